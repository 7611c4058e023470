#!/bin/sh
# Make the disk that test_systemd.py boots: a small Debian of the packages of systemd-packages.txt and guest-packages.txt,
# whose first program is systemd and whose dpkg knows what is installed. Usage: setup_systemd.sh FOLDER GUEST
# GUEST is what setup.sh made for arm64: its modules are taken. Leaves FOLDER/disk.img, and FOLDER/boot, whose files come
# over GUEST's first file system. Does nothing when they are there and made from these lists. Needs apt, and to be root:
# the files on the disk belong to whoever unpacked them.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$1
guest=$(cd "$2" && pwd)
arch=arm64
PATH=$PATH:/sbin:/usr/sbin

fail() {
    echo "panel-vm: $*" >&2
    exit 1
}

list() {
    sed 's/ *#.*//; /^$/d; /:/!s/$/:'$arch'/' "$here/systemd-packages.txt" "$here/guest-packages.txt" | sort -u
}

made_from() {
    cat "$here/setup_systemd.sh" "$here/systemd-packages.txt" "$guest/stamp" | sha256sum
}

download() {
    mkdir debs
    # shellcheck disable=SC2046 # one word a package
    (cd debs && apt-get download -qq $(list) >../apt.log 2>&1) && return
    apt-get update -qq >>apt.log 2>&1 || true
    # shellcheck disable=SC2046
    (cd debs && apt-get download -qq $(list) >>../apt.log 2>&1)
}

# Debian's folders: /bin and so on are those of /usr.
unpack() {
    for name in bin sbin lib; do
        mkdir -p "root/usr/$name"
        ln -s "usr/$name" "root/$name"
    done
    for deb in debs/*.deb; do dpkg -x "$deb" root; done
    rm -rf root/usr/share/doc root/usr/share/man root/usr/share/locale root/usr/share/info root/usr/lib/*/gconv
    cp -r "$guest/root/lib/modules" root/usr/lib
    mkdir -p root/proc root/sys root/dev root/run root/tmp root/t root/usr/local/bin root/var/log/journal
    for applet in usleep pidof; do ln -s /bin/busybox "root/usr/local/bin/$applet"; done
}

# What dpkg, adduser and systemd would have found after an installation.
settle() {
    mkdir -p root/var/lib/dpkg/updates root/var/lib/dpkg/info root/var/lib/dpkg/alternatives root/var/lib/dpkg/triggers
    for deb in debs/*.deb; do
        dpkg-deb -f "$deb" | sed '/^Package:/a Status: install ok installed'
        echo
    done >root/var/lib/dpkg/status
    cp root/usr/share/base-passwd/passwd.master root/etc/passwd
    (cat root/usr/share/base-passwd/group.master && printf "%s:x:%s:\n" input 996 kvm 995 render 994 sgx 993) >root/etc/group
    sed 's/:.*/:*:19000:0:99999:7:::/' root/etc/passwd >root/etc/shadow
    sed 's/:.*/:*::/' root/etc/group >root/etc/gshadow
    echo panel >root/etc/hostname
    echo 0123456789abcdef0123456789abcdef >root/etc/machine-id
    ln -s /lib/systemd/system/multi-user.target root/etc/systemd/system/default.target
    ln -s dash root/usr/bin/sh 2>/dev/null || true
    for unit in systemd-timesyncd.service systemd-networkd.service systemd-resolved.service serial-getty@.service \
        getty@.service getty-static.service console-getty.service apt-daily.timer; do
        ln -s /dev/null "root/etc/systemd/system/$unit"
    done
}

# The tests' way in, as in init.
add_shell() {
    cat >root/usr/local/bin/test-shell <<'END'
#!/bin/sh
export PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
until (: <>/dev/vport0p1) 2>/dev/null; do usleep 10000; done
exec 0<>/dev/vport0p1 1>&0 2>&0
echo @@ready
exec sh
END
    chmod 755 root/usr/local/bin/test-shell
    cat >root/etc/systemd/system/test-shell.service <<'END'
[Unit]
Description=Shell of the tests
[Service]
ExecStart=/usr/local/bin/test-shell
KillMode=process
END
    mkdir -p root/etc/systemd/system/multi-user.target.wants
    ln -s ../test-shell.service root/etc/systemd/system/multi-user.target.wants/test-shell.service
}

make_boot() {
    mkdir boot
    cat >boot/init <<'END'
#!/bin/busybox sh
export PATH=/sbin:/usr/sbin:/bin:/usr/bin
/bin/busybox --install -s /bin 2>/dev/null
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
modprobe -a virtio_pci virtio_blk virtio_console crc32c_generic ext4 can_raw vcan virtio-gpu xhci-pci
until [ -b /dev/vda ]; do usleep 10000; done
mkdir /disk
mount -t ext4 /dev/vda /disk
cp -r /t /disk 2>/dev/null
mount --move /dev /disk/dev
umount /sys /proc
exec switch_root /disk /lib/systemd/systemd
END
    chmod 755 boot/init
}

mkdir -p "$folder"
cd "$folder"
[ "$(cat stamp 2>/dev/null)" != "$(made_from)" ] || exit 0
[ "$(id -u)" = 0 ] || fail "the files of systemd's disk belong to root: only root can make it"
command -v mke2fs >/dev/null || fail "mke2fs is missing: make deps"
rm -rf debs root boot disk.img stamp
download || fail "Debian's packages cannot be had: $(tail -n 1 apt.log)"
unpack
settle
add_shell
make_boot
mke2fs -q -t ext4 -O ^metadata_csum -d root disk.img 400M || fail "mke2fs could not make the disk"
rm -rf root debs
made_from >stamp
