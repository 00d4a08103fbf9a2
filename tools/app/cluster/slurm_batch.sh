#!/bin/sh
# A batch as a Slurm job array: a task a shard, and behind all of them a job that joins.
#
#   sh slurm_batch.sh SHARDS MANIFEST OUT [OPTIONS of animeme batch]
#   sh slurm_batch.sh 8 clips.tsv out --set outputs=.fba
#   SBATCH="--partition=day --cpus-per-task=4" sh slurm_batch.sh ...    # options of sbatch for both
#                                                                       jobs
#   ANIMEME=/opt/animeme/bin/animeme sh slurm_batch.sh ...              # else animeme of PATH
#
# Manifest, inputs and OUT lie in a folder that all nodes see. It prints the ids of both jobs, the
# array's first. Logs: OUT.logs/.
# A task whose program is killed (memory, time, a node) goes back into the queue, three times at
# most, and does only what is missing. The join comes when all tasks have ended: it tells what is
# missing, fails then, and can be done again by hand: animeme batch MANIFEST -o OUT --join. Rows
# with errors are rows of the index.
set -eu
[ $# -ge 3 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0"; exit 2; }
role=$1 manifest=$2 out=$3
shift 3

case $role in
  shard)  # in a task of the array
    status=0
    "${ANIMEME:-animeme}" batch "$manifest" -o "$out" "$@" \
      --resume --jobs "${SLURM_CPUS_PER_TASK:-1}" \
      --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" || status=$?
    if [ $status -gt 128 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 3 ]; then
      echo "killed (status $status), again" >&2
      scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    fi
    exit $status ;;
  join)  # behind the array
    exec "${ANIMEME:-animeme}" batch "$manifest" -o "$out" "$@" --join ;;
esac

mkdir -p "$out.logs"
# shellcheck disable=SC2086  # words are meant
array=$(sbatch --parsable --requeue --job-name=animeme --array="1-$role" --open-mode=append \
  --output="$out.logs/shard_%a.log" ${SBATCH:-} "$0" shard "$manifest" "$out" "$@")
echo "$array"
# A single shard is the whole: it has nothing to join.
[ "$role" -gt 1 ] || exit 0
# shellcheck disable=SC2086
sbatch --parsable --job-name=animeme_join --dependency="afterany:${array%%;*}" --open-mode=append \
  --output="$out.logs/join.log" ${SBATCH:-} "$0" join "$manifest" "$out" "$@"
