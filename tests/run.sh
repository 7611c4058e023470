#!/bin/sh
# Run every test program given, in TAP form, and add up. Usage: run.sh BUILD-DIR TEST...
# A test program prints "ok N - name", "not ok N - name", or "ok N # SKIP name" (cmocka says "not ok" there too).
# A program that dies, or prints no result at all, counts as one failure.
# Programs that clang made to count what they run leave that in BUILD-DIR/profiles (make coverage).
# Tests in emulated machines (panel-vm, zcu102) run beside the others, one after the other as those; their results are
# printed at the end.
set -u
o=$1
shift
logs=$o/test-logs
mkdir -p "$logs"

run_test() { # PROGRAM
    name=${1#"$o"/bin/}
    log=$logs/$(echo "$name" | tr / -).tap
    started=$(date +%s)
    CMOCKA_MESSAGE_OUTPUT=TAP BUILD=$o LLVM_PROFILE_FILE=$o/profiles/$(basename "$log" .tap)-%2m.profraw timeout -k 5 "${TEST_TIMEOUT:-900}" "$1" >"$log" 2>&1 </dev/null
    status=$?
    echo $(($(date +%s) - started)) >"${log%.tap}.seconds" # by which make mutants runs the quick ones first
    s=$(grep -cE '^(not )?ok .*# SKIP' "$log")
    p=$(grep -E '^ok ' "$log" | grep -vc '# SKIP')
    f=$(grep -E '^not ok ' "$log" | grep -vc '# SKIP')
    if [ $status -ne 0 ] && [ "$f" -eq 0 ]; then f=1; echo "not ok - $name ended with status $status" >>"$log"; fi
    if [ $((p + f + s)) -eq 0 ]; then f=1; echo "not ok - $name printed no result" >>"$log"; fi
    printf '%-48s %3d passed' "$name" "$p"
    [ "$f" -eq 0 ] || printf ', %d FAILED' "$f"
    [ "$s" -eq 0 ] || printf ', %d skipped' "$s"
    printf '\n'
    [ "$s" -eq 0 ] || sed -n 's/^# skipped: /    skipped: /p' "$log"
    [ "$f" -eq 0 ] || { sed 's/^/    /' "$log" | tail -n 60; }
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
}

# The tests of standard input, one a line; their sum goes to a file.
lane() { # FILE
    passed=0 failed=0 skipped=0
    while read -r test; do
        run_test "$test"
    done
    echo "$passed $failed $skipped" >"$1"
}

is_emulated='/bin/tests/(panel-vm|zcu102)/'
rm -f "$logs"/lane-*
printf '%s\n' "$@" | grep -E "$is_emulated" | lane "$logs/lane-emulated" >"$logs/emulated.out" 2>&1 &
printf '%s\n' "$@" | grep -vE "$is_emulated" | lane "$logs/lane-plain"
wait
cat "$logs/emulated.out"
read -r passed failed skipped <"$logs/lane-plain"
read -r p f s <"$logs/lane-emulated"
passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ]
