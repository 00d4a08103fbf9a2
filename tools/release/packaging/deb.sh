#!/bin/sh
# Builds the Debian packages: copies the tree, lays tools/release/packaging/debian beside the
# sources as debian/, builds, and has lintian look at what came out (an error of it ends this one).
#   tools/release/packaging/deb.sh -o OUTDIR [-w WORK] [-j JOBS] [--check] [--symbols]
#     -o OUTDIR   where the .deb, .changes and .buildinfo files go
#     -w WORK     a folder that is kept and built in again: what has not changed is not compiled
#                 again
#     -j JOBS     commands at a time; as many as there are cores if it is not given
#     --check     runs the tests of the tree in the build
#     --symbols   also packages of debugging symbols
# ccache is used where it is installed. DEBFULLNAME and DEBEMAIL say who builds them, which becomes
# their maintainer; without, they name the authors, who have no address.
set -eu
here=$(cd "$(dirname "$0")/../../.." && pwd)
usage() {
  sed -n '/^#   /s/^#   //p' "$0" >&2
  exit 2
}
out='' work='' jobs=$(nproc) options="nocheck noautodbgsym" profiles=nocheck
while [ $# -gt 0 ]; do
  case $1 in
    -o) [ $# -gt 1 ] || usage; out=$2; shift ;;
    -w) [ $# -gt 1 ] || usage; work=$2; shift ;;
    -j) [ $# -gt 1 ] || usage; jobs=$2; shift ;;
    --check) options=$(echo "$options" | sed 's/nocheck//') profiles='' ;;
    --symbols) options=$(echo "$options" | sed 's/noautodbgsym//') ;;
    *) usage ;;
  esac
  shift
done
[ -n "$out" ] || usage
for program in dpkg-buildpackage dh lintian doxygen; do
  command -v $program >/dev/null ||
    { echo "$program is missing: run tools/setup.sh packages" >&2; exit 1; }
done
mkdir -p "$out"
out=$(cd "$out" && pwd)

if [ -z "$work" ]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work/animeme"
work=$(cd "$work" && pwd)
# The tree as it is: what git knows of it, or all but what is built where there is no git. Files
# keep their times, so that what was built before stays.
find "$work" "$work/animeme" -mindepth 1 -maxdepth 1 ! -name animeme ! -name 'obj-*' -exec rm \
  -rf {} +
if git -C "$here" rev-parse --git-dir >/dev/null 2>&1; then
  git -C "$here" ls-files -z --cached --others --exclude-standard
else
  (cd "$here" && find . \( -name build -o -name node_modules \) -prune -o -type f -print0)
fi | tar -C "$here" --null -T - -cf - | tar -C "$work/animeme" -xf -
cp -rp "$work/animeme/tools/release/packaging/debian" "$work/animeme/debian"

bogus="--suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog"
if [ -n "${DEBEMAIL:-}" ]; then
  sed -i "s|^\(Maintainer: \| -- \).* <.*@localhost>|\1${DEBFULLNAME:-$DEBEMAIL} <$DEBEMAIL>|" \
    "$work/animeme/debian/control" "$work/animeme/debian/changelog"
  bogus=''
fi

if [ ! -d "$here/tools/bindings/python" ]; then
  echo "tools/bindings/python is missing: python3-animeme is not built" >&2
  profiles="$profiles pkg.animeme.nopython"
fi
[ -d /usr/lib/ccache ] && PATH="/usr/lib/ccache:$PATH"
export PATH
(cd "$work/animeme" && DEB_BUILD_OPTIONS="$options parallel=$jobs" DEB_BUILD_PROFILES="$profiles" \
  dpkg-buildpackage --build=binary --no-sign --no-pre-clean)
# shellcheck disable=SC2086  # words
lintian --fail-on error --allow-root $bogus "$work"/*.changes
cp "$work"/*.deb "$work"/*.changes "$work"/*.buildinfo "$out"
ls -l "$out"/*.deb
