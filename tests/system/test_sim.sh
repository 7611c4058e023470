#!/bin/sh
# landmass-sim as its user runs it: a database and a log from files, pictures into a folder, every mistake told apart.
set -u
build=${BUILD:-build/bench-linux}
here=tests/system
sim=$build/bin/landmass-sim
tool=$build/bin/tests/system/test_sim_tool
work=$build/tmp/test_sim
rm -rf "$work"
mkdir -p "$work"
# shellcheck source=tests/system/test_sim_tap.sh
. $here/test_sim_tap.sh

db=$work/small.lmdb
log=$work/flight.log
script=$work/flight.script
"$tool" image "$db" || exit 1
"$tool" break-fine "$work/broken.lmdb" || exit 1
"$tool" leave-fine-out "$work/coarse.lmdb" || exit 1
"$build/bin/landmass-nav" --straight 45.97,11,0,2000,150 --seconds 4 --quiet --out "$log" || exit 1
cat >"$script" <<END
# 10 nm, then a patch
0    range 10
1.5  sar 46.02 11.03 5
3.9  picture patch
END

fly() { # NAME OPTIONS...: the standard flight with pictures in $work/NAME
    folder=$work/$1
    shift
    exits 0 "$sim" --db "$db" --bus "$log" --script "$script" --png "$folder" --size 400x384 "$@"
}

same_pictures() {
    [ "$(ls "$work/$1")" = "$(ls "$work/$2")" ] || return 1
    for picture in "$work/$1"/*.png; do
        cmp "$picture" "$work/$2/${picture##*/}" || return 1
    done
}

number() { # of the summary, behind a word
    sed -n "s/.*$1 \([0-9]*\).*/\1/p" "$out" | head -n 1
}

number_before() { # a word
    sed -n "s/.*[^0-9]\([0-9][0-9]*\) $1.*/\1/p" "$out" | head -n 1
}

between() { # LOW HIGH NUMBER
    [ -n "$3" ] && [ "$3" -ge "$1" ] && [ "$3" -le "$2" ] || { echo "# '$3' is not in $1..$2"; false; }
}

pictures() {
    find "$work/$1" -name '*.png' | wc -l
}

differ_patch() {
    ! cmp -s "$work/$1/patch.png" "$work/$2/patch.png"
}

size_is() {
    [ "$("$tool" size "$1")" = "$2" ]
}

warnings() { # pixels of the warnings' colour
    "$tool" pixels "$1" FFB020
}

check 'a flight ends with status 0' fly first
check 'with nothing on standard error' test ! -s "$last_error"
check 'frames: thirty a second' between 117 124 "$(number frames)"
check 'lines: 256 a second of ground map, then a patch of 256' between 560 700 "$(number lines)"
check 'none dropped' printed '\(0 dropped\)'
check 'a picture in thirty frames and the one of the script' test "$(pictures first)" -eq 5
check 'that the summary counts' test "$(number 'pictures written')" -eq 5
check 'every frame of the bus was read' test "$(number 'bus: canas17:')" -eq "$(wc -l <"$log")"
check 'no command was refused' test "$(number 'commands refused')" -eq 0
check 'tiles were read, and none failed' between 50 400 "$(number tiles:)"
check 'the faults are none' printed 'faults: 0 flash reads failed, 0 records corrupt, 0 requests dropped, 0 display'
check 'no warning is on the last picture' test "$(warnings "$work/first/patch.png")" -eq 0
check 'the pictures have the size asked for' size_is "$work/first/patch.png" 400x384

check 'a second flight ends well' fly second
check 'and gives the same pictures, byte for byte' same_pictures first second
check 'a flight with --seed 7 ends well' fly seeded --seed 7
check 'and gives other speckle' test "$(cmp -s "$work/first/patch.png" "$work/seeded/patch.png" && echo same)" = ''
check 'a flight with --every 10 ends well' fly tenth --every 10

