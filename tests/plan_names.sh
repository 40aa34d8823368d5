#!/bin/bash
# Plans for farms, films and plug-ins whose files have hostile names: stand-ins record what is executed.
# usage: plan_names.sh PROGRAM FIXTURES; speaks TAP.
# shellcheck source-path=SCRIPTDIR source=film.sh
plugin=$(realpath "${0%/*}/../src/plugins/inkscape/fluidy_paint.py")
. "${0%/*}/film.sh"

# Each of these would run `pwn` if a name became a part of a program. Four of them make a name, after heads by turns: each
# word that a command gets is compared as a whole. What a dialect may refuse is in names of its
# own: braces, control characters and bytes that are no text.
plain=(
    ';pwn;' '|pwn|' '&pwn&' '$(pwn)' '`pwn`' "'\$(pwn)'" '"$(pwn)"' "';pwn;'" '";pwn;"' "\\';pwn;\\'"
    '|;e pwn #' '|e pwn' '${x:=$(pwn)}' '<(pwn)' ' -e pwn' '%x%(pwn)%%n' '#!pwn' ' --wrap=pwn ' '*?[a-z]{pwn,pwn}'
    '~pwn!pwn' '$IFS$(pwn)')
braces=('{{Param.Folder}}' '{{Task.Param.Regions}}' '}}{{Session.WorkingDirectory}}')
control=(
    $'\npwn\n' $'\nTASKS\npwn\n' $'\nTASKS\n)\npwn\n' $'\nMERGE\npwn\n' $'\nMERGE\n)\npwn\n' $')\npwn\n('
    $'\r\npwn\r\n' $'\e]0;pwn\a' $'\\\npwn\n' $'\t;pwn\n#SBATCH --wrap=pwn\n')
heads=("a" "it's" '-"')
names=()

