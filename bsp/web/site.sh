#!/bin/sh
# The folder of static files that is the page: modules, style, the unit, the database of the built-in scene, a flight
# over it. Usage: site.sh BENCH-BUILD-DIR
set -eu
site=build/web/site
if ! "$1"/bin/landmass-db inspect build/run/scene.lmdb >/dev/null 2>&1; then
    echo "There is no database of the built-in scene yet, or none of this format: making it (make run)"
    make --no-print-directory run
fi
# A smaller image for the page: the country around has posts of 50 m, and so cells of 38 m instead of 19 m.
image=build/web/scene.lmdb
if [ ! -e $image ] || [ -n "$(find build/run/scene.lmdb -newer $image)" ]; then
    gdal_translate -q -r average -tr 50 50 build/run/surroundings/terrain.tif build/web/around.tif
    sh host-sim/run/image.sh "$1" build/web/around.tif $image
fi
rm -rf $site
mkdir -p $site
cp bsp/web/page/* bsp/web/serve.mjs build/web/landmass.wasm build/run/flight.log $site
ln $image $site/scene.lmdb 2>/dev/null || cp $image $site/scene.lmdb
du -k --apparent-size $site/* | awk '{ printf "  %8d kB  %s\n", $1, $2 }'
echo "The page is in $site. To fly it here:  node $site/serve.mjs $site"
