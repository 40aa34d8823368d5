#!/bin/sh
# Checks that fills keep their colours: every sequence with each of our styles; about an hour.
#
# usage: colours.sh COLOURS ANIMATIONS
#
# Fails where a fill of the styles 01 or 04 is off. The paint of the others is too uneven for
# shapes of few pixels: half of one may be bare, and its median that of what is below it.
program=$1 animations=$2 status=0
for style in 01 02 03 04 05 06 07 08 09 10; do
    echo "style $style"
    find "$animations" -mindepth 1 -maxdepth 1 -type d ! -name LICENSES ! -name tables | sort |
        xargs "$program" $style || case $style in 01 | 04) status=1 ;; esac
done
exit $status
