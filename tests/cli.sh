#!/bin/bash
# The program as its user meets it. usage: cli.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
unset NO_COLOR # as some have it in CI
program=$(realpath "$1")
fixtures=$(realpath "$2")
tests=$(realpath "${0%/*}")
cd "$folder" || exit 1

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
look='-s 01'
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
refuses 'an unknown option gets a suggestion' 2 'unknown option --styel; did you mean --style?' --styel 01 x
refuses 'an unknown letter is named' 2 'unknown option -z; *' -z x
refuses 'an option without its value is named' 2 '*--style' --style
for pair in load:wash pigments:hue; do
    refuses "--${pair%:*} is --${pair#*:} now" 2 "*--${pair%:*}; did you mean --${pair#*:}?" --"${pair%:*}" .1 x
done
for words in '--preset fluid' '--methods fluid -o o%d.png' '-c fluid.conf'; do
    printf '[region *]\npreset = fluid\n' >fluid.conf
    refuses "the preset fluid is lazyfluids-steady now ($words)" 2 '*did you mean “lazyfluids-steady”?*' whole -s 01 $words
done
refuses 'a mistyped parameter gets a suggestion' 2 '*--w-tmep; did you mean --w-temp?' --w-tmep 3 x
refuses 'a parameter out of range is told the range' 2 'w-temp: *from 0 to 1000' --w-temp 3000 whole
refuses 'a parameter that is no number is told the range' 2 'w-temp: “x” *' --w-temp x whole
refuses 'a width of 0 is told the range' 2 '-W: “0” is not an integer from 1 to 32767 px' -W 0 whole
refuses 'a width with letters is told the range' 2 '--width: “9px” *' --width 9px whole
refuses 'a scale of nan is refused' 2 '--scale: “nan” *' --scale nan whole
refuses 'a mistyped word gets a suggestion' 2 '--missing: *did you mean “hold”?' --missing hodl whole
refuses 'a mistyped stacking gets a suggestion' 2 'stacking: *did you mean “glaze”?' --stacking glase whole
refuses 'an unknown preset lists the presets' 2 'unknown preset “x”; *' --preset x whole
refuses 'a tint that is no colour is refused' 2 'tint: “#12” is not fill, keep or #RRGGBB' --tint '#12' whole
refuses 'a hold of 0 is refused' 2 'hold: “0” is not *' --hold 0 whole
refuses 'contradicting options are refused' 2 '*contradict each other' -y --no-clobber whole
refuses 'an empty output is refused' 2 '--output: the value is missing' --output= whole
refuses 'a config that is not there is named' 1 'no.conf: *No such file*' -c no.conf whole
printf '[defaults]\n\nstyel = 01\n' >bad.conf
refuses 'a mistake in a config has file and line' 2 'bad.conf:3: *did you mean “style”?' -c bad.conf whole

cp bad.conf 'a;b.conf' && cp bad.conf c.conf && mkfifo pipe.conf
refuses 'a config may have a semicolon in its name' 2 'a;b.conf:3: *' -c 'a;b.conf' whole
refuses 'of several configs none may' 2 '-c: “a;b.conf” has a semicolon *' -c 'a;b.conf' -c c.conf whole
refuses 'nor may a later one' 2 '-c: “a;b.conf” has a semicolon *' -c bad.conf -c c.conf -c 'a;b.conf' whole
refuses 'none of the configs that are watched is a pipe' 2 '--watch: pipe.conf: *' -c c.conf -c pipe.conf --watch whole
rm 'a;b.conf' c.conf pipe.conf

# What is wrong with the drawing is known before anything is painted.
refuses 'a pattern that fits nothing suggests one' 1 '*did you mean w_%04d.svg*' 'whole/v_%04d.svg' $look
refuses 'a folder that is not there is named' 1 'nowhere: *' nowhere $look
refuses 'an empty folder is named' 1 'empty: no .svg files *' empty $look
refuses 'a gap lists the numbers' 1 '*no file for frame 2; use --missing *' gap $look
refuses 'frames that do not exist are listed' 1 '*no file for frames 7-9; expected some of 1-*' whole -f 7-9 $look
refuses 'frames that are no numbers are refused' 2 'frames “1-x”: expected *' whole -f 1-x $look
refuses 'a broken file is named with its line' 1 'broken/w_0003.svg: *line *' broken $look
refuses 'a drawing without a size asks for --canvas' 1 'nosize/w_0001.svg: *--canvas*' nosize $look
refuses 'a drawing of no size is refused' 1 'zero/w_0001.svg: *' zero $look
refuses 'a canvas without a height is refused' 2 "canvas “5”: expected WxH *" whole --canvas 5 $look
refuses 'an output without a frame number is refused' 2 'one.png: *' whole -o one.png $look
refuses 'an output of no known kind lists the kinds' 2 'w_%d.bmp: *' whole -o w_%d.bmp $look
refuses 'an unknown style gets a suggestion' 1 'no style “0l” *did you mean “0?” or “0?” or “0?”?' whole -s 0l
refuses 'so does one that is called by its name' 1 'no style “blom” *did you mean “Bloom”?' whole -s blom
refuses 'a style that is gone names the nearest' 1 '*style 12, Batik, does not come with the program any more: take Pools' whole -s batik
"$program" whole -s BLOOM --dry-run $look >out 2>err
result $? 'a style is found by its name in any case'
refuses 'no style asks for one' 2 '*--style*' whole
refuses 'a style that is not there is named' 1 './nowhere: *' whole -s ./nowhere
refuses 'an unknown region lists the regions' 2 'no region “hare”; the regions are: *' whole --region hare $look
refuses 'a background that is not there is named' 1 'paper.png: *' whole -b paper.png $look
refuses 'flow that is not there is named' 1 '*flow_*.flo: *' whole --flow flow_%04d.flo $look
mkdir locked && chmod 0 locked
if ! touch locked/file 2>/dev/null; then
    refuses 'a folder that cannot be written is named' 1 'locked/*: *' whole -o locked/w_%d.png $look
