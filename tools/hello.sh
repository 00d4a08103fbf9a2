#!/bin/sh
# From a fresh checkout to a talking face: installs what is missing, builds, speaks.
#   tools/hello.sh                          writes hello.mp4
#   tools/hello.sh "Any text" out.mp4 [options of animeme speak]
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
text=${1:-"Hello world! My mouth moves by numbers, and a few thousand bits a second are enough."}
output=${2:-hello.mp4}
[ $# -gt 2 ] && shift 2 || shift $#

begin=$(date +%s)
"$here/tools/setup.sh"
installed=$(date +%s)
cd "$here"
cmake --preset release >build-setup.log 2>&1 || { cat build-setup.log >&2; exit 1; }
rm -f build-setup.log
cmake --build build/release --target animeme
built=$(date +%s)
cd - >/dev/null
"$here/build/release/bin/animeme" speak --text "$text" -o "$output" "$@"
echo "packages $((installed - begin)) s, build $((built - installed)) s, speaking $(($(date +%s) - built)) s" >&2
