#!/bin/bash
# Paint that is kept: only what changed is painted, and the frames are those of a render from nothing.
# usage: cache.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"
red=red-aa3311 blue=blue-2255aa

# kept FOLDER ARGUMENT...: paints with the cache into an empty folder.
kept() {
    rm -rf "$1"
    paint "$@" --cache kept
}

# anew FOLDER ARGUMENT...: the same without.
anew() {
    paint "$@" -y --cache off
}

# took TAKEN PAINTED: the summary says so.
took() {
    grep -q "$1 pictures from the cache, $2 painted" err
}

# like_anew ARGUMENT...: the frames in `now` are those of a render from nothing.
like_anew() {
    cp err told
    anew nothing "$@"
    cp told err
    same now nothing
}

regions=$("$program" film -s "$style" --list-regions | awk 'NR > 1 && $6 == "yes" {print $1}')
read -r blue red <<<"$(tr '\n' ' ' <<<"$regions")"
anew whole
kept first
! grep -q 'from the cache' err && same first whole
result $? 'the first render takes nothing and paints what a render without a cache does'
kept again && took 12 0 && same again whole
result $? 'the second one paints nothing, and its frames are the same'

for option in '--tint #336699' '--background #ffeeaa' '--medium opaque' '--paper rough' '--blend linear'; do
    # shellcheck disable=SC2086 # two words
    kept now $option && took 12 0 && like_anew $option
    result $? "${option%% *} paints nothing"
done
"$program" film -s "$style" --cache kept -o now.exr/w_%04d.exr >out 2>err && took 12 0
result $? 'nor does another format'
kept now --region "$red" && took 6 0 && like_anew --region "$red"
result $? 'nor does a region alone'

printf '[region %s]\nw-temp = 9\n' "$blue" >one.conf
kept now -c one.conf && took 6 6 && like_anew -c one.conf &&
    grep -q "region $blue: painted 6 of 6 pictures, since w-temp was 5 and is 9" err
result $? 'a setting of one region paints that region, and the summary says why'
kept now --w-temp 7 && kept now --w-temp 8 && [ "$(grep -c ', since ' err)" = 1 ] &&
    grep -q '2 regions: painted 12 of 12 pictures, since w-temp was 7 and is 8' err
result $? 'regions that are painted for one reason share a line'
kept now -c one.conf --stats now.json && [ "$(grep -c '"taken":true' now.json)" = 12 ] && rm now.json
result $? '--stats has a line for each picture that was taken'
for option in '--seed 3' '--boil 0.5' '--carry 0' '--detail draft' '--width 60'; do
    # shellcheck disable=SC2086
    kept now $option && ! grep -q 'from the cache' err && like_anew $option
    result $? "${option%% *} paints everything"
done
for option in '--hold 2' '--loop' '--edges soft'; do
    # shellcheck disable=SC2086
    kept now $option && kept now $option && grep -q ' 0 painted' err && like_anew $option
    result $? "$option is taken the second time, and is the same"
done

