#!/bin/bash
# Renders that are stopped, killed and asked for again.
# usage: resume.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

started() { # started FOLDER ARGUMENT...: paints $output in the background, as process $job
    local to=$1
    shift
    "$program" "${film:-film}" -s "$style" -o "$to/${output:-w_%04d.png}" --progress none "$@" >out 2>err &
    job=$!
}

# wait_for FILE: until the file is there or the program has ended.
wait_for() {
    while [ ! -e "$1" ] && kill -0 $job 2>/dev/null; do
        sleep 0.002
    done
}

# stop FOLDER SIGNALS FRAME [ARGUMENT...]: paints, sends the signals after the frame; the status is
# the program's.
# Where the program was done before they came, as may be on a busy machine, once more.
stop() {
    local found signal
    for _ in 1 2 3 4 5 6 7 8 9 10; do
        started "$1" "${@:4}"
        wait_for "$1/w_000$3.png"
        for signal in $2; do
            kill -"$signal" $job 2>/dev/null
        done
        wait $job 2>/dev/null
        found=$?
        [ $found = 0 ] || break
        rm -rf "$1"
    done
    return $found
}

paint whole
[ "$(ls whole | wc -l)" = 6 ] && [ ! -e whole/.w_%04d.png.state ]
result $? 'a complete render leaves its frames and nothing else'

for signal in INT TERM; do
    stop $signal $signal 2
    found=$?
    [ $found = 75 ] && says 'run again to resume' && [ -e $signal/.w_%04d.png.state ]
    result $? "SIG$signal ends a render with status 75 and says what to do"
    paint $signal && grep -q 'resuming an earlier run' err && same $signal whole
    result $? "the frames after SIG$signal and a second run are those of a whole render"
done

film=$(dirname "$style")/animations/snowman-wave-layers output=w_000%02d.png
wet=(--style "$(dirname "$style")/styles/05" --width 120 --detail draft)
"$program" "$film" -s 05 -o "long_whole/$output" --progress none "${wet[@]}" 2>err
stop long_resumed INT 40 "${wet[@]}"
[ $? = 75 ] && "$program" "$film" -s 05 -o "long_resumed/$output" --progress none "${wet[@]}" 2>err &&
    grep -q 'resuming an earlier run' err && same long_resumed long_whole
result $? 'the paper has the marks of all frames before the first of a second run'
"$program" "$film" -s 05 --no-frames --paint 'long_paint/{region}_%d.png' --progress none "${wet[@]}" 2>err &&
    "$program" "$film" -s 05 --merge --paint 'long_paint/{region}_%d.png' -o "long_part/$output" --part 44/44 \
        --progress none "${wet[@]}" 2>err && same long_part/w_00044.png long_whole/w_00044.png
result $? 'and before the first of a part of a merge'
unset film output

mkdir puff
for i in 1 2 3 4 5 6; do
    echo "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 48 48' width='96' height='96'><path fill='#567'" \
        "d='M10 44C$((14 - i)) $((30 - 3 * i)) $((16 + i)) $((14 - 2 * i)) 26 $((16 - i))S46 30 34 44Z'/></svg>" >puff/w_000$i.svg
done
film=puff fluid=(--engine lazyfluids --fluid smoke)
paint puff_plain --engine lazyfluids
paint puff_whole "${fluid[@]}"
stop puff_resumed INT 3 "${fluid[@]}"
paint puff_resumed "${fluid[@]}" && grep -q 'resuming an earlier run' err && same puff_resumed puff_whole &&
    ! same puff_resumed puff_plain
result $? 'a fluid flows on where a render is resumed'
paint puff_dumped "${fluid[@]}" --dump puff_flow && paint puff_late "${fluid[@]}" -f 4- --dump puff_late_flow &&
    cmp "$(find puff_late_flow -name motion_0005.flo)" "$(find puff_flow -name motion_0005.flo)" &&
    cmp "$(find puff_late_flow -name motion_0006.flo)" "$(find puff_flow -name motion_0006.flo)"
result $? 'in frames that start late it flows as in the whole film'
unset film

for i in 1 2 3 4 5 6; do
    flow slide_$i.flo '\0\0\x60\x40\0\0\0\0'
done
moved=(--region red-aa3311 --flow 'slide_%d.flo')
paint carried_whole "${moved[@]}"
stop carried INT 3 "${moved[@]}"
paint carried "${moved[@]}" && grep -q 'resuming an earlier run' err &&
    same carried carried_whole
result $? 'paint that is carried goes on as it would have'

