#!/bin/sh
# Installs the Debian packages that Animeme needs and that are missing on a Debian 12. Asks no
# questions; uses sudo when it is not root.
#   tools/setup.sh           what the program needs to be built and to speak, show and stream
#   tools/setup.sh check     prints which of these are missing; exit code 1 if any is ("check all":
#                            also of the next line)
#   tools/setup.sh all       also what single features need: alignment and recognition of speech
#                            (English model), Chinese and Japanese readings, languages guessed by
#                            their words, Draco in glTF files
#   tools/setup.sh tests     also what tests/run.sh needs, and small programs that read our files
#   tools/setup.sh full      also what tests/run.sh full needs: clang with WebAssembly, Chromium,
#                            GStreamer, mpv, Doxygen, and npm packages in
#                            tests/readers/js/node_modules and
#                            tools/characters/trackers/mediapipe/node_modules
#   tools/setup.sh bindings  also what packages for other languages are made and tested with:
#                            Emscripten, Chromium, npm, Blender
#   tools/setup.sh site      what builds the site and looks for dead links in it
#   tools/setup.sh elsewhere compilers for WebAssembly and ARM, and what runs their programs
#   tools/setup.sh packages  what tools/release/packaging/deb.sh and clean_root.sh need
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)

# 190 MB of downloads on a minimal Debian 12: what is large or for one feature only is in
# `features`.
packages="
  g++ cmake ninja-build pkg-config
  libeigen3-dev libcli11-dev nlohmann-json3-dev libpng-dev libjpeg-dev libwebp-dev
  libtomlplusplus-dev
  libavformat-dev libavcodec-dev libavutil-dev libswresample-dev libswscale-dev
  libwebsockets-dev zlib1g-dev libxml2-dev
  libespeak-ng-dev espeak-ng-data
  libicu-dev libexpat1-dev libmeshoptimizer-dev libmecab-dev
  libpocketsphinx-dev libsphinxbase-dev libspeexdsp-dev
"
features="pocketsphinx-en-us mecab-ipadic-utf8 rime-data-pinyin-simp rime-data-terra-pinyin libcld2-dev libdraco-dev"
mode=${1:-}
case $mode in
  "" | check | all | tests | full | bindings | site | elsewhere | packages) ;;
  *) sed -n 's/^#   //p' "$0" >&2; exit 2 ;;
esac
# Only the tests need these.
case $mode in
  tests | full | bindings)
    packages="$packages ca-certificates ccache libgtest-dev libgmock-dev libbenchmark-dev" ;;
esac
case $mode in
  full) packages="$packages clang-14 libclang-rt-14-dev llvm-14 lld-14 wasi-libc libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32" ;;
esac
if [ "$mode" = packages ]; then
  packages="$packages dpkg-dev debhelper fakeroot doxygen lintian mmdebstrap libopenmpi-dev
    libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev libgstreamer-plugins-bad1.0-dev libcurl4-gnutls-dev
    dh-python python3-dev pybind11-dev python3-numpy"
fi
foreign="emscripten g++-aarch64-linux-gnu qemu-user"
[ "$mode" = elsewhere ] && packages="g++ cmake ninja-build libeigen3-dev libgtest-dev"
# Without these, tests skip and say so.
readers="curl haproxy nginx-light ffmpeg liblo-tools mediainfo mkvtoolnix clang-format-14 universal-ctags make parallel python3-yaml
  pybind11-dev python3-dev python3-pytest python3-numpy python3-matplotlib python3-pip python3-setuptools python3-wheel"
[ "$mode" = full ] &&
  readers="$readers mpv chromium doxygen slurm-wlm munge libopenmpi-dev man-db zsh fish ruby
  gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-plugins-bad gstreamer1.0-nice
  libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev libgstreamer-plugins-bad1.0-dev libcurl4-gnutls-dev"
[ "$mode" = bindings ] && readers="$readers $foreign chromium blender"

# True if node 18 or later and npm are there, from wherever.
has_node() {
  command -v node >/dev/null &&
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
  [ -n "${updated:-}" ] || $as_root apt-get update -q
  updated=yes
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

# install_npm_packages FOLDER: those of its lock file, without those that are optional.
install_npm_packages() {
  folder="$here/$1"
  installed="$folder/node_modules/.package-lock.json"
  [ -z "$(find "$installed" -newer "$folder/package-lock.json" 2>/dev/null)" ] || return 0
  (cd "$folder" && npm ci --omit=optional --ignore-scripts --no-audit --no-fund --fetch-retries=1)
}

# shellcheck disable=SC2086  # lists of words are meant
missing=$(missing_of $packages)
if [ -n "$missing" ]; then
  echo "Missing Debian packages:$missing" >&2
  [ "$mode" = check ] && exit 1
  # shellcheck disable=SC2086
  install_packages $missing
fi
[ "$mode" = elsewhere ] && features=""
[ "$mode" = check ] && [ "${2:-}" != all ] && exit 0
[ -z "$mode" ] && exit 0
# shellcheck disable=SC2086
missing=$(missing_of $features)
if [ -n "$missing" ]; then
  echo "Missing Debian packages:$missing" >&2
  [ "$mode" = check ] && exit 1
  # shellcheck disable=SC2086
  install_packages $missing || echo "warning: without$missing their features are missing" >&2
fi
case $mode in
  tests | full | bindings) ;;
  site) readers="doxygen mkdocs mkdocs-material python3-yaml chromium" ;;
  elsewhere) readers=$foreign ;;
  *) exit 0 ;;
esac

[ "$mode" = elsewhere ] || has_node || readers="$readers nodejs"
case $mode in full | bindings | site) command -v npm >/dev/null || readers="$readers npm" ;; esac
# shellcheck disable=SC2086
missing=$(missing_of $readers)
if [ -n "$missing" ]; then
  echo "Missing Debian packages:$missing" >&2
  # shellcheck disable=SC2086
  install_packages $missing || echo "warning: without$missing tests will skip" >&2
fi
folders="tests/readers/js tools/characters/trackers/mediapipe"
case $mode in
  full) ;;
  bindings | site) folders=tests/readers/js ;;
  *) exit 0 ;;
esac
for folder in $folders; do
  install_npm_packages $folder >&2 ||
    echo "warning: without npm packages of $folder tests will skip" >&2
done