cp -r film before
drawing film/w_0005.svg 56 4
kept now && like_anew
found=$?
painted=$(sed -n 's/.*cache, \([0-9]*\) painted/\1/p' err)
[ $found = 0 ] && [ "$painted" -ge 2 ] && [ "$painted" -lt 12 ]
result $? "an edited frame paints what its guides change ($painted of 12) and no more"
# Guides look ahead until the shape has left a place: a disc that crosses the page swiftly does so soon.
swift() { # swift FRAME X
    printf "<svg xmlns='http://www.w3.org/2000/svg' width='56' height='56' viewBox='0 0 48 48'>%s</svg>" \
        "<circle cx='$2' cy='24' r='7' fill='#aa3311'/>" >"film/w_$(printf %04d "$1").svg"
}
rm film/*
places=(8 16 24 32 40 32 24 16 8 16 24 32 40 32)
for i in "${!places[@]}"; do
    swift $((i + 1)) "${places[i]}"
done
kept early
swift 13 42
kept now && like_anew
found=$?
painted=$(sed -n 's/.*cache, \([0-9]*\) painted/\1/p' err)
[ $found = 0 ] && [ "$painted" -ge 2 ] && [ "$painted" -le 9 ]
result $? "of a shape that moves on, no more than the last frames ($painted of 14)"
same_until() { # same_until FRAME: the frames before it have the same bytes
    local i
    for ((i = 1; i < $1; i++)); do
        same "now/w_$(printf %04d "$i").png" "early/w_$(printf %04d "$i").png" || return 1
    done
}
same_until $((15 - painted))
result $? 'and the frames before them are as they were'
rm -rf film && cp -r before film
kept now && took 12 0 && same now whole
result $? 'the edit undone paints nothing'

damage() { # damage SUFFIX NUMBER: of the cache's files
    local file
    file=$(find kept -name "*.$1" -size +64c | sort | sed -n "$2p")
    printf 'x' | dd of="$file" bs=1 seek=40 conv=notrunc status=none
}
rm -rf kept && kept now
damage picture 7
kept now && [ "$(grep -c 'warning\|damaged' err)" -ge 1 ] && same now whole
result $? 'a damaged picture is a warning, and it is painted again'
kept now && took 12 0 && same now whole
result $? 'once'
find kept -name '*.picture' | sort | sed -n '4p;9p' | xargs truncate -s 11
find kept -name '*.film' -exec truncate -s 20 {} +
kept now && same now whole
result $? 'files that were cut short are painted again as well'
find kept -name '*.picture' | sort | sed -n '3p;5p' | xargs rm
kept now && same now whole && ! grep -q damaged err
result $? 'files that are gone are missed by nobody'

rm -rf kept && kept now
for file in $(find kept -name '*.picture' | sort | sed -n '2p;6p') $(find kept -name '*.film' | head -n 1); do
    rm "$file"
    mkfifo "$file"
done
kept now && same now whole && [ -z "$(find kept -name '*.film' -type p)" ]
result $? 'a pipe in the place of a file does not hang the render'
ln -sf "$PWD/whole/w_0001.png" "$(find kept -name '*.picture' | sort | head -n 1)"
kept now && same now whole
result $? 'nor is a link followed'

# forge SUFFIX OFFSET BYTES: writes into the cache's files, and makes their checksums right again.
forge() {
    python3 -c '
import pathlib, struct, sys, zlib
suffix, offset, new = sys.argv[1], int(sys.argv[2]), bytes.fromhex(sys.argv[3])
for path in pathlib.Path("kept").rglob("*." + suffix):
    data = bytearray(path.read_bytes())
    data[16 + offset:16 + offset + len(new)] = new
    path.write_bytes(data[:8] + struct.pack("<I", zlib.crc32(data[16:])) + data[12:])
' "$@"
}
forged() { # forged SENTENCE SUFFIX OFFSET BYTES
    rm -rf kept && kept now
    forge "${@:2}"
    kept now && same now whole
    result $? "$1"
}
forged 'a forged number of pictures does no harm' film 0 ffffffffffffff7f
forged 'nor does one that is a little too small' film 0 0500000000000000
forged 'nor a forged place beyond the page' film 8 f0ffff7ff0ffff7f
forged 'nor a forged size' film 16 ffffff7fffffff7f
forged 'nor forged digests' film 30 aaaaaaaaaa
forged 'nor a forged size of a state' picture 0 ffffffffffffffff
forged 'nor a forged state' picture 12 ffffff7fffffff7fffffff7fffffff7f
rm -rf kept && kept now
find kept -name '*.film' -delete
find kept -name '*.picture' -printf '%T@ %p\n' | sort -n | tail -n 2 | cut -d ' ' -f 2 | xargs rm
forge picture 12 ffffff7fffffff7fffffff7fffffff7f
kept now && same now whole
result $? 'also where painting would go on from it'

# With a key, what somebody else has written is not taken.
head -c 40 /dev/urandom >key
head -c 40 /dev/urandom >other
rm -rf kept
FLUIDY_CACHE_KEY=key kept now && FLUIDY_CACHE_KEY=key kept now && took 12 0 && same now whole
result $? 'a cache with a key is taken with that key'
FLUIDY_CACHE_KEY=other kept now && ! grep -q 'from the cache' err && same now whole
result $? 'not with another one'
kept now && ! grep -q 'from the cache' err && FLUIDY_CACHE_KEY=key kept now && ! grep -q 'from the cache' err
result $? 'nor without one, nor is what has none'
FLUIDY_CACHE_KEY=missing kept now
[ $? = 2 ] && says 'FLUIDY_CACHE_KEY: missing'
result $? 'a key that is not there is one message'

again() { # again ARGUMENT...: the same command, where its frames are
    paint now "$@" --cache kept
}

kept now && again && grep -q 'nothing to do: 6 frames' err && ! grep -q painted err && same now whole
result $? 'a repeated command has nothing to do, and says so'
again -y && grep -q 'nothing to do' err && same now whole
result $? 'also with -y'
paint now -y --cache off && grep -q 'painted 6 frames' err && same now whole
result $? 'but paints all without a cache'
kept now
touch now/w_0003.png
again && grep -q 'nothing to do' err
result $? 'nor if a frame was only touched: its digest counts'
printf x | dd of=now/w_0003.png bs=1 seek=50 conv=notrunc status=none
touch -r now/w_0002.png now/w_0003.png
again
[ $? = 1 ] && grep -q 'already exists' err && again -y && took 12 0 && same now whole
result $? 'a frame that was changed is made again, whatever its size and time'
drawing film/w_0005.svg 56 4
again -y && grep -q 'painted 6 frames' err && ! same now whole
result $? 'so is one whose drawing has changed'
rm -rf film && cp -r before film
kept now
again -y --tint '#336699' && grep -q 'painted 6 frames' err && ! same now whole
result $? 'and another command is not the same'
kept now -c one.conf
sed -i 's/9/8/' one.conf
again -y -c one.conf && grep -q 'painted 6 frames' err
result $? 'nor is a config that was edited'
printf '[defaults]\nhold = 1\n' >two.conf
kept now -c one.conf -c two.conf && again -c one.conf -c two.conf && grep -q 'nothing to do' err
result $? 'two configs are the same command as well'
sed -i 's/8/9/' one.conf
again -y -c one.conf -c two.conf && grep -q 'painted 6 frames' err
result $? 'unless one of them was edited'
sed -i 's/9/8/' one.conf
kept now -c one.conf
again -y -c <(cat one.conf) && again -y -c <(sed 's/8/7/' one.conf) && grep -q 'painted 6 frames' err
result $? 'nor one that comes through a pipe'
cp -r "$style" own
kept now -s "$PWD/own" && again -s "$PWD/own" && grep -q 'nothing to do' err
sed -i 's/^title.*/&s/' own/style.ini && echo >>own/style.ini
again -y -s "$PWD/own" && grep -q 'painted 6 frames' err && same now whole
result $? 'nor a style whose files were edited'
sed -i 's|</svg>|<image href="late.png" width="9" height="9"/></svg>|' film/w_0002.svg
kept now && again && grep -q 'nothing to do' err
cp now/w_0001.png film/late.png
again -y && grep -q 'painted 6 frames' err && ! same now whole
result $? 'nor a picture that was missing and came'
rm -rf film && cp -r before film
kept now
rm now/w_0002.png
again --no-clobber && grep -q 'painted 6 frames' err && same now whole &&
    again --no-clobber && grep -q 'nothing to do: 6 frames exist and are kept' err
