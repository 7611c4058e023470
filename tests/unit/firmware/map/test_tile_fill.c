/* What fills the gaps of a tile: cells of a tile that is as fine, and of a coarser one what lies
 * between its cells, as the reference blends them. */
#include "lm/tile_fill.h"

#include "check.h"
#include "reference/reference.h"
#include "tiny_image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { GAP_COLUMN = 20, ROW = 5, COLUMN = 11, TEXELS = 4 };

static const uint32_t no_data = TINY_NONE << 4;

struct fixture {
    struct lm_tile tile, source;
    struct lm_classes classes;
    struct lm_tile_fill fill;
};

static void fill(struct fixture *f, uint32_t generations)
{
    lm_tile_fill_begin(&f->fill, &f->tile, &f->source, generations, &f->classes);
    while (lm_tile_fill_run(&f->fill) == LM_BUSY) {
    }
}

/* The tile has data in its west alone. Woods, fields and lakes of the source change slowly. */
static struct fixture *prepare(uint32_t generations)
{
    struct fixture *f = calloc(1, sizeof *f);
    f->classes = *tiny_classes();
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const bool is_natural = i == TINY_SOIL || i == TINY_TREES || i == TINY_WATER;
        f->classes.entry[i].flags = is_natural ? LM_CLASS_NATURAL : 0;
    }
    f->tile.row = ROW;
    f->tile.column = COLUMN;
    f->source.row = ROW >> generations;
    f->source.column = COLUMN >> generations;
    f->source.lod = (uint8_t)generations;
    f->source.post_shift = 2;
    for (uint32_t r = 0; r < LM_TILE_POINTS; r++) {
        for (uint32_t c = 0; c < LM_TILE_POINTS; c++) {
            const double u = sin(r * 0.7) + cos(c * 0.9 + r * 0.2);
            const uint32_t class_index = u < -0.8 ? TINY_WATER : u > 0.5 ? TINY_TREES : TINY_SOIL;
            const uint32_t gamma = (uint32_t)lround(100 + 12 * sin(r * 0.4 + c * 1.1));
            const uint32_t code = class_index == TINY_TREES ? 5 + (r * 7 + c * 3) % 5 : 0;
            f->source.points[r][c] =
                (struct lm_tile_point){(uint16_t)(gamma << 8 | class_index << 4 | code), 7};
            f->tile.points[r][c].cell =
                (uint16_t)(c < GAP_COLUMN ? 90 << 8 | TINY_ASPHALT << 4 : no_data);
        }
    }
    return f;
}

static struct fixture *make(uint32_t generations)
{
    struct fixture *f = prepare(generations);
    fill(f, generations);
    return f;
}

/* Cell of the tile, -1..64, in the source, in its cells. */
static double in_source(uint32_t tile_at, uint32_t generations, int cell)
{
    const uint32_t within = tile_at & ((1u << generations) - 1);
    return (within * 64.0 + cell + 0.5) / (1u << generations);
}

static struct ref_bin blended(const struct fixture *f, double north, double east, bool is_stepped)
{
    struct ref_bin bin;
    const struct ref_db db = {.classes = &f->classes};
    const double y = floor(north - 0.5), x = floor(east - 0.5), nearest = is_stepped ? 0.5 : 0;
    const double row = north * TEXELS, column = east * TEXELS;
    const struct lm_tile_point *low = &f->source.points[(int)y + 1][(int)x + 1];
    const struct lm_tile_point *high = low + LM_TILE_POINTS;
    const struct ref_corners corners = {
        .cell = {low[0].cell, low[1].cell, high[0].cell, high[1].cell},
        .north = floor((north - 0.5 - y) * 128) / 128,
        .east = floor((east - 0.5 - x) * 128) / 128,
        .texel_row = fmod(is_stepped ? floor(row + nearest) : row, 64),
        .texel_column = fmod(is_stepped ? floor(column + nearest) : column, 64)};
    ref_blend_cells(&db, &corners, &bin);
    return bin;
}

struct tally {
    uint32_t cells, other_class, other_nearest;
    double worst_db, worst_m, sum_m, sum_wanted_m;
};

