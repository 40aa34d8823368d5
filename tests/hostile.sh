#!/bin/bash
# Drawings that ask for too much or for what is none of their business.
# usage: hostile.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"

# svg FILE BODY: a drawing of 48 x 48 px.
svg() {
    echo "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'" \
        "width='48' height='48'>$2</svg>" >"$1"
}

slowness=${ASAN_OPTIONS:+6} # as meson's timeouts are multiplied
look() { # look ARGUMENT...: what the drawing x.svg is made of; 20 seconds of the CPU, or $cpu_seconds
    (ulimit -t $((${cpu_seconds:-20} * ${slowness:-1})) &&
        timeout $((120 * ${slowness:-1})) "$program" --list-regions --progress none "$@" x.svg >out 2>err)
}

# limited SENTENCE LIMIT MESSAGE: x.svg is too much for the limit, and not for a larger one
limited() {
    look
    local before=$?
    look --limit "$2=${4:-1}"
    [ $? = 1 ] && [ $before = 0 ] && says "$3" && says "; use --limit $2=N to raise it"
    result $? "$1"
}

shape='<path d="M1 1h30v30h-30z" fill="#aa3311"/>'
mkdir own && cd own || exit 1
svg x.svg "<defs><g id='a'>$shape</g></defs><use href='#a'/><use href='#a' x='9'/>"
limited 'too many elements are an error' elements 'x.svg: 5 elements of a drawing' 4
limited 'copies that <use> makes count as elements' elements 'x.svg: 6 elements of a drawing' 5
svg x.svg "<g><g><g>$shape</g></g></g>"
limited 'too many elements in each other are an error' depth 'x.svg: 4 elements in each other' 3
limited 'path data that is too long is an error' path 'x.svg: 15 characters of a path' 14
head -c 3000000 /dev/zero | tr '\0' ' ' >padding
svg x.svg "$shape$(cat padding)"
limited 'a file that is too large is an error' drawing 'MiB of a drawing'
gzip -9c x.svg >y.svg && mv y.svg x.svg # gzip is found by its first bytes
limited 'so is one that is too large when unpacked' drawing 'MiB of a drawing'
svg x.svg "<defs><path id='a' d='M1 1h30v30h-30z$(head -c 400000 padding)'/></defs>$(printf "<use href='#a'/>%.0s" 1 2 3)"
limited 'so is one that <use> makes too large' drawing 'MiB of a drawing'
timeout 20 ffmpeg -v error -f lavfi -i color=red:s=1200x1000 -frames:v 1 big.png </dev/null 2>err
svg x.svg "$shape<image href='big.png' width='30' height='30'/>"
limited 'an image with too many pixels is an error' image 'x.svg: 1.2 million pixels of an image'
svg x.svg "$shape<image xlink:href='data:image/png;base64,$(base64 -w0 big.png)' width='30' height='30'/>"
limited 'so is one that is embedded' image 'x.svg: 1.2 million pixels of an image'

svg x.svg "$shape"
look -W 2000 --limit frame=3
[ $? = 1 ] && says 'x.svg: 4 million pixels of a frame, more than the limit of 3; use --limit frame=N to raise it'
result $? 'a frame that is too large is an error'
look -W 20000
[ $? = 1 ] && says 'x.svg: 400 million pixels of a frame, more than the limit of 100'
result $? 'the limit of a frame holds without an option'
paint() { # paint ARGUMENT...
    timeout 60 "$program" x.svg -s "$style" -o "${to:-o}/%d.png" --progress none "$@" >out 2>err
}
paint --limit style=1 -s 01
[ $? = 1 ] && says 'million pixels of a style' && says 'use --limit style=N to raise it'
result $? 'a style that is too large is an error'
paint -W 2000 --limit memory=100 --style-by-page off
[ $? = 1 ] && says 'MiB of memory for painting' && says '--limit memory=N' && [ ! -e o ]
result $? 'a render that needs too much memory is refused before it is begun'
svg x.svg "$shape<circle r='9' fill='#2255aa'/>"
paint --limit regions=1
[ $? = 1 ] && says '2 regions that are painted' && [ ! -e o ]
result $? 'too many regions are an error'
paint --limit elements=0
[ $? = 2 ] && says 'limit elements: “0” is not an integer from 1 to 1000000'
result $? 'a limit out of range is told the range'
paint --limit elemnts=9
[ $? = 2 ] && says 'no limit “elemnts”; did you mean “elements”?'
result $? 'a mistyped limit gets a suggestion'