result $? 'frames that are to be kept and are all there are left alone'
rm -rf now
if command -v ffmpeg >/dev/null; then
    film() { # film ARGUMENT...: the frames and their film
        "$program" film -s "$style" -o now/w.mkv --progress none --cache kept "$@" >out 2>err
    }
    film && mv now/w.mkv whole.mkv && film && grep -q 'made of 6 frames' err &&
        ! grep -q 'painted 6' err && same now/w.mkv whole.mkv && film && grep -q 'nothing to do' err
    result $? 'a film whose frames are all there is only encoded, and has the same bytes'
    film -y --fps 12 && grep -q 'made of 6 frames' err && ! same now/w.mkv whole.mkv
    result $? 'so is one at another speed'
    rm -r now
else
    skip 'a film whose frames are all there is only encoded' 'no ffmpeg'
fi

echo >file
rm -rf now
paint now -y --cache file && [ "$(grep -c 'cannot be written' err)" = 1 ] && same now whole
result $? 'where a cache cannot be written there is one warning, and the frames'
env FLUIDY_CACHE="$folder/mine" "$program" film -s "$style" -o mine_%04d.png -q && [ -d mine ] &&
    rm mine_*
result $? 'FLUIDY_CACHE says where'

mkdir -p big/film
for i in 1 2 3 4 5 6; do
    drawing big/film/w_000$i.svg 400 $i