# A log that begins later: as if its first two seconds had not been recorded.
awk -v skip=2 '{ t = substr($1, 2) + 0 } NR == 1 { t0 = t } t >= t0 + skip - 1e-7' "$log" >"$work/late.log"
check 'a flight can begin within the log' exits 0 "$sim" --db "$db" --bus "$log" --start 2 --png "$work/later" --every 10 --size 400x384
check 'and one from the rest of the log' exits 0 "$sim" --db "$db" --bus "$work/late.log" --png "$work/late" --every 10 --size 400x384
check 'has the same pictures' same_pictures later late
check 'behind the end of the log it cannot begin' exits 1 "$sim" --db "$db" --bus "$log" --start 5 --png "$work/later"
check 'and that is said' said '--start: .*flight.log ends before 5 s'
check '--start without a log makes no sense' exits 2 "$sim" --db "$db" --start 5 --seconds 1
check 'and leaves a picture in ten frames' between 13 14 "$(pictures tenth)"
check 'a flight with --every 0 ends well' fly none --every 0
check 'and leaves only what the script asks for' test "$(ls "$work/none")" = patch.png
check 'a flight with --seconds 1 ends well' fly short --seconds 1
check 'and stops there' between 29 32 "$(number frames)"
check '--quiet says nothing' fly quiet --quiet --seconds 0.1
check 'indeed' test ! -s "$out"
check 'the smallest glass' exits 0 "$sim" --db "$db" --bus "$log" --script "$script" --png "$work/least" --size 256x256
check 'has that size' size_is "$work/least/patch.png" 256x256
check 'a glass with choices' exits 0 "$sim" --db "$db" --bus "$log" --seconds 1.5 --png "$work/chosen" --glass whole --glass borders
check 'a choice that no glass has' exits 2 "$sim" --db "$db" --bus "$log" --glass oval
check 'the largest glass' exits 0 "$sim" --db "$db" --bus "$log" --seconds 0.5 --png "$work/most" --size 1024x1024
check 'has that size' size_is "$work/most/frame-00000.png" 1024x1024
check 'a flight without pictures' exits 0 "$sim" --db "$db" --bus "$log" --seconds 0.5
check 'a flight without a bus' exits 0 "$sim" --db "$db" --seconds 2 --png "$work/no-bus"
check 'shows that it has none' between 100 100000 "$(warnings "$work/no-bus/frame-00030.png")"

# The database
check 'a missing database fails' exits 1 "$sim" --db "$work/nosuch.lmdb" --bus "$log"
check 'and is named with its cause and remedy' said 'nosuch.lmdb: cannot be opened: No such file.*; landmass-db build'
head -c 3000000 "$db" >"$work/cut.lmdb"
check 'a truncated database is flown' exits 0 "$sim" --db "$work/cut.lmdb" --bus "$log" --seconds 1.2 --png "$work/cut"
check 'with a warning that names it' said 'cut.lmdb: warning: is no usable flash image; landmass-db verify'
check 'a summary that says so' printed 'database: not usable'
check 'and on the glass' between 100 100000 "$(warnings "$work/cut/frame-00030.png")"
: >"$work/empty.lmdb"
check 'an empty database is flown likewise' exits 0 "$sim" --db "$work/empty.lmdb" --bus "$log" --seconds 0.2
check 'with that warning' said 'empty.lmdb: warning: is no usable flash image'
"$sim" --db "$work" --bus "$log" --seconds 0.2 >"$out" 2>"$last_error"
check 'a folder in place of the database is told by name' said "$work: "
check 'a database whose fine levels are damaged is flown to the end' \
    exits 0 "$sim" --db "$work/broken.lmdb" --bus "$log" --script "$script" --png "$work/broken" --size 400x384
check 'with the sweep as before' between 560 700 "$(number lines)"
check 'each bad record counted' between 20 2000 "$(number_before 'records corrupt')"
check 'answered by a coarser one' between 1000 100000000 "$(number_before 'answered by a coarser')"
check 'and the glass says TILE' between 50 100000 "$(warnings "$work/broken/frame-00060.png")"
check 'a database without its fine levels is flown to the end' \
    exits 0 "$sim" --db "$work/coarse.lmdb" --bus "$log" --script "$script" --png "$work/coarse" --size 400x384
