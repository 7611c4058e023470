#!/bin/sh
# The golden pictures on a Cortex-M7 in QEMU: the same firmware as 32-bit code, the same checksums.
set -u
build=${BUILD:-build/bench-linux}
bin=$build/bin/tests/cortex-m7
work=$build/tmp/cortex-m7
for tool in qemu-system-arm arm-none-eabi-gcc; do
    command -v $tool >/dev/null || {
        echo "ok 1 - a Cortex-M7 draws the golden pictures # SKIP"
        echo "# skipped: $tool is not installed (make deps)"
        echo "1..1"
        exit 0
    }
done
mkdir -p "$work"
"$build"/bin/tests/zcu102/golden_flash "$work/golden.img" || exit 1
elf=$PWD/$bin/golden.elf
(cd "$work" && timeout -k 2 200 qemu-system-arm -M mps2-an500 -display none -monitor none -serial null \
    -semihosting-config enable=on,target=native -kernel "$elf" </dev/null) >"$work/pictures" 2>&1
status=$?
rm -f "$work/golden.img"
number=1
failed=$status
[ $status -eq 0 ] || printf 'not '
echo "ok 1 - the firmware flies on a Cortex-M7"
while read -r name radar glass; do
    case $name in image-*) continue ;; esac
    number=$((number + 1))
    if ! grep -qx "$name $radar $glass" "$work/pictures"; then
        failed=1
        printf 'not '
    fi
    echo "ok $number - $name is drawn as on the PC"
done <tests/golden/pictures.golden
[ $status -eq 0 ] || sed 's/^/# /' "$work/pictures" | tail -n 5
echo "1..$number"
exit $failed
