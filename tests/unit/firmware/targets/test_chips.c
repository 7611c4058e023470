/* Chips: how they are read beside other parts of the unit, and how they lie over the ends of a line
 * and of a patch. */
#include "check.h"
#include "signature_image.h"

#include "lm/chip_sector.h"
#include "lm/chip_slope.h"
#include "lm/level.h"
#include "lm/target_patch.h"

#include <stdlib.h>

enum { CELLS = 200, GUARD = 16, LEVEL_Q8 = -20 * 256 };

struct fixture {
    struct signature_world world; /* first: see tear_down_signature_world */
    struct lm_target target;
    struct lm_target_candidates candidates;
    struct lm_target_patch patch;
};

static const struct lm_position centre = {FX_BAM_DEG(46), FX_BAM_DEG(11)};

static int set_up(void **state)
{
    return set_up_signature_world(state, sizeof(struct fixture));
}

/* The target at 46 N 11 E, seen from 20 km west and 6 km above; its chip is asked for. */
static const struct lm_target_candidate *choose(struct fixture *f)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, centre);
    f->target = target_with_signature(46, 11, 30);
    const struct lm_target_set set = set_with_signature(&f->world, &f->target, 1);
    const struct lm_target_query scene = {.position = centre, .reach_m = 20000};
    const struct lm_chip_query query = {.centre = centre,
                                        .reach_m = scene.reach_m,
                                        .radar =
                                            lm_geo_direct(&origin, FX_BAM_DEG(270), 20000 * 256),
                                        .heights = {6000 * 1024, 0},
                                        .cell_mm = 1000,
                                        .side_most = LM_CHIP_SIDE};
    lm_target_candidates_select(&f->candidates, &set, &scene);
    lm_chips_choose(&f->world.chips, &f->candidates, &query);
    return &f->candidates.candidate[0];
}

/* ---- reading ---- */

TEST_WITH(a_chip_is_none_before_it_is_resident, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target_candidate *c = choose(f);
    assert_non_null(c->chip);
    assert_null(lm_chip_of(c));
    assert_true(serve_chips(&f->world));
    assert_ptr_equal(lm_chip_of(c), c->chip);
}

TEST_WITH(a_chip_waits_while_another_part_reads_the_flash, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    uint8_t header[64];
    struct lm_flash_request other = {.destination = header, .length = sizeof header};
    choose(f);
    assert_true(lm_tile_cache_read(&f->world.tiles, &other));
    lm_chips_service(&f->world.chips, &f->world.tiles);
    assert_false(f->world.chips.is_reading);
    assert_true(serve_chips(&f->world));
    assert_int_equal(other.status, LM_OK);
    assert_int_equal(f->world.chips.count.read, 1);
}

/* The images have changed in the middle of it: what is read is nobody's, and is asked for anew. */
TEST_WITH(a_chip_that_is_being_read_when_all_are_forgotten_is_read_anew, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    struct lm_chips *chips = &f->world.chips;
    choose(f);
    lm_chips_service(chips, &f->world.tiles);
    assert_true(chips->is_reading);
    lm_chips_empty(chips);
    assert_true(lm_chips_are_settled(chips));
    const struct lm_target_candidate *c = choose(f);
    assert_true(serve_chips(&f->world));
    assert_non_null(lm_chip_of(c));
    assert_int_equal(chips->count.read, 1);
    assert_int_equal(chips->count.io_errors + chips->count.corrupt, 0);
    lm_chips_empty(chips); /* with nothing under way */
    assert_null(lm_chip_of(c));
}

/* ---- in a line ---- */

/* A line of cells of a metre that looks east from 20 km west, its first cell so far from there. */
static struct lm_target_line line_from(double first_m)
{
    return (struct lm_target_line){.azimuth = FX_BAM_90,
                                   .width = FX_BAM_DEG(1) / 50, /* 7 m there */
                                   .first_m_q8 = (uint32_t)lround(first_m * 256),
                                   .cell_m_q8 = 256,
                                   .cells = CELLS,
                                   .height_m_q10 = 6000 * 1024,
                                   .wavelength_um = X_BAND_UM};
}

