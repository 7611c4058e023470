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
static inline uint16x8_t neon_weights(uint16x8_t halves)
{
    return vshrq_n_u16(vshlq_n_u16(halves, 6), 8);
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

/* fx_bilerp_u16_q16 of eight places. */
static inline uint32x4x2_t neon_bilerp(const struct neon_posts *p, uint16x8_t east,
                                       uint16x8_t north)
{
    const uint16x8_t west = vsubq_u16(vdupq_n_u16(256), east);
    const uint32x4_t south_low = vmlal_u16(vmull_u16(vget_low_u16(p->sw), vget_low_u16(west)),
                                           vget_low_u16(p->se), vget_low_u16(east));
    const uint32x4_t north_low = vmlal_u16(vmull_u16(vget_low_u16(p->nw), vget_low_u16(west)),
                                           vget_low_u16(p->ne), vget_low_u16(east));
    const uint32x4_t south_high = vmlal_high_u16(vmull_high_u16(p->sw, west), p->se, east);
    const uint32x4_t north_high = vmlal_high_u16(vmull_high_u16(p->nw, west), p->ne, east);
    return (uint32x4x2_t){{
        vmlaq_u32(vshlq_n_u32(south_low, 8), vsubq_u32(north_low, south_low),
                  vmovl_u16(vget_low_u16(north))),
        vmlaq_u32(vshlq_n_u32(south_high, 8), vsubq_u32(north_high, south_high),
                  vmovl_high_u16(north)),
    }};
}

/* Base plus post, as lm_k_tile_sample takes them from a scale: Arm shifts by what the lowest byte
 * says. */
static inline uint32x4_t neon_elevation(uint32x4_t scale, uint32x4_t post_q16)
{
    return vaddq_u32(scale, vshlq_u32(post_q16, vreinterpretq_s32_u32(scale)));
}

#endif
