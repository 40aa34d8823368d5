#!/bin/bash
# --watch: frames follow the files that they are painted from. Waits for states, never for a time.
# usage: watch.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
. "${0%/*}/film.sh"
trap 'kill -KILL $job 2>/dev/null; rm -rf "$folder"' EXIT

# until_so COMMAND...: it succeeds within 60 s, while the watch goes on.
until_so() {
    local end=$((SECONDS + 60))
    until "$@"; do
        [ $SECONDS -lt $end ] && kill -0 $job 2>/dev/null || return 1
        sleep 0.05
    done
}

# watch ARGUMENT...: in the background, as process $job.
watch() {
    "$program" film -s "$style" -o 'now/w_%04d.png' --progress none --cache kept --watch "$@" \
        >said 2>told &
    job=$!
}

# waits: everything is painted or told, and nothing is on its way.
waits() {
    tail -n 1 told | grep -q "waiting for a change"
}

# follows: the frames become those of a render from nothing, with nothing beside them.
follows() {
    rm -rf nothing
    paint nothing -c one.conf --cache off && until_so same now nothing && until_so waits
}

errors() {
    [ "$(grep -c 'w_000[0-9].svg: \|w-tmp' told)" = "$1" ]
}

# ends SIGNAL STATUS: the watch does, and leaves nothing but frames.
ends() {
    kill -"$1" $job 2>/dev/null
    wait $job
    [ $? = "$2" ] && [ -z "$(find now -name '.*' -type f)" ]
}

echo >one.conf
watch -c one.conf
paint draft -c one.conf --cache off --detail draft
follows
result $? 'the film is painted, and the watch goes on'
[ "$(grep -c 'painted 6 frames' told)" = 2 ] && ! same draft nothing
result $? 'after drafts, in full'
cp -r now before
drawing film/w_0004.svg 56 1
follows && ! same now before && grep -q 'w_0004.svg has changed' told && grep -q 'from the cache' told
result $? 'an edited frame is painted again, with paint from the cache'
drawing film/w_0007.svg 56 7
follows && [ -e now/w_0007.png ]
result $? 'so is a frame that was added'
printf '[defaults]\nw-temp = 9\n' >one.conf
rm -rf before && cp -r now before
follows && ! same now before
result $? 'and a film whose config was edited'

# Half of a frame stays for longer than it takes to see it, while its writer has it open.
{
    printf "<svg xmlns='http://www.w3.org/2000/svg' width='56' height='56' viewBox='0 0 48 48'>"
    sleep 0.7
    printf "<circle cx='30' cy='24' r='11' fill='#aa3311'/></svg>"
} >film/w_0003.svg
follows && errors 0
result $? 'a frame is not read while it is being written'

printf '<svg' >film/w_0002.svg
until_so errors 1 && until_so waits
result $? 'a broken drawing is one line, and the watch goes on'
drawing film/w_0002.svg 56 6
follows && errors 1
result $? 'until it is mended'
cp -r film again && rm -r film
until_so grep -q 'film: no such file' told && until_so waits
drawing again/w_0002.svg 56 2 && mv again film
follows
result $? 'a folder that was removed is found when it is back'
printf '[defaults]\nw-tmp = 9\n' >one.conf
until_so errors 2 && until_so waits
result $? 'so is a broken config'
printf '[defaults]\nw-temp = 7\n' >one.conf
follows && errors 2
result $? 'until it is mended, too'
ends INT 0
result $? 'SIGINT ends it with status 0, and leaves nothing'

cp -r "$style" own
watch -c one.conf -s "$PWD/own"
wait $job
[ $? = 1 ] && grep -q 'already exists' told
result $? 'frames that exist end it before anything is painted'
watch -c one.conf -s "$PWD/own" -y
follows
grep -v '^title' own/style.ini >edited && mv edited own/style.ini
until_so grep -q 'style.ini has changed' told && until_so waits && kill -0 $job && ends TERM 0
result $? 'a style that was replaced is read again, and SIGTERM ends it as well'
watch -c <(cat one.conf)
wait $job
[ $? = 2 ] && grep -q 'expected a file' told
result $? 'a config from a pipe is refused'

