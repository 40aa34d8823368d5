#!/bin/bash
# The examples of the library: both run, and paint the same film.
# usage: examples.sh EXAMPLE LIBRARY FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
example=$(realpath "$1") style=$3/style-small script=$3/examples/paint.py
library=$(realpath "$2")
LD_LIBRARY_PATH=${library%/*}
export LD_LIBRARY_PATH
mkdir "$folder/c" "$folder/python"

cd "$folder/c" && "$example" "$style" 2>../err && [ "$(find . -name 'disc_*.ppm' | wc -l)" = 8 ]
result $? 'the one in C paints eight frames'
! cmp -s disc_0.ppm disc_7.ppm && [ "$(wc -c <disc_0.ppm)" = 18445 ]
result $? 'which have the size that was asked for'
! "$example" nowhere 2>../err && [ "$(wc -l <../err)" = 1 ] && grep -q '^paint: no style “nowhere”' ../err
result $? 'and says in one line what is wrong'
if python3 -c 'import ctypes; ctypes.CDLL("libfluidy.so.0")' 2>../err; then
    cd "$folder/python" && python3 "$script" "$style" 2>../err && diff -r . ../c >/dev/null
    result $? 'the one in Python paints the same bytes'
    ! python3 "$script" nowhere 2>../err && grep -q '^paint.py: no style “nowhere”' ../err
    result $? 'and says what is wrong as well'
else
    skip 'the one in Python paints the same bytes' 'no python3 that could load the library'
fi
[ "$(wc -l <"${script%.py}.c")" -le 45 ] && [ "$(wc -l <"$script")" -le 45 ]
result $? 'neither is longer than a page'

echo "1..$n"
