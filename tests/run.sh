#!/bin/sh
# Installs what is missing, builds everything and runs all tests: once as released, once under
# the address and undefined behaviour sanitizers.
#   tests/run.sh             everything
#   tests/run.sh quick       the release build only
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
"$here/tools/setup.sh" tests
jobs=$(nproc)
# A compiler cache helps who builds again, precompiled headers who builds once.
faster="-DANIMEME_PCH=ON"
command -v ccache >/dev/null && [ -z "${CCACHE_DISABLE:-}" ] &&
  faster="-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"

run() {
  preset=$1
  shift
  echo "== $preset"
  (cd "$here" && cmake --preset "$preset" $faster "$@" >/dev/null)
  cmake --build "$here/build/$preset"
  ctest --test-dir "$here/build/$preset" --output-on-failure -j "$jobs" \
    --output-junit "$here/build/$preset/tests.xml" 
}

run release
[ "${1:-}" = "quick" ] || run asan
