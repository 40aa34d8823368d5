#!/bin/bash
# The same input, options and seed give the same bytes. usage: same_bytes.sh PROGRAM FIXTURES
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

layers='{region}_%04d.png'
paint one -j 1 --layers "one/$layers"
for threads in 2 3 5; do
    paint many -y -j $threads --layers "many/$layers" && same many one
    result $? "$threads threads paint what one does, layers included"
done
for detail in normal draft; do
    paint single -y -j 1 --detail $detail && paint several -y -j 2 --detail $detail &&
        paint crowd -y -j 5 --detail $detail && same several single && same crowd single
    result $? "and the same frames where no layers are stored, detail $detail"
done
for mask in 0 1 3; do
    FLUIDY_CPU_MASK=$mask paint masked -y --layers "masked/$layers" && same masked one
    result $? "FLUIDY_CPU_MASK=$mask paints what the whole instruction set does"
done
paint elsewhere --layers "elsewhere/$layers" && same elsewhere one
result $? 'another folder has the same frames'

paint again_whole -f 1-6 --layers "again_whole/$layers" && same again_whole one
result $? 'a range of all frames is no range'
for region in $(cd one && ls ./*_0001.png | sed 's/^..//; s/_0001.png//' | grep -vx -e w -e paper_sheet); do
    paint alone -y --region "$region" --layers "alone/$layers" -b none --paint "paint/$layers" &&
        [ -e "alone/${region}_0006.png" ]
    result $? "region $region can be painted alone"
done
same alone/red-aa3311_0006.png one/red-aa3311_0006.png
result $? 'the top region has the same layer alone as among others'
paint merged --merge --paint "paint/$layers" --layers "merged/$layers" && same merged one
result $? 'what was painted region by region is merged to the frames and layers of one run'
paint both --paint "both_paint/$layers" && same both_paint paint
result $? 'and one run keeps the same paint'
paint tinted --tint '#22aa55' --layers "tinted/$layers" &&
    paint retinted --merge --paint "paint/$layers" --tint '#22aa55' --layers "retinted/$layers" &&
    same retinted tinted && ! same tinted one
result $? 'with another tint merging gives what painting does'
paint held --hold 2 --layers "held/$layers" --paint "held_paint/$layers" &&
    paint held_merged --hold 2 --merge --paint "held_paint/$layers" --layers "held_merged/$layers" &&
    same held_merged held && [ "$(find held_paint -type f | wc -l)" = 6 ]
result $? 'frames that are held are merged alike'
paint other --seed 2 --layers "other/$layers" && ! same other one
result $? 'another seed paints something else'

# The transport of ink.
ink=(--style "$(dirname "$style")/styles/14")
paint ink -j 1 "${ink[@]}" && paint ink_many -j 4 "${ink[@]}" && same ink_many ink &&
    FLUIDY_CPU_MASK=0 paint ink_plain "${ink[@]}" && same ink_plain ink && ! same ink one
result $? 'ink is moved alike by four threads and without the larger instruction sets'
mkdir plume # a mound that swells and bends: no single map moves it
for i in 1 2 3 4 5 6; do
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='56' height='56'>" \
        "<path d='M6 54Q6 $((44 - 5 * i)) $((20 + 3 * i)) $((40 - 5 * i))T50 54Z'/></svg>" >plume/w_000$i.svg
done
smoke=("${ink[@]}" --fluid smoke)
film=plume
paint dry "${ink[@]}" --fluid none && paint smoke -j 1 "${smoke[@]}" && ! same smoke dry &&
    paint smoke_many -j 4 "${smoke[@]}" && same smoke_many smoke &&
    FLUIDY_CPU_MASK=0 paint smoke_plain "${smoke[@]}" && same smoke_plain smoke
result $? 'a fluid flows alike on any number of threads'
paint puffs "${smoke[@]}" --hold 2 --paint "puffs_paint/$layers" && ! same puffs smoke &&
    paint puffs_merged "${smoke[@]}" --hold 2 --merge --paint "puffs_paint/$layers" && same puffs_merged puffs
result $? 'and where frames are held and merged'
paint said "${ink[@]}" && same said smoke
result $? 'and a style may ask for it'
unset film
paint flat "${ink[@]}" --strength 0 && ! same flat ink
result $? 'without strength it stays where it is'

# Paint that is cut out, with alpha of its own.
flames=(--style "$(dirname "$style")/style-flames" --engine lazyfluids --tint keep -b none -f 1-3)
paint flames -j 1 "${flames[@]}" --paint "flames_paint/$layers" && paint flames_many -j 4 "${flames[@]}" &&
    same flames_many flames && FLUIDY_CPU_MASK=0 paint flames_plain "${flames[@]}" && same flames_plain flames
result $? 'what is cut out is painted alike by four threads and without the larger instruction sets'
paint flames_merged "${flames[@]}" --merge --paint "flames_paint/$layers" && same flames_merged flames
result $? 'and merged of its paint'
paint flames_still "${flames[@]}" --style-frames 1 && ! same flames_still flames
result $? 'its frames are played in step'
export FLUIDY_CACHE=$PWD/cache
paint flames_first "${flames[@]}" && paint flames_second "${flames[@]}" && same flames_second flames
result $? 'and taken from the cache'
export FLUIDY_CACHE=off

# Lines over the paint, drawn by hand.
mkdir lined
for i in 1 2 3 4; do
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='56' height='56'><rect x='4' y='4'" \
        "width='48' height='48' fill='#2255aa'/><g fill='none' stroke='#221100'>" \
        "<path d='M$((3 + i)) 9L50 $((20 + 3 * i))L12 44' stroke-width='1'/>" \
        "<path d='M9 50L$((40 + i)) 50' stroke-width='1.1'/></g></svg>" >lined/w_000$i.svg
done
lines() {
    local to=$1
    shift
    timeout 120 "$program" lined -s "$style" -o "$to/w_%04d.png" --progress none "$@" >out 2>err
}
lines unsaid && lines pen_said --line pen && lines plain --line plain && same pen_said unsaid &&
    ! same plain unsaid
result $? 'who says nothing gets a pen'
lines preset --preset fluidymation && lines preset_plain --preset fluidymation --line plain &&
    same preset preset_plain
result $? "the papers' presets have plain lines"
for tool in pen pencil brush; do
    lines $tool --line $tool -j 1 && lines many_$tool --line $tool -j 5 &&
        FLUIDY_CPU_MASK=0 lines scalar_$tool --line $tool && same $tool many_$tool &&
        same $tool scalar_$tool && ! same $tool plain
    result $? "a $tool draws the same at every thread count and level"
done
lines boiling --line pencil --line-boil 2 && ! same boiling pencil
result $? 'lines boil when asked to'

echo "1..$n"
