#!/bin/sh
# Run every test program given, in TAP form, and add up. Usage: run.sh BUILD-DIR TEST...
# A test program prints "ok N - name", "not ok N - name", or "ok N # SKIP name" (cmocka says "not ok" there too).
# A program that dies, or prints no result at all, counts as one failure.
set -u
o=$1
shift
mkdir -p "$o/test-logs"
passed=0 failed=0 skipped=0
for test in "$@"; do
    name=${test#"$o"/bin/}
    log=$o/test-logs/$(echo "$name" | tr / -).tap
    CMOCKA_MESSAGE_OUTPUT=TAP BUILD=$o timeout -k 5 "${TEST_TIMEOUT:-900}" "$test" >"$log" 2>&1
    status=$?
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
done
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ]
