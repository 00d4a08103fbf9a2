#!/bin/sh
# Draws tools/release/pictures/people.jpg: all people that --head knows, and two of them changed by
# words. Needs ffmpeg.
#   tools/release/pictures/people.sh build/release/bin/animeme OUT.jpg
set -eu
animeme=$1 out=$2
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
n=0
for head in woman amara mei rosa child man omar kenji george woman:age=13:hair=ginger-fringe; do
  "$animeme" render --shapes expressions --sheet 1x7 --head "$head" --view 20 --zoom 1.15 \
    --size 240x240 -o "$dir/all.png"
  ffmpeg -nostdin -v error -y -i "$dir/all.png" -vf crop=240:240:0:0 "$dir/$n.png"
  n=$((n + 1))
done
ffmpeg -nostdin -v error -y -framerate 1 -i "$dir/%d.png" -vf tile=5x2 -frames:v 1 -q:v 5 "$out"
