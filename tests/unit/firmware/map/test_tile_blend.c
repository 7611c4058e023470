/* What lies between the map's cells, where a picture's are shorter: the kernel itself, on tiles
 * made here. The reference reads whole images the same way (firmware/radar/test_against_reference).
 */
#include "check.h"
#include "hs/rng.h"
#include "lm/grown.h"
#include "lm/kernels_clutter.h"
#include "lm/kernels_map.h"
#include "lm/lanes.h"
#include "reference/reference.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    GRASS = 1,
    ASPHALT = 2,
    WATER = 3,
    FOREST = 4,
    NATURAL = 1 << GRASS | 1 << WATER | 1 << FOREST
};
enum { STEPS_A_CELL_LOG2 = 3, SIDE = 62 << STEPS_A_CELL_LOG2 };

static const double cell_m = 4.77;
static struct lm_tile_point points[LM_TILE_POINTS][LM_TILE_POINTS];
static const uint16_t height_dm[LM_K_CODES] = {0,   20,  30,  40,  50,  60,  80,  100,
                                               120, 150, 180, 220, 270, 350, 500, 800};

/* What the kernel makes of a place, in cells from the tile's south-west corner. */
struct seen {
    int kind;
    double gamma_db, height_m;
};

static struct lm_k_blend blend_of(uint32_t natural, uint32_t crowned)
{
    return (struct lm_k_blend){.points = &points[LM_TILE_BORDER][LM_TILE_BORDER],
                               .grown = lm_grown,
                               .height_dm_of_code = height_dm,
                               .grown_shift = 24,
                               .natural = natural,
                               .crowned = crowned};
}

/* A line of `count` places (up to LM_CELLS_MAX) eastwards, `step` cells apart. */
static void look_along(const struct lm_k_blend *b, double north, double east, double step,
                       uint32_t count, struct seen *seen)
{
    static uint32_t cell[LM_CELLS_ROOM];
    static int32_t elevation[LM_CELLS_ROOM];
    const double unit = ldexp(1, 26);
    const struct lm_tile_coords places = {
        {(uint32_t)llround(north * unit), 0, 0},
        {(uint32_t)llround(east * unit), (uint32_t)llround(step * unit), 0}};
    memset(cell, 0, sizeof cell);
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        elevation[i] = -8; /* sea level, post_shift 0 */
    }
    lm_k_tile_blend(b, &places, 0, (count + LM_LANES - 1) / LM_LANES, cell, elevation);
    for (uint32_t i = 0; i < count; i++) {
        const int32_t code_m_q14 = lm_k_height_m_q14(height_dm[cell[i] & 15]);
        seen[i] = (struct seen){(int)(cell[i] >> 4 & 15),
                                (cell[i] >> 8 & 255) / 2.0 - 80 + ((int32_t)cell[i] >> 16) / 256.0,
                                (elevation[i] + 8 + code_m_q14) / 16384.0};
    }
}

static void set_cell(int row, int column, int kind, int gamma_code, int height_code)
{
    points[row + 1][column + 1].cell = (uint16_t)(gamma_code << 8 | kind << 4 | height_code);
}

static struct seen pixel[SIDE][SIDE];

static void look_everywhere(const struct lm_k_blend *b)
{
    const double step = ldexp(1, -STEPS_A_CELL_LOG2);
    for (int r = 0; r < SIDE; r++) {
        look_along(b, 1 + (r + 0.5) * step, 1 + 0.5 * step, step, SIDE, pixel[r]);
    }
}

/* Distance from a line through the tile's middle, turned by an angle, in metres. */
static double from_edge_m(double north, double east, double angle_deg)
{
    const double angle = angle_deg * 3.14159265358979323846 / 180;
    return ((north - 32.2) * cos(angle) - (east - 31.7) * sin(angle)) * cell_m;
}

static void draw_edge(double angle_deg, int south, int north)
{
    for (int r = -1; r <= 64; r++) {
        for (int c = -1; c <= 64; c++) {
            const int kind = from_edge_m(r + 0.5, c + 0.5, angle_deg) > 0 ? north : south;
            set_cell(r, c, kind, 100, 0);
        }
    }
}

