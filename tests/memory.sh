#!/bin/sh
# Peak memory of long films: 100 and 400 frames of 1000x800 with one region of 111,000 pixels.
#
# usage: memory.sh FLUIDY_SVG [OPTION…]     options as --detail draft are handed on
#
# Fails where 400 frames need more than 512 MiB, or a tenth more than 100 frames do. Takes minutes.
set -eu
program=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export OMP_WAIT_POLICY=passive LC_ALL=C FLUIDY_CACHE=off

# A blob of three lobes that turns, breathes and drifts.
awk -v folder="$folder" 'BEGIN {
    pi = atan2(0, -1); radius = sqrt(111000 / (1.02 * pi))
    for (f = 1; f <= 400; f++) {
        file = sprintf("%s/f_%04d.svg", folder, f); phase = f * 0.12
        printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1000\" height=\"800\">" > file
        printf "<path id=\"blob\" fill=\"#336699\" d=\"" > file
        for (k = 0; k < 180; k++) {
            a = k * pi / 90; r = radius * (1 + 0.2 * (1 + 0.2 * sin(phase)) * sin(3 * a + phase))
            printf "%s%.2f,%.2f", k ? "L" : "M", 500 + 8 * sin(phase) + r * cos(a), \
                400 + 8 * cos(0.7 * phase) + r * sin(a) > file
        }
        print "Z\"/></svg>" > file
        close(file)
    }
}'

peak() { # of so many frames, in MiB
    frames=$1
    shift
    "$program" -s 02 -f "1-$frames" -y -o "$folder/out_%04d.png" --progress none "$@" \
        "$folder/f_%04d.svg" 2>&1 | sed -n 's/.*memory: at most \([0-9]*\) MiB.*/\1/p'
}

# The peak depends on what happens to overlap, by some percent: of two short films the larger.
short=$(printf '%s\n' "$(peak 100 "$@")" "$(peak 100 "$@")" | sort -n | tail -1)
long=$(peak 400 "$@")
echo "peak memory: 100 frames $short MiB, 400 frames $long MiB"
[ "$long" -le 512 ] && [ "$((long * 10))" -le "$((short * 11))" ]