# chain ENDING...: adds names of four endings, and of what is left
chain() {
    local name='' k=0 ending
    for ending; do
        name+=${heads[k % 3]}$ending k=$((k + 1))
        [ $((k % 4)) = 0 ] || [ $k = $# ] || continue
        names+=("$name") name=''
    done
}
chain "${plain[@]}"
chain "${braces[@]}"
chain "${control[@]}"
chain $'\xff;pwn'

mkdir bin hostile
cat >bin/fluidy-svg <<'END'
#!/bin/bash
printf '%s\0' "$PWD" "$@" end >>"$RECORD"
echo painted
END
cat >bin/sbatch <<'END'
#!/bin/bash
set -o pipefail
cat >script
last=0
for word; do
    case $word in --array=0-*) last=${word#--array=0-} ;; esac
done
for ((task = 0; task <= last; task++)); do
    SLURM_ARRAY_TASK_ID=$task SLURM_JOB_ID=7 bash script 2>&1 | cat >>log || exit 1
done
echo 7
END
printf '#!/bin/sh\ntouch "$PWNED"\n' >bin/pwn
cat >bin/ffmpeg <<'END' # it writes what it is fed, or says what it was to read
#!/bin/bash
case " $* " in *' -nostdin '*) echo "${*//$'\n'/ }" >&2 && exit 1 ;; esac
exec cat >&3
END
chmod +x bin/*
export PWNED=$PWD/pwned RECORD=
drawing 1.svg 24 1
drawing 2.svg 24 2

# plan DIALECT: the folders, the drawings and the pictures have the hostile name.
plan() {
    (cd "$place" && PATH=$OLDPWD/bin:$PATH && exec -a fluidy-svg "$program" "./$name" -s "$style" -q --plan "$1" \
        -o "./${name//%/%%}/%d.png")
}

# What a library for Open Job Description does: double braces are references, all else stands for itself.
cat >run.py <<'END'
import json, os, re, subprocess, sys

def run(words, folder, record):
    subprocess.run(words, cwd=folder, env=dict(os.environ, RECORD=os.path.abspath(record)), check=True, stdout=subprocess.DEVNULL)

def resolve(text, known):
    assert not re.search("[\0-\x1f\x7f-\x9f]", text)
    text = re.sub(r"\{\{ *([\w.]+) *\}\}", lambda reference: known[reference[1]].replace("{", "\0").replace("}", "\1"), text)
    assert "{{" not in text and "}}" not in text
    return text.replace("\0", "{").replace("\1", "}")

def run_openjd(job, record):
    known = {"Param." + each["name"]: each["default"] for each in job["parameterDefinitions"]}
    assert [each["type"] for each in job["parameterDefinitions"]] == ["PATH"]
    resolve(job["name"], known)
    for step in job["steps"]:
        [parameter] = step["parameterSpace"]["taskParameterDefinitions"]
        for value in parameter["range"]:
            known["Task.Param." + parameter["name"]] = resolve(value, known)
            action = step["script"]["actions"]["onRun"]
            run([resolve(word, known) for word in [action["command"], *action["args"]]], "/", record)

def calls(record):
    words = open(record, "rb").read().decode(errors="surrogateescape").split("\0")[:-1]
    found = []
    while words:
        end = words.index("end")
        call, words = words[:end], words[end + 1:]
        found.append(call[:-2] if call[-2:] == ["--progress", "plain"] else call)
    return found

name, *dialects = sys.argv[1:]
for dialect in dialects:
    plan = json.load(open(dialect + ".json"))
    if dialect == "openjd":
        run_openjd(plan, "openjd.record")
    else:
        for task in plan["tasks"] + plan["merge"] + plan["film"]:
            run(task["command"], plan["folder"], "json.record")
    got, wanted = calls(dialect + ".record"), calls("slurm.record")
    assert got == wanted, (got, wanted)
    assert len(got) == 3 and all("./" + name in call and call[0].endswith("/" + name) for call in got)
END

# film: a film, a sheet of paper and the folder of a plug-in have the hostile name.
film() {
    local here=$PWD place=$PWD/$place
    cd "$place" && printf '\xff\xd8\xff' >"$name.jpg" || return 1
    PATH=$here/bin:$PATH "$program" "./$name" -s "$style" -q -y -W 24 --no-frames -o "./$name.mov" --cache off 2>"$here/err" &&
        [ -s "./$name.mov" ] || is_wrong film
    PATH=$here/bin:$PATH "$program" "./$name" -s "$style" -q -y -W 24 --paper "./$name.jpg" -o ./p%d.png --cache off 2>"$here/err"
    grep -q 'file:.*\.jpg' "$here/err" || is_wrong paper
    HOME=$here RECORD=$here/plugin.record PATH=$here/bin:$PATH python3 -B "$plugin" --style=ink --result=folder \
        --folder="$place/$name" --frames=drawing "$here/1.svg" >"$here/out" 2>"$here/err"
    grep -zqF -- "${place//%/%%}/${name//%/%%}/painted_%04d.png" "$here/plugin.record" || is_wrong plug-in
    cd "$here" || exit 1
}

is_wrong() { # is_wrong DIALECT
    wrong=$((wrong + 1))
    echo "# wrong in $1: $(printf %q "$name"): $(tail -1 "$folder/err")"
}

executed=0 wrong=0 refused=0
for name in "${names[@]}"; do
    place=hostile/$name
    mkdir -p "$place/$name"
    cp 1.svg "$place/$name/${name}_1.svg" && cp 2.svg "$place/$name/${name}_2.svg"
    RECORD=$PWD/slurm.record
    rm -f ./*.record log
    plan slurm >plan.sh 2>err && PATH=$PWD/bin:$PATH bash plan.sh >out 2>>err </dev/null &&
        [ "$(tr '\0' '\n' <slurm.record | grep -c '^end$')" = 3 ] &&
        [ "$(wc -l <"$place/log")" = 3 ] || is_wrong slurm
    planned=()
    for dialect in json openjd; do
        if plan $dialect >$dialect.json 2>err; then
            planned+=($dialect)
        else
            says 'cannot hold this name' && refused=$((refused + 1)) || is_wrong $dialect
        fi
    done
    if [ ${#planned[@]} -gt 0 ] && command -v python3 >/dev/null; then
        RECORD='' PATH=$PWD/bin:$PATH python3 run.py "$name" "${planned[@]}" >out 2>err ||
            is_wrong "${planned[*]}"
    fi
    film
    if [ -e pwned ]; then
        executed=$((executed + 1))
        echo "# executed: $(printf %q "$name")"
        rm pwned
    fi
done
[ ${#names[@]} = 11 ] && [ $executed = 0 ]
result $? "none of ${#names[@]} hostile names is executed by a plan, a film or a plug-in, $executed are"
[ $wrong = 0 ]
result $? "each command gets the names as they are, or the plan is refused ($refused), $wrong are wrong"

echo "1..$n"
