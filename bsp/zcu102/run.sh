#!/bin/sh
# Fly the built-in scene on the board in QEMU, as host-sim/run/run.sh flew it on the bench, and compare the pictures.
# Usage: run.sh BENCH-BUILD-DIR. Leaves build/zcu102/run/*.ppm, and *.png where gdal_translate is there.
set -eu
run=build/run
out=build/zcu102/run
if ! [ -r $run/scene.lmdb ] || ! [ -r $run/flight.log ]; then
    echo "There is no database of the built-in scene yet: making it (make run)"
    sh host-sim/run/run.sh "$1"
fi
BUILD=$1 python3 -B tests/zcu102/fly.py --db $run/scene.lmdb --bus $run/flight.log --script $run/flight.script \
    --seconds 50 --out $out --compare
for picture in "$out"/*.ppm; do
    if command -v gdal_translate >/dev/null; then
        gdal_translate -q -of PNG "$picture" "${picture%.ppm}.png"
        rm -f "$picture" "${picture%.ppm}.png.aux.xml"
    fi
done
echo "The display's pictures are in $out"