check 'with the sweep as before' between 560 700 "$(number lines)"
check 'which is no fault' printed 'faults: 0 flash reads failed, 0 records corrupt'
check 'and no warning' test "$(warnings "$work/coarse/patch.png")" -eq 0
check 'but a coarser picture' test "$(cmp -s "$work/first/patch.png" "$work/coarse/patch.png" && echo same)" = ''

# The bus
check 'a missing log fails' exits 1 "$sim" --db "$db" --bus "$work/nosuch.log"
check 'and is named' said 'nosuch.log: cannot be opened'
{
    head -n 100 "$log"
    echo 'what is this'
    echo '(12.5) can0 40C#00'
    tail -n +101 "$log"
} >"$work/dirty.log"
check 'a log with bad lines is flown' exits 0 "$sim" --db "$db" --bus "$work/dirty.log" --seconds 1
check 'they are named by number' said 'dirty.log line 101: warning: .*; the line is skipped'
check 'and counted' printed ', 2 malformed'
check 'an interface that is not there fails' exits 1 "$sim" --db "$db" --can nosuch0 --seconds 1
check 'and is named' said 'landmass-sim: nosuch0: '

# Weather on the bus: told until 3 s, stale from 6 s on, removed by 13 s
cat >"$work/weather.script" <<END
0    range 10
2.6  picture sector
2.7  sar 46.02 11.03 5
5    picture patch
5.1  gm
7.5  picture stale
16   picture gone
END
black() { # pixels that are
    "$tool" pixels "$work/$1.png" 000000
}
for weather in fair storm clear; do
    case $weather in
    fair) options= ;;
    storm) options='--rain 46.02,11.03,1500,60,0,3' ;;
    clear) options='--rain 46.02,11.03,1500,60,0,3 --weather-clear 4' ;;
    esac
    # shellcheck disable=SC2086 # an option and its value
    "$build/bin/landmass-nav" --straight 45.97,11,0,2000,150 --seconds 17 --quiet $options --out "$work/$weather.log" || exit 1
    check "a flight with $weather weather on the bus ends well" exits 0 "$sim" --db "$db" --bus "$work/$weather.log" \
        --script "$work/weather.script" --png "$work/$weather" --size 400x384 --every 0
done
check 'the summary says what was taken' printed 'weather: 3 sets taken, 0 torn'
# Two targets, one of them removed after 3 s: told at 0, 1 and 2 s, and at each second of the flight
"$build/bin/landmass-nav" --straight 45.97,11,0,2000,150 --seconds 6 --quiet --live 1,3,46.02,11,90,15 \
    --live 2,13,46.03,11,90,8,-9999,0,0,3 --out "$work/live.log" || exit 1
check 'a flight with live targets ends well' exits 0 "$sim" --db "$db" --bus "$work/live.log" --json "$work/live.json"
check 'the summary says what was heard of them' printed \
    'live targets: 9 sets taken, 0 torn, 0 out of range, 0 frames of a second sender; 1 removed, 0 aged out, 1 there'
tr -d ' \n' <"$work/live.json" >"$work/live.one"
check 'and so does the report' grep -q '"live":{"sets":9,' "$work/live.one"
# A track that the transmitter interrupts
cat >"$work/track.script" <<END
0    range 10
1    cursor 46.02 11
1.5  track
3    osb 4
4    osb 4
5    drop
END
check 'a flight that tracks ends well' exits 0 "$sim" --db "$db" --bus "$work/live.log" --script "$work/track.script" --json "$work/track.json"
check 'the summary says what was tracked' printed 'FTT from 1.50 s, held from 1.5'
check 'why it broke' printed 's: silent; over at 5.0'
tr -d ' \n' <"$work/track.json" >"$work/track.one"
check 'and so does the report' grep -q '"tracks_begun":1,"tracks":\[{"kind":"FTT","state":"off","loss":"none","begun_s":1.5' "$work/track.one"
# One clock told by two, as one node
"$build/bin/landmass-nav" --straight 45.97,11,0,2000,150 --seconds 3 --quiet --exercise-clock 3600 --out "$work/clock.log" || exit 1
printf '1 clock 100\n' >"$work/clock.script"
printf '1 break frozen-video\n' >"$work/break.script"
check 'a clock of the bus and one of the script are refused' \
    exits 1 "$sim" --db "$db" --bus "$work/clock.log" --script "$work/clock.script"
