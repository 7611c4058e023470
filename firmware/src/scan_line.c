#include "lm/scan_line.h"

#include "fx/bits.h"
#include "fx/hash.h"
#include "noise_neon.h"

enum { RUN_CELLS = 64 }; /* longest run */

/* One coordinate along a line, cell k being at `at + k step + k (k - 1) / 2 bend`. The unit is
 * 2^-32 of a tile's side (of zone 0, where it is a longitude), so that the upper half is the tile's
 * row or column and the lower half the place in it. Rounding the bend to that unit moves the last
 * cell of the longest line by 2^-10 of a cell. */
struct track {
    int64_t at, step, bend;
    uint64_t fastest;   /* no step of the line is longer */
    uint32_t direction; /* all ones where none goes back */
    bool turns;         /* some go back and some do not */
};

/* The way of a line through the tiles of one level. */
struct walk {
    struct track north, east;
    uint32_t side_log2; /* of a tile, in BAM of latitude */
};

/* Consecutive cells of a line in one tile of the level asked for. */
struct run {
    uint32_t cells; /* 1..RUN_CELLS */
    uint32_t row, column;
    uint32_t zone;
    struct track north, east; /* from its first cell on */
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

static uint64_t magnitude(int64_t x)
{
    return x < 0 ? 0 - (uint64_t)x : (uint64_t)x;
}

/* From the path's 2^-32 BAM, for so many cells. The angle itself is unsigned, its differences are
 * not. Everything is modulo 2^64, so that no path can do more harm than lead astray. Steps grow or
 * shrink all the way: the first and the last tell how fast they are and where they go. */
static struct track track_of(uint64_t value, uint64_t step, uint64_t bend, uint32_t side_log2,
                             uint32_t cells)
{
    const uint64_t half = (uint64_t)1 << side_log2 >> 1;
    struct track t = {.at = (int64_t)(value >> side_log2),
                      .step = (int64_t)(step + half) >> side_log2,
                      .bend = (int64_t)(bend + half) >> side_log2};
    const int64_t last = (int64_t)((uint64_t)t.step + (uint64_t)t.bend * cells);
    const uint64_t fast = magnitude(t.step), fast_at_last = magnitude(last);
    t.fastest = fast > fast_at_last ? fast : fast_at_last;
    t.direction = t.step < 0 ? 0 : UINT32_MAX;
    t.turns = (t.step < 0) != (last < 0);
    return t;
}

static struct walk walk_of(const struct lm_ground_path *p, uint32_t shift, uint32_t cells)
{
    const uint32_t side = shift + LM_TILE_CELLS_LOG2;
    const uint64_t from_pole = p->latitude + ((uint64_t)FX_BAM_90 << 32);
    return (struct walk){
        .north = track_of(from_pole, p->latitude_step, p->latitude_bend, side, cells),
        .east = track_of(p->longitude, p->longitude_step, p->longitude_bend, side, cells),
        .side_log2 = side};
}

/* The same in a tile so many generations up, or of a zone so much wider. */
static struct lm_track tile_track(const struct track *t, uint32_t shift)
{
    const uint32_t half_bend = (uint32_t)(t->bend >> shift >> 1);
    return (struct lm_track){.at = (uint32_t)(t->at >> shift),
                             .step = (uint32_t)(t->step >> shift) - half_bend,
                             .half_bend = half_bend};
}

static void advance(struct track *t, uint32_t cells)
{
    const uint64_t n = cells, step = (uint64_t)t->step, bend = (uint64_t)t->bend;
    t->at = (int64_t)((uint64_t)t->at + n * step + n * (n - 1) / 2 * bend);
    t->step = (int64_t)(step + n * bend);
}

/* Cells from this one on that surely lie in its tile, itself included: the way to the border that
 * the track heads for, or to the nearer one if it turns round, at the fastest that it goes. The
 * border may turn out to be one cell farther, which then is a run of its own. */
static inline uint32_t cells_inside(const struct track *t, uint32_t zone)
{
    uint32_t room = (uint32_t)(t->at >> zone) ^ t->direction;
    if (t->turns && ~room < room) {
        room = ~room;
    }
    /* RUN_CELLS more for what cutting off the bits below the zone may add to each step. */
    const uint64_t fastest = (t->fastest >> zone) + RUN_CELLS;
    return fastest > room ? 1 : room / (uint32_t)fastest + 1;
}

/* The run that begins where the walk stands, of at most `cells` cells; the walk moves behind it. */
static inline struct run next_run(struct walk *w, uint32_t cells)
{
    struct run run = {.cells = cells < RUN_CELLS ? cells : RUN_CELLS,
                      .row = (uint32_t)(w->north.at >> 32),
                      .north = w->north,
                      .east = w->east};
    /* Borders of zones are borders of tiles: the tile's own south edge tells its zone. */
    run.zone = lm_db_zone((run.row << w->side_log2) - FX_BAM_90);
    run.column =
        (uint32_t)(w->east.at >> (32 + run.zone)) & ((1u << (32 - w->side_log2 - run.zone)) - 1);
    const uint32_t rows = cells_inside(&w->north, 0), columns = cells_inside(&w->east, run.zone);
    run.cells = run.cells < rows ? run.cells : rows;
    run.cells = run.cells < columns ? run.cells : columns;
    advance(&w->north, run.cells);
    advance(&w->east, run.cells);
    return run;
}

static void no_cells(uint32_t count, uint32_t *restrict cell, int32_t *restrict elevation)
{
    for (uint32_t k = 0; k < count; k++) {
        cell[k] = LM_CELL_NONE;
        elevation[k] = 0;
    }
}

/* What the tile that answers, an ancestor perhaps, says on a run. */
static void read_run(const struct run *run, const struct lm_tile *tile, uint8_t level,
                     uint32_t *cell, int32_t *elevation_q14)
{
    const uint32_t generations = tile->level - (uint32_t)level;
    const struct lm_track north = tile_track(&run->north, generations);
    const struct lm_track east = tile_track(&run->east, run->zone + generations);
    lm_tile_read(tile, &north, &east, run->cells, cell, elevation_q14);
}

/* Noise cells have a fraction of so many bits; a sign and those of LM_NOISE_REACH are the rest. The
 * bend's rounding, to half a unit, moves the ends of the longest line by 528^2 / 4 units, which is
 * 2^-4 of a noise cell. */
_Static_assert(LM_NOISE_REACH == 1 << (31 - NOISE_BITS), "the reach is what the fraction leaves");

/* One coordinate of a line, in noise cells from that of cell `before`, where value and step are
 * those of the path. */
static struct lm_track noise_track_of(uint64_t value, uint64_t step, uint64_t bend,
                                      uint32_t noise_shift, uint32_t before)
{
    const uint32_t shift = 32 - NOISE_BITS + noise_shift;
    const uint32_t at = (uint32_t)(value >> shift) & ((1u << NOISE_BITS) - 1);
    const uint32_t slope = (uint32_t)((int64_t)(step - bend / 2) >> shift);
    const uint32_t half_bend = (uint32_t)((int64_t)(bend + ((uint64_t)1 << shift)) >> shift >> 1);
    return (struct lm_track){.at = at - before * (slope - before * half_bend),
                             .step = slope - 2 * before * half_bend,
                             .half_bend = half_bend};
}

/* The number of a noise cell, with a sign. */
static uint32_t noise_cell(uint64_t value, uint32_t noise_shift)
{
    return (uint32_t)((int32_t)(value >> 32) >> noise_shift);
}

static inline uint32_t whole_noise_cells(uint32_t from_middle)
{
    return (uint32_t)((int32_t)from_middle >> NOISE_BITS);
}

static void hash_line(const struct noise *n, uint32_t cells, uint32_t *restrict noise)
{
    for (uint32_t k = 0; k < cells; k++) {
        const uint32_t rows = whole_noise_cells(lm_track_at(&n->north, k));
        const uint32_t columns = whole_noise_cells(lm_track_at(&n->east, k));
        noise[k] = fx_hash3_of_sum(n->sum + rows * n->row + columns * n->column);
    }
}

/* Noise that belongs to the ground: a hash of the noise cell's latitude and longitude, counted from
 * the line's middle. */
static void make_noise(const struct lm_sampling *s, const struct lm_ground_path *path,
                       uint32_t cells, uint32_t *noise)
{
    const uint32_t shift = s->noise_shift, middle = cells / 2;
    struct lm_ground_path p = *path;
    lm_ground_path_skip(&p, (int32_t)middle);
    const struct noise n = {
        .north = noise_track_of(p.latitude, p.latitude_step, p.latitude_bend, shift, middle),
        .east = noise_track_of(p.longitude, p.longitude_step, p.longitude_bend, shift, middle),
        .sum =
            fx_hash3_sum(noise_cell(p.latitude, shift), noise_cell(p.longitude, shift), s->epoch),
        .row = fx_hash3_sum(1, 0, 0),
        .column = fx_hash3_sum(0, 1, 0),
    };
    if (FX_HAS_NEON) {
        hash_line_neon(&n, cells, noise);
    } else {
        hash_line(&n, cells, noise);
    }
}

void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles,
                      const struct lm_sampling *sampling, const struct lm_ground_path *path,
                      uint32_t cells)
{
    const uint8_t level = sampling->level;
    struct walk walk = walk_of(path, (uint32_t)tiles->db->shift0 + level, cells);
    struct run run;
    for (uint32_t i = 0; i < cells; i += run.cells) {
        run = next_run(&walk, cells - i);
        const struct lm_tile *tile = lm_tile_cache_get(tiles, level, run.row, run.column);
        if (tile) {
            read_run(&run, tile, level, line->cell + i, line->elevation_q14 + i);
        } else {
            no_cells(run.cells, line->cell + i, line->elevation_q14 + i);
        }
    }
    make_noise(sampling, path, cells, line->noise);
}

void lm_scan_line_prefetch(struct lm_tile_cache *tiles, const struct lm_sampling *sampling,
                           const struct lm_ground_path *path, uint32_t cells)
{
    struct walk walk = walk_of(path, (uint32_t)tiles->db->shift0 + sampling->level, cells);
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
    struct walk walk = walk_of(&path, (uint32_t)tiles->db->shift0 + level, 1);
    const struct run run = next_run(&walk, 1);
    const struct lm_tile *tile = lm_tile_cache_get(tiles, level, run.row, run.column);
    if (!tile) {
        return otherwise_q10;
    }
    uint32_t cell[LM_LANES];
    int32_t elevation_q14[LM_LANES];
    read_run(&run, tile, level, cell, elevation_q14);
    return elevation_q14[0] >> 4;
}
