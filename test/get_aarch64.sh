#!/bin/sh
# A C++ compiler for ARM and an emulator, for a long test of the kernel, unpacked into a folder of
# their own: nothing is installed. Without them, or apt, the test is skipped and says so.
set -u
folder=$1
mkdir -p "$folder" && cd "$folder" || exit 0
if ! command -v apt-get > /dev/null || ! command -v dpkg > /dev/null; then
  echo "no apt here: the kernel is not tested for ARM"
  exit 0
fi
compiler=$(apt-cache search '^g[+][+]-[0-9]+-aarch64-linux-gnu$' | sort -V | tail -1 | cut -d' ' -f1)
packages="$compiler qemu-user-static"
missing=$(apt-get install --simulate $packages 2> /dev/null | sed -n 's/^Inst \([^ ]*\) .*/\1/p')
apt-get download $missing > download.log 2>&1 ||
  echo "no compiler for ARM could be fetched ($folder/download.log): the kernel is not tested there"
for package in *.deb; do
  [ -e "$package" ] && dpkg -x "$package" . && rm "$package"
done
exit 0
