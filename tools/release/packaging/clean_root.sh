#!/bin/sh
# Tries packages in a fresh minimal Debian where nothing else is, as an ordinary user: codes with
# what `animeme` depends on, speaks with what it recommends, opens the manual, completes a line, and
# links a program, imports the module of Python if those packages are given. What is run is
# debian/tests, which autopkgtest runs, too.
#   tools/release/packaging/clean_root.sh DEB...
# Packages come from where apt of this machine has its own. Wants mmdebstrap, and to be root or to
# have user namespaces.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
suite=bookworm

# say WORDS...: on a line of its own.
say() {
  echo "== $*"
}

# has PACKAGE: whether it is among those given.
has() {
  ls "$root/debs/${1}"_*.deb >/dev/null 2>&1
}

# file PACKAGE: its path in the root.
file() {
  basename "$root/debs/${1}"_*.deb | sed 's|^|/debs/|'
}

# apt_get WORDS...: in the root, quietly unless it fails.
apt_get() {
  chroot "$root" env DEBIAN_FRONTEND=noninteractive apt-get \
    -q -y --no-install-recommends "$@" >"$root/log" 2>&1 ||
    { cat "$root/log"; exit 1; }
}

# try TESTS...: scripts of debian/tests, by somebody who is not root.
try() {
  for test in "$@"; do
    chroot "$root" setpriv --reuid=1000 --regid=1000 --clear-groups env \
      -i HOME=/home/somebody USER=somebody \
      LANG=C.UTF-8 PATH=/usr/bin:/bin TERM=dumb sh -c "cd && exec /debs/tests/$test" >"$root/log" \
        2>&1 ||
      { say "$test failed"; cat "$root/log"; exit 1; }
    say "$test: right"
  done
}

# size: what is installed, in megabytes.
size() {
  chroot "$root" dpkg-query -W -f '${Installed-Size}\n' |
    awk '{sum += $1} END {printf "%d MB, %d packages", sum / 1024, NR}'
}

inside() {
  root=$1
  echo 'somebody:x:1000:1000::/home/somebody:/bin/bash' >>"$root/etc/passwd"
  mkdir -p "$root/home/somebody" "$root/debs"
  chown 1000:1000 "$root/home/somebody"
  for deb in $debs; do cp "$deb" "$root/debs"; done
  cp -r "$here/debian/tests" "$root/debs"
  chmod -R a+rX "$root/debs"

  say "minimal root: $(size)"
  if has animeme; then
    apt_get install "$(file animeme)"
    say "animeme with what it depends on: $(size)"
    try codec without_recommends
    # By name, as apt takes them with a package that is installed anew only.
    wanted=$(chroot "$root" dpkg-query -W -f '${Recommends}' animeme |
      sed 's/([^)]*)//g; s/|[^,]*//g; s/,/ /g')
    # shellcheck disable=SC2086  # words
    apt_get install $wanted
    say "... and recommends: $(size)"
    try codec speak media
    apt_get install man-db bash-completion
    try manual completion
  fi
  if has libanimeme-dev; then
    apt_get install "$(file libanimeme0)" "$(file libanimeme-dev)" gcc libc6-dev pkg-config
    try library
  fi
  if has python3-animeme; then
    apt_get install "$(file python3-animeme)"
    try python
  fi
  if has animeme-doc; then
    apt_get install "$(file animeme-doc)"
    test -s "$root/usr/share/doc/animeme-doc/html/index.html"
  fi
  # Nothing stays behind.
  apt_get purge '?name(animeme)'
  left=$(find "$root/usr" "$root/etc" "$root/var/lib" -iname '*animeme*' ! -path '*/dpkg/*' ! \
    -path '*/apt/*')
  [ -z "$left" ] || { say "left behind: $left"; exit 1; }
  say "purged: nothing stays"
}

if [ "${1:-}" = --inside ]; then
  inside "$2"
  exit
fi
[ $# -gt 0 ] || { sed -n '/^#   /s/^#   //p' "$0" >&2; exit 2; }
command -v mmdebstrap >/dev/null || { echo "mmdebstrap is missing" >&2; exit 77; }
debs=''
for deb in "$@"; do debs="$debs $(realpath "$deb")"; done
export debs
sources=$(grep -lsE "(^|[ :])$suite( |$)" /etc/apt/sources.list /etc/apt/sources.list.d/*.list \
  /etc/apt/sources.list.d/*.sources || true)
# shellcheck disable=SC2086  # words
mmdebstrap --quiet --variant=apt --format=null \
  --customize-hook="'$here/clean_root.sh' --inside \"\$1\"" \
  $suite /dev/null $sources
say "all right"