fi
refuses 'an output folder that is a file is named' 1 'out*: *Not a directory' whole -o out/w_%d.png $look
refuses 'an unknown format gets a suggestion' 2 'exxr: unknown output format; *did you mean “exr”?' --format exxr -s 01 whole
touch film.mkv
refuses 'a film that exists stays' 1 'film.mkv: already exists; use -y to replace it' -o film.mkv --no-clobber -s 01 whole

refuses 'a mistyped end of a name gets a suggestion' 2 'w_%d.pgn: *did you mean “png”?' whole -o w_%d.pgn $look
refuses 'a mistyped folder gets a suggestion' 1 'whle: no such file; did you mean “whole”?' whle $look
refuses 'a preview of no frame is refused' 2 '--preview: “x” is not *' --preview x whole
refuses 'a preview of a frame that is not there is refused' 1 '*no file for frame 9; *' --preview 9 whole $look
refuses 'a preview of a range is refused' 2 '--preview and --frames *' --preview 2 -f 1 whole
refuses 'a mistyped style among several is found out first' 1 '*did you mean “0?” or “0?” or “0?”?' --styles 01,0l whole
refuses 'a mistyped method is found out first' 2 '*did you mean “lazyfluids”?' --methods default,lazyfluid whole
refuses 'a method is changed by settings' 2 '*KEY=VALUE*' --methods default:w-uni whole
refuses 'no style among several is refused' 2 '--styles: expected names *' --styles 01, whole

"$program" --help >out 2>err && [ ! -s err ] && [ "$(wc -l <out)" -le 24 ] && ! grep -qE '.{81}' out
result $? '--help fits into a small terminal'
"$program" --help >out 2>err && [ ! -s err ] && grep -q -- '--style' out
result $? '--help goes to standard output'
[ "$(grep -c '^  fluidy-svg ' out)" = 3 ]
result $? '--help has three examples'
"$program" --help-all >out 2>err && [ ! -s err ] && grep -q -- '--w-temp' out
result $? '--help-all has the parameters of the synthesis'
"$program" -V >out 2>err && grep -qE '^fluidy-svg [0-9]+\.[0-9]+' out
result $? '--version is the name and a number'

printf '[region read-aa3311]\nhold = 2\n' >odd.conf
"$program" whole -s 01 -c odd.conf --dry-run >out 2>err &&
    grep -q 'warning: odd.conf:1: \[region read-aa3311\] .*did you mean “red-aa3311”?' err &&
    "$program" whole -s 01 -c odd.conf --dry-run -f 1 >out 2>err &&
    grep -q 'warning: odd.conf:1: \[region read-aa3311\]' err
result $? 'a section that matches no region is a warning, with some frames of the film, too'
"$program" whole -s 01 --style-frames 1 --dry-run >out 2>err &&
    [ "$(grep -c '/01: one frame is used: its paint does not flow' err)" = 1 ] &&
    "$program" whole -s 15 --dry-run >out 2>err && ! grep -q 'does not flow' err
result $? 'a style of one frame is a warning, unless a fluid moves its paint'
"$program" whole -s 1 --dry-run >out 2>err && [ ! -d fluidy ] &&
    grep -q 'would paint 3 frames of 64x48 pixels, 1 region: fluidy/w_%04d.png' err
result $? '--dry-run says what would be painted'
grep -qE 'would take about 0:00:0[0-9], 0\.[0-9]+ seconds a frame' err
result $? 'and how long that would take'
touch whole/fluidy-svg.conf
"$program" whole -s 01 --dry-run >out 2>err &&
    grep -q 'whole/fluidy-svg.conf is not used; --config whole/fluidy-svg.conf paints by it' err &&
    "$program" whole -s 01 --dry-run -c whole/fluidy-svg.conf >out 2>err && ! grep -q 'not used' err
result $? 'a config beside the drawing is offered'
rm whole/fluidy-svg.conf
mkdir odd
for i in 1 2 3; do
    echo "$drawing<path id='a' d='M9,9 h30 v30 x'/><path id='b' d='M9,9 h30 v30 x'/></svg>" >odd/w_$i.svg
done
"$program" odd -s 01 --detail draft -o 'odd/w_%d.png' >out 2>err && [ "$(grep -c warning: err)" = 1 ] &&
    grep -q 'warning: odd/w_1.svg: #a: .* (and in 2 more frames); and so for 1 more element$' err &&
    [ "$(tail -1 err)" = 'fluidy-svg: 1 warning at the beginning' ] &&
    grep -qE 'seconds: read [0-9.]+, guides .* memory: at most [0-9]+ MiB' err
result $? 'what is wrong in many places is one warning, and the summary recalls it'
"$program" whole -s 01 --preview 3 >out 2>err && "$program" whole -s 01 --preview 3 -q >out 2>err &&
    [ "$(ls fluidy)" = "$(printf 'w_preview_%s\n' 0002.png 0003.png)" ] && rm -r fluidy
result $? '--preview paints a frame and those beside it, again and again'
printf '[project]\nversion = 1\nlayers = film/{region}_%%d.png\nvectors = on\naudio = none.wav\n' >film.conf
"$program" whole -s 01 -c film.conf --preview 2 >out 2>err &&
    "$program" whole -c film.conf --styles 01 -o sheet0.png -f 2 >>out 2>>err && [ -s sheet0.png ] &&
    [ -s fluidy/w_preview_0002.png ] && rm -r fluidy && [ ! -e film ]
