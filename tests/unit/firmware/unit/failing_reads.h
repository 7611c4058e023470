#ifndef FAILING_READS_H
#define FAILING_READS_H

#include "check.h"
#include "unit_rig.h"

/* Start the unit with each of its first reads of the flash failing in turn, and check it behind
 * each: it has its map, or none because of that read. The flash is sound afterwards. */
static inline void start_with_failing_reads(struct rig *r, void (*expect)(const struct rig *r))
{
    uint32_t refused = 0;
    for (uint32_t read = 1; read < 12; read++) {
        r->board.flash.reads = 0;
        r->board.flash.fail_read = read;
        assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
        assert_true(r->unit.map.is_usable || r->unit.map.open_status == LM_ERR_IO);
        expect(r);
        refused += !r->unit.map.is_usable;
    }
    assert_in_range(refused, 4, 10); /* header, classes, bands and table; tiles are read again */
    r->board.flash.fail_read = 0;
}

#endif
