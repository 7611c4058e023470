/* Side lobes of strong returns of the map, against Taylor's response in its closed form and in a
 * patch. */
#include "check.h"
#include "lm/sar.h"
#include "lm/side_lobes.h"
#include "reference/reference.h"
#include "tiny_map.h"

#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 256, LINES = 41, MIDDLE = 20, WALL = 100, FLOOR_Q8 = -80 * 256 };

static const double pi = 3.14159265358979323846;
static struct lm_side_lobes lobes;
static int16_t picture[LINES][LM_CELLS_ROOM];

static double sinc(double x)
{
    return x == 0 ? 1 : sin(pi * x) / (pi * x);
}

/* Taylor's response, -35 dB, nbar 4: zeros of the sinc moved. */
static double taylor(double x)
{
    const double a = acosh(pow(10, 35 / 20.0)) / pi, s2 = 16 / (a * a + 12.25);
    x = fabs(x - round(x)) < 1e-6 && x != 0 ? x + 1e-6 : x; /* beside the poles */
    double h = sinc(x);
    for (int n = 1; n < 4; n++) {
        h *= (1 - x * x / (s2 * (a * a + (n - 0.5) * (n - 0.5)))) / (1 - x * x / (n * n));
    }
    return h;
}

/* The main lobe ends there. */
static const double first_null = 1.663;

/* Once line k of a field of `lines` is searched, the line that has all around it gives its side
 * lobes. */
static void add_behind(int16_t level_q8[][LM_CELLS_ROOM], uint32_t lines, uint32_t k)
{
    static int16_t beyond_q8[LM_CELLS_ROOM];
    int16_t *around[LM_SIDE_LOBES_CELLS];
    if (k < LM_RESPONSE_REACH || k - LM_RESPONSE_REACH >= lines) {
        return;
    }
    for (uint32_t n = 0; n < LM_SIDE_LOBES_CELLS; n++) {
        const uint32_t line = k - 2 * LM_RESPONSE_REACH + n; /* wraps before line 0 */
        around[n] = line < lines ? level_q8[line] : beyond_q8;
    }
    lm_side_lobes_add(&lobes, k - LM_RESPONSE_REACH, around, CELLS);
}

/* A wall of 37 dB in the dark, on the middle one of some lines. */
static const struct lm_strong_cell *draw_wall(uint32_t seed)
{
    lm_side_lobes_clear(&lobes, &lm_radar_default.sar.side_lobes);
    for (uint32_t k = 0; k < LINES; k++) {
        for (int i = 0; i < CELLS; i++) {
            picture[k][i] = FLOOR_Q8;
        }
        picture[k][WALL] = k == MIDDLE ? 37 * 256 : FLOOR_Q8;
        lm_side_lobes_find(&lobes, k, picture[k], CELLS, -46 * 256, seed);
        assert_int_equal(lobes.line[k % LM_SIDE_LOBES_LINES].count, k == MIDDLE);
        add_behind(picture, LINES, k);
    }
    return &lobes.line[MIDDLE % LM_SIDE_LOBES_LINES].strong[0];
}

TEST(a_lone_wall_has_a_cross_whose_side_lobes_are_taylors)
{
    double highest_db = -1000, worst_db = 0, own = 0;
    for (int i = 0; i < 1000; i++) {
        own += pow(taylor((i + 0.5) / 1000 - 0.5), 2) / 1000; /* wherever the point lies */
    }
    own = sqrt(own);
    for (uint32_t seed = 0; seed < 200; seed++) {
        const struct lm_strong_cell *p = draw_wall(seed);
        for (int n = -LM_RESPONSE_REACH + 1; n < LM_RESPONSE_REACH; n++) {
            const double off[2] = {(2.0 * (p->beyond / LM_SIDE_LOBES_CELLS) - 7) / 16,
                                   (2.0 * (p->right / LM_SIDE_LOBES_CELLS) - 7) / 16};
            const int32_t shown_q8[2] = {picture[MIDDLE][WALL + n], picture[MIDDLE + n][WALL]};
            for (int way = 0; way < 2 && abs(n) >= 2; way++) {
                const double x = fabs(n - off[way]);
                const double wanted_db = 20 * log10(fabs(taylor(x)) / own + 1e-9);
                const double got_db = shown_q8[way] / 256.0 - 37;
                if (x < first_null) {
                    assert_true(shown_q8[way] < -70 * 256); /* nothing */
                    continue;
                }
                highest_db = fmax(highest_db, got_db);
                if (wanted_db > -45) { /* nulls are sharper than the table's steps */
                    worst_db = fmax(worst_db, fabs(got_db - wanted_db));
                }
            }
        }
        assert_int_equal(picture[MIDDLE][WALL], 37 * 256);
        assert_int_equal(picture[MIDDLE + 3][WALL + 3], FLOOR_Q8);
        assert_int_equal(picture[MIDDLE + 9][WALL], FLOOR_Q8);
    }
    print_message("# highest side lobe %.2f dB, worst %.2f dB off\n", highest_db, worst_db);
    assert_true(fabs(highest_db + 35.1 - 0.65) < 0.4); /* 0.65 dB: the mean over places */
    assert_true(worst_db < 1);
}

