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
        for told in out err; do
            [ -f "$folder/$told" ] && tail -30 "$folder/$told" | sed "s/^/# std$told: /"
        done
    fi
}

skip() { # skip SENTENCE REASON
    n=$((n + 1))
    echo "ok $n - $1 # SKIP $2"
}
