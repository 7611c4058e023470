#!/bin/sh
# The main job, from nothing: invent a place, classify its image, build the database, fly over it, leave pictures.
# Usage: run.sh BUILD-DIR [COMMAND...]. Everything goes into build/run. landmass-scene and -db are there; COMMAND builds the
# other programs while the first steps run.
set -eu
build=$1
bin=$build/bin
shift
out=build/run
classes=host-sim/programs/db/classes/heaton6.classes
start=$(date +%s)

say() {
    printf '\n== %s\n' "$*"
}

# Steps that need nothing of each other run side by side. What one says is printed when it is joined, in one piece.
beside() { # NAME FUNCTION
    "$2" >$out/said-"$1" 2>&1 &
    echo $! >$out/pid-"$1"
}

join() { # NAME
    if wait "$(cat $out/pid-"$1")"; then status=0; else status=$?; fi
    cat $out/said-"$1"
    rm $out/said-"$1" $out/pid-"$1"
    [ "$status" -eq 0 ] || exit "$status"
}

mkdir -p $out
# The same country for 50 km around, coarse: only its terrain is used.
surroundings() {
    "$bin"/landmass-scene --out $out/surroundings --size 1000 --cell 50
}
later=${*:-true}
# What is parked on the airfield, traced from 24 sides (docs/target-tracer.md).
bake() {
    $later
    say "Trace what is parked on the airfield from 24 sides (docs/target-tracer.md)"
    for model in aircraft tank; do
        "$bin"/landmass-target bake --model $model --aspects 24 --depressions 8,15 --rays 1 --out $out/$model.sig
    done
}
beside surroundings surroundings
beside bake bake

say "The built-in scene: image, terrain, exemplars (build/run/scene)"
"$bin"/landmass-scene --out $out/scene --preview

say "Train the network on the photo-analyst's exemplars, a third of the polygons held out"
# Shares between equal and those of the ground: about their square roots (docs/classifier.md, "Towns").
"$bin"/landmass-db train --image $out/scene/image.tif --exemplars $out/scene/exemplars.geojson \
    --classes $classes --net $out/scene.net --hold-out polygons:0.33 --report $out/training --loss cross-entropy \
    --priors soil=0.15,asphalt=0.07,concrete=0.05,structure=0.07,vegetation=0.4,water=0.26

say "Segment the whole image"
"$bin"/landmass-db segment --image $out/scene/image.tif --net $out/scene.net --classes $classes \
    --exemplars $out/scene/exemplars.geojson --report $out/segmentation \
    --spare structure \
    --out $out/classes.tif --picture $out/classes.png

say "Assign reflectivity"
"$bin"/landmass-db reflect --class-raster $out/classes.tif --classes $classes --method fields \
    --image $out/scene/image.tif --out $out/reflectivity.tif

join surroundings
join bake

place() { # latitude and longitude of a place of the scene
    awk -v name="$1" '/^# place/ { is_list = 1 } is_list && $1 == name { print $2, $3 }' $out/scene/scene.txt
}

# What moves, four vehicles on land and a ferry, and what is parked in a row beside the runway (docs/targets.md).
cat >$out/targets.txt <<EOF
library aircraft aircraft.sig
library tank tank.sig
$(place airfield | awk '{
    for (i = -3; i <= 3; i++) {
        printf "target parked-%d %.6f %.6f ground %d signature %s\n", i + 4, $1 + i * 0.00024, $2 + i * 0.00037,
               i % 2 ? 140 : 320, i < 2 ? "aircraft" : "tank"
    }
}')
target road-train 42.0120 -29.0330 ground+3 30 swerling 1 35 moving 22 3000
target lorry-1 41.9700 -28.9900 ground+3 40 swerling 1 35 moving 20 3000
target lorry-2 42.0350 -29.0100 ground+3 15 swerling 1 35 moving 18 3000
target coach 42.0060 -28.9900 ground+3 10 swerling 1 35 moving 16 3000
target ferry 42.0250 -29.0900 ground+6 20 swerling 1 42 moving 7 6000
EOF

say "Build the flash image"
sh host-sim/run/image.sh "$build" $out/surroundings/terrain.tif $out/scene.lmdb

