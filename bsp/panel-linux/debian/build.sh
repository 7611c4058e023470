#!/bin/sh
# Builds the Debian package of the panel. Usage: build.sh ARCH PROGRAM OUT-DIR [RUNNER]
# PROGRAM is the panel's program for ARCH. RUNNER, if any, runs it on this machine.
set -eu
arch=$1 program=$2 out=$3 runner=${4:-}
here=$(dirname "$0")
version=$($runner "$program" --version | sed 's/.* //')
# The package is reproducible: its times are those of the last commit.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$here" log -1 --format=%ct 2>/dev/null || echo 0)}
export SOURCE_DATE_EPOCH
date=$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d)

root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
put() { install -D -m "$1" "$2" "$root/$3"; }
fill() { sed -e "s/@VERSION@/$version/" -e "s/@ARCH@/$arch/" -e "s/@DATE@/$date/" -e "s/@DEPENDS@/${depends:-}/" "$1"; }

put 755 "$program" usr/sbin/landmass-panel
"${STRIP:-strip}" "$root/usr/sbin/landmass-panel"
load=$(dirname "$program")/landmass-load
put 755 "$load" usr/bin/landmass-load
"${STRIP:-strip}" "$root/usr/bin/landmass-load"
put 644 "$here/landmass-load@.service" lib/systemd/system/landmass-load@.service
put 644 "$here/landmass-load-usb.service" lib/systemd/system/landmass-load-usb.service
put 755 "$here/usb-gadget" usr/lib/landmass-panel/usb-gadget
put 644 "$here/landmass-load.udev" lib/udev/rules.d/90-landmass-load.rules
put 644 "$here/../../../host-sim/package/completion.bash" usr/share/bash-completion/completions/landmass-load
put 644 "$here/landmass-panel.service" lib/systemd/system/landmass-panel.service
put 644 "$here/landmass-panel.udev" lib/udev/rules.d/60-landmass-panel.rules
put 644 "$here/landmass-panel.sysctl" usr/lib/sysctl.d/60-landmass-panel.conf

$runner "$program" --options >"$root/options"
mkdir -p "$root/etc" "$root/usr/share/man/man8" "$root/usr/share/doc/landmass-panel"
{
    echo '# The configuration of landmass-panel(8): option = value. What is commented out is the default.'
    echo '# After a change: landmass-panel --check, then systemctl restart landmass-panel.'
    awk -v as=conf -f "$here/options.awk" "$root/options"
} >"$root/etc/landmass-panel.conf"
awk -v as=man -f "$here/options.awk" "$root/options" >"$root/options.man"
fill "$here/landmass-panel.8.in" | sed -e "/@OPTIONS@/r $root/options.man" -e '/@OPTIONS@/d' |
    gzip -9n >"$root/usr/share/man/man8/landmass-panel.8.gz"
rm "$root/options" "$root/options.man"
man1=$root/usr/share/man/man1
mkdir -p "$man1"
$runner "$load" --help=man | gzip -9n >"$man1/landmass-load.1.gz"
for command in put receive send show verify; do
    $runner "$load" "$command" --help=man | gzip -9n >"$man1/landmass-load-$command.1.gz"
done
doc=$root/usr/share/doc/landmass-panel
gzip -9nc "$here/../../../docs/panel.md" >"$doc/panel.md.gz"
gzip -9nc "$here/../../../CHANGELOG.md" >"$doc/CHANGELOG.md.gz"
{
    printf 'landmass-panel (%s) stable; urgency=medium\n\n  * See CHANGELOG.md.gz.\n\n' "$version"
    printf ' -- landmass maintainers <maintainers@landmass.example>  %s\n' "$(date -u -R -d "@$SOURCE_DATE_EPOCH")"
} | gzip -9n >"$doc/changelog.gz"
install -m 644 "$here/copyright" "$doc/copyright"
python3 -B "$here/../../../host-sim/package/sbom.py" make "$root" landmass-panel "$version" "$arch"

# The dependencies follow from the names of the libraries that the program needs.
depends='adduser, libc6 (>= 2.34)'
for library in $("${OBJDUMP:-objdump}" -p "$program" | sed -n 's/^ *NEEDED *//p'); do
    case $library in
    libusb-1.0.so.0) depends="$depends, libusb-1.0-0 (>= 2:1.0.16)" ;;
    libgpiod.so.2) depends="$depends, libgpiod2 (>= 1.5)" ;;
    libgpiod.so.3) depends="$depends, libgpiod3" ;;
    libcrypto.so.3) depends="$depends, libssl3" ;;
    libc.so.6 | libm.so.6 | ld-linux*) ;;
    *) echo "package: which Debian package has $library? Tell build.sh" >&2 && exit 1 ;;
    esac
done
mkdir -p "$root/DEBIAN"
fill "$here/control.in" >"$root/DEBIAN/control"
echo "Installed-Size: $(du -sk --exclude=DEBIAN "$root" | cut -f1)" >>"$root/DEBIAN/control"
echo /etc/landmass-panel.conf >"$root/DEBIAN/conffiles"
install -m 755 "$here/postinst" "$here/prerm" "$here/postrm" "$root/DEBIAN"
(cd "$root" && find etc lib usr -type f ! -path etc/landmass-panel.conf | LC_ALL=C sort | xargs md5sum) >"$root/DEBIAN/md5sums"
find "$root" -type d -exec chmod 755 {} +
chmod 644 "$root/etc/landmass-panel.conf" "$root"/usr/share/man/man[18]/* "$doc"/* "$root/DEBIAN/control" \
    "$root/DEBIAN/conffiles" "$root/DEBIAN/md5sums"

mkdir -p "$out"
package=$out/landmass-panel_${version}_$arch.deb
dpkg-deb --root-owner-group -Zxz --build "$root" "$package" >/dev/null
echo "$package"
