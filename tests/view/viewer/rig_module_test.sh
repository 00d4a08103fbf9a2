#!/bin/sh
# rig.wasm of the tree is what make.sh compiles: byte for byte by the same compiler; by another one
# the heads of
# RigModule.* move by it as they do in the program.
#   rig_module_test.sh SOURCE_DIR TEST_VIEWER
set -eu
rig=$1/tools/view/viewer/rig program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
result=0
"$rig/make.sh" "$work" >"$work/log" 2>&1 || result=$?
[ $result = 0 ] || { [ $result != 77 ] || echo "view: Skipped"; head -1 "$work/log"; exit $result; }
if cmp -s "$work/rig.wasm" "$rig/rig.wasm"; then
  echo "the same bytes"
elif cmp -s "$work/rig.wasm.compiler" "$rig/rig.wasm.compiler"; then
  echo "rig.wasm is not what its sources make any more (fap/, fap/head/, tools/view/viewer/rig/). Renew it:"
  echo "  tools/view/viewer/rig/make.sh"
  exit 1
else
  echo "compiled by $(cat "$work/rig.wasm.compiler"), kept from $(cat "$rig/rig.wasm.compiler")"
  ANIMEME_RIG_MODULE=$work/rig.wasm "$program" --gtest_filter='RigModule.*'
fi
