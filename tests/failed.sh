#!/bin/sh
# tests/failed.sh PRESET...: names and output of the tests that failed in the last run of each preset:
# at the end of a log, where it is seen, and all that is left of a log that is cut.
cd "$(dirname "$0")/.."
for preset in "$@"; do
  log=build/$preset/tests.xml
  [ -f "$log" ] || continue
  awk -v preset="$preset" '
    /<testcase / { name = $0; sub(/.*<testcase name="/, "", name); sub(/".*/, "", name)
                   failed = /status="fail"/; inside = 0; n = 0 }
    /<system-out>/ { inside = 1; sub(/.*<system-out>/, "") }
    failed && inside { line = $0; sub(/<\/system-out>.*/, "", line); lines[n++] = line }
    /<\/system-out>/ { inside = 0 }
    /<\/testcase>/ && failed {
      print "== Failed (" preset "): " name
      for (i = n > 60 ? n - 60 : 0; i < n; i++) print lines[i]
    }' "$log" | sed 's/&lt;/</g; s/&gt;/>/g; s/&quot;/"/g; s/&amp;/\&/g'
done
