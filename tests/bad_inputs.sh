#!/bin/bash
# A table of mistakes: each is one line on standard error that says what and where, the right exit
# status, and no file. usage: bad_inputs.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

svg() { # svg NAME BODY [ATTRIBUTES]: a folder with one drawing
    mkdir -p "$1"
    echo "<svg xmlns='http://www.w3.org/2000/svg' ${3-width='48' height='48'}>$2</svg>" >"$1/a_1.svg"
}
png() { # png FILE SIZE COLOUR
    ffmpeg -v error -y -f lavfi -i "color=$3:s=$2,format=rgba" -frames:v 1 "$1" </dev/null
}
own() { # own NAME [TEXT]: a copy of the style, perhaps with that style.ini
    cp -r "$style" "$1"
    chmod -R u+w "$1"
    [ $# = 1 ] || printf '%b\n' "$2" >"$1/style.ini"
}
conf() { # conf NAME TEXT
    printf '%b\n' "$2" >"$1.conf"
}
le() { # le NUMBER...: as bytes of 32-bit integers, for flow files
    local number
    for number in "$@"; do
        printf '%b' "$(printf '\\x%02x\\x%02x\\0\\0' $((number % 256)) $((number / 256)))"
    done
}

shape="<circle cx='24' cy='24' r='16' fill='#aa3311'/>"
rm -rf film
svg good "$shape"
svg nosize "$shape" ''
svg zero "$shape" "width='0' height='9'"
svg nan "$shape" "width='nan' height='9'"
svg huge "$shape" "width='1e9' height='9'"
svg twice "<g>
<g a='1' a='2'/></g>"
svg other "$shape" && echo '<svg xmlns="urn:other"/>' >other/a_2.svg
svg shows "$shape<image href='sub/p_1.png' width='9' height='9'/>" && mkdir shows/sub
svg gap "$shape" && cp gap/a_1.svg gap/a_4.svg
mkdir none text html cut
echo 'not a drawing' >text/a_1.svg
echo '<html><body/></html>' >html/a_1.svg
head -c 90 good/a_1.svg >cut/a_1.svg
touch void.svg
head -c 100 /dev/zero >zeros.svg
printf "<svg xmlns='http://www.w3.org/2000/svg'>%s" "$(printf '<g>%.0s' {1..300})" >deep.svg
printf '\x1f\x8b\x08garbage' >packed.svg
printf '\xff\xfe\x00<' >binary.svg
svg nothing ''
svg nbsp "$shape<text>a&nbsp;b</text>"
svg dashes "<!-- a -- b -->$shape"
svg latin "<desc>$(printf 'caf\xe9')</desc>$shape"
svg negative "$shape" "width='-4' height='9'"
mkfifo pipe.svg pipe.png pipe.conf
own pipeframe && rm pipeframe/frames/0002.png && mkfifo pipeframe/frames/0002.png
own pipeini && rm -f pipeini/style.ini && mkfifo pipeini/style.ini
svg broken "<path id='p' d='M1 1h9 x v9z' fill='#aa3311'/>"
svg lost "<rect id='r' width='9' height='9' fill='url(#g)'/>$shape"
svg circle "<g id='a'><use href='#a'/>$shape</g>"
svg animated "<circle id='c' r='16' fill='#aa3311'><animate attributeName='r' to='9'/></circle>"
svg rule "<style>@container x { circle { fill: red } }</style>$shape"
svg piped "$shape<image id='i' href='../piped/p.png' width='9' height='9'/>" && mkfifo piped/p.png
svg sheet "<style>@import url('s.pipe');</style>$shape" && mkfifo sheet/s.pipe
svg styled "<style>@import 'a.css';</style>$shape" && echo '@import "b.css";' >styled/a.css && touch styled/b.css
svg used "$shape<use href='p.pipe#a'/>" && mkfifo used/p.pipe
svg escape "$shape<rect id='a&#10;b' width='9' height='9' fill='url(#x&#9;y)'/>"
svg image "$shape<image id='i' href='gone.png' width='9' height='9'/>"
echo "x<svg xmlns='http://www.w3.org/2000/svg' width='48' height='48'>$shape</svg>" >prologue.svg

mkdir noframes
own still && find still/frames -name '000[2-9].png' -delete
own hole && rm hole/frames/0002.png
own damaged && head -c 200 "$style/frames/0002.png" >damaged/frames/0002.png
own gif && echo GIF89a >gif/frames/0002.png
own odd && png odd/frames/0002.png 7x5 white
own blank && for i in 1 2 3 4 5 6; do png blank/frames/000$i.png 64x48 white; done
own black && mkdir black/masks && for i in 1 2 3 4 5 6; do png black/masks/000$i.png 64x48 black; done
own few && mkdir few/masks && png few/masks/0001.png 64x48 white
own oneflow && mkdir oneflow/flow && echo PIEH >oneflow/flow/0001.flo
own word '[style]\nmedium = opaqe'
own key '[style]\n\nnmae = x'
own section '[stile]\nname = x'
own number '[style]\nborder = -3'
own notanumber '[style]\nfps = nan'
own nonsense 'hello'
own colour '[style]\npaper = #12'

conf style '[defaults]\nstyle = nowhere'
conf unused '[region nowhere]\nmatch-id = nowhere'
conf folder '[defaults]\nstyle = ../no/where'
conf hold '[defaults]\nhold = 0'
conf mistyped '[region a]\nmatch-fil = #123456'
conf colour '[region a]\nmatch-fill = #12345'
conf open '[defaults'
conf first 'style = 01'
conf regon '[regon a]\nstyle = 01'
conf range '[defaults]\nw-temp = 1e9'
conf words '[defaults]\n\njust words'
conf tint '[defaults]\ntint = blue-ish'
conf width '[defaults]\nwidth = 300'
conf place '[project]\ntint = keep'
conf version '[project]\nversion = 2'
conf double '[region a]\nmatch-id = x\n[region a]\nmatch-id = y'
printf '[defaults]\nstyle = \xff\xfe\n' >latin.conf
head -c 1100000 /dev/zero | tr '\0' '#' >long.conf

{ printf PIEH && le 48 48; } >short_1.flo
{ printf PIEH && le 8 8 && head -c 512 /dev/zero; } >small_1.flo
{ printf PIEH && le 48 48 && for _ in $(seq 4608); do printf '\0\0\300\177'; done; } >nan_1.flo
echo hello >text_1.flo
png clear.png 48x48 red@0
mkdir -p dumped/red-aa3311 page && cp clear.png dumped/red-aa3311/ && cp clear.png shows/sub/p_1.png && touch page/index.html page/conf.png
ln -s good/a_1.svg link.svg
touch taken

# Status, message (a glob) and arguments; every row also has -s STYLE in front.
table() {
    cat <<'EOF'
2|-W: “0” is not an integer from 1 to 32767 px|good -W 0
2|-W: “99999999999999999999” is not an integer *|good -W 99999999999999999999
2|-H: “1.5” is not an integer *|good -H 1.5
2|--scale: “-1” is not a number from 0.001 to 1000|good --scale -1
2|size: expected a width and a height, or a scale, above 0|good --scale 2 -W 3
2|--dpi: “nan” is not a number *|good --dpi nan
2|--fps: “inf” is not a number from 0.01 to 1000 *|good --fps inf
2|--seed: “-1” is not an integer *|good --seed -1
2|--gap: “-1” is not a number from 0 to 32 px|good --gap -1
2|-j: “0” is not an integer from 1 to 1024|good -j 0
2|--key: “colour” is not auto, fill, *|good --key colour
2|--blend: “sgrb” is not srgb or linear; did you mean “srgb”?|good --blend sgrb
2|--output: the value is missing|good --output=
2|--region: the value is missing|good --region=
2|no region “red”; the regions are: red-aa3311|good --region red
2|frames “3-1”: expected numbers and ranges *|good -f 3-1
2|frames “99999999999”: expected *|good -f 99999999999
1|good/a_%d.svg: no file for frame 7; use --missing *|good -f 1,7
2|canvas “0x0”: expected WxH *|good --canvas 0x0
2|canvas “9x9+1”: expected WxH or WxH+X+Y, *|good --canvas 9x9+1
2|no limit “x”*the limits are: drawing, elements, *|good --limit x=1
2|background “blue”: expected #rrggbb, none, *|good -b blue
2|film.mp4: H.264 has no transparency; *|good -b clear.png -o film.mp4
2|x_%d.png: --no-frames is for films; use a name such as walk.mov|good --no-frames -o x_%d.png
2|film.mov: a film cannot be resumed without its frames; *|good --resume --no-frames -o film.mov
2|x.bmp: *|good -o x.bmp
2|x_%s.png: “%s.p” is no frame number; expected %d, %04d or ####*|good -o x_%s.png
2|x_%d_%d.png: *|good -o x_%d_%d.png
2|x_{region}.png: {region} is allowed in the names of layers only|good -o x_{region}.png
2|x_{rgion}.png: “{rgion}” is not understood; expected {region}|good --layers x_{rgion}.png
2|x_{region}.png: one file for 2 frames; expected a number in the name*|gap --missing skip --layers x_{region}.png
2|x_{region}.exr: layers and paint are PNG files; expected .png|good --layers x_{region}.exr
2|x_%d_{region}: layers and paint are PNG files; *|good --paint x_%d_{region}
2|--paint: one file for all frames; expected a number in the name*|good --paint x_{region}.png
2|--merge composes what --paint has written, or what ebsynth has painted *|good --merge
1|eb/red-aa3311/out_0001.png: there is no such file; *|good --merge --ebsynth eb
2|region red-aa3311: the engine transport has no guides for --ebsynth; *|good -s 11 --ebsynth eb
2|dumped/red-aa3311/clear.png: is read by this render; *|good -y -b dumped/red-aa3311/clear.png --ebsynth dumped -o y_%d.png
2|--merge paints nothing that --report or --dump could show*|good --merge --paint {region}_%d.png --dump d
1|gone/red-aa3311_1.png: there is no such file; --paint without --merge writes*|good --merge --paint gone/{region}_%d.png
1|odd/frames/0001.png: 64x48 pixels: expected 48x48*|good --merge --paint odd/frames/%04d.png -f 1
2|good/a_1.svg: is read by this render; expected another name *|good -y --format png -o good/a_%d.svg
2|./good/a_1.svg: is read by this render; *|good/a_1.svg -y --format hash -o ./good/a_1.svg
2|clear.png: is read by this render; *|good -y -b clear.png -o clear.png -f 1
2|good/a_1.svg: is read by this render; *|good -y --stats good/a_1.svg -o y_%d.png
2|shows/sub/p_1.png: is read by this render; *|shows -y --layers shows/sub/p_%d.png -o y_%d.png -f 1
2|link.svg: is read by this render; *|link.svg -y --format png -o link.svg
2|shows/sub/p_1.png: is read by this render; *|shows -y -o shows/sub/p_%d.png
2|gap/a_4.svg: is read by this render; *|gap -y -f 1 --format png -o gap/a_4.svg
2|shows/sub/p_1.png: is read by this render; *|shows -y --flat -o shows/sub/p_%d.png
2|shows/sub/p_1.png: is read by this render; *|shows -y --check -o shows/sub/p_%d.png
2|shows/sub/p_1.png: is read by this render; *|shows -y --styles 01 -o shows/sub/p_1.png
2|clear.png: is read by this render; *|good -y -b clear.png --methods default -o clear.png
2|styled/a.css: is read by this render; *|styled -y --stats styled/a.css -o y_%d.png
2|styled/b.css: is read by this render; *|styled -y --stats styled/b.css -o y_%d.png
2|dumped/red-aa3311/clear.png: is read by this render; *|good -y -b dumped/red-aa3311/clear.png --dump dumped -o y_%d.png
2|page/index.html: is read by this render; *|good -y -c page/index.html --report page -o y_%d.png
2|page/conf.png: is read by this render; *|good -y -c page/conf.png -c page/index.html --flat -f 1 -o page/conf.png
2|x.mp4: maps are PNG files; expected .png|good --check -o x.mp4
1|taken: cannot be written: Not a directory|good -o taken/x_%d.png
1|taken: *|good --report taken -o x_%d.png
1|-x: no such file*|-- -x
1|nowhere: *|nowhere
1|none: no .svg files *|none
1|gap: is a folder; expected one folder or several files|good/a_1.svg gap
2|%q.svg: “%q.s” is no frame number; expected %d, %04d or ####*|good/%q.svg
2|%99999d.svg: *|good/%99999d.svg
2|a_%d_%d.svg: “%d.s” is a second frame number; expected one|good/a_%d_%d.svg
1|good/a_1.svg and good/a_1.svg are both frame 1|good/a_1.svg good/a_1.svg
1|*no file for frames 2-3; use --missing *|gap
1|nosize/a_1.svg: *--canvas, such as 1920x1080*|nosize
1|zero/a_1.svg: *--canvas, *|zero
1|nan/a_1.svg: *|nan
1|negative/a_1.svg: the size of the drawing is negative; set one with --canvas, *|negative
1|pipe.svg: it is a pipe or a device; expected a file|pipe.svg
1|/dev/zero: it is a pipe or a device; expected a file|/dev/zero
1|pipe.png: it is a pipe or a device; expected a file|good -b pipe.png
1|./pipeframe/frames/0002.png: it is a pipe or a device; expected a file|good -s ./pipeframe
1|./pipeini/style.ini: it is a pipe or a device; expected a file|good -s ./pipeini
1|piped/a_1.svg: #i: the image “../piped/p.png” is a pipe or a device *under --strict)|piped --strict
1|sheet/a_1.svg: the style sheet “s.pipe” is a pipe or a device *under --strict)|sheet --strict
1|pipe.conf: nothing was written to it for 1 s; use --limit seconds=N *|good -c pipe.conf --limit seconds=1
1|used/a_1.svg: *“p.pipe#a” is a pipe or a device and is left out *under --strict)|used --strict
1|escape/a_1.svg: #a b: fill refers to “#x y”, which is not *under --strict)|escape --strict
1|unused.conf:1: [region nowhere] matches no region *under --strict)|good -c unused.conf -f 1 --strict
1|unused.conf:1: [region nowhere] matches no region *under --strict)|good -c unused.conf --preview 1 --strict
2|x.mp4: flats are PNG files; expected .png|good --flat -o x.mp4
1|huge/a_1.svg: a picture of 1000000000 x 9 px; at most 32767 px *|huge
1|twice/a_1.svg: not well-formed: line 2: Attribute a redefined|twice
1|nbsp/a_1.svg: not well-formed: line 1: Entity 'nbsp' not defined; *&#160;|nbsp
1|dashes/a_1.svg: not well-formed: line 1: Double hyphen *; take “--” out of the comment|dashes
1|latin/a_1.svg: not well-formed: line 1: the text is not UTF-8; save it as UTF-8, or *|latin
1|film.lottie: is a Lottie animation: fluidy-frames *; see fluidy-exports(7)|film.lottie
1|walk_%d.PNG: is pixels, not shapes: *fluidy-style import*|walk_%d.PNG
1|other/a_2.svg: the root is <svg>, expected <svg xmlns="http://www.w3.org/2000/svg">|other
1|text/a_1.svg: not well-formed: line 1: *|text
1|html/a_1.svg: the root is <html>, expected <svg *|html
1|cut/a_1.svg: not well-formed: line 1: *|cut
1|void.svg: not well-formed: line 1: Document is empty|void.svg
1|deep.svg: not well-formed: line 1: elements are nested deeper than 256 levels; use --limit depth=N to allow more|deep.svg
1|zeros.svg: not well-formed: it begins with zero bytes, *|zeros.svg
1|packed.svg: damaged gzip data|packed.svg
1|binary.svg: not well-formed: *|binary.svg
1|nothing/a_1.svg: there is nothing to paint in the drawing (1 warning under --strict)|nothing --strict
1|broken/a_1.svg: #p: the path is broken at “x v9z” (character 8) *under --strict)|broken --strict
1|lost/a_1.svg: #r: fill refers to “#g”, which is not in the file: *under --strict)|lost --strict
1|circle/a_1.svg: <use> of “#a” shows itself and is left out *under --strict)|circle --strict
1|animated/a_1.svg: #c: the animation in it is not played: *under --strict)|animated --strict --frames-from files
1|rule/a_1.svg: the style rule “@container x” is not known *under --strict)|rule --strict
1|image/a_1.svg: #i: the image “gone.png” does not exist *under --strict)|image --strict
1|prologue.svg: ignored the text before <svg>, which is not XML *under --strict)|prologue.svg --strict
1|./still: one frame is used: its paint does not flow (a warning under --strict)|good --strict -s ./still
1|no style “nowhere” in *|good -s nowhere
1|good/a_1.svg: *expected a style|good -s good/a_1.svg
1|./noframes/frames: no such folder: *|good -s ./noframes
1|./hole/frames/0002.png is missing: expected every number from 1 to 6|good -s ./hole
1|./damaged/frames/0002.png: a damaged PNG picture: *|good -s ./damaged
1|./gif/frames/0002.png: cannot be read as a PNG picture: *|good -s ./gif
1|./odd/frames/0002.png: 7x5 pixels: expected 64x48 as in ./odd/frames/0001.png|good -s ./odd
1|./blank: no paint found: everything looks like the paper, #ffffff; *|good -s ./blank
1|./black: every mask is empty: expected white where the paint is|good -s ./black
1|./few/masks: 1 masks for 6 frames: expected one mask for each frame|good -s ./few
1|./oneflow/flow: 1 flow fields for 6 frames: *|good -s ./oneflow
1|./word/style.ini:2: medium = opaqe: expected *did you mean “opaque”?|good -s ./word
1|./key/style.ini:3: unknown key “nmae”: *did you mean “name”?|good -s ./key
1|./section/style.ini:1: [stile]: expected [style]|good -s ./section
1|./number/style.ini:2: border = -3: expected a number from 0.5 to 1000|good -s ./number
1|./notanumber/style.ini:2: fps = nan: expected a number *|good -s ./notanumber
1|./nonsense/style.ini:1: “hello” is neither “[section]” nor “key = value”|good -s ./nonsense
1|./colour/style.ini:2: paper = #12: expected a colour such as #f4efe6|good -s ./colour
2|hold.conf:2: hold: “0” is not an integer from 1 to 1000|good -c hold.conf
2|mistyped.conf:2: [region] has no key “match-fil”; did you mean “match-fill”?|good -c mistyped.conf
2|colour.conf:2: match-fill: “#12345” is not a colour #RRGGBB|good -c colour.conf
2|width.conf:2: [defaults] has no key “width”; it is for the command line alone|good -c width.conf
2|place.conf:2: [project] has no key “tint”; it belongs to [defaults] or [region NAME]|good -c place.conf
2|open.conf:1: “[defaults” is not a section: “]” must end it|good -c open.conf
2|first.conf:1: “style” is above the first section; *|good -c first.conf
2|regon.conf:1: unknown section [regon a]; sections are *|good -c regon.conf
2|range.conf:2: w-temp: “1e9” is not a number from 0 to 1000|good -c range.conf
2|words.conf:3: “just words” is neither “[section]” nor “key = value”|good -c words.conf
2|tint.conf:2: tint: “blue-ish” is not fill, keep or #RRGGBB|good -c tint.conf
2|version.conf:2: version: “2” is not 1, the only version there is|good -c version.conf
2|double.conf:3: [region a] occurs twice, first in line 1|good -c double.conf
2|latin.conf: the file is not UTF-8 text|good -c latin.conf
1|long.conf: the file is larger than 1 MiB|good -c long.conf
1|short_1.flo: the flow has 12 bytes, expected 18444 for 48x48 pixels|good --flow short_%d.flo
1|small_1.flo: the flow is 8x8 pixels, but the frames are 48x48|good --flow small_%d.flo
1|nan_1.flo: the flow at column 0, row 0 is nan, expected a number *|good --flow nan_%d.flo
1|text_1.flo: not a .flo file: it does not start with PIEH|good --flow text_%d.flo
EOF
}

