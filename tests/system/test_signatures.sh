#!/bin/sh
# A target from its model to the glass, as its user makes it: baked, built into an image, flown past.
set -u
build=${BUILD:-build/bench-linux}
bin=$build/bin
work=$build/tmp/test_signatures
rm -rf "$work"
mkdir -p "$work"
# shellcheck source=tests/system/test_sim_tap.sh
. tests/system/test_sim_tap.sh

classes=host-sim/programs/db/classes/heaton6.classes
log=$work/flight.log
script=$work/flight.script

image() { # NAME: with the targets of $work/NAME.txt
    exits 0 "$bin/landmass-db" build --classes $classes --class-raster "$work/scene/truth.tif" --reflectivity "$work/reflectivity.tif" \
        --terrain "$work/scene/terrain.tif" --targets "$work/$1.txt" --title "$1" --out "$work/$1.lmdb"
}

fly() { # NAME: over that image, one patch
    exits 0 "$bin/landmass-sim" --db "$work/$1.lmdb" --bus "$log" --script "$script" --png "$work/$1" --every 0 --size 480x480
}

differ() { # NAME NAME
    ! cmp -s "$work/$1/patch.png" "$work/$2/patch.png"
}

check 'a model is baked from eight sides' exits 0 "$bin/landmass-target" bake --model tank --out "$work/tank.sig" \
    --aspects 8 --depressions 15 --mean 20
exits 0 "$bin/landmass-scene" --out "$work/scene" --size 640 --cell 20
exits 0 "$bin/landmass-db" reflect --class-raster "$work/scene/truth.tif" --classes $classes --method assign \
    --out "$work/reflectivity.tif"
apron=$(awk '/^# place/ { is_list = 1 } is_list && $1 == "airfield" { print $2, $3 }' "$work/scene/scene.txt")
for heading in 0 120; do
    printf 'library tank tank.sig\ntarget parked %s ground %d signature tank\n' "$apron" $heading >"$work/towards-$heading.txt"
done
printf 'target point %s ground 0 swerling 0 20\n' "$apron" >"$work/point.txt"
# From 8 km to the west, past it at 30 degrees to the right.
awk -v place="$apron" 'BEGIN { split(place, at, " "); printf "%.6f,%.6f,60,2000,150\n", at[1], at[2] - 0.1 }' >"$work/start"
exits 0 "$bin/landmass-nav" --straight "$(cat "$work/start")" --seconds 12 --quiet --out "$log"
printf '1 sar %s 0.5\n11 picture patch\n' "$apron" >"$script"

for name in towards-0 towards-120 point; do
    check "an image with $name is built" image $name
    check 'and sound' exits 0 "$bin/landmass-db" verify "$work/$name.lmdb"
    check 'and flown over' fly $name
done
check 'a point needs no chip' printed 'chips: 0 read'
check 'a target with a signature' fly towards-0
check 'needs one, and it is read' printed 'chips: 1 read, 0 damaged, 0 without room, 0 cells of lines left out'
check 'nothing of the image is lost' printed 'targets: 1 held, 0 of the images not; signatures: 1 held, 0 not'
check 'it is not shown as a point' differ towards-0 point
check 'and shows which way it faces' differ towards-0 towards-120

# One bit in the middle of every chip: the image's last section.
python3 - "$work/towards-0.lmdb" "$work/tank.sig" "$work/damaged.lmdb" <<'END'
import sys
image, library = (open(name, "rb").read() for name in sys.argv[1:3])
chips = len(library) - 8 * 4672
image = bytearray(image)
at = bytes(image).rindex(library[chips + 64:chips + 4672]) - 64
for chip in range(8):
    image[at + chip * 4672 + 2000] ^= 1
open(sys.argv[3], "wb").write(image)
END
check 'damaged chips do not end the flight' fly damaged
check 'they are counted' printed 'chips: 0 read, [12] damaged'
check 'and the target is a point' differ damaged towards-0
check 'that an inspector finds' exits 1 "$bin/landmass-db" verify "$work/damaged.lmdb"
finish
