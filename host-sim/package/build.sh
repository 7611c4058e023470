#!/bin/sh
# Builds the Debian package of the tools. Usage: build.sh BIN-DIR OUT-DIR
# BIN-DIR has the programs, built for this machine's architecture.
set -eu
bin=$1 out=$2
here=$(dirname "$0")
top=$here/../..
tools='bus db dis ios nav netem radar realradar reference scene sim target'
arch=$(dpkg --print-architecture)
version=$("$bin/landmass-db" --version | sed 's/.* //')
# The package is reproducible: its times are those of the last commit.
SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -C "$here" log -1 --format=%ct 2>/dev/null || echo 0)}
export SOURCE_DATE_EPOCH

root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
man=$root/usr/share/man/man1
doc=$root/usr/share/doc/landmass-tools
mkdir -p "$root/usr/bin" "$man" "$doc" "$root/DEBIAN" "$root/debian"

for tool in $tools; do
    program=$bin/landmass-$tool
    install -m 755 "$program" "$root/usr/bin"
    "${STRIP:-strip}" "$root/usr/bin/landmass-$tool"
    "$program" --help=man | gzip -9n >"$man/landmass-$tool.1.gz"
    for command in $("$program" --help=list | sed -n 's/^\([a-z0-9]*\)\t\t$/\1/p'); do
        "$program" "$command" --help=man | gzip -9n >"$man/landmass-$tool-$command.1.gz"
    done
done
# Completion is looked for under the name of the command.
completions=$root/usr/share/bash-completion/completions
install -D -m 644 "$here/completion.bash" "$completions/landmass-db"
for tool in $tools; do
    [ "$tool" = db ] || ln -s landmass-db "$completions/landmass-$tool"
done
mkdir -p "$root/usr/share/landmass"
install -m 644 "$top"/host-sim/programs/db/classes/* "$top"/host-sim/programs/radar/tables/* \
    "$top"/host-sim/nav/share/* "$root/usr/share/landmass"
cp -r "$here/../world" "$root/usr/share/landmass/world"
rm "$root/usr/share/landmass/world/world.sh" "$root/usr/share/landmass/world/packages.txt"
cp -r "$bin/../ios" "$root/usr/share/landmass/ios"
rm "$root/usr/share/landmass/ios/.made"
mkdir -p "$doc/docs"
install -m 644 "$top"/docs/*.md "$doc/docs"
gzip -9nc "$top/CHANGELOG.md" >"$doc/CHANGELOG.md.gz"
{
    printf 'landmass-tools (%s) stable; urgency=medium\n\n  * See CHANGELOG.md.gz.\n\n' "$version"
    printf ' -- landmass maintainers <maintainers@landmass.example>  %s\n' "$(date -u -R -d "@$SOURCE_DATE_EPOCH")"
} | gzip -9n >"$doc/changelog.gz"
install -m 644 "$top/bsp/panel-linux/debian/copyright" "$doc/copyright"
python3 -B "$here/sbom.py" make "$root" landmass-tools "$version" "$arch"

# The libraries that the programs need, as packages with the versions that their symbols ask for.
printf 'Source: landmass\n\nPackage: landmass-tools\nArchitecture: any\n' >"$root/debian/control"
depends=$(cd "$root" && dpkg-shlibdeps -O usr/bin/* 2>/dev/null | sed 's/^shlibs:Depends=//')
rm -r "$root/debian"
[ -n "$depends" ] || { echo 'package: dpkg-shlibdeps named no library' >&2 && exit 1; }
sed -e "s/@VERSION@/$version/" -e "s/@ARCH@/$arch/" -e "s/@DEPENDS@/$depends/" "$here/control.in" >"$root/DEBIAN/control"
echo "Installed-Size: $(du -sk --exclude=DEBIAN "$root" | cut -f1)" >>"$root/DEBIAN/control"
(cd "$root" && find usr -type f | LC_ALL=C sort | xargs md5sum) >"$root/DEBIAN/md5sums"
find "$root" -type d -exec chmod 755 {} +
find "$root/usr/share" "$root/DEBIAN" -type f -exec chmod 644 {} +

mkdir -p "$out"
package=$out/landmass-tools_${version}_$arch.deb
dpkg-deb --root-owner-group -Zxz --build "$root" "$package" >/dev/null
echo "$package"
