#!/bin/bash
# Machines that fail while a film is painted. usage: faults.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

# A file system of its own for one command, as root of a name space of its own.
own_mount() { # own_mount OPTIONS COMMAND: "disk" is then a tmpfs
    unshare -rm bash -c "mount -t tmpfs -o $1 tmpfs disk && $2"
}
export -f paint
export program style

no_litter() { # no_litter FOLDER: nothing but frames and the state
    [ -z "$(find "$1" -type f ! -name 'w_000[1-6].png' ! -name '.w_*.state')" ]
}

whole_frames() { # whole_frames FOLDER: each of its frames is one of a render without a fault
    local file
    for file in "$1"/*.png; do
        same "$file" "whole/${file##*/}" || return 1
    done
}

paint whole

mkdir disk
if own_mount size=1m true 2>/dev/null; then
    # Room for two or three frames; then, with more of it, the same command again.
    own_mount size=1m 'head -c 984k /dev/zero >disk/filler
                       paint disk/film; status=$?; cp -r disk/film full; cp err err1
                       rm disk/filler; paint disk/film && cp -r disk/film more
                       exit $status'
    found=$?
    cp err1 err
    [ $found = 1 ] && says 'No space left on device' && no_litter full && whole_frames full &&
        [ -e full/w_0001.png ]
    result $? 'a full disk is one message; the finished frames are whole and nothing else is left'
    same more whole
    result $? 'with room on the disk the same command completes the film'
    own_mount size=1m,ro 'paint disk/there'
    [ $? = 1 ] && says 'Read-only file system'
    result $? 'a disk that cannot be written is one message'
else
    for sentence in full roomy read-only; do
        skip "a $sentence disk" 'no name spaces here'
    done
fi

mkdir limited
(ulimit -f 2 && paint limited)
[ $? = 1 ] && says 'File too large' && no_litter limited
result $? 'a limit on the size of files is one message'
(ulimit -n 40 && paint few -j 20)
[ $? = 1 ] && says 'too few files may be open at once: 96 are needed for 20 threads' && [ ! -e few ]
result $? 'so is a limit on open files'

# cramped ARGUMENT...: paints in a control group with 80 MiB of memory.
group=/sys/fs/cgroup/memory/fluidy-$$
cramped() {
    (echo $BASHPID >$group/tasks && "$program" film -s "$style" -o 'cramped/%d.png' --progress none -y "$@" >out 2>err)
}
if [ -z "${ASAN_OPTIONS:-}" ] && mkdir $group 2>/dev/null && echo $((80 << 20)) 2>/dev/null >$group/memory.limit_in_bytes; then
    cramped -W 300 && found=0
    for width in 1200 2000 4000; do
        cramped -W $width
        [ $? = 1 ] && says 'MiB of memory for painting' && says '--limit memory=N' || found=1
    done
    result $found 'in a control group with little memory, what takes more is one message'
    rmdir $group
else
    rmdir $group 2>/dev/null
    skip 'in a control group with little memory, what takes more is one message' 'no control groups here, or a sanitizer that needs more'
fi

touch file
paint file/below
[ $? = 1 ] && says 'file' && [ ! -s out ]
result $? 'a folder that cannot be made is one message'

# An ffmpeg that runs what is in the file `fault` once the first frame has begun to come. A frame is
# wider than a pipe holds, so the program waits for it, with the last drawing still to be read.
mkdir slow
printf '#!/bin/bash\nhead -c 1 >/dev/null\n[ ! -e fault ] || . ./fault\nexec cat >&3\n' >slow/ffmpeg
chmod +x slow/ffmpeg

