#!/bin/sh
# Installs what is missing, builds and runs tests. Ends with the tests that were skipped, the slowest steps and tests,
# what failed, and the time of each part.
#   tests/run.sh             the release build of what the tests with the label "core" need, and these: all tests of the codec, the
#                            models and heads, some of every other module. At most ten minutes on two cores
#   tests/run.sh full        everything, once as released, once under the address and undefined behaviour sanitizers, with
#                            browsers, players and npm packages to look at the results
#   tests/run.sh bindings    the codec for other languages and machines: C, Python, npm, Blender, ARM; their speeds and weights
#   tests/run.sh site        makes the site, and looks at all its pages in Chromium: dead links, what axe finds
#   tests/run.sh elsewhere   the libraries as WebAssembly under node, and for ARM under QEMU
#   tests/run.sh packages    the Debian packages, into build/packages, and what they do in a clean root; the README's steps in another
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
mode=${1:-core}
case $mode in
  core) packages=tests ;;
  full | bindings | site | elsewhere | packages) packages=$mode ;;
  *) echo "usage: tests/run.sh [full|bindings|site|elsewhere|packages]" >&2; exit 2 ;;
esac
cd "$here"
# Large pages for what compilers and trainings allocate: an eighth of the time of clang, a quarter of training. Other
# C libraries, and kernels without them, take no notice.
export GLIBC_TUNABLES="${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1}"
times=$(mktemp)
trap 'rm -f "$times"' EXIT
status=0
case $mode in
  core | bindings) presets=release ;;
  elsewhere) presets="wasm arm64" ;;
  packages) presets="" ;;
  *) presets="release asan" ;;
esac

# part TITLE COMMAND...: runs it and notes how long it took.
part() {
  title=$1
  shift
  echo "== $title"
  begin=$(date +%s)
  result=0
  "$@" || result=$?
  printf '%-36s %5d s%s\n' "$title" $(($(date +%s) - begin)) "$([ $result = 0 ] || echo '  failed')" >>"$times"
  [ $result = 0 ] || status=$result
  return $result
}

# finish: what there is to say at the end.
finish() {
  # shellcheck disable=SC2046  # the logs that there are
  "$here/tests/skipped.sh" $(for preset in $presets; do ls "build/$preset/Testing/Temporary/LastTest.log" 2>/dev/null; done) || true
  for preset in $presets; do
    [ ! -f "build/$preset/tests.xml" ] || { echo "== $preset"; "$here/tests/slowest.sh" "$preset"; } || true
  done
  # shellcheck disable=SC2086  # a word a preset
  "$here/tests/failed.sh" $presets || true
  [ "$mode" != core ] || "$here/tests/left_out.sh" || true
  echo "== Time"
  cat "$times"
  exit "$status"
}

# tests PRESET MORE [OPTIONS of ctest]: more at a time than there are cores, since live streams and pages mostly wait. What times out
# gets a second try. What fails runs again alone, which tells a fault from a machine that was too busy for a stream
# or a page; that is a finding, too, and told at the end.
tests() {
  preset=$1 more=$2
  shift 2
  ctest --test-dir "build/$preset" --output-on-failure -j "$(($(nproc) + more))" --repeat after-timeout:2 \
    --output-junit "$here/build/$preset/tests.xml" "$@" && return 0
  echo "== Those that failed, alone"
  log=build/$preset/Testing/Temporary/LastTest.log
  cp "$log" "$log.first"
  alone=0
  ctest --test-dir "build/$preset" --output-on-failure --rerun-failed || alone=$?
  mv "$log.first" "$log"  # the one that tells what was skipped
  [ $alone = 0 ] || return $alone
  printf '%-36s         %s\n' "$preset: failed beside others only:" "$(tests/failed.sh "$preset" | sed -n 's/^== Failed.*: //p' | xargs)" >>"$times"
}

# needs_program PRESET PROGRAM: tells that it is skipped without.
needs_program() {
  command -v "$2" >/dev/null || printf '%-36s         %s\n' "$1: skipped" "$2 is missing" >>"$times"
  command -v "$2" >/dev/null
}

