#!/usr/bin/env bash
# Starts a Slurm of one node, this one, to try a campaign on it: as root, with Debian's slurm-wlm and munge installed.
#
#     campaign/measure/one_node_slurm.sh FOLDER     # starts it; its files go into FOLDER, and a link into /etc/slurm
#     campaign/measure/one_node_slurm.sh FOLDER stop
#
# No accounting: jobs are watched with squeue. Daemons are stopped by the ids in FOLDER.
set -euo pipefail
mkdir -p "$1"
folder=$(cd "$1" && pwd)
conf=$folder/slurm.conf
# A job sees no variables of who sent it, so its configuration must be where Slurm looks for it.
installed=/etc/slurm/slurm.conf
if [ -e $installed ] && [ "$(readlink -f $installed)" != "$conf" ]; then
    echo "$installed: this machine has a Slurm already" >&2
    exit 2
fi

if [ "${2:-}" = stop ]; then
    for daemon in slurmd slurmctld munged; do
        if [ -f "$folder/$daemon.pid" ]; then kill "$(cat "$folder/$daemon.pid")" || true; fi
    done
    rm -f $installed
    exit
fi

node=$(hostname -s)
mkdir -p "$folder/state" "$folder/spool"
cat >"$conf" <<CONF
ClusterName=one
SlurmctldHost=$node
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
MinJobAge=600
SchedulerParameters=batch_sched_delay=0,sched_interval=2
NodeName=$node CPUs=$(nproc) RealMemory=$(($(awk '/MemTotal/ {print $2}' /proc/meminfo) / 1024 - 512)) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF

ln -sf "$conf" $installed

# munged wants a key and a folder that are its own.
dd if=/dev/urandom of="$folder/munge.key" bs=1024 count=1 status=none
chmod 600 "$folder/munge.key"
munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/munged.seed"
slurmctld
slurmd
for _ in $(seq 30); do
    if sinfo --noheader --format=%T 2>/dev/null | grep -q idle; then
        exit
    fi
    sleep 1
done
echo "no idle node after 30 s: see $folder/slurmctld.log and $folder/slurmd.log" >&2
exit 1
