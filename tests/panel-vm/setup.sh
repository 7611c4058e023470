#!/bin/sh
# Make what the tests boot: Debian's kernel for an architecture and a first file system of Debian's packages.
# Usage: setup.sh ARCH FOLDER (arm64 or amd64). Leaves FOLDER/Image, FOLDER/base.cpio and, for arm64, the board's device
# tree in FOLDER/board.dtb; does nothing when they are there and made from these lists. Needs apt with the architecture
# among dpkg's (make deps), and no root.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
arch=$1
folder=$2
PATH=$PATH:/sbin:/usr/sbin
case $arch in
arm64) qemu='qemu-system-aarch64' ;;
amd64) qemu='qemu-system-x86_64' ;;
*) echo "panel-vm: $arch: arm64 or amd64" >&2; exit 2 ;;
esac

fail() {
    echo "panel-vm: $*" >&2
    exit 1
}

list() {
    sed 's/ *#.*//; /^$/d' "$here/$1"
}

made_from() {
    cat "$here/setup.sh" "$here/init" "$here/guest-packages.txt" "$here/guest-modules.txt" "$here/gpio-lines.txt" |
        sha256sum
}

# The package lists of a machine may be older than the archive: then they are read anew, once, where that is allowed.
download() {
    mkdir debs
    (cd debs && apt-get download -qq "$@" >../apt.log 2>&1) && return
    apt-get update -qq >>apt.log 2>&1 || true
    (cd debs && apt-get download -qq "$@" >>../apt.log 2>&1)
}

kernel_package() {
    apt-cache depends "linux-image-$arch:$arch" 2>/dev/null | sed -n 's/.*Depends: \(linux-image-[^:]*\).*/\1/p' |
        head -n 1
}

# A PC's kernel unpacks itself at each start, which takes QEMU seconds. QEMU starts the kernel within as well (PVH), where
# it is packed by xz; one that is packed otherwise stays as it is.
unwrap_kernel() {
    at=$(LC_ALL=C grep -aobP -m 1 '\xFD7zXZ\x00' Image | cut -d: -f1 | head -n 1)
    [ -z "$at" ] || ! tail -c +$((at + 1)) Image | xz -dc --single-stream >vmlinux || mv vmlinux Image
    rm -f vmlinux
}

unpack_kernel() { # VERSION
    dpkg -x debs/linux-image-"$1"_*.deb kernel
    cp "kernel/boot/vmlinuz-$1" Image
    [ "$arch" != amd64 ] || unwrap_kernel
    depmod -b kernel "$1"
}

# The modules of the list that this kernel has, and all that they need, in a tree of their own.
copy_modules() { # VERSION
    # shellcheck disable=SC2046 # one word a module
    modprobe --quiet --dirname kernel --set-version "$1" --show-depends --all $(list guest-modules.txt) |
        sed -n 's/^insmod \([^ ]*\).*/\1/p' | sort -u >module-files
    while read -r file; do
        install -D -m 644 "$file" "root/${file#*kernel/}"
    done <module-files
    cp "kernel/lib/modules/$1"/modules.builtin* "kernel/lib/modules/$1/modules.order" "root/lib/modules/$1"
    depmod -b root "$1"
}

make_root() { # VERSION
    for name in bin sbin proc sys dev tmp run etc usr/bin usr/sbin; do mkdir -p "root/$name"; done
    for deb in debs/*.deb; do
        case $deb in debs/linux-image-*) ;; *) dpkg -x "$deb" root ;; esac
    done
    rm -rf root/usr/share root/usr/lib/*/gconv
    copy_modules "$1"
    cp "$here/init" root/init
    (cd root && find . | LC_ALL=C sort | cpio -o -H newc -R +0:+0 --quiet) >base.cpio
}

# QEMU's board has a GPIO chip whose lines have no names, and gives one of them to a power key.
make_device_tree() {
    qemu-system-aarch64 -M virt,dumpdtb=board.dtb -cpu cortex-a53 -smp 1 -nodefaults -display none </dev/null \
        >dtb.log 2>&1
    # shellcheck disable=SC2046 # one word a line
    fdtput -t s board.dtb /pl061@9030000 gpio-line-names $(list gpio-lines.txt)
    fdtput -r board.dtb /gpio-keys
}

mkdir -p "$folder"
cd "$folder"
[ "$(cat stamp 2>/dev/null)" != "$(made_from)" ] || exit 0
for tool in apt-get dpkg cpio depmod modprobe fdtput xz $qemu; do
    command -v "$tool" >/dev/null || fail "$tool is missing: make deps"
done
(dpkg --print-architecture; dpkg --print-foreign-architectures) | grep -qx "$arch" ||
    fail "dpkg does not know $arch: make deps"
rm -rf kernel root debs stamp
kernel=$(kernel_package)
[ -n "$kernel" ] || fail "apt knows no linux-image-$arch: apt-get update"
# shellcheck disable=SC2046 # one word a package
download "$kernel:$arch" $(list guest-packages.txt | sed "s/\$/:$arch/") ||
    fail "Debian's packages cannot be had: $(tail -n 1 apt.log)"
unpack_kernel "${kernel#linux-image-}"
make_root "${kernel#linux-image-}"
[ "$arch" != arm64 ] || make_device_tree
rm -rf kernel debs
made_from >stamp