# untouched COMMAND...: fails if the command changes a file of the checkout outside build/: tests write into the build folder or
# a temporary one.
untouched() {
  tree >"$times.before"
  result=0
  "$@" || result=$?
  tree | diff "$times.before" - >"$times.changed" || {
    echo "Changed in the checkout while the tests ran:"
    sed -n 's/^[<>] [^ ]* [^ ]* /  /p' "$times.changed" | sort -u
    [ $result != 0 ] || result=1
  }
  rm -f "$times.before" "$times.changed"
  return $result
}

# tree: the files of the checkout with their times and sizes.
tree() {
  find . \( -path ./build -o -path ./.git -o -name node_modules -o -name __pycache__ \) -prune -o -type f -printf '%T@ %s %p\n' | sort -k 3
}

run() {
  preset=$1 more=$2
  target=all select=""
  [ "$mode" != core ] || { target=core select="-L ^core$"; }
  rm -f "build/$preset/Testing/Temporary/LastTest.log" "build/$preset/tests.xml"
  part "$preset: configure" cmake --preset "$preset" --log-level=STATUS -DANIMEME_WERROR=ON || finish
  part "$preset: build" cmake --build "build/$preset" --target "$target" || finish
  # shellcheck disable=SC2086  # words
  part "$preset: tests" untouched tests "$preset" "$more" $select || true  # the other round is of use all the same
}

# npm_package: by its own preset, then its tests in the tree of the release build, which has the program and the suite.
npm_package() {
  cmake --preset npm --log-level=STATUS && cmake --build --preset npm &&
    ctest --test-dir build/release --output-on-failure -R '^npm\.'
}

# fetched: a project of others fetches all of animeme and links every component, if what that needs is there.
fetched() {
  cmake --preset release --log-level=STATUS &&
    cmake -DLINK=ON -DCXX=c++ -DGENERATOR=Ninja -DWORK="$here/build/fetched" -DANIMEME_DIR="$here" \
      -DTESTS="$here/tests/release/package" -DCOMPONENTS="$(cat build/release/components.txt)" -P tests/release/package/fetch_all.cmake
}

# arm64_suite: tests of the codec by QEMU, which decode the streams of the conformance suite value for value.
arm64_suite() {
  cmake --preset arm64 --log-level=STATUS && cmake --build build/arm64 --target test_codec &&
    ctest --test-dir build/arm64 --output-on-failure -R '^codec$'
}

# bindings: what the release build has to have for them, then each.
bindings() {
  part "release: configure" cmake --preset release --log-level=STATUS || finish
  part "release: build" cmake --build build/release || finish
  part "C, Python, Blender" ctest --test-dir build/release --output-on-failure -R '^(c|python|blender)\.' || true
  { needs_program npm em++ && needs_program npm npm && part "npm" npm_package; } || true
  { needs_program arm64 aarch64-linux-gnu-g++ && needs_program arm64 qemu-aarch64 && part "arm64" arm64_suite; } || true
  part "table" tests/bench/bindings.sh build/release
}

part "packages" tools/setup.sh "$packages" || finish
if [ "$mode" = bindings ]; then
  bindings || true
  finish
fi
if [ "$mode" = site ]; then
  presets=""
  part "site: configure" cmake --preset release --log-level=STATUS || finish
  part "site: build" cmake --build build/release --target docs || finish
  part "site: check" node tests/release/site/check.js build/release/site || true
  finish
fi
for preset in $presets; do
  case $preset in
    release) run release 1 ;;  # pages draw by the processor
    asan) run asan 2 ;;
    wasm) needs_program wasm em++ && run wasm 0 ;;
    arm64) needs_program arm64 aarch64-linux-gnu-g++ && needs_program arm64 qemu-aarch64 && run arm64 0 ;;
  esac || true
done
if [ "$mode" = elsewhere ]; then
  part "fetched, all components" fetched || true
fi
if [ "$mode" = packages ]; then
  rm -rf build/packages
  part "packages: build, lintian" tools/release/packaging/deb.sh -o build/packages -w build/packages-tree || finish
  part "packages: clean root" tools/release/packaging/clean_root.sh build/packages/*.deb || true
  part "README's steps in a clean root" tests/release/readme/clean_root.sh all || true
fi
finish
