#!/bin/sh
# Makes tools/release/pictures/moving.webp: one sentence on four heads above its curves, with a
# mark that follows the time. Needs ffmpeg.
#   tools/release/pictures/moving.sh build/release/bin/animeme OUT.webp
set -eu
animeme=$1 out=$2
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
rate=12
"$animeme" speak "Hello! We are four heads, and one small stream moves all of us." --mood joy:0.5 \
  -o "$dir/talk.mp4"
bits=$("$animeme" info "$dir/talk.mp4" | sed -n 's/^ *kbit_per_s: \([0-9]*\.[0-9]\).*/\1/p' | head -n 1)
seconds=$(ffprobe -v error -show_entries format=duration -of csv=p=0 "$dir/talk.mp4")
n=0
for head in woman omar mei george; do
  "$animeme" render "$dir/talk.mp4" --head "$head" --view 12 --zoom 1.15 --size 180x200 \
    --rate $rate --quality 8 -o "$dir/$n.mp4"
  n=$((n + 1))
done
"$animeme" plot "$dir/talk.mp4" --faps open_jaw,stretch_l_cornerlip,raise_l_i_eyebrow,head_yaw \
  --scales row --size 720x300 --title "Face: $bits kbit/s" -o "$dir/plot.png"
# In this plot the time begins 32 pixels from the left edge and ends 8 from the right one.
ffmpeg -nostdin -v error -y -i "$dir/0.mp4" -i "$dir/1.mp4" -i "$dir/2.mp4" -i "$dir/3.mp4" \
  -loop 1 -framerate $rate -i "$dir/plot.png" -f lavfi -i "color=red:size=2x222:rate=$rate" \
  -filter_complex "[0][1][2][3]hstack=4[heads];
    [4][5]overlay=x='32+(W-40)*t/$seconds':y=24[curves];[heads][curves]vstack=2:shortest=1" \
  -an -t "$seconds" -loop 0 -c:v libwebp_anim -quality 62 -compression_level 6 "$out"
