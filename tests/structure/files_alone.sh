#!/bin/sh
# tests/structure/files_alone.sh COMPILER: the presets release and asan compile many files as one,
# which hides an include that a file lacks. This looks at files alone (-fsyntax-only): those of one
# of 64 turns, by the day of the last commit, so that two months of work pass them all.
#   ANIMEME_FILES=all     all of them, on all cores (some minutes)
#   ANIMEME_FILES=7       that turn
set -eu
compiler=${1:-c++}
cd "$(dirname "$0")/../.."
day=$(git log -1 --format=%ct 2>/dev/null || date +%s)
turn=${ANIMEME_FILES:-$((day / 86400 % 64))}
every=64 jobs=1
[ "$turn" = all ] && every=1 turn=0 jobs=$(nproc)
flags="-std=c++20 -fsyntax-only -Wall -Wextra -Wshadow -Werror -Wno-missing-field-initializers -I.
  $(pkg-config --cflags-only-I --silence-errors eigen3 libxml-2.0 espeak-ng | sed 's/-I/-isystem /g')
  -isystem /usr/include/pocketsphinx -DANIMEME_SOURCE_DIR=\"\" -DANIMEME_BINARY_DIR=\"\" -DANIMEME_VERSION=\"\"
  -DANIMEME_VERSION_NUMBER=0 -DANIMEME_SPEAKS=1 -DANIMEME_MODULE_FOLDER=\"\""
# The header of the C interface is included as it is installed.
installed=$(mktemp -d)
trap 'rm -rf "$installed"' EXIT
mkdir "$installed/animeme" && ln -s "$PWD/tools/bindings/c/animeme.h" "$installed/animeme/"
# This one the build makes.
mkdir -p "$installed/tools/view/studio"
echo '#include <string_view>
namespace animeme::studio { inline constexpr std::string_view kHeadBuild = "none"; }' >"$installed/tools/view/studio/head_build.h"
flags="$flags -I$installed"
# The Python module, where there is what it stands on.
python=tools/bindings/python
if pkg-config --exists python3 && [ -f /usr/include/pybind11/pybind11.h ]; then
  python=none
  flags="$flags $(pkg-config --cflags-only-I python3 | sed 's/-I/-isystem /g')"
fi
# Modules likewise: those that gst/gst.h and mpi.h are for.
webrtc=tools/live/webrtc/detail mpi=tools/app/mpi/module.cpp
if pkg-config --exists gstreamer-webrtc-1.0 gstreamer-sdp-1.0 gstreamer-app-1.0 libcurl; then
  webrtc=none
  flags="$flags $(pkg-config --cflags-only-I gstreamer-webrtc-1.0 gstreamer-sdp-1.0 gstreamer-app-1.0 libcurl | sed 's/-I/-isystem /g')"
fi
if pkg-config --exists ompi; then
  mpi=none
  flags="$flags $(pkg-config --cflags-only-I ompi | sed 's/-I/-isystem /g') -DOMPI_SKIP_MPICXX"
fi
files=$(find fap codec dam conformance tools tests -name '*.cpp' ! -name '*_absent.cpp' ! \
  -path '*/node_modules/*' \
  ! -path 'tests/release/package/*' ! -path 'tools/characters/trackers/dlib/*' ! \
    -path "$python/*" ! -path "$webrtc/*" ! -path "$mpi" | sort |
    awk -v every="$every" -v turn="$turn" 'NR % every == turn % every')
echo "$(echo "$files" | wc -l) files"
# shellcheck disable=SC2086  # lists of words are meant
echo "$files" | xargs -P "$jobs" -n 4 "$compiler" $flags
