#!/bin/sh
# Drawn faults in flight: each ends in a state that docs/faults.md names, and leaves it.
# Usage: test_faults [RUNS [SEED]], 400 and 1 unless said.
set -u
build=${BUILD:-build/bench-linux}
table=$(mktemp)
trap 'rm -f "$table"' EXIT

if "$build/bin/tests/faults/campaign" "${1:-400}" "${2:-1}" >"$table" 2>"$table.err"; then
    echo "ok 1 - every run ends in a state that it may have, and is well again"
else
    echo "not ok 1 - every run ends in a state that it may have, and is well again"
    head -n 20 "$table.err" | sed 's/^/# /'
fi
rm -f "$table.err"

# Words and pictures of each row must be among those that the document has for this fault.
if awk -F ' *[|] *' '
    NF != 8 || $7 !~ /^[0-9]+$/ { next }
    NR == FNR { told[$2] = $3 " " $4; next }
    !($2 in told) { print "# no row for " $2; wrong = 1; next }
    {
        rows++
        n = split($3 ", " $4, part, ", ")
        for (i = 1; i <= n; i++)
            if (part[i] != "" && index(told[$2], part[i]) == 0) { print "# " $2 ": " part[i]; wrong = 1 }
    }
    END { exit wrong || rows < 30 }' docs/faults.md "$table"; then
    echo "ok 2 - docs/faults.md has all that they did"
else
    echo "not ok 2 - docs/faults.md has all that they did"
fi
echo 1..2
