#!/bin/bash
# Frames and films say what they were made from. usage: verify.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"
export FLUIDY_CACHE=$PWD/cache

verify() { # verify FOLDER ARGUMENT...: the same command asks instead of painting
    "$program" film -s "$style" -o "$1/w_%04d.png" --progress none --verify "${@:2}" >out 2>err
}
whole() { # whole N: the last command found so many files, all as they would be made
    grep -q "all $1 files are as they would be made now" err
}
wrong() { # wrong N: it found so many others
    grep -q "$1 of [0-9]* files are not as they would be made now" err
}
each() { # each COMMAND...: with the record of the render and without it
    "$@" && FLUIDY_CACHE=off "$@"
}
change() { # change FILE BYTE: another value there
    local byte
    byte=$(od -An -tu1 -j "$2" -N 1 "$1")
    # shellcheck disable=SC2059 # the escape is the point
    printf "\\x$(printf %x $((byte ^ 1)))" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

paint now && each verify now && whole 6
result $? 'frames are as the command would paint them'
paint twice && same now twice && cmp -s now/w_0003.png twice/w_0003.png
result $? 'the same command gives frames that say the same'
verify now --layers 'l/{region}_%d.png'
[ $? = 1 ] && wrong 12 && grep -q 'l/red-aa3311_6.png: is missing' err && ! grep -q 'now/' err
result $? 'layers count as well, and frames are the same with them'

paint now -y --provenance made.json && sum=$(sha256sum <now/w_0003.png) && grep -q "now/w_0003.png\":\"${sum%% *}\"" made.json &&
    python3 -c 'import json; made = json.load(open("made.json")); assert len(made["sha256"]) == 6 and "w_0001.svg" in dict(made["facts"])' &&
    verify now && whole 6
result $? 'all that they were made from is listed on request'

for at in 40 300 -9; do
    cp now/w_0004.png kept.png
    change now/w_0004.png $((at < 0 ? $(stat -c %s now/w_0004.png) + at : at))
    each verify now
    [ $? = 1 ] && wrong 1 && grep -q 'now/w_0004.png: has changed since it was written' err
    result $? "a byte of a frame that was changed is found (at $at)"
    mv kept.png now/w_0004.png
done
mv now/w_0002.png w && verify now
[ $? = 1 ] && wrong 1 && grep -q 'now/w_0002.png: is missing' err
result $? 'a frame that is gone is found'
cp now/w_0003.png now/w_0002.png && each verify now
[ $? = 1 ] && wrong 1 && grep -q 'now/w_0002.png: was made from something else' err
result $? 'so is one that is another frame of the film'
mkdir other && drawing other/w_0001.svg 56 3 && "$program" other -s "$style" -o now/w_0002.png -y -q && verify now
[ $? = 1 ] && wrong 1 && grep -q 'now/w_0002.png: was made from something else' err
result $? 'one of another film is found'
rsvg-convert film/w_0002.svg -o now/w_0002.png && verify now
[ $? = 1 ] && wrong 1 && grep -q 'now/w_0002.png: \(does not say\|has changed\)' err
result $? 'so is one that another program has written'
mv w now/w_0002.png

paint now -y # so that its record is the last
cp -r film before
drawing film/w_0005.svg 56 4
verify now
[ $? = 1 ] && wrong 6 && grep -q 'since the last render, w_0005.svg has other contents' err
result $? 'a drawing that has changed is found and named'
rm -rf film && mv before film
verify now --gap 3
[ $? = 1 ] && wrong 6 && grep -q 'since the last render, gap was 0 and is 3' err
result $? 'so is another setting'
cp -r "$style" own
style=$PWD/own
paint now -y && each verify now && echo >>own/style.ini && verify now
[ $? = 1 ] && wrong 6 && grep -q 'since the last render, style own has other contents' err
result $? 'so is a style'

if command -v ffmpeg >/dev/null; then
    film() { # film FILE ARGUMENT...
        "$program" film -s "$style" -o "$1" --progress none "${@:2}" >out 2>err
    }
    for end in mov mkv webm gif apng; do
        film f/w.$end && film f/w.$end --verify && whole 7 && FLUIDY_CACHE=off film f/w.$end --verify && whole 7 &&
            ! film f/w.$end --verify --fps 12 && wrong 1 && grep -q "f/w.$end: was made from something else" err &&
            change f/w.$end 999 && ! film f/w.$end --verify && wrong 1 && grep -q "f/w.$end: has changed" err
        result $? "a film is verified with its frames, .$end"
        rm -r f
    done
    film f/w.mkv --no-frames && each film f/w.mkv --no-frames --verify && whole 1
    result $? 'and without them'
else
    skip 'a film is verified' 'no ffmpeg'
fi

paint stopped && cp -r stopped again && rm again/w_000[456].png && echo >again/w_0003.png && verify again
[ $? = 1 ] && wrong 4
result $? 'files that are no pictures are told like those that are missing'

echo "1..$n"
