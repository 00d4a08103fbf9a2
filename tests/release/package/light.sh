#!/bin/sh
# The program alone is light: it is linked with the C++ library and small libraries only, works on
# streams without its modules, and names the Debian packages to install where it needs one.
#   light.sh BIN_DIR WORK_DIR
# WORK_DIR is made anew.
set -eu
bin=$1 work=$2
fail() {
  echo "$1"
  exit 1
}
needed() {
  readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'
}

# With all that they depend on, these are 12 MB more than a minimal Debian.
small='libstdc++ libm libgcc_s libc ld-linux-x86-64 ld-linux-aarch64 ld-linux libz libexpat libpng16 libjpeg libwebp libwebpmux
  libmeshoptimizer libdraco libwebsockets libatomic libdl libpthread'
for object in $(needed "$bin/animeme"); do
  found=''
  for one in $small; do [ "${object%%.so*}" != "$one" ] || found=yes; done
  [ -n "$found" ] || fail "animeme is linked with $object: load it late (tools/app/late/README.md)"
done

rm -rf "$work"
mkdir -p "$work"
cp "$bin/animeme" "$work"
cd "$work"

# refuses PACKAGE COMMAND...: it fails, and says which package to install.
refuses() {
  package=$1
  shift
  ! "$@" >said 2>&1 || fail "$* works without its module"
  grep -q "apt install.* $package\b" said || fail "$* does not name $package: $(cat said)"
}
printf 'start_s\tend_s\tphone\tword\n0.2\t0.3\tHH\thello\n0.3\t0.4\tAH\thello\n0.4\t0.5\tL\thello\n0.5\t0.7\tOW\thello\n' >script.tsv
./animeme speak --script script.tsv -o said.fba
./animeme decode said.fba -o said.fap
./animeme encode said.fap -o again.fba
./animeme compare said.fap again.fba
./animeme info said.fba | grep -q open_jaw
./animeme render said.fba --sheet 2x1 --size 60x60 -o sheet.png
./animeme head woman -o mask.fdp
refuses libespeak-ng1 ./animeme speak --text hello -o no.fba
refuses espeak-ng-data ./animeme phones --lang de
refuses libavformat59 ./animeme speak --script script.tsv -o no.mp4
refuses libxml2 ./animeme render said.fba --head mask.fdp --sheet 2x1 -o no.png
for file in no.*; do [ ! -e "$file" ] || fail "$file was written"; done

# Text is spoken without the tables of languages; what is not ASCII with a warning.
cp "$bin/animeme_espeak.so" .
if ./animeme speak --text hello -o voiced.fba 2>said; then
  ! grep -q 'apt install' said || fail "$(cat said)"
  ./animeme speak --lang de --text Grüße -o voiced.fba 2>said
  grep -q 'warning: .*apt install.* libicu72\b' said ||
    fail "no warning that ICU is missing: $(cat said)"
fi
rm animeme_espeak.so

# The packages that are named bring all that the modules are linked with.
for module in "$bin"/animeme_*.so; do
  name=$(basename "$module")
  packages=$(./animeme --version --verbose |
    sed -n "s/^  $name .*: not found: apt install \([^(]*\) (.*/\1/p")
  [ -n "$packages" ] || fail "--version --verbose does not say what $name needs"
  grep -qs '^PRETTY_NAME="Debian GNU/Linux 12' /etc/os-release || continue
  # shellcheck disable=SC2086  # words
  apt-cache depends --recurse --installed --no-recommends --no-suggests --no-conflicts --no-breaks \
    --no-replaces \
    --no-enhances $packages libstdc++6 2>/dev/null | grep '^[a-z]' >closure || continue
  for object in $(needed "$module"); do
    path=$(ldd "$module" | sed -n "s|.*$object => \(/[^ ]*\) .*|\1|p")
    [ -n "$path" ] || continue
    owners=$(dpkg -S "*/$(basename "$path")" 2>/dev/null | sed 's/:.*//' | sort -u)
    [ -z "$owners" ] || echo "$owners" | grep -qxF -f closure ||
      fail "$name needs $object of $owners, which apt install $packages does not bring"
  done
done
echo "linked with $(needed "$bin/animeme" | wc -l) objects"
