#!/bin/bash
# The bundled styles from their recipes and pictures, byte for byte. usage: rebuild.sh PROGRAM STYLES; speaks TAP.
# A minute or two of simulation, so it is a benchmark: it also tells the cost of a frame.
set -u
export LC_ALL=C
program=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
n=0
for style in "$2"/*/; do
    name=$(basename "$style")
    [ -e "$style/recipe.ini" ] || [ -e "$style/transport.png" ] || continue # a still: fixtures/fluids/simulate.py
    n=$((n + 1))
    start=$(date +%s%N)
    if [ -e "$style/recipe.ini" ]; then
        "$program" simulate -q "$style/recipe.ini" -o "$folder/$name" 2>"$folder/err"
    else # its picture is not made by the program, but what moves ink is
        cp -r "$style" "$folder/$name" && rm "$folder/$name/transport.png" &&
            "$program" transport -q "$folder/$name" 2>"$folder/err"
    fi
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
