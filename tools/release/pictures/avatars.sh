#!/bin/sh
# One sentence on several heads, each beside three.js in Chromium, which plays the file that
# `animeme export --head` writes. Pictures of avatars whose licences forbid it are not committed.
# Needs ffmpeg, chromium and node with three (npm ci in tests/readers/js).
#   tools/release/pictures/avatars.sh build/release/bin/animeme OUT.png woman me.glb vroid.vrm
#   "face.obj --points points.csv" ...
set -eu
animeme=$1 out=$2
shift 2
scripts=$(dirname "$0")/../../../tests/view/gltf/scripts
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
"$animeme" speak --no-idle-motion --text "Papa saw two blue moons" -o "$dir/talk.fba"
inputs= rows=0
for head in "$@"; do
  columns= count=0
  # shellcheck disable=SC2086  # a head and its --points
  "$animeme" export "$dir/talk.fba" --head $head --gain auto -o "$dir/talk.glb"
  for time in 0.16 0.32 0.60 0.96 1.20 1.44; do
    # shellcheck disable=SC2086
    "$animeme" render "$dir/talk.fba" --head $head --gain auto --time $time --size 200x200 \
      --zoom 1.5 -o "$dir/ours.$count.png" 2>"$dir/render.log"
    echo '{"angle": 0.35, "size": 200, "background": 2635582, "time": '$time'}' >"$dir/camera.json"
    node "$scripts/three.js" "$dir/talk.glb" "$dir/camera.json" "$dir/three.rgb" >"$dir/three.log"
    ffmpeg -nostdin -v error -y -i "$dir/ours.$count.png" -i "$dir/three.png" \
      -filter_complex vstack "$dir/column.$count.png"
    columns="$columns -i $dir/column.$count.png" count=$((count + 1))
  done
  # shellcheck disable=SC2086
  ffmpeg -nostdin -v error -y $columns -filter_complex "hstack=$count" "$dir/row.$rows.png"
  inputs="$inputs -i $dir/row.$rows.png" rows=$((rows + 1))
done
filter=$([ $rows = 1 ] && echo null || echo "vstack=$rows")
# shellcheck disable=SC2086
ffmpeg -nostdin -v error -y $inputs -filter_complex "$filter" -frames:v 1 "$out"
