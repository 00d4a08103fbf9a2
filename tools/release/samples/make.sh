#!/bin/sh
# Makes the samples of this folder again, by the program and make.py: tools/release/samples/make.sh
# [ANIMEME]
set -eu
folder=$(cd "$(dirname "$0")" && pwd)
animeme=${1:-$folder/../../../build/release/bin/animeme}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
run() { "$animeme" -q "$@"; }

# A voice, its text, its phones and words; what it looks like.
text="My mouth moves by numbers."
echo "$text" >voice.txt
run speak --text "$text" --speed 190 -o talk.mp4 -o talk.fap -o talk.fba \
  -o LiveLinkFace.csv.livelink.csv -o curves.csv
mv LiveLinkFace.csv.livelink.csv LiveLinkFace.csv
run demux talk.mp4 -o voice.wav -o voice.TextGrid
run demux talk.mp4 -o voice.m4a -o voice.tsv
run demux talk.mp4 -o voice.vtt

# Takes of a phone with their sound and text: what a corpus is made of.
mkdir takes texts
while read -r name words; do
  echo "$words" >"texts/$name.txt"
  run speak --text "$words" --lang en-gb --speed 200 --rate 15 -o "$name.mp4" \
    -o "takes/$name.livelink.csv"
  mv "takes/$name.livelink.csv" "takes/$name.csv"
  run demux "$name.mp4" -o "takes/$name.m4a"
done <<END
one Bin blue now.
two Place white by two.
three Lay green soon.
four Set red again.
END

# Where something of yours stands in the examples: programs that print what yours would.
program() { cat >"$1" && chmod +x "$1"; }
program my_tts <<'END'
#!/bin/sh
# Stands for a text to speech program that prints its phones: begin, end, phone.
printf '0 0.3 SIL\n0.3 0.42 HH\n0.42 0.5 EH\n0.5 0.6 L\n0.6 0.9 OW\n0.9 1.1 SIL\n'
END
program my_voice <<'END'
#!/bin/sh
# Stands for a voice of yours: writes the sound of a text to a file.
cp voice.wav "$1"
END
program my_player <<'END'
#!/bin/sh
# Stands for a player: takes what comes and counts its lines.
wc -l
END
program my_chat_bot <<'END'
#!/bin/sh
# Stands for a program that says something now and then, a line each.
echo "Hello there."
sleep 1
echo "How are you?"
END
program my_cloud_voice <<'END'
#!/bin/sh
# Stands for a speech service: a line with sound in base64 and the times of its words.
sound=$(base64 <voice.wav | tr -d '\n')
printf '{"audio": "%s", "words": [{"word": "My", "start": 0.25, "end": 0.4}, ' "$sound"
printf '{"word": "mouth", "start": 0.4, "end": 0.65}, {"word": "moves", "start": 0.65, "end": 1.0}, '
printf '{"word": "by", "start": 1.0, "end": 1.1}, {"word": "numbers", "start": 1.1, "end": 1.7}]}\n'
END
printf 'id\ttext\tlang\nhello\tHello world\ten\nhallo\tGuten Tag\tde\n' >clips.tsv

run head woman -o woman.glb
run head woman -o woman.obj
python3 "$folder/make.py"
npm install --silent --no-save --prefix npm meshoptimizer@1.3.0
node "$folder/make_head.mjs" "$work/npm/node_modules/meshoptimizer"
rm -rf npm woman.* one.mp4 two.mp4 three.mp4 four.mp4 curves.csv voice.tsv
cp -r ./* "$folder/"
