#!/bin/bash
# What it costs to paint a film in tasks: wall time of two workers of one thread each against one process of one thread, and
# processor seconds, of which those of reading the drawing again; and the time of two workers that follows from those
# of one task after the other, for machines that do other things.
# usage: farm_times.sh PROGRAM DRAWING ARGUMENT...
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
set -e
program=$(realpath "$1")
drawing=$(realpath "$2")
shift 2
cd "$folder"
mkdir times
export OMP_NUM_THREADS=1
TIMEFORMAT='%U %S %R'
# timed FILE COMMAND...: its seconds of processor and of the wall are a line more in FILE.
timed() {
    local to=$1
    shift
    { time "$@" >"$to.out" 2>"$to.err"; } 2>>"times/$to" || { cat "$to.err" >&2 && return 1; }
}
sum() {
    awk '{cpu += $1 + $2; wall += $3} END {printf "%.2f %.2f\n", cpu, wall}' "times/$1"
}

timed reading "$program" "$drawing" --list-regions "$@"
timed one "$program" "$drawing" -j 1 -q -o 'one/%04d.png' "$@"
"$program" "$drawing" -j 1 -q --plan json -o 'two/%04d.png' "$@" >plan.json
read -r n parts <<<"$(python3 -c '
import json, shlex
plan = json.load(open("plan.json"))
for step in "tasks", "merge":
    for k, task in enumerate(plan[step]):
        open(f"{step}.{k}", "w").write(shlex.join(task["command"]))
print(len(plan["tasks"]), len(plan["merge"]))')"

# One command after the other, and what two workers would make of them: each takes the next one when it is free.
for ((k = 0; k < n; k++)); do
    timed tasks bash "tasks.$k"
done
for ((k = 0; k < parts; k++)); do
    timed merge bash "merge.$k"
done
same one two
longer() { # longer STEP: processor seconds until both workers are free
    awk '{if (a <= b) a += $1 + $2; else b += $1 + $2} END {print (a > b ? a : b)}' "times/$1"
}

# Two workers in truth.
rm -r two fluidy
worker() { # worker STEP N: takes the next of N commands that nobody has taken
    local k
    for ((k = 0; k < $2; k++)); do
        mkdir "taken.$1.$k" 2>/dev/null || continue
        timed "both.$BASHPID" bash "$1.$k"
    done
}
start=$EPOCHREALTIME
for step in "tasks $n" "merge $parts"; do
    # shellcheck disable=SC2086 # two words
    worker $step &
    # shellcheck disable=SC2086
    (worker $step)
    wait $!
done
wall=$(bc <<<"$EPOCHREALTIME - $start")
same one two

read -r one one_wall <<<"$(sum one)"
read -r tasks _ <<<"$(sum tasks)"
read -r merge _ <<<"$(sum merge)"
read -r reading _ <<<"$(sum reading)"
reckoned=$(bc <<<"$(longer tasks) + $(longer merge)")
echo "one process: $one CPU-s, $one_wall s"
echo "$n tasks: $tasks CPU-s, and the merge in $parts parts $merge"
echo "two workers: $wall s, $(bc <<<"scale=2; $one_wall / $wall") times less"
echo "with a processor each, from the CPU-s of one after the other: $reckoned s, $(bc <<<"scale=2; $one / $reckoned") times less"
echo "reading the drawing once: $reading CPU-s, in all tasks $(bc <<<"$reading * $n")"
