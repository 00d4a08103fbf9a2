#!/bin/sh
# slurm_test.sh PROGRAM SOURCE: the scripts of tools/app/cluster on a Slurm that is started for it, and stopped: a batch in
# three shards, of which one is killed in its middle, and a training in three parts make the bytes of one machine.
# Everything lies in one temporary folder. Exit code 77: skipped, with the reason.
set -u
program=$1 source=$2
skip() {
  printf 'slurm: Skipped\n%s\n' "$*"
  exit 77
}
for daemon in slurmctld slurmd munged; do
  command -v $daemon >/dev/null || PATH=$PATH:/usr/sbin:/sbin
  command -v $daemon >/dev/null || skip "$daemon is missing (Debian: slurm-wlm munge)"
done

dir=$(mktemp -d)
daemons=
stop() {
  scancel --user="$(id -un)" --quiet 2>/dev/null
  for pid in $daemons; do kill "$pid" 2>/dev/null; done
  wait
  rm -rf "$dir"
}
trap stop EXIT
trap 'exit 1' HUP INT TERM
fail() {
  echo "FAILED: $*"
  tail -n 20 "$dir"/*.log "$dir"/out.logs/* "$dir"/sums/*.log 2>/dev/null
  exit 1
}
# until_true SECONDS COMMAND...
until_true() {
  left=$(($1 * 10))
  shift
  until "$@"; do
    left=$((left - 1))
    [ $left -gt 0 ] || return 1
    sleep 0.1
  done
}

# A Slurm of one node: no cgroups, no accounting, no user but this one.
chmod 711 "$dir"  # munged wants its socket within reach
mkdir "$dir/state" "$dir/spool"
(umask 077 && head -c 128 /dev/urandom >"$dir/munge.key")
host=$(hostname -s)
start_slurm() {
  port=$((20000 + ($$ + $1 * 1999) % 6000 * 2))
  cat >"$dir/slurm.conf" <<CONF
ClusterName=sandbox
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
# Killed tasks wait until their credentials are no longer valid: as short as can be.
AuthInfo=socket=$dir/munge.socket,cred_expire=5
CredType=cred/munge
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=1,bf_interval=1,sched_min_interval=0
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
NodeName=$host NodeAddr=127.0.0.1 CPUs=4 RealMemory=1000
PartitionName=all Nodes=$host Default=YES MaxTime=10 State=UP
CONF
  export SLURM_CONF="$dir/slurm.conf"
  slurmctld -D >"$dir/slurmctld.out" 2>&1 &
  daemons="$daemons $!"
  slurmd -D -N "$host" >"$dir/slurmd.out" 2>&1 &
  daemons="$daemons $!"
  until_true 15 idle
}
idle() { [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ]; }
munged --foreground --socket="$dir/munge.socket" --key-file="$dir/munge.key" --pid-file="$dir/munged.pid" \
  --log-file="$dir/munged.log" --seed-file="$dir/munged.seed" >"$dir/munged.out" 2>&1 &
daemons=$!
until_true 5 test -S "$dir/munge.socket" || skip "munged does not start here: $(tail -n 1 "$dir"/munged.out)"
# Another program may have the ports: then again with others.
start_slurm 0 || start_slurm 1 || start_slurm 2 ||
  skip "Slurm does not start here: $(grep -h -E 'error|fatal' "$dir"/slurm*.log | tail -n 1)"

# 24 texts in three languages, each brought by a hook as from a store of objects. One of them does
# not come while the file "held" is there.
cd "$dir" || exit 1
mkdir texts
printf 'id\ttext_file\tlang\n' >clips.tsv
for lang in en de fr; do
  for i in 1 2 3 4 5 6 7 8; do
    echo "Clip $i: hello, hallo, bonjour." >"texts/$lang$i.txt"
    printf '%s/%s\tfar://%s%s.txt\t%s\n' $lang $i $lang $i $lang >>clips.tsv
  done
done
cat >bring.sh <<'BRING'
while [ "$(cat held 2>/dev/null)" = "$1" ]; do : >reached; sleep 0.1; done
exec cp "texts/${1#far://}" "$2"
BRING
cat >program.sh <<RUN
#!/bin/sh
echo \$\$ >"$dir/pid.\${SLURM_ARRAY_TASK_ID:-join}"
exec "$program" "\$@"
RUN
chmod +x program.sh
batch() { "$program" batch clips.tsv -o "$@" --set outputs=".fba .TextGrid" --fetch "sh bring.sh {uri} {file}" 2>&1; }
batch one || fail "the batch on one machine"
batch probe --shard 2/3 --jobs 1 || fail "a shard"
shard=$(($(wc -l <probe/index.2-of-3.tsv) - 1))
[ $shard -ge 4 ] || fail "a shard of $shard clips has no middle"
middle=$(sed -n "$((shard / 2 + 2))p" probe/index.2-of-3.tsv | cut -f 1)
echo "far://$(echo "$middle" | tr -d /).txt" >held

# The batch. Its second task is killed while it waits for that text, comes back and joins the others.
export ANIMEME="$dir/program.sh"
tools=$source/tools/app/cluster
jobs=$(sh "$tools/slurm_batch.sh" 3 clips.tsv out --set outputs=".fba .TextGrid" \
  --fetch "sh bring.sh {uri} {file}") || fail "sbatch of the batch"
array=$(echo "$jobs" | head -n 1)
join=$(echo "$jobs" | tail -n 1)
state() { scontrol show job "$1" --oneliner 2>/dev/null | sed 's/.*JobState=\([A-Z]*\).*/\1/'; }
ended() { case $(state "$1") in COMPLETED | FAILED | CANCELLED | TIMEOUT | NODE_FAIL) true ;; *) false ;; esac; }
until_true 60 test -e reached || fail "the task did not come to its middle"
ready=$(($(wc -l <out/index.2-of-3.tsv) - 1))
{ [ "$ready" -ge 1 ] && [ "$ready" -lt $shard ]; } || fail "$ready of $shard clips were done when it was killed"
kill -9 "$(cat pid.2)"
rm held
until_true 60 ended "$join" || fail "the batch does not end: $(state "$join")"
[ "$(state "$join")" = COMPLETED ] || fail "the join: $(state "$join")"
scontrol show job "${array}_2" --oneliner | grep -q ' Restarts=1 ' || fail "the task that was killed did not restart"
grep -q "$shard of $shard clips .* $ready of them unchanged" out.logs/shard_2.log ||
  fail "the task that came back did not do just the rest"
