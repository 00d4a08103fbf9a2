#!/bin/sh
# steps.sh as an ordinary user with sudo in a fresh minimal Debian, which has nothing but git: what
# a reader of README.md sees, with what hello.sh downloads and installs.
#   tests/release/readme/clean_root.sh [all]
# Packages come from where apt of this machine has its own. Wants mmdebstrap, and to be root or to
# have user namespaces.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
suite=bookworm

inside() {
  root=$1
  echo 'somebody:x:1000:1000::/home/somebody:/bin/bash' >>"$root/etc/passwd"
  # Without it sudo refuses the account.
  echo 'somebody:*:19000:0:99999:7:::' >>"$root/etc/shadow"
  echo 'somebody ALL=(ALL) NOPASSWD: ALL' >"$root/etc/sudoers.d/somebody"
  mkdir -p "$root/home/somebody"
  cp -r "$CLONE" "$root/home/somebody/animeme"
  chown -R 1000:1000 "$root/home/somebody"
  before=$(chroot "$root" dpkg-query -W | wc -l)
  chroot "$root" setpriv --reuid=1000 --regid=1000 --clear-groups env \
    -i HOME=/home/somebody USER=somebody LANG=C.UTF-8 \
    PATH=/usr/local/bin:/usr/bin:/bin TERM=dumb sh \
      -c "cd ~/animeme && tests/release/readme/steps.sh $STEPS"
  archives=$(du -sm "$root/var/cache/apt/archives" | cut -f1)
  echo "$(($(chroot "$root" dpkg-query -W | wc -l) - before)) packages installed, $archives MB of downloads"
}

if [ "${1:-}" = --inside ]; then
  inside "$2"
  exit
fi
command -v mmdebstrap >/dev/null ||
  { echo "mmdebstrap is missing: tools/setup.sh packages" >&2; exit 77; }
STEPS=${1:-}
CLONE=$(mktemp -d)/animeme
trap 'rm -rf "$(dirname "$CLONE")"' EXIT
export CLONE STEPS
git clone -q "$top" "$CLONE"
sources=$(grep -lsE "(^|[ :])$suite( |$)" /etc/apt/sources.list /etc/apt/sources.list.d/*.list \
  /etc/apt/sources.list.d/*.sources || true)
# shellcheck disable=SC2086  # words
mmdebstrap --quiet --variant=apt --include=sudo,git --format=null \
  --aptopt='APT::Keep-Downloaded-Packages "true"' \
  --customize-hook="'$here/clean_root.sh' --inside \"\$1\"" $suite /dev/null $sources
