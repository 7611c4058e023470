/* A million controls from a bad hand, under the address and undefined-behaviour sanitizers: no
 * bound of the page is ever broken, and the glass goes on. The seed is fixed; another one may be
 * given. */
#include "check.h"
#include "support.h"
#include "unit_rig.h"

#include "hs/rng.h"

#include <stdlib.h>

enum { EVENTS = 1000000, A_STEP = 8, HOSTILE_STEP_US = 400 };

static int32_t any_value(struct hs_rng *rng)
{
    static const int32_t edges[] = {0, 1, -1, 20, 21, 28, 29, 1000, 1001, INT32_MAX, INT32_MIN};
    const uint32_t count = sizeof edges / sizeof *edges;
    const uint32_t pick = hs_rng_below(rng, 4);
    return pick == 0   ? edges[hs_rng_below(rng, count)]
           : pick == 1 ? (int32_t)hs_rng_below(rng, 4)
                       : (int32_t)hs_rng_below(rng, LM_BUTTONS) + 1;
}

/* Numbers of no bound where the kind of the control has any. */
static void set_numbers(struct lm_control *c, int32_t value, int32_t other)
{
    switch (c->kind) {
    case LM_CONTROL_SECTOR:
        c->sector.mode = value;
        c->sector.fov = other;
        break;
    case LM_CONTROL_STEERPOINT:
        c->steerpoint.is_set = value & 1;
        c->steerpoint.position.latitude = (fx_bam_t)other;
        break;
    case LM_CONTROL_CURSOR:
        c->cursor.latitude = (fx_bam_t)value;
        c->cursor.longitude = (fx_bam_t)other;
        break;
    case LM_CONTROL_RANGE:
        c->range_nm = value > 0 && value < 10 ? 10 * value : value;
        break;
    case LM_CONTROL_AZIMUTH:
        c->azimuth_index = value;
        break;
    case LM_CONTROL_GAIN:
        c->gain_db = value;
        break;
    case LM_CONTROL_FREEZE:
        c->is_frozen = value & 1;
        break;
    case LM_CONTROL_DOWN:
    case LM_CONTROL_UP:
        c->button = value;
        break;
    case LM_CONTROL_KNOB:
        c->knob = value;
        break;
    case LM_CONTROL_SLEW:
        c->slew.x = value;
        c->slew.y = other;
        break;
    default:
        break;
    }
}

static struct lm_control any_control(struct hs_rng *rng, const struct lm_unit *u)
{
    /* Mostly buttons; now and then everything else, kinds that do not exist included. */
    const bool is_button = hs_rng_below(rng, 8) != 0;
    struct lm_control c = {.kind = is_button ? LM_CONTROL_DOWN + hs_rng_below(rng, 2)
                                             : hs_rng_below(rng, 15)};
    set_numbers(&c, any_value(rng), any_value(rng));
    if (c.kind == LM_CONTROL_SLEW && hs_rng_below(rng, 2)) {
        c = lm_control_slew((int32_t)hs_rng_below(rng, 2001) - 1000,
                            (int32_t)hs_rng_below(rng, 2001) - 1000);
    }
    if (c.kind == LM_CONTROL_SAR) {
        c.sar = (struct lm_sar_command){.centre = u->cursor.position,
                                        .cell_mm = hs_rng_below(rng, 50000),
                                        .is_from_ownship = hs_rng_below(rng, 2),
                                        .range_m = hs_rng_below(rng, 300000),
                                        .height_m_q6 = any_value(rng)};
        c.sar.centre.latitude += hs_rng_below(rng, 2) ? (uint32_t)any_value(rng) : 0;
    }
    return c;
}

static void check_bounds(const struct rig *r)
{
    const struct lm_page *p = &r->unit.page;
    assert_true(p->range_index < lm_radar_default.ranges && p->azimuth_index < LM_AZIMUTHS);
    assert_true(p->format <= LM_FORMAT_TEST && p->mode < LM_SECTOR_CHOICES);
    assert_true(p->fov < LM_FOVS && p->range_index <= lm_page_range_last(p) &&
                p->cell_mm >= lm_radar_default.sar.cell_min_mm &&
                p->cell_mm <= lm_radar_default.sar.cell_max_mm);
    assert_true(abs(p->gain_db) <= LM_GAIN_MAX_DB && abs(p->knob) <= LM_FULL_DEFLECTION);
    assert_true(abs(p->black_db) <= LM_WINDOW_MAX_DB && abs(p->white_db) <= LM_WINDOW_MAX_DB);
    assert_true(abs(p->gamma_tenths) <= LM_GAMMA_MAX);
    assert_true(p->palette.tint < LM_TINTS && abs(p->palette.brightness) <= LM_ROCKER_STEPS);
    assert_true(abs(p->palette.contrast) <= LM_ROCKER_STEPS);
    assert_true(abs(p->palette.symbology) <= LM_ROCKER_STEPS);
    assert_true(p->hidden < 1u << LM_OSBS && r->unit.keys.down < 1u << LM_BUTTONS);
    assert_true(r->unit.picture.sar.line <= r->unit.picture.sar.lines);
    assert_int_equal(r->unit.picture.sector.command.range_index < lm_radar_default.ranges, 1);
    const struct lm_cursor *c = &r->unit.cursor;
    assert_true(abs(c->slew_x) <= LM_FULL_DEFLECTION && abs(c->slew_y) <= LM_FULL_DEFLECTION);
    const int32_t reach_q8 = (r->unit.picture.view.radius_px + 2) * 256;
    const struct lm_offset middle = lm_view_middle(&r->unit.picture.view);
    assert_true(!c->is_on_glass || (abs(c->offset.x_px_q8 - middle.x_px_q8) <= reach_q8 &&
                                    abs(c->offset.y_px_q8 - middle.y_px_q8) <= reach_q8));
    for (uint8_t osb = 1; osb <= LM_OSBS; osb++) {
        struct lm_label label;
        assert_true(!lm_page_label(p, osb, &label) || (!label.line[0][5] && !label.line[1][5]));
    }
}

TEST(a_million_hostile_controls_break_no_bound)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, support_number("SEED", 1));
    struct rig *r = make_rig();
    r->board.display.width_px = r->board.display.height_px = 256;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    uint32_t formats_seen = 0, modes_seen = 0;
    for (uint32_t i = 0; i < EVENTS; i += A_STEP) {
        for (uint32_t n = 0; n < A_STEP; n++) {
            command(r, any_control(&rng, &r->unit));
        }
        /* Time mostly crawls and sometimes leaps over long presses and stuck keys. */
        r->now_us += hs_rng_below(&rng, 500) == 0 ? 400000 : HOSTILE_STEP_US;
        r->bus.now_us = r->now_us;
        lm_unit_step(&r->unit, r->now_us);
        assert_int_equal(r->control_next, r->control_count);
        check_bounds(r);
        formats_seen |= 1u << r->unit.page.format;
        modes_seen |= 1u << (r->unit.page.picture == LM_PICTURE_PATCH ? LM_SECTOR_CHOICES
                                                                      : r->unit.page.mode);
    }
    assert_int_equal(formats_seen, 31); /* the stream has been everywhere */
    assert_int_equal(modes_seen, 31);
    assert_true(r->unit.count.frames > 1000);
    print_message("# %u pictures, %u lines, %u refused, %u swaps\n", r->unit.count.frames,
                  r->unit.count.lines, r->unit.count.commands_refused, r->unit.count.swaps);
    free_rig(r);
}
