#!/bin/sh
# animeme.h and the examples compile without a warning as C99, C11, C++11 and C++20, by all
# compilers that are here.
#   header_test.sh SOURCE_DIR
set -e
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/animeme"
cp "$1/tools/bindings/c/animeme.h" "$work/animeme"
printf '#include <animeme/animeme.h>\n#include <animeme/animeme.h>\nint main(void) { return ANIMEME_OK; }\n' >"$work/one.c"
strict="-Wall -Wextra -pedantic -Werror -fsyntax-only -I$work"
tried=0
for compiler in gcc clang clang-14; do
  command -v $compiler >/dev/null || { echo "no $compiler"; continue; }
  for standard in c99 c11; do
    for file in "$work/one.c" "$1"/tools/bindings/examples/*.c; do
      $compiler -std=$standard -Wstrict-prototypes $strict "$file"
      tried=$((tried + 1))
    done
  done
done
for compiler in g++ clang++ clang++-14; do
  command -v $compiler >/dev/null || { echo "no $compiler"; continue; }
  for standard in c++11 c++20; do
    $compiler -std=$standard -x c++ $strict "$work/one.c"
    tried=$((tried + 1))
  done
done
[ $tried -gt 0 ] || exit 77
echo "$tried times without a warning"
