#!/bin/sh
# Installs what building and running Animeme needs and a fresh Debian 12 lacks. Asks for
# nothing; uses sudo when it is not root. With "check" it only tells what is missing. With "tests"
# it also installs what the tests need: libraries, programs of others that read our files, and npm
# packages into tests/readers/js/node_modules.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)

packages="
  g++ cmake ninja-build pkg-config ca-certificates
  libeigen3-dev libcli11-dev nlohmann-json3-dev libstb-dev
  libavformat-dev libavcodec-dev libavutil-dev libswresample-dev libswscale-dev
  libwebsockets-dev zlib1g-dev libxml2-dev
  libespeak-ng-dev espeak-ng-data
  libpocketsphinx-dev libsphinxbase-dev pocketsphinx-en-us
"
# Only the tests need these.
[ "${1:-}" = "tests" ] && packages="$packages libgtest-dev libgmock-dev libbenchmark-dev ffmpeg clang-format-14"
# Without these, tests of tests/readers skip.
readers="
  mediainfo mkvtoolnix mpv chromium
  gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-plugins-bad
"

# True if node 18 or later and npm are there, from wherever.
has_node() {
  command -v npm >/dev/null &&
    node -e 'process.exit(parseInt(process.versions.node) < 18 ? 1 : 0)' 2>/dev/null
}

# Those of the packages given that are not installed.
missing_of() {
  for package in "$@"; do
    status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
    [ "$status" = "install ok installed" ] || printf ' %s' "$package"
  done
}

install_packages() {
  as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
      echo "Become root or install sudo, then run: apt-get install $*" >&2
      return 1
    }
    as_root="sudo"
  fi
  $as_root apt-get update -q
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

install_npm_packages() {
  folder="$here/tests/readers/js"
  installed="$folder/node_modules/.package-lock.json"
  [ -z "$(find "$installed" -newer "$folder/package-lock.json" 2>/dev/null)" ] || return 0
  (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1)
}

# shellcheck disable=SC2086  # lists of words are meant
missing=$(missing_of $packages)
if [ -n "$missing" ]; then
  echo "Missing Debian packages:$missing" >&2
  [ "${1:-}" = "check" ] && exit 1
  # shellcheck disable=SC2086
  install_packages $missing
fi
[ "${1:-}" = "tests" ] || exit 0

has_node || readers="$readers nodejs npm"
# shellcheck disable=SC2086
missing=$(missing_of $readers)
if [ -n "$missing" ]; then
  echo "Missing Debian packages:$missing" >&2
  # shellcheck disable=SC2086
  install_packages $missing || echo "warning: without$missing tests will skip" >&2
fi
install_npm_packages >&2 || echo "warning: without npm packages tests will skip" >&2
