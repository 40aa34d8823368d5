#!/bin/bash
# The extensions of drawing programs, run as those run them. usage: plugins.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
program=$(realpath "$1")
fixtures=$(realpath "$2")
plugins=$(realpath "${0%/*}/../src/plugins")
tests=$(realpath "${0%/*}")
cd "$folder" || exit 1
mkdir bin && ln -s "$program" bin/fluidy-svg
export PATH="$folder/bin:$PATH" HOME=$folder
export FLUIDY_STYLES=$fixtures/styles PYTHONDONTWRITEBYTECODE=1

# Two frames as layers of a file, as Inkscape saves it.
layer='<g xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" inkscape:groupmode="layer" inkscape:label'
cat >film.svg <<END
<svg xmlns="http://www.w3.org/2000/svg" width="64mm" height="48mm" viewBox="0 0 64 48"
    xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"><!-- kept -->
$layer="1"><circle cx="24" cy="24" r="12" fill="#aa3311"/></g>
$layer="2" style="display:none"><circle cx="30" cy="24" r="12" fill="#aa3311"/></g></svg>
END

paint=$plugins/inkscape/fluidy_paint.py
extension() { # extension ARGUMENT...: as Inkscape calls it
    python3 "$paint" --tab=paint --detail=draft "$@" >out 2>err
}
images() { # images FILE: how many pictures a document has
    grep -o '<image' "$1" | wc -l
}
python3 - "$plugins/inkscape/fluidy_paint.inx" "$paint" >out 2>err <<'END'
import sys
import xml.etree.ElementTree as xml
space = '{http://www.inkscape.org/namespace/inkscape/extension}'
script = open(sys.argv[2]).read()
for param in xml.parse(sys.argv[1]).iter(space + 'param'):
    assert f"'--{param.get('name')}'" in script, param.get('name')
END
result $? 'the script takes what the dialog of Inkscape asks for'
sed -n 's/^name = //p' "$fixtures"/styles/*/style.ini | tr 'A-Z ' 'a-z-' >named
sed -n '/name="style"/,/"other"/s/.*<option value="\([^"]*\)".*/\1/p' "$plugins/inkscape/fluidy_paint.inx" | grep -vx other |
    diff named - >err && sed -n '/^STYLES/,/]/p' "$plugins/blender/fluidy_svg.py" | grep -o "'[^']*'" | tr -d "'" |
    diff named - >>err && sed -n '/^STYLES/,/]/p' "$plugins/krita/fluidy_paint/__init__.py" | grep -o "'[^']*'" | tr -d "'" |
    diff named - >>err
result $? 'the dialogs of Inkscape, Blender and Krita offer the bundled styles'
extension --style=ink --frames=drawing film.svg && cp out once.svg && [ "$(images once.svg)" = 1 ] &&
    grep -q '<!-- kept -->' once.svg && grep -q '<image x="0" y="0" width="64" height="48"' once.svg &&
    extension --style=gouache --frames=drawing once.svg && [ "$(images out)" = 1 ] && grep -q 'painted: gouache' out
result $? 'a drawing gets its painting as a layer, which the next one replaces'
extension --style=ink --frames=layers film.svg && [ "$(images out)" = 2 ]
result $? 'layers that are frames are painted one by one'
extension --style=ink --frames=layers --result=folder --folder="$folder/my frames" film.svg && [ "$(images out)" = 0 ] &&
    [ "$(cd 'my frames' && echo *)" = 'painted_0001.png painted_0002.png' ]
result $? 'or go into a folder'
extension --style=other --other_style=none film.svg
[ $? = 1 ] && [ ! -s out ] && grep -q 'no style “none” in' err
result $? 'what is wrong is shown, and the document stays'
extension --style=ink --program=no-such-program film.svg
[ $? = 1 ] && grep -q 'no-such-program: No such file.* Install fluidy-svg' err
result $? 'a program that is not there is told where to come from'
if ! command -v inkscape >/dev/null || ! command -v xvfb-run >/dev/null; then
    skip 'Inkscape itself paints with it' 'no Inkscape, or no xvfb-run'
