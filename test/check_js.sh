#!/bin/sh
# Check the page's modules with the tools of get_js.sh: sh test/check_js.sh FOLDER types|style
set -u
folder=$1
modules=$folder/node_modules
if ! [ -d "$modules" ]; then
  echo "the page's modules cannot be checked: $folder has no TypeScript and Biome (make set-up-js)"
  exit 1
fi
case $2 in
  types) "$modules"/@typescript/*/lib/tsc --project tsconfig.json ;;
  # With the folders named: it would follow every link of an environment beside them.
  style) "$modules"/@biomejs/cli-*/biome ci --colors=off --error-on-warnings symtop_ros/page/web test/page/web ;;
esac
