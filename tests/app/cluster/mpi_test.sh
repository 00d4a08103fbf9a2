#!/bin/sh
# mpi_test.sh PROGRAM SOURCE: train --mpi makes the bytes of one process by any number of them, and
# an error of one is the end of all, by its message and exit code. Exit code 77: skipped, with the
# reason.
set -u
program=$1 source=$2
skip() {
  printf 'mpi: Skipped\n%s\n' "$*"
  exit 77
}
fail() {
  echo "FAILED: $*"
  tail -n 20 ./*.log 2>/dev/null
  exit 1
}
[ -e "$(dirname "$program")/animeme_mpi.so" ] || skip "built without MPI (Debian: libopenmpi-dev)"
command -v mpirun >/dev/null || skip "mpirun is missing (Debian: openmpi-bin)"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
cp -r "$source/tests/data/grid_s1_sample" corpus
# As root, more processes than cores, on this machine alone.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
options="--dominance builtin --ridge-factor 1 --controls 3-13"
# train COUNT: by so many processes.
train() {
  # shellcheck disable=SC2086  # words are meant
  timeout 200 mpirun -n "$1" "$program" train corpus --mpi $options -o "$1.dam" >"$1.log" 2>&1
}

# shellcheck disable=SC2086
"$program" train corpus --accumulate one.stats ${options%--ridge*} --controls 3-13 >one.log 2>&1 &&
  "$program" train --merge one.stats --ridge-factor 1 -o one.dam >>one.log 2>&1 ||
    fail "one process by files"
for count in 1 2 3; do
  train $count || fail "$count processes"
  cmp one.dam $count.dam || fail "$count processes make another model"
done

for part in 1/2 2/2; do
  # shellcheck disable=SC2086
  "$program" train corpus --accumulate "part_${part%/2}.stats" --shard $part ${options%--ridge*} \
    --controls 3-13 \
    >parts.log 2>&1 || fail "shard $part"
done
"$program" train --merge part_2.stats part_1.stats --ridge-factor 1 \
  -o parts.dam >>parts.log 2>&1 || fail "shards"
cmp one.dam parts.dam || fail "shards make another model"

# A sentence that cannot be read.
first=$(ls corpus/phonemes | head -n 1)
printf 'start_s\tend_s\tphone\n0\t1\tQQ\n' >"corpus/phonemes/$first"
rm -f 2.dam
train 2
status=$?
[ $status -eq 3 ] || fail "an error of one process makes $status, not 3"
grep -q "animeme: error: .*$first" 2.log || fail "the error does not name the file"
[ ! -e 2.dam ] || fail "a model of half of the corpus"
