#include "lm/tile_read.h"

#include "fx/lerp.h"
#include "fx/mem.h"
#include "tile_read_neon.h"

/* What a place in a tile gives. Words hold two numbers of the tile side by side, the western one in
 * the low half: lm/db.h on the order of bytes. */
struct ground {
    uint32_t cell;
    int32_t elevation_q14;
};

/* Indices are signed: then a loop of this becomes vector gathers. */
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
                          (uint16_t)(north >> 16), east_q26 << 6 >> 24, north_q26 << 6 >> 24);
    /* A post step is 2^post_shift / 64 m, so the interpolated code's Q16 is Q22 of 2^post_shift m.
     * lm_tile_check holds |base| to 2^20 and post_shift to 4: below 2^29. */
    return (struct ground){.cell = fx_load_u32(cells + (post - row)) & 0xFFFF,
                           .elevation_q14 = (int32_t)((uint32_t)tile->base_q6 * 256u +
                                                      (post_q16 >> (8 - tile->post_shift)))};
}

/* Whole groups: a vector of cells has no rest. No store touches the tile: it may gather. */
void lm_tile_read(const struct lm_tile *restrict tile, const struct lm_track *north,
                  const struct lm_track *east, uint32_t count, uint32_t *restrict cell,
                  int32_t *restrict elevation_q14)
{
    const uint32_t groups = (count + LM_LANES - 1) / LM_LANES;
    const struct lm_track n = *north, e = *east;
    if (FX_HAS_NEON) {
        read_groups_neon(tile, &n, &e, groups, cell, elevation_q14);
        return;
    }
    for (uint32_t k = 0; k < groups * LM_LANES; k++) {
        const struct ground g = read_ground(tile, lm_track_at(&n, k), lm_track_at(&e, k));
        cell[k] = g.cell;
        elevation_q14[k] = g.elevation_q14;
    }
}
