#!/bin/bash
# Threads sleep while they wait for each other, unless the environment says otherwise.
# usage: wait.sh PROGRAM; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
program=$(realpath "$1")

# policy NAME=VALUE: what OpenMP says of itself when the program has started for good.
policy() {
    env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT -u KMP_BLOCKTIME OMP_DISPLAY_ENV=true "$@" \
        "$program" --version 2>&1 | grep 'OMP_WAIT_POLICY' | tail -1 | tr a-z A-Z
}

if ! ldd "$(dirname "$program")"/../libfluidy.so | grep -q libgomp; then
    skip 'threads sleep while they wait' 'another OpenMP, or none'
    echo "1..$n"
    exit 0
fi
[[ "$(policy A=B)" == *PASSIVE* ]]
result $? 'threads sleep while they wait'
[[ "$(policy OMP_WAIT_POLICY=active)" == *ACTIVE* ]]
result $? 'unless they are told otherwise'
(exec -a painter "$program" --nonsense) >out 2>err
[ $? = 2 ] && [ "$(wc -l <err)" = 1 ]
result $? 'arguments and status are those of one start'
echo "1..$n"
