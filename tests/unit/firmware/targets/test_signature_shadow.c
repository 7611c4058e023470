/* Targets in the shadow of another one's chip in a patch, against rays over level ground. */
#include "check.h"
#include "reference/reference.h"
#include "signature_image.h"

#include "lm/target_patch.h"

#include <stdlib.h>

/* A patch of 128 cells of a metre around 46 N 11 E, seen from the west: east is away. */
enum { LINES = 128, CELLS = LINES, BITS = 26 };
static const double range_m = 20000, height_m = 6000;
static const struct lm_target_heights heights = {6000 * 1024, 0};

struct fixture {
    struct signature_world world; /* first: see tear_down_signature_world */
    struct lm_target_patch points;
};

static int set_up(void **state)
{
    return set_up_signature_world(state, sizeof(struct fixture));
}

/* Where something stands, from the centre, which is half a cell from a cell's middle. */
struct spot {
    double right_m, beyond_m, up_m;
};

static void put_at(struct lm_target *t, const struct spot *at)
{
    struct lm_geo_origin o;
    const double bearing_deg = 90 + atan2(at->right_m, at->beyond_m) * 180 / acos(-1);
    lm_geo_set_origin(&o, (struct lm_position){hs_bam(46), hs_bam(11)});
    const struct lm_position p = lm_geo_direct(
        &o, hs_bam(bearing_deg), (uint32_t)lround(hypot(at->right_m, at->beyond_m) * 256));
    t->latitude = p.latitude;
    t->longitude = p.longitude;
    t->elevation_m_q6 = (int32_t)lround(at->up_m * 64);
    seal_target(t);
}

static const struct lm_patch_geometry geometry = {.look = FX_BAM_90,
                                                  .centre_m_q8 = 20000 * 256,
                                                  .cell_m_q8 = 256,
                                                  .lines = LINES,
                                                  .cells = CELLS,
                                                  .traced = CELLS,
                                                  .heights = {6000 * 1024, 0},
                                                  .wavelength_um = X_BAND_UM,
                                                  .dwell_ms = 2000};

/* The patch of these targets, with the chips that have come, and the shadows looked for. */
static void make_patch(struct fixture *f, const struct lm_target *targets, uint32_t count,
                       bool is_first_hidden)
{
    const struct lm_position centre = {hs_bam(46), hs_bam(11)};
    const struct lm_target_set set = set_with_signature(&f->world, targets, count);
    const struct lm_target_query scene = {.position = centre, .reach_m = 20000};
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, centre);
    const struct lm_chip_query chips = {
        .centre = centre,
        .reach_m = scene.reach_m,
        .radar = lm_geo_direct(&origin, FX_BAM_DEG(270), (uint32_t)range_m * 256),
        .heights = heights,
        .cell_mm = 1000,
        .side_most = LM_CHIP_SIDE};
    struct lm_target_candidates candidates;
    struct lm_patch_geometry g = geometry;
    g.centre = centre;
    lm_target_candidates_select(&candidates, &set, &scene);
    lm_chips_choose(&f->world.chips, &candidates, &chips);
    assert_true(serve_chips(&f->world));
    lm_target_patch_set(&f->points, &candidates, &g);
    f->points.scatterer[0].is_hidden = is_first_hidden;
    for (uint32_t i = 0; i < f->points.scatterer_count; i++) {
        lm_target_patch_mark_shaded(&f->points, i, &g);
    }
}

/* The chip's shadow is 6 m wide, from 1 to 12 m behind its origin: over level ground, by a ray that
 * meets it 12 m behind. A metre either way is the cell's. */
static bool is_shaded(const struct spot *at, double end_m)
{
    return fabs(at->right_m) < 3 && at->beyond_m > 1 && at->beyond_m < end_m &&
           ref_tangent(height_m, range_m + at->beyond_m, at->up_m) <=
               ref_tangent(height_m, range_m + end_m, 0);
}

TEST_WITH(a_point_is_shaded_by_the_ray_over_it, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    int shaded = 0, seen = 0;
    for (double right_m = -5; right_m <= 5; right_m += 1) {
        for (double beyond_m = -4; beyond_m <= 16; beyond_m += 1) {
            for (double up_m = 0; up_m < 5; up_m += 0.5) {
                const struct spot here = {0, 0, 0}, at = {right_m, beyond_m, up_m};
                struct lm_target targets[2] = {target_with_signature(46, 11, 0),
                                               point_at(46, 11, 0, 10)};
                put_at(&targets[0], &here);
                put_at(&targets[1], &at);
                make_patch(f, targets, 2, false);
                const struct lm_patch_scatterer *point = &f->points.scatterer[1];
                const bool least = is_shaded(&at, 11) && fabs(right_m) < 2.5 && beyond_m > 2.5;
                const bool most = fabs(right_m) < 4 && beyond_m > -0.5 && beyond_m < 13.5 &&
                                  ref_tangent(height_m, range_m + beyond_m, up_m) <=
                                      ref_tangent(height_m, range_m + 13.5, 0);
                assert_false(f->points.scatterer[0].is_shaded);
                assert_true(point->is_shaded || !least);
                assert_true(!point->is_shaded || most);
                assert_int_equal(point->is_hidden, point->is_shaded);
                shaded += least;
                seen += !most;
            }
        }
    }
    assert_true(shaded > 100 && seen > 1000);
}

