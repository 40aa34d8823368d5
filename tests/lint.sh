#!/bin/bash
# What a reader may rely on but no compiler checks. usage: lint.sh SOURCE-DIR BUILD-DIR; speaks TAP.
set -u
export LC_ALL=C.UTF-8
source=$(cd "$1" && pwd)
build=$(cd "$2" && pwd)
cd "$source" || exit 1
n=0
if ! git rev-parse --git-dir >/dev/null 2>&1; then
    echo '1..0 # SKIP not a git checkout'
    exit 0
fi

# report SENTENCE COMMAND...: the sentence holds if the command prints nothing.
report() {
    local sentence=$1 found
    shift
    found=$("$@" 2>&1)
    n=$((n + 1))
    if [ -z "$found" ]; then
        echo "ok $n - $sentence"
    else
        echo "not ok $n - $sentence"
        sed 's/^/# /' <<<"$found"
    fi
}

skip() {
    n=$((n + 1))
    echo "ok $n - $1 # SKIP $2"
}

# Files beside README are those that tools and newcomers look for there.
top_level() {
    git ls-files | grep -v / |
        grep -vxE 'README.md|HACKING.md|NEWS|LICENSE|meson.build|meson_options.txt|\.clang-(format|tidy)|\.editorconfig|\.gitignore'
}
report 'no file lies beside README by mistake' top_level

# The folders of src, in the order of the data.
folders=$(sed -n "s/^subdir('\(.*\)').*/\1/p" src/meson.build)

layering() {
    local folder above=''
    for folder in $folders; do
        above="$above $folder"
        grep -rnoE '#include "[a-z]+/[^"]*"' --include='*.[ch]' "src/$folder" |
            while IFS= read -r line; do
                local wanted=${line#*\"}
                case " $above " in
                *" ${wanted%%/*} "*) ;;
                *) echo "$line" ;;
                esac
            done
    done
}

# The programs use the public headers, params and base only.
programs_stay_outside() {
    grep -rnE '#include "[a-z]+/' --include='*.[ch]' src/cli | grep -vE '"(base|params|cli)/'
}

# Those of the public headers and those of the programs, under their versions.
exported_symbols() {
    diff <(nm -D --defined-only "$build/src/libfluidy.so" | awk '$2 != "A" {print $3}' | sort) \
        <(awk '/^FLUIDY/ {version = $1} /^ *fl_/ {sub(/;/, ""); print $1 "@@" version}' src/fluidy.map | sort)
}

# One meaning, one name: no two files of the sources are called alike, and no two types.
names_are_unique() {
    git ls-files 'src/*.c' 'src/*.h' 'src/*.inc' | sed 's|.*/||' | sort | uniq -d |
        sed 's/$/: two files have this name/'
    git grep -hoE '^(typedef (struct|enum|union) Fl[A-Za-z]+ \{|struct Fl[A-Za-z]+ \{)' -- 'src/*.h' 'src/*.c' 'include/*.h' |
        grep -oE 'Fl[A-Za-z]+' | sort | uniq -d | sed 's/$/: two types have this name/'
}

# Every work that a comment cites is in the list.
references_are_listed() {
    git grep -ohE '\[[A-Z][A-Za-z]*[0-9]{2}[]0-9 ,;.§A-Za-z()–]*' -- src include |
        grep -oE '(^\[|[;,] )[A-Z][A-Za-z]*[0-9]{2}\b' | tr -d '[;, ' | sort -u | while read -r tag; do
        grep -q "^| $tag " src/REFERENCES.md || echo "REFERENCES.md has no $tag"
    done
    git grep -nE '\[DESIGN' -- src include
}

header_guards() {
    local file guard
    git ls-files 'src/*.h' | xargs grep -L '^#pragma once$' | sed 's/$/: expected #pragma once/'
    for file in $(git ls-files 'include/*.h'); do
        guard=$(tr 'a-z/.-' 'A-Z___' <<<"${file#include/}")
        grep -q "^#ifndef $guard\$" "$file" || echo "$file: expected the guard $guard"
    done
}

formatting() {
    git ls-files 'src/*.[ch]' 'include/*.h' man/fill.c | xargs clang-format --dry-run --Werror 2>&1 | grep 'error:' | head -20
}

