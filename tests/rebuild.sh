#!/bin/bash
# The bundled styles from their recipes, byte for byte. usage: rebuild.sh PROGRAM STYLES; speaks TAP.
# A minute or two of simulation, so it is a benchmark: it also tells the cost of a frame.
set -u
export LC_ALL=C
program=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
n=0
for style in "$2"/*/; do
    name=$(basename "$style")
    n=$((n + 1))
    start=$(date +%s%N)
    "$program" simulate -q "$style/recipe.ini" -o "$folder/$name" 2>"$folder/err"
    took=$(($(date +%s%N) - start))
    if found=$(diff -rq --exclude=recipe.ini "$style" "$folder/$name"); then
        frames=$(find "$folder/$name/frames" -name '*.png' | wc -l)
        echo "ok $n - $name is rebuilt byte for byte, $((took / frames / 1000000)) ms a frame"
    else
        echo "not ok $n - $name is rebuilt byte for byte"
        { cat "$folder/err" && echo "$found"; } | sed 's/^/# /' | head -20
    fi
done
echo "1..$n"
