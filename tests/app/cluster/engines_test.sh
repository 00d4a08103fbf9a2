#!/bin/sh
# engines_test.sh PROGRAM SOURCE make|parallel|kubernetes|schema: the batch of tools/app/cluster by
# this engine makes the bytes of one machine, also where a row is an error. Kubernetes: the commands
# of its jobs, pod by pod, without it; schema: its jobs by its own schema. Exit code 77: skipped,
# with the reason.
set -u
program=$1 source=$2 engine=$3
tools=$source/tools/app/cluster
skip() {
  printf '%s: Skipped\n%s\n' "$engine" "$*"
  exit 77
}
fail() {
  echo "FAILED: $*"
  tail -n 20 ./*.log 2>/dev/null
  exit 1
}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1

# What is missing.
python=
case $engine in
  make) command -v make >/dev/null || skip "make is missing (Debian: make)" ;;
  parallel)
    parallel --version 2>/dev/null | grep -q 'GNU parallel' ||
      skip "GNU parallel is missing (Debian: parallel)" ;;
  kubernetes | schema)
    for candidate in /usr/bin/python3 python3; do
      "$candidate" -c 'import yaml' 2>/dev/null && python=$candidate && break
    done
    [ "$python" ] || skip "PyYAML is missing (Debian: python3-yaml)" ;;
esac
# The command of a job, or with --json the job.
job() { "$python" "$source/tests/app/cluster/kubernetes.py" "$@" || fail "$*"; }

if [ "$engine" = schema ]; then
  node -e 'require("kubernetes-models/batch/v1")' 2>/dev/null ||
    skip "the schema of Kubernetes is missing (npm install kubernetes-models, its node_modules in NODE_PATH)"
  for file in "$tools"/kubernetes_*.yaml; do
    job --json "$file" >job.json
    node "$source/tests/app/cluster/kubernetes_schema.js" job.json ||
      fail "$file is not as the schema wants it"
  done
  exit 0
fi

printf 'id\ttext\tlang\n' >clips.tsv
for i in 1 2 3 4 5 6 7 8 9; do printf 'clip_%s\tClip %s says hello.\ten\n' $i $i >>clips.tsv; done
printf 'broken\tNobody speaks so.\tqqq\n' >>clips.tsv
"$program" batch clips.tsv -o one --set outputs=.fba >one.log 2>&1
[ $? -eq 1 ] || fail "a row with an error has to make 1"

export ANIMEME="$program"
shards=3 status=0
case $engine in
  make)
    make -f "$tools/Makefile" -k -j2 SHARDS=3 OPTIONS='--set outputs=.fba' >engine.log 2>&1 ||
      status=$? ;;
  parallel)
    PARALLEL='--will-cite --jobs 2' sh "$tools/parallel_batch.sh" 3 clips.tsv out \
      --set outputs=.fba >engine.log 2>&1 ||
      status=$? ;;
  kubernetes)
    mkdir bin
    ln -s "$program" bin/animeme
    PATH=$dir/bin:$PATH DATA=$dir SHARDS=8
    export PATH DATA SHARDS
    shards=8
    batch=$(job "$tools/kubernetes_batch.yaml")
    for i in 0 1 2 3 4 5 6 7; do
      JOB_COMPLETION_INDEX=$i sh -c "$batch" >>engine.log 2>&1 || fail "the command of pod $i"
    done
    sh -c "$(job "$tools/kubernetes_join.yaml")" >>engine.log 2>&1 || status=$? ;;
  *) fail "no engine: $engine" ;;
esac
[ $status -ne 0 ] || fail "that a row is an error is hidden"
diff -r -x '*.?-of-?.*' one out || fail "other bytes than one machine's"
found=$(find out -name "index.*-of-$shards.tsv" | wc -l)
[ "$found" = $shards ] || fail "$found shards, not $shards"
