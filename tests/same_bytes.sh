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
for region in $(cd one && ls ./*_0001.png | sed 's/^..//; s/_0001.png//' | grep -vx w); do
    paint alone -y --region "$region" --layers "alone/$layers" -b none &&
        [ -e "alone/${region}_0006.png" ] || echo "# $region"
    result $? "region $region can be painted alone"
done
cmp -s alone/red-aa3311_0006.png one/red-aa3311_0006.png
result $? 'the top region has the same layer alone as among others'
paint other --seed 2 --layers "other/$layers" && ! same other one
result $? 'another seed paints something else'

echo "1..$n"
