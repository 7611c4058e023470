#include "lm/scan_line.h"

#include "fx/bits.h"
#include "lm/tile_read.h"

/* One coordinate of a line, cell k being at `at + k (step + k half_bend)`. The unit is 2^-32 of a
 * tile's side, so that the upper half is the tile's row or column and the lower half the place in
 * it. */
struct way {
    uint64_t at, step, half_bend;
};

/* One coordinate of a walk along a line. */
struct axis {
    struct way way;
    uint64_t fastest;   /* every step of the line is shorter */
    uint32_t direction; /* all ones where none goes back */
    bool turns;         /* some go back and some do not */
    uint32_t tile;      /* row or column where the walk stands */
    uint32_t end;       /* the first cell that may lie in the next one */
};

/* The way of a line through the tiles of one level. A run is a stretch of cells in one tile. */
struct walk {
    struct lm_ground_path middle; /* the line's, from its middle on */
    struct axis north, east;
    uint32_t cells;
    uint32_t side_log2; /* of a tile, in BAM of latitude */
    uint32_t zone;      /* of the row; UINT32_MAX before the first */
};

uint8_t lm_scan_level(const struct lm_db *db, uint32_t cell_mm)
{
    uint8_t level = 0;
    while (level + 1 < db->level_count && lm_db_cell_mm(db, (uint8_t)(level + 1)) <= cell_mm) {
        level++;
    }
    return level;
}

static uint64_t magnitude(uint64_t x)
{
    return x >> 63 ? 0 - x : x;
}

static inline uint64_t way_at(const struct way *w, uint32_t k)
{
    return w->at + k * (w->step + k * w->half_bend);
}

/* A way by where it is at cell k and how fast it goes there. */
static inline struct way way_through(uint32_t k, uint64_t at, uint64_t slope, uint64_t half_bend)
{
    return (struct way){at - k * (slope - k * half_bend), slope - 2 * k * half_bend, half_bend};
}

/* From the path's 2^-32 BAM at cell k. The angle itself is unsigned, its differences are not.
 * Everything is modulo 2^64, so that no path can do more harm than lead astray. Half a unit of the
 * bend moves the ends of the longest line by 528^2 / 8 units, which is 2^-11 of a cell. */
static struct way way_of(uint32_t k, uint64_t value, uint64_t step, uint64_t bend,
                         uint32_t side_log2)
{
    const uint64_t half = (uint64_t)1 << side_log2;
    return way_through(k, value >> side_log2,
                       (uint64_t)((int64_t)(step - (uint64_t)((int64_t)bend >> 1)) >> side_log2),
                       (uint64_t)((int64_t)(bend + half) >> side_log2 >> 1));
}

/* Stand nowhere yet: the first tile is entered at cell k. Steps grow or shrink all the way: the
 * first and the last tell how fast they are and where they go. */
static void start_axis(struct axis *a, struct way way, uint32_t cells, uint32_t k)
{
    const uint64_t first = way.step + way.half_bend;
    const uint64_t last = way.step + (2 * cells - 1) * way.half_bend;
    const uint64_t fast = magnitude(first), fast_at_last = magnitude(last);
    a->way = way;
    a->fastest = (fast > fast_at_last ? fast : fast_at_last) + 1;
    a->direction = first >> 63 ? 0 : UINT32_MAX;
    a->turns = (first ^ last) >> 63;
    a->end = k;
}

static void start_walk(struct walk *w, const struct lm_db *db, uint8_t level,
                       const struct lm_ground_path *path, uint32_t cells)
{
    struct lm_ground_path *p = &w->middle;
    w->cells = cells;
    w->side_log2 = (uint32_t)db->shift0 + level + LM_TILE_CELLS_LOG2;
    w->zone = UINT32_MAX;
    w->east.end = 0;
    *p = *path;
    lm_ground_path_skip(p, (int32_t)(cells / 2));
    const uint64_t from_pole = p->latitude + ((uint64_t)FX_BAM_90 << 32);
    start_axis(&w->north,
               way_of(cells / 2, from_pole, p->latitude_step, p->latitude_bend, w->side_log2),
               cells, 0);
}

/* Where cell k is, and how many from there on surely lie in the same tile: the way to the border
 * that the axis heads for, or to the nearer one if it turns round, at the fastest that it goes. The
 * border may turn out to be one cell farther, which then is a run of its own. */
static inline void enter(struct axis *a, uint32_t k)
{
    const uint64_t at = way_at(&a->way, k);
    uint32_t room = (uint32_t)at ^ a->direction;
    if (a->turns && ~room < room) {
        room = ~room;
    }
    a->tile = (uint32_t)(at >> 32);
    a->end = k + 1;
    if (a->fastest <= room) {
        const uint32_t more = room / (uint32_t)a->fastest;
        a->end += more < LM_CELLS_MAX ? more : LM_CELLS_MAX;
    }
}

/* Of the tile where the walk stands. */
static inline fx_bam_t south_edge(const struct walk *w)
{
    return (w->north.tile << w->side_log2) - FX_BAM_90;
}

