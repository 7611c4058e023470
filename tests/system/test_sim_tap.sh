# shellcheck shell=sh
# Sourced by the shell tests, which have set $work to a folder of theirs: results in TAP. Each `check NAME COMMAND...`
# is one test, passed when the command succeeds.
out=${work:?}/stdout
last_error=$work/stderr
tests=0
failures=0

check() {
    statement=$1
    shift
    tests=$((tests + 1))
    if "$@"; then
        echo "ok $tests - $statement"
    else
        failures=$((failures + 1))
        echo "not ok $tests - $statement"
        sed 's/^/# stderr: /' "$last_error"
    fi
}

skip() {
    tests=$((tests + 1))
    echo "ok $tests - $1 # SKIP"
    echo "# skipped: $2"
}

# Succeeds when the command ends with that status: `exits 2 prog --bad`. Its output is kept in $out and $last_error.
exits() {
    wanted=$1
    shift
    "$@" >"$out" 2>"$last_error" </dev/null
    got=$?
    [ $got -eq "$wanted" ] || { echo "# ended with $got, not $wanted: $*"; false; }
}

# Succeeds when what the last command said on standard error, or standard output, matches.
said() {
    grep -qE -e "$1" "$last_error" || { echo "# stderr does not hold: $1"; false; }
}

printed() {
    grep -qE -e "$1" "$out" || { echo "# stdout does not hold: $1"; sed 's/^/# stdout: /' "$out"; false; }
}

finish() {
    echo "1..$tests"
    [ $failures -eq 0 ]
}
