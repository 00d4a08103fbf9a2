#!/bin/sh
# run.sh TEST.mjs PACKAGE ARGUMENT...: a test of the npm package under node; 77 where something of
# it is missing.
test=$1 package=$2
command -v node >/dev/null || { echo "skipped: node is missing (Debian package nodejs)"; exit 77; }
command -v em++ >/dev/null || [ -d "$package" ] ||
  { echo "skipped: em++ is missing (Debian package emscripten)"; exit 77; }
[ -f "$package/wasm/speaker.wasm" ] ||
  { echo "skipped: the npm package is not built (tests/run.sh bindings)"; exit 77; }
shift
exec node "$(dirname "$0")/$test" "$@"