static void enter_row(struct walk *w, uint32_t k)
{
    enter(&w->north, k);
    /* Borders of zones are borders of tiles: the tile's own south edge tells its zone. */
    const uint32_t zone = lm_db_zone(south_edge(w));
    if (zone != w->zone) {
        const struct lm_ground_path *p = &w->middle;
        w->zone = zone;
        start_axis(&w->east,
                   way_of(w->cells / 2, p->longitude, p->longitude_step, p->longitude_bend,
                          w->side_log2 + zone),
                   w->cells, k);
    }
}

static void enter_column(struct walk *w, uint32_t k)
{
    enter(&w->east, k);
    const uint32_t side_log2 = w->side_log2 + w->zone;
    w->east.tile = w->east.tile << side_log2 >> side_log2; /* the whole turns are gone */
}

/* The end of the run that begins with cell k, where the walk now stands. */
static inline uint32_t next_run(struct walk *w, uint32_t k)
{
    if (k == w->north.end) {
        enter_row(w, k);
    }
    if (k == w->east.end) {
        enter_column(w, k);
    }
    const uint32_t end = w->north.end < w->east.end ? w->north.end : w->east.end;
    return end < w->cells ? end : w->cells;
}

/* A way in the tiles of an ancestor so many generations up, exact at cell k. Elsewhere in a run
 * about that cell, 264 cells off at the most, it is within 264^2 / 2 + 264 units of 2^-32 of the
 * ancestor's side: 2^-10 of one of its cells. */
static struct lm_track track_of(const struct way *w, uint32_t k, uint32_t generations)
{
    const uint64_t half = (uint64_t)1 << generations >> 1;
    const struct way up =
        way_through(k, way_at(w, k) >> generations,
                    (uint64_t)((int64_t)(w->step + 2 * k * w->half_bend) >> generations),
                    (uint64_t)((int64_t)(w->half_bend + half) >> generations));
    return (struct lm_track){(uint32_t)up.at, (uint32_t)up.step, (uint32_t)up.half_bend};
}

static struct lm_places places_of(const struct walk *w, uint32_t k, uint32_t generations)
{
    return (struct lm_places){
        .north = track_of(&w->north.way, k, generations),
        .east = track_of(&w->east.way, k, generations),
    };
}

static void read_nothing(uint32_t first, uint32_t end, struct lm_scan_line *restrict line)
{
    for (uint32_t k = first; k < end; k++) {
        line->cell[k] = LM_CELL_NONE;
        line->elevation_q14[k] = 0;
    }
}

void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles, uint8_t level,
                      const struct lm_ground_path *path, uint32_t cells)
{
    const struct lm_tile *pool = tiles->pool;
    struct walk w;
    struct lm_places places = {0};
    start_walk(&w, tiles->db, level, path, cells);
    uint32_t zone = w.zone, generations = 0; /* of the places */
    uint32_t waiting = 0;                    /* the first cell that is laid and not read */
    for (uint32_t k = 0, end; k < cells; k = end) {
        end = next_run(&w, k);
        const struct lm_tile *tile = lm_tile_cache_get(tiles, level, w.north.tile, w.east.tile);
        const uint32_t up = tile ? tile->level - (uint32_t)level : 0;
        /* The ways in an ancestor are good for one run. */
        if (w.zone != zone || up != generations || up != 0) {
            lm_tile_read(pool, &places, waiting, k, line);
            places = places_of(&w, (k + end) / 2, up);
            zone = w.zone;
            generations = up;
            waiting = k;
        }
        if (tile) {
            lm_tile_lay(pool, tile, k, end, line);
        } else {
            lm_tile_read(pool, &places, waiting, k, line);
            read_nothing(k, end, line);
            waiting = end;
        }
    }
    lm_tile_read(pool, &places, waiting, cells, line);
}

void lm_scan_line_prefetch(struct lm_tile_cache *tiles, uint8_t level,
                           const struct lm_ground_path *path, uint32_t cells)
{
    struct walk w;
    start_walk(&w, tiles->db, level, path, cells);
    for (uint32_t k = 0; k < cells;) {
        k = next_run(&w, k);
        lm_tile_cache_want(tiles, level, w.north.tile, w.east.tile);
    }
}

int32_t lm_scan_elevation(struct lm_tile_cache *tiles, uint8_t level, struct lm_place place,
                          int32_t otherwise_q10)
{
    const struct lm_ground_path path = {.latitude = (uint64_t)place.latitude << 32,
                                        .longitude = (uint64_t)place.longitude << 32};
    struct walk w;
    start_walk(&w, tiles->db, level, &path, 1);
    next_run(&w, 0);
    const struct lm_tile *tile = lm_tile_cache_get(tiles, level, w.north.tile, w.east.tile);
    if (!tile) {
        return otherwise_q10;
    }
    const uint32_t generations = tile->level - (uint32_t)level;
    return lm_tile_ground(tile, (uint32_t)(w.north.way.at >> generations),
                          (uint32_t)(w.east.way.at >> generations))
               .elevation_q14 >>
           4;
}