check 'with cause and remedy' said 'clock.script: tells what the bus tells, too: frame 182'
check 'the bus may tell the clock, and the script what is broken' \
    exits 0 "$sim" --db "$db" --bus "$work/clock.log" --script "$work/break.script"
check 'rain on the bus is in the sector' test "$(cmp -s "$work/fair/sector.png" "$work/storm/sector.png" && echo same)" = ''
check 'and lies over a patch, which is not darker for it' \
    test "$(cmp -s "$work/fair/patch.png" "$work/storm/patch.png" && echo same)" = '' -a "$(black storm/patch)" -le "$(black fair/patch)"
check 'it is not flagged while it is told' test "$(warnings "$work/storm/sector.png")" -eq 0
check 'when it is not told any more it stays for a while' \
    test "$(cmp -s "$work/fair/stale.png" "$work/storm/stale.png" && echo same)" = ''
check 'flagged' between 20 1000 "$(warnings "$work/storm/stale.png")"
check 'then it is gone, to the last pixel' cmp "$work/fair/gone.png" "$work/storm/gone.png"
check 'it is gone at once when the bus takes it away' cmp "$work/fair/stale.png" "$work/clear/stale.png"
check 'having been there' cmp "$work/storm/sector.png" "$work/clear/sector.png"

# The script
bad_script() { # NUMBER LINE...: the last line is the wrong one
    line=$1
    shift
    printf '%s\n' "$@" >"$work/bad.script"
    exits 1 "$sim" --db "$db" --bus "$log" --seconds 1 --script "$work/bad.script" && said "bad.script line $line: "
}
check 'a command that is none is named by file and line' bad_script 3 '# remark' '0 gm' '1 fly home'
check 'so is a scale that is none' bad_script 1 '0 range 30'
check 'so is a place beyond the pole' bad_script 2 '' '0 sar 91 11 5'
check 'so is time that goes back' bad_script 2 '5 gm' '4 gm'
check 'so is a picture outside the folder' bad_script 1 '0 picture ../up'
check 'so is a malfunction that is none, with those that are' bad_script 2 '0 gm' '1 break heart'
check 'and what to write instead' said '`break heart` needs one of no-transmit, .*, dead-key=N; landmass-sim --help'
check 'so is a pace without a clock' bad_script 1 '0 clock rate 2'
printf '0 clock 100\n2 clock rate 0\n1 break weak-transmit=20\n' | sort -n >"$work/drill.script"
check 'an exercise of the script is flown' exits 0 "$sim" --db "$db" --bus "$log" --seconds 4 --script "$work/drill.script" \
    --record "$work/drill.log" --quiet
"$build/bin/landmass-bus" decode "$work/drill.log" >"$work/drill.txt" 2>/dev/null
check 'its frames are in the recording' grep -q 'malfunction' "$work/drill.txt"
check 'which shows the same again' exits 0 "$sim" --db "$db" --replay "$work/drill.log" --quiet
check 'it is refused where its node is not heard' exits 1 "$sim" --db "$db" --bus "$log" --script "$work/drill.script" --nodes 1,9
check 'with the node' said 'of node 30, which --nodes leaves out; name it, too'
check 'and where the bus has no such frames' exits 1 "$sim" --db "$db" --bus "$log" --script "$work/drill.script" --profile xcsoar
check 'with the profile that has them' said 'fly with --profile canas17'
check 'a missing script is named' exits 1 "$sim" --db "$db" --bus "$log" --script "$work/nosuch.script"
check 'with its cause' said 'nosuch.script: cannot be opened: No such file'
printf '%s\n' '0 range 20' '# far away' '0.5 sar 80 0 5' '0.6 osb 1' '0.9 range 80' >"$work/refused.script"
check 'a script with commands that the unit refuses is flown to the end' \
    exits 0 "$sim" --db "$db" --bus "$log" --seconds 1 --script "$work/refused.script"
