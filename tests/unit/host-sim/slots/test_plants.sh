#!/bin/sh
# Bugs planted in the loader, each of which the power cuts of test_cuts must find: it fails with them, and passes without.
set -u
build=${BUILD:-build/bench-linux}
work=$build/tmp/plants
number=0
failed=0
rm -rf "$work"
mkdir -p "$work"
includes='-Ihost-sim/slots -Ihost-sim/slots/include -Ihost-sim/lib/include -Ifixed/include -Idrivers/include
    -Ifirmware/base/include -Ifirmware/map/include -Ifirmware/table/include -Ifirmware/kernels/include'

build_with() { # FILE SED-EXPRESSION: test_cuts with this change of host-sim/slots/FILE
    sed -e "$2" "host-sim/slots/$1.c" >"$work/$1.c"
    ! cmp -s "host-sim/slots/$1.c" "$work/$1.c" || [ -z "$2" ] || { echo "# $2 changes nothing" && return 1; }
    # shellcheck disable=SC2086
    ${CC:-cc} -std=c11 -O1 -w -D_GNU_SOURCE $includes -c "$work/$1.c" -o "$work/$1.o" &&
        ${CC:-cc} -o "$work/cuts" "$build/tests/unit/host-sim/slots/test_cuts.o" "$work/$1.o" \
            "$build/tests/unit/host-sim/slots/libhelpers.a" "$build/tests/support/libsupport.a" \
            "$build/host-sim/slots/libslots.a" "$build/host-sim/lib/liblib.a" "$build/libdrivers.a" "$build/libfirmware.a" \
            "$build/libfixed.a" -lcmocka -lm -pthread
}

finds() { # PLANTED FILE SED-EXPRESSION
    number=$((number + 1))
    if build_with "$2" "$3" && ! LANDMASS_CUTS=3000 "$work/cuts" 'no_cut*' >"$work/said" 2>&1; then
        sed -n 's/.*\(cut [0-9]* of seed\)/# found: \1/p' "$work/said" | head -n 1
        echo "ok $number - found: $1"
    else
        failed=1
        echo "not ok $number - found: $1"
    fi
}

number=1
if build_with load '' && LANDMASS_CUTS=3000 "$work/cuts" 'no_cut*' >"$work/said" 2>&1; then
    echo 'ok 1 - without a plant nothing is found'
else
    failed=1
    echo 'not ok 1 - without a plant nothing is found'
fi
finds 'the image is not synced before it is switched to' load 's/(at - synced >= SYNC_BYTES || at == all)/false/'
finds 'the records are not synced' slot 's/cause = s->medium.sync(s->medium.ctx);/cause = 0;/'
finds 'the slot is whole before its image is written' load 's/\.state = LM_SLOT_LOADING,/.state = LM_SLOT_WHOLE, .sequence = 1000000,/'
finds 'data are written without a word that a load has begun' load \
    's/const int cause = slot_write_record(f->to, record);/const int cause = 0; (void)record;/'
finds 'what is there is taken for the image without a look' load 's/ && memcmp(f->wanted, f->there, length) == 0//'
finds 'the later load has the lower number' load 's/other->record.sequence + 1/1/'
echo "1..$number"
exit $failed
