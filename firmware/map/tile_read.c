#include "lm/tile_read.h"

#include "fx/lerp.h"
#include "fx/mem.h"
#include "tile_read_neon.h"

/* A point is taken as one word, its cell in the low half and its post in the high one: lm/db.h on
 * the order of bytes. Indices are signed: then a loop of this becomes vector gathers. */
static inline struct lm_ground ground_at(const struct lm_tile *pool, uint32_t record, int32_t scale,
                                         uint32_t north, uint32_t east)
{
    const struct lm_tile_point *points = pool->points[0];
    const int32_t row = (int32_t)(north >> 26), column = (int32_t)(east >> 26);
    const int32_t at = (int32_t)record + row * LM_TILE_POSTS + column;
    const uint32_t south_west = fx_load_u32(points + at), south_east = fx_load_u32(points + at + 1);
    const uint32_t north_west = fx_load_u32(points + at + LM_TILE_POSTS);
    const uint32_t north_east = fx_load_u32(points + at + LM_TILE_POSTS + 1);
    const uint32_t post_q16 = fx_bilerp_u16_q16(
        (uint16_t)(south_west >> 16), (uint16_t)(south_east >> 16), (uint16_t)(north_west >> 16),
        (uint16_t)(north_east >> 16), east << 6 >> 24, north << 6 >> 24);
    const uint32_t shift = (0u - (uint32_t)scale) & 0xFF;
    /* The post's part and the base are below 2^29. */
    return (struct lm_ground){.cell = south_west & 0xFFFF,
                              .elevation_q14 = scale + (int32_t)(post_q16 >> shift)};
}

struct lm_ground lm_tile_ground(const struct lm_tile *tile, uint32_t north, uint32_t east)
{
    return ground_at(tile, 0, lm_tile_base_of(tile, tile).scale, north, east);
}

/* Whole groups: a vector of cells has no rest. No store touches the pool: it may gather. */
void lm_tile_read(const struct lm_tile *restrict pool, const struct lm_places *places,
                  uint32_t first, uint32_t end, struct lm_scan_line *restrict line)
{
    const uint32_t groups = (end - first + LM_LANES - 1) / LM_LANES;
    const struct lm_places p = *places;
    uint32_t *const cell_behind = line->cell + end;
    int32_t *const elevation_behind = line->elevation_q14 + end;
    for (int lane = 0; lane < LM_LANES; lane++) {
        cell_behind[lane] = 0; /* not laid, perhaps: any record will do */
        elevation_behind[lane] = 0;
    }
    if (FX_HAS_NEON) {
        read_groups_neon(pool, &p, first, groups, line);
        return;
    }
    for (uint32_t k = first; k < first + groups * LM_LANES; k++) {
        const uint32_t north = lm_track_at(&p.north, k), east = lm_track_at(&p.east, k);
        const struct lm_ground g =
            ground_at(pool, line->cell[k], line->elevation_q14[k], north, east);
        line->cell[k] = g.cell;
        line->elevation_q14[k] = g.elevation_q14;
    }
}
