#!/bin/sh
# Two heads that talk and look at each other: a video of both, and a sheet of it. The one that does
# not speak looks on. Needs ffmpeg.
#   tools/release/pictures/dialogue.sh build/release/bin/animeme OUTFOLDER [LEFT RIGHT]
set -eu
animeme=$1 out=$2 left=${3:-woman} right=${4:-man}
mkdir -p "$out"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
one="Did you see the light in the garden?" two="No, I was asleep. What was it?"
three="I don't know. But it was beautiful!" four="Then wake me up the next time."

# spoken TEXT: how many milliseconds it takes, and some.
spoken() {
  "$animeme" speak --text "$1" -o "$dir/line.mp4" 2>"$dir/log"
  ffprobe -v error -show_entries format=duration -of csv=p=0 "$dir/line.mp4" |
    awk '{printf "%d", 1000 * $1 + 300}'
}
first=$(spoken "$one") second=$(spoken "$two") third=$(spoken "$three") fourth=$(spoken "$four")

# Whoever does not speak is silent for as long as the other one speaks.
cat >"$dir/left.ssml" <<END
<speak>$one <break time="${second}ms"/> $three <break time="${fourth}ms"/></speak>
END
# cue NUMBER FROM LENGTH TEXT: of subtitles.
cue() {
  echo "$1"
  awk -v a="$2" -v b="$(($2 + $3))" 'function at(t) {
    return sprintf("00:00:%02d,%03d", int(t / 1000), t % 1000) } BEGIN {print at(a) " --> " at(b)}'
  printf '%s\n\n' "$4"
}
{
  cue 1 "$first" "$second" "$two"
  cue 2 $((first + second + third)) "$fourth" "$four"
} >"$dir/right.srt"
# The left one in the picture looks to its left, the right one to its right.
look=${LOOK:-22} view=${VIEW:-22}
"$animeme" speak "$dir/left.ssml" --look="$look,0" --seed 3 -o "$dir/left.mp4" 2>"$dir/log"
"$animeme" speak --script "$dir/right.srt" --fit 0.8-1.3 --look="-$look,0" --seed 4 \
  -o "$dir/right.mp4" 2>"$dir/log"
"$animeme" render "$dir/left.mp4" --head "$left" --view "-$view" --size 480x480 \
  -o "$dir/left_film.mp4" 2>"$dir/log"
"$animeme" render "$dir/right.mp4" --head "$right" --view "$view" --size 480x480 \
  -o "$dir/right_film.mp4" 2>"$dir/log"
ffmpeg -nostdin -v error -y -i "$dir/left_film.mp4" -i "$dir/right_film.mp4" -filter_complex \
  "[0:v][1:v]hstack=inputs=2[v];[0:a][1:a]amix=inputs=2:duration=longest:normalize=0[a]" \
  -map "[v]" -map "[a]" "$out/dialogue.mp4"
ffmpeg -nostdin -v error -y -i "$out/dialogue.mp4" -vf "fps=2,scale=360:-1,tile=4x4" -frames:v 1 \
  -update 1 "$out/dialogue.png"
