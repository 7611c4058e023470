#!/bin/sh
# A world in one command: plan, estimate, shards, image, check, report, pictures. Usage: world.sh BUILD-DIR
# WORLD_OPTIONS are options of `landmass-db plan`; without them the ground is that of the built-in generator. WORLD_SEGMENT and
# WORLD_REFLECT are options of `segment` and `reflect`, whose rasters are made first, in WORLD_STRIPS strips. What is made lies
# in build/world. Run it again after a crash or a change: it goes on.
set -eu
bin=$1/bin
out=build/world
here=host-sim/world
command -v snakemake >/dev/null || { echo 'world: snakemake is missing; make deps-world installs it' >&2; exit 1; }
mkdir -p $out
if [ -z "${WORLD_OPTIONS:-}" ]; then
    echo "== No WORLD_OPTIONS: the ground is that of the built-in generator"
    if [ ! -e $out/scene/terrain.tif ] || [ ! -e $out/country/terrain.tif ]; then
        echo "it is made once, which takes a minute of a processor"
        "$bin"/landmass-scene --out $out/scene --size 1024
        "$bin"/landmass-scene --out $out/country --size 2000 --cell 50
    fi
    WORLD_OPTIONS="--classes host-sim/programs/db/classes/heaton6.classes --class-raster $out/scene/truth.tif
        --terrain $out/scene/terrain.tif --terrain $out/country/terrain.tif --heights $out/scene/heights.tif
        --detail $out/scene/detail.txt --title world"
fi
options=$(echo "$WORLD_OPTIONS" | tr -s ' \n' '  ')
cores=${WORLD_CORES:-$(nproc)}
world() {
    snakemake -s $here/Snakefile --rerun-triggers mtime --rerun-incomplete --nolock -j "$cores" \
        --log-handler-script $here/progress.py "$@" \
        --config db="$bin/landmass-db" options="$options" out=$out/world.lmdb work=$out shards="${WORLD_SHARDS:-$((2 * cores))}" \
        segment="${WORLD_SEGMENT:-}" reflect="${WORLD_REFLECT:-}" strips="${WORLD_STRIPS:-1}"
}
if [ -n "${WORLD_SEGMENT:-}${WORLD_REFLECT:-}" ]; then
    echo "== Classes and reflectivity: estimate"
    world $out/classes.plan
    world estimate_classes 2>/dev/null
    echo "== Classes and reflectivity"
fi
echo "== Plan and estimate"
world $out/image.plan
world estimate 2>/dev/null
echo "== Shards, image, check, pictures"
world
echo "== Made"
tail -n 2 $out/report.txt
cat $out/verified.txt
echo "== Look at:"
ls $out/world.lmdb $out/report.txt $out/pictures/*.png
