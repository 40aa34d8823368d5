# Sourced by tests that speak TAP. They run in a folder of their own; what a command said is in the
# files out and err there.
set -u
export LC_ALL=C.UTF-8 OMP_WAIT_POLICY=passive # tests run side by side
folder=$(mktemp -d)
export XDG_CACHE_HOME=$folder/cache # styles that are made larger
export FLUIDY_CACHE=off             # a test that compares renders wants both of them painted
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
n=0

result() { # result STATUS SENTENCE: shows what the last command said after a failure
    n=$((n + 1))
    if [ "$1" = 0 ]; then
        echo "ok $n - $2"
    else
        echo "not ok $n - $2"
        (
            [ -f err ] || cd "$folder" || exit
            for told in out err; do
                [ -f $told ] && tail -30 $told | sed "s/^/# std$told: /"
            done
        )
    fi
}

skip() { # skip SENTENCE REASON
    n=$((n + 1))
    echo "ok $n - $1 # SKIP $2"
}

# bare FILE|FOLDER: the sums of files, without what pictures and films say that they were made from.
bare() {
    local strip='s/fluidy-svg provenance 1 \w{32} \w{32}.{4}//gs; print md5_hex($_), " $ARGV\n"'
    if [ -d "$1" ]; then
        (cd "$1" && find . -type f -print0 | sort -z | xargs -0r perl -MDigest::MD5=md5_hex -0777 -ne "$strip")
    else
        perl -MDigest::MD5=md5_hex -0777 -ne "$strip" <"$1"
    fi
}

# same PATH PATH: two files, or the files of two folders, have the same bytes but for that.
same() {
    [ "$(bare "$1")" = "$(bare "$2")" ]
}
