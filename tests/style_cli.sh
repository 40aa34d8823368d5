#!/bin/bash
# fluidy-style as its user meets it. usage: style_cli.sh PROGRAM FIXTURES PAGE; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
program=$(realpath "$1")
small=$(realpath "$2")/style-small
dust=$(realpath "$2")/watercolour/dust
styles=$(realpath "$2")/styles
page=$3
cd "$folder" || exit 1
export FLUIDY_STYLES=$folder/own XDG_DATA_HOME=$folder/none

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
        [[ $(cat err) == "fluidy-style: "$message ]] && [ "$before" = "$(ls -R)" ]
    result $? "$sentence"
}

# does SENTENCE ARGUMENT...: exit status 0.
does() {
    local sentence=$1
    shift
    "$program" "$@" >out 2>err
    result $? "$sentence"
}

# Files that are not to be seen as changes by refuses().
touch out err

does 'help names the commands' --help
{ grep -q '^  import' out && grep -q '^  check' out && grep -q '^  simulate' out && grep -q '^  list' out; }
result $? 'all four of them'

options() {
    for command in import check simulate list; do "$program" $command --help; done |
        grep -oE '^ +(-[a-z], )?--[a-z-]+' | grep -oE -- '--[a-z-]+' | grep -v -- '--help' | sort -u
}
diff <(options) <(grep '^\.It Fl' "$page" | grep -oE '(Fl|,) -[a-z][a-z-]+' |
    sed -E 's/^(Fl|,) -/--/' | sort -u) >out
result $? 'fluidy-style(1) has the options of --help'

refuses 'a command that does not exist has a suggestion' 2 '*unknown command imprt*did you mean*import*' imprt
refuses 'an option that does not exist has a suggestion' 2 '*--scael; did you mean --scale?*' import --scael 2
refuses 'import needs a folder' 2 '*import needs -o*' import "$small"
refuses 'a source that does not exist is named' 1 'nowhere.mp4: no such file*' import nowhere.mp4 -o x
refuses 'a range without an order is wrong usage' 2 '--frames 9-3: an empty range' import "$small" -o x -f 9-3
refuses 'a crop that leaves the frame tells the size' 2 '*leaves the frame, which is 64x48' \
    import "$small" -o x -c 60x40+10+10
refuses 'a style that does not exist is named' 1 'no style “inc”*' check inc --no-sheet
refuses 'a recipe that does not exist is named' 1 '*nowhere.ini*' simulate nowhere.ini -o x

does 'a folder of pictures is imported' import "$small" -o own/ink -f 2-6x2 --licence CC0-1.0 --fps 6
{ [ "$(ls own/ink/frames | wc -l)" = 3 ] && [ "$(ls own/ink/masks | wc -l)" = 3 ] &&
    grep -q '^fps = 6$' own/ink/style.ini && [ ! -s out ] && grep -q 'paint fills' err; }
result $? 'with the frames that were asked for, notes on stderr'
refuses 'a style is not overwritten' 1 'own/ink/frames: already exists; use -y to replace it' import "$small" -o own/ink
does 'but for -y' import "$small" -o own/ink -y -q
{ [ "$(ls own/ink/frames | wc -l)" = 6 ] && [ ! -s err ] && [ "$(ls -A own)" = ink ]; }
result $? 'quietly, and without leftovers'