else
    mkdir -p profile/extensions && cp "$plugins"/inkscape/* profile/extensions
    INKSCAPE_PROFILE_DIR=$folder/profile timeout 100 xvfb-run -a inkscape --with-gui --batch-process \
        --actions="org.fluidy.paint.noprefs;export-filename:$folder/painted.svg;export-do" film.svg >out 2>err
    [ "$(images painted.svg)" = 1 ] && grep -q 'painted: watercolour' painted.svg
    result $? 'Inkscape itself paints with it'
fi
python3 "$tests/blender_stand_in.py" "$plugins/blender/fluidy_svg.py" >out 2>err
result $? 'the add-on for Blender draws both kinds of Grease Pencil alike'
if ! command -v blender >/dev/null; then
    skip 'Blender paints with its add-on' 'no Blender'
else
    screen=$(command -v xvfb-run) && screen="$screen -a"
    # shellcheck disable=SC2086 # a program and its option, or nothing
    timeout 250 $screen blender -b --factory-startup --python-exit-code 1 --python "$tests/blender.py" -- \
        "$plugins/blender/fluidy_svg.py" "$folder/blender" >out 2>err && grep -q 'the add-on works' out
    result $? 'Blender paints with its add-on, on one page'
fi

# A stand-in for lottie-web: a disc that moves by a pixel a frame, in a layer that is drawn when it is first seen.
cat >player.js <<'END'
window.lottie = {loadAnimation({container, animationData: film}) {
    const add = (parent, name) => parent.appendChild(document.createElementNS("http://www.w3.org/2000/svg", name));
    const svg = add(container, "svg"), renderer = {elements: film.layers.map(data => ({data}))};
    svg.setAttribute("width", film.w);
    svg.setAttribute("height", film.h);
    return {renderer, totalFrames: film.op - film.ip, goToAndStop(frame, isFrame) {
        for (const layer of renderer.elements) {
            layer.baseElement ||= add(svg, "g");
            const disc = layer.baseElement.firstChild || add(layer.baseElement, "circle");
            for (const [name, value] of Object.entries({cx: frame + 12, cy: 16, r: 9, fill: "#aa3311"}))
                disc.setAttribute(name, value);
        }
    }};
}};
END
echo '{"w": 40, "h": 32, "ip": 2, "op": 5, "layers": [{"nm": "#sun & \u003cb>"}]}' >film.json
echo '{"w": 40, "h": 32}' >empty.json
if ! command -v chromium >/dev/null; then
    skip 'a Lottie animation becomes frames' 'no chromium'
else
    frames=$plugins/frames/fluidy-frames
    chmod 755 "$folder"
    timeout 120 "$frames" --player player.js film.json -o lottie >out 2>err && [ ! -s err ] &&
        fluidy-svg lottie --list-regions >out && grep -q '^red.* 3/3 .*sun & <b>$' out &&
        grep -q 'cx="14"' lottie/0003.svg
    result $? 'a Lottie animation becomes frames with the names of its layers'
    timeout 120 "$frames" --player player.js empty.json -o none >out 2>err
    [ $? = 1 ] && grep -q 'empty.json: no frame was drawn: .*' err && [ "$(wc -l <err)" = 1 ]
    result $? 'and one that cannot be played is told'
    mkdir animations && mv film.json animations/ && python3 -m zipfile -c film.lottie animations &&
        timeout 120 "$frames" --player player.js film.lottie -o packed >out 2>err && diff -r lottie packed >out
    result $? 'so does an archive of one'

    # Moved by a timer, by an attribute, by Web Animations, by CSS and by SMIL; and it looks where it should not.
    echo secret >secret.txt && mkdir site && cat >site/page.html <<'END'
<!doctype html><style>@keyframes k { to { transform: rotate(90deg) } } #css { animation: k 1s linear }</style>
<svg viewBox="0 0 100 100" width="200" height="200"><g fill="#a31"><rect id="script" y="1" width="20" height="20"/></g>
<rect id="timer" width="9" height="9"/><rect id="css" width="20" height="20" style="transform-origin: 20px 20px"/>
<circle id="web" cx="20" cy="80" r="9"/><ellipse cy="50" rx="5" ry="9"><animate attributeName="cx" from="50" to="90"
dur="1s"/></ellipse></svg><script src="move.js"></script><script>
const id = (name) => document.getElementById(name);
setInterval(() => id("timer").setAttribute("x", +id("timer").getAttribute("x") + 1), 100);
id("web").animate([{ transform: "none" }, { transform: "translate(40px, 0px)" }], 1000);
for (const place of ["../secret.txt", "file:///etc/passwd", "http://example.org/"])
    fetch(place).then((r) => r.ok && r.text()).then((text) => { if (text) id("web").id = "leak"; }, () => 0);
</script>
END
    echo '(function tick() { document.getElementById("script").setAttribute("x", performance.now() / 20);
        requestAnimationFrame(tick); })()' >site/move.js
    timeout 120 "$frames" site/page.html -o page --fps 8 --seconds 1 >out 2>err && [ "$(ls page | wc -l)" = 8 ] &&
        for moved in 'x="25"' 'x="[45]"' 'matrix(0.707107, 0.707107' 'matrix(1, 0, 0, 1, 20, 0)' 'cx: 70px' '(170, 51, 17)'; do
            grep -q "$moved" page/0005.svg || break
        done && ! grep -q leak page/0008.svg && ! grep -q '<script\|<animate\|@keyframes' page/0005.svg
    result $? 'a page becomes frames, whatever moves it; it sees neither other folders nor a network'
    timeout 120 "$frames" site/page.html -o twice --fps 8 --seconds 1 >out 2>err && diff -r page twice >out
    result $? 'and the same frames again'
fi

echo "1..$n"
