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
    paint "$@" $disc
}

paint_disc masks --motion masks
paint_disc plain -j 1 && ! same plain masks
result $? 'the motion of the outlines carries the paint'
paint_disc carried -j 1 --flow $slide && same plain carried
result $? 'as the same motion in files does'
for threads in 2 5; do
    paint_disc threads -y -j $threads --flow $slide && same threads carried
    result $? "$threads threads carry it as one does"
done
paint_disc none --flow $slide --carry 0 && paint_disc all --flow $slide --carry 1 &&
    ! same none carried && ! same all carried && ! same none all
result $? 'the share that is carried makes a difference'
cmp -s carried/w_0001.png masks/w_0001.png
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
    cmp -s held/w_0003.png every_second/w_0003.png && cmp -s held/w_0005.png every_second/w_0005.png
result $? 'held frames are carried as in a film without those between'
paint_disc loop --loop --flow $slide
result $? 'a loop is carried over its seam'
paint_disc draft --detail draft --flow $slide && paint_disc draft_masks --detail draft --motion masks &&
    ! same draft draft_masks
result $? 'drafts are carried, too'

paint whole --dump dump --motion masks &&
    paint whole_again --motion masks --flow 'dump/{region}/flow_%04d.flo' && same whole whole_again
result $? 'the flow of a dump gives the same frames'
paint_disc carried_dump --flow $slide --dump carried_motion && same carried_dump carried &&
    paint_disc carried_again --flow 'carried_motion/{region}/motion_%04d.flo' &&
    same carried_again carried
result $? 'so does its motion'

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
    cmp -s crossed_paint/blue-2255aa_000{1,6}.png && ! cmp -s crossed_paint/red-aa3311_000{1,6}.png
result $? 'a shape at rest keeps its paint while another one crosses it'

echo "1..$n"
