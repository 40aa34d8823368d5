#!/bin/bash
# Fuzzes the targets of tests/fuzz for some seconds each; fails if one finds anything.
# usage: fuzz.sh BUILD-DIR [SECONDS [TARGET...]], in the source folder; the build has -Dfuzz=enabled.
#
# Seeds are the target's corpus and, for drawings and pictures, the fixtures. $CORPUS is a folder for
# new corpora, of which each target has one; without it they are dropped. $SEED is the seed, $RUNS
# how many runs are enough, $JOBS how many targets run at a time.
set -eu
build=$(cd "$1" && pwd)
seconds=${2:-20}
shift $(($# > 1 ? 2 : 1))
source=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export source build seconds work CORPUS=${CORPUS:-$work/new} SEED=${SEED:-1} RUNS=${RUNS:-1000000}
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:allocator_may_return_null=1:handle_abort=1}
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 OMP_NUM_THREADS=1 FLUIDY_CACHE=off
export LSAN_OPTIONS=suppressions=$source/tests/lsan.supp:print_suppressions=0

# plain FILE: a drawing, unpacked if it is packed
plain() {
    if [[ $1 == *.svgz ]]; then gzip -dc <"$1"; else cat "$1"; fi
}

# Drawings one by one, and films of two frames, as far as they are small enough to be quick.
mkdir -p "$work/svg" "$work/film"
for folder in fixtures/animations/*/; do
    name=$(basename "$folder")
    for file in "$folder"*.svg*; do
        [ -e "$file" ] || continue
        plain "$file" >"$work/frame"
        [ "$(stat -c %s "$work/frame")" -lt 65536 ] || continue
        if [ ! -e "$work/svg/$name" ]; then
            cp "$work/frame" "$work/svg/$name"
        else
            { cat "$work/svg/$name" && printf '<?frame?>' && cat "$work/frame"; } >"$work/film/$name"
            break
        fi
    done
done
find "$work/film" -size +32k -delete
# Pictures, alone, below a line that says how to use them, and several as a recording.
mkdir -p "$work/png" "$work/background" "$work/import"
for file in fixtures/style-small/frames/*.png; do
    cp "$file" "$work/png"
    { echo 1.png; cat "$file"; } >"$work/background/$(basename "$file")"
done
{ echo x0.5; cat fixtures/style-small/frames/*[1-4].png; } >"$work/import/small"
export -f plain

one() {
    local target=$1 seeds=() folder
    for folder in "$work/$target" "tests/corpora/$target"; do
        [ -d "$folder" ] && seeds+=("$folder")
    done
    local options=(-max_total_time="$seconds" -seed="$SEED" -runs="$RUNS" -max_len=65536
        -len_control=0 -timeout=600 -rss_limit_mb=4000 -print_final_stats=1
        -artifact_prefix="$build/$target-")
    case $target in
    svg | film | geometry | path) options+=(-dict=tests/fuzz/svg.dict) ;;
    esac
    # These two fork, and limit their children's memory. LibFuzzer's thread that watches their own could
    # hold the allocator's lock during a fork, and the child would wait for it for ever.
    # A replay looks for leaks.
    case $target in svg | film) options+=(-detect_leaks=0 -rss_limit_mb=0) ;; esac
    mkdir -p "$CORPUS/$target"
    if "$build/tests/fuzz/fuzz_$target" "${options[@]}" "$CORPUS/$target" "${seeds[@]}" \
        >"$work/$target.log" 2>&1; then
        echo "ok $target: $(grep -E '^#[0-9]+.DONE' "$work/$target.log" | tr '\t' ' ')" \
            "$(grep 'below us' "$work/$target.log" || true)"
    else
        tail -60 "$work/$target.log"
        echo "not ok $target: see above"
        return 1
    fi
}
export -f one

if [ $# = 0 ]; then
    mapfile -t targets < <(sed -n "s/^  '\([a-z]*\)': {.*/\1/p" tests/fuzz/meson.build)
    set -- "${targets[@]}"
fi
printf '%s\n' "$@" | xargs -P "${JOBS:-2}" -I '{}' bash -c 'one {}'
