#!/bin/sh
# What is linked is known: `animeme --version --verbose` names every shared object that the program
# and its modules need, with a licence, and so do the SPDX documents of the packages.
#   licences.sh BIN_DIR SPDX_DIR LIBRARIES_TSV LIBANIMEME
set -eu
bin=$1 spdx=$2 table=$3 library=$4
said=$("$bin/animeme" --version --verbose --json)
fail() {
  echo "$1"
  exit 1
}
# needed FILE: the names of what it needs.
needed() {
  readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'
}
count=0
for file in "$bin/animeme" "$bin"/animeme_*.so; do
  for object in $(needed "$file"); do
    stem=${object%%.so*}
    case $object in ld-linux*) stem=ld-linux ;; esac
    echo "$said" | grep -q "\"file\": \"$stem[.-]" ||
      fail "--version --verbose does not know $object of $file"
    grep -q "^PackageFileName: $object\$" "$spdx/animeme.spdx" ||
      fail "animeme.spdx does not know $object of $file"
    count=$((count + 1))
  done
done
for object in $(needed "$library"); do
  grep -q "^PackageFileName: $object\$" "$spdx/libanimeme0.spdx" ||
    fail "libanimeme0.spdx does not know $object"
done
[ $count -gt 20 ] || fail "only $count objects"
! echo "$said" | grep -E '"licence[a-z_]*": "(NOASSERTION|FFmpeg|)"' || fail "no licence"
! grep -E '^PackageLicense(Concluded|Declared):.*(NOASSERTION|FFmpeg)' "$spdx"/*.spdx ||
  fail "no licence"
# Documents hang together: packages are whole, and relationships are between those that are there.
for document in "$spdx"/*.spdx; do
  awk '/^PackageName:/ {names++} /^PackageDownloadLocation:/ {places++} /^PackageLicenseConcluded:/ {licences++}
    /^SPDXID:/ {if ($2 in ids || $2 !~ /^SPDXRef-[A-Za-z0-9.-]+$/) bad = $2; ids[$2]}
    /^Relationship:/ {from[NR] = $2; to[NR] = $4}
    END {for (line in from) if (!(from[line] in ids) || !(to[line] in ids)) bad = from[line] " " to[line]
      if (bad != "" || names < 2 || places != names || licences != names) {print FILENAME ": " bad; exit 1}}' "$document"
done
# FFmpeg says how it was configured, espeak-ng is what decides.
echo "$said" | grep -q '"licence_as_linked": "GPL-3.0-or-later"' ||
  fail "espeak-ng is linked, and does not decide"
if command -v ffmpeg >/dev/null; then
  case $(ffmpeg -hide_banner -L | tr '\n' ' ') in
    *"GNU General Public License"*"version 3"*) licence=GPL-3.0-or-later ;;
    *"GNU General Public License"*"version 2"*) licence=GPL-2.0-or-later ;;
    *) licence=LGPL ;;
  esac
  "$bin/animeme" --version --verbose | grep -q "libavcodec .* $licence" ||
    fail "ffmpeg says $licence"
fi
# The words of the table are SPDX's, and its lines whole.
awk -F '\t' \
  '!/^#/ && (NF < 5 || NF > 6 || $3 == "") {print FILENAME ", line " NR ": " NF " columns"; bad = 1}
  END {exit bad}' "$table"
echo "$count objects"
