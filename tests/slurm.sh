#!/bin/bash
# --plan slurm with the real Slurm: a controller and two nodes of one processor on the loopback address, and tasks that are
# killed. Skipped where Slurm or munge is missing, and for users who may not start its nodes.
# usage: slurm.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

for needed in slurmctld slurmd munged sbatch; do
    if ! PATH=$PATH:/usr/sbin command -v $needed >/dev/null || [ "$(id -u)" != 0 ]; then
        skip 'a farm of two nodes' "no $needed, or not root"
        echo "1..$n"
        exit
    fi
done
PATH=$PATH:/usr/sbin
farm=$folder/farm
mkdir -p "$farm/state"
chmod 755 "$folder" "$farm"
first_port=$((20000 + $$ % 10000 * 4))
[ $first_port -lt 60000 ] || first_port=$((first_port - 30000))

stop_farm() {
    local pid
    for pid in "$farm"/*.pid; do
        [ -e "$pid" ] && kill "$(cat "$pid")" 2>/dev/null
    done
    sleep 1
    rm -rf "$folder"
}
trap stop_farm EXIT

dd if=/dev/urandom of="$farm/key" bs=1024 count=1 status=none
chmod 400 "$farm/key"
munged --force --key-file="$farm/key" --socket="$farm/munge" --pid-file="$farm/munged.pid" \
    --log-file="$farm/munged.log" --seed-file="$farm/seed" >out 2>err
export SLURM_CONF=$farm/slurm.conf
cat >"$SLURM_CONF" <<EOF
ClusterName=loopback
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=$first_port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$farm/munge
StateSaveLocation=$farm/state
SlurmdSpoolDir=$farm/spool.%n
SlurmctldPidFile=$farm/slurmctld.pid
SlurmdPidFile=$farm/slurmd.%n.pid
SlurmctldLogFile=$farm/slurmctld.log
SlurmdLogFile=$farm/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
KillWait=2
NodeName=one NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=$((first_port + 1)) CPUs=1
NodeName=two NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=$((first_port + 2)) CPUs=1
PartitionName=all Nodes=one,two Default=YES MaxTime=INFINITE State=UP
EOF
slurmctld && slurmd -N one && slurmd -N two
for _ in {1..60}; do
    [ "$(sinfo -h -N -o %t 2>/dev/null | grep -c idle)" = 2 ] && break
    sleep 0.5
done
if [ "$(sinfo -h -N -o %t 2>err | grep -c idle)" != 2 ]; then
    skip 'a farm of two nodes' 'Slurm does not start here'
    echo "1..$n"
    exit
fi
result 0 'two nodes wait for work'

# Two large regions and five small ones, in drawings large enough for tasks to be killed at work.
mkdir shot
for i in 01 02 03 04 05 06 07 08 09 10 11 12; do
    {
        i=${i#0}
        echo "<svg xmlns='http://www.w3.org/2000/svg' width='240' height='240' viewBox='0 0 96 96'>" \
            "<rect x='4' y='6' width='60' height='80' fill='#2255aa'/>" \
            "<circle cx='$((40 + 3 * i))' cy='44' r='30' fill='#aa3311'/>"
        for k in 1 2 3 4 5; do
            echo "<rect x='$((12 * k + i))' y='70' width='9' height='9' fill='#${k}0b0${k}0'/>"
        done
        echo '</svg>'
    } >shot/s_00$i.svg
done
render() {
    "$program" shot -s "$style" -q -j 1 "$@"
}
render -o 'whole/s_%04d.png' >out 2>err

# hasten: what was requeued starts in some seconds; Slurm would let it wait for two minutes. A start in the second in which
# the job was taken from the node would be refused, since its old credential is revoked to the second.
hasten() {
    local job reason start
    squeue -h -r -t pending -o '%i %r %S' | while read -r job reason start; do
        if [ "$reason" = BeginTime ] && [ "$(date -d "$start" +%s 2>/dev/null || echo 0)" -gt $((EPOCHSECONDS + 5)) ]; then
            scontrol update "jobid=$job" starttime=now+3 2>/dev/null
        fi
    done
}

# ends KILLS: no job is left in the queue, within five minutes; so many times a running task is requeued, as for a job that
# matters more. Sets `stalled` if Slurm starts nothing any more though both nodes are idle, even when told to.
ends() {
    local end=$((SECONDS + 300)) moved=$SECONDS job
    while [ -n "$(squeue -h)" ]; do
        job=$(squeue -h -r -t running -o %i | grep _ | shuf -n 1)
        if [ -n "$job" ] && [ "$(wc -l <killed)" -lt "$1" ]; then
            sleep "0.$((RANDOM % 5))"
            scontrol requeue "$job" 2>/dev/null && echo "$job" >>killed
        fi
        hasten
        if squeue -h -r -o '%T %r' | grep -qv '^PENDING None$' || sinfo -h -N -o %t | grep -qv '^idle$'; then
            moved=$SECONDS
        elif [ $((SECONDS - moved)) -gt 60 ]; then
            stalled=1
        elif [ $((SECONDS - moved)) -gt 15 ]; then
            scontrol reconfigure 2>/dev/null
            sleep 5
        fi
        if [ -n "$stalled" ] || [ $SECONDS -gt $end ] || squeue -h -o %r | grep -q DependencyNeverSatisfied; then
            squeue -h -r -o '# %i %T %r' && tail -n 50 "$farm/slurmctld.log" | sed 's/^/# /'
            return 1
        fi
        sleep 0.2
    done
}

: >killed
stalled=
render --plan slurm -o 'farmed/s_%04d.png' >plan.sh 2>err && bash plan.sh >out 2>err && ends 4 && same farmed whole
status=$?
if [ -n "$stalled" ]; then
    skip 'tasks that were taken from their nodes' 'Slurm starts nothing any more'
    echo "1..$n"
    exit
fi
result $status "tasks that were taken from their nodes $(wc -l <killed) times give the frames of one process"
[ "$(ls -A farmed 2>/dev/null | wc -l)" = 12 ] && [ -z "$(find fluidy -name '.*' -type f)" ]
result $? 'and leave nothing but paint'
! grep -hv '^s [a-z0-9,/ -]*: ' slurm-*.out | grep -v '^slurmstepd-.* DUE TO JOB REQUEUE' >out
result $? 'each line of the logs begins with shot and regions'

# A task whose processes are killed has failed, and its merge never comes; the same plan goes on.
rm -rf farmed fluidy
bash plan.sh >out 2>err
for _ in {1..600}; do
    [ -n "$(squeue -h -r -t running -o %i)" ] && break
    sleep 0.1
done
sleep 0.7
scancel --full --signal=KILL "$(squeue -h -r -t running -o %i | head -1)"
scancel --user="$(id -un)"
for _ in {1..300}; do
    [ -z "$(squeue -h)" ] && break
    sleep 0.2
done
[ -z "$(squeue -h)" ]
result $? 'what is cancelled does not come back'
[ ! -e farmed ] && bash plan.sh >out 2>err && ends 0 && same farmed whole
result $? 'the same plan again goes on after all was killed'

echo "1..$n"
