#!/usr/bin/env bash
# Runs what `relievo permute --emit slurm` writes on a Slurm of its own: munged, slurmctld and slurmd in a temporary
# folder, on ports of their own, with neither systemd nor cgroups, all stopped in the end. Compares the merged archive
# with that of a single run. Then breaks the manifest, and expects that no merge runs.
#   tests/robustness/slurm_test.sh PATH/TO/relievo
set -euo pipefail
relievo=$(realpath "$1")
shards=4
export PATH=$PATH:/usr/sbin:/sbin

for program in munged slurmctld slurmd sbatch squeue scontrol; do
  command -v $program >/dev/null || { echo "$program is not installed; tests/packages.txt names slurm-wlm and munge" >&2; exit 1; }
done

temporary=$(mktemp -d /tmp/relievo-slurm-XXXXXX) # slurm.conf takes no spaces, which TMPDIR may have
chmod 755 "$temporary" # munged's user passes through
pids=()

stop() {
  status=$?
  trap '' INT TERM
  if [ $status -ne 0 ]; then
    tail -n 15 "$temporary"/{munge,ctld,slurmd}.out "$temporary"/run/*.log "$temporary"/*/logs/*.log 2>/dev/null >&2 || true
  fi
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  for _ in $(seq 50); do
    kill -0 "${pids[@]}" 2>/dev/null || break
    sleep 0.1
  done
  for pid in "${pids[@]}"; do kill -9 "$pid" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$temporary"
  exit $status
}
trap stop EXIT
trap 'exit 1' INT TERM

fail() {
  echo "$*" >&2
  exit 1
}

# Repeats a command for up to $1 seconds, until it succeeds.
wait_for() {
  local seconds=$1 until=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $until ] || fail "'$*' does not succeed within $seconds s"
    sleep 0.2
  done
}

free_port() {
  local port
  while port=$((20000 + RANDOM % 20000)); (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
  echo "$port"
}

# Slurm's credentials come from a munged with its own key; as root it runs as the user that the package made.
start_munge() {
  local as=()
  mkdir -m 755 "$temporary/munge"
  head -c 1024 /dev/urandom >"$temporary/munge/key"
  chmod 600 "$temporary/munge/key"
  if [ "$(id -u)" = 0 ]; then
    chown -R munge:munge "$temporary/munge"
    as=(setpriv --reuid=munge --regid=munge --clear-groups)
  fi
  "${as[@]}" munged --foreground --key-file="$temporary/munge/key" --socket="$temporary/munge/socket" \
    --pid-file="$temporary/munge/pid" --log-file="$temporary/munge/log" --seed-file="$temporary/munge/seed" \
    >"$temporary/munge.out" 2>&1 &
  pids+=($!)
  wait_for 10 munge --no-input --socket="$temporary/munge/socket"
}

start_slurm() {
  local host run=$temporary/run
  host=$(hostname -s)
  mkdir -p "$run/state" "$run/spool"
  cat >"$run/slurm.conf" <<END
ClusterName=relievo
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$temporary/munge/socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1
SlurmctldTimeout=30
KillWait=2
StateSaveLocation=$run/state
SlurmdSpoolDir=$run/spool
SlurmctldPidFile=$run/slurmctld.pid
SlurmdPidFile=$run/slurmd.pid
SlurmctldLogFile=$run/slurmctld.log
SlurmdLogFile=$run/slurmd.log
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
  echo "CgroupPlugin=cgroup/v1" >"$run/cgroup.conf"
  export SLURM_CONF=$run/slurm.conf
  slurmctld -D >"$temporary/ctld.out" 2>&1 &
  pids+=($!)
  wait_for 20 scontrol ping
  slurmd -D >"$temporary/slurmd.out" 2>&1 &
  pids+=($!)
  wait_for 20 sh -c "sinfo -h -o %T | grep -qx idle"
}

state_of() {
  scontrol show job "$1" | sed -n 's/^ *JobState=\([A-Z_]*\).*/\1/p' | sort -u
}

has_ended() {
  [ -z "$(squeue -h -j "$1" 2>/dev/null)" ] || [[ $(state_of "$1") =~ ^(COMPLETED|FAILED|CANCELLED)$ ]]
}

# Prints the state that the merge of the emitted run in folder $1 ends in.
run_emitted() {
  local job
  job=$(bash "$1/submit.sh")
  wait_for 60 has_ended "$job"
  state_of "$job"
}

project="$temporary/a project"
output="$project/it's \$out"
mkdir -p "$project"
cat >"$project/relievo.toml" <<'END'
schema = 1
name = "small"
targets = ["spirv-1.0", "glsl-450"]
[axes]
technique = ["parallax", "bump", "relief"]
address = ["repeat", "clamp"]
filter = ["hardware", "exact"]
END

started=$SECONDS
start_munge
start_slurm
echo "munged, slurmctld and slurmd run after $((SECONDS - started)) s"

"$relievo" permute "$project/relievo.toml" -o "$project/single" --no-cache -j 1 >/dev/null
"$relievo" permute "$project/relievo.toml" -o "$output" --emit slurm --shards $shards --cache "$project/a cache"
started=$SECONDS
state=$(run_emitted "$output")
[ "$state" = COMPLETED ] || fail "the merge is $state; COMPLETED is expected"
cmp "$output/small.rla" "$project/single/small.rla" || fail "the merged archive differs from that of a single run"
for i in $(seq 0 $((shards - 1))); do
  [ -s "$output/logs/shard-$i.log" ] || fail "shard $i has no log"
done
echo "$shards shards and their merge took $((SECONDS - started)) s; the archive is that of a single run"

# A manifest that got broken meanwhile: the shards fail, no merge runs, and the archive is the old one.
echo 'address = 3' >>"$project/relievo.toml"
rm "$output/logs/merge.log"
state=$(run_emitted "$output")
[ "$state" = CANCELLED ] || fail "the merge of failed shards is $state; CANCELLED is expected"
grep -q 'relievo.toml:8' "$output"/logs/shard-*.log || fail "no shard says where the manifest is wrong"
[ ! -e "$output/logs/merge.log" ] || fail "the merge ran although shards failed"
cmp "$output/small.rla" "$project/single/small.rla" || fail "the archive has changed although shards failed"
echo "failed shards cancel the merge, and leave the archive as it was"
