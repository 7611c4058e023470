#!/bin/sh
# The golden pictures drawn by the panel's processor, in qemu-user, are those of the PC; and so is what its own forms of
# single loops give.
set -u
build=${BUILD:-build/bench-linux}
arm64=build/panel-linux-arm64/bin/tests/golden
pictures='an ARM64 panel draws the golden pictures, bit for bit'
loops='loops written for the vectors of Arm give what their twins in plain C do, bit for bit'

missing() {
    echo "ok 1 # SKIP $pictures"
    echo "ok 2 # SKIP $loops"
    echo "# skipped: $1 is missing: run make deps"
    echo '1..2'
    exit 0
}
command -v aarch64-linux-gnu-gcc >/dev/null || missing 'the cross compiler aarch64-linux-gnu-gcc'
command -v qemu-aarch64-static >/dev/null || missing 'qemu-aarch64-static'

# same NUMBER STATEMENT EXPECTED PROGRAM: what the program prints there is what is expected.
same() {
    printed=$build/tmp/${4##*/}-arm64
    if timeout -k 2 600 qemu-aarch64-static "$4" </dev/null >"$printed" && diff "$3" "$printed"; then
        echo "ok $1 - $2"
    else
        echo "not ok $1 - $2"
    fi
}
mkdir -p "$build/tmp"
same 1 "$pictures" tests/golden/pictures.golden $arm64/golden
"$build/bin/tests/golden/twins" >"$build/tmp/twins"
same 2 "$loops" "$build/tmp/twins" $arm64/twins
echo '1..2'
