#!/bin/sh
# The names that libanimeme shows are those of exported.txt: one that goes breaks programs, one that
# comes by accident has to stay for ever.
#   exported_test.sh LIBRARY
set -e
list=$(dirname "$0")/exported.txt
nm -D --defined-only "$1" | awk '$2 != "A" {print $3}' | sed 's/@.*//' | LC_ALL=C sort |
  diff "$list" - || {
  echo "libanimeme shows other names than $list"
  exit 1
}
readelf -d "$1" | grep -q 'SONAME.*libanimeme\.so\.[0-9]*\]' || { echo "no SONAME"; exit 1; }
# Nothing but the C and C++ libraries stands below it.
readelf -d "$1" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' |
  grep -Ev '^(libstdc\+\+|libgcc_s|libm|libc|ld-linux.*)\.so' && {
  echo "libanimeme needs more than the C and C++ libraries"
  exit 1
}
echo "$(wc -l <"$list") names"