result $? 'drafts and sheets are made without the layers, vectors and sound of a config'
refuses 'where a film begins in no sound is refused' 2 '--audio-from says where *; name that by --audio' \
    whole -s 01 -o sound.mkv --audio-from 2
"$program" whole --styles 01,03 >out 2>err && [ "$(ls fluidy)" = w_styles.png ] && rm -r fluidy &&
    grep -q 'style 01 Watercolour' err &&
    "$program" whole --styles 01,03 -o sheet.png -f 2 -q >out 2>err && [ -s sheet.png ] && [ ! -s err ]
result $? '--styles is a sheet'
"$program" whole -s 01 --methods fluidymation,lazyfluids,lazyfluids:w-uni=0,transport -W 64 >out 2>err &&
    [ "$(ls fluidy)" = "$(printf 'w_methods.%s\n' html png)" ] &&
    grep -q '<dt><b>lazyfluids</b></dt><dd>.*begins again' fluidy/w_methods.html && rm -r fluidy
result $? '--methods is a sheet and a page'
: >page.html
refuses 'a page that exists stays, and no sheet is painted' 1 'page.html: already exists*' \
    --methods default -o page.png whole
rm page.html
"$program" --list-styles -o styles.png >out 2>err && [ -s styles.png ] &&
    grep -qE '^01 +Watercolour +soft and wet' out
result $? '--list-styles is a list and a sheet'
"$program" whole -s 01 --detail draft -o '{name}/{name}.gif' -q >out 2>err && [ -s w/w.gif ]
result $? 'the name of the drawing can stand in that of the output'
mkdir 'held 5%' && "$program" whole -s 01 --detail draft -f 1 -q -o 'held 5%' >out 2>err &&
    "$program" whole -s 01 --detail draft -f 1 -q -o held/folder/ >>out 2>>err &&
    "$program" whole -s 01 --detail draft -q -o 'held 5%' --format gif --no-frames >>out 2>>err &&
    [ -s 'held 5%/w_0001.png' ] && [ -s held/folder/w_0001.png ] && [ -s 'held 5%/w.gif' ]
result $? 'a folder as output is filled'
"$program" whole -s 01 --detail draft -f 1 -q -o held/n.png --layers held/folder --paint 'held/{name}%%{region}%d.png' >out 2>err &&
    [ -s held/folder/w_paper_sheet_0001.png ] && compgen -G 'held/w%*1.png' >out
result $? 'so is one of layers, and {name} in a pattern of layers or paint is the name of the film'
refuses 'a sheet that is no PNG is refused' 2 'styles.jpg: sheets are PNG files; *' --list-styles -o styles.jpg
refuses 'a sheet that exists stays' 1 'styles.png: already exists*' --list-styles -o styles.png
"$program" whole -s 01 --detail draft -o 'a/w_%d.png' --layers 'a/{region}_%d.png' >out 2>err &&
    [ "$(ls a | wc -l)" = 9 ] && [ -s a/paper_sheet_1.png ] && [ -s a/paper_stain_2.png ] && [ ! -s out ]
result $? 'frames and layers are painted, and the sheet of paper'
mkdir grounds
for i in 1 2 3; do
    cat >grounds/w_$i.svg <<END
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 96 96"><circle cx="20" cy="8" r="8" fill="#ee8"/>
<path d="M-9 10h114v20h-114z" fill="#cde"/><path d="M-9 60l114 20v30h-114z" fill="#354"/>
<path d="M$((5 + 15 * i)) 66h16v20h-16z" fill="#d33"/></svg>
END
done
"$program" grounds -s 01 -W 192 --detail draft --stain 1 -o 'grounds/o/%d.png' --layers 'grounds/o/{region}_%d.png' -q >out 2>err &&
    [ -s grounds/o/paper_stain-3_3.png ] && [ ! -e grounds/o/paper_stain-2_3.png ]
result $? 'the second ground above a figure keeps the number of its stain'
# visible FILE W:H:X:Y: the pixels of a part that are not transparent
visible() {
    ffmpeg -v error -i "$1" -vf "crop=$2,extractplanes=a" -f rawvideo - </dev/null | tr -d '\0' | wc -c
}
[ "$(visible grounds/o/paper_stain-3_3.png 20:4:80:132)" = 0 ] &&
    [ "$(visible grounds/o/paper_stain-3_3.png 20:12:80:150)" -gt 100 ]
result $? 'and ends where that ground does'
cp -r a b
refuses 'a frame that exists is not painted over' 1 'a/w_1.png: already exists; *' whole -s 01 -o 'a/w_%d.png'
refuses 'what exists is found before anything is read' 1 'a/w_1.png: already exists; *' broken -s 01 -o 'a/w_%d.png'
refuses 'before a map is drawn, too' 1 'a/w_1.png: already exists; *' broken --check -o 'a/w_%d.png'
refuses 'and before a sheet of styles' 1 'a/w_1.png: already exists; *' broken --styles 01 -o a/w_1.png
"$program" whole -s 01 --dry-run -o 'a/w_%d.png' >out 2>err && grep -q 'would paint 3 frames' err &&
    grep -q 'a/w_1.png: already exists; use -y' err
result $? 'a dry run only notes it'
touch old_0002.png
refuses 'a film beside older frames says what to do' 1 \
    'old_0002.png: *earlier film; use -y to replace its frames, --no-frames to write none, *' whole -s 01 -o old.mkv
