#!/bin/sh
# Against the installed library, a program that knows pkg-config only compiles, links and runs, and the
# installed programs find it wherever it lies. usage: pkgconfig.sh BUILD-DIR
set -eu
build=$1
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
file=$(find "$folder" -name fluidy.pc)
sed -i "s|^prefix=|prefix=$folder|" "$file"
PKG_CONFIG_PATH=$(dirname "$file")
export PKG_CONFIG_PATH
flags=$(pkg-config --cflags --libs fluidy)
# shellcheck disable=SC2086 # flags are words
${CC:-cc} "$folder/program.c" -o "$folder/program" $flags
version=$(LD_LIBRARY_PATH=$(pkg-config --variable=libdir fluidy) "$folder/program")
[ "$version" = "$(pkg-config --modversion fluidy)" ]
"$(find "$folder" -path "*/bin/fluidy-svg")" --version >"$folder/said"
"$(find "$folder" -path "*/bin/fluidy-style")" --version >>"$folder/said"
[ "$(grep -c "$version" "$folder/said")" = 2 ]