done
(cd big && "$program" film -s "$style" -o w_%04d.png --cache ../large --cache-size 1 -q --detail draft)
[ "$(du -sk large | cut -f1)" -le 1024 ] && [ -n "$(find large -name '*.picture')" ]
result $? 'a cache stays below its limit'

rm -rf kept
for i in 1 2 3; do
    "$program" film -s "$style" -o "at$i/w_%04d.png" --cache kept -q &
done
wait
same at1 whole && same at2 whole && same at3 whole && [ -z "$(find kept -name 'new-*')" ]
result $? 'three processes share a cache'

for k in 1 2 3; do
    rm -rf kept now
    [ $k = 1 ] || kept now --frames 1-4
    rm -rf now
    "$program" film -s "$style" -o 'now/w_%04d.png' --progress none --cache kept >out 2>err &
    job=$!
    while [ ! -e now/w_000$k.png ] && kill -0 $job 2>/dev/null; do
        sleep 0.002
    done
    kill -KILL $job 2>/dev/null
    wait $job 2>/dev/null
    [ $k = 3 ] && rm -rf kept
    [ ! -e now/.w_%04d.png.state ] || paint now --cache kept
    [ $? = 0 ] && same now whole
    result $? "a render that was killed at frame $k goes on with its cache, or without it"
done
kept now && same now whole
result $? 'and leaves one that serves the next'

# page FOLDER SHAPE: two frames of a page of one colour that lies over a shape.
page() {
    mkdir "$1"
    for i in 1 2; do
        echo "<svg xmlns='http://www.w3.org/2000/svg' width='56' height='56' viewBox='0 0 48 48'>$2" \
            "<path id='page' d='M0,0h48v48h-48z' fill='#2255aa'/></svg>" >"$1/w_$i.svg"
    done
}

# of_page FOLDER TO ARGUMENT...: paints it.
of_page() {
    rm -rf "$2"
    "$program" "$1" -s "$style" -o "$2/%d.png" --progress none -y "${@:3}" >out 2>err
}

page bare ''
page over "<path id='below' d='M9,9h20v20h-20z' fill='#aa3311'/>"
rm -rf kept
of_page bare bare.png --cache off && of_page over over.png --cache kept && same bare.png over.png &&
    of_page over over.png --cache kept && took 2 0 && ! grep -q damaged err && same bare.png over.png
result $? 'what others hide in all frames is not painted, and its shapes are not asked for again'
of_page over apart.png --cache kept --layers 'layers/{region}/%d.png' && took 2 2 &&
    of_page over over.png --cache kept && took 4 0 && same bare.png over.png
result $? 'but it is where layers are stored'

mkdir time
echo "<svg xmlns='http://www.w3.org/2000/svg' width='48' height='48'>" \
    "<path d='M4,9h16v22h-16z' fill='#aa3311'><animateTransform attributeName='transform'" \
    "type='translate' from='0 0' to='24 0' dur='2s' repeatCount='indefinite'/></path></svg>" >time/moving.svg
in_time() { # in_time FOLDER ARGUMENT...: paints its first frames
    rm -rf "$1"
    "$program" time/moving.svg -s "$style" -f 1-4 -o "$1/%d.png" --progress none "${@:2}" >out 2>err
}
in_time now --fps 6 --cache kept && in_time now --fps 12 --cache kept &&
    in_time nothing --fps 12 --cache off && same now nothing
result $? 'a drawing that moves is painted anew at another speed'
in_time now --fps 12 --cache kept && grep -q '4 pictures from the cache, 0 painted' err
result $? 'and taken at the same one'

echo "1..$n"
