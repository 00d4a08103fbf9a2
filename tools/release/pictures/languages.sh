#!/bin/sh
# Draws tools/release/pictures/languages.jpg: a vowel each of ten languages, spoken by its voice and
# seen at its middle. Needs ffmpeg and a font (fonts-dejavu-core).
#   tools/release/pictures/languages.sh build/release/bin/animeme OUT.jpg
set -eu
animeme=$1 out=$2
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf
number=0
# language, word, IPA of the vowel, whether lips are round
while read -r language word ipa lips; do
  number=$((number + 1))
  name=$(printf '%s/%02d' "$dir" $number)
  "$animeme" speak --text "$word" --lang "$language" --rate 50 -o "$name.fap" \
    --save-script "$name.tsv" >"$name.log" 2>&1
  # The longest vowel; its label has one of these letters.
  time=$(awk \
    -F'\t' 'NR > 1 && $3 != "SIL" && $3 ~ /^[AEIOU]/ && $2 - $1 > longest { longest = $2 - $1; at = ($1 + $2) / 2 } END { print at }' "$name.tsv")
  "$animeme" render "$name.fap" --time "$time" --zoom 2.6 --size 220x190 \
    -o "$name.face.png" >>"$name.log" 2>&1
  printf '%s  [%s]  %s' "${language%%-*}" "$ipa" "$lips" >"$name.txt"
  ffmpeg -nostdin -v error -y -i "$name.face.png" -vf \
    "pad=iw:ih+26:0:0:white,drawtext=fontfile=$font:textfile=$name.txt:x=(w-tw)/2:y=h-21:fontsize=15" "$name.png"
  rm "$name.face.png"
done <<'END'
ru мы ɨ spread
vi tư ɯ spread
tr kış ɯ spread
ko 음 ɯ spread
et õ ɤ spread
sv ny y round
fr tu y round
de Mühe y round
cmn 女 y round
en moo u round
END
ffmpeg -nostdin -v error -y -framerate 1 -i "$dir/%02d.png" -vf tile=5x2 -frames:v 1 -q:v 6 "$out"
