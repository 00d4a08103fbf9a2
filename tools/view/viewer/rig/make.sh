#!/bin/sh
# Compiles rig.wasm, the WebAssembly that moves the heads of pages, and notes the compiler in
# rig.wasm.compiler.
#   tools/view/viewer/rig/make.sh [FOLDER]     into FOLDER; without one into its own, where the
#                                              build takes it from
# Needs clang 14 or later with a C++ library for WebAssembly: "tools/setup.sh full" installs it on
# Debian. Elsewhere
# ANIMEME_WASM_CXX names the command, e.g. "clang++ --sysroot=/opt/wasi-sdk/share/wasi-sysroot".
# Exit code 77: there is no such compiler.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../../.." && pwd)
mkdir -p "${1:-$here}"
output=$(cd "${1:-$here}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

flags="--target=wasm32-wasi -std=c++20 -Os -fno-exceptions -fno-rtti -fno-threadsafe-statics -mexec-model=reactor
  -ffp-contract=off -Wl,--strip-all -Wl,-z,stack-size=262144 -Wl,--stack-first"
echo '#include <vector>' >"$work/trial.cpp"
compiler=""
for candidate in "${ANIMEME_WASM_CXX:-clang++-14}" clang++ \
  "clang++ --sysroot=/opt/wasi-sdk/share/wasi-sysroot" \
  "clang++ --sysroot=/opt/homebrew/share/wasi-sysroot"; do
  # shellcheck disable=SC2086  # words
  [ -n "$compiler" ] ||
    ! $candidate $flags -o "$work/trial.wasm" "$work/trial.cpp" 2>"$work/why" || compiler=$candidate
done
[ -n "$compiler" ] || {
  echo "No clang here has a C++ library for WebAssembly. Debian 12: apt-get install clang-14 lld-14 wasi-libc" >&2
  echo "libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32 (tools/setup.sh full does so). The last one tried says:" >&2
  cat "$work/why" >&2
  exit 77
}

# One unit: its parts share headers, and only the page calls it.
for name in fap/arkit fap/arkit_table fap/arkit_sparsity fap/bounded_fit fap/bounded_solver \
  fap/exact_fit fap/expand fap/face_fit fap/shape_fit fap/tables fap/viseme fap/wider \
  fap/head/model fap/head/pose fap/head/vector fap/head/detail/geodesic fap/head/detail/normals \
  fap/head/detail/stops fap/head/detail/targets fap/head/detail/teeth fap/head/detail/whole \
  tools/view/viewer/rig/unpack tools/view/viewer/rig/module; do
  echo "#include \"$name.cpp\""
done >"$work/rig.cpp"
# shellcheck disable=SC2086
$compiler $flags -I"$top" -o "$work/rig.wasm" "$work/rig.cpp"
chmod 644 "$work/rig.wasm"
$compiler --version | head -1 >"$work/rig.wasm.compiler"
mv "$work/rig.wasm" "$work/rig.wasm.compiler" "$output"
