/* Beyond 85 degrees of latitude nothing is drawn, and the glass says so. */
#include "hs/angle.h"
#include "unit_rig.h"

#include "check.h"
#include "glass_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Fly north from 5.6 km south of a latitude, at 500 m/s. */
static struct rig *fly_across(double latitude_deg)
{
    struct rig *r = make_rig_at(latitude_deg, 179.99);
    r->bus.speed_m_s = 500;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 4);
    return r;
}

/* Nothing of the radar is on the glass, in any step. */
static void check_blank(struct rig *r, double seconds)
{
    for (double t = 0; t < seconds; t += 0.1) {
        run(r, 0.1);
        assert_int_equal(lit_pixels(r), 0);
        assert_int_equal(r->unit.flags & (LM_FLAG_POLE | LM_FLAG_NAV_DEAD | LM_FLAG_NAV_STALE),
                         LM_FLAG_POLE);
    }
    const struct lm_surface glass = glass_of(r);
    const struct lm_palette *palette = &r->unit.palette;
    assert_true(glass_find(&glass, "POLE", palette->warning, palette->ink, NULL));
    assert_false(glass_find(&glass, "NAV FAIL", palette->warning, palette->ink, NULL));
}

TEST(the_picture_is_removed_with_a_word_where_a_flight_goes_beyond_85_north)
{
    struct rig *r = fly_across(85);
    assert_int_equal(r->unit.flags & (LM_FLAG_POLE | LM_FLAG_OFF_MAP), 0);
    assert_true(lit_pixels(r) > 2000);
    run(r, 8); /* 6 km */
    check_blank(r, 2);
    assert_int_equal(r->unit.faults.count, 0);
    free_rig(r);
}

TEST(it_comes_back_where_a_flight_leaves_the_south_pole)
{
    struct rig *r = fly_across(-85);
    check_blank(r, 2);
    run(r, 12);
    assert_int_equal(r->unit.flags & (LM_FLAG_POLE | LM_FLAG_NAV_DEAD), 0);
    assert_true(lit_pixels(r) > 2000);
    free_rig(r);
}

TEST(at_the_poles_themselves_and_on_the_way_there_nothing_is_drawn)
{
    static const double latitudes[] = {85.2, 87, 89, 89.9, 90, 90.02, -85.2, -87, -89.9, -89.95};
    for (size_t i = 0; i < sizeof latitudes / sizeof latitudes[0]; i++) {
        struct rig *r = fly_across(latitudes[i]);
        check_blank(r, 1);
        free_rig(r);
    }
}

TEST(a_patch_beyond_is_refused_and_one_from_a_commanded_place_stays)
{
    struct rig *r = fly_across(85);
    struct lm_control patch = {.kind = LM_CONTROL_SAR,
                               .sar = {.centre = {hs_bam(85.001), hs_bam(179.99)},
                                       .cell_mm = 10000,
                                       .range_m = 20000,
                                       .height_m_q6 = 3000 * 64}};
    command(r, patch);
    run(r, 0.1);
    assert_int_equal(r->unit.refusal, LM_REFUSED_POLE);
    patch.sar.centre.latitude = hs_bam(84.99);
    command(r, patch);
    run(r, 12); /* the aircraft is beyond by then, the patch's radar is not in it */
    assert_int_equal(r->unit.flags & LM_FLAG_POLE, 0);
    assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
    assert_true(lit_pixels(r) > 2000);
    free_rig(r);
}
