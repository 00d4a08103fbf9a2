#!/bin/sh
# From a fresh checkout to a talking face: installs the missing packages, builds the program,
# speaks. Prints the time of each part, in seconds of wall clock and of CPU, and the slowest steps
# of the build.
#   tools/hello.sh                          writes hello.mp4
#   tools/hello.sh "Any text" out.mp4 [options of animeme speak]
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
text=${1:-"Hello world! My mouth moves by numbers, and a few thousand bits a second are enough."}
output=${2:-hello.mp4}
[ $# -gt 2 ] && shift 2 || shift $#
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# part TITLE COMMAND...: runs it and notes its time. `times` counts the CPU of all that this shell
# has run.
part() {
  title=$1
  shift
  begin=$(date +%s.%N)
  times >"$work/before"
  "$@"
  times >"$work/after"
  cat "$work/before" "$work/after" | tr 'ms' '  ' | awk -v title="$title" -v begin="$begin" \
    -v end="$(date +%s.%N)" '
    NR % 2 == 0 { cpu[NR / 2] = 60 * $1 + $2 + 60 * $3 + $4 }
    END { printf "%-10s %7.1f s  %7.1f s of CPU\n", title, end - begin, cpu[2] - cpu[1] }' >>"$work/times"
}

configure() {
  cmake --preset release >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
}

# Manual pages come with it, so that all of the program is there to be installed.
build() {
  cmake --build build/release --target animeme manual
}

part packages "$here/tools/setup.sh"
cd "$here"
part configure configure
part build build
cd - >/dev/null
part speak "$here/build/release/bin/animeme" speak --text "$text" -o "$output" "$@"
{
  [ -z "$(find "$here/build/release/.ninja_log" -newer "$work/log")" ] ||
    "$here/tests/slowest.sh" release 5 steps
  cat "$work/times"
  "$here/tools/setup.sh" check all 2>/dev/null ||
    echo "To align recordings, and for Chinese and Japanese, install more packages: tools/setup.sh all"
} >&2
