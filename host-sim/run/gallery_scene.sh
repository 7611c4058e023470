#!/bin/sh
# One real scene, from its data to pictures of it.
# Usage: gallery_scene.sh BIN-DIR DATA-DIR OUT-DIR village|reservoir|campus|island|riviera|zion|guadeloupe|
#        kansas|monaco|baltimore|san_diego|modes|island_modes|airfield
# The tests of tests/system run the same scenes through the same script.
set -eu
bin=$1
data=$2
out=$3
scene=$4
in=host-sim/gallery
tables=host-sim/programs/db/classes

say() {
    printf '\n== %s: %s\n' "$scene" "$*"
}

need() { # FOLDER: end here, with a word, when the data are not on this machine
    if [ ! -r "$data/$1" ]; then
        say "skipped, there is no $data/$1 here"
        exit 0
    fi
}

classify() { # IMAGE EXEMPLARS BANDS: network, class raster and reflectivity from image and polygons
    say "judge the network by polygons that it has not seen"
    "$bin"/landmass-db train --image "$1" --exemplars "$2" --map "$in/$scene.map" \
        --classes "$in/$scene.classes" --hold-out polygons:0.3 --net "$out/judged.net" --report "$out/judged"
    say "train on all polygons; segment; reflectivity of fields by the brightness of the image"
    "$bin"/landmass-db train --image "$1" --exemplars "$2" --map "$in/$scene.map" \
        --classes "$in/$scene.classes" --goal 0.995 --net "$out/scene.net"
    "$bin"/landmass-db segment --image "$1" --exemplars "$2" --map "$in/$scene.map" \
        --classes "$in/$scene.classes" --net "$out/scene.net" --report "$out/segmentation" \
        --out "$out/classes.tif" --picture "$out/classes.png" --picture-bands "$3"
    "$bin"/landmass-db reflect --class-raster "$out/classes.tif" --classes "$in/$scene.classes" \
        --method fields --image "$1" --out "$out/reflectivity.tif"
}

build() { # TITLE, then options of landmass-db build
    title=$1
    shift
    say "build the flash image and check every byte of it"
    "$bin"/landmass-db build --title "$title" --out "$out/scene.lmdb" "$@"
    "$bin"/landmass-db verify "$out/scene.lmdb"
}

fly() { # SCRIPT, then what landmass-nav shall fly
    script=$1
    shift
    say "fly $script"
    "$bin"/landmass-nav --quiet --out "$out/$script.log" "$@"
    "$bin"/landmass-sim --db "$out/scene.lmdb" --bus "$out/$script.log" --script "$in/$script.script" \
        --png "$out" --every 0 --size 1024x1024
}

pass() { # NAME LAT,LON,HEADING,HEIGHT,SPEED "LAT LON CELL": fly by, and after 4 s make a patch
    printf '4 sar %s\n8 picture flight-%s\n' "$3" "$1" > "$out/pass-$1.script"
    say "pass $1"
    "$bin"/landmass-nav --quiet --out "$out/pass-$1.log" --straight "$2" --seconds 10
    "$bin"/landmass-sim --db "$out/scene.lmdb" --bus "$out/pass-$1.log" --script "$out/pass-$1.script" \
        --png "$out" --every 0 --size 1024x1024
}

show() { # DATABASE NAME TRACK-LOG: fly that script for a look at small pictures
    say "show $2"
    "$bin"/landmass-sim --db "$1" --bus "$3" --script "$out/$2.script" --png "$out" --every 0 --size 480x480
}

# DATABASE RANGE_NM "LAT LON of weather" RADIUS_KM "LAT LON CELL of a patch" "LAT LON RADIUS_KM of rain before it", then what
# landmass-nav shall fly
modes_of() {
    database=$1 range=$2 weather=$3 radius=$4 patch=$5 shower=$6
    shift 6
    "$bin"/landmass-nav --quiet --out "$out/straight.log" "$@" --seconds 60
    { echo "0 range $range" && cat $in/modes.script; } > "$out/modes.script"
    show "$database" modes "$out/straight.log"
    cat > "$out/effects.script" <<EOF
0    range $range
2.1  picture effect-none
2.1  rain $weather $radius 30
4.2  picture effect-rain
4.2  weather fair
4.2  jam $weather 30
6.3  picture effect-jammer
6.3  weather fair
6.3  osb 5
6.4  osb 4
8.5  picture effect-pencil-beam
8.5  osb 2 1.2
11.8 picture effect-pencil-beam-tilted-up
EOF
    show "$database" effects "$out/straight.log"
    cat > "$out/seas.script" <<EOF
0    range $range
0    sea
0    seastate 1
4.2  picture effect-sea-state-1
4.2  seastate 6
8.4  picture effect-sea-state-6
EOF
    show "$database" seas "$out/straight.log"
    printf '1 sar %s plan\n6 picture effect-plan\n6 sar %s\n11 picture effect-layover\n' "$patch" "$patch" \
        > "$out/layover.script"
    show "$database" layover "$out/straight.log"
    printf '1 sar %s\n8 picture effect-patch\n' "$patch" > "$out/patch.script"
    show "$database" patch "$out/straight.log"
    printf '0 rain %s 60\n1 sar %s\n8 picture effect-patch-rain\n' "$shower" "$patch" > "$out/patch-rain.script"
    show "$database" patch-rain "$out/straight.log"
}