/* Its height is that of its top, 3 m: 10 m of shadow at 3 in 10. Near the hider it is shaded by a
 * higher ray only. One that is raised looks over. What shades is none of its own. */
TEST_WITH(a_chip_in_the_shadow_of_another_is_not_drawn_and_throws_none, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    static const struct spot spots[] = {{0, 4, -2}, {0, 4, 2}, {0, -4, -2}, {8, 4, -2}};
    for (int i = 0; i < 4; i++) {
        const struct spot here = {0, 0, 0};
        struct lm_target targets[2] = {target_with_signature(46, 11, 0),
                                       target_with_signature(46, 11, 0)};
        static const int32_t elevation_m_q14[LM_CELLS_ROOM];
        int16_t level_q8[LM_CELLS_ROOM];
        put_at(&targets[0], &here);
        put_at(&targets[1], &spots[i]);
        make_patch(f, targets, 2, false);
        assert_int_equal(f->points.scatterer[1].is_hidden, i == 0);
        assert_int_equal(f->points.scatterer[0].is_hidden, false);
        int drawn = 0;
        for (uint32_t k = 0; k < LINES; k++) {
            for (uint32_t c = 0; c < CELLS; c++) {
                level_q8[c] = -120 * 256;
            }
            f->points.target[0].has_chip = false; /* of the second alone */
            lm_target_patch_add_chips(&f->points, k, &geometry, elevation_m_q14, level_q8);
            for (uint32_t c = 0; c < CELLS; c++) {
                drawn += level_q8[c] > -120 * 256;
            }
        }
        assert_int_equal(drawn > 0, i != 0);
    }
}

/* Three in a row: the second is shaded by the first, and shades the third none the less, whoever is
 * judged first. */
TEST_WITH(the_order_of_the_targets_does_not_matter, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    static const int orders[][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {1, 0, 2}};
    static const struct spot row[] = {{0, 0, 0}, {0, 6, -2.5}, {0, 14, -5}};
    for (int i = 0; i < 4; i++) {
        struct lm_target targets[3];
        for (int k = 0; k < 3; k++) {
            targets[k] = target_with_signature(46, 11, 0);
            put_at(&targets[k], &row[orders[i][k]]);
        }
        make_patch(f, targets, 3, false);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(f->points.scatterer[k].is_hidden, orders[i][k] != 0);
        }
    }
}

/* Marks of the terrain keep it, and a hider that terrain hides shades nothing. */
TEST_WITH(terrain_and_shadows_go_together, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct spot here = {0, 0, 0}, at = {0, 5, 0};
    struct lm_target targets[2] = {target_with_signature(46, 11, 0), point_at(46, 11, 0, 10)};
    int32_t horizon[CELLS];
    for (int i = 0; i < CELLS; i++) {
        horizon[i] = INT32_MIN;
    }
    put_at(&targets[0], &here);
    put_at(&targets[1], &at);
    make_patch(f, targets, 2, true);
    assert_false(f->points.scatterer[1].is_hidden);
    make_patch(f, targets, 2, false);
    for (uint32_t k = 0; k < LINES; k++) {
        lm_target_patch_mark_hidden(&f->points, k, horizon, BITS, CELLS - 1);
    }
    assert_true(f->points.scatterer[1].is_hidden);
    assert_false(f->points.scatterer[0].is_hidden);
}

TEST_WITH(a_point_is_shaded_on_the_first_and_the_last_line_of_a_patch, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    int first = 0, last = 0;
    for (int right_m = -66; right_m <= 66; right_m += right_m == -60 ? 120 : 1) {
        const struct spot here = {right_m, 0, 0}, at = {right_m, 5, 0};
        struct lm_target targets[2] = {target_with_signature(46, 11, 0), point_at(46, 11, 0, 10)};
        put_at(&targets[0], &here);
        put_at(&targets[1], &at);
        make_patch(f, targets, 2, false);
        const struct lm_patch_scatterer *point = &f->points.scatterer[1];
        if (point->line >= 0 && point->line < LINES) {
            assert_true(point->is_shaded);
            first += point->line == 0;
            last += point->line == LINES - 1;
        }
    }
    assert_true(first > 0 && last > 0);
}
