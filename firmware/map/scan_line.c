#include "lm/scan_line.h"

#include "lm/grown.h"
#include "lm/seldom.h"
#include "lm/tile_read.h"

/* A line is walked from run to run. A run is a stretch of cells in one tile.
 *
 *     tile     |    r, c     |   r, c+1   |   r+1, c+1
 *     cell   k |.............|............|......
 *              run           run          run
 *
 * read_zone assigns a tile to each run, and then reads all cells in one call. The columns change
 * their width with the zone, so that a line is read zone by zone. */

/* One coordinate of a line as a quadratic: cell k is at `at + k (step + k half_bend)`, modulo 2^64.
 * The unit is 2^-32 of a tile's side. Hence the upper half is the tile's row or column, and the
 * lower half the point in the tile. */
struct coordinate {
    uint64_t at, step, half_bend;
};

/* One axis of the map, row or column, during a walk along a line. */
struct map_axis {
    struct coordinate coordinate;
    uint64_t fastest;   /* longer than every step of the line */
    uint32_t direction; /* all ones if the coordinate grows, 0 if it falls */
    bool is_turning;    /* true if it may do both */
    uint32_t round;     /* mask of rows or columns: a power of two less one */
    uint32_t tile;      /* row or column of the current run */
    uint32_t end;       /* first cell that may lie in the next tile, or `cells` */
};

/* Keep code that runs once a line, or seldom, out of line. It then takes no registers from the loop
 * of runs, which saves 140 instructions a line on the Cortex-A53. */
#define OUT_OF_LINE __attribute__((noinline))

/* Walk of a line through the tiles of one LOD. */
struct walk {
    const struct lm_ground_path *path;  /* borrowed */
    const struct lm_scan_blend *wanted; /* borrowed; NULL: no tile is blended */
    const struct lm_k_blend *blend;     /* borrowed; NULL: the nearest cells are read */
    bool tells_runs;
    struct map_axis north, east;
    uint32_t cells;
    uint32_t side_log2; /* of a tile, in BAM of latitude */
    uint32_t sixteenth; /* of the current row: sixteenth_of_row */
};

uint8_t lm_scan_lod(const struct lm_db *db, uint32_t cell_mm)
{
    const uint64_t longest_mm = (uint64_t)cell_mm + cell_mm / 8;
    uint8_t lod = db->finest;
    while (lod + 1 < db->lod_count && lm_db_cell_mm(db, (uint8_t)(lod + 1)) <= longest_mm) {
        lod++;
    }
    return lod;
}

/* Lengths of cells for crowns: the map must not show them, and the picture must. */
enum { CROWN_CELL_MM = 3500 };

/* Turn the blend to the tiles of an LOD. */
static void turn_to_lod(struct lm_scan_blend *b, const struct lm_db *db, uint8_t lod)
{
    const uint32_t cell_mm = b->cell_mm, map_mm = lm_db_cell_mm(db, lod);
    const bool has_crowns = cell_mm < CROWN_CELL_MM && map_mm > CROWN_CELL_MM;
    b->is_on = (uint64_t)3 * cell_mm < (uint64_t)2 * map_mm;
    b->crowned = has_crowns ? b->trees : 0;
    b->grown_shift = has_crowns ? 32u - LM_TILE_CELLS_LOG2 - db->shift0 - lod + LM_GROWN_TEXEL_LOG2
                                : LM_GROWN_CELL_SHIFT;
    /* Three halves of a texel, which is map_mm over 2^(32 - 6 - grown_shift). */
    b->is_stepped =
        (uint64_t)2 * cell_mm << (32 - LM_TILE_CELLS_LOG2 - b->grown_shift) >= (uint64_t)3 * map_mm;
}

void lm_scan_blend_set(struct lm_scan_blend *b, const struct lm_db *db, uint32_t cell_mm)
{
    b->cell_mm = cell_mm;
    b->natural = b->trees = b->flat = 0;
    b->tells_runs = false;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const struct lm_class *c = &db->classes.entry[i];
        b->natural |= (uint32_t)(c->flags & LM_CLASS_NATURAL) << i;
        b->trees |= (uint32_t)(c->kind == LM_KIND_TREES) << i;
    }
    turn_to_lod(b, db, db->finest);
}

