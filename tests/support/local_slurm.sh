#!/bin/sh
# A cluster of this one machine: `local_slurm.sh start FOLDER` prints the configuration to put into SLURM_CONF, `stop
# FOLDER` ends it. Of Debian: slurmctld, slurmd, munge; needs root. Status 77 and the reason where it cannot be.
set -u
PATH=$PATH:/usr/sbin:/sbin
folder=$2

stop() {
  for daemon in slurmd slurmctld munged; do
    [ -s "$folder/$daemon.pid" ] && kill "$(cat "$folder/$daemon.pid")" 2>/dev/null
  done
}

cannot() {
  echo "$*"
  stop
  exit 77
}

if [ "$1" = stop ]; then
  stop
  exit 0
fi

for program in munged slurmctld slurmd sbatch; do
  command -v "$program" >/dev/null || cannot "no $program here"
done
[ "$(id -u)" -eq 0 ] || cannot "a local cluster needs root"

mkdir -p "$folder/state" "$folder/spool"
chmod 755 "$folder"
umask 077
dd if=/dev/urandom of="$folder/munge.key" bs=1024 count=1 2>/dev/null
umask 022
munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
  --seed-file="$folder/munge.seed" --log-file="$folder/munged.log" 2>/dev/null || cannot "munged does not start"

host=$(hostname -s)
ports=$((20000 + $$ % 20000 * 2))
cat >"$folder/slurm.conf" <<END
ClusterName=tutu
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
SlurmctldPort=$ports
SlurmdPort=$((ports + 1))
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
MinJobAge=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF="$folder/slurm.conf"
slurmctld 2>"$folder/errors" || cannot "slurmctld does not start: $(tail -n 1 "$folder/errors")"
slurmd 2>"$folder/errors" || cannot "slurmd does not start: $(tail -n 1 "$folder/errors")"
for _ in $(seq 100); do
  [ "$(sinfo --noheader --format=%t 2>/dev/null)" = idle ] && echo "$SLURM_CONF" && exit 0
  sleep 0.2
done
cannot "the node never came up: $(tail -n 1 "$folder/slurmd.log")"