refuses 'a layer that exists is not painted over' 1 'a/*_1.png: already exists; *' \
    whole -s 01 -o 'c/w_%d.png' --layers 'a/{region}_%d.png'
rm a/w_2.png && touch -d @0 a/w_1.png
"$program" whole -s 01 --detail draft -o 'a/w_%d.png' --layers 'a/{region}_%d.png' --no-clobber -j1 \
    >out 2>err && [ "$(stat -c %Y a/w_1.png)" = 0 ] && same a b
result $? '--no-clobber paints what is missing, and gives the same bytes'

# Layers as frames: one file, as Inkscape keeps it, and the same frames as files.
mkdir layered
group='<g xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:groupmode="layer" inkscape:label'
ground="$group='land (static)'><path fill='#88aacc' d='M0 30h64v18H0z'/></g>"
echo "$drawing$ground" >film.svg
for i in 1 2 3; do
    shapes="<g xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' inkscape:label='hat'><circle id='c$i' cx='$((20 + 4 * i))' cy='24' r='12' fill='#aa3311'/></g>
<path d='M5 5L50 4$i' stroke='#000' fill='none'/>"
    echo "$group='Frame $i (200)' style='display:none' id='layer$i'>$shapes</g>" >>film.svg
    echo "$drawing$ground<g>$shapes</g></svg>" >layered/film_$i.svg
done
echo '</svg>' >>film.svg
"$program" film.svg --frames-from layers -s 01 -q -o 'one/w%d.png' >out 2>err &&
    "$program" layered -s 01 -q -o 'many/w%d.png' >out 2>err && same one many && [ -s one/w3.png ]
result $? 'frames that are layers of one file are painted as if each had a file'
sed 's|</svg>|<g><use href="#c2"/></g></svg>|; s|groupmode|mode|' film.svg >clones.svg
"$program" clones.svg --frames-from layers -f 4 --list-regions >out 2>err && grep -q 'hat-aa3311\|red-aa3311 .* 1/1' out
result $? 'clones of what is in another layer are drawn'
refuses 'layers of several files are refused' 2 '--frames-from layers: 3 files; expected one *' layered --frames-from layers $look
refuses 'a file without layers is named' 1 'whole/w_0001.svg: no layers *' whole/w_0001.svg --frames-from layers $look
echo "$drawing<circle r='9' fill='#f00'>
<animate attributeName='cx' values='0;9' dur='1s'/></circle></svg>" >moves.svg
"$program" moves.svg -s 01 --fps 12 --dry-run >out 2>err && grep -q 'would paint 12 frames' err
result $? 'a lone file that moves by itself is a film'
"$program" moves.svg -s 01 --fps 10 --from .5 --to .8 --dry-run >out 2>err && grep -q 'would paint 3 frames' err
result $? 'a stretch of its time is painted on request'
refuses 'a stretch beyond its end is refused' 2 '*moves.svg: its film is 1 s long*' moves.svg --from 2 $look
"$program" moves.svg -s 01 --frames-from files --dry-run >out 2>err && grep -q 'would paint 1 frame' err
result $? 'it is one frame on request'

# For programs.
film=$fixtures/animations/snowman-wave-layers
json() { # json FILE EXPRESSION: whether it is true of the list of a file's lines, or its one object
    python3 -c 'import json, sys
text = open(sys.argv[1]).read()
try: data = json.loads(text)
except ValueError: data = [json.loads(line) for line in text.splitlines()]
sys.exit(not eval(f"({sys.argv[2]})"))' "$1" "$2" 2>>err
}
"$program" "$film" --list-regions --format json >out 2>err && json out 'data["width"] == 1024 and
    data["frames"] == list(range(1, 45)) and {"region": "hat-a42718", "painted": True}.items() <=
    next(r for r in data["regions"] if r["layer"] == "body/head/hat" and "a4" in r["region"]).items()'
result $? '--list-regions --format json is JSON'
"$program" --list-styles --format json >out 2>err && json out 'data[1]["name"] == "Ink" and len(data) >= 10'
result $? 'so is --list-styles --format json'
cp -r "$fixtures/style-small" own && printf '\n[region]\nengine = lazyfluids\n' >>own/style.ini
engine() { "$program" whole -s ./own -f 1 -v --detail draft -o 'own/%d.png' -y "$@" 2>&1 >out | grep -c 'engine lazyfluids'; }
[ "$(engine)" -gt 0 ] && [ "$(engine --engine patch)" = 0 ] && [ "$(engine --preset thesis)" = 0 ]
result $? 'a style brings settings of its regions, and those of the user come after them'
"$program" whole -s 01 --preset fluidymation --dry-run >out 2>err && grep -q 'narrower than the border of their preset' err &&
    "$program" whole -s 01 --preset fluidymation --border 2 --dry-run >out 2>err && ! grep -q narrower err
result $? 'a border that is all of a region is told'
refuses 'a list in a format of pictures is refused' 2 '--format png: lists are written *' whole --list-regions --format png
"$program" nowhere -s 01 --progress json >out 2>err
[ $? = 1 ] && json err '"nowhere: no such" in data["error"]'
result $? 'an error is a JSON object with --progress json'
"$program" "$film" -s 01 -W 96 --detail draft --missing hold --no-frames --paint 'apart/d/{region}_%d.png' -j1 \
    -f 1-6 --progress json >out 2>err && json err '[d["done"] for d in data if d.get("stage") == "masks"][-1] == 6 and
    any(d.get("stage") == "read" and d["total"] == 6 for d in data) and
    any("apart/d/{region}" in d.get("note", "") for d in data)'
