#!/bin/sh
# bench.sh BUILD-DIR [counts]: what a pixel and a line cost in instructions (callgrind counts them, so that the figures are the
# same on a busy machine), tiles read for a picture, time against the reference in double precision and against GDAL, and
# the classifier beside its peers; or the counts alone. At the end: goal, last release and now. Nothing here passes or
# fails.
set -eu
build=${1:?usage: bench.sh BUILD-DIR [counts]}
here=$(dirname "$0")
bench=$build/bin/tests/bench/stage_bench
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM

# "function instructions" of a run, calls included. A function with inlined headers has a line for each file: the
# largest is the whole.
count() { # what stage_bench is to draw
    valgrind --tool=callgrind --callgrind-out-file="$work/out" "$bench" "$1" 1 > "$work/said" 2> "$work/log" || {
        cat "$work/log" >&2
        exit 1
    }
    callgrind_annotate --inclusive=yes --threshold=100 --auto=no "$work/out" |
        sed -nE 's/^ *([0-9,]+) \([ 0-9.]+%\) +[^ ]*:([a-z0-9_]+)( .*)?$/\2 \1/p' | tr -d , |
        awk '$2 > n[$1] { n[$1] = $2 } END { for (f in n) print f, n[f] }'
}

# Rows of a table from such a list; "rest" is what the whole has and its parts have not. The whole is a figure that is
# kept beside that of the last release (tests/figures).
table() { # divisor format figure
    awk -v per="$1" -v format="$2" -v figure="$3" -v figures="$work/figures" '
        function row(name, n) { if (n) printf "  %-44s " format "\n", name, n / per }
        function part(name, n) { parts += n; row(name, n) }
        { n[$1] = $2 }
        END {
            whole = n["lm_sar_draw_line"] + n["lm_sector_draw_line"] + n["lm_sar_start"]
            paint = n["lm_scan_conv_patch"] + n["lm_scan_conv_sector"]
            part("scan_line: cells, terrain", n["lm_scan_line_run"])
            part("illumination: horizon, shadow, slope, edges", n["lm_illuminate"] + n["lm_foreground_line_horizon"])
            part("speckle, noise of a patch", n["lm_grain_powers"] + n["lm_receiver_fade"] + n["lm_grain_floor_run"] + n["lm_patch_floor_run"])
            part("layover", n["lm_layover_run"])
            part("side lobes of the ground", n["lm_side_lobes_find"] + n["lm_side_lobes_add"])
            part("mean over a sample of several azimuths", n["lm_azimuth_average_begin"] + n["lm_azimuth_average_add"] + n["lm_azimuth_average_mean"])
            part("elevation pattern", n["lm_antenna_pattern_apply"])
            part("slant range, levels to power", n["lm_slant_run"])
            part("beam", n["lm_beam_set_taps"] + n["lm_beam_sum"])
            part("receiver: pulse, noise, logarithm", n["lm_receiver_run"])
            part("tone", n["lm_tone_run"])
            row("rest: geometry, tiles asked for, set-up", whole - parts)
            row("paint into the plane", paint)
            row("all", whole + paint)
            printf "%.1f instructions %s\n", (whole + paint) / per, figure >> figures
        }'
}