struct drawn {
    uint32_t given, brighter, darker;
};

/* Draw the chip into a line over level ground, or ground that rises by so much a cell. */
static struct drawn draw(const struct lm_target_candidate *c, const struct lm_target_line *line,
                         double rise_m)
{
    const struct lm_chip_sector_origin at = {.range_m_q8 = 20000 * 256};
    static int32_t elevation_m_q14[CELLS];
    int16_t guarded[GUARD + CELLS + GUARD], *level = guarded + GUARD;
    struct lm_target_line l = *line;
    struct drawn d = {0, 0, 0};
    for (int i = 0; i < GUARD + CELLS + GUARD; i++) {
        guarded[i] = LEVEL_Q8;
    }
    for (int i = 0; i < CELLS; i++) {
        elevation_m_q14[i] = (int32_t)lround(rise_m * i * 16384);
    }
    l.elevation_m_q14 = rise_m == 0 ? NULL : elevation_m_q14;
    d.given = lm_chip_sector_add(c, &at, &l, 0, level);
    for (int i = -GUARD; i < CELLS + GUARD; i++) {
        assert_true(level[i] == LEVEL_Q8 || (i >= (int)line->first && i < CELLS));
        d.brighter += level[i] > LEVEL_Q8;
        d.darker += level[i] < LEVEL_Q8;
    }
    return d;
}

/* As a line begins later and later, first the shadow's end comes into it, then the target, and at
 * last both have gone before it. */
TEST_WITH(a_chip_lies_over_the_ends_of_a_line_as_far_as_it_goes, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    const struct lm_target_candidate *c = choose(f);
    uint32_t parts = 0;
    assert_true(serve_chips(&f->world));
    for (int is_rising = 0; is_rising < 2; is_rising++) {
        const struct lm_target_line middle = line_from(20000 - CELLS / 2);
        const struct drawn whole = draw(c, &middle, is_rising * 1e-3);
        assert_true(whole.given >= 3 && whole.brighter >= 3 && whole.darker >= 5);
        for (int off = -CELLS; off <= CELLS; off++) {
            const struct lm_target_line line = line_from(20000 - CELLS / 2 + off);
            const struct drawn d = draw(c, &line, is_rising * 1e-3);
            assert_true(d.given <= whole.given + 1 && d.darker <= whole.darker + 1);
            if (abs(off) > CELLS / 2 + 30) {
                assert_int_equal(d.given + d.brighter + d.darker, 0);
            }
            parts += d.given != 0 && d.given < whole.given;
        }
        struct lm_target_line later = middle;
        later.first = CELLS / 2; /* cells before the middle are not displayed */
        const struct drawn d = draw(c, &later, is_rising * 1e-3);
        assert_true(d.given < whole.given && d.darker > 0);
    }
    assert_true(parts > 4);
}

/* The line of the picture: the chip is drawn where its top is seen, and as a point where the mode
 * stretches targets. */
TEST_WITH(a_target_with_a_chip_is_drawn_by_it_if_its_top_is_seen_and_it_is_not_stretched, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    struct lm_geo_origin origin;
    int32_t horizon[LM_CELLS_ROOM];
    struct lm_target_line line = line_from(20000 - CELLS / 2);
    uint32_t given[3];
    lm_geo_set_origin(&origin, centre);
    line.position = lm_geo_direct(&origin, FX_BAM_DEG(270), 20000 * 256);
    uint32_t distance_m_q8;
    lm_geo_inverse(line.position, centre, &distance_m_q8, &line.azimuth);
    choose(f);
    assert_true(serve_chips(&f->world));
    for (int how = 0; how < 3; how++) {
        int16_t level_q8[LM_CELLS_ROOM];
        for (int i = 0; i < LM_CELLS_ROOM; i++) {
            level_q8[i] = LEVEL_Q8;
            horizon[i] = how == 1 ? INT32_MAX : INT32_MIN;
        }
        const struct lm_target_horizon sight = {horizon, 30};
        line.stretch_cells = how == 2 ? 2 : 0;
        given[how] = lm_target_line_add(&f->candidates, &line, &sight, level_q8);
    }
    assert_true(given[0] >= 3); /* its corners */
    assert_int_equal(given[1], 0);
    assert_int_equal(given[2], 1); /* a point, though of several cells */
}