/* Root of the mean square of how far the border lies off the line it stands for, in metres. */
static double border_rms_m(double angle_deg)
{
    const double step = ldexp(1, -STEPS_A_CELL_LOG2);
    double sum = 0, count = 0;
    for (int r = 0; r + 1 < SIDE; r++) {
        for (int c = 0; c + 1 < SIDE; c++) {
            const double north = 1 + (r + 0.5) * step, east = 1 + (c + 0.5) * step;
            if (pixel[r][c].kind != pixel[r + 1][c].kind) {
                const double off = from_edge_m(north + step / 2, east, angle_deg);
                sum += off * off * cos(angle_deg / 57.2957795);
                count += cos(angle_deg / 57.2957795);
            }
            if (pixel[r][c].kind != pixel[r][c + 1].kind) {
                const double off = from_edge_m(north, east + step / 2, angle_deg);
                sum += off * off * sin(angle_deg / 57.2957795);
                count += sin(angle_deg / 57.2957795);
            }
        }
    }
    assert_true(count > 100);
    return sqrt(sum / count);
}

/* The nearest cells: 1.37 m at 20 degrees, 0.98 m at 45. */
TEST(straight_edges_stay_nearly_straight)
{
    static const struct {
        double angle_deg, most_m;
    } edges[] = {{0, 1.38}, {10, 1.25}, {20, 1.05}, {35, 0.95}, {45, 0.25}};
    const struct lm_k_blend b = blend_of(NATURAL, 0);
    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        draw_edge(edges[i].angle_deg, GRASS, ASPHALT);
        look_everywhere(&b);
        const double rms_m = border_rms_m(edges[i].angle_deg);
        printf("# edge turned %g degrees: %.2f m rms\n", edges[i].angle_deg, rms_m);
        assert_true(rms_m <= edges[i].most_m);
    }
}

/* A lone cell is no square: a square's corners are 1.41 times as far off as its sides. */
TEST(a_lone_cell_is_nearly_round)
{
    const struct lm_k_blend b = blend_of(NATURAL, 0);
    draw_edge(0, GRASS, GRASS);
    set_cell(32, 32, ASPHALT, 200, 5);
    double nearest = 10, farthest = 0;
    look_everywhere(&b);
    for (int r = 0; r < SIDE; r++) {
        for (int c = 0; c < SIDE; c++) {
            const double north = 1 + (r + 0.5) / 8 - 32.5, east = 1 + (c + 0.5) / 8 - 32.5;
            const bool is_in = pixel[r][c].kind == ASPHALT;
            nearest = is_in ? nearest : fmin(nearest, hypot(north, east));
            farthest = is_in ? fmax(farthest, hypot(north, east)) : farthest;
        }
    }
    assert_true(nearest > 0.38 && farthest < 0.52);
}

/* Each cell drawn anew. Nearest cells: 0.75 half a cell away by half, and 0 from one cell on. */
TEST(the_grain_of_a_class_does_not_end_at_one_cell)
{
    const struct lm_k_blend b = blend_of(0, 0);
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    for (int i = 0; i < 66 * 66; i++) {
        set_cell(i / 66 - 1, i % 66 - 1, GRASS, 100 + (int)hs_rng_below(&rng, 40), 0);
    }
    look_everywhere(&b);
    double mean = 0, product[17] = {0};
    for (int i = 0; i < SIDE * SIDE; i++) {
        mean += pixel[i / SIDE][i % SIDE].gamma_db / (SIDE * SIDE);
    }
    for (int r = 0; r < SIDE; r++) {
        for (int c = 0; c + 16 < SIDE; c++) {
            for (int lag = 0; lag <= 16; lag++) {
                product[lag] += (pixel[r][c].gamma_db - mean) * (pixel[r][c + lag].gamma_db - mean);
            }
        }
    }
    /* Of a chain of straight pieces through independent numbers. */
    assert_true(fabs(product[8] / product[0] - 0.25) < 0.06);
    assert_true(fabs(product[16] / product[0]) < 0.08);
    for (int lag = 1; lag <= 16; lag++) {
        assert_true(product[lag - 1] - product[lag] < 0.15 * product[0]); /* no corner */
    }
}