TEST(of_many_strong_cells_only_the_strongest_of_a_line_count)
{
    int16_t level_q8[LM_CELLS_ROOM];
    for (int i = 0; i < CELLS; i++) {
        level_q8[i] = (int16_t)(i % 20 == 10 ? (20 + i * 7 % 13) * 256 : -30 * 256);
    }
    lm_side_lobes_clear(&lobes, &lm_radar_default.sar.side_lobes);
    lm_side_lobes_find(&lobes, 0, level_q8, CELLS, -35 * 256, 1);
    assert_int_equal(lobes.line[0].count, LM_SIDE_LOBES_A_LINE);
    int above = 0;
    for (int i = 0; i < CELLS; i++) {
        above += level_q8[i] > lobes.line[0].strong[LM_SIDE_LOBES_A_LINE - 1].level_db_q8;
    }
    assert_true(above < LM_SIDE_LOBES_A_LINE);
}

TEST(a_strong_field_among_fields_has_none)
{
    int16_t level_q8[LM_CELLS_ROOM];
    for (int i = 0; i < CELLS; i++) {
        level_q8[i] = (int16_t)(10 * 256 + i * 37 % 25 * 256);
    }
    lm_side_lobes_clear(&lobes, &lm_radar_default.sar.side_lobes);
    lm_side_lobes_find(&lobes, 0, level_q8, CELLS, -35 * 256, 1);
    assert_int_equal(lobes.line[0].count, 0);
}

/* ---- against the reference ---- */

struct score {
    uint32_t cells, changed, beyond_half_db;
    double worst_db;
};

static double level_before[LM_PATCH_LINES_MAX * CELLS], level_wanted[LM_PATCH_LINES_MAX * CELLS];
static double shadow_db[LM_PATCH_LINES_MAX];

static void compare(struct score *s, uint32_t line, const int16_t *level_db_q8)
{
    for (uint32_t i = 0; i < CELLS; i++) {
        const double wanted_db = level_wanted[line * CELLS + i];
        const double error_db = fabs(level_db_q8[i] / 256.0 - wanted_db);
        s->cells++;
        s->changed += wanted_db > level_before[line * CELLS + i] + 0.5;
        s->beyond_half_db += error_db > 0.5;
        s->worst_db = fmax(s->worst_db, error_db);
    }
}

static struct ref_side_lobes law(void)
{
    const struct lm_side_lobe_config *c = &lm_radar_default.sar.side_lobes;
    return (struct ref_side_lobes){c->over_shadow_db_q8 / 256.0, c->above_db_q8 / 256.0, c->a_line};
}

/* Speckled ground with points on a hundredth of its cells, from weak to strong, also side by side
 * and at the edges. */
TEST(side_lobes_of_a_field_of_points_are_the_references)
{
    enum { FIELD = 64 };
    static int16_t level_q8[FIELD][LM_CELLS_ROOM];
    struct score score = {0};
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    for (uint32_t k = 0; k < FIELD; k++) {
        for (uint32_t i = 0; i < CELLS; i++) {
            const uint32_t rise = hs_rng_below(&rng, 100) == 0 ? 10 + hs_rng_below(&rng, 50) : 0;
            level_q8[k][i] =
                (int16_t)((int32_t)(hs_rng_below(&rng, 6 * 256) + rise * 256) - 18 * 256);
            level_before[k * CELLS + i] = level_q8[k][i] / 256.0;
        }
        shadow_db[k] = -31;
    }
    memcpy(level_wanted, level_before, sizeof level_wanted);
    const struct ref_side_lobes lobe_law = law();
    assert_int_equal(ref_side_lobes(&lobe_law, level_wanted, shadow_db, FIELD, CELLS, 77), 0);
    lm_side_lobes_clear(&lobes, &lm_radar_default.sar.side_lobes);
    for (uint32_t k = 0; k < FIELD + 2 * LM_RESPONSE_REACH; k++) {
        if (k < FIELD) {
            lm_side_lobes_find(&lobes, k, level_q8[k], CELLS, -31 * 256, 77);
        }
        add_behind(level_q8, FIELD, k);
        if (k >= 2 * LM_RESPONSE_REACH) { /* none that comes can reach it */
            compare(&score, k - 2 * LM_RESPONSE_REACH, level_q8[k - 2 * LM_RESPONSE_REACH]);
        }
    }
    print_message("# %u cells, %u with a side lobe; worst %.2f dB, beyond 0.5 dB %u\n", score.cells,
                  score.changed, score.worst_db, score.beyond_half_db);
    assert_true(score.changed > 500);
    assert_int_equal(score.beyond_half_db, 0);
}