deep() { # deep N: N groups in each other
    printf '<g>%.0s' $(seq "$1")
    echo "$shape"
    printf '</g>%.0s' $(seq "$1")
}
svg x.svg "$(deep 100000)"
look
[ $? = 1 ] && [ "$(wc -l <err)" = 1 ]
result $? '100000 elements in each other are an error'
look --limit depth=1000
[ $? = 1 ] && says 'more than the limit of 1000'
result $? 'and they are one with the limit raised'
svg x.svg "$(deep 900)"
look --limit depth=1000 && grep -q aa3311 out
result $? '900 are drawn with the limit raised'

# ten times ten times ... of a shape; of an entity
body="<g id='u0'>$shape</g>"
for i in 1 2 3 4 5 6 7 8 9; do
    uses=$(printf "<use href='#u$((i - 1))'/>%.0s" 1 2 3 4 5 6 7 8 9 10)
    body="$body<g id='u$i'>$uses</g>"
done
svg x.svg "<defs>$body</defs><use href='#u9'/>"
look
[ $? = 1 ] && says 'more than the limit of 200000; use --limit elements=N to raise it'
result $? 'a billion copies by <use> are an error'
{
    echo '<!DOCTYPE svg [<!ENTITY e0 "lol">'
    for i in 1 2 3 4 5 6 7 8 9; do
        echo "<!ENTITY e$i '$(printf "&e$((i - 1));%.0s" 1 2 3 4 5 6 7 8 9 10)'>"
    done
    echo "]><svg xmlns='http://www.w3.org/2000/svg' width='48' height='48'><text y='9'>&e9;</text>$shape</svg>"
} >x.svg
([ -n "${ASAN_OPTIONS:-}" ] || ulimit -v 2000000 && look)
[ $? -le 1 ] && [ "$(wc -l <err)" -le 1 ]
result $? 'a billion laughs end soon and in little memory'

{
    echo "<!DOCTYPE svg [<!ENTITY e '$(head -c 60000 /dev/zero | tr '\0' x)'>]>"
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='48' height='48'><desc>"
    printf '&e;%.0s' $(seq 15000)
    echo "</desc>$shape</svg>"
} >x.svg
([ -n "${ASAN_OPTIONS:-}" ] || ulimit -v 2000000 && look)
[ $? = 1 ] && says "MiB that a drawing's entities stand for, more than the limit of 1; use --limit entities=N"
result $? 'entities that multiply themselves by being repeated are an error'

# What stopped the libraries below.
svg x.svg "<g opacity='.5'><rect x='-1e5' width='200' height='200'/></g>$shape"
look && grep -q aa3311 out
result $? 'shapes that are parked far off the page in a group with opacity are left out'
svg x.svg "<pattern id='p' width='9' height='9' patternUnits='userSpaceOnUse'><rect x='-1e6' width='1e5'
    height='9'/><rect width='5' height='5'/></pattern><marker id='m'><rect x='-1e6' width='3'
    height='3'/></marker><g opacity='.3'><path d='M9 9h9v9' fill='url(#p)' stroke='red'
    marker-end='url(#m)'/></g>$shape"
look && grep -q aa3311 out
result $? 'so are those in patterns and markers'
for body in "<rect width='30' height='30' fill='#a31' clip-path='url(#c)'/>" "<g clip-path='url(#c)'>$shape</g>" \
    "<g clip-path='url(#c)' opacity='.5'>$shape<circle r='9' fill='#13a'/></g>$shape"; do
    svg x.svg "<clipPath id='c'><path d='M-6000 -6000H40V40H-6000z'/></clipPath>$body"
    look && grep -q aa3311 out || break
