#include "lm/scan_line.h"

#include "fx/bits.h"
#include "fx/hash.h"
#include "fx/lerp.h"
#include "fx/mem.h"

enum { RUN_CELLS = 64 }; /* longest run */

/* One coordinate along a line, cell k being at `at + k step + k (k - 1) / 2 bend`. The unit is
 * 2^-32 of a tile's side (of zone 0, where it is a longitude), so that the upper half is the tile's
 * row or column and the lower half the place in it. Rounding the bend to that unit moves the last
 * cell of the longest line by 2^-10 of a cell. */
struct track {
    int64_t at, step, bend;
};

/* The way of a line through the tiles of one level. */
struct walk {
    struct track north, east;
    uint32_t side_log2; /* of a tile, in BAM of latitude */
};

/* The place of a run's cells in its tile, as fractions of the side: 2^32 is the whole, so that no
 * value lies outside. */
struct local_track {
    uint32_t at, step, bend;
};

/* Consecutive cells of a line in one tile of the level asked for. */
struct run {
    uint32_t cells; /* 1..RUN_CELLS */
    uint32_t row, column;
    uint32_t high, wide; /* binary logarithms of the tile's sides, in BAM */
    struct local_track north, east;
};

/* Where the cells of a run are found in the tile that answers, which may be an ancestor of the one
 * asked for: fraction of its side = origin + (fraction of the asked tile's side >> generations). */
struct view {
    const struct lm_tile *tile;
    uint32_t north_origin, east_origin;
    uint32_t generations;
};

struct lm_sampling lm_sampling_for(const struct lm_db *db, uint32_t cell_mm, uint32_t epoch)
{
    struct lm_sampling s = {.level = 0, .noise_shift = 0, .epoch = epoch};
    while (s.level + 1 < db->level_count && lm_db_cell_mm(db, (uint8_t)(s.level + 1)) <= cell_mm) {
        s.level++;
    }
    /* cell / sqrt 2 in BAM: mm * 46341 / 65536 / 9.31506, that is mm * 4975 >> 16. */
    const uint32_t noise_bam = (uint32_t)(((uint64_t)cell_mm * 4975) >> 16);
    s.noise_shift = noise_bam ? (uint8_t)(31 - fx_clz32(noise_bam)) : 0;
    return s;
}

/* From the path's 2^-32 BAM. The angle itself is unsigned, its differences are not. Everything is
 * modulo 2^64, so that no path can do more harm than lead astray. */
static struct track track_of(uint64_t value, uint64_t step, uint64_t bend, uint32_t side_log2)
{
    const uint64_t half = (uint64_t)1 << side_log2 >> 1;
    return (struct track){.at = (int64_t)(value >> side_log2),
                          .step = (int64_t)(step + half) >> side_log2,
                          .bend = (int64_t)(bend + half) >> side_log2};
}

static struct walk walk_of(const struct lm_ground_path *p, uint32_t shift)
{
    const uint32_t side_log2 = shift + LM_TILE_CELLS_LOG2;
    const uint64_t from_pole = p->latitude + ((uint64_t)FX_BAM_90 << 32);
    return (struct walk){
        .north = track_of(from_pole, p->latitude_step, p->latitude_bend, side_log2),
        .east = track_of(p->longitude, p->longitude_step, p->longitude_bend, side_log2),
        .side_log2 = side_log2};
}

static struct local_track local_track_of(const struct track *t, uint32_t zone)
{
    return (struct local_track){.at = (uint32_t)(t->at >> zone),
                                .step = (uint32_t)(t->step >> zone),
                                .bend = (uint32_t)(t->bend >> zone)};
}

static void advance(struct track *t, uint32_t cells)
{
    const uint64_t n = cells, step = (uint64_t)t->step, bend = (uint64_t)t->bend;
    t->at = (int64_t)((uint64_t)t->at + n * step + n * (n - 1) / 2 * bend);
    t->step = (int64_t)(step + n * bend);
}

/* |x|. Bends are below 2^53, as track_of cuts ten bits off or more, and steps below 2^63 after
 * LM_CELLS_MAX of them: a step and RUN_CELLS bends add up without overflow. */
static uint64_t magnitude(int64_t x)
{
    return x < 0 ? 0 - (uint64_t)x : (uint64_t)x;
}

