/* Signatures: which chip is chosen, how it is read and reduced, and how it is laid over cells,
 * against the double-precision reference. */
#include "check.h"
#include "reference/chip.h"
#include "signature_image.h"

#include "lm/chip_patch.h"

#include <stdlib.h>

enum { POLLS = 16 };

static const double degree = 3.14159265358979323846 / 180;

static int set_up(void **state)
{
    struct signature_world *f = calloc(1, sizeof *f);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    assert_int_equal(open_signature_world(f, &spec), 0);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct signature_world *f = *state;
    close_signature_world(f);
    free(f);
    return 0;
}

TEST_WITH(the_chip_nearest_to_the_bearing_and_the_depression_is_chosen, set_up, tear_down)
{
    const struct signature_world *f = *state;
    struct hs_rng r;
    hs_rng_seed(&r, 1);
    for (int k = 0; k < 20000; k++) {
        const fx_bam_t bearing = (fx_bam_t)hs_rng_u64(&r);
        const double degrees = bearing * 360.0 / 4294967296.0, step = 360.0 / ASPECTS;
        const double elevation = 90 * hs_rng_uniform(&r);
        const struct lm_chip_choice c =
            lm_signature_choose(&f->signature, bearing, hs_bam(elevation));
        const double off = remainder(degrees - c.aspect * step, 360);
        assert_true(c.aspect < ASPECTS && fabs(off) <= step / 2 + 1e-6);
        assert_true(fabs((int32_t)c.turn * 360.0 / 4294967296.0 - off) < 1e-6);
        if (fabs(elevation - 20) > 1e-6) {
            assert_int_equal(c.depression, elevation > 20);
        }
    }
}

TEST_WITH(records_with_a_number_out_of_bounds_are_refused, set_up, tear_down)
{
    const struct signature_world *f = *state;
    assert_int_equal(lm_signature_check(&f->signature, CHIPS), LM_OK);
    assert_int_equal(lm_signature_check(&f->signature, CHIPS - 1), LM_ERR_CORRUPT);
    for (int k = 0; k < 12; k++) {
        struct lm_signature s = f->signature;
        switch (k) {
        case 0:
            s.aspects = 0;
            break;
        case 1:
            s.aspects = 129;
            break;
        case 2:
            s.depressions = 0;
            break;
        case 3:
            s.depressions = 9;
            break;
        case 4:
            s.origin_row = 65;
            break;
        case 5:
            s.pixel_mm = 9;
            break;
        case 6:
            s.pixel_mm = 16001;
            break;
        case 7:
            s.depression[1] = s.depression[0];
            break;
        case 8:
            s.depression[1] = FX_BAM_90;
            break;
        case 9:
            s.chip0 = 1;
            break;
        case 10:
            s.height_mm = LM_SIGNATURE_HEIGHT_MAX_MM + 1;
            break;
        case 11: /* as many chips as there are, and 2^32 before them */
            s.chip0 = 0u - CHIPS;
            break;
        }
        assert_int_equal(lm_signature_check(&s, CHIPS), LM_ERR_CORRUPT); /* not sealed */
        seal_signature(&s);
        assert_int_equal(lm_signature_check(&s, CHIPS), LM_ERR_CORRUPT);
    }
    struct lm_chip c = make_chip(3, 1);
    assert_int_equal(lm_chip_check(&c, 0, 3, 1), LM_OK);
    assert_int_equal(lm_chip_check(&c, 0, 4, 1), LM_ERR_CORRUPT);
    assert_int_equal(lm_chip_check(&c, 1, 3, 1), LM_ERR_CORRUPT);
    assert_int_equal(lm_chip_check(&c, 0, 3, 0), LM_ERR_CORRUPT);
    c.level[9][9] ^= 1;
    assert_int_equal(lm_chip_check(&c, 0, 3, 1), LM_ERR_CORRUPT);
}

