#!/bin/bash
# The page of --report in a real browser. usage: report.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
program=$(realpath "$1")
board=$(realpath "$2")/animations/board-game
visit=$(realpath "${0%/*}")/visit_report.py
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
cd "$folder" || exit 1

for i in 1 2 3; do
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='48' height='40'><g id='a&lt;/script&gt;'>
<circle cx='$((16 + 4 * i))' cy='20' r='12' fill='#aa3311'/></g></svg>" >"w_000$i.svg"
done
"$program" w_%04d.svg -s 01 -q -b none -o 'out_%d.png' --report page
result $? 'a render leaves a page'
[ "$(grep -c '^<script>frames.push' page/index.html)" = 3 ]
result $? 'the page has every frame'
! grep -oE '(src|href)="[^"]*"' page/index.html | grep -vE '"(data:[^"]*)?"'
result $? 'the page refers to no other file'
grep -q '"uses":\[$' page/index.html && grep -q '^{"style":"01","picture":"data:image/png' page/index.html && ! grep -q '"painters":\[\[0,' page/index.html
result $? 'the page has energies and the use of the recording'
"$program" w_%04d.svg -s 01 -q -o 'new_%d.png' --report page 2>err
[ $? = 1 ] && grep -q 'page/index.html: already exists; use -y' err && [ ! -e new_1.png ]
result $? 'a page that exists stays, and nothing is painted'

# in which parts of regions rest, whose guides the page has and the paint needs not
board_game() { # board_game NAME OPTION...
    "$program" "$board" -s 01 -W 500 -q --cache off -o "$1_%d.png" "${@:2}"
}
board_game plain && board_game seen --report board-page && same plain_12.png seen_12.png &&
    same plain_13.png seen_13.png && same plain_14.png seen_14.png
result $? 'a page changes nothing in the picture'

"$program" w_%04d.svg -s 01 --format null --report - 2>err
[ $? = 2 ] && grep -q 'expected a folder' err && [ ! -e ./- ]
result $? 'standard output is no folder'

# What a visitor does, run by the page itself; the last line of the page tells how it went.
cat >visitor.js <<'EOF'
const said = [];
const tell = (sentence, good) => said.push((good ? "ok" : "not ok") + " - " + sentence);
const seen = () => byId("view").toDataURL();
const change = (id, value, event) => {
  byId(id).value = value;
  byId(id).dispatchEvent(new Event(event || "change"));
};
const drag = (share) => {
  const stage = byId("stage"), box = byId("view").getBoundingClientRect();
  stage.setPointerCapture = () => {};
  const where = { clientX: box.left + share * box.width, clientY: box.top + 5, buttons: 1 };
  stage.dispatchEvent(new PointerEvent("pointerdown", { ...where, clientX: where.clientX - 9 }));
  stage.dispatchEvent(new PointerEvent("pointermove", where));
};
const differs = (sentence, act, undo) => {
  const before = seen();
  act();
  const between = seen();
  if (undo) undo();
  tell(sentence, between !== before && (!undo || seen() === before));
};
addEventListener("load", () => {
  tell("the contact sheet has every frame", document.querySelectorAll("#sheet button").length === 3);
  tell("every curve is drawn", document.querySelectorAll("#energy path, #change path").length === 2);
  tell("every frame has its bars of time", document.querySelectorAll("#times rect").length === 9);
  tell("there are six guides of each of three frames", document.querySelectorAll("#guides canvas").length === 18);
  tell("the use of the recording is shown", document.querySelectorAll("#uses img").length === 1);
  differs("the frame slider shows another frame", () => change("scrub", "2", "input"));
  tell("and its number", byId("number").textContent === "3");
  differs("on twos the frame before is held", () => { show(1); change("hold", "1"); },
    () => { show(2); change("hold", "2"); });
  change("hold", "1");
  differs("the seam can be dragged", () => drag(0.9), () => drag(0.5));
  differs("the map can be shown", () => change("left", "map"), () => change("left", "before"));
  differs("a region can be switched off and on", () => byId("none").click(), () => byId("all").click());
  const slices = () => byId("slice-after").toDataURL(), row = slices();
  change("axis", "y", "input");
  tell("a slice can be a column", slices() !== row);
  const along = (k) => shown[k].points[0].slice(0, 3).map((v) => v.toFixed(1)).join(" ");
  tell("a slice goes along with the drawing",
    along(0) === "19.5 19.5 0.0" && along(2) === "27.5 19.5 0.0" || along(0) + along(2));
  const still = byId("along-before").toDataURL();
  change("axis", "x", "input");
  tell("its line can be a row", byId("along-before").toDataURL() !== still);
  tell("frames are counted as people do",
    [1, 2, 3, 4, 11, 12, 22, 103].map(ordinal).join() === "1st,2nd,3rd,4th,11th,12th,22nd,103rd");
  change("behind", "white");
  tell("white can lie behind", byId("stage").style.backgroundColor === "white" &&
    !byId("stage").classList.contains("checker"));
  byId("play").click();
  tell("it can play", state.playing && byId("play").textContent === "Pause");
  const lines = document.createElement("pre");
  lines.textContent = said.join("\n");
  document.body.append(lines);
});
EOF
awk '/<\/body>/ { print "<script>"; while ((getline line < "visitor.js") > 0) print line;
    print "</script>" } { print }' page/index.html >page/visited.html

if [ -z "$browser" ]; then
    skip 'a browser shows it without a complaint' 'no chromium'
else
    browse() { # browse PAGE: its DOM to the file dom, complaints to log
        timeout 60 "$browser" --headless --no-sandbox --disable-gpu --enable-logging=stderr \
            --user-data-dir="$folder/profile" --virtual-time-budget=5000 --dump-dom \
            "file://$folder/page/$1" >dom 2>log
        ! grep CONSOLE log
    }
    browse index.html && grep -q '<h1 id="title">w, painted</h1>' dom
    result $? 'a browser shows it without a complaint'
    browse visited.html
    result $? 'a visitor causes no complaint'
    sed -n '/<pre>/,/<\/pre>/p' dom | sed -e 's/<[^>]*>//g' >told
    [ "$(wc -l <told)" -ge 14 ]
    result $? 'the visit runs to its end'
    while read -r line; do
        n=$((n + 1))
        echo "$line" | sed "s/ - / $n - /"
    done < <(sed '$a\' told | grep ok)
    if command -v python3 >/dev/null; then
        timeout 60 python3 -B "$visit" "$browser" page/index.html "$folder/profile" >told
        [ "$(wc -l <told)" = 8 ]
        result $? 'a mouse goes through the page'
        while read -r line; do
            n=$((n + 1))
            echo "$line" | sed "s/ - / $n - /"
        done < <(grep ok told)
    else
        skip 'a mouse goes through the page' 'no python3'
    fi
fi
echo "1..$n"
