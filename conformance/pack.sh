#!/bin/sh
# Makes the committed form of the suite: a case.json for each case in cases/, and the data in two
# archives. Run it after a change of the generator, the vocabulary or a reference case.
#   conformance/pack.sh [BUILD]     BUILD: folder of a build, build/release if not given
set -eu
here=$(cd "$(dirname "$0")" && pwd)
make_cases="${1:-$here/../build/release}/bin/make_cases"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

pack() { # folder with cases, archive
  (cd "$1" && tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 \
    --exclude=case.json --no-recursion -cf - */*) | xz -9e -T1 >"$2"
}

mkdir "$work/reference" "$work/generated"
tar -C "$work/reference" -xf "$here/reference.tar.xz"
for folder in "$work"/reference/*; do cp "$here/cases/${folder##*/}/case.json" "$folder/"; done
"$make_cases" describe "$work"/reference/*
"$make_cases" generate "$work/generated"

rm -rf "$here/cases"
for folder in "$work"/reference/* "$work"/generated/*; do
  mkdir -p "$here/cases/${folder##*/}"
  cp "$folder/case.json" "$here/cases/${folder##*/}/"
done
# The bytes of an archive depend on the version of xz: those that hold the same are left alone.
update() { # name
  mkdir "$work/old"
  [ ! -f "$here/$1.tar.xz" ] || tar -C "$work/old" -xf "$here/$1.tar.xz"
  diff -rq --exclude=case.json "$work/old" "$work/$1" >/dev/null ||
    pack "$work/$1" "$here/$1.tar.xz"
  rm -r "$work/old"
}
update reference
update generated
ls -l "$here"/*.tar.xz