mkdir -- '-odd %d'
cp "$small"/frames/*.png -- '-odd %d'
does 'a folder may have any name' import -q -o odd -- '-odd %d'

does 'list finds it' list
grep -q "^ink	ink		$folder/own/ink$" out
result $? 'by number, name, character and folder'
does 'list draws them' list -o own.png
[ "$(head -c 4 own.png | tail -c 3)" = PNG ]
result $? 'on a sheet'
refuses 'which is not overwritten' 1 'own.png: already exists*' list -o own.png

does 'check reports on it by name' check ink
{ grep -q '^size       64x48, 6 frames' out && grep -q '^sheet      ink-check.png$' out &&
    [ "$(head -c 4 ink-check.png | tail -c 3)" = PNG ]; }
result $? 'and draws a picture sheet'
refuses 'a sheet is not overwritten' 1 'ink-check.png: already exists; use -y to replace it' check ink
"$program" check ink --no-sheet --strict >out 2>err
{ [ $? = 1 ] && grep -q '^problem' out && grep -q '^fluidy-style: [0-9]* problem' err; }
result $? 'under --strict problems are a failure'
does 'a style that moves ink has none of a recording' check --strict --no-sheet "$styles/11" "$styles/14"
cp -r own/ink tiled && cp "$styles/11/transport.png" tiled && "$program" check --no-sheet ./tiled >out
grep -q '^problem    paint fills [0-9]* % of the frame: expected 95 % or more' out
result $? 'but for paint that does not fill its picture'
"$program" list >/dev/full 2>err
[ $? = 1 ]
result $? 'a full disk is a failure'

for more in 'steps = 100000' 'warm-up = 1000000'; do
    grep -v "^${more%% *} " "$styles/07/recipe.ini" | sed "s/^\[recipe\]/&\n$more/" >endless.ini
    refuses "a recipe with $more is too much work, and not begun" 1 \
        '*--limit recipe=N to raise it*' simulate endless.ini -o x --limit style=4000
done
does 'a recipe is simulated' simulate "$dust/recipe.ini" -o dust
{ diff -r dust/frames "$dust/frames" >out && diff -r dust/masks "$dust/masks" >>out &&
    [ "$(tail -1 err)" = 'fluidy-style: frame 3 of 3; writing the files' ]; }
result $? 'frame by frame'
sed 's/^frames = 3/frames = 2/' "$dust/recipe.ini" >short.ini
refuses 'a simulated style is not overwritten' 1 'dust/frames: already exists; use -y to replace it' \
    simulate short.ini -o dust
refuses 'a file is no place for a style' 1 'err: is a file: expected a folder' simulate short.ini -o err
does 'but for -y' simulate -qy short.ini -o dust
{ [ "$(ls dust/frames | wc -l)" = 2 ] && [ "$(ls dust/masks | wc -l)" = 2 ] && [ ! -s err ]; }
result $? 'and no frame of the old one stays'

mkdir -p .dust.part/frames .dust.mine && touch .dust.part/frames/0001.png
exec 9<.dust.part
flock 9
refuses 'of two runs that would write the same style the second is told' 1 \
    'dust: another run is writing it' simulate -qy short.ini -o dust
exec 9<&-
does 'what a killed run left is no hindrance' simulate -qy short.ini -o dust
[ ! -e .dust.part ] && [ -e .dust.mine ]
result $? 'and goes, and what somebody else has there stays'

if command -v ffmpeg >/dev/null; then
    ffmpeg -v error -framerate 12 -i "$small/frames/%04d.png" -c:v ffv1 -pix_fmt bgr0 paint.mkv
    does 'a video is imported' import paint.mkv -o video -f 2-6x2
    { [ "$(ls video/frames | wc -l)" = 3 ] && grep -q '^fps = 6$' video/style.ini &&
        cmp -s video/masks/0001.png own/ink/masks/0002.png; }
    result $? 'frame by frame, at its rate, with the masks of its pictures'
    refuses 'a video that ends early tells how many frames it gave' 1 '*ends before frame 9*6 frames' \
        import paint.mkv -o early -f 1-9
    ffmpeg -v error -i "$small/frames/0006.png" paint.jpg
    does 'a photograph is imported' import paint.jpg -o photo
    grep -q 'only one frame, so the paint will not flow' err
    result $? 'with the warning that it will not flow'
    ffmpeg -v error -f lavfi -i sine=d=0.1 -c:a pcm_s16le sound.wav
    refuses 'sound is no paint' 1 'sound.wav: has no pictures' \
        import sound.wav -o sound
    printf 'ffconcat version 1.0\nfile paint.mkv\n' >list.mkv
    echo '<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"/>' >x.svg
    if "${program%/*}/fluidy-svg" x.svg --list-regions --sandbox require >out 2>err; then
        refuses 'a recording that names another file does not get it' 1 'list.mkv: *' import list.mkv -o listed
    else
        skip 'a recording that names another file does not get it' 'no sandbox here'
    fi
    head -c 2000 paint.mkv >cut.mkv
    refuses 'a broken video is named' 1 'cut.mkv: *' import cut.mkv -o broken
else
    skip 'videos and photographs are imported' 'no ffmpeg'
fi
echo "1..$n"