# paint_film FOLDER [COMMAND]: a film with its frames beside it; the command is run during the first.
paint_film() {
    rm -f fault
    if [ $# = 2 ]; then echo "$2" >fault; fi
    PATH=$PWD/slow:$PATH timeout 120 "$program" film -s "$style" -W 200 -o "$1/w.mov" \
        --progress none >out 2>err
}

mv whole small
paint_film whole

paint_film vanished 'mv film/w_0006.svg .'
[ $? = 1 ] && says 'w_0006.svg' && no_litter vanished && whole_frames vanished
result $? 'a drawing that vanishes is named; the frames before it are whole'
mv w_0006.svg film/
paint_film vanished && same vanished whole
result $? 'and once it is back the same command completes the film'

drawing w_0006.svg 56 1
cp film/w_0006.svg kept.svg
paint_film changed 'mv w_0006.svg film/'
[ $? = 1 ] && says 'w_0006.svg: has changed since the render began' && whole_frames changed
result $? 'a drawing that changes in between is named, and no frame of both is written'
mv kept.svg film/w_0006.svg
paint_film changed && same changed whole
result $? 'and once it is as it was the same command completes the film'

paint_film undone 'rm -rf undone'
[ $? = 1 ] || [ -e undone/w_0006.png ] # the folder is made again where that can be
result $? 'a folder of frames that vanishes does no more harm'

rm -rf whole vanished changed undone
mv small whole

"$program" film --list-regions >&- 2>err
[ $? = 1 ] && : >out && says 'standard output cannot be written'
result $? 'a closed standard output is one message'
"$program" film --list-regions >/dev/full 2>err
[ $? = 1 ] && says 'standard output cannot be written: No space left on device'
result $? 'a full standard output is one message'
timeout 100 "$program" film -s "$style" -o 'mute/w_%04d.png' --progress plain 2>&-
[ $? = 0 ] && same mute whole
result $? 'without a standard error the frames are the same'
timeout 100 "$program" film -s "$style" -o 'pipe/w_%04d.png' --progress json 2>&1 | true
[ "${PIPESTATUS[0]}" = 0 ] && same pipe whole
result $? 'a reader of the progress who leaves does not stop the render'

mkdir bin
printf '#!/bin/sh\nhead -c 100 >/dev/null\necho no such codec >&2\nexit 1\n' >bin/ffmpeg
chmod +x bin/ffmpeg
PATH=$PWD/bin:$PATH "$program" film -s "$style" -o film.mov --progress none >out 2>err
[ $? = 1 ] && says 'ffmpeg stopped: no such codec' && [ -z "$(find . -name '*.mov')" ]
result $? 'an ffmpeg that dies is quoted, and no film is left'
printf '#!/bin/sh\ntouch hangs\nexec sleep 1000\n' >bin/ffmpeg
PATH=$PWD/bin:$PATH "$program" film -s "$style" -o hung/film.mov --progress none >out 2>err &
job=$!
for _ in {1..200}; do
    [ -e hangs ] && [ -e hung/film_0006.png ] && break
    sleep 0.05
done
sleep 0.2
kill -TERM $job
wait $job
[ $? = 75 ] && says 'ffmpeg was interrupted' && [ ! -e hung/film.mov ] && [ ! -e hung/.film.mov.part ]
result $? 'a signal ends the wait for an ffmpeg that hangs'

# tight KIB: one frame with that much address space is painted, or refused in one line.
tight() {
    local status
    rm -rf tight
    (ulimit -v "$1" && paint tight -W 500 -f 1 -j 2)
    status=$?
    case $status in
    0) painted=$((painted + 1)) && [ -e tight/w_0001.png ] ;;
    1) refused=$((refused + 1)) && grep -q 'not enough memory' err && [ "$(wc -l <err)" = 1 ] && [ ! -e tight ] ;;
    127) grep -q 'loading shared libraries' err ;; # before main()
    *) false ;;
    esac || { echo "# $1 KiB: status $status"; return 1; }
}

if [ -n "${ASAN_OPTIONS:-}" ]; then
    for sentence in 'that cannot be had' 'of any size'; do
        skip "memory $sentence is one message" 'the sanitizer needs it all'
    done
else
    painted=0 refused=0
    for kib in 60000 75000 80000 85000 90000 95000 100000 105000 110000 115000 120000 130000 200000 400000; do
        tight $kib || break
    done && [ $painted -gt 0 ] && [ $refused -gt 0 ]
    result $? 'memory of any size is enough or is one message'
    (ulimit -v 1500000 && paint huge -W 30000 -j 1 --style-by-page off --limit frame=1000 --limit memory=1000000)
    found=$?
    [ $found = 1 ] && [ "$(wc -l <err)" = 1 ] && grep -qi 'memory' err && [ ! -e huge/w_0001.png ]
    result $? 'memory that cannot be had is one message'
fi

echo "1..$n"
