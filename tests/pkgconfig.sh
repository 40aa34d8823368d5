#!/bin/sh
# Against the installed library, a program that knows pkg-config only compiles, links and runs, and the
# installed programs find it wherever it lies. usage: pkgconfig.sh BUILD-DIR SOURCE-DIR
set -eu
build=$1
source=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/program.c" <<'EOF'
#include <fluidy/fluidy.h>
#include <stdio.h>

int main(void)
{
    return puts(fl_version()) < 0;
}
EOF
meson install -C "$build" --no-rebuild --quiet --destdir "$folder" --tags devel,runtime
cd "$folder"
file=$(find . -name fluidy.pc)
sed -i 's|^prefix=/|prefix=|' "$file" # relative: the folder's own path may have spaces
PKG_CONFIG_PATH=$(dirname "$file")
export PKG_CONFIG_PATH
flags=$(pkg-config --cflags --libs fluidy)
# shellcheck disable=SC2086 # flags are words
${CC:-cc} program.c -o program $flags
version=$(LD_LIBRARY_PATH=$(pkg-config --variable=libdir fluidy) ./program)
[ "$version" = "$(pkg-config --modversion fluidy)" ]
"$(find . -path "*/bin/fluidy-svg")" --version >said
"$(find . -path "*/bin/fluidy-style")" --version >>said
[ "$(grep -c "$version" said)" = 2 ]
# Nothing that is installed looks into the folder that it was built in; where its sources were is
# part of the debug information, if there is any.
strip -g -o stripped "$(find . -name 'libfluidy.so.*.*.*')"
strings -a stripped >said
grep -q 'fluidy/styles' said
if grep -F -e "$source" -e "$(realpath "$build")" said; then
    exit 1
fi
