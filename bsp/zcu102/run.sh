#!/bin/sh
# Fly the built-in scene on the board in QEMU, as host-sim/run/run.sh flew it on the bench. Usage: run.sh BENCH-BUILD-DIR
# [count|cycles]: compare the pictures and leave them in build/zcu102/run, count the instructions, or estimate the cycles.
set -eu
run=build/run
out=build/zcu102/run
if ! [ -r $run/flight.log ] || ! "$1"/bin/landmass-db inspect $run/scene.lmdb > /dev/null 2>&1; then
    echo "There is no database of the built-in scene yet, or none of this format: making it (make run)"
    sh host-sim/run/run.sh "$1"
fi
flight="--db $run/scene.lmdb --bus $run/flight.log --seconds 53"
export BUILD="$1"
if [ "${2:-}" = count ] || [ "${2:-}" = cycles ]; then
    # Every mode, a track, and the patch of the town as make run has it, finer than the map; and one that is not.
    mkdir -p build/zcu102/bench
    {
        printf '%s\n' '0 range 10' '5 gm exp'
        awk '$2 == "sar" { print 10, $2, $3, $4, $5; print 16, $2, $3, $4, 5; exit }' $run/flight.script
        printf '%s\n' '22 gm dbs1' '29 gm dbs2' '36 gmt' '41 sea' '44 bcn' '46 gm'
        awk '$2 == "sar" { print 50.0, "cursor", $3, $4; print 50.4, "track"; exit }' $run/flight.script
    } >build/zcu102/bench/script
    # shellcheck disable=SC2086 # words
    case $2 in
    count) exec python3 -B tests/zcu102/bench.py $flight --script build/zcu102/bench/script --out build/zcu102/bench ;;
    cycles)
        "$1"/bin/tests/zcu102/tile_order
        exec python3 -B tests/zcu102/cycles/cycles.py $flight --script build/zcu102/bench/script --out build/zcu102/cycles
        ;;
    esac
fi
# shellcheck disable=SC2086
python3 -B tests/zcu102/fly.py $flight --script $run/flight.script --out $out --compare
for picture in "$out"/*.ppm; do
    if command -v gdal_translate >/dev/null; then
        gdal_translate -q -of PNG "$picture" "${picture%.ppm}.png"
        rm -f "$picture" "${picture%.ppm}.png.aux.xml"
    fi
done
echo "The display's pictures are in $out"
