#!/bin/bash
# Renders in tasks for a farm: two workers, tasks killed at random, and the frames of one process.
# usage: farm.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

# A film of seven regions: two large ones and five small ones, and one that is never seen.
mkdir shot
for i in 01 02 03 04 05 06 07 08 09 10 11 12; do
    {
        i=${i#0}
        echo "<svg xmlns='http://www.w3.org/2000/svg' width='96' height='96'>" \
            "<rect x='28' y='36' width='9' height='9' fill='#00ff00'/>" \
            "<rect x='4' y='6' width='60' height='80' fill='#2255aa'/>" \
            "<circle cx='$((40 + 3 * i))' cy='44' r='30' fill='#aa3311'/>"
        for k in 1 2 3 4 5; do
            echo "<rect x='$((12 * k + i))' y='70' width='9' height='9' fill='#${k}0b0${k}0'/>"
        done
        echo '</svg>'
    } >shot/s_00$i.svg
done
render() {
    "$program" shot -s "$style" -q "$@"
}
render -o 'whole/s_%04d.png' >out 2>err

# What a scheduler does, in place of Slurm: two workers, which kill tasks and queue them again.
mkdir bin
cat >bin/sbatch <<'END'
#!/bin/bash
script=$(mktemp)
cat >"$script"
last=0 array='' name=''
for word; do
    case $word in
    --array=0-*) last=${word#--array=0-} array=yes ;;
    --dependency=*) [ "$word" = --dependency=afterok:7 ] || exit 1 ;;
    --job-name=*) name=${word#*=} ;;
    esac
done
work() {
    local task=$1 tries=0 status
    while :; do
        SLURM_ARRAY_TASK_ID=$task SLURM_JOB_ID=$((100 + task)) bash "$script" >>"log.$name.$task" 2>&1 &
        local job=$!
        if [ -n "$array" ] && [ $tries -lt 4 ]; then
            sleep "0.0$((RANDOM % 10))"
            # the shell of the task and all that it has started, or the program with a warning
            if [ $((RANDOM % 2)) = 0 ]; then
                pkill -KILL -P $job 2>/dev/null
                kill -KILL $job 2>/dev/null
            else
                kill -TERM $job 2>/dev/null
            fi
        fi
        wait $job 2>/dev/null
        status=$?
        tries=$((tries + 1))
        echo "$task $status" >>tries
        [ $status = 0 ] && return 0
        [ $tries -lt 30 ] || return 1
    done
}
worker() { # worker FIRST: every second task
    local task
    for ((task = $1; task <= last; task += 2)); do
        work $task || return 1
    done
}
worker 0 & one=$!
worker 1 & two=$!
wait $one && wait $two || exit 1
rm "$script"
echo 7
END
printf '#!/bin/sh\necho "$@" >>requeued\n' >bin/scontrol
chmod +x bin/sbatch bin/scontrol

render --plan slurm -o 'farmed/s_%04d.png' >plan.sh 2>err && bash -n plan.sh
result $? '--plan slurm prints a script'
[ ! -e farmed ] && [ ! -e fluidy ]
result $? 'and writes nothing'
all=$(sed -n '/^all=($/,/^)$/p' plan.sh | sed '1d;/^)$/,$d')
[ "$(wc -l <<<"$all")" = 3 ] && [ "$(tail -1 <<<"$all" | tr ',' '\n' | wc -l)" = 5 ] &&
    [ "$(tr ',' '\n' <<<"$all" | sort -u | wc -l)" = 7 ] && [ "$(head -1 <<<"$all")" = blue-2255aa ]
result $? 'small regions share a task, after the large ones, and one that is never seen has none'
PATH=$PWD/bin:$PATH bash plan.sh >out 2>err && same farmed whole
result $? "tasks that were killed $(grep -cv ' 0$' tries) times give the frames of one process"
[ "$(ls -A farmed | wc -l)" = 12 ] && [ -z "$(find fluidy -name '.*' -type f)" ]
result $? 'and leave nothing but paint'
! grep -hv '^s [a-z0-9,/ -]*: ' log.* >out
result $? 'each line of the logs begins with shot and regions'

render --plan json -o 'farmed/s_%04d.png' >plan.json 2>err
if command -v python3 >/dev/null; then
    cat >run.py <<'END'
import json, subprocess, sys
plan = json.load(open("plan.json"))
shares = [task["share"] for task in plan["tasks"]]
assert len(plan["merge"]) == 2 and len(plan["film"]) == len(sys.argv) - 1
assert plan["frames"] == 12 and abs(sum(shares) - 1) < 1e-4 and shares[0] == max(shares[:-1])
for task in plan["tasks"] + plan["merge"][::-1] + plan["film"]:
    subprocess.run(task["command"], cwd=plan["folder"], check=True)
END
    rm -rf farmed fluidy
    python3 run.py >out 2>err && same farmed whole
    result $? 'the commands of --plan json give the same frames, the parts of the merge in any order'
    rm -rf farmed fluidy
    render --plan json -o farmed/s.apng >plan.json 2>err && render -o whole.apng --no-frames >out 2>err &&
        python3 run.py film >out 2>err && same farmed/s.apng whole.apng && rm farmed/s.apng && same farmed whole
    result $? 'and the same film, after all parts'
    render --plan=openjd -o 'farmed/s_%04d.png' 2>err | python3 -c '
import json, sys
job = json.load(sys.stdin)
paint, merge = job["steps"]
assert merge["parameterSpace"]["taskParameterDefinitions"][0]["range"] == ["1/2", "2/2"]
assert job["specificationVersion"] == "jobtemplate-2023-09"
assert merge["dependencies"] == [{"dependsOn": "Paint"}]
assert len(paint["parameterSpace"]["taskParameterDefinitions"][0]["range"]) == 3
args = paint["script"]["actions"]["onRun"]["args"]
assert args[args.index("--region") + 1] == "{{Task.Param.Regions}}"
assert [(each["name"], each["type"]) for each in job["parameterDefinitions"]] == [("Folder", "PATH")]
assert "--merge" in merge["script"]["actions"]["onRun"]["args"]'
    result $? '--plan openjd is a template of two steps'
else
    skip 'the commands of --plan json give the same frames' 'no python3'
    skip '--plan openjd is a template of two steps' 'no python3'
fi
# The paint of each region in frames as wide as these says how wide it is, in its 20th byte.
render --no-frames --paint 'paint/{region}_%04d.png' --paint-area region >out 2>err &&
    [ "$(od -An -tu1 -j19 -N1 paint/red-aa3311_0001.png)" -lt 96 ]
result $? 'paint files of a region are smaller than the frames'
render --no-frames --paint 'paint/{region}_%04d.png' --region red-aa3311 -y >out 2>err &&
    [ "$(od -An -tu1 -j19 -N1 paint/red-aa3311_0001.png)" -eq 96 ] && rm -rf farmed paint/*-00ff00_* &&
    render --merge --paint 'paint/{region}_%04d.png' -o 'farmed/s_%04d.png' >out 2>err && same farmed whole
result $? 'a merge reads both kinds, and needs no paint of what is never seen'
rm -rf farmed
merge_part() {
    render --merge --paint 'paint/{region}_%04d.png' -o "farmed/${2:-s_%04d.png}" --part "$1" >out 2>err
}
merge_part 2/5 && (cd farmed && echo s_*) >names && [ "$(cat names)" = 's_0003.png s_0004.png' ]
result $? 'a part is of some of the frames'
cp -r shot gap && rm gap/s_0007.svg # with which the second half begins
gap() {
    "$program" gap -s "$style" -q --missing hold "$@" >out 2>err
}
gap -o 'held/s_%04d.png' && gap --no-frames --paint 'held_paint/{region}_%d.png' --paint-area region &&
    gap --merge --paint 'held_paint/{region}_%d.png' -o 'half/s_%04d.png' --part 2/2 &&
    [ "$(ls half | wc -l)" = 6 ] && same half/s_0007.png held/s_0007.png && same half/s_0008.png held/s_0008.png
result $? 'a part that begins with a held frame shows the one before'
merge_part 5/4
[ $? = 2 ] && says 'K from 1 to N' && render --part 1/2 -o 'farmed/%d.png' >out 2>err
[ $? = 2 ] && says 'needs --merge' && merge_part film
[ $? = 2 ] && says 'needs a film'
result $? 'a part that is none, of no merge, or a film of no name, is told'
merge_part film s.apng
[ $? = 1 ] && says 's_0001.png: there is no such frame'
result $? 'a film wants all parts'
render --region "$(printf 'blue-2255aa,%.0s' {1..30})red-aa3311" --no-frames --paint 'many/{region}_%d.png' >out 2>err &&
    [ "$(ls many | wc -l)" = 24 ]
result $? 'a task of so many regions that no file may be named after them paints them'
printf '[project]\nlayers = layers/{region}_%%d.png\n' >layers.conf
render -c layers.conf --region red-aa3311 --no-frames --paint 'alone/{region}_%d.png' >out 2>err &&
    [ "$(ls alone | wc -l)" = 12 ] && [ ! -e layers ]
result $? 'a task writes none of the layers that a config asks for'
render --region red-aa3311 --no-frames --paint 'other/{region}_%d.png' --paper tissue >out 2>err
[ $? = 2 ] && says 'paper “tissue”' && [ ! -e other ]
result $? 'and finds out about a paper that is none, which only the merge makes'
render --plan condor >out 2>err
[ $? = 2 ] && says 'slurm'
result $? 'another scheduler is told which there are'
render --plan json --region red-aa3311 >out 2>err
[ $? = 2 ] && says 'leave out'
result $? 'a plan is of all regions'
render --region nobody,red-aa3311 -o 'x_%04d.png' >out 2>err
[ $? = 2 ] && says 'no region “nobody”'
result $? 'each region of a list is looked for'

echo "1..$n"