TEST_WITH(a_record_that_is_not_there_or_not_read_is_told_apart, set_up, tear_down)
{
    struct signature_world *f = *state;
    struct lm_signature s;
    assert_int_equal(lm_signature_read(&f->db, 0, &s, POLLS), LM_OK);
    assert_int_equal(lm_signature_read(&f->db, 1, &s, POLLS), LM_ERR_RANGE);
    f->flash.fail_every = 1;
    assert_int_equal(lm_signature_read(&f->db, 0, &s, POLLS), LM_ERR_IO);
    f->flash.fail_every = 0;
    f->with.bytes[f->with.head_at + 64 + 30] ^= 1;
    assert_int_equal(lm_signature_read(&f->db, 0, &s, POLLS), LM_ERR_CORRUPT);
}

/* A view from which nothing was seen returns nothing. */
TEST_WITH(a_cross_section_is_that_of_its_code_and_of_code_0_none, set_up, tear_down)
{
    const struct signature_world *f = *state;
    struct lm_signature s = f->signature;
    assert_int_equal(lm_signature_rcs_dbsm_q8(&s, 0, hs_bam(10)), 22 * 256 + 128);
    s.rcs[0][0] = 0;
    assert_int_equal(lm_signature_rcs_dbsm_q8(&s, 0, hs_bam(10)), LM_RCS_NONE_DBSM_Q8);
    assert_int_equal(lm_signature_rcs_dbsm_q8(&s, 0, hs_bam(30)), 22 * 256 + 128);
}

TEST_WITH(a_head_that_does_not_hold_makes_the_image_unsound, set_up, tear_down)
{
    struct signature_world *f = *state;
    static const struct {
        size_t at;
        uint32_t value;
    } wrong[] = {{0, 2}, {0, 17}, {4, 1151}, {8, CHIPS + 1}, {8, 0xFFFFFFFF}, {12, 4671}};
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
        uint8_t *at = f->with.bytes + f->with.head_at + wrong[k].at, old[4];
        struct lm_db db;
        memcpy(old, at, 4);
        put(at, wrong[k].value, 4);
        seal_image(&f->with);
        assert_int_equal(lm_db_open(&db, &f->flash.port, POLLS), LM_ERR_CORRUPT);
        memcpy(at, old, 4);
        seal_image(&f->with);
        assert_int_equal(lm_db_open(&db, &f->flash.port, POLLS), LM_OK);
        f->with.bytes[f->with.head_at + 60] ^= 1;
        assert_int_equal(lm_db_open(&db, &f->flash.port, POLLS), LM_ERR_CORRUPT);
        seal_image(&f->with);
    }
}

/* ---- loading ---- */

/* Targets with the signature near the centre, each turned another way, and the scene of a patch
 * seen from the west. */
static void choose(struct signature_world *f, const struct lm_target *targets, uint32_t count,
                   uint32_t cell_mm, struct lm_target_candidates *candidates)
{
    const struct lm_target_set set = set_with_signature(f, targets, count);
    const struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = 1000};
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, scene.position);
    const struct lm_chip_query chips = {.centre = scene.position,
                                        .reach_m = scene.reach_m,
                                        .radar =
                                            lm_geo_direct(&origin, FX_BAM_DEG(270), 20000 * 256),
                                        .heights = {6000 * 1024, 0},
                                        .cell_mm = cell_mm,
                                        .side_most = LM_CHIP_SIDE};
    lm_target_candidates_select(candidates, &set, &scene);
    lm_chips_choose(&f->chips, candidates, &chips);
}

