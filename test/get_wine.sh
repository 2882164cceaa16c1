#!/bin/sh
# Wine, to run the kernel for Windows in long tests, unpacked into a folder of its own: nothing is
# installed. Without it, or apt, that test is skipped.
set -u
folder=$1
mkdir -p "$folder" && cd "$folder" || exit 0
missing=$(apt-get install --simulate --no-install-recommends wine64 2> /dev/null |
  sed -n 's/^Inst \([^ ]*\) .*/\1/p')
if [ -z "$missing" ] || ! apt-get download $missing > download.log 2>&1; then
  echo "Wine could not be fetched: the kernel for Windows is not run"
  exit 0
fi
for package in *.deb; do
  dpkg -x "$package" . && rm "$package"
done
# What its packages do when they are installed.
ln -sf wineserver64 usr/lib/wine/wineserver
cp usr/x86_64-w64-mingw32/lib/zlib1.dll usr/lib/x86_64-linux-gnu/wine/x86_64-windows/
touch done
