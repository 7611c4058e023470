#!/bin/sh
# The folder of static files that is the page: modules, style, the unit, the database of the built-in scene, a flight
# over it. Usage: site.sh BENCH-BUILD-DIR
set -eu
site=build/web/site
if ! "$1"/bin/landmass-db inspect build/run/scene.lmdb >/dev/null 2>&1; then
    echo "There is no database of the built-in scene yet, or none of this format: making it (make run)"
    make --no-print-directory run
fi
rm -rf $site
mkdir -p $site
cp bsp/web/page/* bsp/web/serve.mjs build/web/landmass.wasm build/run/flight.log $site
ln build/run/scene.lmdb $site/scene.lmdb 2>/dev/null || cp build/run/scene.lmdb $site/scene.lmdb
du -k --apparent-size $site/* | awk '{ printf "  %8d kB  %s\n", $1, $2 }'
echo "The page is in $site. To fly it here:  node $site/serve.mjs $site"