static struct lm_k_blend kernel_blend(const struct lm_scan_blend *b,
                                      const struct lm_tile_cache *tiles)
{
    return (struct lm_k_blend){.points = lm_tile_origin(tiles->pool),
                               .grown = lm_grown,
                               .height_dm_of_code = tiles->db->classes.height_dm,
                               .grown_shift = b->grown_shift,
                               .is_stepped = b->is_stepped,
                               .natural = b->natural,
                               .crowned = b->crowned,
                               .flat = b->flat};
}

static inline uint64_t magnitude(int64_t x)
{
    return x < 0 ? 0 - (uint64_t)x : (uint64_t)x;
}

static inline uint64_t coordinate_at(const struct coordinate *w, uint32_t k)
{
    return w->at + k * (w->step + k * w->half_bend);
}

/* The quadratic that has the value `at` and the derivative `slope` at cell k. */
static inline struct coordinate coordinate_through(uint32_t k, uint64_t at, uint64_t slope,
                                                   uint64_t half_bend)
{
    return (struct coordinate){at - k * (slope - k * half_bend), slope - 2 * k * half_bend,
                               half_bend};
}

/* Start a run at cell k: find its tile and how many cells surely lie in it.
 *
 * The distance to the border ahead, or to the nearer border if the axis may turn, is divided by a
 * bound of the steps. The true border may be farther. Then the next run continues in the same
 * tile. */
static inline void start_run(struct map_axis *a, uint32_t k, uint32_t cells)
{
    const uint64_t at = coordinate_at(&a->coordinate, k);
    uint32_t room = (uint32_t)at ^ a->direction;
    if (a->is_turning && ~room < room) {
        room = ~room;
    }
    const uint64_t end = k + 1 + room / a->fastest;
    a->tile = (uint32_t)(at >> 32) & a->round;
    a->end = end < cells ? (uint32_t)end : cells;
}

/* One coordinate of a path with its differences, in units of 2^-32 BAM: struct lm_ground_path. */
struct path_coordinate {
    uint64_t value, step, bend;
};

/* Start to walk along an axis, in the tile of cell k. Converts the path's forward differences, in
 * units of 2^-32 BAM, to a quadratic in units of 2^-32 of a tile's side.
 *
 * With m the middle cell, value m is value + m step + m (m - 1) / 2 bend. The derivative there is
 * step + m bend - bend / 2. The quadratic is exact at m. The bend is rounded to half a unit, which
 * moves the ends of a line of 528 cells by 528^2 / 8 units: 2^-11 of a cell.
 *
 * The angle itself is unsigned, its differences are signed. Everything is modulo 2^64, so a bad
 * path leads to a wrong tile, never to an overflow. */
static inline void start_axis(struct map_axis *a, struct path_coordinate g, uint32_t side_log2,
                              uint32_t k, uint32_t cells)
{
    const uint32_t middle = cells / 2, pairs = middle * (middle - 1) / 2;
    const uint64_t half = (uint64_t)1 << side_log2;
    const uint64_t at = (g.value + middle * g.step + pairs * g.bend) >> side_log2;
    const uint64_t slope = g.step + middle * g.bend - (uint64_t)((int64_t)g.bend >> 1);
    const int64_t slope_there = (int64_t)slope >> side_log2;
    const int64_t half_bend = (int64_t)(g.bend + half) >> side_log2 >> 1;
    /* No step of the line differs from the slope by more than the bend of all cells. A tile is at
     * least 2^10 BAM high, so these are below 2^53 and 2^62. */
    const uint64_t fast = magnitude(slope_there), bent = magnitude(half_bend) * cells;
    a->coordinate = coordinate_through(middle, at, (uint64_t)slope_there, (uint64_t)half_bend);
    a->fastest = fast + bent + 1;
    a->direction = slope_there < 0 ? 0 : UINT32_MAX;
    a->is_turning = fast <= bent;
    a->round = UINT32_MAX >> side_log2;
    start_run(a, k, cells);
}

static OUT_OF_LINE void start_walk(struct walk *w, const struct lm_db *db, uint8_t lod,
                                   const struct lm_ground_path *path, uint32_t cells)
{
    w->blend = NULL;
    w->wanted = NULL;
    const uint64_t from_pole = path->latitude + ((uint64_t)FX_BAM_90 << 32);
    w->path = path;
    w->cells = cells;
    w->side_log2 = (uint32_t)db->shift0 + lod + LM_TILE_CELLS_LOG2;
    start_axis(&w->north,
               (struct path_coordinate){from_pole, path->latitude_step, path->latitude_bend},
               w->side_log2, 0, cells);
}