/* Fields, and towers of bright walls. */
static struct tiny_cell towers(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const bool is_one = fabs(remainder(p->east_m, 260)) < 5 && fabs(remainder(p->north_m, 310)) < 5;
    return is_one ? (struct tiny_cell){20, TINY_STRUCTURE, 6}
                  : (struct tiny_cell){-15, TINY_SOIL, 0};
}

static void start(struct lm_sar *sar, struct tiny_map *map)
{
    const struct lm_sar_command command = {
        .centre = {map->db.centre_latitude, map->db.centre_longitude},
        .cell_mm = 5000,
        .look_azimuth = FX_BAM_DEG(30),
        .range_m = 20000,
        .height_m_q6 = 3000 * 64};
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_sar_start(sar, &lm_radar_default, &map->db, &command, &setup), LM_OK);
    for (uint32_t line = 0; line < sar->lines; line += 4) {
        lm_sar_prefetch(sar, &map->tiles, line);
        tiny_map_read_tiles(map);
    }
}

/* Of a whole patch: from its lines as they are sampled to those that it draws. */
TEST(a_patch_draws_the_references_side_lobes_into_its_lines)
{
    static struct lm_sar sar;
    static struct lm_line line;
    static struct lm_tone tone;
    static int16_t sampled_q8[LM_CELLS_ROOM];
    struct score score = {0};
    struct tiny_map map;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = towers;
    spec.rows = spec.columns = 9;
    tiny_map_open(&map, &spec, 300);
    assert_int_equal(lm_tone_set(&tone, &lm_radar_default.sar.tone), LM_OK);
    start(&sar, &map);
    for (uint32_t k = 0; k < sar.lines; k++) {
        lm_sar_sample_line(&sar, &map.tiles, k, &line, sampled_q8);
        for (uint32_t i = 0; i < CELLS; i++) {
            level_before[k * CELLS + i] = sampled_q8[i] / 256.0;
        }
        shadow_db[k] = sar.shadow_db_q8 / 256.0;
    }
    memcpy(level_wanted, level_before, sizeof level_wanted);
    const struct ref_side_lobes lobe_law = law();
    assert_int_equal(ref_side_lobes(&lobe_law, level_wanted, shadow_db, sar.lines, CELLS,
                                    map.db.centre_longitude),
                     0);
    start(&sar, &map);
    for (uint32_t k = 0; k < sar.lines; k++) {
        const int16_t *level_q8 = lm_sar_draw_line(&sar, &map.tiles, &tone, &line);
        compare(&score, k, level_q8);
    }
    tiny_map_close(&map);
    print_message("# %u cells, %u with a side lobe; worst %.2f dB, beyond 0.5 dB %u\n", score.cells,
                  score.changed, score.worst_db, score.beyond_half_db);
    assert_true(score.changed > 200);
    assert_int_equal(score.beyond_half_db, 0);
}

/* What is left on the stack must not count as cells. */
static __attribute__((noinline)) void leave_on_stack(int16_t level_q8)
{
    volatile int16_t left_q8[8192];
    for (uint32_t i = 0; i < sizeof left_q8 / sizeof *left_q8; i++) {
        left_q8[i] = level_q8;
    }
}

TEST(a_strong_cell_counts_up_to_the_last_but_one_of_a_line)
{
    for (int i = 0; i < 16; i++) {
        const int at = i < 8 ? i : CELLS - 1 - (i - 8);
        int16_t level_q8[LM_CELLS_ROOM];
        for (int k = 0; k < LM_CELLS_ROOM; k++) {
            level_q8[k] = FLOOR_Q8;
        }
        level_q8[at] = 37 * 256;
        lm_side_lobes_clear(&lobes, &lm_radar_default.sar.side_lobes);
        leave_on_stack(INT16_MAX);
        lm_side_lobes_find(&lobes, 0, level_q8, CELLS, -46 * 256, 1);
        /* The last cell itself is repeated beyond the end, and stands out of none. */
        const uint32_t count = at != 0 && at != CELLS - 1;
        assert_int_equal(lobes.line[0].count, count);
        assert_true(count == 0 || lobes.line[0].strong[0].cell == at);
    }
}