done
result $? 'a clip path that reaches far off the page is drawn'
svg x.svg "$shape$(printf "<g data-x='%04000d'/>" {1..3000})"
look && grep -q aa3311 out
result $? 'a drawing of 12 MB is read'
svg x.svg "$(for i in $(seq 8000); do
    echo "<circle cx='$((i % 47))' cy='$((i % 43))' r='2' fill='#a31'/>"
done)$shape"
look && grep -q 8001 out && cpu_seconds=30 look
result $? '8000 shapes are read in a few seconds'
svg x.svg "<mask id='m'><rect width='40' height='30' fill='#fff'/></mask><g mask='url(#m)'>$(
    for i in $(seq 2000); do echo "<circle cx='$((i % 47))' cy='$((i % 43))' r='2' fill='#a31'/>"; done
)</g>"
look && grep -q 1334 out && cpu_seconds=30 look # the others are outside of it
result $? 'and so are 2000 in a group with a mask'
svg x.svg "$(for i in {1..8}; do
    echo "<pattern id='p$i' width='1' height='1' patternContentUnits='objectBoundingBox'>$(
        printf "<rect width='.1' height='.1' transform='rotate(9)' fill='url(#p$((i + 1)))'/>%.0s" {1..10})</pattern>"
done)$shape"
look && grep -q aa3311 out
result $? 'patterns that each show the next one ten times are copied within bounds'
svg x.svg "<filter id='f' color-interpolation-filters='sRGB'><feBlend mode='multiply'
    in2='BackgroundImage'/></filter>$shape<g filter='url(#f)'><circle r='20' fill='#4a9'/></g>"
look && [ ! -s err ] && grep -q 44aa99 out
result $? 'a filter that only blends with the background is a blend mode'
svg x.svg "<filter id='f'><feOffset in='BackgroundImage' dx='9'/></filter>$shape<circle r='20'
    fill='#4a9' filter='url(#f)'/>"
look && says 'BackgroundImage is empty: filters cannot read what is below'
result $? 'to another filter the background is empty, with a warning'
svg x.svg "<filter id='f'><feOffset dy='4'/><feGaussianBlur stdDeviation='2'/><feBlend in='SourceGraphic'/></filter>
    <g filter='url(#f)'>$shape<circle r='20' fill='#4a9'/></g>"
look && says 'a filter or blend mode makes the 2 shapes of a group one picture'
result $? 'a shadow that makes a whole figure one region is told'
{
    for i in $(seq 10000); do printf '[region r%d]\nhold = 2\n' "$i"; done
} >many.conf
cpu_seconds=60 look -c many.conf && grep -q '9980 more sections match no region' err &&
    [ "$(wc -l <err)" -le 24 ]
result $? '10000 sections of a config are read fast and told briefly'
svg x.svg "$(for i in $(seq 400); do
    printf '<rect width="1" height="1" x="%d" y="%d" fill="#%06x"/>' $((i % 48)) $((i / 48)) $((i * 40000))
done)"
(ulimit -n 100 && paint --dry-run && to=few paint -W 48 --limit regions=1000)
result $? '400 regions are painted with 100 open files'
rm -rf o few

# What ends the libraries below, or never ends.
svg x.svg "<style>:lang(x-cn) { }</style><g xml:lang='en'/>$shape"
look
status=$?
if [ $status = 0 ]; then
    skip 'a drawing that crashes librsvg is an error' 'this librsvg does not'
    skip 'and a film goes on without it' 'this librsvg does not'
    skip 'unless all of it does' 'this librsvg does not'
else
    [ $status = 1 ] && says 'x.svg: frame 1: the SVG library crashed while reading it (Aborted)'
    result $? 'a drawing that crashes librsvg is an error'
    mkdir mixed && cp x.svg mixed/m_2.svg && svg mixed/m_1.svg "$shape" && cp mixed/m_1.svg mixed/m_3.svg
    "$program" --list-regions mixed --missing hold >out 2>err && says 'mixed/m_2.svg: left out' &&
        grep -q 'aa3311 *3/3' out && "$program" --list-regions mixed --missing skip >out 2>err &&
        grep -q 'aa3311 *2/2' out
    result $? 'and a film goes on without it'
    rm mixed/m_1.svg mixed/m_3.svg && cp x.svg mixed/m_1.svg && cp x.svg mixed/m_3.svg
    timeout 60 "$program" --list-regions mixed --missing hold >out 2>err
    [ $? = 1 ] && says 'the SVG library crashed while reading it'
    result $? 'unless all of it does'
