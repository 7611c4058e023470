#!/bin/sh
# The golden pictures drawn by the panel's processor, in qemu-user, are those of the PC.
set -u
build=${BUILD:-build/bench-linux}
arm64=build/panel-linux-arm64/bin/tests/golden
pictures='an ARM64 panel draws the golden pictures, bit for bit'

missing() {
    echo "ok 1 # SKIP $pictures"
    echo "# skipped: $1 is missing: run make deps"
    echo '1..1'
    exit 0
}
command -v aarch64-linux-gnu-gcc >/dev/null || missing 'the cross compiler aarch64-linux-gnu-gcc'
command -v qemu-aarch64-static >/dev/null || missing 'qemu-aarch64-static'

mkdir -p "$build/tmp"
drawn=$build/tmp/golden-arm64
if timeout -k 2 600 qemu-aarch64-static $arm64/golden </dev/null >"$drawn" && diff tests/golden/pictures.golden "$drawn"; then
    echo "ok 1 - $pictures"
else
    echo "not ok 1 - $pictures"
fi
echo '1..1'
