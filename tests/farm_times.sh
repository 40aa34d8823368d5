#!/bin/bash
# What it costs to paint a film in tasks: wall time of two workers of one thread each against one process of one thread, and
# processor seconds, of which those of reading the drawing again. Machines that do other things want processor seconds.
# usage: farm_times.sh PROGRAM DRAWING ARGUMENT...
set -e
program=$(realpath "$1")
drawing=$(realpath "$2")
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir times
export FLUIDY_CACHE=off OMP_NUM_THREADS=1
TIMEFORMAT='%U %S %R'
# timed FILE COMMAND...: its seconds of processor and of the wall are a line more in FILE.
timed() {
    local to=$1
    shift
    { time "$@" >out 2>err; } 2>>"times/$to" || { cat err >&2 && return 1; }
}
sum() {
    awk '{cpu += $1 + $2; wall += $3} END {printf "%.2f %.2f\n", cpu, wall}' "times/$1"
}

timed reading "$program" "$drawing" --list-regions "$@"
timed one "$program" "$drawing" -j 1 -q -o 'one/%04d.png' "$@"
"$program" "$drawing" -j 1 -q --plan json -o 'two/%04d.png' "$@" >plan.json
n=$(python3 -c '
import json, shlex
plan = json.load(open("plan.json"))
for k, task in enumerate(plan["tasks"] + [plan["merge"]]):
    open(f"task.{k}", "w").write(shlex.join(task["command"]))
print(len(plan["tasks"]))')
worker() { # worker FILE: takes the next task that nobody has taken
    local k
    for ((k = 0; k < n; k++)); do
        mkdir "taken.$k" 2>/dev/null || continue
        timed "$1" bash "task.$k"
    done
}
start=$EPOCHREALTIME
worker tasks.1 &
worker tasks.2
wait $!
timed merge bash "task.$n"
wall=$(bc <<<"$EPOCHREALTIME - $start")
diff -r one two
cat times/tasks.[12] >times/tasks
read -r one one_wall <<<"$(sum one)"
read -r tasks _ <<<"$(sum tasks)"
read -r merge _ <<<"$(sum merge)"
read -r first _ <<<"$(sum tasks.1)"
read -r second _ <<<"$(sum tasks.2)"
best=$(awk "BEGIN {print $merge + ($first > $second ? $first : $second)}")
read -r reading _ <<<"$(sum reading)"
echo "one process: $one CPU-s, $one_wall s"
echo "$n tasks: $tasks CPU-s, and the merge $merge; two workers $wall s, $(bc <<<"scale=2; $one_wall / $wall") times less"
echo "on two processors with nothing else to do: $one s and $best s, $(bc <<<"scale=2; $one / $best") times less"
echo "reading the drawing once: $reading CPU-s, in all tasks $(bc <<<"$reading * $n")"
