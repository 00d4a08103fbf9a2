#!/bin/sh
# Contact sheets to look at: one sentence in seven moods, then looks and lids, a row for each head.
# Pictures of avatars whose licences forbid it are not committed. Needs ffmpeg.
#   tools/release/pictures/moods.sh build/release/bin/animeme OUTFOLDER woman man me.glb vroid.vrm
#   ...
set -eu
animeme=$1 out=$2
shift 2
mkdir -p "$out"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
size=${SIZE:-200x240} zoom=${ZOOM:-1.4}

# stack DIRECTION OUT PICTURE...: side by side or one below the other.
stack() {
  direction=$1 picture=$2
  shift 2
  inputs= count=0
  for one in "$@"; do inputs="$inputs -i $one" count=$((count + 1)); done
  if [ $count = 1 ]; then filter=null; else filter="$direction=inputs=$count"; fi
  # shellcheck disable=SC2086
  ffmpeg -nostdin -v error -y $inputs -filter_complex "$filter" -frames:v 1 -update 1 "$picture"
}

# row OUT HEAD CLIP TIME...: pictures of a clip.
row() {
  picture=$1 head=$2 clip=$3
  shift 3
  columns=
  for time in "$@"; do
    "$animeme" render "$clip" --head "$head" --time "$time" --size "$size" --zoom "$zoom" \
      -o "$dir/at.$time.png" 2>"$dir/log"
    columns="$columns $dir/at.$time.png"
  done
  # shellcheck disable=SC2086
  stack hstack "$picture" $columns
}

text="Now I know what you mean by all of this."
for mood in neutral joy sadness anger fear disgust surprise; do
  "$animeme" speak --text "$text" --mood $mood --still gaze,head,blinks \
    -o "$dir/$mood.fba" 2>"$dir/log"
done
looks="camera 25,0 -25,0 0,20 0,-20 15,-12"
for look in $looks; do
  "$animeme" speak --text "Hm." --look="$look" --still head,blinks \
    -o "$dir/look.$look.fba" 2>"$dir/log"
done
"$animeme" speak --text "$text And what do you think of it, my friend?" --seed 5 \
  -o "$dir/alive.fba" 2>"$dir/log"

number=0
for head in "$@"; do
  number=$((number + 1)) moods= gazes=
  for mood in neutral joy sadness anger fear disgust surprise; do
    row "$dir/mood.$mood.png" "$head" "$dir/$mood.fba" 0.04 0.6 1.0 1.4 1.9
    moods="$moods $dir/mood.$mood.png"
  done
  # shellcheck disable=SC2086
  stack vstack "$out/moods.$number.png" $moods
  for look in $looks; do
    row "$dir/gaze.$look.png" "$head" "$dir/look.$look.fba" 0.2
    gazes="$gazes $dir/gaze.$look.png"
  done
  # shellcheck disable=SC2086
  stack hstack "$out/gaze.$number.png" $gazes
  row "$out/alive.$number.png" "$head" "$dir/alive.fba" 0.2 0.6 1.0 1.4 1.8 2.2 2.6 3.0 3.4 3.8
done
