#!/bin/sh
# Inputs that the campaigns of make fuzz have tried without a finding, by target: those of tests/fuzz/counted.txt, which is
# kept with the sources, and those of build/fuzz/counts, which fuzz.sh has written here.
# Usage: count.sh [--keep] TARGET...
#   --keep   put the sums into counted.txt and empty build/fuzz/counts
set -u
kept=tests/fuzz/counted.txt
here=build/fuzz/counts
is_kept=false
if [ "${1:-}" = --keep ]; then
    is_kept=true
    shift
fi
[ -e $here ] || mkdir -p build/fuzz && touch $here || exit 1

sums=$(for target in "$@"; do
    awk -v target="$target" '$1 == target { n += $2 } END { printf "%s %.0f\n", target, n }' $kept $here
done)
if $is_kept; then
    { sed -n '/^#/p' $kept && echo "$sums"; } >$kept.new && mv $kept.new $kept && rm $here || exit 1
fi
echo "$sums" | awk '
    { printf "%-14s %13.0f %s\n", $1, $2, ($2 >= 1e7 ? "" : sprintf("%5.1f %% of 10,000,000", $2 / 1e5))
      all += $2; enough += $2 >= 1e7 }
    END { printf "%.0f inputs in all, %.1f %% of 1,000,000,000; %d of %d targets have 10,000,000\n", all, all / 1e7, enough, NR }'
