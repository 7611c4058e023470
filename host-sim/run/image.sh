#!/bin/sh
# The image of the built-in scene, of what run.sh left in build/run. Usage: image.sh BUILD-DIR TERRAIN-AROUND OUT.lmdb
set -eu
run=build/run
"$1"/bin/landmass-db build --classes host-sim/programs/db/classes/heaton6.classes --class-raster $run/classes.tif \
    --reflectivity $run/reflectivity.tif --terrain $run/scene/terrain.tif --terrain "$2" \
    --heights $run/scene/heights.tif --detail $run/scene/detail.txt --targets $run/targets.txt \
    --title "built-in scene" --out "$3"