static void compare(const struct fixture *f, uint32_t generations, int row, int column,
                    struct tally *t)
{
    const double north = in_source(ROW, generations, row);
    const double east = in_source(COLUMN, generations, column);
    const struct ref_bin wanted = blended(f, north, east, generations <= 1);
    const uint32_t cell = f->tile.points[row + 1][column + 1].cell;
    const uint32_t nearest = f->source.points[(int)north + 1][(int)east + 1].cell;
    t->cells++;
    t->other_nearest += (nearest >> 4 & 15) != (cell >> 4 & 15);
    if ((int)(cell >> 4 & 15) != wanted.class_index) {
        t->other_class++;
        return;
    }
    const double height_m = f->classes.height_dm[cell & 15] / 10.0;
    t->worst_db = fmax(t->worst_db, fabs((cell >> 8) / 2.0 - 80 - wanted.gamma_db));
    t->worst_m = fmax(t->worst_m, fabs(height_m - wanted.height_m));
    t->sum_m += height_m;
    t->sum_wanted_m += wanted.height_m;
}

/* Codes are 1/2 dB and, of the heights of these woods, 2 to 5 m apart; of the two around a height
 * the one is drawn, so that woods keep their mean. */
TEST(a_gap_takes_what_lies_between_the_cells_of_a_coarser_tile)
{
    for (uint32_t generations = 1; generations <= 4; generations++) {
        struct fixture *f = make(generations);
        struct tally t = {0};
        for (int row = 0; row < LM_TILE_CELLS; row++) {
            for (int column = GAP_COLUMN; column < LM_TILE_CELLS; column++) {
                compare(f, generations, row, column, &t);
            }
        }
        print_message(
            "# %u generations: class of %u of %u cells is another, of %u that of no "
            "nearest cell; at most %.2f dB and %.1f m; mean %.2f m, wanted %.2f\n",
            generations, t.other_class, t.cells, t.other_nearest, t.worst_db, t.worst_m,
            t.sum_m / t.cells, t.sum_wanted_m / t.cells);
        assert_true(t.other_class * 100 <= t.cells);
        assert_true(t.other_nearest * 50 >= t.cells);
        assert_true(t.worst_db < 0.9 && t.worst_m < 5.2);
        assert_true(fabs(t.sum_m - t.sum_wanted_m) < 0.02 * t.sum_wanted_m);
        free(f);
    }
}

TEST(a_gap_takes_the_very_cells_of_a_tile_that_is_as_fine_and_no_other_cell_changes)
{
    struct fixture *f = make(0);
    for (uint32_t r = 0; r < LM_TILE_POINTS; r++) {
        for (uint32_t c = 0; c < LM_TILE_POINTS; c++) {
            const uint32_t wanted =
                c < GAP_COLUMN ? 90 << 8 | TINY_ASPHALT << 4 : f->source.points[r][c].cell;
            assert_int_equal(f->tile.points[r][c].cell, wanted);
        }
    }
    free(f);
}

/* The tile lies in the south-east of its parent: what is east and south of both is known by the
 * parent's border alone. */
TEST(beside_the_source_its_border_answers)
{
    struct fixture *f = make(1);
    const struct lm_tile *t = &f->tile, *s = &f->source;
    for (int i = -1; i <= LM_TILE_CELLS; i++) {
        const int in = (ROW % 2 * LM_TILE_CELLS + i) >> 1;
        assert_int_equal(t->points[i + 1][LM_TILE_CELLS + 1].cell, s->points[in + 1][65].cell);
    }
    free(f);
}

/* Bushes of 50 to 100 m are no woods: the nearer of two codes is told, the highest one, too. */
TEST(what_is_no_wood_has_the_nearer_code_of_its_height)
{
    struct fixture *f = prepare(2);
    uint32_t highest = 0, others = 0;
    for (uint32_t r = 0; r < LM_TILE_POINTS; r++) {
        for (uint32_t c = 0; c < LM_TILE_POINTS; c++) {
            f->source.points[r][c].cell =
                (uint16_t)(100 << 8 | TINY_SOIL << 4 | (12 + (r / 3 + c / 4) % 4));
        }
    }
    fill(f, 2);
    for (int row = 0; row < LM_TILE_CELLS; row++) {
        for (int column = GAP_COLUMN; column < LM_TILE_CELLS; column++) {
            const struct ref_bin wanted =
                blended(f, in_source(ROW, 2, row), in_source(COLUMN, 2, column), false);
            const uint32_t code = f->tile.points[row + 1][column + 1].cell & 15;
            const uint16_t *dm = f->classes.height_dm;
            const uint32_t step_dm = code == 15 ? dm[15] - dm[14] : dm[code + 1] - dm[code];
            assert_true(fabs(dm[code] - 10 * wanted.height_m) <= step_dm / 2.0 + 3);
            highest += code == 15;
            others += code < 15;
        }
    }
    assert_true(highest > 100 && others > 100);
    free(f);
}

