#!/bin/sh
# What all programs promise on the command line: --help everywhere, mistakes told with status 2, on standard error alone.
set -u
build=${BUILD:-build/bench-linux}
work=$build/tmp/test_cli
mkdir -p "$work"
# shellcheck source=tests/system/test_sim_tap.sh
. tests/system/test_sim_tap.sh

helps() {
    exits 0 "$@" --help && printed '^([Uu]sage:|landmass-[a-z]+ )' && test ! -s "$last_error"
}

refuses() {
    exits 2 "$@" && test -s "$last_error" && test ! -s "$out"
}

names_itself() { # the first line is "program: place: cause"
    head -n 1 "$last_error" | grep -qE "(^|/)$1: [^:]+"
}

is_a_manual_page() { # PROGRAM [COMMAND]: the formatter has nothing to warn of
    exits 0 "$@" --help=man && printed '^\.TH LANDMASS-' || return 1
    warned=$(MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$out" 2>&1 >/dev/null)
    [ -z "$warned" ] || { echo "# $warned" && return 1; }
}

lists_what_it_explains() { # PROGRAM [COMMAND]: every option of the list is in the help
    exits 0 "$@" --help=list && cut -f1 "$out" | grep -E '^--' >"$work/list" && exits 0 "$@" --help || return 1
    while read -r option; do
        grep -qE -e "$option( |\[|=|$)" "$out" || { echo "# $option is not in the help" && return 1; }
    done <"$work/list"
}

tells_defaults_once() { # PROGRAM [COMMAND]: what is "left out" is a clause of its own; no default is said twice
    exits 0 "$@" --help=man &&
        awk '/^left out:/ && before !~ /[;,.]$|^\\fB/ || /[^;,.] left out:/ { print "# " before " " $0; bad = 1 }
            { before = $0 } END { exit bad }' "$out" &&
        ! tr '\n' ' ' <"$out" | grep -oE '\(([0-9.]+)\) Range [^;]*; default \1\.'
}

explains_itself() { # PROGRAM [COMMAND]
    name=$(basename "$1")${2:+ $2}
    check "$name --help=man is a manual page" is_a_manual_page "$@"
    check "$name --help tells each default once" tells_defaults_once "$@"
    check "$name --help=list names what --help explains" lists_what_it_explains "$@"
}

for program in "$build"/bin/landmass-*; do
    name=${program##*/}
    check "$name --help prints how it is used" helps "$program"
    check "$name refuses an option it does not have" refuses "$program" --nosuch
    check "and says so under its name" names_itself "$name"
    # A service works when it is started alone.
    [ "$name" = landmass-panel ] || check "$name alone is a wrong command line" refuses "$program"
    [ "$name" = landmass-panel ] && continue # it has a page of its own
    check "$name --version prints it" exits 0 "$program" --version
    explains_itself "$program"
    for command in $("$program" --help=list | sed -n 's/^\([a-z0-9]*\)\t\t$/\1/p'); do
        explains_itself "$program" "$command"
    done
done

db=$build/bin/landmass-db
commands=$("$db" --help=list | sed -n 's/^\([a-z]*\)\t\t$/\1/p')
check 'landmass-db has its commands' test "$(echo "$commands" | wc -w)" -ge 8
for command in $commands; do
    check "landmass-db $command --help prints how it is used" helps "$db" "$command"
    check "landmass-db $command refuses an option it does not have" refuses "$db" "$command" --nosuch
    check "and says so under its name" names_itself landmass-db
    check "landmass-db $command alone is a wrong command line" refuses "$db" "$command"
done
check 'landmass-db refuses a command it does not have' refuses "$db" nosuch
for command in inspect verify; do
    check "landmass-db $command of a missing file fails" exits 1 "$db" "$command" "$work/nosuch.lmdb"
    check 'and names it with its cause' said 'nosuch.lmdb: .*No such file'
done
check 'landmass-nav of a missing track fails' exits 1 "$build/bin/landmass-nav" "$work/nosuch.csv"
check 'and names it with its cause' said 'nosuch.csv: cannot be opened: No such file'
finish
