#!/bin/sh
# tests/left_out.sh: what "tests/run.sh full" runs in addition to "tests/run.sh", from the release
# build: tests by label, and programs that were not built, with the tests in their sources.
cd "$(dirname "$0")/.."
build=build/release
# count LABEL: tests with it that are not core, those of programs that are not built left out.
count() {
  ctest --test-dir $build -N -L "$1" -LE '^core$' | grep -E '^ *Test +#' | grep -cv NOT_BUILT
}
echo "== tests/run.sh full also runs"
echo "  the tests of the libraries and of the program under the address and undefined behaviour sanitizers, fuzz targets included"
echo "  tests by label that are built here:"
for label in $(ctest --test-dir $build --print-labels | sed -n 's/^  //p' | grep -v '^core$'); do
  [ "$(count "^$label\$")" = 0 ] || printf '%8d  %s\n' "$(count "^$label\$")" "$label"
done
echo "  programs that are not built here:"
ctest --test-dir $build -N | sed -n 's/.* \([a-z_]*\)\.NOT_BUILT.*/test_\1/p' | sort -u |
  fmt -w 100 | sed 's/^/          /'
