#!/bin/sh
# What a SAR patch costs without vectors: a Cortex-M7 in QEMU, whose clock counts instructions. Usage: bench.sh BUILD-DIR
set -eu
build=${1:?usage: bench.sh BUILD-DIR}
work=$build/tmp/bench-m7
mkdir -p "$work"
"$build"/bin/tests/bench/stage_bench image "$work/patch.img"
elf=$PWD/$build/bin/tests/cortex-m7/bench.elf
(cd "$work" && timeout -k 2 200 qemu-system-arm -M mps2-an500 -icount shift=0 -display none -monitor none -serial null \
    -semihosting-config enable=on,target=native -kernel "$elf" </dev/null) >"$work/ticks" 2>&1 || {
    cat "$work/ticks" >&2
    exit 1
}
rm -f "$work/patch.img"
# 40 instructions a tick, 65536 cells of a patch, 366 x 366 pixels of it on the glass.
awk -v figures="$work/figures" '
    { cost[$1, $2] = $3 * 40 }
    function figure(value, unit, name) {
        printf "  %-52s %8.1f %s\n", name, value, unit
        printf "%.1f %s %s\n", value, unit, name >figures
    }
    END {
        print "A Cortex-M7 without vectors, a SAR patch of 256 x 256 cells, every effect:"
        drawn = cost["patch", "drawn"]
        figure(drawn / 65536, "instructions", "M7: SAR patch, a pixel")
        figure(cost["finer", "drawn"] / 65536, "instructions", "M7: SAR patch finer than the map, a pixel")
        figure((cost["patch", "painted"] - drawn) / 366 / 366, "instructions", "M7: painting a pixel of the glass")
        figure(100e6 / drawn, "patches", "M7: SAR patches a second at 100 MIPS")
    }' "$work/ticks"
python3 -B tests/figures/figures.py bench-m7 <"$work/figures"
rm -f "$work/figures"
