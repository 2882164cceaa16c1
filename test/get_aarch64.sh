#!/bin/sh
# A C++ compiler for ARM, an emulator and a Python for ARM, for long tests of the kernel, unpacked
# into a folder of their own: nothing is installed. Without them, or apt, the tests are skipped.
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

# The lists of packages for ARM lie in the folder too: those of this machine are not changed.
python="python3-minimal libpython3-stdlib libstdc++6"
mkdir -p python/lists/partial python/archives/partial && touch python/status && cd python || exit 0
foreign() {
  apt-get -o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Debug::NoLocking=1 \
    -o Dir::State="$PWD" -o Dir::State::status="$PWD/status" -o Dir::Cache="$PWD" \
    -o Acquire::Languages=none "$@"
}
foreign update > download.log 2>&1
missing=$(foreign install --simulate --no-install-recommends $python 2> /dev/null |
  sed -n 's/^Inst \([^ ]*\) .*/\1/p')
foreign download $missing >> download.log 2>&1 ||
  echo "no Python for ARM could be fetched ($PWD/download.log): wheels are not tested there"
for package in *.deb; do
  [ -e "$package" ] && dpkg -x "$package" . && rm "$package"
done
exit 0