verify() {
    say "Check every byte of the image"
    "$bin"/landmass-db verify $out/scene.lmdb
}

# SECONDS PLACE CELL SIDE: five seconds for the patch, then its picture.
look_at() {
    echo "$1 sar $(place "$2") $3"
    echo "$(($1 + 5)) picture sar-$2-from-$4"
}

window=
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then window=--window; fi

arrival() {
    say "Fly in from the sea at 3,000 m: ground map, then patches of five places to the right of the way"
    "$bin"/landmass-nav --straight 42.045,-29.18,90,3000,180 --seconds 60 --out $out/flight.log
    {
        printf '0 range 20\n5 picture ground-map-20nm\n5 range 10\n9 picture ground-map-10nm\n'
        look_at 10 town 2 north
        look_at 16 harbour 4 north
        look_at 22 airfield 5 north
        printf '28 sar %s 1\n34 picture sar-parked\n' "$(place airfield)"
        look_at 34 lake 8 north
        look_at 40 river-valley 5 north
        printf '46 range 10\n50 picture ground-map-coast\n'
    } >$out/flight.script
    "$bin"/landmass-sim --db $out/scene.lmdb --bus $out/flight.log --script $out/flight.script \
        --png $out/pictures --every 150 --seconds 51 $window
}

east() {
    say "The same five places once more, from a northbound way to the east of them"
    "$bin"/landmass-nav --straight 41.83,-28.86,0,3000,180 --seconds 40 --out $out/east.log
    {
        look_at 1 airfield 5 east
        look_at 7 harbour 4 east
        look_at 13 town 2 east
        look_at 19 lake 8 east
        look_at 25 river-valley 5 east
    } >$out/east.script
    "$bin"/landmass-sim --db $out/scene.lmdb --bus $out/east.log --script $out/east.script --png $out/pictures --every 0
}

modes() {
    say "Fly past the town once more: sea, moving targets, and the ground map through every field of view"
    "$bin"/landmass-nav --straight 42.05,-29.16,90,3000,180 --seconds 25 --out $out/modes.log
    { echo "0 range 10" && cat host-sim/gallery/modes.script; } >$out/modes.script
    "$bin"/landmass-sim --db $out/scene.lmdb --bus $out/modes.log --script $out/modes.script --png $out/pictures --every 0
}

exercise() {
    say "An exercise: vehicles that only the bus knows, rain, a transmitter that weakens; recorded, and shown again"
    # A convoy along the coast road, and two vehicles that leave the apron.
    convoy=$(awk 'BEGIN { for (i = 0; i < 6; i++) printf "--live %d,4,%.5f,-28.99000,0,18 ", i, 42.005 + i * 0.0012 }')
    apron=$(place airfield | awk '{ for (i = 0; i < 2; i++) printf "--live %d,4,%.5f,%.5f,130,6 ", 10 + i, $1 + 0.001, $2 + i * 0.001 }')
    # shellcheck disable=SC2086 # words
    "$bin"/landmass-nav --straight 42.05,-29.16,90,3000,180 --seconds 40 $convoy $apron --exercise-clock 0 \
        --rain 42.06,-29.02,3000,30,12 --malfunction weak-transmit=25@20,27 --out $out/exercise.log
    {
        printf '0 range 10\n1 gmt\n9 picture exercise-gmt\n9 gm\n19 picture exercise-rain\n26 picture exercise-weak\n'
        printf '30 sar %s 1\n36 picture exercise-patch\n' "$(place airfield)"
    } >$out/exercise.script
    "$bin"/landmass-sim --db $out/scene.lmdb --bus $out/exercise.log --script $out/exercise.script --png $out/pictures \
        --every 0 --record $out/recording.log
    "$bin"/landmass-sim --db $out/scene.lmdb --replay $out/recording.log --from 35.9 --png $out/replay --every 1
}

# What the exercise records is flown again: nothing takes longer, so the others leave it a processor.
for part in exercise arrival east modes verify; do beside $part $part; done
for part in arrival east modes verify; do renice -n 10 -p "$(cat $out/pid-$part)" >/dev/null || true; done
for part in verify arrival east modes exercise; do join $part; done

say "Done in $(($(date +%s) - start)) s. Look at:"
ls $out/scene/preview.png $out/classes.png $out/pictures/*.png
