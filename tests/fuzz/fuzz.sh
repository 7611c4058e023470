#!/bin/sh
# Fuzz the targets with clang's libFuzzer, one on each processor at a time. Usage:
#   fuzz.sh [--until COUNT] [SECONDS [TARGET...]]
#     SECONDS        for each target (60; 0: no limit)
#     --until COUNT  leave each target once it has tried COUNT inputs, those of earlier campaigns counted; SECONDS is then 0
# JOBS=N in the environment: N targets at a time. Those that have tried least begin.
#
# A target runs in stretches. An eighth of the time goes to a program that tells libFuzzer of each comparison
# (build/fuzz/comparisons), the rest to one that tells it of branches alone, which is several times as fast
# (build/fuzz/branches). New inputs are kept in build/fuzz/corpus, whatever breaks a target in build/fuzz/findings. The new
# inputs that each stretch tried without a finding are noted in build/fuzz/counts: count.sh adds them up. When interrupted,
# the stretches under way are noted too.
# Ends with status 1 when something was found.
set -u
stretch=300
o=build/fuzz
count=0
seconds=60
if [ "${1:-}" = --until ]; then
    count=$2
    seconds=0
    shift 2
fi
if [ $# -gt 0 ]; then
    seconds=$1
    shift
fi
jobs=${JOBS:-$(nproc)}

programs() { # FUZZER FOLDER TARGET...: build them
    kind=$1 folder=$2
    shift 2
    # shellcheck disable=SC2046 # a list of names
    make --no-print-directory -j2 CC=clang FUZZER="$kind" O="$folder" \
        $(for name in "$@"; do echo "$folder/bin/fuzz/$name"; done) \
        $([ $# -gt 0 ] || echo fuzz-programs)
}

tried() { # TARGET: what it has tried in all campaigns
    awk -v target="$1" '$1 == target { n += $2 } END { printf "%.0f\n", n }' tests/fuzz/counted.txt $o/counts
}

lacks() { # TARGET: what it lacks of the count; -1 without one
    if [ "$count" -eq 0 ]; then
        echo -1
    else
        n=$(tried "$1")
        echo $((n < count ? count - n : 0))
    fi
}

# One stretch: TARGET PROGRAM SECONDS RUNS, of which -1 is no limit. The status is libFuzzer's; 72 is an interruption.
run() {
    entropic=1
    [ "$1" != unit ] || entropic=0 # it has so many branches that to weigh them takes longer than to fly
    most=-1
    # libFuzzer counts the inputs that it begins with, too
    [ "$4" -lt 0 ] || most=$(($4 + 100 + $(find "$o/corpus/$1" "tests/fuzz/corpus/$1" -type f | wc -l)))
    "$2" -max_total_time="$3" -runs="$most" -timeout=20 -rss_limit_mb=2048 -reload=0 -entropic=$entropic -print_final_stats=1 \
        -artifact_prefix="$o/findings/$1-" "$o/corpus/$1" "tests/fuzz/corpus/$1" >"$o/logs/$1" 2>&1 &
    fuzzer=$!
    wait $fuzzer
    status=$?
    if $stopped; then # the signal ended the wait, not the fuzzer
        wait $fuzzer
        status=$?
    fi
    # Inputs that were kept from earlier, up to INITED, are no new ones.
    new=$(awk '/INITED/ && !old { sub(/^#/, "", $1); old = $1 + 0 } /^stat::number_of_executed_units:/ { all = $2 }
        END { print (all > old ? all - old : 0) }' "$o/logs/$1")
    if [ $status -eq 0 ] || [ $status -eq 72 ]; then
        echo "$1 $new" >>$o/counts
        runs=$((runs + new))
    fi
    return $status
}

fuzz() { # TARGET: until its time is over or its count reached
    runs=0
    status=0
    begin=$(date +%s)
    mkdir -p "$o/corpus/$1"
    while ! $stopped; do
        spent=$(($(date +%s) - begin))
        long=$stretch
        [ "$seconds" -eq 0 ] || [ $((seconds - spent)) -ge $stretch ] || long=$((seconds - spent))
        wanted=$(lacks "$1")
        if [ $long -le 0 ] || [ "$wanted" -eq 0 ]; then
            break
        fi
        run "$1" $o/comparisons/bin/fuzz/"$1" $(((long + 7) / 8)) "$wanted" || [ $? -eq 72 ] || break
        ! $stopped || break
        wanted=$(lacks "$1")
        long=$((long * 7 / 8))
        [ "$wanted" -eq 0 ] || [ $long -eq 0 ] || run "$1" $o/branches/bin/fuzz/"$1" $long "$wanted" || [ $? -eq 72 ] || break
    done
    if [ "$status" -ne 0 ] && [ "$status" -ne 72 ]; then
        echo "$1" >>$o/failed
        echo "$1: FOUND SOMETHING, see $o/logs/$1 and $o/findings"
        return
    fi
    spent=$(($(date +%s) - begin))
    cover=$(sed -n 's/.* cov: \([0-9]*\).*/\1/p' "$o/logs/$1" 2>/dev/null | tail -n 1)
    echo "$1: no finding in $runs runs, ${cover:-0} edges covered, $((runs / (spent > 0 ? spent : 1))) a second"
    echo "$runs" >>$o/all
}

# Take targets that no other worker has taken, until none is left.
work() {
    stopped=false
    fuzzer=
    trap 'stopped=true; [ -z "$fuzzer" ] || kill -TERM $fuzzer 2>/dev/null' TERM
    for target in $targets; do
        $stopped || ! mkdir "$o/taken/$target" 2>/dev/null || fuzz "$target"
    done
}

programs 1 $o/branches "$@" && programs compare $o/comparisons "$@" || exit 1
rm -rf $o/taken $o/failed $o/all
mkdir -p $o/findings $o/logs $o/taken
touch $o/counts $o/all
# shellcheck disable=SC2046 # a list of names
[ $# -gt 0 ] || set -- $(ls $o/branches/bin/fuzz)
targets=$(for target in "$@"; do
    n=$(tried "$target")
    [ "$count" -gt 0 ] && [ "$n" -ge "$count" ] || echo "$n $target"
done | sort -n | sed 's/.* //')
workers=
while [ "$jobs" -gt 0 ]; do
    work &
    workers="$workers $!"
    jobs=$((jobs - 1))
done
trap 'kill -TERM $workers 2>/dev/null' INT TERM HUP
# shellcheck disable=SC2086 # a list of numbers
until wait $workers; do
    # A signal ends the wait; the workers note their counts meanwhile.
    for worker in $workers; do
        wait "$worker"
    done
done
awk '{ n += $1 } END { printf "%.0f inputs without a finding\n", n }' $o/all
[ ! -e $o/failed ]
