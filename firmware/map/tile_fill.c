#include "lm/tile_fill.h"

#include "fx/hash.h"
#include "fx/sat.h"
#include "lm/grown.h"
#include "lm/kernels_clutter.h"
#include "lm/kernels_map.h"
#include "lm/lanes.h"

enum {
    NONE_MASK = 15 << 4,
    NONE = LM_DB_CLASS_NONE << 4,
    FINE_LOG2 = 8, /* places in a cell of the source are told to 1/256 */
    ROW_GROUPS = (LM_TILE_POINTS + LM_LANES - 1) / LM_LANES,
    ROW_ROOM = (ROW_GROUPS + 1) * LM_LANES,
    WHOLE_ROWS = 3,  /* in a part, where no cell is to be filled */
    ANY_SCALE = -8,  /* of struct lm_tile_base: sea level and the least steps */
    STEPPED_MOST = 1 /* generations of which a cell of the tile has 3/2 texels or more */
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
                        uint32_t generations, const struct lm_classes *classes)
{
    const uint32_t within = (1u << generations) - 1;
    *f = (struct lm_tile_fill){.tile = tile,
                               .source = source,
                               .classes = classes,
                               .generations = generations,
                               .row0 = (int32_t)((tile->row & within) * LM_TILE_CELLS),
                               .column0 = (int32_t)((tile->column & within) * LM_TILE_CELLS),
                               .least_m_q6 = INT32_MAX,
                               .most_m_q6 = INT32_MIN,
                               .base_m_q6 = tile->base_m_q6,
                               .post_shift = tile->post_shift};
    for (uint32_t i = 0; i < LM_DB_CLASS_NONE; i++) {
        const int16_t *gain_db_q8 = classes->entry[i].lod_gain_db_q8;
        f->natural |= (uint32_t)(classes->entry[i].flags & LM_CLASS_NATURAL) << i;
        f->more_db_q8[i] = gain_db_q8[tile->lod + generations] - gain_db_q8[tile->lod];
    }
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

/* Gaps of a row: posts that are the corner of no cell with data, and take the source's elevation.
 * Returns whether a cell of the row has no data. */
static bool find_gaps(const struct lm_tile *t, uint32_t row, bool gap[LM_TILE_POINTS])
{
    const struct lm_tile_point *own = t->points[row], *south = t->points[row - (row > 0)];
    bool is_west_none = true, has_none = false;
    for (uint32_t column = 0; column < LM_TILE_POINTS; column++) {
        const bool is_own_none = (own[column].cell & NONE_MASK) == NONE;
        const bool are_none = is_own_none && (south[column].cell & NONE_MASK) == NONE;
        gap[column] = are_none && is_west_none;
        has_none |= is_own_none;
        is_west_none = are_none;
    }
    return has_none;
}

/* Elevation of a post in the filled tile. */
static int32_t filled_m_q6(const struct lm_tile_fill *f, struct place at, uint32_t row,
                           uint32_t column, bool is_gap)
{
    return is_gap ? source_m_q6(f->source, at, place_of(f, f->column0, column))
                  : f->base_m_q6 + (f->tile->points[row][column].post << f->post_shift);
}

/* Returns whether the row has gaps. */
static bool measure_row(struct lm_tile_fill *f, uint32_t row)
{
    const struct place at = place_of(f, f->row0, row);
    bool gap[LM_TILE_POINTS];
    const bool has_none = find_gaps(f->tile, row, gap);
    for (uint32_t column = 0; column < LM_TILE_POINTS; column++) {
        const int32_t m_q6 = filled_m_q6(f, at, row, column, gap[column]);
        f->least_m_q6 = fx_min_i32(f->least_m_q6, m_q6);
        f->most_m_q6 = fx_max_i32(f->most_m_q6, m_q6);
    }
    return has_none;
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

/* Cells of a row as the source is blended there, as lm_k_tile_blend tells them; and what their
 * heights lack to those of the blend, metres * 16384. */
struct blended {
    uint32_t cell[ROW_ROOM];
    int32_t lack_m_q14[ROW_ROOM];
};

/* Places are those of the middles of the tile's cells in the source. That of a cell beside the
 * source is anywhere in it. */
static void blend_row(const struct lm_tile_fill *f, uint32_t row, struct blended *b)
{
    const uint32_t side_log2 = 32 - LM_TILE_CELLS_LOG2 - f->generations,
                   half = 1u << side_log2 >> 1;
    const uint32_t north = (uint32_t)f->row0 + row - LM_TILE_BORDER;
    const uint32_t west = (uint32_t)f->column0 - LM_TILE_BORDER;
    const struct lm_tile_coords places = {.north = {.at = (north << side_log2) + half},
                                          .east = {(west << side_log2) + half, 1u << side_log2, 0}};
    const struct lm_k_blend map = {.points = lm_tile_origin(f->source),
                                   .grown = lm_grown,
                                   .height_dm_of_code = f->classes->height_dm,
                                   .grown_shift = LM_GROWN_CELL_SHIFT,
                                   .is_stepped = f->generations <= STEPPED_MOST,
                                   .natural = f->natural};
    uint32_t nearest[ROW_ROOM];
    int32_t terrain_m_q14[ROW_ROOM];
    for (uint32_t i = 0; i < ROW_ROOM; i++) {
        nearest[i] = b->cell[i] = 0;
        terrain_m_q14[i] = b->lack_m_q14[i] = ANY_SCALE;
    }
    lm_k_tile_read(map.points, &places, 0, ROW_GROUPS, nearest, terrain_m_q14);
    lm_k_tile_blend(&map, &places, 0, ROW_GROUPS, b->cell, b->lack_m_q14);
    for (uint32_t i = 0; i < LM_TILE_POINTS; i++) {
        b->lack_m_q14[i] -= terrain_m_q14[i];
    }
}

/* Of the codes of the heights below and above one the nearer; or one that is drawn by the place, so
 * that the mean stays. `draw` is of 2^16, and 2^15 draws the nearer. */
static uint32_t code_of(const uint16_t *height_dm, int32_t m_q14, uint32_t draw)
{
    uint32_t code = 0;
    while (code + 2 < LM_K_CODES && m_q14 >= lm_k_height_m_q14(height_dm[code + 1])) {
        code++;
    }
    /* Heights are below 2^27, and equal ones have no share. */
    const int64_t low = lm_k_height_m_q14(height_dm[code]);
    const int64_t apart = lm_k_height_m_q14(height_dm[code + 1]) - low;
    return code + ((m_q14 - low) << 16 > apart * (int64_t)draw);
}

/* Trees have tops: no two cells of theirs are alike. */
static uint32_t draw_of(const struct lm_tile_fill *f, uint32_t cell, uint32_t row, uint32_t column)
{
    const struct lm_tile *t = f->tile;
    return f->classes->entry[cell >> 4 & 15].kind != LM_KIND_TREES
               ? 1u << 15
               : fx_hash3(t->row * LM_TILE_CELLS + row, t->column * LM_TILE_CELLS + column, 0) >>
                     16;
}

/* The cell of a record that has the class and height of one, and so much more reflectivity as its
 * class has gain at the source's LOD. */
static uint16_t cell_with(const struct lm_tile_fill *f, uint32_t cell, int32_t more_db_q8)
{
    const int32_t all_db_q8 = more_db_q8 + f->more_db_q8[cell >> 4 & 15];
    return lm_cell_brightened(cell, lm_gamma_codes_of(all_db_q8));
}

static uint16_t blended_cell(const struct lm_tile_fill *f, const struct blended *b, uint32_t row,
                             uint32_t column)
{
    const uint16_t *height_dm = f->classes->height_dm;
    uint32_t cell = b->cell[column];
    if (b->lack_m_q14[column] != 0) {
        const int32_t m_q14 = lm_k_height_m_q14(height_dm[cell & 15]) + b->lack_m_q14[column];
        cell = (cell & ~15u) | code_of(height_dm, m_q14, draw_of(f, cell, row, column));
    }
    return cell_with(f, cell, (int32_t)cell >> 16);
}

static bool is_in_source(const struct lm_tile_fill *f, int32_t first, uint32_t point)
{
    const int32_t cell = (first + (int32_t)point - LM_TILE_BORDER) >> f->generations;
    return cell >= 0 && cell < LM_TILE_CELLS;
}

/* From the north: whether a post is a gap hangs on cells to its south. Returns whether there were
 * cells to fill. */
static bool fill_row(struct lm_tile_fill *f, uint32_t row)
{
    struct lm_tile *t = f->tile;
    struct blended blended;
    const struct place at = place_of(f, f->row0, row);
    bool gap[LM_TILE_POINTS];
    const bool has_none = find_gaps(t, row, gap);
    const bool is_blended = has_none && f->generations > 0 && is_in_source(f, f->row0, row);
    if (is_blended) {
        blend_row(f, row, &blended);
    }
    for (uint32_t column = 0; column < LM_TILE_POINTS; column++) {
        struct lm_tile_point *p = &t->points[row][column];
        const int32_t above_m_q6 = filled_m_q6(f, at, row, column, gap[column]) - t->base_m_q6;
        p->post = (uint16_t)fx_min_u32((uint32_t)above_m_q6 >> t->post_shift, UINT16_MAX);
        if (is_none(t, row, column)) {
            const bool is_between = is_blended && is_in_source(f, f->column0, column);
            const uint32_t nearest =
                f->source->points[at.at][place_of(f, f->column0, column).at].cell;
            p->cell =
                is_between ? blended_cell(f, &blended, row, column) : cell_with(f, nearest, 0);
        }
    }
    return has_none;
}

int lm_tile_fill_run(struct lm_tile_fill *f)
{
    bool has_none = false;
    for (uint32_t i = 0; i < WHOLE_ROWS && !has_none && f->row < 2 * LM_TILE_POINTS; i++) {
        has_none = f->row < LM_TILE_POINTS ? measure_row(f, f->row)
                                           : fill_row(f, 2 * LM_TILE_POINTS - 1 - f->row);
        f->row++;
        if (f->row == LM_TILE_POINTS) {
            set_steps(f);
        }
    }
    return f->row < 2 * LM_TILE_POINTS ? LM_BUSY : LM_OK;
}
