#!/bin/bash
# --serve: the live page in a real browser, and who may speak to it. Waits for states, never for a time.
# usage: serve.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
fixtures=$(realpath "$2")
tests=$(realpath "${0%/*}")
. "${0%/*}/film.sh"
trap 'kill -KILL $job 2>/dev/null; rm -rf "$folder"' EXIT
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
export FLUIDY_STYLES=$fixtures/styles TMPDIR=$folder/tmp
mkdir tmp
job='' address=''

if "$program" --serve no-such-folder 2>err; grep -q 'this build has no live page' err; then
    result 0 'a build without libsoup says so'
    echo "1..$n"
    exit
fi

# serves ARGUMENT...: in the background, as process $job; $address is that of its page.
serves() {
    rm -f said
    set -m # the processes that it starts are of its group
    "$program" film --cache kept "$@" >said 2>told &
    job=$!
    set +m
    until [ -s said ]; do
        kill -0 $job 2>/dev/null || return 1
        sleep 0.05
    done
    address=$(cat said)
}

# ends SIGNAL: the server ends with status 0, without its temporary files and its processes.
ends() {
    kill -"$1" $job
    wait $job && [ -z "$(ls -A tmp)" ] || return 1
    until ! pgrep -g $job -r S,R,D >/dev/null; do
        sleep 0.05
    done
}

"$program" --serve no-such-folder >out 2>err
[ $? = 1 ] && says 'no-such-folder' && [ ! -s out ]
result $? 'input that is not there is one line'
"$program" film --serve -o 'out_%d.png' 2>err
[ $? = 2 ] && says '--serve and --output contradict each other'
result $? 'an output is refused, since the page writes no frames'
"$program" film --serve=70000 2>err
[ $? = 2 ] && says '“70000” is not a port from 0 to 65535'
result $? 'a port above 65535 is refused'

"$program" film --serve -c <(echo) 2>err
[ $? = 2 ] && says 'expected a file, which can be read again'
result $? 'a config that cannot be read twice is refused'

if ! command -v python3 >/dev/null; then
    skip 'the page is served' 'no python3'
    echo "1..$n"
    exit
fi

printf '# mine\n[project]\nlayers = layers/{region}_%%d.png\n\n[defaults]\nstyle = ./ink\n# below\n' >one.conf
cp -r "$style" ink
serves -c one.conf --serve
result $? 'the page has an address'
port=${address#http://127.0.0.1:}
port=${port%%/*}
"$program" film --serve "$port" >out 2>err
[ $? = 1 ] && says "port $port of 127.0.0.1" && [ ! -s out ]
result $? 'a port in use is one line'

# visit SCRIPT ARGUMENT...: takes its lines "ok - " and "not ok - ".
visit() {
    timeout 120 python3 -B "$tests/$1" "${@:2}" >lines 2>err
    result $? "$1 runs to its end"
    while read -r line; do
        n=$((n + 1))
        echo "$line" | sed "s/ - / $n - /"
    done < <(grep ok lines)
}

visit ask_live.py "$address"
if [ -z "$browser" ]; then
    skip 'a mouse goes through the page' 'no chromium'
else
    visit visit_live.py "$browser" "$address" "$folder/profile" film "$program" --cache off
    grep -q '^# mine' kept.conf && grep -q '^# below' kept.conf && grep -q '^layers = ' kept.conf
    result $? 'the config keeps the comments and keys of its author'
fi
[ ! -e layers ] && [ ! -e fluidy ] && cmp -s one.conf <(printf '# mine\n[project]\nlayers = layers/{region}_%%d.png\n\n[defaults]\nstyle = ./ink\n# below\n')
result $? 'the server writes no outputs and does not change the config'
ends INT
result $? 'SIGINT ends it with status 0, without leftovers'

echo '[project]' >keyed.conf
serves -s 'ink@1 ./ink@4~2' -c keyed.conf --serve
visit ask_live.py "$address" keyed
ends INT

mkdir bin
cp "$program" bin
LD_LIBRARY_PATH=$(dirname "$program")/..${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export LD_LIBRARY_PATH
built=$program program=$folder/bin/fluidy-svg
"$program" film -s "$style" --window >out 2>err
[ $? = 2 ] && says "$folder/bin/fluidy-window cannot be run"
result $? 'a build without a window says so'
printf '#!/bin/sh\necho "$1" >shown\nuntil [ -e close ]; do sleep 0.05; done\n' >bin/fluidy-window
chmod +x bin/fluidy-window
serves -s "$style" --window
until [ -s shown ]; do sleep 0.05; done
[ "$(cat shown)" = "$address" ] && ends INT
result $? 'a window shows the page, and ends with the program'
serves -s "$style" --window
touch close
wait $job
result $? 'the program ends with its window'
program=$built
printf '#!/bin/sh\ncase $1 in *bad.json) echo "no player" >&2; exit 1;; esac\nmkdir "$3" && cp "%s/film/w_0001.svg" "$3/7.svg"\n' "$PWD" >bin/fluidy-frames
chmod +x bin/fluidy-frames
PATH=$folder/bin:$PATH
most=$(ulimit -Sn)
ulimit -Sn 60
serves -s "$style" --serve -j 2
ulimit -Sn "$most"
visit ask_live.py "$address" flood
ends TERM
result $? 'so does SIGTERM while it paints'
echo "1..$n"
