#!/bin/sh
# stages.sh WORD LIBRARY NM FUNCTION...: WORD and the name, a line for each function that the library has, behind the
# instrument's own (stage 0), by which it knows what it costs itself.
set -eu
word=$1
library=$2
nm=$3
shift 3
if [ $# -gt 79 ]; then
    echo "stages.sh: $# functions, and the instrument has room for 79 (INSTRUMENT_STAGES_MAX)" >&2
    exit 1
fi
has=$("$nm" --defined-only "$library" 2>/dev/null | awk '$2 == "T" { print $3 }')
echo "${word}instrument_nothing"
for name in "$@"; do
    if echo "$has" | grep -qx "$name"; then
        echo "$word$name"
    fi
done
