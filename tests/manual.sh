#!/bin/bash
# The manuals are about these programs, and their examples work. usage: manual.sh BUILD FIXTURES;
# speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
build=$(realpath "$1")
fixtures=$(realpath "$2")
cd "$folder" || exit 1
export PATH="$build/src/cli:$folder/bin:$PATH"
export HOME=$folder EDITOR=true
unset XDG_DATA_HOME

# The long options that a manual describes, one a line.
described() {
    sed -n 's/^\.It Fl //p' "$1" | tr ' ,' '\n\n' | sed -n 's/^-\([a-z]\)/\1/p' | sort -u
}

# The same of what --help prints, on standard input.
offered() {
    sed -nE 's/^ +(-., )?--([a-z-]+).*/\2/p' | sort -u
}

# Lines of the examples of a manual, as the reader types them.
examples() {
    sed -n '/^\.Sh EXAMPLES/,/^\.Sh [^E]/p' "$1" |
        sed -n -e '/^\.Bd/,/^\.Ed/{/^\.[BE]d/!p}' -e 's/^\.Dl //p' | sed 's/\\e/\\/g'
}

fluidy-svg --help-all | offered >is
described "$build/man/fluidy-svg.1" >said
diff is said >err
result $? 'fluidy-svg(1) describes the options that there are, and no others'
for command in import check simulate list; do fluidy-style "$command" --help; done | offered |
    grep -vxE 'help(-all)?|version' >is
described "$build/man/fluidy-style.1" | grep -vxE 'help(-all)?|version' >said
diff is said >err
result $? 'fluidy-style(1) describes the options that there are, and no others'

for style in "$fixtures"/styles/*/; do
    echo "$(basename "$style") , $(sed -n 's/^name = //p' "$style/style.ini")"
done >is
sed -n '/^\.Sh BUNDLED/,/^\.Sh FILES/s/^\.It Ic //p' "$build/man/fluidy-style.5" >said
diff is said >err
result $? 'fluidy-style(5) lists the bundled styles by their names'

# What the examples are about, as small as they allow.
mkdir bin walk styles
for style in 01 02 03 04 05 06; do
    cp -r "$fixtures/style-small" "styles/$style"
done
export FLUIDY_STYLES=$folder/styles
printf '#!/bin/sh\n[ -f "$1" ]\n' >bin/xdg-open
chmod +x bin/xdg-open
for i in $(seq 24); do
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='48' height='36'><circle cx='$((12 + i))'
cy='18' r='10' fill='#aa3311'/></svg>" | tee "$(printf 'walk_%04d.svg' "$i")" \
        >"$(printf 'walk/walk_%04d.svg' "$i")"
done
examples "$build/man/fluidy-svg.1" >run
bash -e run >err 2>&1 && [ -s walk.mov ] && [ -s cycle.gif ] && [ -s ink/index.html ] &&
    [ -s styles.png ] && [ -s fluidy/walk_styles.png ]
result $? 'the examples of fluidy-svg(1) work'

# The tutorial, with the styles that are installed and no folder but an empty one.
mkdir tutorial
sed -n '/^\.Bd/,/^\.Ed/{/^\.[BE]d/!p}' "$build/man/fluidy-tutorial.7" | sed 's/\\e/\\/g' >tutorial.run
if ! command -v ffmpeg >/dev/null; then
    skip 'every command of the tutorial works' 'no ffmpeg'
else
    (cd tutorial && unset FLUIDY_STYLES && bash -e ../tutorial.run) >err 2>&1 && [ -s tutorial/hills.mov ] &&
        [ "$(find tutorial/layers -name '*.png' | wc -l)" = 72 ] && [ -s tutorial/mine/style.ini ]
    result $? 'every command of the tutorial works'
fi

# Small drafts of the frames that come with the repository.
mkdir readme && cp -r "$fixtures/animations/snowman-wave-layers" readme
printf '#!/bin/sh\nexec "%s" -W 64 --detail draft "$@"\n' "$build/src/cli/fluidy-svg" >readme/fluidy-svg
chmod +x readme/fluidy-svg
sed -nE 's/^ {4,}(fluidy-svg|xdg-open) /\1 /p' "$fixtures/../README.md" |
    sed 's|fixtures/animations/||' >readme/run
(cd readme && PATH=$PWD:$PATH && unset FLUIDY_STYLES && bash -e run) >err 2>&1 &&
    [ "$(wc -l <readme/run)" = 8 ] && [ -s readme/snowman/0044.png ]
result $? 'the examples of the README work on frames that are in the repository'

sed -n '/^\.Sh EXAMPLES/,/^\.Sh DIAG/p' "$build/man/fluidy-svg.conf.5" |
    sed -n '/^\.Bd/,/^\.Ed/{/^\.[BE]d/!p}' >example.conf
cp "$fixtures/compose/drop-13-rgb.png" paper.png
fluidy-svg walk -c example.conf --dry-run -o 'conf_%d.png' >err 2>&1
result $? 'the example of fluidy-svg.conf(5) is a config'

if ! command -v ffmpeg >/dev/null; then
    skip 'the examples of fluidy-style(1) and (5) work' 'no ffmpeg'
else
    frames=$fixtures/styles/03/frames
    paper='scale=700:-1,pad=1500:1000:550:180:color=0xf6f2ea'
    ffmpeg -v error -framerate 2.7 -i "$frames/%04d.png" -vf "$paper,tpad=stop=-1:stop_mode=clone,fps=25" \
        -frames:v 185 -c:v mpeg4 -q:v 3 ink.mp4
    ffmpeg -v error -i "$frames/%04d.png" scan_%02d.jpg
    i=0
    for frame in "$frames"/*.png; do
        i=$((i + 1))
        cp "$frame" "$(printf 'rgb_%05d.png' $i)"
        cp "${frame/frames/masks}" "$(printf 'alpha_%05d.png' $i)"
    done
    mkdir 01
    cp "$fixtures/watercolour/wet/recipe.ini" 01/
    # Whoever reads on does not paint the same film twice.
    printf '#!/bin/sh\nrm -rf fluidy\nexec "%s" "$@"\n' "$build/src/cli/fluidy-svg" >bin/fluidy-svg
    chmod +x bin/fluidy-svg
    export PATH="$folder/bin:$PATH"
    { examples "$build/man/fluidy-style.1" && echo rm -r ink ink-check.png && examples "$build/man/fluidy-style.5" | sed "/^\[/,\$d"; } >run
    bash -e run >err 2>&1 && [ -f fire/style.ini ] && [ -f my01/style.ini ]
    result $? 'the examples of fluidy-style(1) and (5) work'
fi
echo "1..$n"
