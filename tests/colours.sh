#!/bin/sh
# Whether fills keep their colours: every sequence with each of our styles; some minutes.
#
# usage: colours.sh COLOURS ANIMATIONS
program=$1 animations=$2 status=0
for style in 01 02 03 04 05 06; do
    echo "style $style"
    find "$animations" -mindepth 1 -maxdepth 1 -type d ! -name LICENSES ! -name tables | sort |
        xargs "$program" $style || status=1
done
exit $status
