#!/bin/bash
# The page of --report in a real browser. usage: report.sh PROGRAM; speaks TAP.
set -u
export LC_ALL=C.UTF-8
program=$(realpath "$1")
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
n=0

report() { # report STATUS SENTENCE
    n=$((n + 1))
    [ "$1" = 0 ] && echo "ok $n - $2" || echo "not ok $n - $2"
}

for i in 1 2 3; do
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='48' height='40'><g id='a&lt;/script&gt;'>
<circle cx='$((16 + 4 * i))' cy='20' r='12' fill='#aa3311'/></g></svg>" >"w_000$i.svg"
done
"$program" w_%04d.svg -s 01 -q -b none -o 'out_%d.png' --report page
report $? 'a render leaves a page'
[ "$(grep -c '^<script>frames.push' page/index.html)" = 3 ]
report $? 'the page has every frame'
! grep -oE '(src|href)="[^"]*"' page/index.html | grep -vE '"(data:[^"]*)?"'
report $? 'the page refers to no other file'
"$program" w_%04d.svg -s 01 -q -o 'new_%d.png' --report page 2>err
[ $? = 1 ] && grep -q 'page/index.html: *exists' err && [ ! -e new_1.png ]
report $? 'a page that exists stays, and nothing is painted'

if [ -z "$browser" ]; then
    n=$((n + 1))
    echo "ok $n - a browser shows it without a complaint # SKIP no chromium"
else
    timeout 60 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" \
        --enable-logging=stderr --virtual-time-budget=5000 --dump-dom \
        "file://$folder/page/index.html" >dom 2>log
    ! grep CONSOLE log && grep -q '<h1 id="title">w, painted</h1>' dom &&
        [ "$(grep -o '<small>' dom | wc -l)" = 3 ] && grep -q '<path d="M' dom
    report $? 'a browser shows it without a complaint'
fi
echo "1..$n"
