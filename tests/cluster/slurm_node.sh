#!/usr/bin/env bash
# slurm_node.sh start DIR [MAX_ARRAY] | stop DIR: a Slurm of one node, this machine, as root: no systemd, no cgroups, nothing in /etc,
# ports of its own. With SLURM_CONF=DIR/slurm.conf sbatch and the others talk to it.
set -euo pipefail
action=$1
dir=$(readlink -f "$2")
host=$(hostname -s)

configure() {
  cat <<END
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/linux
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,batch_sched_delay=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
MaxArraySize=$1
KillWait=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$(($(awk '/MemTotal/ {print $2}' /proc/meminfo) / 1100))
PartitionName=all Nodes=$host Default=YES State=UP
END
}

start() {
  mkdir -p "$dir/state" "$dir/spool"
  (umask 077 && head -c 128 /dev/urandom >"$dir/munge.key")
  munged --force --num-threads=2 --key-file="$dir/munge.key" --socket="$dir/munge.socket" --pid-file="$dir/munged.pid" \
    --seed-file="$dir/munge.seed" --log-file="$dir/munged.log"
  configure "${1:-1001}" >"$dir/slurm.conf"
  export SLURM_CONF=$dir/slurm.conf
  slurmctld
  slurmd
  for _ in $(seq 150); do
    if [[ $(sinfo -h -o %T 2>/dev/null) == idle ]]; then return; fi
    sleep 0.2
  done
  tail -n 5 "$dir/slurmctld.log" "$dir/slurmd.log" >&2
  echo "slurm_node.sh: the node did not become idle" >&2
  exit 1
}

stop() {
  for daemon in slurmd slurmctld munged; do
    if [[ -f $dir/$daemon.pid ]]; then kill "$(cat "$dir/$daemon.pid")"; fi
  done
}

shift 2
"$action" "$@"