/* Cells from this one on that surely lie in its tile, itself included: the way to the border that
 * the track heads for, or to the nearer one if it may turn round, at the fastest that it can go.
 * The border may turn out to be one cell farther, which then is a run of its own. */
static uint32_t cells_inside(const struct track *t, uint32_t zone)
{
    const uint32_t back = (uint32_t)(t->at >> zone), ahead = ~back;
    const uint64_t pace = magnitude(t->step), change = magnitude(t->bend) * RUN_CELLS;
    uint32_t room = t->step < 0 ? back : ahead;
    if (pace < change) {
        room = back < ahead ? back : ahead;
    }
    /* RUN_CELLS more for what cutting off the bits below the zone may add to each step. */
    const uint64_t fastest = ((pace + change) >> zone) + RUN_CELLS;
    return fastest > room ? 1 : room / (uint32_t)fastest + 1;
}

/* The run that begins where the walk stands, of at most `cells` cells; the walk moves behind it. */
static struct run next_run(struct walk *w, uint32_t cells)
{
    struct run run = {.cells = cells < RUN_CELLS ? cells : RUN_CELLS,
                      .row = (uint32_t)(w->north.at >> 32),
                      .high = w->side_log2};
    /* Borders of zones are borders of tiles: the tile's own south edge tells its zone. */
    const uint32_t zone = lm_db_zone((run.row << run.high) - FX_BAM_90);
    run.wide = run.high + zone;
    run.column = (uint32_t)(w->east.at >> (32 + zone)) & ((1u << (32 - run.wide)) - 1);
    run.north = local_track_of(&w->north, 0);
    run.east = local_track_of(&w->east, zone);
    const uint32_t rows = cells_inside(&w->north, 0), columns = cells_inside(&w->east, zone);
    run.cells = run.cells < rows ? run.cells : rows;
    run.cells = run.cells < columns ? run.cells : columns;
    advance(&w->north, run.cells);
    advance(&w->east, run.cells);
    return run;
}

static struct view view_of(const struct lm_tile *tile, uint8_t level, uint32_t row, uint32_t column)
{
    const uint32_t generations = tile->level - (uint32_t)level;
    return (struct view){
        .tile = tile,
        .north_origin = (uint32_t)((uint64_t)row << (32 - generations)),
        .east_origin = (uint32_t)((uint64_t)column << (32 - generations)),
        .generations = generations,
    };
}

/* Where the cells of a run are in the tile asked for, each way: fractions of its side. */
struct places {
    uint32_t north[RUN_CELLS], east[RUN_CELLS];
};

/* `count` places, and a whole number of groups of LM_LANES of them. */
static inline void place_cells(const struct run *r, uint32_t count, struct places *restrict at)
{
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t pairs = k * (k - 1) / 2;
        at->north[k] = r->north.at + k * r->north.step + pairs * r->north.bend;
        at->east[k] = r->east.at + k * r->east.step + pairs * r->east.bend;
    }
}

/* What a place in a tile gives. Words hold two numbers of the tile side by side, the western one in
 * the low half: lm/db.h on the order of bytes. */
struct ground {
    uint32_t cell;
    int32_t elevation_q14;
};

static inline struct ground read_ground(const struct lm_tile *tile, uint32_t north_q26,
                                        uint32_t east_q26)
{
    const uint16_t *cells = (const uint16_t *)tile->cells, *posts = (const uint16_t *)tile->posts;
    const int32_t row = (int32_t)(north_q26 >> 26), column = (int32_t)(east_q26 >> 26);
    const int32_t post = row * LM_TILE_POSTS + column;
    const uint32_t south = fx_load_u32(posts + post);
    const uint32_t north = fx_load_u32(posts + post + LM_TILE_POSTS);
    const uint32_t post_q16 =
        fx_bilerp_u16_q16((uint16_t)south, (uint16_t)(south >> 16), (uint16_t)north,
                          (uint16_t)(north >> 16), east_q26 >> 18 & 255, north_q26 >> 18 & 255);
    /* A post step is 2^post_shift / 64 m, so the interpolated code's Q16 is Q22 of 2^post_shift m.
     * lm_tile_check holds |base| to 2^20 and post_shift to 4: below 2^29. */
    return (struct ground){.cell = fx_load_u32(cells + row * LM_TILE_CELLS + column) & 0xFFFF,
                           .elevation_q14 = (int32_t)((uint32_t)tile->base_q6 * 256u +
                                                      (post_q16 >> (8 - tile->post_shift)))};
}

