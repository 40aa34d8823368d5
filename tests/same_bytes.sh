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
cmp -s alone/red-aa3311_0006.png one/red-aa3311_0006.png
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

echo "1..$n"
