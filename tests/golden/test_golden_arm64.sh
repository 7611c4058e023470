#!/bin/sh
# The golden pictures drawn by the panel's processor, in qemu-user, are those of the PC.
set -u
build=${BUILD:-build/bench-linux}
golden=build/panel-linux-arm64/bin/tests/golden/golden
statement='an ARM64 panel draws the golden pictures, bit for bit'

missing() {
    echo "ok 1 # SKIP $statement"
    echo "# skipped: $1 is missing: run make deps"
    echo '1..1'
    exit 0
}
command -v aarch64-linux-gnu-gcc >/dev/null || missing 'the cross compiler aarch64-linux-gnu-gcc'
command -v qemu-aarch64-static >/dev/null || missing 'qemu-aarch64-static'

mkdir -p "$build/tmp"
if timeout -k 2 600 qemu-aarch64-static "$golden" </dev/null >"$build/tmp/golden-arm64" &&
    diff tests/golden/pictures.golden "$build/tmp/golden-arm64"; then
    echo "ok 1 - $statement"
else
    echo "not ok 1 - $statement"
fi
echo '1..1'