TEST_WITH(a_chip_is_read_and_holds_the_power_and_the_shadow_of_its_pixels, set_up, tear_down)
{
    struct signature_world *f = *state;
    const struct lm_target t = target_with_signature(46, 11, 30);
    static const uint32_t cells_mm[] = {500, 999, 1000, 2000, 4000, 7999};
    for (int k = 0; k < 6; k++) {
        struct lm_target_candidates candidates;
        f->chip_source = (struct lm_chip_source){f->db.chips_offset, 0};
        lm_chips_init(&f->chips, &f->chip_source, &f->signature);
        choose(f, &t, 1, cells_mm[k], &candidates);
        assert_null(lm_chip_of(&candidates.candidate[0]));
        assert_true(serve_chips(f));
        const struct lm_chip_slot *slot = lm_chip_of(&candidates.candidate[0]);
        assert_non_null(slot);
        /* The radar stands to the west, 240 degrees from its nose; 16.7 degrees up. */
        const struct lm_chip chip = make_chip(240 * ASPECTS / 360, 0);
        const double total_db = 10 * log10(ref_chip_total_m2(&chip));
        assert_true(fabs(slot->total_dbsm_q8 / 256.0 - total_db) < 0.05);
        assert_true(slot->pixel_mm <= cells_mm[k] && 2 * slot->pixel_mm > cells_mm[k]);
        double power = 0, dark = 0;
        for (uint32_t i = 0; i < (uint32_t)slot->side * slot->side; i++) {
            power += ldexp(lm_chip_pixel(slot->power_q31, i / slot->side, i % slot->side), -31);
            dark += lm_chip_pixel(slot->shadow, i / slot->side, i % slot->side) / 255.0;
        }
        assert_true(fabs(10 * log10(power)) < 0.05);
        assert_true(fabs(dark * pow(slot->pixel_mm / 1000.0, 2) / (22 * 12 * 0.25) - 1) < 0.02);
    }
    struct lm_target_candidates candidates;
    choose(f, &t, 1, 8100, &candidates); /* 32 m of chip in less than four cells */
    assert_null(candidates.candidate[0].chip);
}

TEST_WITH(damage_and_failure_leave_a_target_without_chip_and_are_counted, set_up, tear_down)
{
    struct signature_world *f = *state;
    const struct lm_target t = target_with_signature(46, 11, 30);
    struct lm_target_candidates candidates;
    uint8_t *chip = f->with.bytes + f->with.chips_at + 16 * LM_CHIP_BYTES;
    chip[100] ^= 1;
    choose(f, &t, 1, 1000, &candidates);
    assert_true(serve_chips(f));
    assert_null(lm_chip_of(&candidates.candidate[0]));
    assert_int_equal(f->chips.count.corrupt, 1);
    chip[100] ^= 1;
    f->flash.fail_read = f->flash.reads + 1;
    choose(f, &t, 1, 1000, &candidates); /* tried again */
    assert_true(serve_chips(f));
    assert_null(lm_chip_of(&candidates.candidate[0]));
    assert_int_equal(f->chips.count.io_errors, 1);
    choose(f, &t, 1, 1000, &candidates);
    assert_true(serve_chips(f));
    assert_non_null(lm_chip_of(&candidates.candidate[0]));
}

TEST_WITH(chips_are_shared_kept_and_bounded, set_up, tear_down)
{
    struct signature_world *f = *state;
    struct lm_target t[ASPECTS + 1];
    struct lm_target_candidates candidates;
    for (int k = 0; k <= ASPECTS; k++) {
        t[k] = target_with_signature(46, 11, k * 360.0 / ASPECTS);
    }
    choose(f, t, 8, 1000, &candidates);
    assert_true(serve_chips(f));
    assert_int_equal(f->chips.count.read, 8);
    t[1] = t[0];
    choose(f, t, 8, 1000, &candidates);
    assert_true(serve_chips(f));
    assert_int_equal(f->chips.count.read, 8);
    assert_ptr_equal(candidates.candidate[0].chip, candidates.candidate[1].chip);
    choose(f, t + 1, ASPECTS, 1000, &candidates);
    assert_true(serve_chips(f));
    uint32_t with_chip = 0;
    for (uint32_t i = 0; i < candidates.count; i++) {
        with_chip += lm_chip_of(&candidates.candidate[i]) != NULL;
    }
    /* The first and the last of them look alike. */
    assert_int_equal(with_chip, LM_CHIPS_MAX + 1);
    assert_int_equal(f->chips.count.left_out, ASPECTS - LM_CHIPS_MAX - 1);
}