_Static_assert(LM_DB_SHIFT_MAX + LM_TILE_CELLS_LOG2 <= LM_DB_SIXTEENTH_LOG2,
               "a tile lies in one zone");

/* The sixteenth of a quarter turn that the current row lies in, from the south pole. Zones begin
 * and end at sixteenths, and these at borders of tiles. */
static inline uint32_t sixteenth_of_row(const struct walk *w)
{
    return w->north.tile >> (LM_DB_SIXTEENTH_LOG2 - w->side_log2);
}

/* Enter a zone at cell k: start to walk along its columns. */
static OUT_OF_LINE void enter_zone(struct walk *w, uint32_t k)
{
    const struct lm_ground_path *p = w->path;
    const struct path_coordinate longitude = {p->longitude, p->longitude_step, p->longitude_bend};
    w->sixteenth = sixteenth_of_row(w);
    const uint32_t zone = lm_db_zone((w->sixteenth << LM_DB_SIXTEENTH_LOG2) - FX_BAM_90);
    start_axis(&w->east, longitude, w->side_log2 + zone, k, w->cells);
}

/* First cell behind the current run. */
static inline uint32_t end_of_run(const struct walk *w)
{
    return w->north.end < w->east.end ? w->north.end : w->east.end;
}

/* Advance to the run that begins at cell k. False if k lies in another zone, which must be entered
 * first, or behind the last cell. */
static inline bool next_run(struct walk *w, uint32_t k)
{
    if (k == w->north.end) {
        if (k == w->cells) {
            return false;
        }
        start_run(&w->north, k, w->cells);
        if (sixteenth_of_row(w) != w->sixteenth) {
            return false;
        }
    }
    if (k == w->east.end) { /* behind the last cell both runs end, which is seen above */
        start_run(&w->east, k, w->cells);
    }
    return true;
}

static inline struct lm_quadratic quadratic_of(const struct coordinate *w)
{
    return (struct lm_quadratic){(uint32_t)w->at, (uint32_t)w->step, (uint32_t)w->half_bend};
}

/* The coordinate in the tiles of an ancestor that many generations up, exact at cell k. A run about
 * that cell reaches at most 264 cells to either side. There the error is within 264^2 / 2 + 264
 * units of 2^-32 of the ancestor's side: 2^-10 of one of its cells. */
static struct lm_quadratic quadratic_in_ancestor(const struct coordinate *w, uint32_t k,
                                                 uint32_t generations)
{
    const uint64_t half = (uint64_t)1 << generations >> 1;
    const struct coordinate up =
        coordinate_through(k, coordinate_at(w, k) >> generations,
                           (uint64_t)((int64_t)(w->step + 2 * k * w->half_bend) >> generations),
                           (uint64_t)((int64_t)(w->half_bend + half) >> generations));
    return quadratic_of(&up);
}

static inline void assign_lanes(struct lm_tile_base tile, uint32_t *cell, int32_t *elevation,
                                int lanes)
{
    for (int lane = 0; lane < lanes; lane++) {
        cell[lane] = tile.record;
    }
    for (int lane = 0; lane < lanes; lane++) {
        elevation[lane] = tile.scale;
    }
}

/* Assign a tile to the cells of a run, and to those behind it up to a whole number of LM_LANES.
 * Pass one of lm/tile_read.h. */
static inline void assign_tile(struct lm_tile_base tile, uint32_t first, uint32_t end,
                               struct lm_scan_line *line)
{
    uint32_t *cell = line->cell + first;
    int32_t *elevation = line->elevation_m_q14 + first;
    int32_t more = (int32_t)(end - first) - LM_LANES; /* behind the next LM_LANES */
    while (more > 0) {
        assign_lanes(tile, cell, elevation, 2 * LM_LANES);
        cell += 2 * LM_LANES;
        elevation += 2 * LM_LANES;
        more -= 2 * LM_LANES;
        /* Keep two pointers and what is left: the compiler would replace them by one offset and its
         * end, which costs more before the loop. */
        __asm__("" : "+r"(cell), "+r"(elevation), "+r"(more));
    }
    if (more > -LM_LANES) {
        assign_lanes(tile, cell, elevation, LM_LANES);
    }
}

