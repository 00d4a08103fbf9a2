#!/bin/sh
# All attacks on the program, on loopback:  tests/attack/run.sh [PROGRAM]
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${1:-$here/../../build/release/bin/animeme}")
failed=
for attack in "waits.py" "memory.py --all" "files.py --number 2000" "net.py --seconds 60" \
  "text.py"; do
  set -- $attack
  script=$1
  shift
  echo "== $attack"
  python3 "$here/$script" "$program" "$@" || [ $? = 77 ] || failed="$failed $script"
done
[ -z "$failed" ] || { echo "failed:$failed"; exit 1; }
