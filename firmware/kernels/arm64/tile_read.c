#include <arm_neon.h>

#include "lm/kernels_map.h"
#include "lm/lanes.h"
#include "neon_tile.h"
#include "neon_track.h"

/* Eight places at a time. Arm has no gather: only the points of the tiles are fetched one by one.
 */

/* What a turn fetches: one pointer reaches all of it. */
struct scratch {
    uint32_t offset[LM_LANES];
    neon_pair south[LM_LANES], north[LM_LANES];
};

void lm_k_tile_read(const struct lm_tile_point *points, const struct lm_tile_coords *places,
                    uint32_t first, uint32_t groups, uint32_t *cell_of_line,
                    int32_t *elevation_m_q14)
{
    const struct neon_source source = neon_source_of(points);
    struct neon_track north_track = neon_track_from(&places->north, first);
    struct neon_track east_track = neon_track_from(&places->east, first);
    uint32_t *cell = cell_of_line + first;
    uint32_t *elevation = (uint32_t *)elevation_m_q14 + first;
    struct scratch room, *scratch = &room;
    __asm__("" : "+r"(scratch));
    for (const uint32_t *const end = cell + groups * LM_LANES; cell != end; cell += LM_LANES) {
        const uint32x4_t n0 = neon_next(&north_track), n1 = neon_next(&north_track);
        const uint32x4_t e0 = neon_next(&east_track), e1 = neon_next(&east_track);
        const uint16x8_t n = neon_halves(n0, n1), e = neon_halves(e0, e1);
        const uint32x4x2_t record = {{vld1q_u32(cell), vld1q_u32(cell + 4)}};
        neon_store_offsets(scratch->offset, record, vshrq_n_u16(n, 10), vshrq_n_u16(e, 10));
        /* In memory, from where two numbers come at a time; the compiler would move one by one. */
        __asm__("" : "+m"(*scratch));
        neon_fetch(&source, scratch->offset, scratch->south, scratch->north);
        neon_fetch(&source, scratch->offset + 4, scratch->south + 4, scratch->north + 4);
        /* Cell and post of the western point, cell and post of the eastern one. */
        const uint16x8x4_t s = vld4q_u16((const uint16_t *)scratch->south);
        const uint16x8x4_t f = vld4q_u16((const uint16_t *)scratch->north);
        const struct neon_posts posts = {s.val[1], s.val[3], f.val[1], f.val[3]};
        const uint32x4x2_t post_q16 = neon_bilerp(&posts, neon_weights(e), neon_weights(n));
        vst1q_u32(cell, vmovl_u16(vget_low_u16(s.val[0])));
        vst1q_u32(cell + 4, vmovl_high_u16(s.val[0]));
        for (int half = 0; half < 2; half++) {
            vst1q_u32(elevation, neon_elevation(vld1q_u32(elevation), post_q16.val[half]));
            elevation += 4;
        }
    }
}