fi
mkdir torn && svg torn/m_1.svg "$shape" && cp torn/m_1.svg torn/m_3.svg && head -c 60 torn/m_1.svg >torn/m_2.svg
"$program" --list-regions torn --missing hold >out 2>err && says 'torn/m_2.svg: left out' && grep -q 'aa3311 *3/3' out
result $? 'nor does a file that was cut off end a film'
mv torn/m_1.svg torn/m_4.svg && mv torn/m_2.svg torn/m_1.svg && mv torn/m_3.svg torn/m_2.svg && mv torn/m_4.svg torn/m_3.svg
for more in '' --register; do
    "$program" --list-regions torn --missing hold $more >out 2>err && says 'torn/m_1.svg: left out' &&
        grep -q 'aa3311 *3/3' out && "$program" --list-regions torn --missing skip $more >out 2>err && grep -q 'aa3311 *2/2' out
    result $? "not even as the first $more"
done
body="<pattern id='p0' width='1' height='1'><rect width='1' height='1' fill='red'/></pattern>"
for i in 1 2 3 4 5 6 7 8 9; do
    body="$body<pattern id='p$i' width='9' height='9' patternUnits='userSpaceOnUse'>$(
        printf "<rect width='$i' height='9' fill='url(#p$((i - 1)))'/>%.0s" 1 2 3 4 5 6 7 8 9 10
    )</pattern>"
done
svg x.svg "$body<rect width='48' height='48' fill='url(#p9)'/>"
look --limit seconds=1
[ $? = 1 ] && says 'x.svg: frame 1: reading it took longer than 1 s; use --limit seconds=N to allow more'
result $? 'a drawing that takes too long is an error'

# What is read on a small page, and is too much only when it is drawn.
svg x.svg "<filter id='f' x='0' y='0' width='1' height='1'>$(
    printf "<feTurbulence baseFrequency='.0%d' numOctaves='9'/>" 1 2
)</filter><rect width='48' height='48' filter='url(#f)'/>"
large=(--flat -j 1 -W 3000 -o 'o/%d.png' -y --progress none)
flat() { # flat ARGUMENT...: a large picture of x.svg, or of the film mixed/
    timeout 120 "$program" "${large[@]}" "$@" >out 2>err
}
children() { # children SECONDS PID...: of these processes, those that have had so much of the CPU
    local least=$(($(getconf CLK_TCK) * $1))
    shift
    awk -v parents=" $* " -v least="$least" \
        'index(parents, " " $4 " ") && $14 + $15 >= least { print $1 }' /proc/[0-9]*/stat 2>/dev/null | xargs
}
crash_one() { # crash_one ARGUMENT...: flat, and the process that draws gets a signal
    local painter drawing=''
    "$program" "${large[@]}" "$@" >out 2>err &
    painter=$!
    for _ in $(seq 1200); do
        # The processes that start workers, and workers that wait or draw a simple frame, take less time.
        # shellcheck disable=SC2046,SC2086 # lists
        drawing=$(children 1 $(children 0 $painter)) && [ -n "$drawing" ] && break
        sleep 0.1
    done
    # shellcheck disable=SC2086
    [ -n "$drawing" ] && kill -SEGV $drawing
    wait $painter
}
flat --limit seconds=1 x.svg
[ $? = 1 ] && says 'x.svg: frame 1: drawing it took longer than 1 s; use --limit seconds=N to allow more'
result $? 'so is one that takes too long when it is drawn'
crash_one x.svg
[ $? = 1 ] && says 'x.svg: frame 1: the SVG library crashed while drawing it (Segmentation fault)'
result $? 'one that crashes when it is drawn'
if [ -n "${ASAN_OPTIONS:-}" ]; then
    skip 'and one that takes too much memory when it is drawn' 'the sanitizer needs it all'
