#!/bin/sh
# A bus of one's own without a compiler: CANaerospace moved to other identifiers, and a text table that says so. Whoever
# hears it by that table flies the flight that others fly by canas17, pixel by pixel.
set -u
build=${BUILD:-build/bench-linux}
bin=$build/bin
work=$build/tmp/test_bus_table
rm -rf "$work"
mkdir -p "$work"
# shellcheck source=tests/system/test_sim_tap.sh
. tests/system/test_sim_tap.sh

classes=host-sim/programs/db/classes/heaton6.classes
shift=400

image() { # NAME OPTIONS...
    name=$1
    shift
    exits 0 "$bin/landmass-db" build --classes $classes --class-raster "$work/scene/truth.tif" \
        --terrain "$work/scene/terrain.tif" --out "$work/$name.lmdb" "$@"
}

fly() { # NAME OPTIONS...: pictures into $work/NAME
    name=$1
    shift
    exits 0 "$bin/landmass-sim" --png "$work/$name" --every 30 --size 256x256 "$@"
}

same() { # NAME NAME: the pictures of two flights
    [ -n "$(ls "$work/$1")" ] && diff -r "$work/$1" "$work/$2" >/dev/null
}

"$bin/landmass-scene" --out "$work/scene" --size 200 --cell 40 >"$out" 2>"$last_error"
town=$(awk '/^# place/ { is_list = 1 } is_list && $1 == "town" { print $2, $3 }' "$work/scene/scene.txt")
awk -v place="$town" 'BEGIN { split(place, at, " "); printf "%.6f,%.6f,60,2000,70\n", at[1], at[2] - 0.08 }' >"$work/start"
"$bin/landmass-nav" --straight "$(cat "$work/start")" --seconds 4 --out "$work/plain.log" >"$out" 2>"$last_error"

# The table of canas17, as text with other identifiers; and what does the same to a log.
"$bin/landmass-bus" table >"$work/rows"
{
    printf 'profile moved\nframing canaerospace\n'
    awk -F ' *[|] *' -v shift=$shift '$2 ~ /^[0-9]+$/ && $2 < 1500 {
        gsub(/, /, ",", $6)
        printf "item \"%s\" field=%s id=%d types=%s per-unit=%d range=%s period=%s stale=%s dead=%s priority=%s\n",
            $4, $5, $2 + shift, $6, ($6 ~ /LONG/ ? 10000000 : 1), $8, $10, $11, $12, $13
    }' "$work/rows"
} >"$work/moved.bus"
awk -F ' *[|] *' -v shift=$shift '$2 ~ /^[0-9]+$/ { printf "s/ %s#/ %X#/;t\n", $3, $2 + shift }' "$work/rows" >"$work/move.sed"
sed -f "$work/move.sed" "$work/plain.log" >"$work/moved.log"

image plain
image table --bus-table "$work/moved.bus"
check 'the flight by canas17 is flown' fly plain --db "$work/plain.lmdb" --bus "$work/plain.log"
check 'moved to other identifiers it is not heard' fly deaf --db "$work/plain.lmdb" --bus "$work/moved.log"
same plain deaf && deaf=no || deaf=yes
check 'and the glass shows so' test $deaf = yes
check 'by the table of a file it is' fly file --db "$work/plain.lmdb" --bus "$work/moved.log" --table "$work/moved.bus"
check 'the summary names it' printed '^bus: moved: '
check 'and the glass is the same, pixel by pixel' same plain file
check 'so it is by the table of the image' fly image --db "$work/table.lmdb" --bus "$work/moved.log"
check 'pixel by pixel' same plain image
check 'a profile that is named wins over the image' fly named --db "$work/table.lmdb" --bus "$work/plain.log" --profile canas17
check 'pixel by pixel, too' same plain named
check 'verify finds nothing wrong with the image' exits 0 "$bin/landmass-db" verify "$work/table.lmdb"
exits 0 "$bin/landmass-db" inspect "$work/table.lmdb"
check 'inspect names the table' printed '^bus table  *moved$'