all=$(find . -type f | sort | grep -vE '^\./(out|err)$')
while IFS='|' read -r status message arguments; do
    # shellcheck disable=SC2086 # arguments are words
    timeout 60 "$program" -s "$style" --progress none $arguments >out 2>err
    found=$?
    # shellcheck disable=SC2053 # the message is a glob
    [ $found = "$status" ] && [ "$(wc -l <err)" = 1 ] && [ ! -s out ] &&
        [[ $(cat err) == "fluidy-svg: "${message//[/\\[} ]] &&
        [ "$all" = "$(find . -type f | sort | grep -vE '^\./(out|err)$')" ]
    result $? "“$arguments” ends with status $status: ${message//#/＃}"
done < <(table)

# Styles that are asked for by a config: no -s wins over it.
for name in style:'no style “nowhere” in ' folder:'../no/where: no such folder: expected a style'; do
    "$program" good -c "${name%%:*}.conf" >out 2>err
    [ $? = 1 ] && says "${name#*:}"
    result $? "a config with a wrong ${name%%:*} is told what is wrong"
done

# What could be a mistake and need not be is a warning, and the picture is made.
"$program" nothing --progress none -s "$style" -o 'n_%d.png' >out 2>err
[ $? = 0 ] && grep -q 'warning: nothing/a_1.svg: there is nothing to paint in the drawing' err && [ -e n_1.png ]
result $? 'a drawing of nothing is a warning'
"$program" good --progress none -s "$style" -b clear.png -o 'c_%d.png' >out 2>err &&
    [ "$(od -An -tu1 -j25 -N1 c_1.png)" = '   6' ]
result $? 'a background that is transparent makes frames that are'

echo "1..$n"
