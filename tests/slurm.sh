#!/bin/sh
# slurm.sh WEFT: starts a queue of Slurm on this machine alone, and gives it a picture: the bytes of one run. Needs root and
# the packages of script/install farm; skipped without them.
set -eu
weft=$1
for program in slurmctld slurmd munged sbatch squeue; do
    PATH=$PATH:/usr/sbin command -v $program >/dev/null || { echo "no $program (script/install farm): skipped"; exit 77; }
done
[ "$(id -u)" = 0 ] || { echo "a queue needs root: skipped"; exit 77; }
PATH=$PATH:/usr/sbin
work=$(mktemp -d)
begun=""
finish() {
    for process in $begun; do kill "$process" 2>/dev/null || true; done
    sleep 1
    for process in $begun; do kill -9 "$process" 2>/dev/null || true; done
    rm -rf "$work"
}
trap finish EXIT INT TERM
cd "$work"
chmod 755 "$work"

# Ports that nothing listens on, as the numbers of this process.
port=$((20000 + $$ % 20000))
host=$(hostname -s)
mkdir state spool
dd if=/dev/urandom of=munge.key bs=128 count=1 2>/dev/null
chmod 400 munge.key
munged --foreground --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munge.pid" \
    --log-file="$work/munge.log" --seed-file="$work/munge.seed" >munge.out 2>&1 &
begun="$begun $!"
cat >slurm.conf <<END
ClusterName=weft
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/builtin
SelectType=select/cons_tres
ReturnToService=2
MailProg=/bin/true
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF="$work/slurm.conf"
for tries in 1 2 3 4 5 6 7 8 9 10; do [ -S munge.socket ] && break || sleep 0.3; done
slurmctld -D >slurmctld.out 2>&1 &
begun="$begun $!"
slurmd -D -N "$host" >slurmd.out 2>&1 &
begun="$begun $!"
tries=0
until [ "$(sinfo -h -o %t 2>/dev/null)" = idle ]; do
    tries=$((tries + 1))
    if [ $tries -gt 60 ]; then
        echo "the queue did not start: skipped"
        tail -5 ./*.log ./*.out
        exit 77
    fi
    sleep 0.5
done

job="builtin:spheres --width 120 --height 90 --spp 48"
"$weft" render $job --quiet -o whole.exr -o whole.png
"$weft" farm slurm --array 3 --program "$weft" -- render $job -o "a cloth.exr" -o cloth.png >job.sh
sh job.sh --chdir="$work" >numbers
tries=0
while [ -n "$(squeue -h)" ]; do
    tries=$((tries + 1))
    [ $tries -le 240 ] || { squeue; tail -5 ./*.log; exit 1; }
    sleep 0.5
done
cmp whole.exr "a cloth.exr"
cmp whole.png cloth.png
echo "jobs $(tr '\n' ' ' <numbers): an array of 3 parts and the merge have the bytes of one run"