TEST(reflectivity_and_height_are_straight_between_the_middles_of_one_class)
{
    const struct lm_k_blend b = blend_of(NATURAL, 0);
    static struct seen seen[256];
    for (int r = -1; r <= 64; r++) {
        for (int c = -1; c <= 64; c++) {
            set_cell(r, c, GRASS, 20 + 2 * c, c < 32 ? 7 : 8);
        }
    }
    look_along(&b, 40.25, 0.5, 0.25, 248, seen);
    for (int i = 0; i < 248; i++) {
        const double middle = i * 0.25; /* cells' middles from the first one's */
        assert_true(fabs(seen[i].gamma_db - (10 + middle - 80)) < 0.003);
        const double share = fmin(fmax(middle - 31, 0), 1);
        assert_true(fabs(seen[i].height_m - (10 + 2 * share)) < 0.012);
    }
}

TEST(nothing_of_another_class_is_mixed_in)
{
    const struct lm_k_blend b = blend_of(NATURAL, 0);
    draw_edge(27, GRASS, ASPHALT);
    for (int i = 0; i < 66 * 66; i++) {
        struct lm_tile_point *p = &points[i / 66][i % 66];
        p->cell = (p->cell >> 4 & 15) == GRASS ? 90 << 8 | GRASS << 4 : 30 << 8 | ASPHALT << 4 | 5;
    }
    look_everywhere(&b);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const struct seen *s = &pixel[i / SIDE][i % SIDE];
        assert_true(s->kind == GRASS || s->kind == ASPHALT);
        assert_true(s->gamma_db == (s->kind == GRASS ? 90 : 30) / 2.0 - 80);
        assert_true(fabs(s->height_m - (s->kind == GRASS ? 0 : 6)) < 0.01);
    }
}

/* Bent by up to 9/20 of a cell beside what it is anyway, and never by more than the cells say. */
TEST(borders_between_natural_classes_bend_and_others_do_not)
{
    static struct seen straight[SIDE][SIDE];
    draw_edge(0, GRASS, WATER);
    const struct lm_k_blend made = blend_of(0, 0), natural = blend_of(NATURAL, 0);
    look_everywhere(&made);
    memcpy(straight, pixel, sizeof straight);
    look_everywhere(&natural);
    double sum = 0;
    int most = 0;
    for (int c = 0; c < SIDE; c++) {
        int moved = 0;
        for (int r = 0; r < SIDE; r++) {
            moved += (pixel[r][c].kind == GRASS) - (straight[r][c].kind == GRASS);
        }
        sum += moved * moved;
        most = moved > most ? moved : -moved > most ? -moved : most;
    }
    assert_in_range(most, 3, 4); /* eighths of a cell */
    assert_true(sqrt(sum / SIDE) > 0.8);
    draw_edge(0, GRASS, ASPHALT);
    look_everywhere(&natural);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_int_equal(pixel[i / SIDE][i % SIDE].kind == GRASS,
                         straight[i / SIDE][i % SIDE].kind == GRASS);
    }
}

TEST(crowns_keep_the_mean_height_of_a_forest)
{
    const struct lm_k_blend b = blend_of(NATURAL, 1 << FOREST);
    double sum = 0, squares = 0;
    draw_edge(0, FOREST, FOREST);
    for (int i = 0; i < 66 * 66; i++) {
        points[i / 66][i % 66].cell |= 8; /* 12 m */
    }
    look_everywhere(&b);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double height_m = pixel[i / SIDE][i % SIDE].height_m;
        sum += height_m;
        squares += height_m * height_m;
    }
    const double mean_m = sum / SIDE / SIDE;
    assert_true(fabs(mean_m - 12) < 0.1);
    const double spread_m = sqrt(squares / SIDE / SIDE - mean_m * mean_m);
    assert_true(spread_m > 0.9 && spread_m < 1.5);
}