foreign_paths() {
    git grep -nE '/(work|tmp/lib|tmp/wt)/' -- . ':!tests/lint.sh'
}

pages_are_clean() {
    mandoc -Tlint "$build"/man/*.[1-9] 2>&1 |
        grep -vE 'referenced manual not found|outdated mandoc.db'
}

# Every option of --help-all is in the page, and every option of the page is in --help-all.
options_are_documented() {
    local program=$1 page=$2
    diff <("$program" --help-all | grep -oE '^ +(-[a-zA-Z], )?--[a-z-]+' | grep -oE '\-\-[a-z-]+' |
        sort -u) \
        <(grep -oE '^\.It Fl .*' "$page" | grep -oE '(Fl|,) -[a-z][a-z-]+' |
            sed -E 's/^(Fl|,) -/--/' | sort -u) |
        sed -n 's/^</not in the page:/p; s/^>/not in --help-all:/p'
}

help_fits_one_screen() {
    local program=$1
    [ "$("$program" --help | wc -l)" -le 40 ] || echo "--help has more than 40 lines"
    "$program" --help | awk 'length > 80 { print "longer than 80: " $0 }'
}

# The two commands of the README are what CI runs.
readme_test_command() {
    local command
    command=$(sed -n '/^<!-- tests -->$/,/^```$/p' README.md | grep -vE '^(<!--|```)')
    [ -n "$command" ] || echo 'README.md has no command after <!-- tests -->'
    grep -qF 'README.md' .ci/run || echo '.ci/run does not read the command from README.md'
}

# The messages of the README are the program's: the words between what varies stand in the sources.
readme_messages() {
    local words part
    words=$(cat src/*/*.c | tr '\n' ' ' | sed 's/" *"//g')
    words=$(cat src/*/*.c | tr '\n' ' ' |
        sed 's/" *"//g; s/‘overwrite’/-y/g; s/‘\([a-z-]*\)’/--\1/g')
    sed -n '/^<!-- messages -->$/,/^## /s/^| `\([^`]*\)` .*/\1/p' README.md | sed 's/…/\n/g' |
        while read -r part; do
            [ -z "$part" ] || grep -qF -- "$part" <<<"$words" || echo "no message says: $part"
        done
}

readme_pictures() {
    grep -oE '\]\([^)#:]+\)' README.md | tr -d '()]' | while read -r file; do
        [ -f "$file" ] || echo "README.md: there is no $file"
    done
    [ "$(cat fixtures/gallery/* | wc -c)" -lt 1500000 ] || echo 'fixtures/gallery is larger than 1.5 MB'
}