ink=(--engine transport --style "$(dirname "$style")/styles/14")
paint ink_whole "${ink[@]}"
stop ink INT 3 "${ink[@]}"
paint ink "${ink[@]}" && grep -q 'resuming an earlier run' err && same ink ink_whole
result $? 'ink that is moved goes on as it would have'

stop twice 'INT TERM' 1
found=$?
[ $found = 143 ] || [ $found = 75 ] # the second came too late for a render that had ended
result $? 'a second signal ends it at once'
paint twice && same twice whole
result $? 'and then it goes on all the same'

paint slid_whole --style-window 2
! same slid_whole whole
result $? 'a window on the recording paints something else than the whole of it'
stop slid INT 3 --style-window 2
[ $? = 75 ] && paint slid --style-window 2 && same slid slid_whole
result $? 'a render that is interrupted goes on with the window where it was'

# 50 kills: five a round, at any moment of one frame after another; now and then before the first.
RANDOM=${SEED:-$$}
echo "# SEED=${SEED:-$$}"
for round in 1 2 3 4 5 6 7 8 9 10; do
    rm -rf killed
    for frame in 1 2 3 4 5; do
        started killed -j $((1 + RANDOM % 3))
        [ $((RANDOM % 4)) = 0 ] || wait_for killed/w_000$frame.png
        sleep 0.0$((RANDOM % 90 + 10))
        kill -KILL $job 2>/dev/null
        wait $job 2>/dev/null
    done
    # the last run may have come to its end before it was killed
    { [ -e killed/w_0006.png ] && [ ! -e killed/.w_%04d.png.state ]; } || paint killed
    same killed whole
    result $? "a render killed five times has the frames of a whole one (round $round)"
done

# A file that replaces another has a hidden name for a moment; here a run was killed in it.
stop left KILL 2
echo half >left/..w_%04d.png.state.part
echo mine >left/.w_0003.png.mine
paint left && grep -q mine left/.w_0003.png.mine && rm left/.w_0003.png.mine && same left whole
result $? 'a hidden file of the killed run is gone after the second, one of somebody else is not'

stop linked KILL 2
ln -s ../outside 'linked/..w_%04d.png.state.part'
paint linked && [ ! -e outside ] && same linked whole
result $? 'a link in its place is replaced, not followed'

stop told KILL 2
paint told --report page && grep -q 'report and statistics lack the . frames' err && same told whole
result $? 'who asks for a report of a render that goes on is told which frames it lacks'
paint told -y --report page && ! grep -q lack err
result $? 'which a render from the beginning does not'

paint held_whole --hold 4
stop held KILL 2 --hold 4
paint held --hold 4 && same held held_whole
result $? 'a frame that is held is held on by a second run'

paint layers_whole --layers 'layers_whole/{region}_%04d.png'
stop layered KILL 2 --layers 'layered/{region}_%04d.png'
paint layered --layers 'layered/{region}_%04d.png' && same layered layers_whole
result $? 'layers are complete after a second run too'

paint painted --paint 'paint/{region}_%04d.png'
stop merged KILL 2 --merge --paint 'paint/{region}_%04d.png'
paint merged --merge --paint 'paint/{region}_%04d.png' && same merged whole
result $? 'merging goes on too'
stop painted2 KILL 2 --paint 'painted2/paint/{region}_%04d.png'
paint painted2 --paint 'painted2/paint/{region}_%04d.png' && same painted2/paint paint
result $? 'and the paint that is kept is complete'

# as another run has it
mkdir both
exec 9>both/.w_%d.png.lock
flock 9
paint both -y
[ $? = 1 ] && says 'both/w_%04d.png: another run is writing it' && [ ! -e both/w_0001.png ]
result $? 'of two runs that would write the same frames the second is told'
"$program" film -s "$style" -o both/w_####.png -y --progress none >out 2>err
[ $? = 1 ] && says 'both/w_####.png: another run is writing it' && [ ! -e both/w_0001.png ]
result $? 'also if it spells their names otherwise'
"$program" film -s "$style" -o both/w_%03d.png -y --progress none >out 2>err
[ $? = 1 ] && says 'both/w_%03d.png: another run is writing it' && [ ! -e both/w_001.png ]
result $? 'or would meet it in frame 1000 only'
exec 9>&-
paint both && same both whole
result $? 'and a lock that a killed run left does no harm'

# ---- what has changed ----

stop changed INT 2
while [ -e changed/w_0005.png ]; do # leave two to be painted
    rm -rf changed
    stop changed INT 2
