#!/bin/sh
# From a fresh checkout to a talking face: installs what is missing, builds, speaks.
#   tools/hello.sh                          writes hello.mp4
#   tools/hello.sh "Any text" out.mp4 [options of animeme speak]
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
text=${1:-"Hello world! My mouth moves by numbers, and a few thousand bits a second are enough."}
output=${2:-hello.mp4}
[ $# -gt 2 ] && shift 2 || shift $#

"$here/tools/setup.sh"
# The tests need more packages; a build that has them keeps them.
tests=""
[ -f "$here/build/release/CMakeCache.txt" ] || tests="-DANIMEME_BUILD_TESTS=OFF"
# shellcheck disable=SC2086  # nothing or one word
cmake -S "$here" -B "$here/build/release" -G Ninja -DCMAKE_BUILD_TYPE=Release $tests \
  >"$here/build-setup.log" 2>&1 || { cat "$here/build-setup.log" >&2; exit 1; }
rm -f "$here/build-setup.log"
cmake --build "$here/build/release" --target animeme
exec "$here/build/release/bin/animeme" speak --text "$text" -o "$output" "$@"