/* New ones come first in the list: they must not take the slots of those that are still shown. */
TEST_WITH(chips_that_are_shown_keep_their_slots_when_new_ones_come, set_up, tear_down)
{
    enum { NEW = 6 };
    struct signature_world *f = *state;
    struct lm_target t[LM_CHIPS_MAX + NEW];
    struct lm_target_candidates candidates;
    for (int k = 0; k < LM_CHIPS_MAX + NEW; k++) {
        t[k] = target_with_signature(46, 11, k * 360.0 / ASPECTS);
    }
    choose(f, t + NEW, LM_CHIPS_MAX, 1000, &candidates);
    assert_true(serve_chips(f));
    assert_int_equal(f->chips.count.read, LM_CHIPS_MAX);
    choose(f, t, LM_CHIPS_MAX, 1000, &candidates);
    for (uint32_t i = 0; i < LM_CHIPS_MAX; i++) {
        assert_int_equal(lm_chip_of(&candidates.candidate[i]) != NULL, i >= NEW);
    }
    assert_true(serve_chips(f));
    assert_int_equal(f->chips.count.read, LM_CHIPS_MAX + NEW);
    assert_int_equal(f->chips.count.left_out, 0);
    /* With no slot free, what is there stays and what is new is left out. */
    choose(f, t, LM_CHIPS_MAX + NEW, 1000, &candidates);
    for (uint32_t i = 0; i < LM_CHIPS_MAX + NEW; i++) {
        assert_int_equal(lm_chip_of(&candidates.candidate[i]) != NULL, i < LM_CHIPS_MAX);
    }
    assert_int_equal(f->chips.count.left_out, NEW);
}

static void seal_chip_at(struct signature_world *f, uint32_t number, const struct lm_chip *c)
{
    memcpy(f->with.bytes + f->with.chips_at + number * LM_CHIP_BYTES, c, sizeof *c);
}

/* Chips as weak as they come: one pixel of -20 dBsm, and none at all. */
TEST_WITH(a_weak_chip_keeps_its_power_and_one_without_any_shows_nothing, set_up, tear_down)
{
    struct signature_world *f = *state;
    const struct lm_target t = target_with_signature(46, 11, 30);
    for (int lit = 0; lit < 2; lit++) {
        struct lm_target_candidates candidates;
        struct lm_chip c = make_chip(16, 0);
        memset(c.level, 0, sizeof c.level);
        c.level[20][30] = lit ? code_of(-20) : 0;
        seal_chip(&c);
        seal_chip_at(f, 16, &c);
        lm_chips_init(&f->chips, &f->chip_source, &f->signature);
        choose(f, &t, 1, 1000, &candidates);
        assert_true(serve_chips(f));
        const struct lm_chip_slot *slot = lm_chip_of(&candidates.candidate[0]);
        assert_non_null(slot);
        const uint32_t power = slot->power_q31[slot->side][slot->side];
        if (lit) {
            assert_true(fabs(power / 2147483648.0 - 1) < 1e-6);
            assert_true(fabs(slot->total_dbsm_q8 / 256.0 + 20) < 0.05);
            assert_int_equal(slot->lit.row, 10);
            assert_int_equal(slot->lit.column, 15);
        } else {
            assert_int_equal(power, 0);
            assert_int_equal(slot->total_dbsm_q8, LM_SIGNATURE_CODE_ZERO_DBSM_Q8);
            assert_int_equal(slot->lit.row_end, 0);
        }
        assert_true(slot->dark.row_end > 0); /* its shadow is there */
    }
}

