#!/bin/sh
# The pictures of this build against tests/golden/pictures.golden, each one a test; then the other builds against it.
set -u
build=${BUILD:-build/bench-linux}
golden=tests/golden/pictures.golden
bin=$build/bin/tests/golden
work=$build/tmp/golden
rm -rf "$work"
mkdir -p "$work"
number=0
failed=0
different=
radar_pictures=0 labels_alone=0

result() { # STATUS STATEMENT
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - $2"
    else
        failed=1
        echo "not ok $number - $2"
    fi
}

"$bin"/golden >"$work/pictures"
result $? 'the golden pictures can be drawn'
# Of a country's image there is one checksum, and no glass.
while read -r name radar glass; do
    grep -qx "$name $radar${glass:+ $glass}" "$work/pictures"
    status=$?
    result $status "$name is as it was"
    if [ $status -ne 0 ]; then
        different="$different $name"
        if [ -n "$glass" ] && grep -q "^$name $radar " "$work/pictures"; then
            labels_alone=$((labels_alone + 1))
            echo "# only symbols, labels or warnings of $name differ: its radar picture is as it was"
        else
            radar_pictures=$((radar_pictures + 1))
            echo "# the radar picture of $name differs"
        fi
    fi
done <"$golden"
[ "$(wc -l <"$golden")" -eq "$(wc -l <"$work/pictures")" ]
result $? 'there are as many as before'
if [ -n "$different" ]; then
    # shellcheck disable=SC2086 # a list of names
    "$bin"/golden --png "$work" $different >/dev/null
    echo "# of $(wc -l <"$golden") situations $radar_pictures differ in the radar picture, $labels_alone in symbols or labels alone"
    echo "# what is drawn now is in $work; when it is right, make golden-update and commit before and after"
fi
for variant in "$bin"/golden-*; do
    [ -e "$variant" ] || continue # a build for coverage or by clang has none
    name=${variant##*/}
    "$variant" >"$work/$name" && cmp "$work/pictures" "$work/$name"
    result $? "$name draws the same"
done
echo "1..$number"
exit $failed
