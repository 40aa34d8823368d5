#!/bin/bash
# Paint belongs to the page: the same at every size, from styles that are made larger where that is wanted.
# usage: page.sh PROGRAM FIXTURES TEXTURE; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
texture=$(realpath "$3")
recipe=$(realpath "$2")/watercolour/wet
bundled=$(realpath "$2")/styles
. "${0%/*}/film.sh"
umask 022

mkdir wash page
echo "<svg xmlns='http://www.w3.org/2000/svg' width='100' height='60'>" \
    "<rect x='10' y='5' width='80' height='50' rx='8' fill='#4f7d9f'/></svg>" >wash/a_1.svg
echo "<svg xmlns='http://www.w3.org/2000/svg' width='1000' height='300'>" \
    "<circle cx='60' cy='60' r='40' fill='#4f7d9f'/></svg>" >page/a_1.svg

# size WIDTH ARGUMENT...: of the texture of a wash, in 1/100000 of the page.
size() {
    "$program" wash -s "$bundled/09" --paper none --wash 0 -q -W "$1" -o "wash_$1_%d.png" -y "${@:2}" >out 2>err &&
        "$texture" "wash_$1_1.png" | tr -d .
}
small=$(size 500) large=$(size 1000) pixels=$(size 500 --style-by-page off)
[ $((100 * small)) -gt $((90 * large)) ] && [ $((100 * small)) -lt $((110 * large)) ] &&
    [ $((100 * pixels)) -gt $((130 * large)) ]
result $? "texture has one size on the page: $small and $large; with the pixels' size $pixels"
half=$(size 1000 --style-scale .5)
[ $((100 * half)) -lt $((80 * large)) ]
result $? "--style-scale goes on from there: $half"
rm -rf cache # with the style at twice its size

# page_of FOLDER ARGUMENT...: paints a page for which the style is wanted at twice its size
page_of() {
    timeout 120 "$program" page -s "$recipe" -W 1250 -j 2 -o "$1/w_%d.png" "${@:2}" --progress plain >out 2>err
}
kept() { # what is kept, in order
    (cd cache/fluidy-svg/styles 2>/dev/null && ls -A)
}
page_of dry --dry-run && [ -z "$(kept)" ] && ! grep -q 'simulating' err
result $? 'a dry run makes no style'
page_of first && [[ $(kept) == wet-2x-* ]] && [ "$(grep -c 'simulating its paint at 2 times' err)" = 1 ] &&
    grep -q 'style, frame 3' err
result $? 'a page that is large enough has a style made once, with progress'
page_of second && ! grep -q 'simulating' err && same first/w_1.png second/w_1.png
result $? 'and found again'
rm -r cache
page_of one & page_of two
wait $!
[[ $(kept) == wet-2x-* ]] && same first/w_1.png one/w_1.png && same first/w_1.png two/w_1.png
result $? 'two runs at once make it whole'
rm -r cache && mkdir -p cache/fluidy-svg && : >cache/fluidy-svg/styles
page_of nowhere && grep -q 'but not kept' err && same first/w_1.png nowhere/w_1.png
result $? 'where it cannot be kept it is made all the same'
rm -r cache && mkdir -p cache/fluidy-svg
page_of broken -q
rm cache/fluidy-svg/styles/wet-2x-*/style.ini
page_of mended && grep -q 'simulating' err && same first/w_1.png mended/w_1.png
result $? 'one that is not whole is made anew'
cp -r "$recipe" changed && sed -i 's/^seed = .*//; s/^steps = 12 16/steps = 12 18/' changed/recipe.ini
timeout 120 "$program" page -s ./changed -W 1250 -q -o 'changed/w_%d.png' >out 2>err &&
    [ "$(kept | wc -l)" = 2 ] && ! same first/w_1.png changed/w_1.png
result $? 'another recipe is another style'
cp -r "$recipe" slow && sed -i 's/^frames = .*/frames = 10000/; s/^steps = .*/steps = 100000/' slow/recipe.ini
timeout 60 "$program" page -s ./slow -W 1250 -o 'slow/w_%d.png' >out 2>err && ! grep -q 'simulating' err
result $? 'one that would take hours is not simulated'
timeout 120 "$program" page -s "$style" -W 1500 -o 'own/w_%d.png' >out 2>err &&
    grep -q 'its pictures are enlarged 1.5 times' err
result $? 'a recording without a recipe is enlarged with a warning'
timeout 120 "$program" page -s "$style" -W 1500 --style-by-page off -o 'still/w_%d.png' >out 2>err &&
    ! grep -q 'enlarged' err
result $? 'paint of the size of pixels is not'

echo "1..$n"
