#!/bin/bash
# Films in three styles against their recordings, see scores.c: a line each.
#
# usage: scores.sh PROGRAM SCORES STYLES ANIMATIONS [OPTION...]
# Options are of fluidy-svg, such as --w-dir 1: run it twice to compare. The bundled animations are
# short, but for the snowman; $FILMS names others, of which the first 12 frames are painted.
set -eu
program=$1 scores=$2 styles=$3 animations=$4
shift 4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export FLUIDY_CACHE=off FLUIDY_STYLES=$styles
printf '%-28s sharp   std  edge flicker  used    rim (of)\n' "${*:-defaults}"
for style in 01 02 05; do
    for film in ${FILMS:-snowman-wave-layers ghost-morph strutter-zdog}; do
        frames=$(find "$animations/$film" -name '[0-9]*.svg*' -printf '%f\n' | sort | head -n 12)
        frames=$(echo "$frames" | sed 's/[.].*//; s/^0*//' | paste -sd,)
        rm -rf "$folder/dump"
        "$program" "$animations/$film" -f "$frames" -W 300 -s $style --style-by-page off -q "$@" -o "$folder/%d.png" -y \
            --dump "$folder/dump" --paint "$folder/dump/{region}/paint_%04d.png"
        "$scores" "$styles/$style" "$folder/dump" "$style $film"
    done
done