/* Cells and elevations of `count` places from the tile that answers. They are gathered in arrays of
 * this function's own: the compiler then sees that no store touches the tile, and makes vectors of
 * the loop. */
static void read_cells(const struct view *v, const struct places *at, uint32_t count,
                       uint32_t *cell, int32_t *elevation_q14)
{
    uint32_t own_cell[RUN_CELLS];
    int32_t own_elevation_q14[RUN_CELLS];
    for (uint32_t k = 0; k < count; k++) {
        const struct ground g =
            read_ground(v->tile, v->north_origin + (at->north[k] >> v->generations),
                        v->east_origin + (at->east[k] >> v->generations));
        own_cell[k] = g.cell;
        own_elevation_q14[k] = g.elevation_q14;
    }
    for (uint32_t k = 0; k < count; k++) {
        cell[k] = own_cell[k];
        elevation_q14[k] = own_elevation_q14[k];
    }
}

static void no_cells(uint32_t count, uint32_t *restrict cell, int32_t *restrict elevation)
{
    for (uint32_t k = 0; k < count; k++) {
        cell[k] = LM_CELL_NONE;
        elevation[k] = 0;
    }
}

/* Noise that belongs to the ground: a hash of the noise cell's latitude and longitude. */
static void make_noise(const struct run *r, const struct lm_sampling *s, const struct places *at,
                       uint32_t count, uint32_t *restrict noise)
{
    const uint32_t south = (r->row << r->high) - FX_BAM_90;
    const uint32_t west = r->column << r->wide;
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t latitude = south + (at->north[k] >> (32 - r->high));
        const uint32_t longitude = west + (at->east[k] >> (32 - r->wide));
        noise[k] = fx_hash3(latitude >> s->noise_shift, longitude >> s->noise_shift, s->epoch);
    }
}

static void read_run(struct lm_scan_line *line, uint32_t first, const struct run *run,
                     const struct lm_tile *tile, const struct lm_sampling *sampling)
{
    struct places at;
    const uint32_t count = (run->cells + LM_LANES - 1) / LM_LANES * LM_LANES;
    place_cells(run, count, &at);
    make_noise(run, sampling, &at, count, line->noise + first);
    if (tile) {
        const struct view view = view_of(tile, sampling->level, run->row, run->column);
        read_cells(&view, &at, count, line->cell + first, line->elevation_q14 + first);
    } else {
        no_cells(count, line->cell + first, line->elevation_q14 + first);
    }
}

void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles,
                      const struct lm_sampling *sampling, const struct lm_ground_path *path,
                      uint32_t cells)
{
    struct walk walk = walk_of(path, (uint32_t)tiles->db->shift0 + sampling->level);
    struct run run;
    for (uint32_t i = 0; i < cells; i += run.cells) {
        run = next_run(&walk, cells - i);
        read_run(line, i, &run, lm_tile_cache_get(tiles, sampling->level, run.row, run.column),
                 sampling);
    }
}

void lm_scan_line_prefetch(struct lm_tile_cache *tiles, const struct lm_sampling *sampling,
                           const struct lm_ground_path *path, uint32_t cells)
{
    struct walk walk = walk_of(path, (uint32_t)tiles->db->shift0 + sampling->level);
    struct run run;
    for (uint32_t i = 0; i < cells; i += run.cells) {
        run = next_run(&walk, cells - i);
        lm_tile_cache_want(tiles, sampling->level, run.row, run.column);
    }
}

int32_t lm_scan_elevation(struct lm_tile_cache *tiles, uint8_t level, struct lm_place place,
                          int32_t otherwise_q10)
{
    const struct lm_ground_path path = {.latitude = (uint64_t)place.latitude << 32,
                                        .longitude = (uint64_t)place.longitude << 32};
    struct walk walk = walk_of(&path, (uint32_t)tiles->db->shift0 + level);
    const struct run run = next_run(&walk, 1);
    const struct lm_tile *tile = lm_tile_cache_get(tiles, level, run.row, run.column);
    if (!tile) {
        return otherwise_q10;
    }
    const struct view v = view_of(tile, level, run.row, run.column);
    return read_ground(tile, v.north_origin + (run.north.at >> v.generations),
                       v.east_origin + (run.east.at >> v.generations))
               .elevation_q14 >>
           4;
}