done
cp -r changed before
refused() { # refused SENTENCE MESSAGE ARGUMENT...: status 1, one line, nothing touched
    local sentence=$1 message=$2
    shift 2
    paint changed "$@"
    [ $? = 1 ] && says "$message" && same changed before
    result $? "$sentence"
}
refused 'another parameter is no reason to mix frames' 'w-temp of region ' --w-temp 3
refused 'another seed is told with both values' 'seed was 1 and is 2; use -y to start anew' --seed 2
refused 'another size is told' 'the width was 56 and is 28' -W 28
drawing film/w_0006.svg 56 1
refused 'a drawing that was changed is named' 'w_0006.svg has other contents; use -y to start anew'
drawing film/w_0006.svg 56 6
cp -r "$style" other-style
printf '\n' >>other-style/style.ini
own_style=$style
style=$PWD/other-style
mkdir same-name && mv other-style same-name/style-small && style=$PWD/same-name/style-small
refused 'a style that was changed is named' 'style style-small has other contents'
style=$own_style
mv changed/w_0001.png .
paint changed
[ $? = 1 ] && says 'w_0001.png: an earlier run painted it, but it is gone'
result $? 'a finished frame that is gone is told'
cp changed/w_0002.png changed/w_0001.png
paint changed
[ $? = 1 ] && says 'w_0001.png: an earlier run painted it, but it has changed since'
result $? 'so is one that has changed'
mv w_0001.png changed/
later=changed/w_000$(($(ls changed/w_*.png | wc -l) + 2)).png # the next one was in hand
drawing "$later" 56 1
paint changed
[ $? = 1 ] && says "${later#*/}: already exists" && grep -q svg "$later"
result $? 'a file that a later frame would replace is refused and left alone'
rm "$later"
head -c 100 changed/.w_%04d.png.state >cut && cp cut changed/.w_%04d.png.state
paint changed
[ $? = 1 ] && says 'the state of an earlier render cannot be read; use -y to start anew'
result $? 'a state that is cut short is told'
paint changed -y && ! grep -q 'resuming' err && same changed whole
result $? '-y starts anew'

rm -rf stopped
stop stopped INT 2
paint stopped -y --resume && grep -q 'resuming' err && same stopped whole
result $? '-y --resume goes on where it can'
stop stopped2 INT 2
paint stopped2 -y --resume --seed 2 && ! grep -q 'resuming' err && ! same stopped2 whole
result $? '-y --resume starts anew where it cannot'

"$program" film -s "$style" -o film.gif --no-frames --resume >out 2>err
[ $? = 2 ] && says 'film.gif: a film cannot be resumed without its frames; leave out --no-frames'
result $? 'a film without frames that should be resumed is refused'

"$program" film -s "$style" -o played/w.mkv -q >out 2>err
[ $? = 0 ] && [ -s played/w.mkv ] && mv played/w.mkv played.mkv && same played whole
result $? 'a film keeps its frames beside it'
output=w.mkv stop on TERM 3
[ $? = 75 ] && [ ! -e on/w.mkv ] && "$program" film -s "$style" -o on/w.mkv >out 2>err &&
    grep -q 'resuming' err && same on/w.mkv played.mkv && rm on/w.mkv && same on whole
result $? 'an interrupted film goes on and has the same bytes'
for frame in 1 3; do
    output=w.mkv stop dead KILL $frame
done
"$program" film -s "$style" -o dead/w.mkv >out 2>err && grep -q 'resuming' err &&
    same dead/w.mkv played.mkv && rm dead/w.mkv && same dead whole
result $? 'so does one that was killed twice, and leaves nothing else'
# An ffmpeg that is slow to start, of a run that was killed, does not touch what the next one wrote.
mkdir slow bin
ffmpeg=$(command -v ffmpeg)
printf '#!/bin/sh\ntrap "" HUP TERM\n(sleep 3; exec "%s" "$@" </dev/null) &\nwait\n' "$ffmpeg" >bin/ffmpeg
chmod +x bin/ffmpeg
PATH=$PWD/bin:$PATH output=w.mkv stop slow KILL 2
"$program" film -s "$style" -o slow/w.mkv >out 2>err && sleep 3.5 &&
    same slow/w.mkv played.mkv && rm slow/w.mkv && same slow whole
result $? 'and a late ffmpeg of the killed run does no harm'
mkdir one
exec 9>one/.w.mkv.part
flock 9
"$program" film -s "$style" -o one/w.mkv --no-frames -y -q >out 2>err
[ $? = 1 ] && says 'one/w.mkv: another run is writing it' && [ ! -e one/w.mkv ]
result $? 'of two runs that would write the same film the second is told'
exec 9>&-
"$program" film -s "$style" -o alone/w.mkv --no-frames -q >out 2>err
[ $? = 0 ] && [ "$(ls -A alone)" = w.mkv ] && same alone/w.mkv played.mkv
result $? 'without frames the film is the same and alone'

echo "1..$n"
