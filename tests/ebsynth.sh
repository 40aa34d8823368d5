#!/bin/bash
# What ebsynth is given, and what is made of its pictures. usage: ebsynth.sh PROGRAM FIXTURES
# shellcheck source-path=SCRIPTDIR source=film.sh
tests=$(realpath "${0%/*}")
. "${0%/*}/film.sh"

if ! command -v python3 >/dev/null; then
    skip 'ebsynth gets the guides of our own frames' 'no python3'
    echo '1..1'
    exit
fi
printf '#!/bin/sh\nexec python3 "%s/ebsynth.py" "$@"\n' "$tests" >stand-in && chmod +x stand-in
export EBSYNTH=$folder/stand-in
disc='red-aa3311'

# weights FOLDER LINE: those of the disc in the LINE-th step that was run.
weights() {
    sed -n "$2p" "$1/$disc/weights"
}

paint plain --preset fluidymation && paint exported --preset fluidymation --ebsynth patch -j 1 && same plain exported
result $? 'the export changes nothing of the frames'
[ -s patch/$disc/run_0001.sh ] && [ -s patch/$disc/run_0002.sh ] && [ -s patch/$disc/run_0006.sh ] &&
    [ "$(find patch -name 'run_*.sh' | wc -l)" = 12 ] && [ -s patch/README ]
result $? 'every region and frame is a step'
paint resting --ebsynth rests -j 1 && sh rests/run.sh >out 2>&1 && same rests/blue-2255aa/out_000{1,6}.png &&
    [ "$(wc -l <rests/blue-2255aa/weights)" = 1 ]
result $? 'a frame at rest is that before, and is not synthesised again'
paint threads --preset fluidymation --ebsynth patch_threads -j 5 && same patch patch_threads
result $? 'the same bytes on any number of threads'
sh patch/run.sh >out 2>&1 && [ "$(find patch -name 'out_*.png' | wc -l)" = 12 ]
result $? "the command lines are as ebsynth's own"
[ "$(weights patch 1)" = 'style 1 shape 4 ext-plus 1 ext-minus 1 segment 100' ] &&
    [ "$(weights patch 2)" = 'style 1 shape 4 ext-plus 1 ext-minus 1 segment 100 temporal 4' ]
result $? 'every channel weighs as much as in the preset'
paint lazy --preset lazyfluids --ebsynth fluid && sh fluid/run.sh >out 2>&1 &&
    [ "$(weights fluid 1)" = 'style 1 alpha 3 segment 100' ] &&
    [ "$(weights fluid 2)" = 'style 1 alpha 3 segment 100 past 0.2 past-alpha 0.6' ]
result $? 'those of LazyFluids, too'
paint back --preset fluidymation --merge --ebsynth patch --tint keep --paper none --wash 0 --hue 0 &&
    [ "$(python3 "$tests/ebsynth.py" back/w_0003.png 34 28)" = '20 123 200' ]
result $? 'and what it has painted is composed as ours is'

echo "1..$n"
