#!/bin/sh
# Prints the figures of the top README again, each under the command that it names.
#   tests/bench/figures.sh [BUILD]        BUILD: build/release; ANIMEME_SHARED: a folder with
#                                         data/grid_s1, for two of them
# What is compared without a clock is tests/release/readme/figures_test.cpp; speeds are ratios
# within one run.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
bin=${1:-$here/build/release}/bin
corpus=${ANIMEME_SHARED:-/nowhere}/data/grid_s1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

figure() { printf '\n$ %s\n' "$*"; }
cd "$here"

figure animeme check conformance
"$bin/animeme" check conformance 2>&1 | tail -1

if [ -d "$corpus" ]; then
  figure "animeme train grid_s1 --split train -o m.dam && animeme evaluate m.dam grid_s1 --split test"
  "$bin/animeme" -q train "$corpus" --split train -o "$work/m.dam"
  "$bin/animeme" evaluate "$work/m.dam" "$corpus" --split test
else
  echo "skipped: the corpus grid_s1 is wanted below the folder that ANIMEME_SHARED names"
fi

for program in test_media bench_codec; do
  [ -x "$bin/$program" ] ||
    { echo "skipped: build $program (cmake --build build/release --target $program)"; continue; }
  case $program in
    test_media)
      figure "build/release/bin/test_media --gtest_filter='*Click*'"
      "$bin/test_media" --gtest_filter='*Click*' 2>&1 | tail -1 ;;
    bench_codec)
      figure "build/release/bin/bench_codec (x_textbook: against a plain coder, in the same run)"
      "$bin/bench_codec" --benchmark_filter='decode' 2>/dev/null |
        grep -E 'x_textbook|Benchmark' || true ;;
  esac
done

figure "sentence of tools/hello.sh, as .fba"
sentence=$(sed -n 's/^text=${1:-"\(.*\)"}$/\1/p' tools/hello.sh)
"$bin/animeme" speak --text "$sentence" -o "$work/a.fba"
"$bin/animeme" speak --text "$sentence" --rms 2 -o "$work/b.fba"
