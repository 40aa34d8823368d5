# Sourced by tests that paint a tiny film: PROGRAM and FIXTURES are the first two arguments.
# Makes and enters a folder with film/ (six drawings), big/ (larger ones) and bad/.
# shellcheck source-path=SCRIPTDIR source=tap.sh
. "${0%/*}/tap.sh"
program=$(realpath "$1")
style=$(realpath "$2")/style-small
cd "$folder" || exit 1

# drawing NAME SIDE FRAME: a disc that moves over a square.
drawing() {
    echo "<svg xmlns='http://www.w3.org/2000/svg' width='$2' height='$2' viewBox='0 0 48 48'>" \
        "<rect x='4' y='6' width='24' height='30' fill='#2255aa'/>" \
        "<circle cx='$((18 + 3 * $3))' cy='24' r='11' fill='#aa3311'/></svg>" >"$1"
}

mkdir film
for i in 1 2 3 4 5 6; do
    drawing film/w_000$i.svg 56 $i
done

# flow FILE BYTES: the same displacement of 8 bytes everywhere in a frame of 56 x 56 px.
flow() {
    local row='' x
    for ((x = 0; x < 56; x++)); do
        row+=$2
    done
    printf 'PIEH\x38\0\0\0\x38\0\0\0' >"$1"
    for ((x = 0; x < 56; x++)); do
        # shellcheck disable=SC2059 # the escapes are the point
        printf "$row" >>"$1"
    done
}

# paint FOLDER ARGUMENT...: paints the film, or that of $film, into the folder; the status is the
# program's.
paint() {
    local to=$1
    shift
    timeout 120 "$program" "${film:-film}" -s "$style" -o "$to/w_%04d.png" --progress none "$@" >out 2>err
}

# says TEXT: standard error is one line, which has the text.
says() {
    [ "$(wc -l <err)" = 1 ] && grep -qF -- "$1" err
}
