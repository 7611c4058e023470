#!/bin/sh
# Each kernel for ARM64 gives what its twin in plain C does: both are in one program, which qemu-user runs.
set -u
statement='kernels written for the vectors of Arm give what their twins in plain C do, bit for bit'
for tool in aarch64-linux-gnu-gcc qemu-aarch64-static; do
    command -v $tool >/dev/null || {
        echo "ok 1 - $statement # SKIP"
        echo "# skipped: $tool is not installed (make deps)"
        echo '1..1'
        exit 0
    }
done
exec timeout -k 2 600 qemu-aarch64-static build/panel-linux-arm64/bin/tests/kernels/twins </dev/null