if command -v valgrind > /dev/null; then
    echo "SAR patch of 256 x 256 cells of 5 m, on a glass of 512 x 512: instructions a pixel"
    count sar > "$work/sar"
    table 65536 '%7.1f' "SAR patch, a pixel" < "$work/sar"
    awk '$1 == "lm_sar_prefetch" { printf "  %-44s %7.1f\n", "and, before it: asking for its tiles", $2 / 65536 }' "$work/sar"
    echo
    echo "The same of cells of 1 m, finer than the map's of 4.8 m"
    count finer > "$work/finer"
    table 65536 '%7.1f' "SAR patch finer than the map, a pixel" < "$work/finer"
    count chips > "$work/chips"
    echo
    echo "Sixteen targets with a signature, 60 x 60 cells of 0.5 m each: instructions a target and patch"
    awk -v figures="$work/figures" '{ n[$1] = $2 } END {
        chip = n["lm_chips_service"] + n["lm_target_patch_shade"] + n["lm_target_patch_add_chips"]
        printf "%.0f instructions target with a signature in a patch\n", chip / 16 >> figures
        printf "  %-44s %9.0f\n", "reading and reducing its chip", n["lm_chips_service"] / 16
        printf "  %-44s %9.0f\n", "shadow", n["lm_target_patch_shade"] / 16
        printf "  %-44s %9.0f\n", "power", n["lm_target_patch_add_chips"] / 16
    }' "$work/chips"
    for mode in gm exp dbs1 dbs2 gmt sea; do
        count $mode > "$work/$mode"
        read -r _ lines _ samples < "$work/said"
        echo
        echo "$mode, 10 nautical miles, on a glass of 512 x 512: instructions a line drawn ($lines lines, $samples sampled)"
        table "$lines" '%7.0f' "$mode, a line" < "$work/$mode"
    done
else
    echo "bench: valgrind is missing (make deps), no instructions counted"
fi
keep() { # those measured, beside their goals and the last release's
    [ ! -s "$work/figures" ] || python3 -B "$here/../figures/figures.py" bench < "$work/figures"
}
[ "${2:-}" != counts ] || { keep; exit 0; }

echo
python3 -B "$here/host.py" "$build" "$work/figures"

echo
echo "Processor time of the patch: ns a pixel, firmware and double-precision reference, five runs"
"$bench" compare 5 | sort -n | awk '
    { firmware[NR] = $1; reference[NR] = $2; ratio[NR] = $3 }
    function sorted(a, n,   i, j, t) {
        for (i = 2; i <= n; i++) for (j = i; j > 1 && a[j] < a[j - 1]; j--) { t = a[j]; a[j] = a[j - 1]; a[j - 1] = t }
    }
    END {
        sorted(reference, NR); sorted(ratio, NR); m = int((NR + 1) / 2)
        printf "  %-16s least %7.2f   median %7.2f\n", "firmware", firmware[1], firmware[m]
        printf "  %-16s least %7.2f   median %7.2f\n", "reference", reference[1], reference[m]
        printf "  %-16s least %7.1f   median %7.1f\n", "times as fast", ratio[1], ratio[m]
    }'

echo
if [ -r build/run/scene.lmdb ] && [ -r build/run/flight.log ]; then
    echo "A flight of a minute over the built-in scene (make run), ground map and patches:"
    "$build"/bin/landmass-sim --db build/run/scene.lmdb --bus build/run/flight.log --script build/run/flight.script \
        --png "$work/png" --every 0 > "$work/sim" 2>&1 || { cat "$work/sim"; exit 1; }
    sed -n 's/^/  /; /frames\|pictures\|tiles:/p' "$work/sim"
    python3 -B "$here/flash.py" "$build"
else
    echo "No build/run/scene.lmdb (make run): no tiles counted"
fi

if [ -x "$build/bin/landmass-dis" ]; then
    python3 -B "$here/dis_delay.py" "$build/bin/landmass-dis"
    "$build/bin/tests/bench/dis_glass" 300
    echo
fi

if [ -x "$build/bin/landmass-ios" ] && [ -r build/run/scene.lmdb ]; then
    python3 -B "$here/ios.py" "$build/bin/landmass-ios" build/run/scene.lmdb
    echo
fi

if [ -r "$here/classifier.sh" ]; then
    echo
    sh "$here/classifier.sh" "$build"
fi

if [ -x "$build/bin/landmass-target" ]; then
    echo
    sh "$here/target.sh" "$build"
fi

if [ -x "$build/bin/landmass-netem" ]; then
    echo
    sh "$here/netem.sh" "$build"
fi

keep
python3 -B "$here/../figures/figures.py" --goals
