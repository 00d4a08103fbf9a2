#!/bin/sh
# Draws tools/release/pictures/heads.jpg: woman, man and child from three sides, with visemes and
# expressions beside them. Needs ffmpeg.
#   tools/release/pictures/heads.sh build/release/bin/animeme OUT.jpg
set -eu
animeme=$1 out=$2
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
for head in woman man child; do
  for view in front three-quarter side; do
    "$animeme" render --shapes expressions --sheet 1x7 --head $head --view $view --zoom 1.25 \
      --size 240x240 -o "$dir/all.png"
    ffmpeg -nostdin -v error -y -i "$dir/all.png" -vf crop=240:240:0:0 "$dir/$view.png"
  done
  "$animeme" render --shapes visemes --sheet 5x3 --head $head --zoom 2 --size 80x79 \
    -o "$dir/visemes.png"
  "$animeme" render --shapes expressions --sheet 4x2 --head $head --view three-quarter --zoom 1.3 \
    --size 119x119 -o "$dir/expressions.png"
  ffmpeg -nostdin -v error -y -i "$dir/front.png" -i "$dir/three-quarter.png" -i "$dir/side.png" \
    -i "$dir/visemes.png" -i "$dir/expressions.png" -filter_complex \
    "[3]scale=-1:240[v];[4]scale=-1:240[e];[0][1][2][v][e]hstack=5" "$dir/$head.png"
done
ffmpeg -nostdin -v error -y -i "$dir/woman.png" -i "$dir/man.png" -i "$dir/child.png" \
  -filter_complex vstack=3 -frames:v 1 -q:v 8 "$out"