result $? 'progress is told while frames are read and masks are drawn'
[ -z "$(ls apart/d | grep -v -- '-[0-9a-f]*_[0-9]*.png')" ] && [ -s apart/d/hat-a42718_6.png ] &&
    [ "$(find apart -name '.*')" = '' ] && [ ! -e fluidy ]
result $? '--paint with --no-frames writes the paint alone'
"$program" "$film" -s 01 -W 96 --detail draft -j1 --merge --paint 'apart/d/{region}_%d.png' -o 'apart/m%d.png' --front 0 --stain 0 -f 6 >out 2>err &&
    "$program" "$film" -s 01 -W 96 --detail draft -j1 -o 'apart/w%d.png' --front 0 --stain 0 -f 1-6 >out 2>err && same apart/m6.png apart/w6.png
result $? 'and it is the paint of the film'
# Its text says where the region has moved to; whatever it says, the frame is painted.
/usr/bin/python3 - apart/d/*_6.png <<'EOF'
import sys, zlib
for path in sys.argv[1:]:
    data = open(path, 'rb').read()
    at = data.index(b'tEXtAnchor\0')
    length = int.from_bytes(data[at - 4:at], 'big')
    text = b'tEXtAnchor\0nan 1e30 -9 4'.ljust(length + 4)
    open(path, 'wb').write(data[:at] + text + zlib.crc32(text).to_bytes(4, 'big') + data[at + 8 + length:])
EOF
"$program" "$film" -s 01 -W 96 --detail draft -j1 --merge --paint 'apart/d/{region}_%d.png' -o 'apart/n%d.png' --front 0 --stain 0 -f 6 >out 2>err &&
    [ -s apart/n6.png ] && ! same apart/n6.png apart/w6.png
result $? 'a text that says nothing is left alone'
ls whole/*1.svg whole/*2.svg | "$program" - -s 01 --detail draft -o 'listed/%d.png' >out 2>err &&
    [ "$(ls listed | xargs)" = '1.png 2.png' ]
result $? '- is the files that standard input lists'
"$program" whole -s 01 --detail draft -q -o 'new/a/b/%d.png' --stats new/s/t/x.json --report new/r/q --dump new/d/e \
    --layers 'new/l/m/{region}%d.png' --paint 'new/p/q/{region}%d.png' >out 2>err &&
    "$program" whole --check -q -o 'new/c/c/%d.png' >out 2>err &&
    "$program" whole --flat -q -o 'new/f/f/%d.png' >out 2>err &&
    "$program" whole --styles 01 -q -o new/i/i/s.png >out 2>err &&
    "$program" --list-styles -o new/j/j/s.png >out 2>err && [ "$(ls new | xargs)" = 'a c d f i j l p r s' ]
result $? 'a folder that is not there is made for whatever is written'
touch stats.json
refuses 'statistics that exist are found before anything is read' 1 'stats.json: already exists; *' broken $look --stats stats.json

# Held frames: one that is not there and one beyond a limit, before everything that changes.
for i in 1 2 5; do
    echo "$drawing<circle cx='$((20 + 4 * i))' cy='24' r='12' fill='#aa3311'/>
<path d='M$((4 + i)) 5L50 44' stroke='#000' stroke-width='1'/></svg>" >gap/w_000$i.svg
done
echo "$drawing$(printf '<circle r="9" fill="#ff0000"/>%.0s' {1..60})</svg>" >gap/w_0004.svg
rm gap/w_0003.svg
"$program" gap -s 01 --missing hold --limit elements=50 --boil 1 --line-boil 1 --paper-boil 1 -o 'held/w_%d.png' \
    --layers 'held/{region}_%d.png' >out 2>err && same held/w_2.png held/w_3.png &&
    same held/w_2.png held/w_4.png && same held/red-aa3311_2.png held/red-aa3311_4.png &&
    ! same held/w_4.png held/w_5.png && ! same held/w_1.png held/w_2.png
result $? 'a frame that is held is the one before, to the bit'

# on_a_terminal COMMAND: what it prints there, control characters spelt out
on_a_terminal() {
    TERM=xterm script -qec "stty cols 75; $1" /dev/null </dev/null | tr '\r' '\n' | cat -v
}
paint="'$program' whole -s 01 --detail draft -o 'term/w_%d.png' -y"
if [ "$(on_a_terminal 'echo yes' 2>/dev/null)" = yes ]; then
    on_a_terminal "$paint" >out && grep -qE '^\[\^\[\[36m#{24}\^\[\[0m\] 100 % paint, frame 3 \(3/3\), [0-9.]+ s/frame, 0' out &&
        ! grep '^\[' out | sed 's/\^\[\[[0-9]*[mK]//g' | grep -qE '.{76}'
    result $? 'a terminal has a bar with frame, seconds a frame and the time that is left'
    on_a_terminal "NO_COLOR=1 $paint" >out && grep -q '\[####' out && ! grep -qF '[36m' out
    result $? 'NO_COLOR leaves the bar without colour'
fi
bash -c "$paint" 2>err >out && ! grep -q '\[' err && grep -qE '^100 % paint, frame 3 \(3/3\)' err
result $? 'elsewhere there are plain lines'

"$program" --list-regions "$film" >out 2>err && [ ! -s err ] &&
    grep -qE '^hat-a42718 +#a42718 +44/44 .* body/head/hat$' out
result $? '--list-regions prints a line per region'
"$program" --print-config "$film" >shot.conf 2>err &&
    "$program" --list-regions -c shot.conf "$film" >again 2>err && [ ! -s err ] &&
    cmp <(awk '{ print $1, $2, $3, $4 }' out) <(awk '{ print $1, $2, $3, $4 }' again) &&
    grep -q ' yes  *hat-a42718 ' again
result $? 'the config that is printed gives the same regions'

# The config: three edits of the printed one, every key that the manual has, and its example.
"$program" --list-regions "$film" >out 2>err && "$program" --list-regions --sandbox off "$film" >again 2>err && cmp out again &&
    { "$program" --list-regions --sandbox require "$film" >again 2>err && cmp out again || grep -q -e '--sandbox require: ' err; }
result $? 'the sandbox changes no result; if it is required and a part is missing, that is an error'
printf '[project]\nversion = 1\nsandbox = off\n' >open.conf
! "$program" --list-regions -c open.conf "$film" >out 2>err && grep -q 'sandbox' err
result $? 'a config cannot open the sandbox'
mkdir recoloured
for t in 1 2; do
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='90' height='60'><g id='arm'><path d='M${t} 9h20v20h-20z' fill='#474d50'/></g>
        <g id='flake1'><circle cx='50' cy='${t}9' r='4' fill='#95c7f7'/></g><g id='flake2'><circle cx='70' cy='${t}9' r='4' fill='#95c7f7'/></g>
        <path class='foot' d='M40 40h9v9h-9z' fill='#ff6207'/></svg>" >"recoloured/$t.svg"
done
"$program" recoloured --print-config >last.conf && grep -qx '\[region flake\*\]' last.conf && grep -qx 'match-class = foot' last.conf &&
    ! grep -q '^[^#]*[0-9a-f]\{6\}' last.conf && [ "$(grep -c '^\[region' last.conf)" = 3 ] &&
    sed -i 's/#474d50/#603020/; s/#95c7f7/#88aaee/g; s/#ff6207/#22aa44/' recoloured/*.svg &&
    "$program" recoloured -c last.conf --list-regions >out 2>err && [ ! -s err ] &&
    [ "$(awk 'NR > 1 && $7 != "-"' out | wc -l)" = 4 ]
result $? 'a printed config fits the drawing after all its colours have changed'
"$program" --print-config -f 1 "$film" >shot.conf 2>err &&
    sed -i -e '/^\[region hat-474d50\]/,/^$/ s/^# tint = fill/tint = #224488/' \
        -e '/^\[region face-ffa72b\]/,/^$/ s/^# style = 01/passthrough = on/' \
        -e 's/^# background = #ffffff/background = #ffeedd/' shot.conf &&
    [ "$(grep -cE '^(tint = #2|passthrough|background)' shot.conf)" = 3 ] &&
    "$program" "$film" -c shot.conf -W 96 -f 1 --detail draft -o edited_%d.png >out 2>err &&
    "$program" "$film" -s 01 -W 96 -f 1 --detail draft -o plain_%d.png >out 2>err &&
    ! same edited_1.png plain_1.png
result $? 'three edits of the printed config change the picture'
cat >all.conf <<'END'
[project]
version = 1
background = #ffffff
blend = linear
canvas = 64x48
fps = 12
frames = 1-2
gap = 1
key = auto
layers = all/{region}_%d.png
missing = hold
output = all/w_%d.png
register = off
seed = 3
stroke = paint
[defaults]
style = 01
detail = draft
[region disc]
match-fill = #aa3311;#bb4422
match-tolerance = 5
match-id = c*
match-class = a;b?
match-label = *
match-layer = Char*
tint = #335577
border = 6
scale = 0.5
rotate = off
w-temp = 2
w-bound = 8
stacking = glaze
medium = body
edges = soft
reverse = on
hold = 2
[region rim]
match-stroke = #000000
match-fill = none
merge-with = disc
[region white-ffffff]
passthrough = on
[region rest]
match = *
END
mkdir all.d
for i in 1 2; do
    echo "$drawing<g xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' inkscape:groupmode='layer' inkscape:label='Character'>" \
        "<circle id='c1' class='x b2' cx='$((20 + 4 * i))' cy='24' r='12' fill='#a93311'/>" \
        "<path d='M40,8v30' stroke='#000' stroke-width='3' fill='none'/></g>" \
        "<path d='M50,10h8v8h-8z' fill='#228833'/></svg>" >all.d/w_000$i.svg
done
"$program" all.d -c all.conf >out 2>err && [ -s all/w_2.png ] && [ -s all/disc_1.png ] &&
    [ -s all/rest_1.png ] && [ ! -e all/rim_1.png ] && [ "$(grep 'warning:' err)" = "$(grep 'warning: all.conf:41: ' err)" ]
result $? 'every key of a config is taken'
# A layer's name says settings: more than --hold for all regions, less than a section for its own.
mkdir named.d
for i in 1 2; do
    sed "s/'Character'/'Disc hold=2 carry=0.3'/" all.d/w_000$i.svg >named.d/w_000$i.svg
done
"$program" named.d -s 01 --list-regions >out 2>err && grep -q '^disc-a93311 ' out &&
    "$program" named.d -s 01 --hold 1 -o 'named/%d.png' --paint 'named/{region}_%d.png' 2>err &&
    [ -s named/disc-a93311_1.png ] && [ ! -e named/disc-a93311_2.png ]
result $? "a layer's name says how it is painted"
sed -i "s/hold=2/hold=0/" named.d/w_000?.svg
printf '[region disc-*]\nhold = 1\n' >named.conf
"$program" named.d -s 01 --dry-run 2>err; grep -q 'layer “Disc hold=0 carry=0.3”: hold: “0” is not' err &&
    "$program" named.d -s 01 -c named.conf --dry-run 2>err && sed -i "s/hold=0/style=blom/" named.d/w_000?.svg &&
    ! "$program" named.d -s 01 --dry-run 2>err && grep -q 'layer “Disc style=blom carry=0.3”: no style “blom”' err &&
    ! "$program" all.d -s Char --dry-run 2>err && grep -q '^fluidy-svg: no style “Char”' err
result $? 'a mistake in it names the layer, and a section of the region wins'
sed -n '/^\.Sh EXAMPLES/,/^\.Ed/p' "$fixtures/../man/fluidy-svg.conf.5.in" | grep -v '^\.' >example.conf
cp plain_1.png paper.png
"$program" all.d -c example.conf --dry-run >out 2>err &&
    ! grep 'warning:' err | grep -v 'example.conf:8: \[region hair\] matches no region'
result $? 'the example of fluidy-svg.conf(5) is read'

# Paint that leaves its paper is opaque unless somebody says otherwise.
of_medium() { # of_medium NAME STYLE ARGUMENT...: a frame in medium/NAME.png
    "$program" whole --frames 1 -s "$2" --detail draft -q -o "medium/$1%d.png" "${@:3}" >out 2>err
}
printf '[defaults]\nmedium = transparent\n' >glaze.conf
of_medium none 01 -b none && of_medium config 01 -b none -c glaze.conf &&
    of_medium glaze 01 -b none --medium transparent && same medium/config1.png medium/glaze1.png &&
    ! same medium/none1.png medium/glaze1.png
result $? 'over nothing paint is opaque unless the config or the command line say otherwise'
of_medium dust 04 -b none && of_medium dust-body 04 -b none --medium body && same medium/dust1.png medium/dust-body1.png
result $? 'charcoal has body as its style says'
horse=$fixtures/animations/horse-gallop
"$program" "$horse" -s 05 -f 1-2 -W 96 -q -o medium/plain%d.png >out 2>err &&
    "$program" "$horse" -s 05 -f 1-2 -W 96 -q -o medium/apart%d.png --layers 'medium/l-{region}-%d.png' >out 2>err &&
    same medium/plain1.png medium/apart1.png && same medium/plain2.png medium/apart2.png
result $? 'layers that are stored beside a film change no pixel of it'

# Paper and the unevenness of paint are composing: the paint below them is the same.
on_paper() { # on_paper NAME ARGUMENT...: a frame, and its paint, in sheet/NAME…
    "$program" whole --frames 1 -s 01 -W 60 -q -o "sheet/$1%d.png" --paint "sheet/$1-{region}_%d.png" \
        "${@:2}" >out 2>err
}
same_paint() { # same_paint NAME…: the paint of each is that of sheet/auto
    for other; do
        same sheet/auto-*_1.png sheet/"$other"-*_1.png || return 1
    done
}
printf '[project]\npaper = kraft\n' >kraft.conf
on_paper auto && on_paper cold --paper cold && on_paper bare --paper none --granulation 0 &&
    on_paper relief --paper-relief 0 && on_paper seed --paper-seed 5 && on_paper kraft -c kraft.conf &&
    ! same sheet/auto1.png sheet/cold1.png && ! same sheet/auto1.png sheet/bare1.png &&
    ! same sheet/auto1.png sheet/seed1.png && ! same sheet/auto1.png sheet/kraft1.png &&
    ! same sheet/bare1.png sheet/relief1.png && ! same sheet/auto1.png sheet/relief1.png &&
    same_paint cold bare relief seed kraft
result $? 'paper is that of the style unless it is said, and changes no paint'
on_paper white -b '#ffffff' && on_paper white-none -b '#ffffff' --paper none &&
    on_paper white-cold -b '#ffffff' --paper cold && ! same sheet/white1.png sheet/white-cold1.png &&
    ! same sheet/white1.png sheet/white-none1.png
result $? 'over a background the sheet has its tooth alone unless it is asked for'
on_paper preset --preset fluidymation --paper none &&
    on_paper preset-zero --preset fluidymation --paper none --granulation 0 --wash 0 --hue 0 &&
    on_paper preset-play --preset fluidymation --paper none --hue 6 &&
    same sheet/preset1.png sheet/preset-zero1.png && ! same sheet/preset1.png sheet/preset-play1.png
result $? 'the presets of the papers have even paint'
on_paper wash --wash 2 --hue 7.2 && same_paint wash && ! same sheet/wash1.png sheet/auto1.png
result $? 'washes are composing'
steady=(whole -f 1-2 -s 01 -W 60)
"$program" "${steady[@]}" --preset lazyfluids-steady -o 'sheet/steady%d.png' -q >out 2>err &&
    "$program" "${steady[@]}" --preset lazyfluids -o 'sheet/paper%d.png' -q >out 2>err &&
    ! same sheet/steady2.png sheet/paper2.png
result $? 'pictures have a steadier preset than the paper'

# What is written opens as it looks.
if "$program" whole -s 01 -q -f 1 -o 'open/w%d.ora' >out 2>err; then
    "$program" whole -s 01 -q -f 1 -b '#336699' --paper rough -o 'open/b%d.ora' >out 2>err &&
        "$program" whole -s 01 -q -f 1 -b none --paper cold -o 'open/n%d.ora' >out 2>err &&
        "$program" whole -s 01 -q -f 1-3 --paper-boil 2 -o 'open/p%d.ora' >out 2>err &&
        off=$(python3 "$tests/ora.py" open/[wbn]1.ora open/p[23].ora 2>err) && echo "$off" >>err &&
        [ "${off%.*}" -le 1 ]
    result $? 'the layers of an OpenRaster file, paper and ground among them, make its picture'
fi
"$program" whole -s 01 -q -f 1 -b none -o 'open/n%d.png' --layers 'open/{region}%d.png' >out 2>err &&
    python3 "$tests/ora.py" open/n1.png 2>err && python3 "$tests/ora.py" open/red-aa33111.png 2>err
result $? 'the alpha of PNG files is straight'
"$program" whole -s 01 -q -f 1 --format png16 -o 'open/deep%d.png' >out 2>err &&
    on_paper deep --paper open/deep1.png && on_paper ground -b open/deep1.png &&
    ! same sheet/deep1.png sheet/auto1.png && ! same sheet/ground1.png sheet/auto1.png
result $? 'paper and background may have 16 bits'
if ! command -v ffmpeg >/dev/null; then
    skip 'they may be JPEG pictures' 'no ffmpeg'
else
    ffmpeg -v error -y -i open/deep1.png open/Deep.JPG && on_paper jpeg --paper open/Deep.JPG &&
        on_paper jpeg-ground -b open/Deep.JPG && ! same sheet/jpeg1.png sheet/auto1.png &&
        ! same sheet/jpeg-ground1.png sheet/auto1.png &&
        head -c 100 open/Deep.JPG >open/cut.jpg && ! on_paper cut --paper open/cut.jpg &&
        grep -q 'open/cut.jpg: cannot be read as pictures: ' err && ! grep -q 'marking filters' err
    result $? 'they may be JPEG pictures'
    ffmpeg -v error -y -i sheet/auto1.png -lossless 1 -pix_fmt bgra open/a.webp && cp sheet/auto1.png open/a.png
    for end in png webp; do
        echo "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='40'><image href='a.$end' width='40' height='40'/></svg>" >open/$end.svg
        "$program" --flat open/$end.svg -q -o open/flat-$end.png
    done >out 2>err
    if grep -q 'reads no WebP' err; then
        skip 'drawings may have WebP images' 'no libwebp'
    else
        [ ! -s err ] && cmp open/flat-png.png open/flat-webp.png >out
        result $? 'drawings may have WebP images'
    fi
fi

# Drafts are made at half the size, all regions or none; their files have that of the frames.
sides() { # of a PNG file
    od -An -tu4 --endian=big -j16 -N8 "$1" | xargs
}
"$program" all.d -s 01 --detail draft -W 61 -o 'half/w_%d.png' --layers 'half/l_{region}_%d.png' \
    --paint 'half/p_{region}_%d.png' -q >out 2>err && [ "$(sides half/w_1.png)" = '61 46' ] &&
    [ "$(for layer in half/l_*; do sides "$layer"; done | sort -u)" = '61 46' ] &&
    [ "$(for paint in half/p_*; do sides "$paint"; done | sort -u)" = '31 23' ]
result $? 'a draft of an odd size has frames and layers of that size'
for half in on off; do
    printf '[defaults]\nstyle = 01\n[region one]\nmatch-fill = #a93311\ndetail = draft\nhalf-size = %s\n' $half \
        >some-$half.conf
    "$program" all.d -c some-$half.conf -o "some-$half/w_%d.png" -q >out 2>err || break
done
same some-on some-off && [ -s some-on/w_1.png ]
result $? 'among others a draft is not made at half the size'
printf '[defaults]\nstyle = 01\n[region one]\nmatch-fill = #a93311\nengine = lazyfluids\n' >two-engines.conf
drafted() { # a folder, options
    "$program" all.d -c two-engines.conf --detail draft -W 61 -o "$1/w_%d.png" -q "${@:2}" >out 2>err
}
drafted drafted -j1 && drafted drafted-many -j2 &&
    drafted drafted-seen --report drafted-report --dump drafted-dump --stats drafted.json &&
    same drafted drafted-many && same drafted drafted-seen >out &&
    [ "$(for plane in drafted-dump/*/distance_*.png; do sides "$plane"; done | sort -u)" = '31 23' ]