check 'each is reported with line and reason' said 'refused.script line 3: warning: refused: the patch is too far; '
check 'one behind a key, too' said 'refused.script line 5: warning: refused: out of range, or mode'
check 'and none but those' test "$(grep -c refused: "$last_error")" -eq 2
printf '0 picture here\n' >"$work/picture.script"
check 'a picture asked for without a folder' exits 1 "$sim" --db "$db" --bus "$log" --script "$work/picture.script"
check 'is told how to give one' said 'add --png DIR'

# The pictures
check 'a folder that cannot be made fails' exits 1 "$sim" --db "$db" --bus "$log" --png "$db/below"
check 'and is named with its cause' said 'small.lmdb/below: cannot be made: Not a directory'
check 'a file in place of the folder fails' exits 1 "$sim" --db "$db" --bus "$log" --png "$log"
check 'and is named' said 'flight.log'

# The command line
wrong() {
    exits 2 "$sim" "$@" && test -s "$last_error" && test ! -s "$out"
}
check 'an unknown option is a wrong command line' wrong --db "$db" --bus "$log" --nosuch
check 'so is a stray word' wrong --db "$db" --bus "$log" stray
check 'so is no database' wrong --bus "$log"
check 'so are two buses' wrong --db "$db" --bus "$log" --can can0
check 'so is a run without an end' wrong --db "$db"
for bad in '--size 255x400' '--size 400x1025' '--size 400' '--size axb' '--every -1' '--every x' '--seconds 0' \
    '--seconds -1' '--seconds nan' '--seconds inf' '--seconds 1e9' '--seed -1' '--seed x' '--seed 1.5'; do
    # shellcheck disable=SC2086 # an option and its value
    check "so is $bad" wrong --db "$db" --bus "$log" $bad
done

# A recording and its replay
again="$work/again"
check 'a flight is recorded' exits 0 "$sim" --db "$db" --bus "$log" --seconds 3 --node 20 --reports \
    --png "$work/once" --every 10 --record "$work/rec.log"
check 'and shown again' exits 0 "$sim" --db "$db" --replay "$work/rec.log" --png "$again" --every 10
check 'with the same pictures' diff -r "$work/once" "$again"
check 'and no departure' grep -qE 'failed 0; departures 0$' "$out"
check 'from a time on only the pictures after it' exits 0 "$sim" --db "$db" --replay "$work/rec.log" --from 2 \
    --png "$work/afterwards" --every 10
check 'which are fewer' test "$(pictures afterwards)" -lt "$(pictures again)"
check 'another image is refused' exits 1 "$sim" --db "$work/coarse.lmdb" --replay "$work/rec.log"
check 'and named' said 'made with another image'
check 'unless told, and then the difference is not silent' exits 0 "$sim" --db "$work/coarse.lmdb" \
    --replay "$work/rec.log" --replay-anyway
check 'in the figures' grep -qvE 'failed 0; departures 0$' "$out"
grep -v '1F4C4D01#' "$work/rec.log" >"$work/stepless.log"
check 'a recording without its steps is refused' exits 1 "$sim" --db "$db" --replay "$work/stepless.log"
# Latitudes for most of a second: a single one is extrapolated, and a value that stays 0 is missed by nobody
awk '/ 40C#/ && ++n >= 7 && n <= 40 {next} {print}' "$work/rec.log" >"$work/cut.log"
check 'lines that were taken out are seen' exits 1 "$sim" --db "$db" --replay "$work/cut.log"
check 'and told with its time' said 'not the one recorded: from [0-9]'
head -c 50001 "$work/rec.log" >"$work/torn.log"
check 'a torn recording is shown to its end' exits 0 "$sim" --db "$db" --replay "$work/torn.log"
check 'which is told' grep -q 'the recording has no end' "$out"
check 'a log of the bus is no recording' exits 1 "$sim" --db "$db" --replay "$log"
check 'a recording has its own bus' wrong --db "$db" --replay "$work/rec.log" --bus "$log"
# The head is a blob over the first lines; its last word is the identity of the build.
python3 - "$work/rec.log" "$work/other.log" <<'END'
import sys
lines = open(sys.argv[1]).read().splitlines()
head = [i for i, line in enumerate(lines) if 'unit 1F4C4D00#' in line]
digits = ''.join(lines[i].split('#')[1] for i in head)
digits = digits[:-24] + b'abcdefabcdef'.hex().upper()
for n, i in enumerate(head):
    lines[i] = lines[i].split('#')[0] + '#' + digits[16 * n:16 * n + 16]
