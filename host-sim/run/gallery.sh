#!/bin/sh
# Fly the real data and leave pictures in build/gallery (docs/gallery.md says what each shows).
# Usage: gallery.sh BUILD-DIR [SCENE...]; a scene whose data are absent is skipped.
set -eu
bin=$1/bin
shift
data=${LANDMASS_DATA:-../shared/data}
out=build/gallery
here=host-sim/run
mkdir -p $out
[ $# -gt 0 ] || set -- village reservoir campus island riviera zion guadeloupe kansas monaco baltimore san_diego modes island_modes airfield
for scene in "$@"; do
    sh $here/gallery_scene.sh "$bin" "$data" $out/"$scene" "$scene"
done
"$bin"/landmass-target sheet --model slicy --out $out/slicy.png
printf '\n== Pictures:\n'
find $out -name '*.png' | sort
