#!/bin/sh
# Does who builds a package again get the same bytes? Each package is built here, as `make package` does, and once more
# from a copy of the sources: in another folder, later, with another umask, time zone and locale, and without a compiler
# cache. Ends in "N passed, N failed, N skipped". With an argument, only what its make targets say: "panel-package".
set -u
cd "$(dirname "$0")/../.." || exit 1
here=$PWD
unset MAKEFLAGS MAKEOVERRIDES MFLAGS MAKELEVEL
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct 2>/dev/null || echo 0)
export SOURCE_DATE_EPOCH
passed=0 failed=0

there=$(mktemp -d)/a-folder-of-another-name
trap 'rm -rf "${there%/*}"' EXIT
mkdir "$there"
git ls-files | cpio -pd --quiet "$there" || { echo 'reproduce: the sources cannot be copied: is this a git tree?' >&2; exit 1; }

build() { # MAKE-WORDS; the package's path goes to $package
    # shellcheck disable=SC2086 # the words are some
    package=$(nice make --no-print-directory -s -j2 $1 | grep '\.deb$' | tail -n 1)
}

build_otherwise() { # MAKE-WORDS
    export CCACHE_DISABLE=1 TZ=Pacific/Kiritimati LC_ALL=C.UTF-8 LANG=C.UTF-8
    cd "$there" && umask 0077 && build "$1" && echo "$package"
}

once_more() { # MAKE-WORDS
    build "$1"
    again=$(build_otherwise "$1")
    if [ -s "$here/$package" ] && cmp "$here/$package" "$there/$again"; then
        passed=$((passed + 1))
        echo "reproduce: ${package##*/}: the same, $(sha256sum <"$here/$package" | cut -d' ' -f1)"
    else
        failed=$((failed + 1))
        echo "reproduce: ${package:-$1}: ANOTHER, or none; built again it differs"
    fi
}

for words in 'BOARD=panel-linux ARCH=amd64 panel-package' 'BOARD=panel-linux ARCH=arm64 panel-package' \
    'O=build/tools HAS_AVX2= tools-package'; do
    case $words in *"${1:-}"*) once_more "$words" ;; esac
done
echo "$passed passed, $failed failed, 0 skipped"
[ "$failed" -eq 0 ]
