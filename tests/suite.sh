#!/bin/bash
# How near drawings come to librsvg's pictures of them, region by region without paint.
# usage: suite.sh FOLDER [PROGRAM [LIST]]: counts for every .svg below FOLDER; LIST gets a line each.
# $JOBS at a time (1), each for $LIMIT seconds (10), with 4 GiB.
set -u
folder=$(realpath "$1")
program=$(realpath "${2:-${0%/*}/../build/src/cli/fluidy-svg}")
list=$(realpath -m "${3:-/dev/null}")
psnr=$(dirname "$program")/../../tests/psnr
export program psnr folder LIMIT=${LIMIT:-10} LC_ALL=C.UTF-8 OMP_NUM_THREADS=1
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
cd "$temporary" || exit 1

one() { # one FILE: its verdict, dB, name and the program's last words
    local file=$1 name=${1#"$folder"/} made status size db verdict what
    made=$(mktemp -d -p .)
    ulimit -v 4194304
    timeout "$LIMIT" rsvg-convert --unlimited "$file" -o "$made/truth.png" 2>/dev/null || rm -f "$made/truth.png"
    size=()
    timeout -k 1 "$LIMIT" "$program" --flat --frames-from files -y -o "$made/flat_%d.png" "$file" >/dev/null 2>"$made/err"
    status=$?
    if grep -q 'no size and no viewBox' "$made/err" && [ -s "$made/truth.png" ]; then
        size=(--canvas "$("$psnr" "$made/truth.png")")
        timeout -k 1 "$LIMIT" "$program" --flat --frames-from files -y "${size[@]}" -o "$made/flat_%d.png" "$file" \
            >/dev/null 2>"$made/err"
        status=$?
    fi
    mv "$made"/flat_*.png "$made/flat.png" 2>/dev/null
    db=- what=$(grep -v ' flat: ' "$made/err" | head -1)
    if [ $status = 124 ] || [ $status = 137 ]; then
        verdict=time
    elif [ $status -ge 126 ]; then
        verdict=crash
    elif [ ! -s "$made/truth.png" ]; then
        verdict=none
    elif [ $status != 0 ]; then
        verdict=error
    else
        db=$("$psnr" "$made/truth.png" "$made/flat.png" || echo 0)
        case $db in [4-9]?.?) ;; *) db=$(once_larger) ;; esac
        case $db in
        [4-9]?.?) verdict=good ;;
        3?.?) verdict=near ;;
        *) [ -n "$what" ] && verdict=warned || verdict=silent ;;
        esac
    fi
    printf '%s\t%s\t%s\t%s\n' "$verdict" "$db" "$name" "$what"
    rm -rf "$made"
}


# Small drawings whose size is no whole number of pixels are scaled a little, and their edges move.
once_larger() { # of $file and $made: dB where the page has 640 px
    timeout "$LIMIT" rsvg-convert --unlimited -w 640 "$file" -o "$made/large.png" 2>/dev/null
    timeout -k 1 "$LIMIT" "$program" --flat --frames-from files -y -W 640 "${size[@]}" -o "$made/large_%d.png" "$file" \
        >/dev/null 2>"$made/more"
    "$psnr" "$made/large.png" "$made"/large_*.png || echo "$db"
}
export -f one once_larger

find "$folder" -name '*.svg' -print0 | sort -z |
    nice xargs -0 -n 1 -P "${JOBS:-1}" bash -c 'one "$0"' >"$temporary/all"
cp "$temporary/all" "$list"
count() { # count VERDICT TEXT
    printf '%5d  %s\n' "$(grep -c "^$1" "$temporary/all")" "$2"
}
count '' "drawings"
count good "40 dB and more"
count near "30 to 40 dB"
count warned "below, with a warning"
count silent "below, without"
count error "error where rsvg-convert draws"
count crash crash
count time "over $LIMIT s"
count none "rsvg-convert draws nothing either"
