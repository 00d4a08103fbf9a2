#!/bin/sh
# tests/slowest.sh [PRESET [COUNT [steps]]]: the slowest steps of the last build and the slowest
# tests of the last run, in seconds of wall clock; ten of each unless COUNT is given, only the steps
# with "steps". Presets: release (the default), asan ...
folder=$(cd "$(dirname "$0")/.." && pwd)/build/${1:-release}
echo "== Slowest build steps"
awk -F'\t' 'NF >= 4 && $4 !~ /^\// { took[$4] = ($2 - $1) / 1000 }
  END { for (step in took) printf "%7.1f  %s\n", took[step], step }' "$folder/.ninja_log" | sort -rn | head -n "${2:-10}"
[ "${3:-}" != steps ] && [ -f "$folder/tests.xml" ] || exit 0
echo "== Slowest tests"
sed -nE 's/.*<testcase name="([^"]*)".* time="([0-9.]+)".*/\2 \1/p' "$folder/tests.xml" |
  sort -rn | head -n "${2:-10}" | awk '{ time = $1; $1 = ""; printf "%7.1f %s\n", time, $0 }'