else
    flat --limit memory=60 x.svg
    [ $? = 1 ] && says 'x.svg: frame 1: drawing it takes more than 60 MiB of memory; use --limit memory=N to allow more'
    result $? 'and one that takes too much memory when it is drawn'
fi
rm -rf mixed && mkdir mixed && cp x.svg mixed/m_1.svg && svg mixed/m_2.svg "$shape" && cp mixed/m_2.svg mixed/m_4.svg
cp x.svg mixed/m_3.svg && rm -rf o
flat --limit seconds=1 --missing hold mixed
[ $? = 1 ] && grep -q 'drawing it took longer than 1 s; use --limit seconds=N to allow more' err && [ ! -e o ]
result $? 'a frame that ran out of time is an error, whatever --missing says'
if [ -n "${ASAN_OPTIONS:-}" ]; then
    skip 'a film holds the frame before those that cannot be drawn, and counts them' 'the sanitizer needs the memory'
else
    flat --limit memory=60 --missing hold mixed && [ "$(ls o | wc -l)" = 4 ] && same o/1.png o/4.png &&
        same o/3.png o/4.png && grep -q '2 frames could not be read or drawn and were replaced' err
    result $? 'a film holds the frame before those that cannot be drawn, and counts them'
fi
rm -rf o mixed/m_3.svg && crash_one --missing skip mixed && [ ! -e o/1.png ] && [ -e o/2.png ] && [ -e o/4.png ] &&
    grep -q 'crashed while drawing it' err &&
    grep -q '1 frame could not be read or drawn and was skipped' err
result $? 'or skips them'

# rest_a_while FOLDER: the film slow/, whose processes all stop for longer than a frame may take.
rest_a_while() {
    local group
    setsid nice "$program" slow --flat -j 1 -W 800 -o "$1/%d.png" -q --limit seconds=2 --missing hold &
    for _ in 1 2; do
        sleep 0.5
        group=$(ps -eo pid=,pgid= | awk -v leader=$! '$2 == leader { print $1 }' | xargs)
        # shellcheck disable=SC2086 # a list
        kill -STOP $group 2>/dev/null && sleep 2.5 && kill -CONT $group 2>/dev/null
    done
    wait $!
}
mkdir slow
for i in 1 2 3; do
    svg slow/s_$i.svg "<filter id='f' x='0' y='0' width='1' height='1'><feTurbulence baseFrequency='.0$i'
        numOctaves='9'/></filter><rect width='48' height='48' filter='url(#f)'/>$shape"
done
"$program" slow --flat -W 800 -o 'awake/%d.png' -q && rest_a_while rested && same awake rested
result $? 'a film that is stopped for a while, at a low priority, is drawn as if it were not'

# What a drawing must not see: the same bytes as if it were not there.
cd ..
mkdir outside
echo "<svg xmlns='http://www.w3.org/2000/svg' width='48' height='48'><rect id='r' width='48' height='48' fill='red'/></svg>" >outside/secret.svg
cp own/big.png outside/secret.png
echo 'path { fill: red !important }' >outside/secret.css
echo secret >outside/secret.txt
cd own || exit 1
ln -s ../outside/secret.png link.png
ln -s ../outside linked

# unseen SENTENCE BODY [WARNING]: paints the same whether outside is there or not
unseen() {
    local warning=${3:-}
    rm -rf with without
    if [[ $2 == '<!DOCTYPE'* ]]; then echo "$2" >x.svg; else svg x.svg "$shape$2"; fi
    to=with paint
    local status=$?
    cp err err1
    mv ../outside ../gone
    to=without paint
    mv ../gone ../outside
    cp err1 err
    [ $status = 0 ] && same with without && [ -e with/1.png ] && grep -qF -- "$warning" err
    result $? "$sentence$1"
}
sentence='a drawing does not see '
unseen 'an image outside its folder' "<image href='../outside/secret.png' width='48' height='48'/>" \
    'the image “../outside/secret.png” is outside the drawing'
