#!/bin/sh
# Valgrind has nothing to say of the examples: no read of what is not set, nothing lost; nor of two
# handles in two threads.
#   valgrind_test.sh SOURCE_DIR SPEAK DECODE TEXT_DECODER CASES TEST_C
command -v valgrind >/dev/null || { echo "SKIPPED: valgrind is missing"; exit 77; }
set -e
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
quiet="valgrind --quiet --error-exitcode=9 --leak-check=full --show-leak-kinds=all --errors-for-leak-kinds=all"
$quiet "$2" "$1/tests/data/grid_s1_sample/phonemes/prac8p.tsv" "$work/talk.fba"
$quiet "$3" "$work/talk.fba" "$work/again.fba" >"$work/weights"
for case in face_and_body bad_cut_in_values bad_garbage_between; do
  stream=$5/$case/$case.fba
  [ -f "$stream" ] || continue
  $quiet "$4" "$stream" "$work/face" "$work/body" 2>"$work/said" || [ $? -eq 1 ] ||
    { cat "$work/said"; exit 1; }
done
valgrind --tool=helgrind --quiet --error-exitcode=9 "$6" --gtest_brief=1 \
  --gtest_filter='CDecoder.Handles*'
echo "quiet"
