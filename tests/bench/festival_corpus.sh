#!/bin/sh
# Speech whose times are known, in languages that have no corpus here: Festival's voices say sentences
# and tell their phones. For align_table (DIR has utterances.tsv, audio/, phonemes/).
#
#     tests/bench/festival_corpus.sh VOICE LIST DIR    # LIST: a sentence a line, or Asterisk's "ID: text"
#     tests/bench/festival_corpus.sh hy_fi_mv_diphone tests/bench/sentences/fi.txt /tmp/fi
#
# Voices (Debian): kal_diphone (festvox-kallpc16k), lp_diphone, pc_diphone (festvox-italp16k, -itapc16k),
# hy_fi_mv_diphone (festvox-suopuhe-mv), czech_ph (festvox-czech-ph), msu_ru_nsh_clunits (festvox-ru),
# upc_ca_ona_hts (festvox-ca-ona-hts).
set -eu
[ $# = 3 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0"; exit 2; }
voice=$1 list=$2 dir=$3
command -v festival >/dev/null || { echo "$0: festival is missing" >&2; exit 2; }
case $voice in
  lp_*|pc_*|hy_fi_*|upc_ca_*) letters=ISO-8859-1 ;;
  czech_*) letters=ISO-8859-2 ;;
  *) letters=UTF-8 ;;
esac
mkdir -p "$dir/audio" "$dir/phonemes"
# The first 60 sentences of 40 letters and more without digits, which voices and aligners read differently, brackets
# (what is not said), and quotes and dots, which Festival stumbles over.
sed 's/^\xef\xbb\xbf//; /^;/d; s/^[a-z0-9_-]*: *//; s/[[:space:]]*$//' "$list" |
  grep -v '[][<>(){}0-9"\\]\|[«»“”„…–—]\|[.][.]' | awk 'length($0) >= 40' | head -60 > "$dir/sentences.txt"
printf 'id\ttext\n' > "$dir/utterances.tsv"
{
  echo "(voice_$voice)"
  echo '(define (word_of s) (item.feat s "R:SylStructure.parent.parent.R:Token.parent.name"))'
  echo '(define (say id text)
    (let ((u (utt.synth (eval (list (quote Utterance) (quote Text) text)))) (f nil))
      (utt.save.wave u (string-append "'"$dir"'/audio/" id ".wav") (quote riff))
      (set! f (fopen (string-append "'"$dir"'/phonemes/" id ".raw") "w"))
      (mapcar (lambda (s) (format f "%f\t%f\t%s\t%s\n" (item.feat s "segment_start")
        (item.feat s "end") (item.name s) (word_of s))) (utt.relation.items u (quote Segment)))
      (fclose f)))'
  number=0
  while IFS= read -r text; do
    number=$((number + 1))
    id=$(printf 's%03d' $number)
    printf '%s\t%s\n' "$id" "$text" >> "$dir/utterances.tsv"
    printf '(unwind-protect (say "%s" "%s") nil)\n' "$id" "$(printf %s "$text" | iconv -c -f UTF-8 -t "$letters")"
  done < "$dir/sentences.txt"
} > "$dir/say.scm"
festival -b "$dir/say.scm" 2> "$dir/festival.log"
for raw in "$dir"/phonemes/*.raw; do
  { printf 'start_s\tend_s\tphone\tword\n'; iconv -c -f "$letters" -t UTF-8 "$raw"; } > "${raw%.raw}.tsv"
  rm "$raw"
done
echo "$dir: $(ls "$dir/audio" | wc -l) sentences"
