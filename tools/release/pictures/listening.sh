#!/bin/sh
# Ten seconds of a face that hears another voice, as a sheet for each head: a picture each half
# second. It keeps eye contact, blinks, and nods at pauses. In real time. Needs ffmpeg.
#   tools/release/pictures/listening.sh build/release/bin/animeme OUTFOLDER woman man me.glb ...
set -eu
animeme=$1 out=$2
shift 2
mkdir -p "$out"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
port=${PORT:-7391}
text="I was there on Sunday, you know. Nobody had told me. And then it began to rain! So we went home."
"$animeme" speak --text "$text" -o "$dir/other.mp4" 2>"$dir/log"
ffmpeg -nostdin -v error -y -i "$dir/other.mp4" -vn "$dir/other.wav"
"$animeme" receive udp://127.0.0.1:$port --duration 10 -o "$dir/listening.fba" \
  2>"$dir/receive.log" &
receiver=$!
sleep 13 | timeout 14 "$animeme" stream --say - --hear "$dir/other.wav" --seed "${SEED:-2}" \
  --to udp://127.0.0.1:$port 2>"$dir/stream.log" || true
wait $receiver || { cat "$dir/receive.log" "$dir/stream.log" >&2; exit 1; }
number=0
for head in "$@"; do
  number=$((number + 1))
  "$animeme" render "$dir/listening.fba" --head "$head" --sheet 10x2 --size "${SIZE:-160x190}" \
    --zoom "${ZOOM:-1.3}" -o "$out/listening.$number.png" 2>"$dir/log"
done
