#!/bin/sh
# clean_root.sh FOLDER COMMAND...: runs COMMAND where g++, cmake and ninja are installed as ever,
# and of the development files of all other packages nothing: no headers, no libraries to link, no
# modules of CMake or pkg-config. FOLDER is for its links. Exits with 77 where that cannot be had:
# without dpkg, or without user namespaces.
set -eu
folder=$1
shift
skip() {
  echo "Skipped: $1"
  exit 77
}
command -v apt-cache >/dev/null || skip "the clean root is made of Debian's packages"
unshare -rm true 2>/dev/null || skip "a clean root needs user namespaces (unshare -rm)"
lib=/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH 2>/dev/null || gcc -print-multiarch)

rm -rf "$folder"
mkdir -p "$folder/include" "$folder/lib" "$folder/empty" "$folder/all/include" "$folder/all/lib"
# What these packages stand on, with all of their files.
apt-cache depends --recurse --installed --no-recommends --no-suggests --no-conflicts --no-breaks \
  --no-replaces \
  --no-enhances g++ cmake ninja-build | grep '^[a-z]' | sort -u >"$folder/packages"
# shellcheck disable=SC2046  # one package a word
dpkg -L $(cat "$folder/packages") 2>/dev/null | sed 's|^/lib/|/usr/lib/|' | sort -u >"$folder/files"

# keep FROM TO: links in TO to what the packages have of FROM, and to what is only there to run.
keep() {
  ls -d "$1"/* | grep -xF -f "$folder/files" >"$folder/kept" || true
  ls -d "$1"/*.so.* >>"$folder/kept" 2>/dev/null || true
  sort -u "$folder/kept" | sed "s|^$1/|$folder/all/$2/|" | xargs ln -s -t "$folder/$2"
}
keep /usr/include include
keep "$lib" lib
rm -f "$folder/lib/pkgconfig" "$folder/lib/cmake"
export folder lib
exec unshare -rm sh -eu -c '
  mount --bind /usr/include "$folder/all/include"
  mount --bind "$lib" "$folder/all/lib"
  mount --bind "$folder/include" /usr/include
  for hidden in /usr/lib/cmake /usr/share/cmake /usr/share/eigen3 /usr/share/pkgconfig /usr/lib/pkgconfig /usr/local/include \
    /usr/local/lib; do
    [ ! -d $hidden ] || mount --bind "$folder/empty" $hidden
  done
  mount --bind "$folder/lib" "$lib"
  for hidden in /usr/include/eigen3 /usr/include/nlohmann /usr/include/libxml2 /usr/include/zlib.h "$lib/libz.so"; do
    [ ! -e $hidden ] || { echo "the root is not clean: $hidden"; exit 1; }
  done
  exec "$@"' sh "$@"
