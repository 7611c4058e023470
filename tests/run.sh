#!/bin/sh
# Run every test program given, in TAP form, and add up. Usage: run.sh BUILD-DIR TEST...
# A test program prints "ok N - name", "not ok N - name", or "ok N # SKIP name" (cmocka says "not ok" there too).
# A program that dies, or prints no result at all, counts as one failure.
# Programs that clang made to count what they run leave that in BUILD-DIR/profiles (make coverage).
# Three lanes on two cores: tests in emulated machines (panel-vm, zcu102) run one after the other beside those of programs,
# sockets and browsers. Both wait much. What only computes waits in a queue, from which a lane of low priority takes what the
# others leave of the cores, and then the lane that is through first. The results of that lane and of the emulated machines
# are printed at the end.
set -u
o=$1
shift
logs=$o/test-logs
mkdir -p "$logs"

# What two outputs of `times` are apart: seconds of a processor that programs took, those that they started among them.
apart() { # BEFORE AFTER
    awk 'FNR == 2 { split($0, t, /[ms ]+/); sum[++files] = t[1] * 60 + t[2] + t[3] * 60 + t[4] }
        END { printf "%.1f\n", sum[2] - sum[1] }' "$1" "$2"
}

run_test() { # PROGRAM
    name=${1#"$o"/bin/}
    log=$logs/$(echo "$name" | tr / -).tap
    times >"$log.before"
    CMOCKA_MESSAGE_OUTPUT=TAP BUILD=$o LLVM_PROFILE_FILE=$o/profiles/$(basename "$log" .tap)-%2m.profraw nice -n "$priority" timeout -k 5 "${TEST_TIMEOUT:-900}" "$1" >"$log" 2>&1 </dev/null
    status=$?
    times >"$log.after"
    apart "$log.before" "$log.after" >"${log%.tap}.seconds" # by which make mutants runs the quick ones first
    rm "$log.before" "$log.after"
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

# The next test of the queue, or nothing.
next_in_queue() {
    flock "$queue.lock" sed -i -e '1w /dev/stdout' -e 1d "$queue"
}

# The tests of standard input, one a line, then those of the queue; the sum goes to a file.
lane() { # FILE PRIORITY
    priority=$2 passed=0 failed=0 skipped=0
    while read -r test; do
        run_test "$test"
    done
    while test=$(next_in_queue) && [ -n "$test" ]; do
        run_test "$test"
    done
    echo "$passed $failed $skipped" >"$1"
}

is_emulated='/bin/tests/(panel-vm|zcu102)/'
only_computes='/bin/tests/(discipline|fuzz|golden|realism|system/test_real|unit/(fixed|firmware|host-sim/(build|image|reference|tracer))/)'
queue=$logs/queue
rm -f "$logs"/lane-*
printf '%s\n' "$@" | grep -E "$only_computes" >"$queue"
printf '%s\n' "$@" | grep -E "$is_emulated" | lane "$logs/lane-emulated" 0 >"$logs/emulated.out" 2>&1 &
lane "$logs/lane-queue" 10 </dev/null >"$logs/queue.out" 2>&1 &
printf '%s\n' "$@" | grep -vE "$is_emulated|$only_computes" | lane "$logs/lane-plain" 0
wait
cat "$logs/queue.out" "$logs/emulated.out"
# A lane that ended without its sum is a failure.
read -r passed failed skipped <<SUM
$(awk '{ passed += $1; failed += $2; skipped += $3 } END { print passed, failed + (NR != 3), skipped }' "$logs"/lane-*)
SUM
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
