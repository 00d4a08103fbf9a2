#!/bin/sh
# steps.sh in a copy of the tree whose build finds all compiled files in the compiler cache; without
# ccache it would take minutes and is skipped ("tests/run.sh packages" has all steps, in a clean
# root).
#   steps_test.sh SOURCE_DIR WORK_DIR [CMAKE_OPTIONS...]
set -eu
source=$1 work=$2
shift 2
skip() {
  printf 'readme: Skipped\n%s\n' "$1"
  exit 77
}
command -v ccache >/dev/null || skip "ccache is missing"
command -v git >/dev/null && git -C "$source" rev-parse >/dev/null 2>&1 ||
  skip "this is no checkout of git"
"$source/tools/setup.sh" check >/dev/null 2>&1 || skip "packages of tools/setup.sh are missing"
rm -rf "$work"
mkdir -p "$work"
cd "$source"
git ls-files -co --exclude-standard -z |
  xargs -0 sh -c 'for f; do [ ! -e "$f" ] || printf "%s\0" "$f"; done' sh |
  tar --null -T - -cf - | tar -xf - -C "$work"
cd "$work"
# As the tree that was compiled, or the cache would not know the files.
cmake --preset release "$@" >configure.log 2>&1 || { cat configure.log; exit 1; }
rm configure.log
tests/release/readme/steps.sh
