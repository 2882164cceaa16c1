#!/bin/sh
# A software Vulkan driver for the tests that render pictures, unpacked into a folder of its own:
# nothing is installed. Without it, or apt, those tests are skipped and say so.
set -u
folder=$1
packages="mesa-vulkan-drivers libvulkan1"
mkdir -p "$folder" && cd "$folder" || exit 0
if ! command -v apt-get > /dev/null || ! command -v dpkg > /dev/null; then
  echo "no apt here: pictures are tested only where a Vulkan driver is installed"
  exit 0
fi
missing=$(apt-get install --simulate $packages 2> /dev/null | sed -n 's/^Inst \([^ ]*\) .*/\1/p')
apt-get download $packages $missing > download.log 2>&1 ||
  echo "no Vulkan driver could be fetched ($folder/download.log): pictures are not tested"
for package in *.deb; do
  [ -e "$package" ] && dpkg -x "$package" . && rm "$package"
done
# those of graphics cards
rm -rf usr/share/doc usr/lib/*/dri usr/lib/*/libvulkan_intel* usr/lib/*/libvulkan_radeon.so
exit 0
