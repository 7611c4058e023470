#!/bin/sh
# figures.sh BUILD-DIR: measure all that has a figure of the last release, and print both.
set -eu
build=${1:?usage: figures.sh BUILD-DIR}
mkdir -p build/figures-log
rm -rf build/figures
for command in size coverage bench-zcu102 bench-m7 bench; do
    echo "figures: $command (build/figures-log/$command)"
    if [ "$command" = bench ]; then
        make --no-print-directory all
        sh tests/bench/bench.sh "$build" counts
    else
        make --no-print-directory "$command"
    fi >"build/figures-log/$command" 2>&1 || echo "figures: make $command failed"
done
python3 -B tests/figures/figures.py