unseen 'an image by its whole path' "<image href='$folder/outside/secret.png' width='48' height='48'/>" \
    'is outside the drawing'
unseen 'an image by a file address' "<image href='file://$folder/outside/secret.png' width='48' height='48'/>" \
    'is outside the drawing'
unseen 'an image by a link' "<image href='link.png' width='48' height='48'/>" 'is outside the drawing'
unseen 'an image in a folder that is a link' "<image href='linked/secret.png' width='48' height='48'/>" \
    'is outside the drawing'
unseen 'a drawing as an image' "<image href='../outside/secret.svg' width='48' height='48'/>" \
    'is outside the drawing'
unseen 'what <use> takes from outside' "<use href='../outside/secret.svg#r'/>"
unseen 'what <use> takes from a link' "<use href='linked/secret.svg#r'/>"
unseen 'a style sheet outside' "<style>@import url('../outside/secret.css');</style>"
unseen 'a style sheet by a link' "<style>@import 'linked/secret.css';</style>"
unseen 'an image of a filter' "<filter id='f'><feImage href='../outside/secret.png'/></filter>
    <rect width='48' height='48' filter='url(#f)'/>" 'is outside the drawing'
unseen 'a DTD that is a file' "<!DOCTYPE svg SYSTEM '../outside/secret.txt'>
    <svg xmlns='http://www.w3.org/2000/svg' width='48' height='48'>$shape</svg>"
unseen 'what is no file' "<image href='ftp://127.0.0.1:9/secret.png' width='48' height='48'/>" \
    'is not in a file and is left out: nothing is fetched'
{
    echo "<!DOCTYPE svg [<!ENTITY x SYSTEM '../outside/secret.txt'>]>"
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='48' height='48'>$shape<text y='20'>&x;</text></svg>"
} >x.svg
paint
[ $? = 1 ] && says "Entity 'x' not defined" && ! grep -q secret err
result $? 'an entity that is a file is an error, and the file is not read'

# A server that notes who calls.
/usr/bin/python3 - calls <<'EOF' &
import http.server, sys
class Note(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        open(sys.argv[1], 'a').write(self.path + '\n')
        self.send_error(404)
    def log_message(self, *words):
        pass
server = http.server.HTTPServer(('127.0.0.1', 0), Note)
open('port', 'w').write(str(server.server_port) + '\n')
server.serve_forever()
EOF
server=$!
for _ in $(seq 100); do [ -s port ] || sleep 0.1; done
if [ -s port ]; then
    here=http://127.0.0.1:$(cat port)
    {
        echo "<?xml-stylesheet href='$here/1.css'?>"
        echo "<!DOCTYPE svg SYSTEM '$here/2.dtd' [<!ENTITY % p SYSTEM '$here/3.ent'>%p;]>"
        echo "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xi='http://www.w3.org/2001/XInclude'"
        echo "width='48' height='48'><style>@import url('$here/4.css');"
        echo "@font-face { font-family: f; src: url('$here/5.ttf') }</style>$shape"
        echo "<image href='$here/6.png' width='48' height='48'/><use href='$here/7.svg#r'/>"
        echo "<xi:include href='$here/8.svg'/><rect width='9' height='9' fill='url($here/9.svg#p)'/>"
        echo "<text y='20' font-family='f'>t</text></svg>"
    } >x.svg
    paint
    [ $? = 0 ] && [ ! -e calls ] && (exec 3<>"/dev/tcp/127.0.0.1/$(cat port)" &&
        printf 'GET /own HTTP/1.0\r\n\r\n' >&3 && cat <&3 >/dev/null) && grep -qx /own calls
    result $? 'nothing in a drawing calls a server'
else
    skip 'nothing in a drawing calls a server' 'no server here'
fi
kill $server 2>/dev/null

svg x.svg "$shape<image href='big.png' width='48' height='48'/>"
rm -rf with without
to=with paint && mv big.png gone.png && to=without paint && ! same with without &&
    grep -qF 'the image “big.png” does not exist and is left out' err
result $? 'but it does see one in its folder, and says when it is gone'

echo "1..$n"
