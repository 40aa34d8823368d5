#!/bin/bash
# The completions as the shells meet them. usage: completions.sh FOLDER-OF-COMPLETIONS; speaks TAP.
set -u
export LC_ALL=C.UTF-8
folder=$(realpath "$1")
n=0

report() { # report STATUS SENTENCE
    n=$((n + 1))
    [ "$1" = 0 ] && echo "ok $n - $2" || echo "not ok $n - $2"
}

# completed FUNCTION WORD...: what bash offers for the last word
completed() {
    local function=$1
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    "$function"
    echo "${COMPREPLY[*]}"
}

# shellcheck disable=SC1091
source "$folder/fluidy-svg"
# shellcheck disable=SC1091
source "$folder/fluidy-style"
[ "$(completed _fluidy_svg fluidy-svg --det)" = --detail ]
report $? 'bash completes an option'
[ "$(completed _fluidy_svg fluidy-svg --detail dr)" = draft ]
report $? 'bash completes a word of an option'
[ "$(completed _fluidy_svg fluidy-svg --detail = n)" = normal ]
report $? 'bash completes a word after an equals sign'
[ "$(completed _fluidy_svg fluidy-svg --w-tem)" = --w-temp ]
report $? 'bash completes a parameter of the synthesis'
[ "$(completed _fluidy_style fluidy-style im)" = import ]
report $? 'bash completes a command of fluidy-style'
[ "$(completed _fluidy_style fluidy-style import --no-f)" = --no-flatten ]
report $? 'bash completes an option of a command'

for shell in zsh fish; do
    for program in fluidy-svg fluidy-style; do
        if command -v "$shell" >/dev/null; then
            file=$folder/$program.fish
            [ "$shell" = zsh ] && file=$folder/_$program
            "$shell" -n "$file"
            report $? "$shell reads the completions of $program"
        else
            n=$((n + 1))
            echo "ok $n - $shell reads the completions of $program # SKIP no $shell"
        fi
    done
done
if command -v fish >/dev/null; then
    offered=$(fish --no-config -c "source '$folder/fluidy-svg.fish'; complete -C 'fluidy-svg --detail '" |
        cut -f 1 | sort | tr '\n' ' ')
    [ "$offered" = 'draft fine normal ' ]
    report $? 'fish completes a word of an option'
fi
echo "1..$n"
