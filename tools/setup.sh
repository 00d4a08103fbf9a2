#!/bin/sh
# Installs what building and running Animeme needs and a fresh Debian 12 lacks. Asks for
# nothing; uses sudo when it is not root. With "check" it only tells what is missing.
set -eu

packages="
  g++ cmake ninja-build pkg-config ca-certificates
  libeigen3-dev libcli11-dev nlohmann-json3-dev
  libavformat-dev libavcodec-dev libavutil-dev libswresample-dev
  zlib1g-dev
  libespeak-ng-dev espeak-ng-data
  libpocketsphinx-dev libsphinxbase-dev pocketsphinx-en-us
"
# Only the tests need these.
[ "${1:-}" = "tests" ] && packages="$packages libgtest-dev libgmock-dev libbenchmark-dev ffmpeg clang-format-14"

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done
if [ -z "$missing" ]; then
  exit 0
fi
echo "Missing Debian packages:$missing" >&2
[ "${1:-}" = "check" ] && exit 1

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "Become root or install sudo, then run: apt-get install$missing" >&2
    exit 1
  }
  as_root="sudo"
fi
$as_root apt-get update -q
# shellcheck disable=SC2086  # a list of words is meant
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