# What the drawings link to lies elsewhere, and so does the background that the config names.
mkdir film/linked ground
cp nothing/w_0001.png film/linked/picture.png
cp nothing/w_0001.png ground/ground.png
printf 'circle { fill: #3355aa }' >film/linked/look.css
{
    echo "<?xml-stylesheet type='text/css' href='linked/look.css'?>" \
        "<svg xmlns='http://www.w3.org/2000/svg' width='56' height='56' viewBox='0 0 48 48'>"
    echo "<circle cx='30' cy='24' r='11'/><image href='linked/picture.png' width='9' height='9'/></svg>"
} >film/w_0003.svg
printf '; a remark\n[project]\nbackground = ground/ground.png\n' >one.conf
rm -rf now kept
watch -c one.conf
follows
result $? 'drawings may link to files'
# touches FILE COMMAND...: the film follows a file that the command writes.
touches() {
    rm -rf before && cp -r now before
    "${@:2}" >"$1"
    follows && ! same now before && grep -qF "${1##*/} has changed" told && errors 0
}
# halves FILE: half of it, and after a while the other.
halves() {
    head -c 60 "$1" && sleep 0.7 && tail -c +61 "$1"
}
touches film/linked/picture.png halves nothing/w_0004.png
result $? 'a picture that a drawing links to is followed, and not read while it is being written'
touches film/linked/look.css echo 'circle { fill: #aa5533 }'
result $? 'so is a style sheet'
touches ground/ground.png cat film/linked/picture.png
result $? 'and the background of the config'
mv film/linked/picture.png picture.png
until_so grep -q 'does not exist' told && follows && ends TERM 0
result $? 'a picture that is gone is told'
watch -c one.conf -y
follows && mv picture.png film/linked && follows && grep -q 'picture.png has changed' told
result $? 'and followed when it comes'
ends TERM 0
drawing film/w_0003.svg 56 3
mkdir maps && cp nothing/w_0001.png maps/m_1.png
printf '[defaults]\nfront = 2\nstain = 1\nmap-front = maps/m_%%d.png\n' >one.conf
rm -rf now kept
watch -c one.conf
follows
touches maps/m_4.png cat nothing/w_0002.png
result $? 'a picture that comes to a control map is followed'
ends TERM 0
echo >one.conf

# Large frames take long enough to be stopped while they are painted, or changed.
for i in 1 2 3 4 5 6 7; do
    drawing film/w_000$i.svg 400 $i
done
# painting: some of the frames in full are written, and not the last.
painting() {
    [ -e now/w_0001.png ] && [ -e now/.w_%04d.png.state ]
}
for signal in INT TERM; do
    rm -rf now kept
    watch -c one.conf
    until_so painting && ends $signal 75 && grep -q 'run again' told
    result $? "SIG$signal while it paints gives status 75, and leaves no state"
done
rm -rf now kept
watch -c one.conf
until_so painting
for i in 1 2 3 4 5 6 7; do
    drawing film/w_000$i.svg 56 $i
done
follows && errors 0
result $? 'a change while it paints starts again'
ends TERM 0

none='a watch without inotify is refused in one line'
if unshare -r bash -c 'echo 0 >/proc/sys/user/max_inotify_instances' 2>/dev/null; then
    unshare -r bash -c 'echo 0 >/proc/sys/user/max_inotify_instances && timeout 60 "$@"' bash \
        "$program" film -s "$style" -o 'none/w_%d.png' --watch 2>err
    [ $? = 1 ] && says 'there is no inotify' && [ ! -e none ]
    result $? "$none"
else
    skip "$none" 'no name spaces'
fi

echo "1..$n"