/* Classes have a gain at each LOD, and readers add that of the line's. Add what the ancestor's is
 * more. Gains are within 2^15, and what a blend adds is within 2^14. */
static void add_gain(const struct lm_classes *classes, uint8_t lod, uint8_t of_line, uint32_t first,
                     uint32_t end, struct lm_scan_line *line)
{
    uint32_t more[LM_DB_CLASSES] = {0}, any = 0;
    for (uint32_t i = 0; i < LM_DB_CLASS_NONE; i++) {
        const int16_t *gain_db_q8 = classes->entry[i].lod_gain_db_q8;
        more[i] = (uint32_t)(gain_db_q8[lod] - gain_db_q8[of_line]) << 16;
        any |= more[i];
    }
    for (uint32_t k = first; k < end && any != 0; k++) {
        line->cell[k] += more[line->cell[k] >> 4 & 15];
    }
}

/* Read a run from an ancestor that is assigned to it. Where the map has nothing finer it is
 * blended, if its cells are so much longer than the line's. */
static void read_ancestor(const struct walk *w, const struct lm_tile_cache *tiles, uint8_t lod,
                          const struct lm_tile *tile, const struct lm_tile_coords *coords,
                          uint32_t first, uint32_t end, struct lm_scan_line *line)
{
    struct lm_scan_blend blend = {.is_on = false};
    if (w->wanted && !tiles->is_late) {
        blend = *w->wanted;
        turn_to_lod(&blend, tiles->db, tile->lod);
    }
    if (blend.is_on) {
        const struct lm_k_blend map = kernel_blend(&blend, tiles);
        lm_tile_blend(&map, coords, first, end, line);
    } else {
        lm_tile_read(tiles->pool, coords, first, end, line);
    }
    if (!tiles->is_late) {
        add_gain(&tiles->db->classes, tile->lod, lod, first, end, line);
    }
}

/* Read a run whose tile was not found by lm_tile_cache_peek: from the tile, an ancestor, or
 * nothing. It is read at once, because an ancestor's coordinates are good for this run alone. */
static LM_SELDOM void read_substitute(const struct walk *w, struct lm_tile_cache *tiles,
                                      uint8_t lod, uint32_t first, uint32_t end,
                                      struct lm_scan_line *line)
{
    const struct lm_tile *tile = lm_tile_cache_get(tiles, lod, w->north.tile, w->east.tile);
    if (!tile) {
        for (uint32_t k = first; k < end; k++) {
            line->cell[k] = LM_CELL_NONE;
            line->elevation_m_q14[k] = 0;
        }
        return;
    }
    const uint32_t middle = (first + end) / 2, generations = tile->lod - (uint32_t)lod;
    const struct lm_tile_coords coords = {
        quadratic_in_ancestor(&w->north.coordinate, middle, generations),
        quadratic_in_ancestor(&w->east.coordinate, middle, generations)};
    assign_tile(lm_tile_base_of(tiles->pool, tile), first, end, line);
    read_ancestor(w, tiles, lod, tile, &coords, first, end, line);
    if ((uint16_t)line->cell[middle] != LM_CELL_NONE && tile->lod > lod) {
        line->coarsest_lod = tile->lod > line->coarsest_lod ? tile->lod : line->coarsest_lod;
        line->coarse_cells = (uint16_t)(line->coarse_cells + end - first);
    }
}

/* Read cells of a zone that have a tile assigned. Pass two. */
static void read_assigned(const struct walk *w, const struct lm_tile *pool, uint32_t first,
                          uint32_t end, struct lm_scan_line *line)
{
    if (first != end) {
        const struct lm_tile_coords coords = {quadratic_of(&w->north.coordinate),
                                              quadratic_of(&w->east.coordinate)};
        if (w->blend) {
            lm_tile_blend(w->blend, &coords, first, end, line);
        } else {
            lm_tile_read(pool, &coords, first, end, line);
        }
    }
}

/* Tell the current run, as far as it goes. A tile has no hollows, and what a line comes back to is
 * another run. */