/* Two signatures with the same chips, and one target seen under either depression. */
TEST_WITH(chips_of_another_signature_depression_or_reduction_are_others, set_up, tear_down)
{
    struct signature_world *f = *state;
    const struct lm_signature both[2] = {f->signature, f->signature};
    const struct lm_chip_source sources[2] = {f->chip_source, f->chip_source};
    struct lm_target t[2] = {target_with_signature(46, 11, 30), target_with_signature(46, 11, 30)};
    t[1].signature = 1;
    const struct lm_target_set set = {
        .items = t, .count = 2, .signatures = both, .signature_count = 2};
    const struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = 1000};
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, scene.position);
    lm_chips_init(&f->chips, sources, both);
    struct lm_chip_query query = {.centre = scene.position,
                                  .reach_m = scene.reach_m,
                                  .radar = lm_geo_direct(&origin, FX_BAM_DEG(270), 20000 * 256),
                                  .heights = {6000 * 1024, 0},
                                  .cell_mm = 1000,
                                  .side_most = LM_CHIP_SIDE};
    struct lm_target_candidates candidates;
    lm_target_candidates_select(&candidates, &set, &scene);
    lm_chips_choose(&f->chips, &candidates, &query);
    const struct lm_chip_slot *low = candidates.candidate[0].chip;
    assert_ptr_not_equal(low, candidates.candidate[1].chip);
    assert_int_equal(low->key.depression, 0);
    query.heights.antenna_m_q10 = 12000 * 1024; /* 31 degrees */
    lm_chips_choose(&f->chips, &candidates, &query);
    assert_int_equal(candidates.candidate[0].chip->key.depression, 1);
    /* No more pixels than asked for, nor fewer than 4. */
    query.side_most = 10;
    lm_chips_choose(&f->chips, &candidates, &query);
    assert_int_equal(candidates.candidate[0].chip->side, 8);
    query.side_most = 1;
    lm_chips_choose(&f->chips, &candidates, &query);
    assert_int_equal(candidates.candidate[0].chip->side, LM_CHIP_SIDE >> 4);
    /* Out of the picture nobody needs it. */
    query.centre = lm_geo_direct(&origin, 0, (1000 + LM_TARGET_EXTENT_M + 2) * 256);
    lm_chips_choose(&f->chips, &candidates, &query);
    assert_null(candidates.candidate[0].chip);
    query.centre = lm_geo_direct(&origin, 0, (1000 + LM_TARGET_EXTENT_M - 2) * 256);
    lm_chips_choose(&f->chips, &candidates, &query);
    assert_non_null(candidates.candidate[0].chip);
}

/* The flash still writes the chip that was asked for when another picture wants as many as there
 * are slots: none of them gets that one's. */
TEST_WITH(a_slot_is_not_given_away_while_it_is_read, set_up, tear_down)
{
    struct signature_world *f = *state;
    struct lm_target t[LM_CHIPS_MAX + 1];
    struct lm_target_candidates first, candidates;
    for (int k = 0; k <= LM_CHIPS_MAX; k++) {
        t[k] = target_with_signature(46, 11, k * 360.0 / ASPECTS);
    }
    f->flash.busy_polls = 3;
    choose(f, t, 1, 1000, &first);
    lm_chips_service(&f->chips, &f->tiles);
    lm_tile_cache_service(&f->tiles, 0, 1);
    lm_chips_service(&f->chips, &f->tiles); /* which has nothing to do yet */
    assert_ptr_equal(f->chips.busy, first.candidate[0].chip);
    assert_int_equal(f->chips.count.read, 0);
    choose(f, t + 1, LM_CHIPS_MAX, 1000, &candidates);
    assert_int_equal(f->chips.count.left_out, 1);
    for (uint32_t i = 0; i < candidates.count; i++) {
        assert_ptr_not_equal(candidates.candidate[i].chip, f->chips.busy);
    }
    f->flash.busy_polls = f->flash.now.polls_left = 0;
    assert_true(serve_chips(f));
    assert_int_equal(f->chips.count.read, LM_CHIPS_MAX);
    choose(f, t, LM_CHIPS_MAX, 1000, &candidates);
    assert_non_null(lm_chip_of(&candidates.candidate[0])); /* it was read to its end */
}

/* ---- laying ---- */

struct score {
    double worst_power_db, shadow, cross, squares[2];
};

static bool is_in(const struct lm_chip_reach *r, int32_t right, int32_t beyond)
{
    return right >= r->right && right < r->right_end && beyond >= r->beyond &&
           beyond < r->beyond_end;
}

