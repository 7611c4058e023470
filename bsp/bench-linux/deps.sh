#!/bin/sh
# Install what packages.txt lists and this machine lacks. Needs root, or sudo.
set -eu
list=$(sed 's/#.*//' "$(dirname "$0")/packages.txt")
missing=
for package in $list; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || {
        echo "deps: root is needed to install:$missing" >&2
        echo "deps: run 'make deps' as root once, or install sudo" >&2
        exit 1
    }
    as_root=sudo
fi
echo "deps: installing$missing"
# A name like libc6-dev:arm64 is a package of the panel's architecture, which dpkg must be told of.
case $missing in
*:arm64*) $as_root dpkg --add-architecture arm64 ;;
esac
$as_root apt-get update -qq
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
echo "deps: done"
