#!/bin/bash
# The program as its user meets it. usage: cli.sh PROGRAM FIXTURES; speaks TAP.
set -u
export LC_ALL=C.UTF-8
program=$(realpath "$1")
fixtures=$2
folder=$(mktemp -d)
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
n=0

result() { # result STATUS SENTENCE: prints the files out and err of the last run after a failure
    n=$((n + 1))
    if [ "$1" = 0 ]; then
        echo "ok $n - $2"
    else
        echo "not ok $n - $2"
        sed 's/^/# stdout: /' out | head -20
        sed 's/^/# stderr: /' err | head -20
    fi
}

# refuses SENTENCE STATUS MESSAGE ARGUMENT...: one line on stderr that matches the glob MESSAGE,
# nothing on stdout, no file written.
refuses() {
    local sentence=$1 status=$2 message=$3 found before
    shift 3
    before=$(ls -R)
    "$program" "$@" >out 2>err
    found=$?
    # shellcheck disable=SC2053 # MESSAGE is a glob
    [ "$found" = "$status" ] && [ "$(wc -l <err)" = 1 ] && [ ! -s out ] &&
        [[ $(cat err) == "fluidy-svg: "$message ]] && [ "$before" = "$(ls -R)" ]
    result $? "$sentence"
}

touch out err
drawing='<svg xmlns="http://www.w3.org/2000/svg" width="64" height="48">'
mkdir whole gap broken empty nosize zero
for i in 1 2 3; do
    echo "$drawing<circle cx='$((20 + 4 * i))' cy='24' r='12' fill='#aa3311'/></svg>" >whole/w_000$i.svg
done
cp whole/w_0001.svg whole/w_0003.svg gap/
cp whole/w_0001.svg whole/w_0002.svg broken/
echo "$drawing<circle" >broken/w_0003.svg
echo '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0,0"/></svg>' >nosize/w_0001.svg
echo '<svg xmlns="http://www.w3.org/2000/svg" width="0" height="9"></svg>' >zero/w_0001.svg

refuses 'without input it says what it expects' 2 'no input; expected *'
refuses 'an unknown option gets a suggestion' 2 'there is no option --styel; did you mean --style?' --styel 01 x
refuses 'an unknown letter is named' 2 'there is no option -z; *' -z x
refuses 'an option without its value is named' 2 '*--style' --style
refuses 'a mistyped parameter gets a suggestion' 2 '*--w-tmep; did you mean --w-temp?' --w-tmep 3 x
refuses 'a parameter out of range is told the range' 2 'w-temp: *from 0 to 1000' --w-temp 3000 whole
refuses 'a parameter that is no number is told the range' 2 'w-temp: “x” *' --w-temp x whole
refuses 'a width of 0 is told the range' 2 '-W: “0” is not an integer from 1 to 32767 px' -W 0 whole
refuses 'a width with letters is told the range' 2 '--width: “9px” *' --width 9px whole
refuses 'a scale of nan is refused' 2 '--scale: “nan” *' --scale nan whole
refuses 'a mistyped word gets a suggestion' 2 '--missing: *did you mean “hold”?' --missing hodl whole
refuses 'a mistyped stacking gets a suggestion' 2 'stacking: *did you mean “glaze”?' --stacking glase whole
refuses 'an unknown preset lists the presets' 2 'there is no preset “x”; *' --preset x whole
refuses 'a tint that is no colour is refused' 2 'tint: “#12” is not fill, keep or #RRGGBB' --tint '#12' whole
refuses 'a hold of 0 is refused' 2 'hold: “0” is not *' --hold 0 whole
refuses 'contradicting options are refused' 2 '*contradict each other' -y --no-clobber whole
refuses 'an empty output is refused' 2 '--output: the value is missing' --output= whole
refuses 'a config that is not there is named' 1 'no.conf: *No such file*' -c no.conf whole
printf '[defaults]\n\nstyel = 01\n' >bad.conf
refuses 'a mistake in a config has file and line' 2 'bad.conf:3: *did you mean “style”?' -c bad.conf whole

"$program" --help >out 2>err && [ ! -s err ] && grep -q -- '--style' out
result $? '--help goes to standard output'
"$program" --help-all >out 2>err && [ ! -s err ] && grep -q -- '--w-temp' out
result $? '--help-all has the parameters of the synthesis'
"$program" -V >out 2>err && grep -qE '^fluidy-svg [0-9]+\.[0-9]+' out
result $? '--version is the name and a number'

echo "1..$n"