result $? 'drafts of two engines are the same on two threads, and where their guides are looked at'

# An edge is closed where shapes end at each other, and soft where one lies over the other; shading
# over both hides neither.
mkdir lie lie-mixed meet lie-shaded meet-shaded
echo "<svg xmlns='http://www.w3.org/2000/svg' width='120' height='80'><path d='M5 5h110v70H5z' fill='#336699'/>
<path d='M30 15h60v50H30z' fill='#bb4422'/></svg>" >lie/d_1.svg
echo "<svg xmlns='http://www.w3.org/2000/svg' width='120' height='80'><path d='M5 5h55v70H5z' fill='#336699'/>
<path d='M60 5h55v70H60z' fill='#bb4422'/></svg>" >meet/d_1.svg
sed "s|fill='#bb4422'|& style='mix-blend-mode:multiply'|" lie/d_1.svg >lie-mixed/d_1.svg
for drawing in lie meet; do
    sed "s|</svg>|<path d='M0 0h120v80H0z' fill-opacity='.6'/></svg>|" $drawing/d_1.svg >$drawing-shaded/d_1.svg
done
printf '[region shading]\nmatch-fill = #bb4422\npassthrough = off\n' >painted.conf
closes() { # closes DRAWING ARGUMENT...: whether closed edges look other than soft ones
    for edges in closed soft; do
        "$program" "$@" -s "$fixtures/style-small" --edges $edges -q -o "$1/$edges%d.png" >out 2>err || return 2
    done
    ! same "$1/closed1.png" "$1/soft1.png"
}
closes meet && { closes lie; [ $? = 1 ]; }
result $? 'edges are closed where shapes meet, not where one lies over the other'
closes lie-mixed -c painted.conf
[ $? = 1 ]
result $? 'nor where shading that is to be painted lies over it'
closes meet-shaded && { closes lie-shaded; [ $? = 1 ]; }
result $? 'shading over shapes does not change which of their edges are closed'

echo "1..$n"
