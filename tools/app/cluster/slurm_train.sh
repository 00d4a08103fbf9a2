#!/bin/sh
# A training as a Slurm job array: a task for the sums of each part of a corpus, and behind all of
# them, if all went well, a job that makes the model of them.
#
#   sh slurm_train.sh MODEL.dam SUMS CORPUS... [-- OPTIONS of animeme train for the sums]
#   sh slurm_train.sh large.dam sums corpus/a corpus/b corpus/c -- --dominance base.dam
#   SBATCH and ANIMEME: as in slurm_batch.sh.
#
# CORPUS are folders that all nodes see; SUMS is a folder for the sums, one file a part, and the
# logs. Prints the ids of both jobs, the array's first. The model is, byte for byte, that of one
# machine that takes all of it. A task that is killed goes back into the queue and counts no
# sentence twice; so does all of it when it is sent again.
set -eu
[ $# -ge 3 ] || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0"; exit 2; }
program=${ANIMEME:-animeme}

case $1 in
  --part)  # in a task of the array: --part SUMS CORPUS... [-- OPTIONS]
    sums=$2
    shift 2
    shift $((SLURM_ARRAY_TASK_ID - 1))
    corpus=$1
    while [ $# -gt 0 ] && [ "$1" != -- ]; do shift; done
    [ $# -eq 0 ] || shift
    status=0
    "$program" train "$corpus" --accumulate "$sums/part_$SLURM_ARRAY_TASK_ID.stats" "$@" ||
      status=$?
    if [ $status -gt 128 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 3 ]; then
      echo "killed (status $status), again" >&2
      scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
    fi
    exit $status ;;
  --merge)  # behind the array: --merge SUMS MODEL PARTS
    sums=$2 model=$3 parts=$4
    set --
    for part in $(seq "$parts"); do set -- "$@" "$sums/part_$part.stats"; done
    exec "$program" train --merge "$@" -o "$model" ;;
esac

model=$1 sums=$2
shift 2
parts=0
for word in "$@"; do
  [ "$word" != -- ] || break
  parts=$((parts + 1))
done
mkdir -p "$sums"
# shellcheck disable=SC2086  # words are meant
array=$(sbatch --parsable --requeue --job-name=animeme_sums --array="1-$parts" --open-mode=append \
  --output="$sums/part_%a.log" ${SBATCH:-} "$0" --part "$sums" "$@")
echo "$array"
# shellcheck disable=SC2086
sbatch --parsable --job-name=animeme_merge --dependency="afterok:${array%%;*}" --open-mode=append \
  --output="$sums/merge.log" ${SBATCH:-} "$0" --merge "$sums" "$model" "$parts"