open(sys.argv[2], 'w').write('\n'.join(lines) + '\n')
END
check 'a recording of another build is shown' exits 0 "$sim" --db "$db" --replay "$work/other.log"
check 'which is told' said 'made by build abcdefabcdef of the firmware'

# Two interfaces in one recording
check 'a flight of two interfaces is recorded' exits 0 "$sim" --db "$db" --bus "$log" --bus2 "$log" --profile2 xcsoar \
    --seconds 2 --png "$work/two" --every 10 --record "$work/two.log"
check 'both of them' test "$(grep -c ' can1 ' "$work/two.log")" -gt 50
check 'and shown again' exits 0 "$sim" --db "$db" --replay "$work/two.log" --profile2 xcsoar --png "$work/two-again" \
    --every 10
check 'with the same pictures' diff -r "$work/two" "$work/two-again"
check 'and no departure' grep -qE 'failed 0; departures 0$' "$out"
check 'under another table of the second it is refused' exits 1 "$sim" --db "$db" --replay "$work/two.log"

# Two images in one recording
"$tool" range "$work/range.lmdb" || exit 1
"$tool" other-range "$work/other-range.lmdb" || exit 1
printf '0 range 10\n0.5 sar 46.02 11.03 5\n' >"$work/range.script"
check 'a flight over two images is recorded' exits 0 "$sim" --db "$db" --db2 "$work/range.lmdb" --bus "$log" \
    --script "$work/range.script" --seconds 3 --png "$work/beside" --every 10 --record "$work/beside.log"
check 'and shown again' exits 0 "$sim" --db "$db" --db2 "$work/range.lmdb" --replay "$work/beside.log" \
    --png "$work/beside-again" --every 10
check 'with the same pictures' diff -r "$work/beside" "$work/beside-again"
check 'and no departure' grep -qE 'failed 0; departures 0$' "$out"
check 'without the second it is refused' exits 1 "$sim" --db "$db" --replay "$work/beside.log"
check 'and said why' said 'made with another second image'
check 'with another one too' exits 1 "$sim" --db "$db" --db2 "$work/other-range.lmdb" --replay "$work/beside.log"
check 'and said why again' said 'made with another second image'
check 'at another place it is refused as well' exits 1 "$sim" --db "$db" --db3 "$work/range.lmdb" \
    --replay "$work/beside.log"
check 'unless told' exits 0 "$sim" --db "$db" --db2 "$work/other-range.lmdb" --replay "$work/beside.log" --replay-anyway
check 'an image that the recording lacks is not shown' exits 0 "$sim" --db "$db" --db2 "$work/range.lmdb" \
    --replay "$work/rec.log"

