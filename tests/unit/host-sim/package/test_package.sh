#!/bin/bash
# The Debian package of the tools: what is in it, that it installs, and that what is installed does its work.
set -u
build=${BUILD:-build/bench-linux}
work=$build/tmp/tools-package
rm -rf "$work"
mkdir -p "$work"
# shellcheck source=tests/system/test_sim_tap.sh
. tests/system/test_sim_tap.sh

if ! command -v dpkg-shlibdeps >/dev/null; then
    skip 'the package of the tools' 'dpkg-shlibdeps is missing: run make deps'
    finish
fi

build_package() { # OUT-DIR; the name of the package goes to $out
    exits 0 sh host-sim/package/build.sh "$build/bin" "$1"
}

check 'the package can be built' build_package "$work"
package=$(cat "$out")
build_again() { build_package "$work/again" && cmp "$package" "$(cat "$out")"; }
check 'the same programs make the same package, byte for byte' build_again

names_its_libraries() { dpkg-deb -f "$package" Depends >"$out" && printed 'libgdal.*libproj' && ! grep -q @ "$out"; }
check 'it names the packages of its libraries' names_its_libraries
belongs_to_root() { dpkg-deb -c "$package" | awk '$2 != "root/root" || $1 ~ /^-.......w/ { print; bad = 1 } END { exit bad }'; }
check 'everything in it belongs to root, and nobody else may write it' belongs_to_root

# Installed below a folder of its own: dpkg's records too.
root=$PWD/$work/root
mkdir -p "$root/var/lib/dpkg/updates" "$root/var/lib/dpkg/info"
touch "$root/var/lib/dpkg/status" "$root/var/lib/dpkg/available"
install_it() {
    exits 0 dpkg --root="$root" --force-depends --force-not-root --log="$root/dpkg.log" -i "$package" &&
        dpkg --root="$root" --verify landmass-tools | grep . && return 1
    [ -x "$root/usr/bin/landmass-db" ]
}
check 'dpkg installs it' install_it
bin=$root/usr/bin

has_manual() {
    for program in "$bin"/*; do
        [ -s "$root/usr/share/man/man1/${program##*/}.1.gz" ] || { echo "# ${program##*/} has no manual page" && return 1; }
    done
    [ -s "$root/usr/share/man/man1/landmass-db-build.1.gz" ]
}
check 'each program and each command has its manual page' has_manual

# The main job with what is installed: a scene, a database with terrain and classes, a flight, a picture.
flies() {
    classes=$root/usr/share/landmass/heaton6.classes
    "$bin/landmass-scene" --out "$work/scene" --size 256 --cell 10 >"$out" 2>"$last_error" &&
        "$bin/landmass-db" build --classes "$classes" --terrain "$work/scene/terrain.tif" --class-raster "$work/scene/truth.tif" \
            --out "$work/tools.lmdb" >>"$out" 2>>"$last_error" &&
        "$bin/landmass-db" verify "$work/tools.lmdb" >>"$out" 2>>"$last_error" &&
        "$bin/landmass-nav" --straight 41.985,-29.01,80,3000,180 --seconds 4 --out "$work/flight.log" >>"$out" 2>>"$last_error" &&
        "$bin/landmass-bus" decode "$work/flight.log" >"$work/decoded" 2>>"$last_error" && grep -q latitude "$work/decoded" &&
        "$bin/landmass-sim" --db "$work/tools.lmdb" --bus "$work/flight.log" --png "$work/pictures" --every 20 >>"$out" 2>>"$last_error" &&
        [ "$(find "$work/pictures" -name '*.png' -size +2k | wc -l)" -ge 1 ]
}
check 'what is installed makes a scene, a database, a flight and a picture' flies

# What bash would offer behind these words; the last is being typed.
offered() {
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    COMPREPLY=()
    _landmass "$1"
    printf '%s\n' "${COMPREPLY[@]}" >"$out"
}
# shellcheck source=host-sim/package/completion.bash
. "$root/usr/share/bash-completion/completions/landmass-sim"
PATH=$bin:$PATH
offers() { # WORD... -- WANTED...: each of these is offered
    words=()
    while [ "$1" != -- ]; do
        words+=("$1")
        shift
    done
    shift
    offered "${words[@]}"
    for wanted in "$@"; do
        grep -qxF -e "$wanted" "$out" || { echo "# not offered: $wanted" && return 1; }
    done
}
offers_only() { offers "$@" && [ "$(wc -l <"$out")" -eq 1 ]; }
check 'the shell completes commands' offers landmass-db '' -- build segment verify --help
check 'and what has been begun' offers_only landmass-db seg -- segment
check 'and options of a command' offers landmass-db build --c -- --classes --class-raster --cell
check 'and options of a program without commands' offers_only landmass-nav --posi -- --position
check 'and words of a choice' offers landmass-nav --position '' -- double float long
check 'and words of a text' offers landmass-db picture --plane '' -- reflectivity class elevation height shade
check 'and words beside a place holder' offers landmass-db train --priors e -- exemplars equal
: >"$work/terrain-1.tif"
check 'and files' offers_only landmass-db build --terrain "$work/terr" -- "$work/terrain-1.tif"
check 'and folders' offers_only landmass-scene --out "$work/sce" -- "$work/scene"
check 'and arguments' offers_only landmass-db verify "$work/tools.l" -- "$work/tools.lmdb"
check 'and nothing where nothing is known' offers_only landmass-db build --title x -- ''

if command -v lintian >/dev/null; then
    cp "$package" "$work/looked-at.deb"
    check 'lintian finds neither errors nor warnings' exits 0 lintian --allow-root --fail-on error,warning "$work/looked-at.deb"
    sed 's/^/# /' "$out"
else
    skip 'lintian finds neither errors nor warnings' 'lintian is missing: run make deps'
fi
finish
