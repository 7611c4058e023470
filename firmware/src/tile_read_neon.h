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

/* Where the numbers of four places are: south-western posts in bytes, and cells. */
static inline void neon_offsets(uint32x4_t record, uint32x4_t north, uint32x4_t east,
                                uint32_t *post, uint32_t *which)
{
    const uint32x4_t row = vshrq_n_u32(north, 26);
    const uint32x4_t across = vsraq_n_u32(record, east, 26);
    vst1q_u32(post, vmlaq_n_u32(vaddq_u32(across, across), row, 2 * LM_TILE_POSTS));
    vst1q_u32(which, vmlaq_n_u32(across, row, LM_TILE_CELLS));
}

struct neon_source {
    const uint8_t *south, *north; /* the first record's post in the southernmost row, in the next */
    const uint16_t *cells;
};

/* The compiler must not see that the three are a constant apart: it would add it for each place
 * instead of keeping three registers. */
static inline struct neon_source neon_source_of(const struct lm_tile *pool)
{
    struct neon_source s = {(const uint8_t *)pool->posts[0], (const uint8_t *)pool->posts[1],
                            pool->cells[0]};
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

/* lm_place_noise of four places. */
static inline uint32x4_t neon_noise(const struct lm_places *p, uint32x4_t sum, uint32x4_t north,
                                    uint32x4_t east)
{
    const uint32x4_t row = vshlq_u32(north, vdupq_n_s32(-(int32_t)p->north_shift));
    const uint32x4_t column = vshlq_u32(east, vdupq_n_s32(-(int32_t)p->east_shift));
    uint32x4_t x = vmlaq_n_u32(sum, row, fx_hash3_sum(1, 0, 0));
    x = vmlaq_n_u32(x, column, fx_hash3_sum(0, 1, 0));
    x = vmulq_n_u32(veorq_u32(x, vshrq_n_u32(x, 16)), FX_HASH_FIRST);
    return vmulq_n_u32(veorq_u32(x, vshrq_n_u32(x, 15)), FX_HASH_SECOND);
}

/* Base plus post, as ground_at takes them from a scale: Arm shifts by what the lowest byte says. */
static inline uint32x4_t neon_elevation(uint32x4_t scale, uint32x4_t post_q16)
{
    return vaddq_u32(scale, vshlq_u32(post_q16, vreinterpretq_s32_u32(scale)));
}

static inline void read_groups_neon(const struct lm_tile *pool, const struct lm_places *places,
                                    uint32_t first, uint32_t groups, struct lm_scan_line *line)
{
    const struct neon_source source = neon_source_of(pool);
    struct neon_track north_track = neon_track_from(&places->north, first);
    struct neon_track east_track = neon_track_from(&places->east, first);
    uint32_t *noise = line->noise + first, *cell = line->cell + first;
    uint32_t *elevation = (uint32_t *)line->elevation_q14 + first;
    for (const uint32_t *const end = cell + groups * LM_LANES; cell != end; cell += LM_LANES) {
        uint32_t post[LM_LANES], which[LM_LANES];
        neon_word corner[2 * LM_LANES];
        uint32x4_t n[2], e[2];
        for (int half = 0; half < 2; half++) {
            n[half] = neon_next(&north_track);
            e[half] = neon_next(&east_track);
            neon_offsets(vld1q_u32(cell + 4 * half), n[half], e[half], post + 4 * half,
                         which + 4 * half);
        }
        neon_fetch(&source, post, which, corner, cell);
        neon_fetch(&source, post + 4, which + 4, corner + LM_LANES, cell + 4);
        const uint32x4x2_t post_q16 =
            neon_bilerp(vld4q_u16((const uint16_t *)corner), neon_weights(e[0], e[1]),
                        neon_weights(n[0], n[1]));
        for (int half = 0; half < 2; half++) {
            vst1q_u32(noise, neon_noise(places, vld1q_u32(noise), n[half], e[half]));
            vst1q_u32(elevation, neon_elevation(vld1q_u32(elevation), post_q16.val[half]));
            noise += 4;
            elevation += 4;
        }
    }
}

#else

static inline void read_groups_neon(const struct lm_tile *pool, const struct lm_places *places,
                                    uint32_t first, uint32_t groups, struct lm_scan_line *line)
{
    (void)pool, (void)places, (void)first, (void)groups, (void)line;
}

#endif
#endif