# An image comes and goes in flight: a patch drawn behind it is that of a start with it, or without
patch="1.5 sar 46.02 11.03 5\n3.9 picture patch\n"
printf '%b' "0 range 10\n$patch" >"$work/start.script"
printf '%b' "0 range 10\n0.7 mount 2 $work/range.lmdb\n$patch" >"$work/mount.script"
printf '%b' "0 range 10\n0.7 unmount 2\n$patch" >"$work/unmount.script"
fixed="1.5 sarfrom 46.02 11.03 5 45 9000 2000"
printf '%b' "0 range 10\n$fixed\n3.9 picture patch\n" >"$work/fixed.script"
# one that is refused, one that is not there, a place that is taken, one that is free; then the half drawn patch begins again
printf '%b' "0 range 10\n0.2 mount 3 $log\n0.3 mount 4 $work/nosuch\n0.4 unmount 3\n0.5 mount 3 $work/range.lmdb
0.6 mount 3 $work/other-range.lmdb\n0.7 unmount 2\n$fixed\n1.6 unmount 3\n1.6 mount 3 $work/other-range.lmdb
3.9 picture patch\n" >"$work/changes.script"
fly_images() { # NAME SCRIPT OPTIONS...
    name=$1
    script=$work/$2.script
    shift 2
    fly "$name" --every 0 --record "$work/$name.log" "$@"
}
same_patch() {
    cmp "$work/$1/patch.png" "$work/$2/patch.png"
}
check 'a flight without the second image' fly_images alone start
check 'and with it from the start' fly_images two-images start --db2 "$work/range.lmdb"
check 'show different patches' differ_patch alone two-images
check 'an image comes in flight' fly_images came mount
check 'and the patch is that of the start with both' same_patch came two-images
check 'it goes in flight' fly_images went unmount --db2 "$work/range.lmdb"
check 'and the patch is that of the start with one' same_patch went alone
check 'images come and go, and bad ones are refused' fly_images changes changes
check 'the one that is no image' said 'flight.log: warning: is no usable flash image'
check 'the one that is not there' said "line 3: warning: $work/nosuch: cannot be opened"
check 'the one whose place is taken' said 'line 6: warning: an image is at place 3; unmount it first'
check 'the one that nobody mounted' said 'line 7: warning: no image is at place 2'
check 'no command was refused' test "$(number 'commands refused')" -eq 0
check 'with the other one from the start' fly_images other fixed --db3 "$work/other-range.lmdb"
# It is begun later; so the mark in the corner, which turns with each picture, may stand otherwise.
check 'the patch that was half drawn is the same at last' between 0 30 \
    "$("$tool" differ "$work/changes/patch.png" "$work/other/patch.png")"
check 'the recording of it is shown again' exits 0 "$sim" --db "$db" --db2 "$work/range.lmdb" \
    --replay "$work/came.log" --png "$work/came-again" --every 1
check 'without a departure' grep -qE 'failed 0; departures 0$' "$out"
check 'without the image it ends there' exits 1 "$sim" --db "$db" --replay "$work/came.log"
check 'and says why' said 'an image comes here that is not at hand'
printf '0 mount 5 x\n' >"$work/fifth.script"
check 'there is no fifth image' exits 1 "$sim" --db "$db" --bus "$log" --script "$work/fifth.script"
printf '%b' "0 range 10\n0.5 unmount 1\n$fixed\n3.9 picture patch\n" >"$work/first-goes.script"
printf '%b' "0 range 10\n0.5 unmount 1\n0.7 mount 1 $db\n$fixed\n3.9 picture patch\n" >"$work/first-back.script"
check 'the first one goes' fly_images first-goes first-goes --db2 "$work/range.lmdb"
check 'no command was refused then' test "$(number 'commands refused')" -eq 0
check 'both from the start' fly_images both fixed --db2 "$work/range.lmdb"
check 'the patch has changed' differ_patch first-goes both
check 'the first one goes and comes back' fly_images first-back first-back --db2 "$work/range.lmdb"
check 'and the patch is that of the start with both' same_patch first-back both
check 'a recording of it is shown again' exits 0 "$sim" --db "$db" --db2 "$work/range.lmdb" \
    --replay "$work/first-goes.log" --png "$work/first-goes-again" --every 1
check 'with no departure' grep -qE 'failed 0; departures 0$' "$out"
check 'the only image stays' fly_images only first-goes
check 'and it is said why' said 'line 2: warning: the image at place 1 is the only one; it stays'
script=$work/flight.script

# The window
check 'without a screen the flight goes on' \
    env SDL_VIDEODRIVER=nosuch "$sim" --db "$db" --bus "$log" --seconds 0.3 --window --quiet 2>"$last_error"
check 'with a warning' said 'window: warning: no screen'
if command -v xvfb-run >/dev/null; then
    check 'a flight in a window on a virtual screen ends with status 0' \
        exits 0 env SDL_VIDEODRIVER=x11 SDL_RENDER_DRIVER=software xvfb-run -a "$sim" --db "$db" --bus "$log" \
        --seconds 0.5 --window
    check 'and complains of nothing' test ! -s "$last_error"
else
    skip 'a flight in a window' 'no xvfb-run here'
fi
finish
