#!/bin/bash
# Runs tests in a build that watches memory, threads or arithmetic, or has the sources analysed.
# usage: sanitize.sh address|fuzz|thread|memcheck|analysers|bare BUILD-DIR, in the source folder; each has a
# folder of its own, but address and fuzz share one, and memcheck and analysers may have that of an ordinary build.
#
# address: tests with AddressSanitizer, LeakSanitizer and UndefinedBehaviorSanitizer of clang: units but for the long ones,
#   corpora, hostile drawings, faults of the system, and a render from paint that is kept. The other scripts paint as
#   these do, in seven times the time of a plain build; HACKING.md says how to run all of them.
# fuzz: every target of tests/fuzz for 20 seconds, in the same build.
# thread: what uses threads, ThreadSanitizer with clang. gcc's reports false races in OpenMP; Archer
#   tells clang's what OpenMP orders, and tsan_glib.c what GLib does. GLib's own slices, handed from
#   a thread that has ended to the next, would be taken for shared.
#   It also fails if clang warns of anything; .ci/run builds with gcc so.
# bare: every optional feature off; what is left is built without warnings, and what would use
#   a feature does without.
# memcheck: a short render in valgrind.
# analysers: cppcheck and clang-tidy; tests/cppcheck.supp and .clang-tidy say what is left out.
set -eu
what=$1
build=$2
source=$PWD
export OMP_WAIT_POLICY=passive FLUIDY_CACHE=off FLUIDY_FIXTURES=$source/fixtures

# What is made by other programs is tried in the ordinary build.
plain=(-Dapi=disabled -Dpython=disabled)
# Lines are enough to say where; it builds a fifth sooner.
make_build() {
    [ -f "$build/build.ninja" ] || meson setup "$build" -Dbuildtype=debugoptimized -Ddebug=false -Dc_args=-g1 "$@"
}

# A render on several threads, and all that can be written beside it.
render=("$build/src/cli/fluidy-svg" -s fixtures/style-small -W 64 -f 1-2 -j 3 --progress none -y
    -o "$build/render/%d.png" fixtures/animations/snowman-wave-layers)
beside=(--report "$build/render/report" --stats "$build/render/stats")

case $what in
address | fuzz)
    export CC=clang
    make_build -Dfuzz=enabled -Db_sanitize=address,undefined -Db_lundef=false "${plain[@]}"
    if [ "$what" = fuzz ]; then
        ninja -C "$build" fuzzers
        exec tests/fuzz.sh "$build" 20
    fi
    export ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
    export LSAN_OPTIONS=suppressions=$source/tests/lsan.supp:print_suppressions=0
    # Meson builds what these tests need.
    run=(meson test -C "$build" --timeout-multiplier 6 --print-errorlogs)
    "${run[@]}" faults hostile
    "${run[@]}" --suite kernels --suite corpora
    # These look at pictures of whole renders, whose code other tests run.
    looks=(/lazy/contrast-stays-where-use-is-equal-and-goes-where-it-is-not
        /maps/maps_change_the_paint_where_they_are_dark /paint/a_cut_out_brings_its_own_alpha
        /wet/a-stain-stays-in-place-between-cells /wet/a-tide-and-a-moon-leave-the-paper-as-it-is
        /wet/ground-is-stained-and-a-face-is-not)
    "${run[@]}" --suite unit --test-args="${looks[*]/#/-s }"
    rm -rf "$build/cache"
    for _ in painted kept; do
        rm -rf "$build/render" # else there is nothing to do
        "${render[@]}" --cache "$build/cache"
    done
    ;;
bare)
    make_build --werror -Dopenmp=disabled -Dsimd=disabled -Dexr=disabled -Dora=disabled -Dwebp=disabled -Dsandbox=disabled -Dserve=disabled -Dman=disabled
    ninja -C "$build" src/cli/fluidy-svg src/cli/fluidy-style
    meson test -C "$build" --print-errorlogs kernels child distance film_object formats options paper render \
        sandbox schedule sink synth synth_cases task workers
    ;;
thread)
    export CC=clang
    make_build --werror -Db_sanitize=thread -Db_lundef=false "${plain[@]}"
    programs=(distance film guides holds layers synth synth_cases watercolour)
    ninja -C "$build" src/cli/fluidy-svg src/cli/fluidy-style "${programs[@]/#/tests/test_}"
    clang -D_GNU_SOURCE -shared -fPIC -Wl,--unresolved-symbols=ignore-all \
        $(pkg-config --cflags glib-2.0) tests/tsan_glib.c -o "$build/tsan_glib.so"
    archer=$(clang -print-file-name=libarcher.so)
    [ -f "$archer" ] || archer=$(find /usr/lib/llvm-* -name libarcher.so | head -1)
    [ -f "$archer" ] || { echo 'no libarcher.so: it is in libomp-dev'; exit 1; }
    export OMP_TOOL_LIBRARIES=$archer OMP_NUM_THREADS=3 LD_PRELOAD=$build/tsan_glib.so
    export G_SLICE=always-malloc
    export TSAN_OPTIONS='ignore_noninstrumented_modules=1 exitcode=66 halt_on_error=1'
    for program in "${programs[@]}"; do
        "$build/tests/test_$program"
    done
    "${render[@]}" "${beside[@]}"
    # without a report, files are written while the next frame is painted
    "${render[@]}" -f 1-3
    ;;
memcheck)
    make_build
    ninja -C "$build" src/cli/fluidy-svg
    FLUIDY_CPU_MASK=3 valgrind -q --suppressions=tests/memcheck.supp --error-exitcode=66 "${render[@]}" "${beside[@]}" -j 1
    ;;
analysers)
    make_build
    cppcheck -q -j "$(nproc)" --std=c11 --enable=warning,performance,portability --library=gtk \
        --suppressions-list=tests/cppcheck.supp '-DG_GNUC_PRINTF(a,b)=' -I include -I src \
        -i src/synth/arm --error-exitcode=66 src
    # paths through a function end after 60,000 states instead of 225,000, in two fifths of the time
    window=src/cli/window.c # needs headers that are not on every machine
    pkg-config --exists webkit2gtk-4.1 && window=
    git ls-files 'src/*.c' ':!src/*/arm/*' ${window:+":!$window"} | xargs -P "$(nproc)" -n 8 clang-tidy -p "$build" --quiet \
        --extra-arg={-Xclang,-analyzer-config,-Xclang,max-nodes=60000}
    ;;
*)
    echo "usage: sanitize.sh address|thread|fuzz|memcheck|analysers|bare BUILD-DIR"
    exit 2
    ;;
esac
