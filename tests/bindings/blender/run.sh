#!/bin/sh
# run.sh PROGRAM SOURCE TEST: TEST.py in the background of Blender, with the add-on installed there
# from its zip, in a profile of its own. Exit code 77: skipped, with the reason.
set -u
name=$3
command -v blender >/dev/null || {
  printf '%s: Skipped\nBlender is missing (Debian: blender)\n' "$name"
  exit 77
}
program=$(realpath "$1") source=$(realpath "$2")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
"$source/tools/bindings/blender/pack.sh" "$dir/animeme_face.zip" || exit 1
# Blender's sound needs no device; its libraries tell a great deal of nothing.
export HOME="$dir" BLENDER_USER_CONFIG="$dir/config" BLENDER_USER_SCRIPTS="$dir/scripts" \
  ALSOFT_DRIVERS=null
PYTHONDONTWRITEBYTECODE=1 blender --background --factory-startup --python-exit-code 1 \
  --python "$source/tests/bindings/blender/$name.py" -- "$program" "$source" "$dir" >"$dir/log" \
    2>&1 || {
  cat "$dir/log"
  exit 1
}
grep -q '^ALL DONE$' "$dir/log" || {
  echo "FAILED: Blender ended before the test did"
  cat "$dir/log"
  exit 1
}
