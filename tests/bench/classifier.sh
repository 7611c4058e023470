#!/bin/sh
# classifier.sh BUILD-DIR: the classifier as it comes beside scikit-learn's MLPClassifier, on the same splits of the real
# scenes with the same priors, and both as segmenters of three bands. Figures are means over the seeds of SEEDS (default
# "1 2 3"); SCENES chooses among rgb, cube, sen2, tm, jasper6, jasper198 and water. A line that says "window" adds the
# neighbourhood of a pixel to its bands, for both.
set -eu
build=${1:?usage: classifier.sh BUILD-DIR}
here=$(dirname "$0")
data=${LANDMASS_DATA:-../shared/data}
program=$build/bin/landmass-db
seeds=${SEEDS:-1 2 3}
scenes=${SCENES:-rgb sen2 tm jasper6 water cube jasper198}
hows=${HOWS:-polygons pixels}
python=${PYTHON:-/usr/bin/python3}
if [ ! -r "$data/houston2018_rgb_hs_labels/derived/labels_512.pgm" ]; then
    echo "classifier: no real scenes here, nothing measured"
    exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM
export OPENBLAS_NUM_THREADS=1
houston=$data/houston2018_rgb_hs_labels/derived
jasper=$data/jasper_ridge_aviris/derived
sen2=$data/sentinel2_amazon_village_srtm_labels/derived
tm=$data/landsat5_amazon_tucurui_srtm_labels/derived
water=$data/sen1floods11_spain_s1_s2/Spain_7370579
printf '%s\n' '1 = vegetation' '2 = vegetation' '6 = asphalt' '9 = asphalt' '10 = asphalt' '7 = concrete' \
    '5 = structure' '12 = structure' > "$work/houston.map"
printf '%s\n' '1 = tree' '2 = water' '3 = dirt' '4 = road' > "$work/jasper.map"
printf '%s\n' '0 = land' '1 = water' > "$work/water.map"
# The cube has a quarter of the labels' resolution: each of its pixels is repeated, so that 4,000 exemplars a class exist.
gdal_translate -q -outsize 512 512 -r nearest "$houston/hs48_128.bsq" "$work/cube.tif" 2> /dev/null

class_table() { # name...
    for name in "$@"; do
        printf '[%s]\ncolour = 0 0 0\nkind = ground\ngamma_db = -20\nspread_db = 3\nlimits_db = -30 -10\n' "$name"
    done
}
class_table forest village water dryout > "$work/sen2.classes"
class_table forest water cleared fallen_dry > "$work/tm.classes"
class_table tree water dirt road > "$work/jasper.classes"
class_table land water > "$work/water.classes"

train() { # scene how seed options...
    scene=$1 how=$2 seed=$3
    shift 3
    six=host-sim/programs/db/classes/heaton6.classes
    case $scene in
        rgb) set -- "$@" --image "$houston/rgb_512.ppm" --classes $six --labels "$houston/labels_512.pgm" --map "$work/houston.map" ;;
        cube) set -- "$@" --image "$work/cube.tif" --classes $six --labels "$houston/labels_512.pgm" --map "$work/houston.map" ;;
        sen2) set -- "$@" --image "$sen2/sen2_12band_refl_x10000.bsq" --classes "$work/sen2.classes" \
            --exemplars "$sen2/trainingPolygons_sen2.tsv" ;;
        tm) set -- "$@" --image "$tm/lsat_7band.bsq" --classes "$work/tm.classes" --exemplars "$tm/trainingPolygons_lsat.tsv" ;;
        jasper6) set -- "$@" --image "$jasper/tm_like_6band.bsq" --classes "$work/jasper.classes" \
            --labels "$jasper/dominant_class.pgm" --map "$work/jasper.map" ;;
        jasper198) set -- "$@" --image "$jasper/jasper198_100x100.bsq" --classes "$work/jasper.classes" \
            --labels "$jasper/dominant_class.pgm" --map "$work/jasper.map" ;;
        water) set -- "$@" --image "${water}_S2Hand.tif" --classes "$work/water.classes" --labels "${water}_LabelHand.tif" \
            --map "$work/water.map" ;;
    esac
    "$program" train --hold-out "$how:0.3" --net "$work/$scene.net" --seed "$seed" "$@" 2> /dev/null
}

mean() { # of "accuracy kappa" lines
    awk '{ a += $1; k += $2 } END { printf "%.3f %.3f", a / NR, k / NR }'
}

ours() { # scene how options...
    scene=$1 how=$2
    shift 2
    for seed in $seeds; do
        train "$scene" "$how" "$seed" "$@" | grep '^overall' | tail -n 1 | sed 's/[^0-9. ]//g' | awk '{ print $1 / 100, $3 }'
    done | mean
}

peer() { # scene how priors options...
    scene=$1 how=$2 priors=$3
    shift 3
    files=
    for seed in $seeds; do
        train "$scene" "$how" "$seed" --epochs 1 --committee 1 --split-out "$work/$seed.csv" "$@" > /dev/null
        files="$files $work/$seed.csv"
    done
    # shellcheck disable=SC2086
    "$python" "$here/classifier_peer.py" score "$priors" $files | mean
}

compare() { # scene how priors what options...
    scene=$1 how=$2 priors=$3 what=$4
    shift 4
    printf '%-10s %-9s %-10s %-7s peer %s  ours %s\n' "$scene" "$how" "$priors" "$what" \
        "$(peer "$scene" "$how" "$priors" "$@")" "$(ours "$scene" "$how" --priors "$priors" "$@")"
}

if "$python" -c 'import sklearn' 2> /dev/null; then
    echo "scene      held out  priors     inputs  overall, kappa"
    for scene in $scenes; do
        for how in $hows; do
            compare "$scene" "$how" equal bands
            # The priors of the exemplars are those of all their pixels, so none may be left out.
            case $scene in
                jasper6 | sen2 | tm) compare "$scene" "$how" exemplars bands --per-class 1000000 ;;
            esac
        done
        [ "$scene" != rgb ] || compare rgb polygons equal window --context 7
    done
else
    echo "classifier: no scikit-learn here, nothing to compare with"
fi

echo
gdal_translate -q -outsize 4096 4096 -r nearest "$houston/rgb_512.ppm" "$work/large.tif" 2> /dev/null
train rgb polygons 1 --hidden 18 --epochs 5 --committee 1 > /dev/null
printf 'segmenting three bands, 3-18-4, Mpixel a second of processor time: ours '
"$program" segment --image "$work/large.tif" --classes host-sim/programs/db/classes/heaton6.classes \
    --net "$work/rgb.net" --out "$work/large-classes.tif" 2> /dev/null |
    sed -n 's/.* \([0-9.]*\) Mpixel\/s$/\1/p'
if "$python" -c 'import sklearn' 2> /dev/null; then
    printf 'scikit-learn, 3-18-6: %s\n' "$("$python" "$here/classifier_peer.py" speed)"
fi