TEST_WITH(a_chip_turned_by_any_angle_has_all_its_power_in_the_line, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    struct lm_target_candidate c = *choose(f);
    assert_true(serve_chips(&f->world));
    for (int deg = 0; deg < 360; deg += 15) {
        struct lm_target_line line = line_from(20000 - CELLS / 2);
        line.width = FX_BAM_DEG(1) / 5; /* 70 m: no pixel is beside it */
        c.chip_turn = hs_bam(deg);
        const struct drawn d = draw(&c, &line, 0);
        assert_true(d.given >= 3 && d.given <= 9);
        assert_int_equal(d.brighter + d.darker > 0, 1);
    }
}

/* Pixels of 8 m, reduced, in cells of a quarter of a metre: 1,000 times as large, and more cells
 * than a chip may have. */
TEST_WITH(a_chip_of_more_cells_than_there_is_room_for_is_cut_off, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    struct lm_target_candidate c = *choose(f);
    assert_true(serve_chips(&f->world));
    struct lm_chip_slot large = *c.chip;
    c.chip = &large;
    const struct lm_target_line fine = {.azimuth = FX_BAM_90,
                                        .width = FX_BAM_DEG(1) / 5,
                                        .first_m_q8 = (20000 - CELLS / 8) * 256,
                                        .cell_m_q8 = 64,
                                        .cells = CELLS,
                                        .height_m_q10 = 6000 * 1024,
                                        .wavelength_um = X_BAND_UM};
    large.pixel_mm = 8000;
    const struct drawn cut = draw(&c, &fine, 0);
    assert_true(cut.given <= 6);
    struct lm_target_line finest = fine;
    finest.width = FX_BAM_DEG(1) / 20000; /* 17 mm */
    large.pixel_mm = 256000;
    assert_true(draw(&c, &finest, 0).darker <= CELLS);
}

TEST_WITH(a_chip_without_a_shadow_darkens_nothing, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    for (uint32_t k = 0; k < CHIPS; k++) {
        struct lm_chip *const chip =
            (struct lm_chip *)(void *)(f->world.with.bytes + f->world.with.chips_at +
                                       k * LM_CHIP_BYTES);
        memset(chip->shadow, 0, sizeof chip->shadow);
        seal_chip(chip);
    }
    const struct lm_target_candidate *c = choose(f);
    assert_true(serve_chips(&f->world));
    const struct lm_target_line line = line_from(20000 - CELLS / 2);
    const struct drawn d = draw(c, &line, 0);
    assert_true(d.brighter >= 3);
    assert_int_equal(d.darker, 0);
}

/* ---- on a slope ---- */

TEST(a_ray_that_does_not_sink_has_a_slope_of_the_most_cells_a_metre)
{
    const struct lm_target_heights h = {6000 * 1024, 0};
    struct lm_chip_slope level, none;
    lm_chip_slope_set(&level, 0, 20000 * 256, 256, &h);
    lm_chip_slope_set(&none, 0, 20000 * 256, 0, &h); /* cells of no length */
    assert_true(level.cells_a_metre_q16 > 0 && level.cells_a_metre_q16 < none.cells_a_metre_q16);
    assert_int_equal(none.cells_a_metre_q16, 1 << 26);
}

/* ---- in a patch ---- */

