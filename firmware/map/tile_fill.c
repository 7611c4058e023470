#include "lm/tile_fill.h"

#include "fx/sat.h"

enum {
    NONE_MASK = 15 << 4,
    NONE = LM_DB_CLASS_NONE << 4,
    FINE_LOG2 = 8 /* places in a cell of the source are told to 1/256 */
};

static bool is_none(const struct lm_tile *tile, uint32_t row, uint32_t column)
{
    return (tile->points[row][column].cell & NONE_MASK) == NONE;
}

bool lm_tile_has_gaps(const struct lm_tile *tile)
{
    for (uint32_t row = 0; row < LM_TILE_POINTS; row++) {
        for (uint32_t column = 0; column < LM_TILE_POINTS; column++) {
            if (is_none(tile, row, column)) {
                return true;
            }
        }
    }
    return false;
}

void lm_tile_fill_begin(struct lm_tile_fill *f, struct lm_tile *tile, const struct lm_tile *source,
                        uint32_t generations)
{
    const uint32_t within = (1u << generations) - 1;
    *f = (struct lm_tile_fill){.tile = tile,
                               .source = source,
                               .generations = generations,
                               .row0 = (int32_t)((tile->row & within) * LM_TILE_CELLS),
                               .column0 = (int32_t)((tile->column & within) * LM_TILE_CELLS),
                               .least_m_q6 = INT32_MAX,
                               .most_m_q6 = INT32_MIN,
                               .base_m_q6 = tile->base_m_q6,
                               .post_shift = tile->post_shift};
}

/* Place of a point of the tile in the source: its point there, 0..65, and how far behind it. Cells
 * of the tile count from -1, its border, to 64: in the source they are below 2^21. */
struct place {
    uint32_t at, part_q8;
};

static struct place place_of(const struct lm_tile_fill *f, int32_t first, uint32_t point)
{
    const int32_t cell = first + (int32_t)point - LM_TILE_BORDER;
    const uint32_t part = (uint32_t)cell & ((1u << f->generations) - 1);
    return (struct place){(uint32_t)((cell >> f->generations) + LM_TILE_BORDER),
                          f->generations > FINE_LOG2 ? part >> (f->generations - FINE_LOG2)
                                                     : part << (FINE_LOG2 - f->generations)};
}

static uint32_t post(const struct lm_tile *tile, uint32_t row, uint32_t column)
{
    return tile->points[fx_min_u32(row, LM_TILE_POINTS - 1)][fx_min_u32(column, LM_TILE_POINTS - 1)]
        .post;
}

/* Elevation of the source, metres * 64: posts are below 2^16, weights 2^16 together. Within 2^22.
 */
static int32_t source_m_q6(const struct lm_tile *s, struct place row, struct place column)
{
    const uint32_t east = column.part_q8, west = 256 - east;
    const uint32_t south =
        post(s, row.at, column.at) * west + post(s, row.at, column.at + 1) * east;
    const uint32_t north =
        post(s, row.at + 1, column.at) * west + post(s, row.at + 1, column.at + 1) * east;
    const uint64_t both =
        (uint64_t)south * (256 - row.part_q8) + (uint64_t)north * row.part_q8 + (1 << 15);
    return s->base_m_q6 + (int32_t)((uint32_t)(both >> 16) << s->post_shift);
}

/* True if a cell that has data has its corner there. */
static bool stays(const struct lm_tile *t, uint32_t row, uint32_t column)
{
    const uint32_t south = row - (row > 0), west = column - (column > 0);
    return !is_none(t, row, column) || !is_none(t, south, column) || !is_none(t, row, west) ||
           !is_none(t, south, west);
}

/* Elevation of a point in the filled tile. */
static int32_t filled_m_q6(const struct lm_tile_fill *f, struct place at, uint32_t row,
                           uint32_t column)
{
    const struct lm_tile *t = f->tile;
    if (stays(t, row, column)) {
        return f->base_m_q6 + (t->points[row][column].post << f->post_shift);
    }
    return source_m_q6(f->source, at, place_of(f, f->column0, column));
}

static void measure_row(struct lm_tile_fill *f, uint32_t row)
{
    const struct place at = place_of(f, f->row0, row);
    for (uint32_t column = 0; column < LM_TILE_POINTS; column++) {
        const int32_t m_q6 = filled_m_q6(f, at, row, column);
        f->least_m_q6 = fx_min_i32(f->least_m_q6, m_q6);
        f->most_m_q6 = fx_max_i32(f->most_m_q6, m_q6);
    }
}

/* The base is lowered by whole steps, to 16 below 2^20 at most: what lm_tile_base_of makes of it
 * fits as well. */
static void set_steps(struct lm_tile_fill *f)
{
    struct lm_tile *t = f->tile;
    const int32_t below = fx_max_i32(f->base_m_q6 - f->least_m_q6, 0);
    uint32_t steps = UINT32_MAX;
    for (uint8_t s = f->post_shift; s <= LM_TILE_POST_SHIFT_MAX && steps > UINT16_MAX; s++) {
        const uint32_t down = ((uint32_t)below + (1u << s) - 1) >> s;
        t->post_shift = s;
        t->base_m_q6 = f->base_m_q6 - (int32_t)(down << s);
        steps = (uint32_t)(f->most_m_q6 - t->base_m_q6) >> s;
    }
}

/* From the north-east: whether a post stays hangs on cells to its south-west. */
static void fill_row(struct lm_tile_fill *f, uint32_t row)
{
    struct lm_tile *t = f->tile;
    const struct place at = place_of(f, f->row0, row);
    for (uint32_t column = LM_TILE_POINTS; column-- > 0;) {
        struct lm_tile_point *p = &t->points[row][column];
        const int32_t above_m_q6 = filled_m_q6(f, at, row, column) - t->base_m_q6;
        p->post = (uint16_t)fx_min_u32((uint32_t)above_m_q6 >> t->post_shift, UINT16_MAX);
        if (is_none(t, row, column)) {
            p->cell = f->source->points[at.at][place_of(f, f->column0, column).at].cell;
        }
    }
}

int lm_tile_fill_run(struct lm_tile_fill *f)
{
    if (f->row < LM_TILE_POINTS) {
        measure_row(f, f->row);
    } else {
        fill_row(f, 2 * LM_TILE_POINTS - 1 - f->row);
    }
    f->row++;
    if (f->row == LM_TILE_POINTS) {
        set_steps(f);
    }
    return f->row < 2 * LM_TILE_POINTS ? LM_BUSY : LM_OK;
}
