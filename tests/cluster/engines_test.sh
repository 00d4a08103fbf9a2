#!/bin/sh
# engines_test.sh PROGRAM SOURCE: GNU parallel, make and the commands of the Kubernetes jobs make the bytes of one machine,
# also where a row is an error; the jobs are checked, by the schema of Kubernetes where it is there.
# Exit code 77: something was skipped, with the reason; the rest passed.
set -u
program=$1 source=$2
tools=$source/tools/cluster
here=$source/tests/cluster
skipped=
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
fail() {
  echo "FAILED: $*"
  tail -n 20 ./*.log 2>/dev/null
  exit 1
}
equal() {
  diff -r -x '*.?-of-?.*' one "$1" || fail "$2 makes other bytes than one machine"
  [ "$(ls "$1"/index.*-of-"$3".tsv | wc -l)" = "$3" ] || fail "$2 made other shards than $3"
}

printf 'id\ttext\tlang\n' >clips.tsv
for i in 1 2 3 4 5 6 7 8 9; do printf 'clip_%s\tClip %s says hello.\ten\n' $i $i >>clips.tsv; done
printf 'broken\tNobody speaks so.\tqqq\n' >>clips.tsv
"$program" batch clips.tsv -o one --set outputs=.fba >one.log 2>&1
[ $? -eq 1 ] || fail "a row with an error has to make 1"
export ANIMEME="$program"

make -f "$tools/Makefile" -k -j2 SHARDS=3 OUT=made OPTIONS='--set outputs=.fba' >make.log 2>&1 &&
  fail "make hides that a row is an error"
equal made make 3

if command -v parallel >/dev/null && parallel --version 2>/dev/null | grep -q 'GNU parallel'; then
  PARALLEL='--will-cite --jobs 2' sh "$tools/parallel_batch.sh" 3 clips.tsv parallel --set "outputs=.fba" \
    >parallel.log 2>&1 && fail "parallel hides that a row is an error"
  equal parallel "GNU parallel" 3
else
  skipped="$skipped; GNU parallel is missing (Debian: parallel)"
fi

python=
for candidate in /usr/bin/python3 python3; do
  "$candidate" -c 'import yaml' 2>/dev/null && python=$candidate && break
done
if [ "$python" ]; then
  mkdir bin data
  ln -s "$program" bin/animeme
  cp clips.tsv data/
  job() { "$python" "$here/kubernetes.py" "$@" || fail "$*"; }
  batch=$(job "$tools/kubernetes_batch.yaml")
  join=$(job "$tools/kubernetes_join.yaml")
  for i in 0 1 2 3 4 5 6 7; do
    PATH=$dir/bin:$PATH DATA=$dir/data SHARDS=8 JOB_COMPLETION_INDEX=$i sh -c "$batch" >>kubernetes.log 2>&1 ||
      fail "the command of pod $i"
  done
  PATH=$dir/bin:$PATH DATA=$dir/data sh -c "$join" >>kubernetes.log 2>&1 && fail "the join hides that a row is an error"
  mv data/out kubernetes
  equal kubernetes "the Kubernetes job" 8
  if node -e 'require("kubernetes-models/batch/v1")' 2>/dev/null; then
    for file in "$tools"/kubernetes_*.yaml; do
      job --json "$file" >job.json
      node "$here/kubernetes_schema.js" job.json || fail "$file is not as the schema wants it"
    done
  else
    skipped="$skipped; the schema of Kubernetes is missing (npm install kubernetes-models, its node_modules in NODE_PATH)"
  fi
else
  skipped="$skipped; PyYAML is missing (Debian: python3-yaml)"
fi

[ -z "$skipped" ] || { echo "${skipped#; }: Skipped"; exit 77; }