static struct lm_patch_geometry geometry_of(uint32_t cells)
{
    return (struct lm_patch_geometry){.centre = centre,
                                      .look = FX_BAM_90,
                                      .centre_m_q8 = 20000 * 256,
                                      .cell_m_q8 = 256,
                                      .lines = 128,
                                      .cells = cells,
                                      .traced = cells,
                                      .heights = {6000 * 1024, 0},
                                      .wavelength_um = X_BAND_UM,
                                      .lean_q16 = 19661,
                                      .dwell_ms = 2000};
}

static void slope_of(int32_t *elevation_m_q14, double rise_m)
{
    for (int i = 0; i < LM_CELLS_ROOM; i++) {
        elevation_m_q14[i] = (int32_t)lround(rise_m * i * 16384);
    }
}

TEST_WITH(the_slope_under_a_chip_is_taken_once, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    static int32_t elevation_m_q14[LM_CELLS_ROOM];
    const struct lm_patch_geometry g = geometry_of(128);
    choose(f);
    assert_true(serve_chips(&f->world));
    lm_target_patch_set(&f->patch, &f->candidates, &g);
    const struct lm_patch_chip *chip = &f->patch.chip[0];
    const uint32_t line = (uint32_t)f->patch.scatterer[chip->scatterer].line;
    slope_of(elevation_m_q14, 0.1);
    assert_false(chip->slope.is_known);
    lm_target_patch_lean(&f->patch, line, elevation_m_q14, &g);
    assert_true(chip->slope.is_known);
    const uint32_t stretch_q16 = chip->slope.stretch_q16;
    assert_true(stretch_q16 > 65536);
    slope_of(elevation_m_q14, -0.1);
    lm_target_patch_lean(&f->patch, line, elevation_m_q14, &g);
    assert_int_equal(chip->slope.stretch_q16, stretch_q16);
}

/* Nothing of it is lit, so that it covers no ground. */
TEST_WITH(a_chip_without_a_lit_pixel_stands_on_no_slope, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    static int32_t elevation_m_q14[LM_CELLS_ROOM];
    const struct lm_patch_geometry g = geometry_of(128);
    for (uint32_t k = 0; k < CHIPS; k++) {
        struct lm_chip *const chip =
            (struct lm_chip *)(void *)(f->world.with.bytes + f->world.with.chips_at +
                                       k * LM_CHIP_BYTES);
        memset(chip->level, 0, sizeof chip->level);
        seal_chip(chip);
    }
    choose(f);
    assert_true(serve_chips(&f->world));
    lm_target_patch_set(&f->patch, &f->candidates, &g);
    const struct lm_patch_chip *chip = &f->patch.chip[0];
    slope_of(elevation_m_q14, 0.1);
    lm_target_patch_lean(&f->patch, (uint32_t)f->patch.scatterer[chip->scatterer].line,
                         elevation_m_q14, &g);
    assert_false(chip->slope.is_known);
}

/* A patch that ends a few cells before or behind the target: its shadow and what is lit of it go as
 * far as the patch does. */
/* A patch of 64 cells on ground that rises by so much in each, and `overscan` before and behind it
 * that are traced as well. */
