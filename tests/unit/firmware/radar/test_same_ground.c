/* The same ground shows the same bright places wherever the patch is centred: what differs is
 * speckle alone. docs/EQUATIONS.md, "Class gain". */
#include "check.h"
#include "fx/hash.h"
#include "lm/sar.h"
#include "reference_support.h"
#include "tiny_map.h"

#include <math.h>
#include <stdlib.h>

enum { CELLS = 256, POOL_TILES = 400, MAP_CELL_SHIFT = 9, ASIDE = 8 };

/* Structures whose reflectivity is drawn for each square of 40 m, from -20 to 0 dB. */
static struct tiny_cell varied_cell(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const uint32_t column = (uint32_t)(int32_t)floor(p->east_m / 40);
    const uint32_t row = (uint32_t)(int32_t)floor(p->north_m / 40);
    const uint32_t drawn = fx_hash3(column, row, 3) >> 16;
    return (struct tiny_cell){-20 * (drawn / 65536.0), TINY_STRUCTURE, 0};
}

/* Levels of a patch of 10 m cells whose centre lies `east` cells aside: its middle lines. Where the
 * look is north, lines count to the east. */
static void draw_patch(struct tiny_map *map, int east, fx_bam_t look, double level_db[CELLS][CELLS])
{
    static struct lm_sar sar;
    static struct lm_line line;
    static int16_t level_q8[LM_CELLS_ROOM];
    struct lm_geo_origin origin;
    const struct lm_position middle = {map->db.centre_latitude, map->db.centre_longitude};
    lm_geo_set_origin(&origin, middle);
    const struct lm_sar_command command = {
        .centre = east ? lm_geo_direct(&origin, FX_BAM_90, (uint32_t)east * 2560) : middle,
        .cell_mm = 10000,
        .look_azimuth = look,
        .range_m = 20000,
        .height_m_q6 = 3000 * 64};
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map->db, &command, &setup), LM_OK);
    for (uint32_t k = 0; k < CELLS; k++) {
        const uint32_t number = (sar.lines - CELLS) / 2 + k;
        lm_sar_prefetch(&sar, &map->tiles, number);
        tiny_map_read_tiles(map);
        lm_sar_sample_line(&sar, &map->tiles, number, &line, level_q8);
        for (int i = 0; i < CELLS; i++) {
            level_db[k][i] = decibels(level_q8[i]);
        }
    }
}

struct sums {
    double n, a, b, aa, bb, ab;
};

static void note(struct sums *s, double a, double b)
{
    s->n++;
    s->a += a;
    s->b += b;
    s->aa += a * a;
    s->bb += b * b;
    s->ab += a * b;
}

static double correlation_of(const struct sums *s, double *allowed)
{
    const double mean_a = s->a / s->n, mean_b = s->b / s->n;
    const double variance_a = s->aa / s->n - mean_a * mean_a;
    const double variance_b = s->bb / s->n - mean_b * mean_b;
    /* Four looks: the variance of 10 log10 of a Gamma variable is (10 / ln 10)^2 times the
     * trigamma function, 0.2838 for 4. */
    const double speckle = 0.2838 * pow(10 / log(10), 2);
    *allowed = 1 - speckle / sqrt(variance_a * variance_b);
    return (s->ab / s->n - mean_a * mean_b) / sqrt(variance_a * variance_b);
}

static void open_varied(struct tiny_map *map)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = varied_cell;
    spec.shift0 = MAP_CELL_SHIFT;
    spec.rows = spec.columns = 12;
    tiny_map_open(map, &spec, POOL_TILES);
}

/* Of two patches whose ground is aligned, the speckle of each is its own. It takes from the
 * correlation what it adds to the variance: with a spread of the ground of g dB and of the speckle
 * of n dB, g2 / (g2 + n2) is left. A texture that jumped with the patch would take more. */
TEST(a_patch_asked_for_again_80_m_aside_shows_the_same_bright_places)
{
    static double here[CELLS][CELLS], aside[CELLS][CELLS];
    struct tiny_map map;
    struct sums s = {0};
    open_varied(&map);
    draw_patch(&map, 0, 0, here);
    draw_patch(&map, ASIDE, 0, aside);
    tiny_map_close(&map);
    for (int k = ASIDE; k < CELLS; k++) {
        for (int i = 0; i < CELLS; i++) {
            note(&s, here[k][i], aside[k - ASIDE][i]);
        }
    }
    double allowed;
    const double correlation = correlation_of(&s, &allowed);
    print_message("# correlation %.3f of %.3f allowed\n", correlation, allowed);
    assert_true(correlation > 0.85 * allowed);
    assert_true(correlation < 1.05 * allowed); /* the speckle is drawn anew */
}

/* [Heaton]: scatterers stay at their place over some 30 degrees of aspect. Here a town whose walls
 * face the first look: the whole of it is darker from 30 degrees aside, and its bright places are
 * the same. Cells at the borders of squares fall to either side and are left out. */
TEST(bright_places_stay_where_they_are_over_30_degrees_of_aspect)
{
    static double here[CELLS][CELLS], turned[CELLS][CELLS];
    struct tiny_map map;
    struct sums s = {0};
    open_varied(&map);
    map.db.classes.entry[TINY_STRUCTURE].facing = 1;
    draw_patch(&map, 0, 0, here);
    draw_patch(&map, 0, FX_BAM_DEG(30), turned);
    tiny_map_close(&map);
    const double sine = 0.5, cosine = 0.5 * sqrt(3), half = CELLS / 2.0 - 0.5;
    for (int k = 0; k < CELLS; k++) {
        for (int i = 0; i < CELLS; i++) {
            /* Lines are rays: they spread with range, 2,000 cells from the antenna. */
            const double along = i - half, across = (k - half) * (1 + along / 2000);
            const double east = across * cosine + along * sine;
            const double north = along * cosine - across * sine;
            const int line = (int)lround(half + east / (1 + north / 2000));
            const int cell = (int)lround(half + north);
            if (line >= 1 && line < CELLS - 1 && cell >= 1 && cell < CELLS - 1 &&
                fabs(here[line - 1][cell] - here[line + 1][cell]) < 6 &&
                fabs(here[line][cell - 1] - here[line][cell + 1]) < 6) {
                note(&s, here[line][cell], turned[k][i]);
            }
        }
    }
    double allowed;
    const double correlation = correlation_of(&s, &allowed);
    print_message("# correlation %.3f of %.3f allowed; %.1f dB darker\n", correlation, allowed,
                  (s.a - s.b) / s.n);
    assert_true(correlation > 0.85 * allowed);
    assert_true((s.a - s.b) / s.n > 10);
}