modes() { # the built-in scene, as `make run` leaves it
    if [ ! -r build/run/scene.lmdb ]; then
        say "skipped, there is no build/run/scene.lmdb here: make run makes it"
        exit 0
    fi
    modes_of build/run/scene.lmdb 10 "42.02 -29.07" 2.5 "41.9950 -29.0080 5" "41.9996 -29.0211 1.2" \
        --straight 42.05,-29.16,90,3000,180
    # A turn of 8.1 m/s2, the town 10 km off and 40 degrees to the right.
    "$bin"/landmass-nav --quiet --out "$out/turn.log" --circle 41.9674,-28.9225,4000,3000,180,180 --seconds 20
    cat > "$out/turn.script" <<EOF
1    sar 41.9950 -29.0080 1
4    picture effect-turn
4    sar 41.9950 -29.0080 1 steady
8    picture effect-turn-steady
EOF
    show build/run/scene.lmdb turn "$out/turn.log"
}

island_modes() { # Hilo, and Mauna Kea behind it
    island_image
    modes_of "$out/scene.lmdb" 20 "19.73 -155.10" 5 "19.82 -155.47 30" "19.817 -155.45 2" \
        --straight 19.75,-154.9,250,3000,200
}

# A visual database in pieces, each a tree of its own: joined by links, then looked at from above. The ground is
# classified at its imagery's 27 m, over a larger area; buildings stand in cells of 7 m.
san_diego() {
    need cdb_san_diego
    classes=$tables/landcover.classes
    area=32.65,-117.24,32.74,-117.10
    rm -rf "$out/cdb"
    mkdir -p "$out/cdb"
    for part in ImageryMoreLODPositiveElevation GSModelsWithGTModelTexture GTModels; do
        cp -rs -n "$(realpath "$data")/cdb_san_diego/$part/." "$out/cdb/"
    done
    say "look down on the tree: imagery for the classifier, then buildings, terrain and heights"
    "$bin"/landmass-db import --cdb "$out/cdb" --area 32.60,-117.25,32.75,-117.05 --cell 28 \
        --out-image "$out/ground.tif" --out-mask "$out/patches.tif"
    "$bin"/landmass-db import --cdb "$out/cdb" --area $area --cell 7 --boxes --classes "$classes" \
        --map $in/san_diego.map --out-image "$out/image.tif" --out-classes "$out/named.tif" \
        --out-terrain "$out/terrain.tif" --out-heights "$out/heights.tif"
    say "train, segment, correct the water where two pictures of it meet, lay the buildings over it"
    "$bin"/landmass-db train --image "$out/ground.tif" --exemplars $in/san_diego.geojson --classes "$classes" \
        --context 7 --net "$out/scene.net"
    "$bin"/landmass-db segment --image "$out/ground.tif" --classes "$classes" --net "$out/scene.net" \
        --out "$out/segmented.tif" --picture "$out/classes.png"
    "$bin"/landmass-db correct --class-raster "$out/segmented.tif" --classes "$classes" \
        --corrections $in/san_diego.water.geojson --out "$out/corrected.tif"
    gdalbuildvrt -q -overwrite -te -117.24 32.65 -117.10 32.74 -resolution highest "$out/classes.vrt" \
        "$out/corrected.tif" "$out/named.tif"
    build "San Diego" --classes "$classes" --class-raster "$out/classes.vrt" --class-numbers \
        --heights "$out/heights.tif" --terrain "$out/terrain.tif"
    # Downtown, 8 km off and 45 degrees to the right: from the sea, and from the hills behind.
    pass from-south-west 32.659,-117.2254,0,1500,200 "32.705 -117.165 8"
    pass from-north-east 32.761,-117.1046,180,1500,200 "32.705 -117.165 8"
    pass bridge 32.643,-117.2104,0,1500,200 "32.689 -117.155 4"
}

