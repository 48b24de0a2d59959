#!/usr/bin/env bash
# Runs a small sweep as an array of jobs under a real Slurm on this machine, merges it, and compares it with the same sweep without.
#
#   deploy/slurm/test.sh target/release/vibrissa
#
# Needs Debian's slurmctld, slurmd, slurm-client and munge, and the user root; says so and ends well where they are not there.
# It starts Slurm in a directory of its own, on free ports, and ends it again.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
vibrissa=$(realpath "${1:?"usage: deploy/slurm/test.sh VIBRISSA"}")

for program in slurmctld slurmd sbatch squeue sinfo munged; do
    if ! PATH=$PATH:/usr/sbin:/sbin command -v "$program" >/dev/null; then
        echo "skipped: $program is not installed (apt-get install slurmctld slurmd slurm-client munge)"
        exit 0
    fi
done
if [ "$(id -u)" != 0 ]; then
    echo "skipped: only root can start Slurm's daemons"
    exit 0
fi
PATH=$PATH:/usr/sbin:/sbin

work=$(mktemp -d)
pids=()
finish() {
    local status=$?
    if [ $status -ne 0 ]; then
        tail -n 20 "$work"/*.log "$work"/job-*.out 2>/dev/null >&2 || true
    fi
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
    for pid in "${pids[@]}"; do wait "$pid" 2>/dev/null || true; done
    rm -rf "$work"
}
trap finish EXIT

# munged asks that nobody else can write where its socket and its key are.
mkdir --mode=755 "$work/munge" "$work/state" "$work/spool"
chmod 755 "$work"
head -c 128 /dev/urandom >"$work/munge/key"
chmod 400 "$work/munge/key"

free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}
host=$(hostname -s)
cat >"$work/slurm.conf" <<CONF
ClusterName=vibrissa
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
CredType=cred/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=test Nodes=ALL Default=YES State=UP
CONF
echo "IgnoreSystemd=yes" >"$work/cgroup.conf"
export SLURM_CONF=$work/slurm.conf

munged --foreground --socket="$work/munge/socket" --key-file="$work/munge/key" --pid-file="$work/munge/pid" \
    --log-file="$work/munge/log" --seed-file="$work/munge/seed" >"$work/munged.log" 2>&1 &
pids+=($!)
within_10_s() {
    for _ in $(seq 100); do
        if "$@" >/dev/null 2>&1; then return; fi
        sleep 0.1
    done
    echo "failed within ten seconds: $*" >&2
    return 1
}
within_10_s test -S "$work/munge/socket"
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out.log" 2>&1 &
pids+=($!)
slurmd -D -f "$SLURM_CONF" -N "$host" >"$work/slurmd.out.log" 2>&1 &
pids+=($!)
is_idle() { timeout 2 sinfo --noheader --format=%T | grep -q idle; }
within_10_s is_idle

cat >"$work/sweep.yaml" <<SWEEP
name: slurm
policies: [$root/policies/vibrissa.fsm]
scenes: [{scenario: $root/scenarios/disk.yaml, trials: 6}]
vary:
  scenario:
    stop: [{time: 3 s}]
    rig.sensing.angle_noise: [0.5 urad]
SWEEP
export VIBRISSA=$vibrissa
timeout 60 sbatch --quiet --wait --array=1-3 --output="$work/job-%a.out" --mem-per-cpu=0 \
    "$root/deploy/slurm/sweep.sbatch" "$work/sweep.yaml" "$work/sharded"
"$vibrissa" study merge "$work/sharded" >/dev/null
"$vibrissa" sweep "$work/sweep.yaml" --out "$work/whole" >/dev/null 2>&1
"$vibrissa" study merge "$work/whole" --out "$work/in-order.jsonl" >/dev/null

# The times are those of the machine.
results() { python3 -c '
import json, sys
for line in open(sys.argv[1]):
    result = json.loads(line)
    for key in ("start_s", "wall_s", "realtime", "tick_us"):
        result.pop(key, None)
    print(json.dumps(result, sort_keys=True))' "$1"; }
results "$work/sharded/results.jsonl" >"$work/sharded.txt"
results "$work/in-order.jsonl" >"$work/whole.txt"
[ "$(wc -l <"$work/whole.txt")" = 7 ]
diff "$work/sharded.txt" "$work/whole.txt"
echo "the sweep as an array of 3 jobs gives what it gives without Slurm"
