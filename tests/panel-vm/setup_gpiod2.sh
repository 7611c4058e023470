#!/bin/sh
# Make what test_gpiod2.py runs: the GPIO driver and a probe over it, linked with Debian 13's libgpiod 2, beside that
# library and its C library. Usage: setup_gpiod2.sh FOLDER. Leaves FOLDER/t, which comes into the machine as /t. The
# machine's own package sources are read with the suite's name changed, into FOLDER; nothing of the machine changes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../.." && pwd)
folder=$1
arch=arm64
triplet=aarch64-linux-gnu

fail() {
    echo "panel-vm: $*" >&2
    exit 1
}

made_from() {
    cat "$here/setup_gpiod2.sh" "$here/gpio_probe.c" "$top"/drivers/gpio/* "$top/drivers/include/drv/gpio.h" | sha256sum
}

apt13() {
    "$@" -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$work/sources" -o Dir::State::lists="$work/lists" \
        -o Dir::Cache="$work/cache" -o APT::Sandbox::User=root
}

sources13() {
    for file in /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list /etc/apt/sources.list; do
        [ ! -s "$file" ] || sed 's/bookworm/trixie/g' "$file" >"sources/${file##*/}"
    done
    [ ! -e sources/sources.list ] || mv sources/sources.list sources/main.list
    grep -rq trixie sources
}

mkdir -p "$folder"
cd "$folder"
work=$PWD
[ "$(cat stamp 2>/dev/null)" != "$(made_from)" ] || exit 0
command -v $triplet-gcc >/dev/null || fail "$triplet-gcc is missing: make deps"
if [ ! -e debs/done ]; then
    rm -rf sources lists cache debs root
    mkdir -p sources lists/partial cache/archives/partial debs root
    sources13 || fail "the package sources of this machine are not Debian 12's"
    apt13 apt-get -qq update >apt.log 2>&1 || fail "Debian 13's lists cannot be had: $(tail -n 1 apt.log)"
    (cd debs && apt13 apt-get -qq download libgpiod3:$arch libgpiod-dev:$arch libc6:$arch >>../apt.log 2>&1) ||
        fail "Debian 13's packages cannot be had: $(tail -n 1 apt.log)"
    for deb in debs/*.deb; do dpkg -x "$deb" root; done
    touch debs/done
fi
rm -rf t header
mkdir t header
cp root/usr/include/gpiod.h header # before the one of this machine's version
lib=$work/root/usr/lib/$triplet
# Its C library is newer than the compiler's: what libgpiod asks of it is found in the machine.
$triplet-gcc -std=c11 -Wall -Wextra -Werror -O2 -D_GNU_SOURCE -I"$top/drivers/include" \
    -I"$top/drivers/gpio" -I"$top/firmware/base/include" -I"$top/fixed/include" -Iheader "$here/gpio_probe.c" "$top/drivers/gpio/gpio.c" \
    "$top/drivers/gpio/lines_gpiod2.c" "$lib"/libgpiod.so.3 -Wl,--allow-shlib-undefined -o t/gpio_probe
cp -L "$lib"/libgpiod.so.3 "$lib"/libc.so.6 "$lib"/ld-linux-aarch64.so.1 t
made_from >stamp
