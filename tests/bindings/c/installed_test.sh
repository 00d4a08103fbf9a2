#!/bin/sh
# Others find the installed library, by pkg-config and by CMake (in C alone), and their programs
# run.
#   installed_test.sh SOURCE_DIR BINARY_DIR CMAKE LIBDIR
command -v pkg-config >/dev/null || { echo "SKIPPED: pkg-config is missing"; exit 77; }
set -e
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake=$3
$cmake --install "$2" --component c --prefix "$work/made" >"$work/log"
$cmake --install "$2" --component package --prefix "$work/made" >>"$work/log"
mv "$work/made" "$work/prefix" # it works where it is found
lib=$work/prefix/$4
export PKG_CONFIG_PATH="$lib/pkgconfig" LD_LIBRARY_PATH="$lib"
script=$1/tests/data/grid_s1_sample/phonemes/prac8p.tsv

cc -std=c99 -Wall -Wextra -pedantic -Werror "$1/tools/bindings/examples/decode_to_arkit.c" \
  -o "$work/decode" \
  $(pkg-config --cflags --libs animeme)
c++ -std=c++11 -Wall -Wextra -pedantic -Werror "$1/tools/bindings/examples/speak_to_fba.cpp" \
  -o "$work/speak" \
  $(pkg-config --cflags --libs animeme)
"$work/speak" "$script" "$work/talk.fba"
"$work/decode" "$work/talk.fba" "$work/again.fba" >"$work/one"
grep -q 'jawOpen=' "$work/one"

mkdir "$work/project"
cat >"$work/project/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.25)
project(engine LANGUAGES C)
find_package(animeme REQUIRED COMPONENTS c)
add_executable(decode decode.c)
target_link_libraries(decode PRIVATE animeme::c)
PROJECT
cp "$1/tools/bindings/examples/decode_to_arkit.c" "$work/project/decode.c"
$cmake -S "$work/project" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" >>"$work/log"
$cmake --build "$work/build" >>"$work/log"
"$work/build/decode" "$work/again.fba" >"$work/two"
diff "$work/one" "$work/two" # the live stream has the same faces
echo "both ways"
