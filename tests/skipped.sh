#!/bin/sh
# tests/skipped.sh LOG...: why tests were skipped, from logs of ctest, with the number of tests.
awk '
  waits { if ($0 != "") { count[$0]++; total++ } waits = 0 }
  /: Skipped$/ { waits = 1 }
  END {
    if (!total) { print "== No test was skipped"; exit }
    print "== Skipped tests: " total
    for (why in count) printf "%4d  %s\n", count[why], why
  }' "$@" </dev/null
