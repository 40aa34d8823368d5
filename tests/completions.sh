#!/bin/bash
# The completions as the shells meet them. usage: completions.sh FOLDER-OF-COMPLETIONS; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
completions=$(realpath "$1")

# completed FUNCTION WORD...: what bash offers for the last word
completed() {
    local function=$1
    shift
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
    "$function"
    echo "${COMPREPLY[*]}"
}

# shellcheck disable=SC1091
source "$completions/fluidy-svg"
# shellcheck disable=SC1091
source "$completions/fluidy-style"
[ "$(completed _fluidy_svg fluidy-svg --det)" = --detail ]
result $? 'bash completes an option'
[ "$(completed _fluidy_svg fluidy-svg --detail dr)" = draft ]
result $? 'bash completes a word of an option'
[ "$(completed _fluidy_svg fluidy-svg --detail = n)" = normal ]
result $? 'bash completes a word after an equals sign'
[ "$(completed _fluidy_svg fluidy-svg --w-tem)" = --w-temp ]
result $? 'bash completes a parameter of the synthesis'
[ "$(completed _fluidy_style fluidy-style im)" = import ]
result $? 'bash completes a command of fluidy-style'
[ "$(completed _fluidy_style fluidy-style import --no-f)" = --no-flatten ]
result $? 'bash completes an option of a command'

mkdir -p "$folder/styles/own/frames"
printf '[style]
name = Lamp black
' >"$folder/styles/own/style.ini"
[ "$(PATH=$completions/..:$PATH FLUIDY_STYLES=$folder/styles completed _fluidy_svg fluidy-svg -s la)" = lamp-black ]
result $? 'bash completes a style by its name'

for shell in zsh fish; do
    for program in fluidy-svg fluidy-style; do
        if command -v "$shell" >/dev/null; then
            file=$completions/$program.fish
            [ "$shell" = zsh ] && file=$completions/_$program
            "$shell" -n "$file"
            result $? "$shell reads the completions of $program"
        else
            skip "$shell reads the completions of $program" "no $shell"
        fi
    done
done
if command -v fish >/dev/null; then
    offered=$(fish --no-config -c "source '$completions/fluidy-svg.fish'; complete -C 'fluidy-svg --detail '" |
        cut -f 1 | sort | tr '\n' ' ')
    [ "$offered" = 'draft fine normal ' ]
    result $? 'fish completes a word of an option'
fi
echo "1..$n"
