#!/bin/bash
# Drawings that resist being taken apart look as rsvg-convert, or a browser, draws them, in as many regions as can be.
# usage: differences.sh PROGRAM FIXTURES PSNR
. "${0%/*}/tap.sh"
program=$(realpath "$1") drawings=$(realpath "$2")/differences psnr=$(realpath "$3") db=-
cd "$folder" || exit 1

# What cannot be taken apart at all is one region.
table() {
    cat <<'EOF'
blend-alone-in-an-isolated-group 1
blend-in-a-masked-group 1
blend-in-an-isolated-group 2
blend-of-a-group 2
clip-by-a-hidden-box 1
context-paint 3
elements-from-an-entity 1
filter-of-a-group 2
filter-of-the-background 3
filter-of-the-root 2
marker-from-a-style 2
marker-of-a-group 2
mask-over-overlapping-shapes 2
masks-in-masks-and-clips 4
opacity-of-a-group 2
opacity-of-a-stroked-shape 2
sheet-from-a-file 2
switch-by-an-empty-extension 2
use-below-a-descendant-selector 3
use-of-a-symbol-with-a-transform 2
use-of-an-svg 3
EOF
}

echo "1..$(table | wc -l)"
while read -r name wanted; do
    "$program" --flat -y -o 'flat_%d.png' "$drawings/$name.svg" >out 2>err &&
        db=$("$psnr" flat_1.png "$drawings/$name.png") &&
        regions=$("$program" --list-regions "$drawings/$name.svg" 2>>err | tail -n +2 | wc -l)
    echo "$db dB, $regions regions, $wanted expected" >>out
    [[ $db == [4-9]?.? && $regions = "$wanted" ]]
    result $? "${name//-/ }"
done < <(table)
