#!/bin/bash
# Frames, films and regions of odd sizes. usage: sizes.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

svg() { # svg FILE WIDTH HEIGHT BODY
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='$2' height='$3'>$4</svg>" >"$1"
}
number() { # number FILE OFFSET: four bytes, the largest first
    od -An -tu1 -j"$2" -N4 "$1" | { read -r a b c d && echo $((((a * 256 + b) * 256 + c) * 256 + d)); }
}
painted() { # painted SENTENCE FILE WIDTH HEIGHT ARGUMENT...: paints, and the picture has that size
    local sentence=$1 file=$2 width=$3 height=$4
    shift 4
    timeout 120 "$program" -s "$style" --progress none "$@" >out 2>err && [ ! -s out ] &&
        ! grep -q 'nan' err && [ "$(number "$file" 16)" = "$width" ] && [ "$(number "$file" 20)" = "$height" ]
    result $? "$sentence"
}
rm -rf film
mkdir one && svg one/a_1.svg 1 1 "<rect width='1' height='1' fill='#aa3311'/>"
painted 'a frame of one pixel' one_1.png 1 1 one -o 'one_%d.png'
mkdir dot && svg dot/a_1.svg 48 32 "<rect x='20' y='9' width='1' height='1' fill='#aa3311'/>"
svg dot/a_2.svg 48 32 "<rect x='21' y='9' width='1' height='1' fill='#aa3311'/>"
painted 'a region of one pixel that moves' dot_2.png 48 32 dot -o 'dot_%d.png'
mkdir thin && svg thin/a_1.svg 48 32 "<rect x='20' width='.2' height='32' fill='#aa3311'/>"
painted 'a region thinner than a pixel' thin_1.png 48 32 thin -o 'thin_%d.png'
mkdir row && svg row/a_1.svg 90 1 "<rect width='90' height='1' fill='#aa3311'/>"
painted 'a frame of one row' row_1.png 90 1 row -o 'row_%d.png'
mkdir column && svg column/a_1.svg 1 90 "<rect width='1' height='90' fill='#aa3311'/>"
painted 'a frame of one column' column_1.png 1 90 column -o 'column_%d.png'

# larger than the exemplar, which has 64 x 48 px, and touching all edges
mkdir full
for i in 1 2 3; do
    svg full/a_$i.svg 150 130 "<rect width='150' height='130' fill='#aa3311'/>
        <circle cx='$((60 + 5 * i))' cy='60' r='9' fill='#2255aa'/>"
done
painted 'a region that is the whole frame, larger than the exemplar' full_3.png 150 130 full -o 'full_%d.png'
ffmpeg -v error -i full_3.png -f rawvideo -pix_fmt rgb24 - </dev/null | od -An -v -tu1 -w3 |
    awk '$1 > 240 && $2 > 235 && $3 > 225 { bare++ } END { exit bare > NR / 20 }'
result $? 'and nearly all of it is painted'
mkdir beyond
for i in 1 2 3; do
    svg beyond/a_$i.svg 64 64 "<circle cx='$((i * 40 - 60))' cy='30' r='40' fill='#aa3311'/>"
done
painted 'a region that comes in from outside the frame' beyond_3.png 64 64 beyond -o 'beyond_%d.png'
mkdir still && for i in 1 2 3; do cp dot/a_1.svg still/a_$i.svg; done
painted 'a film in which nothing moves' still_3.png 48 32 still -o 'still_%d.png'
same still_1.png still_3.png
result $? 'stands still'
mkdir come
svg come/a_1.svg 48 32 "<g/>"
svg come/a_2.svg 48 32 "<circle cx='20' cy='16' r='9' fill='#aa3311'/>"
svg come/a_3.svg 48 32 ''
svg come/a_4.svg 48 32 "<circle cx='40' cy='16' r='9' fill='#aa3311'/>"
painted 'a region that comes, goes and comes again elsewhere' come_4.png 48 32 come -o 'come_%d.png'
same come_1.png come_3.png && ! same come_2.png come_4.png
result $? 'leaves nothing behind'
timeout 120 "$program" -s "$style" --progress none full -f 2 -o 'second_%d.png' >out 2>err && [ -e second_2.png ]
result $? 'a film of one of many frames'

# as large as film gets: a small shape, so that it is painted soon; memory that is never written is
# none, but Meson has malloc() write it
unset MALLOC_PERTURB_
mkdir large && svg large/a_1.svg 8192 4320 "<circle cx='40' cy='40' r='24' fill='#aa3311'/>"
painted 'a frame of 8192x4320 pixels' large_1.png 8192 4320 large -o 'large_%d.png'
grep -qE 'memory: at most [0-9]{1,3} MiB' err || [ -n "${ASAN_OPTIONS:-}" ]
result $? 'takes less than a gigabyte'

echo "1..$n"