village() {
    need sentinel2_amazon_village_srtm_labels
    source=$data/sentinel2_amazon_village_srtm_labels/derived
    classify "$source/sen2_12band_refl_x10000.bsq" "$source/trainingPolygons_sen2.tsv" 4,3,2
    # The terrain repeats each 3-second post of SRTM over nine or ten pixels. Those stairs would cast shadows: take posts back.
    gdalwarp -q -overwrite -r bilinear -ts 26 25 "$source/srtm.bsq" "$out/posts.tif"
    build "Amazon village" --classes $in/village.classes --class-raster "$out/classes.tif" \
        --reflectivity "$out/reflectivity.tif" --terrain "$out/posts.tif" --land-class forest
    fly village --circle -1.46935,-56.3626,8000,1500,200,180 --seconds 20
    # Four passes at 200 m/s, the village 8 km away and 45 degrees to the right when the patch is made.
    pass from-south-4m -1.54269,-56.38789,337.92,1500,200 "-1.4715 -56.3690 4"
    pass from-west -1.47414,-56.43959,45.24,1500,200 "-1.46935 -56.3626 8"
    pass from-north -1.39184,-56.36704,135.48,1500,200 "-1.46935 -56.3626 8"
    pass from-east -1.46327,-56.28570,224.29,1500,200 "-1.46935 -56.3626 8"
}

reservoir() {
    need landsat5_amazon_tucurui_srtm_labels
    source=$data/landsat5_amazon_tucurui_srtm_labels
    bands=
    for band in 1 2 3 4 5 6 7; do
        bands=$bands,$source/LT52240631988227CUB02_B$band.TIF
    done
    classify "${bands#,}" "$source/derived/trainingPolygons_lsat.tsv" 5,4,3
    build "Amazon reservoir" --classes $in/reservoir.classes --class-raster "$out/classes.tif" \
        --reflectivity "$out/reflectivity.tif" --terrain "$source/derived/srtm.bsq" --land-class forest
    fly reservoir --straight -3.7875,-49.98,90,2500,150 --seconds 60
}

campus() {
    need houston2018_rgb_hs_labels
    source=$data/houston2018_rgb_hs_labels/derived
    classes=host-sim/programs/db/classes/heaton6.classes
    for image in rgb_512.ppm hs48_128.bsq; do
        name=${image%%_*}
        say "train and segment $image"
        "$bin"/landmass-db train --image "$source/$image" --labels "$source/labels_512.pgm" --map $in/campus.map --priors equal \
            --classes $classes --black-is-nodata --hold-out polygons:0.33 --net "$out/$name.net"
        "$bin"/landmass-db segment --image "$source/$image" --black-is-nodata --classes $classes \
            --net "$out/$name.net" --out "$out/$name-classes.tif" --picture "$out/$name-classes.png" \
            --picture-bands "$([ "$name" = rgb ] && echo 1,2,3 || echo 40,22,10)"
    done
}

island_image() {
    need dted1_hawaii
    source=$data/dted1_hawaii
    build Hawaii --classes $in/terrain.classes --terrain "$source/n19_w155_3arc_v2.dt1" \
        --terrain "$source/n19_w156_3arc_v2.dt1" --terrain "$source/n20_w156_3arc_v2.dt1" \
        --land-class land --water-class sea --steep-class rock --steep-degrees 20
}

island() {
    island_image
    fly island-high --straight 19.75,-154.75,270,3000,200 --seconds 10
    fly island-low --straight 19.75,-154.75,270,1500,200 --seconds 10
}

riviera() {
    need srtm_hgt/N43E007.hgt.zip
    need nav_tracks/nice.csv.gz
    build Riviera --classes $in/terrain.classes --terrain "$data/srtm_hgt/N43E007.hgt.zip" \
        --land-class land --water-class sea --steep-class rock --steep-degrees 25 --geoid 49
    # An aircraft that calibrates the airport's instruments: up the coast and down to the runway, 1,230 m to 200 m. Its heights are
    # above the sea; the bus carries heights above the ellipsoid.
    fly riviera --start 9500 --seconds 345 --height-offset 49 "$data/nav_tracks/nice.csv.gz"
}

cover() { # TITLE LAND-COVER MAP TERRAIN, then options: an image of somebody's land cover, without training
    title=$1 raster=$2 map=$3 terrain=$4
    shift 4
    build "$title" --classes $tables/landcover.classes --class-raster "$raster" --map "$tables/$map" \
        --terrain "$terrain" "$@"
}

