/* Side lobes of strong returns of the map, against Taylor's response in its closed form and in a
 * patch. */
#include "check.h"
#include "lm/sar.h"
#include "lm/side_lobes.h"
#include "tiny_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 256, LINES = 41, MIDDLE = 20, WALL = 100, FLOOR_Q8 = -80 * 256 };

static const double pi = 3.14159265358979323846;
static struct lm_side_lobes lobes;
static int32_t picture[LINES][LM_CELLS_ROOM];

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

/* A wall of 37 dB in the dark, on the middle one of some lines. */
static const struct lm_strong_cell *draw_wall(uint32_t seed)
{
    lm_side_lobes_clear(&lobes);
    for (uint32_t k = 0; k < LINES; k++) {
        for (int i = 0; i < CELLS; i++) {
            picture[k][i] = FLOOR_Q8;
        }
        picture[k][WALL] = k == MIDDLE ? 37 * 256 : FLOOR_Q8;
        lm_side_lobes_find(&lobes, k, picture[k], CELLS, -11 * 256, seed);
        assert_int_equal(lobes.line[k % LM_SIDE_LOBES_LINES].count, k == MIDDLE);
        if (k >= LM_RESPONSE_REACH) {
            lm_side_lobes_add(&lobes, k - LM_RESPONSE_REACH, picture[k - LM_RESPONSE_REACH], CELLS);
        }
    }
    return &lobes.line[MIDDLE % LM_SIDE_LOBES_LINES].strong[0];
}

TEST(a_lone_wall_has_a_cross_whose_side_lobes_are_taylors)
{
    double highest_db = -1000, worst_db = 0;
    for (uint32_t seed = 0; seed < 200; seed++) {
        const struct lm_strong_cell *p = draw_wall(seed);
        for (int n = -LM_RESPONSE_REACH + 1; n < LM_RESPONSE_REACH; n++) {
            const double off[2] = {(p->beyond - 4.0) / 16, (p->right - 4.0) / 16};
            const int32_t shown_q8[2] = {picture[MIDDLE][WALL + n], picture[MIDDLE + n][WALL]};
            for (int way = 0; way < 2 && abs(n) >= 2; way++) {
                const double wanted_db =
                    20 * log10(fabs(taylor(n - off[way]) / taylor(off[way])) + 1e-9);
                const double got_db = shown_q8[way] / 256.0 - 37;
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
    assert_true(fabs(highest_db + 35.2) < 1);
    assert_true(worst_db < 1);
}

TEST(of_many_strong_cells_only_the_strongest_of_a_line_count)
{
    int32_t level_q8[LM_CELLS_ROOM];
    for (int i = 0; i < CELLS; i++) {
        level_q8[i] = i % 20 == 10 ? (20 + i * 7 % 13) * 256 : -30 * 256;
    }
    lm_side_lobes_clear(&lobes);
    lm_side_lobes_find(&lobes, 0, level_q8, CELLS, 0, 1);
    assert_int_equal(lobes.line[0].count, LM_SIDE_LOBES_A_LINE);
    int above = 0;
    for (int i = 0; i < CELLS; i++) {
        above += level_q8[i] > lobes.line[0].strong[LM_SIDE_LOBES_A_LINE - 1].level_db_q8;
    }
    assert_true(above < LM_SIDE_LOBES_A_LINE);
}

TEST(a_strong_field_among_fields_has_none)
{
    int32_t level_q8[LM_CELLS_ROOM];
    for (int i = 0; i < CELLS; i++) {
        level_q8[i] = 10 * 256 + i * 37 % 25 * 256;
    }
    lm_side_lobes_clear(&lobes);
    lm_side_lobes_find(&lobes, 0, level_q8, CELLS, 0, 1);
    assert_int_equal(lobes.line[0].count, 0);
}
