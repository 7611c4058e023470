/* The noise of a line: what it is made of, and how the vectors of 64-bit Arm make it, with the same
 * results as scan_line.c's loop. */
#ifndef NOISE_NEON_H
#define NOISE_NEON_H

#include "fx/hash.h"
#include "lm/scan_line.h"
#include "track_neon.h"

enum { NOISE_BITS = 19 }; /* of a noise cell's fraction */

/* A line's noise cells from that of its middle, in units of 2^-NOISE_BITS, and what the hash adds
 * up: for the middle, and for each row and column more. */
struct noise {
    struct lm_track north, east;
    uint32_t sum, row, column;
};

#if FX_HAS_NEON

static inline uint32x4_t neon_noise(const struct noise *n, struct neon_track *north,
                                    struct neon_track *east)
{
    const int32x4_t rows = vshrq_n_s32(vreinterpretq_s32_u32(neon_next(north)), NOISE_BITS);
    const int32x4_t columns = vshrq_n_s32(vreinterpretq_s32_u32(neon_next(east)), NOISE_BITS);
    uint32x4_t x = vdupq_n_u32(n->sum);
    x = vmlaq_n_u32(x, vreinterpretq_u32_s32(rows), n->row);
    x = vmlaq_n_u32(x, vreinterpretq_u32_s32(columns), n->column);
    x = vmulq_n_u32(veorq_u32(x, vshrq_n_u32(x, 16)), FX_HASH_FIRST);
    return vmulq_n_u32(veorq_u32(x, vshrq_n_u32(x, 15)), FX_HASH_SECOND);
}

/* Whole groups of LM_LANES, for which there is room. */
static inline void hash_line_neon(const struct noise *n, uint32_t cells, uint32_t *noise)
{
    struct neon_track north = neon_track_of(&n->north), east = neon_track_of(&n->east);
    for (uint32_t *const end = noise + cells; noise < end; noise += LM_LANES) {
        uint32x4x2_t hashes;
        hashes.val[0] = neon_noise(n, &north, &east);
        hashes.val[1] = neon_noise(n, &north, &east);
        vst1q_u32_x2(noise, hashes);
    }
}

#else

static inline void hash_line_neon(const struct noise *n, uint32_t cells, uint32_t *noise)
{
    (void)n, (void)cells, (void)noise;
}

#endif
#endif
