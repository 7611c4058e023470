#!/bin/sh
# Install what a list, packages.txt unless it is named, has and this machine lacks. Needs root, or sudo. Usage: deps.sh [LIST]
set -eu
list=$(sed "s/#.*//" "${1:-$(dirname "$0")/packages.txt}")
# " NAME:ARCHITECTURE " of all that is installed; a name without one means this machine's, or none in particular.
have=$(dpkg-query -W -f ' ${Package}:${Architecture} ${db:Status-Status}\n' | sed -n 's/ installed$/ /p')
own=$(dpkg --print-architecture)
has() { # PACKAGE
    case $1 in
    *:*) case $have in *" $1 "*) return 0 ;; esac ;;
    *) case $have in *" $1:$own "* | *" $1:all "*) return 0 ;; esac ;;
    esac
    return 1
}
missing=
for package in $list; do
    name=${package#\?}
    has "$name" && continue
    [ "$name" = "$package" ] || apt-cache show "$name" >/dev/null 2>&1 || continue
    missing="$missing $name"
done
[ -n "$missing" ] || exit 0

fail() { # CAUSE REMEDY
    echo "deps: $1" >&2
    echo "deps: $2" >&2
    exit 1
}

as_root=
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || fail "root is needed to install:$missing" "run 'make deps' as root once, or install sudo"
    as_root=sudo
fi
echo "deps: installing$missing"
# A name like libc6-dev:arm64 is a package of the panel's architecture, which dpkg must be told of.
case $missing in
*:arm64*) $as_root dpkg --add-architecture arm64 ;;
esac
$as_root apt-get update -qq || fail "apt could not fetch its lists of packages" "is there a network, and are apt's sources right?"
# shellcheck disable=SC2086 # a list of names
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null ||
    fail "apt could not install:$missing" "what apt said stands above; Debian 12 has all of them"
echo "deps: done"
