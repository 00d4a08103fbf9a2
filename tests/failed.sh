#!/bin/sh
# tests/failed.sh PRESET...: names and output of the tests that failed in the last run of each
# preset: at the end of a log, where it is seen, and all that is left of a log that is cut. Of a
# long output what surrounds each failure of GoogleTest, and the end.
cd "$(dirname "$0")/.."
for preset in "$@"; do
  log=build/$preset/tests.xml
  [ -f "$log" ] || continue
  awk -v preset="$preset" '
    /<testcase / { name = $0; sub(/.*<testcase name="/, "", name); sub(/".*/, "", name)
                   failed = /status="fail"/; inside = 0; n = 0; shown = 0 }
    /<system-out>/ { inside = 1; sub(/.*<system-out>/, "") }
    failed && inside { line = $0; sub(/<\/system-out>.*/, "", line); lines[n++] = substr(line, 1, 300) }
    /<\/system-out>/ { inside = 0 }
    /<\/testcase>/ && failed {
      print "== Failed (" preset "): " name
      for (i = 0; i < n; i++) {
        if (lines[i] ~ /: Failure$/) until = i + 10
        if (i < until || i >= n - 20) { if (shown++ < 200) print lines[i] }
      }
      until = 0
    }' "$log" | sed 's/&lt;/</g; s/&gt;/>/g; s/&quot;/"/g; s/&amp;/\&/g'
done