# Attitude, velocity and heading on other identifiers than the position: on one interface, and on two. The second log
# begins with the first's first frame, so that both have one clock.
near='^[^#]* (1[0-9A-F][0-9A-F]|4[67][0-9A-F])#'
sed -E "/$near/"'!d' "$work/plain.log" >"$work/rest.log"
{
    head -n 1 "$work/plain.log"
    sed -f "$work/move.sed" "$work/rest.log"
} >"$work/second.log"
sed -E "/$near/d" "$work/plain.log" >"$work/first.log"
{ head -n 1 "$work/plain.log"; cat "$work/first.log"; } | uniq >"$work/begun.log" && mv "$work/begun.log" "$work/first.log"
{
    sed 's/^/0 /' "$work/first.log"
    sed -f "$work/move.sed" "$work/rest.log" | sed 's/^/1 /'
} | sort -s -k 2,2 | cut -d ' ' -f 2- >"$work/mixed.log"
check 'two tables are heard side by side on one interface' fly beside --db "$work/plain.lmdb" --bus "$work/mixed.log" \
    --profile canas17 --table "$work/moved.bus"
check 'pixel by pixel' same plain beside
check 'and by two interfaces' fly two --db "$work/plain.lmdb" --bus "$work/first.log" \
    --bus2 "$work/second.log" --table2 "$work/moved.bus"
check 'pixel by pixel' same plain two
check 'without the second the flight is another' fly one --db "$work/plain.lmdb" --bus "$work/first.log"
same plain one && lost=no || lost=yes
check 'as the glass shows' test $lost = yes
sed 's/id=1436 /id=1036 /' "$work/moved.bus" >"$work/clash.bus"
check 'two tables that claim one identifier are refused' exits 1 "$bin/landmass-sim" --db "$work/plain.lmdb" \
    --bus "$work/mixed.log" --profile canas17 --table "$work/clash.bus"
check 'which is named' said 'moved: and canas17 both take frame 40C; hear them on two interfaces'
check 'a second table needs a second interface' exits 2 "$bin/landmass-sim" --db "$work/plain.lmdb" \
    --bus "$work/mixed.log" --table2 "$work/moved.bus"

# A damaged record, and mistakes of a text.
cp "$work/table.lmdb" "$work/damaged.lmdb"
at=$(LC_ALL=C grep -abo 'steerpoint-latitude' "$work/table.lmdb" | head -n 1 | cut -d: -f1)
printf 'x' | dd of="$work/damaged.lmdb" bs=1 seek="$at" conv=notrunc 2>/dev/null
check 'a damaged table is a fault of the image' exits 1 "$bin/landmass-db" verify "$work/damaged.lmdb"
check 'that is named' printed 'section BUS: its length or its checksum does not fit it'
check 'the display refuses that image' fly damaged --db "$work/damaged.lmdb" --bus "$work/moved.log"
check 'and says so' said 'is no usable flash image'
sed '4s/stale=300/stale=3/' "$work/moved.bus" >"$work/wrong.bus"
check 'a mistake of the text ends the bench' exits 1 "$bin/landmass-sim" --db "$work/plain.lmdb" --bus "$work/moved.log" \
    --table "$work/wrong.bus"
check 'with file, line and reason' said 'wrong.bus line 4: period, stale and dead: must rise in this order'
check 'and ends the builder' exits 1 "$bin/landmass-db" build --classes $classes --class-raster "$work/scene/truth.tif" \
    --terrain "$work/scene/terrain.tif" --out "$work/none.lmdb" --bus-table "$work/wrong.bus"
check 'likewise' said 'wrong.bus line 4: '
printf 'can.table = %s\n' "$(realpath "$work/wrong.bus")" >"$work/panel.conf"
check 'the check of the panel finds it' exits 1 "$bin/landmass-panel" --check --config "$work/panel.conf"
check 'likewise, too' said 'wrong.bus line 4: period, stale and dead: must rise in this order'
printf 'can.table = %s\n' "$(realpath "$work/moved.bus")" >"$work/panel.conf"
check 'and nothing in the right one' exits 0 "$bin/landmass-panel" --check --config "$work/panel.conf"
finish
