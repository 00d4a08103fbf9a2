#!/bin/sh
# The steps of README.md in a row, as a reader takes them in a fresh clone, which is the current
# folder: hello.sh, the commands that show hello.mp4, an installation, a program of the reader's own
# that uses it. With "all" also the tests and what the README does after them.
#   steps.sh [all]
set -eu
[ -x tools/hello.sh ] && [ -f README.md ] || { echo "run it at the top of a clone"; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
step() {
  echo "== $*"
}
fail() {
  echo "$1"
  exit 1
}
# says WORDS: they are a step of the README.
says() {
  grep -qF -- "$1" README.md || fail "README.md no longer says '$1': change this script, too"
}

says tools/hello.sh
step tools/hello.sh
tools/hello.sh
[ -s hello.mp4 ] || fail "there is no hello.mp4"
cksum hello.mp4 >"$work/hello"
[ ! -f build-setup.log ] || fail "hello.sh left a log behind"

PATH=$PWD/build/release/bin:$PATH
sed -n 's/^    \(animeme [a-z]* hello\.mp4.*\)/\1/p' README.md | sed 's/ *#.*//' >"$work/commands"
[ "$(wc -l <"$work/commands")" -ge 2 ] || fail "README.md shows hello.mp4 by less than two commands"
printf '%s\n' "animeme info hello.mp4" "animeme decode hello.mp4 -o hello.fap" \
  "animeme render hello.mp4 --size 160x160 -o hello.png" >>"$work/commands"
while read -r command; do
  step "$command"
  sh -c "$command" </dev/null
done <"$work/commands"
cksum hello.mp4 | cmp - "$work/hello" || fail "a command that reads hello.mp4 has written it"

# installed PREFIX: whether what is installed there works; a program that uses the codec is built
# with it.
installed() {
  step "cmake --install build/release --prefix $1"
  cmake --install build/release --prefix "$1" >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
  grep -v '^-- \(Install\|Set runtime\|Up-to-date\)' "$work/log" || true
  ! grep -q Warning "$work/log" || fail "the installation warns"
  "$1/bin/animeme" speak --text "Installed" -o "$work/installed.mp4"
  "$1/bin/animeme" info "$work/installed.mp4" >/dev/null
  [ -f "$1/share/man/man1/animeme-speak.1" ] || fail "the manual pages are not installed"
  rm -rf "$work/project"
  mkdir "$work/project"
  cat >"$work/project/CMakeLists.txt" <<'PROJECT'
cmake_minimum_required(VERSION 3.25)
project(app LANGUAGES CXX)
find_package(animeme REQUIRED COMPONENTS fba)
add_executable(app app.cpp)
target_link_libraries(app PRIVATE animeme::fba)
PROJECT
  cp tests/release/package/consumer/fba.cpp "$work/project/app.cpp"
  cmake -G Ninja -S "$work/project" -B "$work/project/build" \
    -DCMAKE_PREFIX_PATH="$1" >"$work/log" &&
    cmake --build "$work/project/build" >>"$work/log" && "$work/project/build/app" ||
      { cat "$work/log"; exit 1; }
}

says "cmake --install build/release --prefix"
says "find_package(animeme REQUIRED COMPONENTS fba)"
installed "$work/first"
# The next reader is somebody who did the same before.
step tools/hello.sh again
tools/hello.sh "Once more" "$work/again.mp4"
[ -s "$work/again.mp4" ] || fail "the second time hello.sh wrote nothing"

if [ "${1:-}" = all ]; then
  says tests/run.sh
  step tests/run.sh
  tests/run.sh
  cksum hello.mp4 | cmp - "$work/hello" || fail "tests have written hello.mp4"
  [ ! -d .git ] || [ -z "$(git status --porcelain)" ] ||
    fail "git sees changes: $(git status --porcelain)"
  installed "$work/second"
  step cmake --build build/release
  cmake --build build/release >"$work/log" || { tail -30 "$work/log"; exit 1; }
  installed "$work/third"
fi
step "all steps work"