/* The record's first and last point are read, none beside them: see the sanitizer. */
TEST(no_place_of_a_tile_leaves_its_record)
{
    const struct lm_k_blend b = blend_of(NATURAL, 0);
    static struct seen seen[64];
    draw_edge(0, GRASS, GRASS);
    for (int c = -1; c <= 64; c++) {
        set_cell(-1, c, ASPHALT, 40, 0);
        set_cell(64, c, WATER, 60, 0);
    }
    look_along(&b, 0, 0, 1 - ldexp(1, -26), 64, seen);
    for (int i = 0; i < 64; i++) {
        assert_int_equal(seen[i].kind, ASPHALT);
    }
    look_along(&b, 64 - ldexp(1, -26), 64 - ldexp(1, -26), 0, 1, seen);
    assert_int_equal(seen[0].kind, GRASS);
    set_cell(63, 64, WATER, 60, 0);
    set_cell(64, 64, WATER, 60, 0);
    look_along(&b, 64 - ldexp(1, -26), 64 - ldexp(1, -26), 0, 1, seen);
    assert_int_equal(seen[0].kind, WATER);
}

TEST(the_pattern_is_that_of_the_equations)
{
    for (int i = 0; i < LM_K_GROWN_WORDS; i += 7) {
        const int row = i / LM_K_GROWN_STRIDE % LM_K_GROWN_SIDE;
        const int column = i % LM_K_GROWN_STRIDE % LM_K_GROWN_SIDE;
        const double n = (int8_t)(lm_grown[i] & 255) * 230.0 / 32768;
        const double crown = 1 + ((lm_grown[i] >> 8) - 128) / 256.0;
        assert_true(fabs(n - ref_grown_bend(row, column)) < 0.008);
        assert_true(fabs(crown - ref_grown_crown(row, column)) < 0.005);
    }
}

/* Places of cells of any kind, reflectivity and height that are not as the reference says. Two
 * classes may be all but equal. */
static int count_others(bool is_stepped)
{
    static struct lm_classes classes;
    const struct ref_db db = {.classes = &classes};
    struct lm_k_blend b = blend_of(NATURAL, 1 << FOREST);
    b.is_stepped = is_stepped;
    struct hs_rng rng;
    hs_rng_seed(&rng, 6);
    for (int k = 0; k < LM_DB_CLASSES; k++) {
        classes.entry[k].kind = k == FOREST ? LM_KIND_TREES : LM_KIND_GROUND;
        classes.entry[k].flags = NATURAL >> k & 1 ? LM_CLASS_NATURAL : 0;
        classes.height_dm[k] = height_dm[k];
    }
    for (int i = 0; i < 66 * 66; i++) {
        set_cell(i / 66 - 1, i % 66 - 1, 1 + (int)hs_rng_below(&rng, 4),
                 90 + (int)hs_rng_below(&rng, 20), (int)hs_rng_below(&rng, 12));
    }
    look_everywhere(&b);
    int others = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double y = 1 + (i / SIDE + 0.5) / 8, x = 1 + (i % SIDE + 0.5) / 8;
        const double v = y + 0.5 - floor(y + 0.5), u = x + 0.5 - floor(x + 0.5);
        const struct lm_tile_point *low = &points[(int)(y + 0.5)][(int)(x + 0.5)];
        const struct ref_corners corners = {
            .cell = {low[0].cell, low[1].cell, low[66].cell, low[67].cell},
            .north = v,
            .east = u,
            .texel_row = fmod(is_stepped ? round(y * 4) : y * 4, 64),
            .texel_column = fmod(is_stepped ? round(x * 4) : x * 4, 64),
            .has_crowns = true};
        struct ref_bin bin;
        ref_blend_cells(&db, &corners, &bin);
        const struct seen *s = &pixel[i / SIDE][i % SIDE];
        /* A mean is within 7 % of 10 dB or 22 m, a crown within a texel's doubt. */
        others += s->kind != bin.class_index || fabs(s->gamma_db - bin.gamma_db) > 0.6 ||
                  fabs(s->height_m - bin.height_m) > 1.5 + 0.01 * bin.height_m;
    }
    return others;
}

TEST(any_four_cells_are_blended_as_the_equations_say)
{
    assert_in_range(count_others(false), 0, SIDE * SIDE / 500);
}

TEST(the_nearest_texel_counts_alone_where_cells_are_longer)
{
    assert_in_range(count_others(true), 0, SIDE * SIDE / 500);
}
