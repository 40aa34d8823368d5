#!/bin/bash
# Paint that is carried along the drawing's motion, of its outlines or as files give it. usage: motion.sh PROGRAM FIXTURES
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

for i in 1 2 3 4 5 6; do
    flow slide_$i.flo '\0\0\x60\x40\0\0\0\0' # 3.5 px to the right
    flow twice_$i.flo '\0\0\xe0\x40\0\0\0\0' # 7 px
done
slide='slide_%d.flo'
disc='--region red-aa3311'

# shellcheck disable=SC2086 # $disc is two words
paint_disc() {
    paint "$@" $disc --front 0 --stain 0
}

paint_disc masks --motion masks
paint_disc plain -j 1 && ! same plain masks
result $? 'the motion of the outlines carries the paint'
paint_disc carried -j 1 --flow $slide && same plain carried
result $? 'as the same motion in files does'
mv slide_1.flo first.flo
paint_disc without -j 1 --flow $slide && same without carried
result $? 'and the first frame needs none'
! paint_disc lacking --loop --flow $slide && grep -q 'slide_1.flo: ' err
result $? 'but in a loop'
mv first.flo slide_1.flo
for threads in 2 5; do
    paint_disc threads -y -j $threads --flow $slide && same threads carried
    result $? "$threads threads carry it as one does"
done
paint_disc none --flow $slide --carry 0 && paint_disc all --flow $slide --carry 1 &&
    ! same none carried && same all carried
result $? 'the share that is carried makes a difference'
same none/w_0001.png masks/w_0001.png
result $? 'but not in a first frame'
paint_disc everything --motion masks --flow $slide && ! same everything carried &&
    ! same everything masks
result $? 'with the motion of masks a flow is that of everything'
paint_disc thesis --preset thesis --flow $slide &&
    paint_disc thesis_masks --preset thesis --motion masks --carry 1 --flow $slide &&
    same thesis thesis_masks
result $? 'so it is in the presets of the papers'
# A recording as small as so small a page asks for has few levels, by which the frames are cropped.
paint_disc held --hold 2 --style-by-page off --flow 'twice_%d.flo' &&
    paint_disc every_second -f 1-6x2 --style-by-page off --flow 'twice_%d.flo' &&
    same held/w_0003.png every_second/w_0003.png && same held/w_0005.png every_second/w_0005.png
result $? 'held frames are carried as in a film without those between'
paint_disc loop --loop --flow $slide && paint_disc loop_none --loop --flow $slide --carry 0 &&
    ! same loop/w_0001.png loop_none/w_0001.png
result $? 'a loop is carried over its seam'
paint_disc draft --detail draft --flow $slide && paint_disc draft_masks --detail draft --motion masks &&
    ! same draft draft_masks
result $? 'drafts are carried, too'

paint whole --dump dump --motion masks &&
    paint whole_again --motion masks --flow 'dump/{region}/flow_%04d.flo' --dump again &&
    (cd dump && sha256sum ./*/flow_*.flo) >sums && (cd again && sha256sum -c --quiet ../sums)
result $? 'the flow of a dump is read as it is'
paint_disc carried_dump --flow $slide --dump carried_motion && same carried_dump carried &&
    paint_disc carried_again --flow 'carried_motion/{region}/motion_%04d.flo' &&
    same carried_again carried
result $? 'its motion gives the same frames'

# motion_of FILE: what is in the middle of the disc of frame 1, tenths of px to the right.
motion_of() {
    local middle=$((12 + 8 * (28 * 56 + 24)))
    od -An -tf4 -j $middle -N 4 "$1" | awk '{ printf "%.0f", 10 * $1 }'
}
paint_disc seam --loop --dump seam_dump && paint_disc open --dump open_dump &&
    [ "$(motion_of seam_dump/red-aa3311/motion_0001.flo)" = -175 ] &&
    [ "$(motion_of open_dump/red-aa3311/motion_0002.flo)" = 35 ] &&
    ! same seam/w_0001.png open/w_0001.png
result $? 'the motion over the seam is from the last frame to the first'
paint_disc halved --style-by-page off --flow $slide --dump halved_dump &&
    [ "$(motion_of halved_dump/red-aa3311/motion_0002.flo)" = 35 ]
result $? 'a dump is as large as the frame where the paint is searched at half its size'
paint_disc skipped -f 1,2,4-6 --dump gap_dump &&
    [ "$(motion_of gap_dump/red-aa3311/motion_0004.flo)" = 70 ]
result $? 'the motion over frames that are not painted is between those that are'
mkdir saved
mv film/w_0003.svg saved
paint_disc gap --missing skip && same gap skipped
result $? 'so it is where files are missing'
paint_disc held_gap --missing hold && same held_gap/w_0002.png held_gap/w_0003.png &&
    paint_disc held_masks --missing hold --motion masks &&
    ! same held_gap/w_0004.png held_masks/w_0004.png
result $? 'or held'
mv saved/w_0003.svg film

for i in 3 4; do
    mv film/w_000$i.svg saved
    sed 's/<circle[^>]*>//' saved/w_000$i.svg >film/w_000$i.svg
done
paint_disc back && paint_disc back_carried --carry 0.5 && paint_disc back_masks --motion masks &&
    ! same back/w_0002.png back_masks/w_0002.png &&
    ! same back/w_0006.png back_carried/w_0006.png
result $? 'a shape that leaves and returns is carried before and after'
same back_carried/w_0005.png back_masks/w_0005.png
result $? 'what returns is painted afresh'
paint_disc back_loop --loop --carry 1 && paint_disc back_threads --loop --carry 1 -j 3 &&
    same back_loop back_threads
result $? 'also in a loop, with any number of threads'
mv saved/w_000[34].svg film

# moves FILE: a plane is not 0 throughout.
moves() {
    [ "$(tr -d '\0' <"$1" | wc -c)" != 0 ]
}
for i in 1 2 3 4; do
    drawing film/w_000$i.svg 56 $((i < 3 ? 1 : 3))
done
paint_disc jump -f 1-4 --flow-sigma 0 --dump jump_dump
at=jump_dump/red-aa3311/flow
! moves ${at}_0002.f32 && moves ${at}_0003.f32 && ! moves ${at}_0004.f32
result $? 'the flow of a frame is the motion into it'

paint crossed --paint 'crossed_paint/{region}_%04d.png' &&
    same crossed_paint/blue-2255aa_000{1,6}.png && ! same crossed_paint/red-aa3311_000{1,6}.png
result $? 'a shape at rest keeps its paint while another one crosses it'

echo "1..$n"
