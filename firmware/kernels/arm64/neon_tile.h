/* The points of tiles around eight places, by the vectors of 64-bit Arm: shared by tile_read.c and
 * tile_blend.c. */
#ifndef NEON_TILE_H
#define NEON_TILE_H

#include <arm_neon.h>
#include <stdint.h>

#include "fx/mem.h"
#include "lm/tile_point.h"

/* Upper halves of the coordinates of eight places. They hold all that weights need. */
static inline uint16x8_t neon_halves(uint32x4_t low, uint32x4_t high)
{
    return vuzp2q_u16(vreinterpretq_u16_u32(low), vreinterpretq_u16_u32(high));
}

/* Weights of eight places: bits 25..18 of each. */
static inline uint8x8_t neon_weights(uint16x8_t halves)
{
    return vshrn_n_u16(halves, 2);
}

/* Store where the points of eight places are, in bytes from the pool's first record. Those of a
 * record take 16 bits. */
static inline void neon_store_offsets(uint32_t *offset, uint32x4x2_t record, uint16x8_t row,
                                      uint16x8_t column)
{
    const uint16x8_t at = vshlq_n_u16(vmlaq_n_u16(column, row, LM_TILE_POINTS), 2);
    vst1q_u32(offset, vaddw_u16(record.val[0], vget_low_u16(at)));
    vst1q_u32(offset + 4, vaddw_high_u16(record.val[1], at));
}

struct neon_source {
    const uint8_t *south, *north; /* the first record's own points: southernmost row, the next */
};

/* The compiler must not see that the two are a constant apart: it would add it for each place
 * instead of keeping two registers. */
static inline struct neon_source neon_source_of(const struct lm_tile_point *points)
{
    struct neon_source s = {(const uint8_t *)points, (const uint8_t *)(points + LM_TILE_POINTS)};
    __asm__("" : "+r"(s.south), "+r"(s.north));
    return s;
}

/* Two points side by side, as the vectors will load them: any type may follow. */
typedef uint64_t neon_pair __attribute__((may_alias));

/* The western and eastern points of each of four places, to the south and to the north. All is
 * loaded first: a store might change what is loaded, for all that the compiler knows. */
static inline void neon_fetch(const struct neon_source *s, const uint32_t *offset, neon_pair *south,
                              neon_pair *north)
{
    const uint32_t o0 = offset[0], o1 = offset[1], o2 = offset[2], o3 = offset[3];
    const uint64_t s0 = fx_load_u64(s->south + o0), n0 = fx_load_u64(s->north + o0);
    const uint64_t s1 = fx_load_u64(s->south + o1), n1 = fx_load_u64(s->north + o1);
    const uint64_t s2 = fx_load_u64(s->south + o2), n2 = fx_load_u64(s->north + o2);
    const uint64_t s3 = fx_load_u64(s->south + o3), n3 = fx_load_u64(s->north + o3);
    south[0] = s0;
    south[1] = s1;
    south[2] = s2;
    south[3] = s3;
    north[0] = n0;
    north[1] = n1;
    north[2] = n2;
    north[3] = n3;
}

/* Posts of eight places: south-west, south-east, north-west, north-east. */
struct neon_posts {
    uint16x8_t sw, se, nw, ne;
};

/* Four posts: sw is 2^16 of the result, less what the other three have of it. */
static inline uint32x4_t neon_bilerp_4(uint16x4_t sw, uint16x4_t se, uint16x4_t nw, uint16x4_t ne,
                                       uint16x4_t away, uint16x4_t to_se, uint16x4_t to_nw,
                                       uint16x4_t to_ne)
{
    const uint32x4_t south = vmlal_u16(vshll_n_u16(sw, 16), se, to_se);
    return vmlsl_u16(vmlal_u16(vmlal_u16(south, nw, to_nw), ne, to_ne), sw, away);
}

/* fx_bilerp_u16_q16 of eight places, by the weights of their four posts. That of sw, 2^16 where
 * both others are 0, would not fit in 16 bits; what it lacks does: 65535 at most, 2^16 - 1 * 1.
 * Weights are below 256, and a product of two of them below 2^16. The sum is modulo 2^32 on its
 * way, and at most 65535 * 2^16. */
static inline uint32x4x2_t neon_bilerp(const struct neon_posts *p, uint8x8_t east, uint8x8_t north)
{
    const uint16x8_t both = vmull_u8(east, north), north_q16 = vshll_n_u8(north, 8);
    const uint16x8_t to_se = vsubq_u16(vshll_n_u8(east, 8), both);
    const uint16x8_t to_nw = vsubq_u16(north_q16, both), away = vaddq_u16(to_se, north_q16);
    const uint32x4_t low = neon_bilerp_4(
        vget_low_u16(p->sw), vget_low_u16(p->se), vget_low_u16(p->nw), vget_low_u16(p->ne),
        vget_low_u16(away), vget_low_u16(to_se), vget_low_u16(to_nw), vget_low_u16(both));
    uint32x4_t high = vmlal_high_u16(vshll_high_n_u16(p->sw, 16), p->se, to_se);
    __asm__("" : "+w"(high)); /* gcc 12 would move it to another register */
    high = vmlal_high_u16(vmlal_high_u16(high, p->nw, to_nw), p->ne, both);
    return (uint32x4x2_t){{low, vmlsl_high_u16(high, p->sw, away)}};
}

/* Base plus post, as lm_k_tile_sample takes them from a scale: Arm shifts by what the lowest byte
 * says. */
static inline uint32x4_t neon_elevation(uint32x4_t scale, uint32x4_t post_q16)
{
    return vaddq_u32(scale, vshlq_u32(post_q16, vreinterpretq_s32_u32(scale)));
}

#endif