/* A tile without any data, filled with a wood whose tops rise and fall from cell to cell. */
static struct fixture *make_wood(uint32_t row, uint32_t column)
{
    struct fixture *f = prepare(2);
    f->tile.row = row;
    f->tile.column = column;
    f->source.row = row >> 2;
    f->source.column = column >> 2;
    for (uint32_t r = 0; r < LM_TILE_POINTS; r++) {
        for (uint32_t c = 0; c < LM_TILE_POINTS; c++) {
            f->tile.points[r][c].cell = no_data;
            f->source.points[r][c].cell =
                (uint16_t)(100 << 8 | TINY_TREES << 4 | (5 + (r + c) % 2));
        }
    }
    fill(f, 2);
    return f;
}

/* The border of a tile is its neighbour's first cells: within a source, trees are drawn there once.
 */
TEST(both_tiles_at_a_border_have_the_same_trees_there)
{
    struct fixture *west = make_wood(ROW, COLUMN - 2), *east = make_wood(ROW, COLUMN - 1);
    struct fixture *north = make_wood(ROW + 1, COLUMN - 2);
    uint32_t changes = 0;
    for (uint32_t i = 0; i < LM_TILE_POINTS; i++) {
        for (uint32_t k = 0; k < 2; k++) {
            const uint32_t last = LM_TILE_CELLS + k;
            assert_int_equal(west->tile.points[i][last].cell, east->tile.points[i][k].cell);
            assert_int_equal(west->tile.points[last][i].cell, north->tile.points[k][i].cell);
        }
        changes += i > 0 && west->tile.points[i][65].cell != west->tile.points[i - 1][65].cell;
    }
    assert_true(changes > 10);
    free(west);
    free(east);
    free(north);
}

static int32_t post_m_q6(const struct lm_tile *t, uint32_t row, uint32_t column)
{
    return t->base_m_q6 + (t->points[row][column].post << t->post_shift);
}

TEST(a_gap_lies_between_the_posts_of_the_source_however_coarse_that_is)
{
    for (uint32_t generations = 0; generations < LM_DB_LODS_MAX; generations++) {
        struct fixture *f = prepare(generations);
        for (uint32_t r = 0; r < LM_TILE_POINTS; r++) {
            for (uint32_t c = 0; c < LM_TILE_POINTS; c++) {
                f->source.points[r][c].post = (uint16_t)(50 * r + 700 * c);
            }
        }
        fill(f, generations);
        const double half = 0.5 / (1u << generations); /* posts stand at corners of cells */
        for (int row = 0; row < LM_TILE_CELLS; row++) {
            for (int column = GAP_COLUMN + 1; column < LM_TILE_CELLS; column++) {
                const double wanted_q6 =
                    4 * (50 * (in_source(ROW, generations, row) - half + 1) +
                         700 * (in_source(COLUMN, generations, column) - half + 1));
                const int32_t m_q6 = post_m_q6(&f->tile, (uint32_t)row + 1, (uint32_t)column + 1);
                /* Of the way between two posts 1/256 is told, and a post to its step. */
                assert_true(fabs(m_q6 - wanted_q6) <=
                            4 * 750 / 256.0 + 4 + (1 << f->tile.post_shift));
            }
        }
        free(f);
    }
}

TEST(what_rises_further_above_the_tile_than_a_record_can_tell_is_cut_off_there)
{
    struct fixture *f = prepare(1);
    const int32_t deep_m_q6 = -(1 << 20);
    f->tile.base_m_q6 = deep_m_q6;
    f->source.base_m_q6 = 1 << 20;
    fill(f, 1);
    assert_int_equal(f->tile.post_shift, LM_TILE_POST_SHIFT_MAX);
    for (uint32_t r = 1; r <= LM_TILE_CELLS; r++) {
        assert_int_equal(post_m_q6(&f->tile, r, 4), deep_m_q6);
        assert_int_equal(f->tile.points[r][LM_TILE_CELLS].post, UINT16_MAX);
    }
    free(f);
}
