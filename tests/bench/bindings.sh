#!/bin/sh
# The codec by its bindings, side by side: what each weighs, and how many planes of one stream it
# decodes in a second of the CPU (66 FAPs a plane, in pieces of 100 bytes; each for a second, three
# times in turns, the best). What is not built has no row.
#   bindings.sh BUILD_DIR [NPM_BUILD_DIR]
set -eu
build=$1 npm=${2:-build/npm}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stream=$work/wide.fba
"$build/bin/bindings_table" --make "$stream"
package=$npm/tools/bindings/npm/package

python() {
  [ -d "$build/python/animeme" ] || return 0
  PYTHONPATH=$build/python /usr/bin/python3 -B - "$stream" <<'PYTHON'
import sys, time
import animeme

stream = open(sys.argv[1], "rb").read()

def decode():
    decoder, planes = animeme.Decoder(), 0
    for at in range(0, len(stream), 100):
        decoder.push(stream[at:at + 100])
        for plane in decoder:
            planes += 1
    return planes

for name, run in ("Python, plane by plane", decode), ("Python, whole", lambda: len(animeme.decode(stream))):
    planes, begin = 0, time.process_time()
    while time.process_time() - begin < 1:
        planes += run()
    print(f"{name}\t{planes / (time.process_time() - begin):.0f}")
PYTHON
}

web() {
  [ -f "$package/wasm/decoder.wasm" ] || return 0
  cat >"$work/decode.mjs" <<'NODE'
import {readFileSync} from 'node:fs';
const [, , place, file] = process.argv;
const {ready, Decoder} = await import(place);
await ready();
const stream = new Uint8Array(readFileSync(file));
const cpu = () => process.cpuUsage().user / 1e6;
let planes = 0;
const begin = cpu();
while (cpu() - begin < 1) {
  const decoder = new Decoder();
  for (let at = 0; at < stream.length; at += 100) {
    decoder.push(stream.subarray(at, at + 100));
    for (const frame of decoder) planes += frame ? 1 : 0;
  }
  decoder.free();
}
console.log(`WebAssembly in node\t${Math.round(planes / (cpu() - begin))}`);
NODE
  node "$work/decode.mjs" "$(realpath "$package")/src/node.js" "$stream"
}

# shellcheck disable=SC2034  # three times
for turn in 1 2 3; do
  "$build/bin/bindings_table" "$stream"
  python
  web
done >"$work/speeds"

# weight FILE...: stripped, and that by gzip -9, in kB.
weight() {
  for file in "$@"; do
    case $file in
      *.so*) strip -o "$work/stripped" "$file" && cat "$work/stripped" ;;
      *) cat "$file" ;;
    esac
  done >"$work/all"
  printf '%s kB, %s kB packed' "$(($(wc -c <"$work/all") / 1000))" \
    "$(($(gzip -9 -c "$work/all" | wc -c) / 1000))"
}

echo "| decoder | planes a second | of C++ | weight |"
echo "|---|---|---|---|"
sort -t "$(printf '\t')" -k1,1 -k2,2nr "$work/speeds" | awk -F '\t' '!seen[$1]++' |
  sort -t "$(printf '\t')" -k2,2nr >"$work/best"
cpp=$(awk -F '\t' '$1 == "C++" {print $2}' "$work/best")
while IFS="$(printf '\t')" read -r name speed; do
  case $name in
    C++) what="in your program" ;;
    C) what="\`libanimeme.so\` (with speech): $(weight "$(realpath "$(ls "$build"/tools/bindings/c/libanimeme.so* "$build"/lib/libanimeme.so* 2>/dev/null | head -1)")")" ;;
    Python*) what="the module (with all of the tools): $(weight "$build"/python/animeme/_animeme*.so)" ;;
    Web*) what="\`decoder.wasm\` and its scripts: $(weight "$package/wasm/decoder.wasm" "$package"/src/[!es]*.js)" ;;
  esac
  echo "| $name | $speed | $(awk "BEGIN {printf \"%.0f %%\", 100 * $speed / $cpp}") | $what |"
done <"$work/best"
