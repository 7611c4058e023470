#include <arm_neon.h>

#include "lm/kernels_map.h"
#include "lm/lanes.h"
#include "neon_tile.h"
#include "neon_track.h"

/* Eight places at a time. Arm has no gather: only the points of the tiles are fetched one by one.
 */

void lm_k_tile_read(const struct lm_tile_point *points, const struct lm_tile_coords *places,
                    uint32_t first, uint32_t groups, uint32_t *cell_of_line,
                    int32_t *elevation_m_q14)
{
    const struct neon_source source = neon_source_of(points);
    struct neon_track north_track = neon_track_from(&places->north, first);
    struct neon_track east_track = neon_track_from(&places->east, first);
    uint32_t *cell = cell_of_line + first;
    uint32_t *elevation = (uint32_t *)elevation_m_q14 + first;
    for (const uint32_t *const end = cell + groups * LM_LANES; cell != end; cell += LM_LANES) {
        uint32_t offset[LM_LANES];
        neon_pair south[LM_LANES], north[LM_LANES];
        const uint32x4_t n[2] = {neon_next(&north_track), neon_next(&north_track)};
        const uint32x4_t e[2] = {neon_next(&east_track), neon_next(&east_track)};
        vst1q_u32(offset, neon_offsets(vld1q_u32(cell), n[0], e[0]));
        vst1q_u32(offset + 4, neon_offsets(vld1q_u32(cell + 4), n[1], e[1]));
        /* In memory, from where two numbers come at a time; the compiler would move one by one. */
        __asm__("" : "+m"(offset));
        neon_fetch(&source, offset, south, north);
        neon_fetch(&source, offset + 4, south + 4, north + 4);
        /* Cell and post of the western point, cell and post of the eastern one. */
        const uint16x8x4_t s = vld4q_u16((const uint16_t *)south);
        const uint16x8x4_t f = vld4q_u16((const uint16_t *)north);
        const struct neon_posts posts = {s.val[1], s.val[3], f.val[1], f.val[3]};
        const uint32x4x2_t post_q16 = neon_bilerp(&posts, neon_weights(neon_halves(e[0], e[1])),
                                                  neon_weights(neon_halves(n[0], n[1])));
        vst1q_u32(cell, vmovl_u16(vget_low_u16(s.val[0])));
        vst1q_u32(cell + 4, vmovl_high_u16(s.val[0]));
        for (int half = 0; half < 2; half++) {
            vst1q_u32(elevation, neon_elevation(vld1q_u32(elevation), post_q16.val[half]));
            elevation += 4;
        }
    }
}
