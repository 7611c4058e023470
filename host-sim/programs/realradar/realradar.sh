#!/bin/sh
# The simulation beside real radar (docs/realradar.md): tables on standard output, pictures in OUT-DIR.
# Usage: realradar.sh BIN-DIR DATA-DIR OUT-DIR gotcha|orihuela; a scene whose data are absent is skipped.
set -eu
bin=$1
data=$2
out=$3
scene=$4
here=host-sim/programs/realradar
classes=host-sim/programs/db/classes/heaton6.classes

need() { # FILE: end here, with a word, when it is not on this machine
    if [ ! -r "$data/$1" ]; then
        echo "$scene: skipped, there is no $data/$1 here"
        exit 0
    fi
}

gotcha() {
    need gotcha_xband/data_3dsar_pass1_az001_HH.mat
    "$bin"/landmass-realradar focus "$data/gotcha_xband/data_3dsar_pass1_az001_HH.mat" --out "$out"
}

# Fields, villages, a motorway and a flood: classes from Sentinel-2's 13 bands, echo from Sentinel-1 a day before.
orihuela() {
    need sen1floods11_spain_s1_s2/Spain_7370579_S2Hand.tif
    need sen1floods11_spain_s1_s2/Spain_7370579_S1Hand.tif
    image=$data/sen1floods11_spain_s1_s2/Spain_7370579_S2Hand.tif
    for part in judged trained; do
        [ $part = judged ] && how='--hold-out polygons:0.3' || how='--goal 0.99'
        # shellcheck disable=SC2086
        "$bin"/landmass-db train --image "$image" --exemplars $here/orihuela.tsv --map $here/orihuela.map \
            --classes $classes $how --net "$out/$part.net"
    done
    "$bin"/landmass-db segment --image "$image" --classes $classes --net "$out/trained.net" --out "$out/classes.tif" \
        --picture "$out/segmented.png" --picture-bands 4,3,2
    "$bin"/landmass-db reflect --class-raster "$out/classes.tif" --classes $classes --out "$out/reflectivity.tif"
    echo "All pixels, as segmented:"
    compare "$out/classes.tif" "$out"
    exemplars_alone
    echo "The pixels of the exemplars alone:"
    compare "$out/exemplars.tif" "$out/exemplars"
}

compare() { # CLASS-RASTER OUT-DIR
    "$bin"/landmass-realradar classes --classes $classes --class-raster "$1" --reflectivity "$out/reflectivity.tif" \
        --out "$2" --radar "$data/sen1floods11_spain_s1_s2/Spain_7370579_S1Hand.tif"
}

exemplars_alone() { # exemplars.tif: the class raster with everything else blank
    rm -f "$out/exemplars.gpkg"
    ogr2ogr -q -a_srs EPSG:4326 -oo GEOM_POSSIBLE_NAMES=WKT -nln polygons "$out/exemplars.gpkg" $here/orihuela.tsv
    gdal_translate -q -scale 0 255 255 255 "$out/classes.tif" "$out/exemplars.tif"
    index=0
    # shellcheck disable=SC2013
    for class in $(sed -n 's/^\[\(.*\)\].*/\1/p' $classes); do
        gdal_rasterize -q -burn $index -where "class = '$class'" -l polygons "$out/exemplars.gpkg" "$out/exemplars.tif"
        index=$((index + 1))
    done
}

mkdir -p "$out"
"$scene"
