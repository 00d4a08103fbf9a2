#!/bin/sh
# tests/structure/other_library.sh: the npm package and the WebAssembly builds compile codec, fap
# and dam with libc++, which lacks parts of the C++20 library that the one of GCC has (algorithms in
# std::ranges, std::from_chars for numbers with a fraction), and for 32 bits. This looks at their
# files with clang 14 for WebAssembly (-fsyntax-only), many as one unit. Exit code 77: that compiler
# or its library is not there.
set -eu
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags="--target=wasm32-wasi -std=c++20 -fsyntax-only -fexceptions -Wall -Wextra -Wshorten-64-to-32 -Werror
  -Wno-missing-field-initializers -isystem $work -I. $(pkg-config --cflags-only-I eigen3 | sed 's/-I/-isystem /g')"
# The library for WASI has no files, unlike Emscripten's. Its header does.
cat >"$work/__config_site" <<'CONFIG'
#include_next <__config_site>
#undef _LIBCPP_HAS_NO_FILESYSTEM_LIBRARY
CONFIG
echo '#include <vector>' >"$work/trial.cpp"
# shellcheck disable=SC2086  # words
clang++-14 $flags "$work/trial.cpp" 2>"$work/why" || { cat "$work/why"; exit 77; }
rm "$work/trial.cpp"
# At most 24 files, whose names in anonymous namespaces differ, without those that need threads or
# mapped memory.
for folder in codec fap fap/head dam; do
  find $folder -name '*.cpp' ! -path 'fap/xml/*' |
    { [ $folder != fap ] && cat || grep -v ^fap/head; } | sort |
    xargs grep -L -E '<(thread|sys/mman.h)>' | sed 's/.*/#include "&"/' |
    split -l 24 --additional-suffix=.cpp - "$work/$(basename $folder)."
done
# shellcheck disable=SC2086
find "$work" -name '*.cpp' | xargs -P "$(nproc)" -n 1 clang++-14 $flags