static inline void tell_run(const struct walk *w, struct lm_scan_line *line)
{
    const uint32_t row = w->north.tile, column = w->east.tile;
    const uint32_t count = line->run_count;
    const bool goes_on =
        count != 0 && line->run[count - 1].row == row && line->run[count - 1].column == column;
    if (!goes_on && count == LM_SCAN_RUNS_MAX) {
        return;
    }
    struct lm_scan_run *const run = &line->run[goes_on ? count - 1 : count];
    *run = (struct lm_scan_run){row, column, end_of_run(w)};
    line->run_count = count + !goes_on;
}

/* Read the cells of a zone, from cell k on. Returns the first cell behind them. */
static uint32_t read_zone(struct walk *w, struct lm_tile_cache *tiles, uint8_t lod, uint32_t k,
                          struct lm_scan_line *line)
{
    const struct lm_tile *pool = tiles->pool;
    uint32_t assigned = k; /* the first cell that is assigned and not read */
    enter_zone(w, k);
    do {
        const uint32_t end = end_of_run(w);
        const struct lm_tile_slot *slot =
            lm_tile_cache_peek(tiles, lod, w->north.tile, w->east.tile);
        if (slot) {
            assign_tile(slot->base, k, end, line);
        } else {
            read_assigned(w, pool, assigned, k, line);
            read_substitute(w, tiles, lod, k, end, line);
            assigned = end;
        }
        if (w->tells_runs) {
            tell_run(w, line);
        }
        k = end;
    } while (next_run(w, k));
    read_assigned(w, pool, assigned, k, line);
    return k;
}

void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles, uint8_t lod,
                      const struct lm_scan_blend *blend, const struct lm_ground_path *path,
                      uint32_t cells)
{
    struct walk w;
    struct lm_k_blend map;
    line->coarsest_lod = lod;
    line->coarse_cells = 0;
    line->run_count = 0;
    start_walk(&w, tiles->db, lod, path, cells);
    w.wanted = blend;
    w.tells_runs = blend && blend->tells_runs;
    if (blend && blend->is_on) {
        map = kernel_blend(blend, tiles);
        w.blend = &map;
    }
    for (uint32_t k = 0; k < cells;) {
        k = read_zone(&w, tiles, lod, k, line);
    }
}

void lm_scan_line_prefetch(struct lm_tile_cache *tiles, uint8_t lod,
                           const struct lm_ground_path *path, uint32_t cells)
{
    struct walk w;
    start_walk(&w, tiles->db, lod, path, cells);
    for (uint32_t k = 0; k < cells;) {
        enter_zone(&w, k);
        do {
            lm_tile_cache_want(tiles, lod, w.north.tile, w.east.tile);
            k = end_of_run(&w);
        } while (next_run(&w, k));
    }
}

/* Ground at a place, from the resident tile or its nearest resident ancestor. False if there is
 * none. */
static bool find_ground(struct lm_tile_cache *tiles, uint8_t lod, struct lm_position position,
                        struct lm_ground *ground)
{
    const uint32_t side_log2 = (uint32_t)tiles->db->shift0 + lod + LM_TILE_CELLS_LOG2;
    const uint64_t from_pole = (uint64_t)(position.latitude + FX_BAM_90) << 32;
    const uint64_t north = from_pole >> side_log2;
    const uint64_t east =
        ((uint64_t)position.longitude << 32) >> (side_log2 + lm_db_zone(position.latitude));
    const struct lm_tile *tile =
        lm_tile_cache_get(tiles, lod, (uint32_t)(north >> 32), (uint32_t)(east >> 32));
    if (!tile) {
        return false;
    }
    const uint32_t generations = tile->lod - (uint32_t)lod;
    *ground =
        lm_tile_ground(tile, (uint32_t)(north >> generations), (uint32_t)(east >> generations));
    return true;
}

int32_t lm_scan_elevation(struct lm_tile_cache *tiles, uint8_t lod, struct lm_position position,
                          int32_t fallback_m_q10)
{
    struct lm_ground ground;
    return find_ground(tiles, lod, position, &ground) ? ground.elevation_m_q14 >> 4
                                                      : fallback_m_q10;
}

uint16_t lm_scan_cell(struct lm_tile_cache *tiles, uint8_t lod, struct lm_position position)
{
    struct lm_ground ground;
    return find_ground(tiles, lod, position, &ground) ? (uint16_t)ground.cell : LM_CELL_NONE;
}
