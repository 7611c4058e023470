#!/bin/sh
# target.sh BUILD-DIR: rays of landmass-target a second, beside bare Embree and beside POV-Ray (the engine of RaySAR), on the
# same model and the same picture; and what one chip costs. Nothing here passes or fails.
set -eu
build=${1:?usage: target.sh BUILD-DIR}
target=$build/bin/landmass-target
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM
azimuth=20 depression=15 rays=4

value() { # name, of the file "ours"
    awk -v name="$1" '$1 == name { print $2 }' "$work/ours"
}

# The model on a plane, as a scene of POV-Ray: parallel rays from the same plane, a light at the radar, mirrors that are
# followed for five reflections. POV-Ray's axes are left-handed: its picture is ours in a mirror, and as much work.
pov_scene() {
    awk -v azimuth=$azimuth -v depression=$depression -v plane="$(awk '$1 == "plane_m" { print $2, $3, $4 }' "$work/ours")" '
        function vector(x, y, z) { return sprintf("<%.9g,%.9g,%.9g>", x, y, z) }
        BEGIN {
            split(plane, p)
            rad = atan2(0, -1) / 180; a = azimuth * rad; d = depression * rad
            ax = -cos(a); ay = sin(a)                                   # away
            sx = ax * cos(d); sy = ay * cos(d); sz = -sin(d)            # line of sight
            ux = ax * sin(d); uy = ay * sin(d); uz = cos(d)             # up on the plane
            print "#version 3.7; global_settings { assumed_gamma 1 max_trace_level 5 adc_bailout 0 }"
            print "camera { orthographic location", vector(-20 * sx + p[3] * ux, -20 * sy + p[3] * uy, -20 * sz + p[3] * uz)
            print "direction", vector(sx, sy, sz), "right", vector(sin(a) * p[1], cos(a) * p[1], 0)
            print "up", vector(ux * p[2], uy * p[2], uz * p[2]), "}"
            print "light_source {", vector(-1000 * sx, -1000 * sy, -1000 * sz), "color rgb 1 parallel point_at 0 }"
            look = "texture { pigment { rgb 1 } finish { ambient 0 diffuse 0.1 reflection 0.9 } } }"
            print "plane { z, 0", look                                  # quicker than two triangles in the mesh
            print "mesh {"
        }
        $1 == "v" { v[++n] = vector($2, $3, $4) }
        $1 == "f" { print "triangle {" v[$2] "," v[$3] "," v[$4] "}" }
        END {
            print look
        }' "$work/model.obj" > "$work/scene.pov"
}

# Least time by the clock, in ms, of five runs of a program.
clock_ms() { # program arguments...
    python3 -c '
import subprocess, sys, time
def run():
    start = time.monotonic()
    subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.monotonic() - start
print(round(1e3 * min(run() for _ in range(5))))' "$@"
}

# Processor seconds of POV-Ray for the picture, which it need not write: the last line is that of tracing, the ones before it
# are those of parsing.
trace_with_pov() {
    povray +I"$work/scene.pov" -F +W"$(value columns)" +H"$(value rows)" -D -A +WT"$(nproc)" > "$work/pov" 2>&1 ||
        { tail -n 20 "$work/pov" >&2; exit 1; }
    sed -nE 's/.* with ([0-9.]+) CPU-seconds total.*/\1/p' "$work/pov" | tail -n 1
}

compare() { # model
    "$target" model --model "$1" --obj "$work/model.obj" > "$work/log"
    "$target" bench --model "$1" --azimuth $azimuth --depression $depression --rays $rays --seconds 4 > "$work/ours"
    pov_scene
    pov_s=$(for _ in 1 2 3 4 5 6 7; do trace_with_pov; done | sort -n | head -n 1)
    awk -v model="$1" -v primary="$(value primary_rays)" -v rays="$(value rays)" -v ms="$(value trace_cpu_ms)" \
        -v cast="$(value cast_cpu_ms)" -v embree="$(value embree_cpu_ms)" -v pov="$pov_s" 'BEGIN {
        printf "  %-6s %8d %9d %9.1f %8.0f %9.1f %8.1f %7.0f%%\n", model, primary, rays, cast, pov * 1e3, embree,
               pov * 1e3 / cast, 100 * embree / cast
        printf "  %-6s %8s %9s %9.1f %8s %9s %8.1f %7.0f%%\n", "", "", "drawn:", ms, "", "", pov * 1e3 / ms, 100 * embree / ms
    }'
}

echo "A picture of up to five reflections: least processor time of landmass-target, of POV-Ray, and of Embree for bare rays"
echo "Every ray cast; then as it is done, with first reflections drawn"
echo "  model   primary  all rays  ours, ms  POV, ms  bare, ms  times POV  of bare"
if command -v povray > /dev/null; then
    compare slicy
    compare tank
else
    echo "  povray is missing (make deps): not compared"
fi
echo "One chip of 54 x 54 pixels, 5 reflections, 2 x 2 rays a cell"
echo "  model   model to pixels    memory   program, by the clock   POV-Ray likewise"
for model in slicy tank; do
    "$target" model --model $model --obj "$work/model.obj" > "$work/log"
    "$target" bench --model $model --azimuth $azimuth --depression $depression --seconds 2 > "$work/ours"
    ours=$(clock_ms "$target" render --model $model --azimuth $azimuth --depression $depression --out "$work/chip.png")
    pov=-
    if command -v povray > /dev/null; then
        pov_scene
        pov=$(clock_ms povray +I"$work/scene.pov" +O"$work/scene.png" +W"$(value columns)" +H"$(value rows)" -D -A \
            +WT"$(nproc)")
    fi
    printf '  %-6s %13.1f ms %6s MB %20s ms %15s ms\n' $model "$(value chip_ms)" "$(value memory_mb)" "$ours" "$pov"
done