changed_defaults_are_explained() {
    local name
    for name in $(awk '/^\.It Fl -/ { name = $3 }
                       /^default .*, fluidymation / {
                           split($0, part, /default |, fluidymation |, thesis |, lazyfluids /)
                           if (part[2] != part[3]) print name }' "$build/man/fluidy-svg.1"); do
        sed -n '/^\.Sh DEPARTURES/,/^\.Sh ENV/p' man/fluidy-svg.1.in | grep -qE "^\.It Fl.* $name( |\$)" ||
            echo "-$name differs from the article; DEPARTURES FROM THE PAPERS does not say why"
    done
}

# The keys of [project] and [region], which are said in the source and in the page.
config_keys_are_documented() {
    grep -oE '\{"[a-z-]+",' src/params/config.c | tr -d '{",' | sort -u |
        while read -r key; do
            grep -qE "^\.It Ic $key " man/fluidy-svg.conf.5.in || echo "fluidy-svg.conf(5) has no $key"
        done
}

# What a render is told is in the table of options, but for what no option says.
options_are_in_the_table() {
    local field
    sed -n '/^typedef struct FlRenderOptions/,/^} FlRenderOptions/p' include/fluidy/render.h |
        sed -E ':a;N;$!ba; s@/\*([^*]|\*+[^*/])*\*+/@@g; s/^[^{]*\{//; s/\}.*//' | tr '\n' ' ' |
        tr ';,' '\n\n' | grep -v '(' | grep -oE '[a-z_0-9]+ *$' | tr -d ' ' |
        grep -vxE 'size|inputs|settings|n_settings|config_text|most_side|data' | while read -r field; do
        grep -qE "^FL_OPTION\(RENDER, [A-Z]+, $field," src/params/options.def ||
            echo "FlRenderOptions has $field, options.def has not"
    done
}

# Each program has its own words for an option; the library names it, ‘canvas’.
messages_name_no_flags() {
    grep -rnE '"[^"]*(--[a-z]| -[a-zA-Z]\b)[^"]*"' --include='*.[ch]' src include |
        grep -vE '^src/cli/|^src/io/(video|ffmpeg)[a-z_]*.c|^src/inspect/farm_plan.c|ulimit -[nv]'
}

limits_are_documented() {
    local name preset
    sed -nE 's/^FL_LIMIT\([A-Z]+, "([a-z]+)", ([0-9]+),.*/\1 \2/p' src/base/limits.def |
        while read -r name preset; do
            [ "$preset" = 0 ] && preset='The machine'
            grep -A1 "^\.It Cm $name\$" man/fluidy-svg.1.in | grep -qw "^$preset" ||
                echo "--limit $name: the page does not say $preset"
        done
}

# Drying lines and passes lie on the drawing; a fluid would flow past them.
lines_in_fluids() {
    grep -lE '^fluid = [^n]' fixtures/styles/*/style.ini | xargs awk '
        /^wash = 0|^tide = 0/ { dry[FILENAME] = 1 }
        /^wash = 0|^passes = 0/ { even[FILENAME] = 1 }
        END { for (i = 1; i < ARGC; i++) if (!dry[ARGV[i]] || !even[ARGV[i]]) print ARGV[i] }'
}

report 'a folder includes headers of itself and the folders above it' layering
# A source file and its header are one file here.
no_include_circles() {
    grep -rnoE '#include "[a-z0-9_]+/[a-z0-9_]+\.' src --include='*.[ch]' |
        sed -nE 's@^src/([a-z0-9_]+/[a-z0-9_]+)\.[ch]:[0-9]+:#include "([a-z0-9_]+/[a-z0-9_]+)\.@\1 \2@p' |
        while read -r from to; do
            [ "$from" = "$to" ] || echo "$from $to"
        done | sort -u | tsort 2>&1 >/dev/null | sed 's/^tsort: //'
}

report 'the programs use base, params and public headers only' programs_stay_outside
report 'the library exports what src/fluidy.map lists' exported_symbols
report 'no files include each other in a circle' no_include_circles
report 'headers are read once; the public ones by guards that are their path' header_guards
report 'no two files or types have one name' names_are_unique
report 'every work that is cited is in REFERENCES.md' references_are_listed
report 'options.def has every field of FlRenderOptions' options_are_in_the_table
report 'messages of the library name no flags of the programs' messages_name_no_flags
report 'no path of a workplace is committed' foreign_paths
report '--help fits one screen' help_fits_one_screen "$build/src/cli/fluidy-svg"
report 'CI runs the test command of the README' readme_test_command
report 'the messages of the README are those of the program' readme_messages
report 'the files that the README shows are there, and small' readme_pictures
report 'no line of a wash stands still in a style that flows' lines_in_fluids
if command -v clang-format >/dev/null; then
    report 'the sources are formatted' formatting
else
    skip 'the sources are formatted' 'no clang-format'
fi
if [ ! -f "$build/man/fluidy-svg.1" ]; then
    skip 'man pages' 'not built'
else
    report 'fluidy-svg(1) has the options of --help-all' \
        options_are_documented "$build/src/cli/fluidy-svg" "$build/man/fluidy-svg.1"
    report 'fluidy-svg(1) has every limit and its default' limits_are_documented
    report 'fluidy-svg.conf(5) has every key' config_keys_are_documented
    report 'fluidy-svg(1) explains every default that is not the published one' \
        changed_defaults_are_explained
    if command -v mandoc >/dev/null; then
        report 'mandoc finds nothing odd in the man pages' pages_are_clean
    else
        skip 'mandoc finds nothing odd in the man pages' 'no mandoc'
    fi
fi
echo "1..$n"
