/* What a tile says, by the vectors of 64-bit Arm: eight places at a time. Only the numbers of the
 * tile are fetched one by one, Arm having no gather; what tile_read.c makes of them is the same to
 * the bit. Not for other machines, where it is never called. */
#ifndef TILE_READ_NEON_H
#define TILE_READ_NEON_H

#include "fx/mem.h"
#include "lm/tile_read.h"
#include "track_neon.h"

#if FX_HAS_NEON

/* Weights of eight places: bits 25..18 of each. */
static inline uint16x8_t neon_weights(uint32x4_t low, uint32x4_t high)
{
    const uint16x8_t upper = vuzp2q_u16(vreinterpretq_u16_u32(low), vreinterpretq_u16_u32(high));
    return vshrq_n_u16(vshlq_n_u16(upper, 6), 8);
}

/* Where the numbers of eight places are: south-western posts in bytes, behind them cells. */
static inline void neon_offsets(const uint32x4_t north[2], const uint32x4_t east[2],
                                uint32_t offset[2 * LM_LANES])
{
    uint32x4x4_t at;
    for (int half = 0; half < 2; half++) {
        const uint32x4_t row = vshrq_n_u32(north[half], 26), column = vshrq_n_u32(east[half], 26);
        at.val[half] = vmlaq_n_u32(vaddq_u32(column, column), row, 2 * LM_TILE_POSTS);
        at.val[2 + half] = vsliq_n_u32(column, row, LM_TILE_CELLS_LOG2);
    }
    vst1q_u32_x4(offset, at);
}

struct neon_source {
    const uint8_t *south, *north; /* first post of the southernmost row, and of the next one */
    const uint16_t *cells;
};

/* The compiler must not see that the three are a constant apart: it would add it for each place
 * instead of keeping three registers. */
static inline struct neon_source neon_source_of(const struct lm_tile *tile)
{
    struct neon_source s = {(const uint8_t *)tile->posts[0], (const uint8_t *)tile->posts[1],
                            tile->cells[0]};
    __asm__("" : "+r"(s.south), "+r"(s.north), "+r"(s.cells));
    return s;
}

/* Words as the vectors will load them: any type may follow. */
typedef uint32_t neon_word __attribute__((may_alias));

/* The four posts around each of four places, and their cells. All is loaded first: a store might
 * change what is loaded, for all that the compiler knows. */
static inline void neon_fetch(const struct neon_source *s, const uint32_t *post,
                              const uint32_t *which, neon_word *corner, uint32_t *cell)
{
    const uint32_t p0 = post[0], p1 = post[1], p2 = post[2], p3 = post[3];
    const uint32_t c0 = s->cells[which[0]], c1 = s->cells[which[1]];
    const uint32_t c2 = s->cells[which[2]], c3 = s->cells[which[3]];
    const uint32_t south0 = fx_load_u32(s->south + p0), north0 = fx_load_u32(s->north + p0);
    const uint32_t south1 = fx_load_u32(s->south + p1), north1 = fx_load_u32(s->north + p1);
    const uint32_t south2 = fx_load_u32(s->south + p2), north2 = fx_load_u32(s->north + p2);
    const uint32_t south3 = fx_load_u32(s->south + p3), north3 = fx_load_u32(s->north + p3);
    corner[0] = south0;
    corner[1] = north0;
    corner[2] = south1;
    corner[3] = north1;
    corner[4] = south2;
    corner[5] = north2;
    corner[6] = south3;
    corner[7] = north3;
    cell[0] = c0;
    cell[1] = c1;
    cell[2] = c2;
    cell[3] = c3;
}

/* fx_bilerp_u16_q16 of eight places from their posts: south-west, south-east, north-west,
 * north-east. */
static inline uint32x4x2_t neon_bilerp(uint16x8x4_t post, uint16x8_t east, uint16x8_t north)
{
    const uint16x8_t west = vsubq_u16(vdupq_n_u16(256), east);
    const uint32x4_t south_low = vmlal_u16(vmull_u16(vget_low_u16(post.val[0]), vget_low_u16(west)),
                                           vget_low_u16(post.val[1]), vget_low_u16(east));
    const uint32x4_t north_low = vmlal_u16(vmull_u16(vget_low_u16(post.val[2]), vget_low_u16(west)),
                                           vget_low_u16(post.val[3]), vget_low_u16(east));
    const uint32x4_t south_high =
        vmlal_high_u16(vmull_high_u16(post.val[0], west), post.val[1], east);
    const uint32x4_t north_high =
        vmlal_high_u16(vmull_high_u16(post.val[2], west), post.val[3], east);
    return (uint32x4x2_t){{
        vmlaq_u32(vshlq_n_u32(south_low, 8), vsubq_u32(north_low, south_low),
                  vmovl_u16(vget_low_u16(north))),
        vmlaq_u32(vshlq_n_u32(south_high, 8), vsubq_u32(north_high, south_high),
                  vmovl_high_u16(north)),
    }};
}

static inline void read_groups_neon(const struct lm_tile *tile, const struct lm_track *north,
                                    const struct lm_track *east, uint32_t groups,
                                    uint32_t *restrict cell, int32_t *restrict elevation_q14)
{
    const int32x4_t shift = vdupq_n_s32(tile->post_shift - 8);
    const uint32x4_t base_q14 = vdupq_n_u32((uint32_t)tile->base_q6 * 256u);
    const struct neon_source source = neon_source_of(tile);
    struct neon_track north_track = neon_track_of(north), east_track = neon_track_of(east);
    for (const uint32_t *const end = cell + groups * LM_LANES; cell != end; cell += LM_LANES) {
        uint32_t offset[2 * LM_LANES];
        neon_word corner[2 * LM_LANES];
        const uint32x4_t n[2] = {neon_next(&north_track), neon_next(&north_track)};
        const uint32x4_t e[2] = {neon_next(&east_track), neon_next(&east_track)};
        neon_offsets(n, e, offset);
        neon_fetch(&source, offset, offset + LM_LANES, corner, cell);
        neon_fetch(&source, offset + 4, offset + LM_LANES + 4, corner + LM_LANES, cell + 4);
        uint32x4x2_t q14 = neon_bilerp(vld4q_u16((const uint16_t *)corner),
                                       neon_weights(e[0], e[1]), neon_weights(n[0], n[1]));
        q14.val[0] = vaddq_u32(base_q14, vshlq_u32(q14.val[0], shift));
        q14.val[1] = vaddq_u32(base_q14, vshlq_u32(q14.val[1], shift));
        vst1q_u32_x2((uint32_t *)elevation_q14, q14);
        elevation_q14 += LM_LANES;
    }
}

#else

static inline void read_groups_neon(const struct lm_tile *tile, const struct lm_track *north,
                                    const struct lm_track *east, uint32_t groups,
                                    uint32_t *restrict cell, int32_t *restrict elevation_q14)
{
    (void)tile, (void)north, (void)east, (void)groups, (void)cell, (void)elevation_q14;
}

#endif
#endif
