#!/bin/sh
# classifier.sh BUILD-DIR: the classifier beside scikit-learn's MLPClassifier, on the same splits of the Houston scene, and
# both as segmenters of three bands. Figures are means over the seeds of SEEDS (default "1 2 3"). Every line says what
# it was given: "bands" is the spectrum of the pixel alone, "window" adds the neighbourhood and is no like for like.
set -eu
build=${1:?usage: classifier.sh BUILD-DIR}
here=$(dirname "$0")
houston=${LANDMASS_DATA:-../shared/data}/houston2018_rgb_hs_labels/derived
program=$build/bin/landmass-db
seeds=${SEEDS:-1 2 3}
python=${PYTHON:-/usr/bin/python3}
if [ ! -r "$houston/labels_512.pgm" ]; then
    echo "classifier: no Houston scene here, nothing measured"
    exit 0
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM
export OPENBLAS_NUM_THREADS=1

cat > "$work/houston.map" <<'MAP'
1 = vegetation
2 = vegetation
6 = asphalt
9 = asphalt
10 = asphalt
7 = concrete
5 = structure
12 = structure
MAP
# The cube has a quarter of the labels' resolution: each of its pixels is repeated, so that 4,000 exemplars a class exist.
gdal_translate -q -outsize 512 512 -r nearest "$houston/hs48_128.bsq" "$work/cube.tif" 2> /dev/null

image_of() { # rgb | cube
    case $1 in rgb) echo "$houston/rgb_512.ppm" ;; *) echo "$work/cube.tif" ;; esac
}

train() { # image how seed options...
    image=$1 how=$2 seed=$3
    shift 3
    "$program" train --image "$(image_of "$image")" --classes host-sim/programs/db/classes/heaton6.classes \
        --labels "$houston/labels_512.pgm" --map "$work/houston.map" --hold-out "$how:0.3" \
        --net "$work/$image.net" --seed "$seed" "$@" 2> /dev/null
}

mean() { # of "accuracy kappa" lines
    awk '{ a += $1; k += $2 } END { printf "%.3f   %.3f", a / NR, k / NR }'
}

ours() { # image how name options...
    image=$1 how=$2 name=$3
    shift 3
    result=$(for seed in $seeds; do
        train "$image" "$how" "$seed" --goal 1 "$@" | grep '^overall' | tail -n 1 |
            sed 's/[^0-9. ]//g' | awk '{ print $1 / 100, $3 }'
    done | mean)
    printf '%-5s %-9s ours, %-42s %s\n' "$image" "$how" "$name" "$result"
}

peer() { # image how
    files=
    for seed in $seeds; do
        train "$1" "$2" "$seed" --epochs 1 --split-out "$work/$1-$2-$seed.csv" > /dev/null
        files="$files $work/$1-$2-$seed.csv"
    done
    # shellcheck disable=SC2086
    printf '%-5s %-9s %-48s %s\n' "$1" "$2" "scikit-learn MLPClassifier (100,), bands" \
        "$("$python" "$here/classifier_peer.py" score $files | mean)"
}

if "$python" -c 'import sklearn' 2> /dev/null; then has_peer=1; else has_peer=0; fi
echo "image held out  classifier                                       overall kappa"
for how in polygons pixels; do
    for image in rgb cube; do
        [ $has_peer = 0 ] || peer $image $how
        ours $image $how "as Heaton, bands"
        if [ $image = rgb ]; then
            ours $image $how "committee of 5, bands" --committee 5
            ours $image $how "100 hidden, cross-entropy, none thinned" --hidden 100 --loss cross-entropy \
                --noise 0.01 --thin 0
            ours $image $how "as Heaton, 7 x 7 window" --context 7
        else
            ours $image $how "cross-entropy, decay 0.001, bands" --loss cross-entropy --decay 0.001
            ours $image $how "cross-entropy, noise 0.01, none thinned" --loss cross-entropy --noise 0.01 --thin 0
        fi
    done
done

echo
gdal_translate -q -outsize 4096 4096 -r nearest "$houston/rgb_512.ppm" "$work/large.tif" 2> /dev/null
train rgb polygons 1 --hidden 18 --epochs 5 > /dev/null
printf 'segmenting three bands, 3-18-4: ours '
"$program" segment --image "$work/large.tif" --classes host-sim/programs/db/classes/heaton6.classes \
    --net "$work/rgb.net" --out "$work/large-classes.tif" 2> /dev/null |
    sed -n 's/.* \([0-9.]* Mpixel\/s\)$/\1 on one core, network alone/p'
if [ $has_peer = 1 ]; then
    "$python" "$here/classifier_peer.py" speed |
        awk '{ printf "segmenting three bands, 3-18-6: scikit-learn %s Mpixel/s with %s of a core busy\n", $1, $2 }'
fi
