#!/bin/bash
# Options that change from frame to frame. usage: keys.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

# config NAME LINE...: makes a config with these lines for the disc.
config() {
    printf '%s\n' '[defaults]' "style = $style" '[region red-aa3311]' "${@:2}" >"$1.conf"
}

# paint FOLDER ARGUMENT...: as that of film.sh, with styles from a config.
paint() {
    timeout 120 "$program" film -o "$1/w_%04d.png" --progress none "${@:2}" >out 2>err
}

# keyed NAME LINE...: paints the film into NAME by them.
keyed() {
    config "$@" && paint "$1" -c "$1.conf"
}

dry=('front = 0' 'stain = 0')
keyed whole 'carry = 1@1 1@6' && paint plain -s "$style" && same whole plain
result $? 'keys of one value paint what the value does'
keyed washed "${dry[@]}" 'wash = 0@2 2@4'
for pair in 1:0 2:0 3:1 4:2 6:2; do
    keyed "wash_${pair#*:}" "${dry[@]}" "wash = ${pair#*:}"
    same "washed/w_000${pair%:*}.png" "wash_${pair#*:}/w_000${pair%:*}.png" >out 2>err
    result $? "wash is ${pair#*:} in frame ${pair%:*} of 0@2 2@4"
done
keyed still "${dry[@]}" 'carry = 0@3 1@4' && keyed carried "${dry[@]}" 'carry = 0' &&
    same still/w_0003.png carried/w_0003.png && ! same still/w_0004.png carried/w_0004.png
result $? 'paint is carried from the key on'
keyed wets 'front = 0@1 0@3 2@5' && keyed never 'front = 0' && keyed ever 'front = 2' &&
    same wets/w_0003.png never/w_0003.png && ! same wets/w_0005.png never/w_0005.png &&
    ! same wets/w_0005.png ever/w_0005.png
result $? 'a front begins at its key'
keyed runs 'wet-with = all' 'bleed = 0@1 0@3 1@5' && same runs/w_0003.png whole/w_0003.png &&
    ! same runs/w_0005.png whole/w_0005.png
result $? 'neighbours that are wet together run into each other from the key on'
! paint bad -s "$style" --wet-with no-such && says 'wet-with: no region “no-such”'
result $? 'wet-with names regions'
paint late -c washed.conf -f 3-6 && paint later -c wash_1.conf -f 3-6 && same late/w_0003.png later/w_0003.png
result $? 'keys stand at the numbers of --frames, wherever a range begins'

# fate NAME CONFIG ARGUMENT...: the config gives the same frames in other ways.
fate() {
    local name=$1 how=(-c "$2.conf" "${@:3}") layers='{region}_%04d.png' job
    paint "$name" -j 1 "${how[@]}"
    paint "$name-many" -j 3 "${how[@]}" && same "$name-many" "$name"
    result $? "$name: the same by three threads"
    for region in blue-2255aa red-aa3311; do
        paint "$name-none" -y "${how[@]}" --region $region --no-frames --paint "$name-paint/$layers"
    done
    paint "$name-merged" "${how[@]}" --merge --paint "$name-paint/$layers" && same "$name-merged" "$name"
    result $? "$name: the same merged of its regions' paint"
    for _ in 1 2 3 4 5; do # until one is stopped before it is done
        rm -rf "$name-stopped"
        "$program" film -o "$name-stopped/w_%04d.png" --progress none "${how[@]}" >out 2>err &
        job=$!
        while [ ! -e "$name-stopped/w_0003.png" ] && kill -0 $job 2>/dev/null; do
            sleep 0.002
        done
        kill -INT $job 2>/dev/null
        wait $job || break
    done
    paint "$name-stopped" "${how[@]}" && grep -q 'resuming an earlier run' err && same "$name-stopped" "$name"
    result $? "$name: the same in pieces"
    FLUIDY_CACHE=$PWD/cache paint "$name-kept" "${how[@]}" && FLUIDY_CACHE=$PWD/cache paint "$name-taken" "${how[@]}" &&
        same "$name-kept" "$name" && same "$name-taken" "$name"
    result $? "$name: the same from the cache"
}

config dials 'carry = 0.2@1 1@5' 'w-temp = 5@2 20@6' 'wash = 0.4@1 2@6' 'front = 0.2@1 1.5@6' 'wet-with = blue-2255aa' \
    'granulation = -1@1 1@6'
fate dials dials
fate held dials --hold 2

other=$(dirname "$style")/styles/14
config styles "style = $style@1 $other@3~2"
fate styles styles
fate styled styles --hold 2
paint one_style -s "$style" && paint other_style -s "$other" && same_frame() { same "$1/w_000$3.png" "$2/w_000$3.png"; } &&
    same_frame styles one_style 3 && ! same_frame styles one_style 4 && ! same_frame styles other_style 4
result $? 'a style is replaced in the frames after its key'
config cut "style = $style@1 $other@5"
paint cut -c cut.conf && same_frame cut one_style 4 && ! same_frame cut one_style 5
result $? 'or at once'
mkdir rests
for i in $(seq 10 54); do
    cp film/w_0001.svg rests/r_$i.svg
done
echo "style = $style@1 $other@52" | sed '1i [defaults]' >rests.conf
"$program" rests -c rests.conf -o 'rested/r_%02d.png' --progress none >out 2>err
same rested/r_10.png rested/r_51.png && ! same rested/r_51.png rested/r_52.png &&
    same rested/r_52.png rested/r_54.png
result $? 'also where nothing moves'
config flames "style = $style@1 $(dirname "$style")/style-flames@5" 'engine = lazyfluids'
! paint flames -c flames.conf && says 'is cut out, and so it can be no keyed style'
result $? 'paint that is cut out can be no keyed style'

# The same drawings under other numbers are painted by other keys.
config numbered "${dry[@]}" 'carry = 0@1 1@6'
mkdir moved
for i in 1 2 3 4 5 6; do
    cp film/w_000$i.svg moved/w_000$((i + 3)).svg
done
FLUIDY_CACHE=$PWD/numbers paint numbered -c numbered.conf
FLUIDY_CACHE=$PWD/numbers "$program" moved -c numbered.conf -o 'warm/w_%04d.png' --progress none >out 2>err
"$program" moved -c numbered.conf -o 'cold/w_%04d.png' --progress none >out 2>err
same warm cold && ! same cold/w_0009.png numbered/w_0006.png
result $? 'paint in the cache is not taken for frames of other numbers'

echo "1..$n"
