#!/bin/sh
# Another radar without a compiler: its table a text, the built-in scene built for its band, and flown.
set -u
build=${BUILD:-build/bench-linux}
bin=$build/bin
work=$build/tmp/test_radar
rm -rf "$work"
mkdir -p "$work"
# shellcheck source=tests/system/test_sim_tap.sh
. tests/system/test_sim_tap.sh

classes=host-sim/programs/db/classes/heaton6.classes
ku=host-sim/programs/radar/tables/ku.radar
picture=$build/bin/tests/system/test_sim_tool

image() { # NAME SENSOR OPTIONS...: of the scene, seen by that sensor
    name=$1 sensor=$2
    shift 2
    exits 0 "$bin/landmass-db" reflect --class-raster "$work/scene/truth.tif" --classes $classes --method assign \
        --sensor "$sensor" --out "$work/$name.tif" &&
        exits 0 "$bin/landmass-db" build --classes $classes --class-raster "$work/scene/truth.tif" \
            --reflectivity "$work/$name.tif" --terrain "$work/scene/terrain.tif" --heights "$work/scene/heights.tif" \
            --title "$name" --out "$work/$name.lmdb" "$@"
}

fly() { # NAME SCRIPT OPTIONS...: pictures into $work/NAME
    name=$1 script=$2
    shift 2
    exits 0 "$bin/landmass-sim" --bus "$work/flight.log" --script "$work/$script" --png "$work/$name" --every 0 \
        --size 480x480 "$@"
}

lit() { # PICTURE: pixels that are not black, as the tool counts those that are
    black=$("$picture" pixels "$work/$1.png" 000000)
    echo $((480 * 480 - black))
}

"$bin/landmass-scene" --out "$work/scene" --size 640 --cell 20 >"$out" 2>"$last_error"
town=$(awk '/^# place/ { is_list = 1 } is_list && $1 == "town" { print $2, $3 }' "$work/scene/scene.txt")
awk -v place="$town" 'BEGIN { split(place, at, " "); printf "%.6f,%.6f,60,2000,70\n", at[1], at[2] - 0.08 }' >"$work/start"
"$bin/landmass-nav" --straight "$(cat "$work/start")" --seconds 12 --out "$work/flight.log" >"$out" 2>"$last_error"
printf '0 range 4\n5 picture map\n6 sar %s 2\n11 picture patch\n' "$town" >"$work/ku.script"
printf '0 range 10\n5 picture map\n6 sar %s 2\n11 picture patch\n' "$town" >"$work/x.script"

# ---- the text ----
"$bin/landmass-radar" print >"$work/x.radar"
check 'the built-in table passes its own check' exits 0 "$bin/landmass-radar" check "$work/x.radar"
"$bin/landmass-radar" record "$work/x.radar" "$work/x.record" 2>"$last_error"
"$bin/landmass-radar" print "$work/x.record" >"$work/again.radar"
check 'a record printed is the text that it was made of' cmp -s "$work/x.radar" "$work/again.radar"
check 'the shipped Ku table is sound' exits 0 "$bin/landmass-radar" check $ku
check 'and its wavelength is of its band' test ! -s "$last_error"
sed 's/^wavelength_um .*/wavelength_um = 31228 um/' $ku >"$work/slip.radar"
check 'a wavelength of another band is warned of' exits 0 "$bin/landmass-radar" check "$work/slip.radar"
check 'with its frequency' said '31228 um are 9.6 GHz, and Ku band is 12 to 18 GHz'

# ---- the image ----
check 'the scene is built for Ku, with its radar' image ku ku --radar $ku
check 'and for X, without one' image x x
check 'every byte of the image is right' exits 0 "$bin/landmass-db" verify "$work/ku.lmdb"
check 'and verify names sensor and radar' printed '^sensor: KU; radar: KU-1$'
# A bit of the table, which lies before the manifest.
cp "$work/ku.lmdb" "$work/damaged.lmdb"
at=$(LC_ALL=C grep -abo 'KU-1' "$work/ku.lmdb" | head -n 1 | cut -d: -f1)
printf 'Q' | dd of="$work/damaged.lmdb" bs=1 seek="$at" conv=notrunc 2>/dev/null
check 'a damaged table is a fault of the image' exits 1 "$bin/landmass-db" verify "$work/damaged.lmdb"
check 'that is named' printed 'section RADAR: its length or its checksum does not fit it'
exits 0 "$bin/landmass-db" inspect "$work/ku.lmdb"
check 'inspect names the sensor' printed '^sensor  *KU$'
check 'and the radar' printed '^radar  *KU-1$'
"$bin/landmass-radar" print "$work/ku.lmdb" >"$work/of-image.radar"
"$bin/landmass-radar" record "$work/of-image.radar" "$work/of-image.record" 2>"$last_error"
"$bin/landmass-radar" record $ku "$work/ku.record" 2>"$last_error"
check 'the table in the image is that of the file' cmp -s "$work/of-image.record" "$work/ku.record"
check 'a Ku radar for reflectivity at X is refused' exits 1 "$bin/landmass-db" build --classes $classes \
    --class-raster "$work/scene/truth.tif" --reflectivity "$work/x.tif" --terrain "$work/scene/terrain.tif" \
    --radar $ku --out "$work/none.lmdb"
check 'and both bands are named' said 'is a radar of Ku band, and the image is for X band'

# ---- the flight ----
check 'the Ku image flies with its own radar: 4 miles is a scale, the built-in one has none' \
    fly ku ku.script --db "$work/ku.lmdb"
check 'nothing was refused' printed 'commands refused 0'
check 'its map is lit' test "$(lit ku/map)" -gt 20000
check 'and its patch' test "$(lit ku/patch)" -gt 20000
check 'the X image flies with the built-in radar' fly x x.script --db "$work/x.lmdb"
check 'the picture of the Ku radar is another' sh -c "! cmp -s $work/ku/patch.png $work/x/patch.png"
check 'a table on the command line wins over that of the image' fly named x.script --db "$work/ku.lmdb" \
    --radar "$work/x.radar"
check 'an X radar refuses the Ku image' said 'reflectivity is of band KU, the radar.s is X'
check 'and shows nothing but words' test "$(lit named/map)" -lt 20000
check 'the Ku radar refuses the X image' fly other ku.script --db "$work/x.lmdb" --radar $ku
check 'and says so' said 'reflectivity is of band X, the radar.s is KU'

finish
