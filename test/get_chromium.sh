#!/bin/sh
# Chromium for the tests of the page, and its headless shell, which opens a page with less work,
# unpacked into a folder of their own: nothing is installed. Without the first, or apt, those tests
# are skipped and say so.
set -u
folder=$1
mkdir -p "$folder" && cd "$folder" || exit 0
if command -v chromium > /dev/null || command -v chromium-browser > /dev/null; then
  exit 0
fi
if ! command -v apt-get > /dev/null || ! command -v dpkg > /dev/null; then
  echo "no apt here: the page is tested only where Chromium is installed"
  exit 0
fi
missing=$(apt-get install --simulate --no-install-recommends chromium 2> /dev/null |
  sed -n 's/^Inst \([^ ]*\) .*/\1/p')
apt-get download chromium $missing > download.log 2>&1 ||
  echo "no Chromium could be fetched ($folder/download.log): the page is not tested in a browser"
apt-get download chromium-headless-shell >> download.log 2>&1 # Ubuntu has none
for package in *.deb; do
  [ -e "$package" ] && dpkg -x "$package" . && rm "$package"
done
rm -rf usr/share/doc usr/share/locale usr/lib/chromium/libVkLayer_*
exit 0