diff -r -x '*.?-of-3.*' one out || fail "a batch on Slurm has other bytes than one machine's"
echo "batch: $ready of $shard clips of a shard done when it was killed; $(find one -type f | wc -l) files equal"

# The training, twice, against the same parts in another order: a part that comes again counts nothing twice.
sample=$source/tests/data/grid_s1_sample
for part in 1 2 3; do
  mkdir -p "corpus/$part"
  ln -s "$sample/fap" "$sample/phonemes" "corpus/$part/"
  head -n 1 "$sample/utterances.tsv" >"corpus/$part/utterances.tsv"
  tail -n +2 "$sample/utterances.tsv" | awk -v part=$part 'NR % 3 == part - 1' >>"corpus/$part/utterances.tsv"
done
(
  for part in 3 1 2; do
    "$program" train corpus/$part --accumulate "$part.stats" --controls 3-8 || exit 1
  done
  "$program" train --merge 3.stats 1.stats 2.stats -o one.dam
) >one.log 2>&1 || fail "the training on one machine"
for time in first second; do
  rm -f slurm.dam
  jobs=$(sh "$tools/slurm_train.sh" slurm.dam sums corpus/1 corpus/2 corpus/3 -- --controls 3-8) ||
    fail "sbatch of the training"
  merge=$(echo "$jobs" | tail -n 1)
  until_true 60 ended "$merge" || fail "the training does not end: $(state "$merge")"
  [ "$(state "$merge")" = COMPLETED ] || fail "the merge: $(state "$merge")"
  cmp one.dam slurm.dam || fail "a model of Slurm has other bytes than one machine's, the $time time"
done
grep -q ' 0 sentences added, 8 were there already' sums/part_3.log || fail "sentences were counted twice"
echo "training: three parts, twice; $(wc -c <one.dam) bytes of the model equal"