plain() { # EPSG "WEST NORTH EAST SOUTH" METRES: level ground, where there is no terrain
    # shellcheck disable=SC2086 # four numbers
    gdal_create -q -ot Float32 -outsize 100 100 -burn "$3" -a_srs "EPSG:$1" -a_ullr $2 "$out/terrain.tif"
}

zion() {
    need zion_nlcd_srtm
    cover Zion "$data/zion_nlcd_srtm/nlcd2011.tif" nlcd.map "$data/zion_nlcd_srtm/srtm.tif"
    fly zion --straight 37.20,-113.20,30,4500,200 --seconds 30
}

guadeloupe() {
    need corine_guadeloupe
    plain 4559 "617151 1836482 723451 1740782" 1
    cover Guadeloupe "$data/corine_guadeloupe/U2018_CLC2018_V2020_20u1_FR_GLP.tif" corine.map "$out/terrain.tif" \
        --sea-level -1 --land-class water
    fly guadeloupe --straight 16.02,-61.90,75,4500,200 --seconds 30
}

kansas() {
    need cropland_kansas_cdl
    plain 5070 "-106095 1822605 -76095 1792605" 380
    cover Kansas "$data/cropland_kansas_cdl/2021_30m_cdls.tif" cdl.map "$out/terrain.tif"
    fly kansas --straight 39.17,-97.20,40,3000,200 --seconds 30
}

vectors() { # CELL FILE..., options: classes, heights and detail of OpenStreetMap
    cell=$1 file=$2
    shift 2
    say "classes, heights and detail of $file"
    "$bin"/landmass-db vectors --vectors "$file" --rules $tables/osm.rules --classes $tables/landcover.classes \
        --cell "$cell" --out "$out/classes.tif" --heights "$out/heights.tif" --detail "$out/detail.txt" "$@"
}

monaco() {
    need osm_monaco
    need srtm_hgt/N43E007.hgt.zip
    need nav_tracks/nice.csv.gz
    vectors 2.4 "$data/osm_monaco/monaco.osm.pbf"
    build Monaco --classes $tables/landcover.classes --class-raster "$out/classes.tif" --heights "$out/heights.tif" \
        --detail "$out/detail.txt" --terrain "$data/srtm_hgt/N43E007.hgt.zip" --steep-class rock --steep-degrees 30 \
        --geoid 49
    fly monaco --start 9500 --seconds 345 --height-offset 49 "$data/nav_tracks/nice.csv.gz"
}

baltimore() {
    need osm_baltimore
    vectors 2.4 "$data/osm_baltimore/baltimore.osm.pbf"
    plain 4326 "-76.70 39.35 -76.45 39.20" 5
    build Baltimore --classes $tables/landcover.classes --class-raster "$out/classes.tif" --heights "$out/heights.tif" \
        --detail "$out/detail.txt" --terrain "$out/terrain.tif"
    fly baltimore --straight 39.15,-76.45,320,3000,200 --seconds 30
}

airfield() { # a field of our own, on level ground at 42 N 27 W, with what landmass-target bakes parked on it
    classes=host-sim/programs/db/classes/heaton6.classes
    extent="499400 4649400 500600 4650600" # UTM zone 26 N; the apron is around 500000, 4650000
    for model in aircraft tank lorry shelter; do
        say "bake the signature of the $model"
        "$bin"/landmass-target bake --model $model --aspects 24 --depressions 8,15,30 --rays 1 \
            --out "$out/$model.sig" --sheet "$out/signature-$model.png"
        "$bin"/landmass-target model --model $model --view "$out/model-$model.png"
    done
    gdal_rasterize -q -a class -init 4 -ot Byte -te $extent -tr 1 1 $in/airfield.geojson "$out/classes.tif"
    gdal_rasterize -q -a height -init 0 -ot Float32 -te $extent -tr 1 1 $in/airfield.geojson "$out/heights.tif"
    gdal_create -q -ot Float32 -outsize 40 40 -burn 30 -a_srs EPSG:32626 \
        -a_ullr 480000 4670000 520000 4630000 "$out/terrain.tif"
    "$bin"/landmass-db reflect --class-raster "$out/classes.tif" --classes $classes --out "$out/reflectivity.tif"
    cp $in/airfield.targets "$out"
    build airfield --classes $classes --class-raster "$out/classes.tif" --reflectivity "$out/reflectivity.tif" \
        --heights "$out/heights.tif" --terrain "$out/terrain.tif" --trust-inputs --targets "$out/airfield.targets"
    fly airfield --straight 41.95,-27.02,10,1500,150 --seconds 26
    fly airfield-modes --straight 41.9319,-27.0543,0,1500,180 --seconds 24
}

mkdir -p "$out"
"$scene"