static void check_ends(struct fixture *f, double rise_m, uint32_t overscan)
{
    static int32_t elevation_m_q14[LM_CELLS_ROOM];
    static int16_t level_q8[LM_CELLS_ROOM];
    uint32_t lit = 0, dark = 0, dark_behind = 0;
    slope_of(elevation_m_q14, rise_m);
    for (int off_m = -60; off_m <= 60; off_m++) {
        struct lm_geo_origin origin;
        struct lm_patch_geometry g = geometry_of(64);
        g.overscan = overscan;
        g.traced = g.cells + 2 * overscan;
        lm_geo_set_origin(&origin, centre);
        g.centre = lm_geo_direct(&origin, off_m < 0 ? FX_BAM_DEG(270) : FX_BAM_90,
                                 (uint32_t)abs(off_m) * 256);
        lm_target_patch_set(&f->patch, &f->candidates, &g);
        const uint32_t middle = (uint32_t)f->patch.scatterer[0].line;
        const int32_t *elevation_of_patch_m_q14 = elevation_m_q14 + overscan;
        lm_target_patch_lean(&f->patch, middle, elevation_of_patch_m_q14, &g);
        for (uint32_t line = middle - 8; line <= middle + 8; line++) {
            for (int i = 0; i < LM_CELLS_ROOM; i++) {
                level_q8[i] = LEVEL_Q8;
            }
            lm_target_patch_shade(&f->patch, line, &g, elevation_of_patch_m_q14,
                                  level_q8 + overscan);
            for (int i = 0; i < LM_CELLS_ROOM; i++) {
                dark += level_q8[i] < LEVEL_Q8;
                dark_behind += level_q8[i] < LEVEL_Q8 && i >= (int)(overscan + g.cells);
                assert_true(level_q8[i] == LEVEL_Q8 || i < (int)g.traced);
            }
            lm_target_patch_add_chips(&f->patch, line, &g, elevation_of_patch_m_q14,
                                      level_q8 + overscan);
            for (int i = 0; i < LM_CELLS_ROOM; i++) {
                lit += level_q8[i] > LEVEL_Q8;
                assert_true(level_q8[i] == LEVEL_Q8 || i < (int)g.traced);
            }
        }
    }
    assert_true(lit > 100 && dark > 1000 && (dark_behind > 0) == (overscan > 0));
}

TEST_WITH(a_chip_lies_over_the_ends_of_a_patch_as_far_as_it_goes, set_up, tear_down_signature_world)
{
    struct fixture *f = *state;
    choose(f);
    assert_true(serve_chips(&f->world));
    check_ends(f, 0.05, 0);
    check_ends(f, 0, 8);
}

/* Middle of the cells that a chip adds to the lines beside its own, where the ground is `higher_m`
 * higher than below its origin. */
static double middle_beside(struct fixture *f, double higher_m, bool is_known, bool is_displaced)
{
    static int32_t elevation_m_q14[LM_CELLS_ROOM];
    static int16_t level_q8[LM_CELLS_ROOM];
    const struct lm_patch_geometry g = geometry_of(64);
    double sum = 0, cells = 0;
    lm_target_patch_set(&f->patch, &f->candidates, &g);
    const uint32_t line = (uint32_t)f->patch.scatterer[0].line;
    slope_of(elevation_m_q14, 0);
    if (is_known) {
        lm_target_patch_lean(&f->patch, line, elevation_m_q14, &g);
    }
    f->patch.scatterer[0].is_displaced = is_displaced;
    for (int i = 0; i < LM_CELLS_ROOM; i++) {
        elevation_m_q14[i] = (int32_t)(higher_m * 16384);
    }
    for (uint32_t beside = line - 8; beside <= line + 8; beside++) {
        for (int i = 0; i < LM_CELLS_ROOM; i++) {
            level_q8[i] = LM_LEVEL_SHADOW;
        }
        if (beside != line) {
            lm_target_patch_add_chips(&f->patch, beside, &g, elevation_m_q14, level_q8);
        }
        for (int i = 0; i < LM_CELLS_ROOM; i++) {
            sum += level_q8[i] > LM_LEVEL_SHADOW ? i : 0;
            cells += level_q8[i] > LM_LEVEL_SHADOW;
        }
    }
    assert_true(cells > 0);
    return sum / cells;
}

/* Ground that is higher across is laid over, by up to one in one. What is displaced stands
 * elsewhere, and of what has not been met yet nobody knows the ground. */
TEST_WITH(a_chip_leans_on_the_ground_across_where_it_stands_and_is_known, set_up,
          tear_down_signature_world)
{
    struct fixture *f = *state;
    choose(f);
    assert_true(serve_chips(&f->world));
    for (int known = 0; known < 2; known++) {
        for (int displaced = 0; displaced < 2; displaced++) {
            const double flat = middle_beside(f, 0, known, displaced);
            const double high = middle_beside(f, 50, known, displaced);
            assert_true(known && !displaced ? high < flat : high == flat);
        }
    }
}
