#!/bin/bash
# What is known of how the drawing moves. usage: motion.sh PROGRAM FIXTURES
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"
disc='--region red-aa3311'

# shellcheck disable=SC2086 # $disc is two words
paint_disc() {
    paint "$@" $disc
}

paint whole --dump dump && paint whole_again --flow 'dump/{region}/flow_%04d.flo' &&
    same whole whole_again
result $? 'the flow of a dump gives the same frames'

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

echo "1..$n"
