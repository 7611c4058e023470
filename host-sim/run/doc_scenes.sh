#!/bin/sh
# What the pictures of docs/pictures are made of besides `make run` and `make gallery`: figures, models, another radar,
# infrared. Leaves it in build/docs; `doc_pictures.py` takes it from there. Usage: doc_scenes.sh BUILD-DIR
set -eu
bin=$1/bin
out=build/docs
classes=host-sim/programs/db/classes/heaton6.classes
mkdir -p $out

"$bin"/landmass-figures figure1 $out/figure1.png
"$bin"/landmass-figures table1 $out/table1.png
"$bin"/landmass-target trace --model slicy --azimuth 20 --out $out/slicy.trace --picture $out/slicy-reflections.png
"$bin"/landmass-target map --model tank --azimuth 40 --out $out/tank-parts.png --heights $out/heights.png \
    --csv $out/cells.csv
"$bin"/landmass-target bake --model tank --aspects 8 --depressions 10,20,40 --out $out/tank.sig \
    --sheet $out/signature-tank.png
"$bin"/landmass-target sheet --model slicy --depression 15 --count 6 --out $out/slicy.png

# docs/guide.md, of the flight of `make run`
printf '0 range 20\n9 picture page\n' >$out/page.script
"$bin"/landmass-sim --db build/run/scene.lmdb --bus build/run/flight.log --script $out/page.script --bezel \
    --size 512x512 --png $out --every 0

# docs/infrared.md
"$bin"/landmass-scene --out $out/small --size 1024
"$bin"/landmass-db infrared --class-raster $out/small/truth.tif --classes $classes --terrain $out/small/terrain.tif \
    --heights $out/small/heights.tif --shadows --air 18 --wind 2 --hours 4,9,14 --out $out/infrared

# docs/database.md, "Another radar"
"$bin"/landmass-scene --out $out/scene
"$bin"/landmass-db reflect --class-raster $out/scene/truth.tif --classes $classes --sensor ku --out $out/ku.tif
"$bin"/landmass-db build --classes $classes --class-raster $out/scene/truth.tif --reflectivity $out/ku.tif \
    --terrain $out/scene/terrain.tif --heights $out/scene/heights.tif --detail $out/scene/detail.txt \
    --radar host-sim/programs/radar/tables/ku.radar --out $out/ku.lmdb
"$bin"/landmass-nav --straight 41.985131,-29.105537,30,2500,70 --seconds 16 --out $out/ku.log
printf '0 range 4\n1 sar 41.990131 -29.025537 2\n15 picture ku-harbour\n' >$out/ku.script
"$bin"/landmass-nav --straight 42.0102,-29.092,90,2500,70 --seconds 10 --out $out/map.log
printf '0 range 4\n9 picture ku-map\n' >$out/map.script
"$bin"/landmass-sim --db $out/ku.lmdb --bus $out/ku.log --script $out/ku.script --png $out --every 0
"$bin"/landmass-sim --db $out/ku.lmdb --bus $out/map.log --script $out/map.script --png $out --every 0
