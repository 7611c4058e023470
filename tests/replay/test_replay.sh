#!/bin/sh
# A recorded flight is shown again bit for bit by another compiler's build, and by the panel's
# processor in qemu-user. Usage: test_replay [FLIGHTS], 20 unless said.
set -u
flights=${1:-20}
build=${BUILD:-build/bench-linux}
programs=$build/bin/tests/replay
arm64=build/panel-linux-arm64/bin/tests/replay/flights
number=0

case_is() {
    number=$((number + 1))
    name=$1
    shift
    if "$@" </dev/null; then
        echo "ok $number - $name"
    else
        echo "not ok $number - $name"
    fi
}

skip() {
    number=$((number + 1))
    echo "ok $number # SKIP $1"
    echo "# skipped: $2"
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
image=$folder/image.lmdb
"$programs/flights" image "$image" || exit 1

mkdir "$folder/gcc"
record() {
    "$programs/flights" record "$image" "$folder/gcc" 1 "$flights" >"$folder/recorded" && cat "$folder/recorded"
}
case_is "$flights flights of random events are recorded" record
case_is 'pages were swapped with a partner' grep -q '^# [1-9][0-9]* pages swapped' "$folder/recorded"
case_is 'and flights began with the settings of others' grep -q 'unit 1F4C4D12#' "$folder/gcc/2.log"
echo "# $(cat "$folder/gcc"/*.sums | wc -l) pictures in $(du -sk "$folder/gcc" | cut -f1) KiB"
case_is 'the same build shows them again, every picture' "$programs/flights" replay "$image" "$folder/gcc" 1 "$flights"
case_is 'a step that is lost is seen in every one of them' "$programs/flights" lose "$image" "$folder/gcc" 1 "$flights"
if [ -x "$programs/flights-clang" ]; then
    case_is 'clang shows what gcc recorded' "$programs/flights-clang" replay "$image" "$folder/gcc" 1 "$flights"
fi
if [ -x "$programs/flights-sanitized" ]; then
    few=$((flights < 4 ? flights : 4))
    case_is "the sanitizers find nothing in $few of them" "$programs/flights-sanitized" replay "$image" "$folder/gcc" 1 "$few"
fi
# The panel itself, whose process is killed in flight: as far as it had written, the bench shows it.
panel_flies() { # FOLDER RUNNER PROGRAM...
    printf '%s\n' "database = $image" 'database.trust = any' 'database.serial = none' 'can = none' 'glass = none' 'stick = none' 'realtime.priority = 0' \
        'realtime.memory = free' "record = $1" >"$folder/panel.conf"
    where=$1
    shift
    timeout -k 2 -s KILL 5 "$@" --config "$folder/panel.conf" 2>/dev/null
    "${BUILD:-build/bench-linux}/bin/landmass-sim" --db "$image" --replay "$where/flight-00001-000.log" >"$folder/said" &&
        grep -q 'failed 0; departures 0; the recording has no end' "$folder/said" &&
        [ "$(sed -n 's/^replay: \([0-9]*\) steps.*/\1/p' "$folder/said")" -gt 300 ]
}
case_is 'what a panel had recorded when it was killed is shown' panel_flies "$folder/pc-panel" "$build/bin/landmass-panel"
arm_panel=build/panel-linux-arm64/bin/landmass-panel
if [ ! -x "$arm_panel" ] || ! command -v qemu-aarch64-static >/dev/null; then
    skip 'and of an ARM64 panel' 'the cross compiler or qemu-aarch64-static is missing: run make deps'
else
    case_is 'and of an ARM64 panel' panel_flies "$folder/arm64-panel" qemu-aarch64-static "$arm_panel"
fi
arm='an ARM64 panel shows what the PC recorded, and the PC what it recorded'
some=$((flights < 100 ? 3 : flights / 10))
if [ ! -x "$arm64" ]; then
    skip "$arm" 'the cross compiler aarch64-linux-gnu-gcc is missing: run make deps'
elif ! command -v qemu-aarch64-static >/dev/null; then
    skip "$arm" 'qemu-aarch64-static is missing: run make deps'
else
    case_is "an ARM64 panel shows $some of them" \
        timeout -k 2 3600 qemu-aarch64-static "$arm64" replay "$image" "$folder/gcc" 1 "$some"
    mkdir "$folder/arm64"
    case_is 'and records flights itself' \
        timeout -k 2 3600 qemu-aarch64-static "$arm64" record "$image" "$folder/arm64" 1 "$some"
    case_is 'which the PC shows again' "$programs/flights" replay "$image" "$folder/arm64" 1 "$some"
fi
echo "1..$number"
