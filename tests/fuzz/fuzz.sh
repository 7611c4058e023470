#!/bin/sh
# Fuzz every target with clang's libFuzzer, one after another. Usage: fuzz.sh [SECONDS [TARGET...]]
# SECONDS for each target (60). New inputs are kept in build/fuzz/corpus, whatever breaks a target in build/fuzz/findings. The
# inputs that were tried without a finding are noted in build/fuzz/counts: count.sh adds them up.
# Ends with status 1 when something was found.
set -u
seconds=${1:-60}
[ $# -eq 0 ] || shift
o=build/fuzz
make --no-print-directory -j2 CC=clang FUZZER=1 O=$o fuzz-programs || exit 1
mkdir -p $o/findings $o/logs
targets=${*:-$(ls $o/bin/fuzz)}
failed=0
all=0
for target in $targets; do
    mkdir -p "$o/corpus/$target"
    if "$o/bin/fuzz/$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
        -artifact_prefix="$o/findings/$target-" "$o/corpus/$target" "tests/fuzz/corpus/$target" >"$o/logs/$target" 2>&1
    then
        runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$o/logs/$target")
        cover=$(sed -n 's/.* cov: \([0-9]*\).*/\1/p' "$o/logs/$target" | tail -n 1)
        all=$((all + runs))
        echo "$target $runs" >>$o/counts
        echo "$target: no finding in $runs runs, $cover edges covered"
    else
        failed=1
        echo "$target: FOUND SOMETHING, see $o/logs/$target and $o/findings"
    fi
done
echo "$all inputs without a finding"
exit $failed