/* Every cell around the origin against the reference, the grid shifted by up to half a cell. Beyond
 * the lay's reach, nothing is taken from it. */
static void score_lay(const struct lm_chip_patch *chip, const struct ref_chip *ref, int block,
                      double cell_m, int32_t shift_q8, struct score *s)
{
    double fixed = 0, exact = 0, dark = 0, exact_dark = 0;
    const int32_t around = (int32_t)(30 / cell_m) + 4; /* all of the chip */
    for (int32_t i = -around; i <= around; i++) {
        for (int32_t k = -around; k <= around; k++) {
            const int32_t right_q8 = k * 256 + shift_q8, beyond_q8 = i * 256 - shift_q8;
            const double right_m = right_q8 * cell_m / 256, beyond_m = beyond_q8 * cell_m / 256;
            const double truth = ref_chip_cell_m2(ref, block, right_m, beyond_m, cell_m);
            const int32_t q8 = is_in(&chip->lit, k, i)
                                   ? lm_chip_patch_rcs_dbsm_q8(chip, right_q8, beyond_q8)
                                   : LM_RCS_NONE_DBSM_Q8;
            const double got = q8 <= LM_RCS_NONE_DBSM_Q8 ? 0 : pow(10, q8 / 2560.0);
            fixed += got;
            exact += truth;
            s->cross += got * truth;
            s->squares[0] += got * got;
            s->squares[1] += truth * truth;
            if (is_in(&chip->dark, k, i)) {
                dark +=
                    lm_chip_patch_shadow(chip, right_q8, beyond_q8) / (double)LM_CHIP_SHADOW_ALL;
            }
            exact_dark += ref_chip_cell_shadow(ref, right_m, beyond_m, cell_m);
        }
    }
    assert_true(fabs(10 * log10(exact / ref_chip_total_m2(ref->chip))) < 0.1);
    s->worst_power_db = fmax(s->worst_power_db, fabs(10 * log10(fixed / exact)));
    s->shadow = fmax(s->shadow, fabs(dark / exact_dark - 1));
}

TEST_WITH(a_chip_laid_over_cells_of_any_size_and_turn_agrees_with_the_reference, set_up, tear_down)
{
    struct signature_world *f = *state;
    struct hs_rng r;
    hs_rng_seed(&r, 3);
    struct score s = {0};
    for (int k = 0; k < 60; k++) {
        struct lm_target_candidates candidates;
        const double heading = 360 * hs_rng_uniform(&r);
        const double cell_m = 0.25 + (k % 12) * 0.34;
        const struct lm_target t = target_with_signature(46, 11, heading);
        choose(f, &t, 1, (uint32_t)lround(cell_m * 1000), &candidates);
        assert_true(serve_chips(f));
        const struct lm_chip_slot *slot = lm_chip_of(&candidates.candidate[0]);
        const struct lm_smear still = lm_smear_of(0, 0);
        struct lm_chip_patch lay;
        const struct lm_chip_cells cells = {.cell_mm = (uint32_t)lround(cell_m * 1000),
                                            .wide_q16 = 65536};
        lm_chip_patch_set(&lay, slot, candidates.candidate[0].chip_turn, &cells, &still);
        const struct lm_chip chip = make_chip(slot->key.aspect, slot->key.depression);
        const struct ref_chip ref = {&chip, PIXEL_MM / 1000.0, ORIGIN_ROW,
                                     (int32_t)candidates.candidate[0].chip_turn * 360.0 /
                                         4294967296.0 * degree};
        score_lay(&lay, &ref, 1 << slot->key.shift, cell_m, (int32_t)hs_rng_below(&r, 256) - 128,
                  &s);
    }
    const double likeness = s.cross / sqrt(s.squares[0] * s.squares[1]);
    print_message("# all of it within %.3f dB, cells alike to %.5f, shadow within %.1f %%\n",
                  s.worst_power_db, likeness, 100 * s.shadow);
    assert_true(s.worst_power_db < 0.1);
    assert_true(likeness > 0.99);
    assert_true(s.shadow < 0.02);
}
