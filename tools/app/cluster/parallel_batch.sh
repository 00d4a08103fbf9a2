#!/bin/sh
# A batch by GNU parallel (Debian: parallel): a job a shard, on this machine or over ssh on others.
#
#   sh parallel_batch.sh SHARDS MANIFEST OUT [OPTIONS of animeme batch]
#   sh parallel_batch.sh 8 clips.tsv out --set outputs=.fba
#   PARALLEL="--sshloginfile nodes --workdir . --jobs 1" sh parallel_batch.sh ...    # machines, one
#                                                                                    a line in
#                                                                                    "nodes"
#   ANIMEME=/opt/animeme/bin/animeme sh parallel_batch.sh ...                        # else animeme
#                                                                                    of PATH
#
# On one machine `animeme batch` has all cores by itself: this is for several, which see one folder
# (the same path). A shard that fails or is killed comes again, twice at most, and does only what is
# missing; so does all of it when it is started again.
set -eu
[ $# -ge 3 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0"; exit 2; }
shards=$1 manifest=$2 out=$3
shift 3
program=${ANIMEME:-animeme}

# Rows with errors make 1: the join tells them.
seq "$shards" | parallel --quote --retries 3 --line-buffer --tag \
  "$program" batch "$manifest" -o "$out" "$@" --resume --shard "{}/$shards" || [ $? -le 101 ]
# A single shard is the whole: it has nothing to join.
[ "$shards" -gt 1 ] || exit 0
exec "$program" batch "$manifest" -o "$out" "$@" --join
