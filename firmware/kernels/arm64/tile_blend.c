#include <arm_neon.h>

#include "fx/mem.h"
#include "lm/kernels_clutter.h"
#include "lm/kernels_map.h"
#include "lm/lanes.h"
#include "neon_tile.h"
#include "neon_track.h"

/* Eight places at a time, in 16 bits where they suffice. Words and order are those of
 * c/tile_blend.c. */

/* share_of_weight of c/tile_blend.c. */
static const uint8_t share_of_weight[64] = {
    255, 255, 255, 255, 255, 255, 255, 255, 241, 216, 195, 178, 164, 152, 141, 132,
    124, 117, 111, 105, 100, 95,  91,  87,  84,  80,  77,  74,  72,  69,  67,  65,
    63,  61,  59,  58,  56,  55,  53,  52,  51,  49,  48,  47,  46,  45,  44,  43,
    42,  41,  41,  40,  39,  38,  38,  37,  36,  36,  35,  34,  34,  33,  33,  32,
};

/* The four cells around each of eight places: south-west, south-east, north-west, north-east. */
struct neon_corners {
    uint16x8_t cell[4];
    int16x8_t weight[4];
};

/* What has won: class, and the weight of its cells. */
struct neon_winner {
    int16x8_t kind, weight;
};

/* A coordinate half a cell further, in 2^-25 of a tile. */
static inline uint32x4_t neon_half_on(uint32x4_t at)
{
    return vsraq_n_u32(vdupq_n_u32(1u << 24), at, 1);
}

/* Bits 24..18 of eight coordinates. */
static inline int16x8_t neon_fractions(uint32x4_t low, uint32x4_t high)
{
    const uint16x8_t upper = vuzp2q_u16(vreinterpretq_u16_u32(low), vreinterpretq_u16_u32(high));
    return vreinterpretq_s16_u16(vshrq_n_u16(vshlq_n_u16(upper, 7), 9));
}

static inline int16x8_t neon_kinds(uint16x8_t cell)
{
    return vreinterpretq_s16_u16(vandq_u16(vshrq_n_u16(cell, 4), vdupq_n_u16(15)));
}

/* Where the south-western of the four cells is, in bytes from the record's first point. */
static inline uint32x4_t neon_corner_offsets(uint32x4_t record, uint32x4_t north_q25,
                                             uint32x4_t east_q25)
{
    const uint32x4_t across = vsraq_n_u32(record, east_q25, 25);
    return vshlq_n_u32(vmlaq_n_u32(across, vshrq_n_u32(north_q25, 25), LM_TILE_POINTS), 2);
}

static inline void neon_set_weights(struct neon_corners *c, int16x8_t u, int16x8_t v)
{
    c->weight[3] = vmulq_s16(u, v);
    c->weight[1] = vsubq_s16(vshlq_n_s16(u, 7), c->weight[3]);
    const int16x8_t of_north = vshlq_n_s16(v, 7);
    c->weight[2] = vsubq_s16(of_north, c->weight[3]);
    c->weight[0] = vsubq_s16(vsubq_s16(vdupq_n_s16(16384), of_north), c->weight[1]);
}

static inline int16x8_t neon_where(uint16x8_t mask, int16x8_t x)
{
    return vandq_s16(vreinterpretq_s16_u16(mask), x);
}

/* Bit 0: whether a mask of classes has each class. */
static inline uint16x8_t neon_bit_of(uint32_t mask, int16x8_t kind)
{
    return vshlq_u16(vdupq_n_u16((uint16_t)mask), vnegq_s16(kind));
}

/* What has grown at eight places: bends and crowns, bytes times 256. */
struct neon_grown {
    int16x8_t bend_q8, crown_q16;
};

/* Two texels side by side at each of eight places. */
static inline uint32x4x2_t neon_texels(const uint8_t *grown, const uint32_t *offset)
{
    uint32x4x2_t t = {{vdupq_n_u32(0), vdupq_n_u32(0)}};
    t.val[0] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[0]), t.val[0], 0);
    t.val[0] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[1]), t.val[0], 1);
    t.val[0] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[2]), t.val[0], 2);
    t.val[0] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[3]), t.val[0], 3);
    t.val[1] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[4]), t.val[1], 0);
    t.val[1] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[5]), t.val[1], 1);
    t.val[1] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[6]), t.val[1], 2);
    t.val[1] = vld1q_lane_u32((const uint32_t *)(const void *)(grown + offset[7]), t.val[1], 3);
    return t;
}

static inline uint16x8_t neon_even(uint32x4_t low, uint32x4_t high)
{
    return vuzp1q_u16(vreinterpretq_u16_u32(low), vreinterpretq_u16_u32(high));
}

static inline uint16x8_t neon_odd(uint32x4_t low, uint32x4_t high)
{
    return vuzp2q_u16(vreinterpretq_u16_u32(low), vreinterpretq_u16_u32(high));
}

/* Crowns between two texels, in sixteenths. */
static inline uint16x8_t neon_crowns(uint16x8_t west, uint16x8_t east, uint16x8_t u)
{
    return vmlaq_u16(vmulq_u16(vshrq_n_u16(west, 8), vsubq_u16(vdupq_n_u16(16), u)),
                     vshrq_n_u16(east, 8), u);
}

/* Bends between two texels, in sixteenths. */
static inline int16x8_t neon_bends(uint16x8_t west, uint16x8_t east, int16x8_t u)
{
    const int16x8_t at_west = vshrq_n_s16(vreinterpretq_s16_u16(vshlq_n_u16(west, 8)), 8);
    const int16x8_t at_east = vshrq_n_s16(vreinterpretq_s16_u16(vshlq_n_u16(east, 8)), 8);
    return vmlaq_s16(vmulq_s16(at_west, vsubq_s16(vdupq_n_s16(16), u)), at_east, u);
}

static inline struct neon_grown neon_grown_at(const struct lm_k_blend *map,
                                              const uint32x4_t north[2], const uint32x4_t east[2])
{
    const uint8_t *const grown = (const uint8_t *)map->grown;
    const int32x4_t down = vdupq_n_s32(4 - (int32_t)map->grown_shift);
    const uint32x4_t in_side = vdupq_n_u32(LM_K_GROWN_SIDE - 1);
    const uint16x8_t sixteenths = vdupq_n_u16(15);
    uint32x4_t north_q4[2], east_q4[2];
    uint32_t offset[LM_LANES];
    for (size_t h = 0; h < 2; h++) {
        north_q4[h] = vshlq_u32(north[h], down);
        east_q4[h] = vshlq_u32(east[h], down);
        const uint32x4_t row = vandq_u32(vshrq_n_u32(north_q4[h], 4), in_side);
        const uint32x4_t column = vandq_u32(vshrq_n_u32(east_q4[h], 4), in_side);
        const uint32x4_t at = vmlaq_n_u32(column, row, LM_K_GROWN_STRIDE);
        vst1q_u32(offset + 4 * h, vshlq_n_u32(at, 1));
    }
    __asm__("" : "+m"(offset));
    const uint32x4x2_t south = neon_texels(grown, offset);
    const uint32x4x2_t next = neon_texels(grown + 2 * LM_K_GROWN_STRIDE, offset);
    const uint16x8_t u = vandq_u16(neon_even(east_q4[0], east_q4[1]), sixteenths);
    const uint16x8_t v = vandq_u16(neon_even(north_q4[0], north_q4[1]), sixteenths);
    const uint16x8_t texel[4] = {
        neon_even(south.val[0], south.val[1]), neon_odd(south.val[0], south.val[1]),
        neon_even(next.val[0], next.val[1]), neon_odd(next.val[0], next.val[1])};
    const uint16x8_t v_left = vsubq_u16(vdupq_n_u16(16), v);
    const uint16x8_t crown = vmlaq_u16(vmulq_u16(neon_crowns(texel[0], texel[1], u), v_left),
                                       neon_crowns(texel[2], texel[3], u), v);
    const int16x8_t u_s16 = vreinterpretq_s16_u16(u);
    const int16x8_t bend =
        vmlaq_s16(vmulq_s16(neon_bends(texel[0], texel[1], u_s16), vreinterpretq_s16_u16(v_left)),
                  neon_bends(texel[2], texel[3], u_s16), vreinterpretq_s16_u16(v));
    return (struct neon_grown){bend, vreinterpretq_s16_u16(veorq_u16(crown, vdupq_n_u16(0x8000)))};
}

/* Let a class challenge the winner. */
static inline void neon_challenge(struct neon_winner *w, int16x8_t kind, int16x8_t weight,
                                  int16x8_t lean_q15, uint32_t natural)
{
    const uint16x8_t bits = vandq_u16(neon_bit_of(natural, kind), neon_bit_of(natural, w->kind));
    const uint16x8_t are_natural = vtstq_u16(bits, vdupq_n_u16(1));
    const int16x8_t lean =
        neon_where(are_natural, vqdmulhq_s16(vaddq_s16(weight, w->weight), lean_q15));
    const int16x8_t leaning = vsubq_s16(neon_where(vcgtq_s16(kind, w->kind), lean),
                                        neon_where(vcltq_s16(kind, w->kind), lean));
    const int16x8_t more = vaddq_s16(vsubq_s16(weight, w->weight), leaning);
    const uint16x8_t takes = vcgtzq_s16(more);
    w->kind = vbslq_s16(takes, kind, w->kind);
    w->weight = vbslq_s16(takes, weight, w->weight);
}

/* The winner among four, by the weights of their classes. */
static inline struct neon_winner neon_winner_of(const struct neon_corners *corners,
                                                const int16x8_t kind[4], int16x8_t lean_q15,
                                                uint32_t natural)
{
    const uint16x8_t ab = vceqq_s16(kind[0], kind[1]), ac = vceqq_s16(kind[0], kind[2]);
    const uint16x8_t ad = vceqq_s16(kind[0], kind[3]), bc = vceqq_s16(kind[1], kind[2]);
    const uint16x8_t bd = vceqq_s16(kind[1], kind[3]), cd = vceqq_s16(kind[2], kind[3]);
    const int16x8_t a = corners->weight[0], b = corners->weight[1];
    const int16x8_t c = corners->weight[2], d = corners->weight[3];
    const int16x8_t of_a =
        vaddq_s16(vaddq_s16(a, neon_where(ab, b)), vaddq_s16(neon_where(ac, c), neon_where(ad, d)));
    const int16x8_t of_b =
        vaddq_s16(vaddq_s16(b, neon_where(ab, a)), vaddq_s16(neon_where(bc, c), neon_where(bd, d)));
    const int16x8_t of_c =
        vaddq_s16(vaddq_s16(c, neon_where(ac, a)), vaddq_s16(neon_where(bc, b), neon_where(cd, d)));
    const int16x8_t of_d =
        vaddq_s16(vaddq_s16(d, neon_where(ad, a)), vaddq_s16(neon_where(bd, b), neon_where(cd, c)));
    struct neon_winner w = {kind[0], of_a};
    neon_challenge(&w, kind[1], of_b, lean_q15, natural);
    neon_challenge(&w, kind[2], of_c, lean_q15, natural);
    neon_challenge(&w, kind[3], of_d, lean_q15, natural);
    return w;
}

/* Of four numbers less one of them, each times its weight: the sums. */
static inline int32x4x2_t neon_weighed(const struct neon_corners *c, const int16x8_t number[4],
                                       int16x8_t less)
{
    int16x8_t x = vsubq_s16(number[0], less);
    int32x4_t low = vmull_s16(vget_low_s16(x), vget_low_s16(c->weight[0]));
    int32x4_t high = vmull_high_s16(x, c->weight[0]);
    for (size_t n = 1; n < 4; n++) {
        x = vsubq_s16(number[n], less);
        low = vmlal_s16(low, vget_low_s16(x), vget_low_s16(c->weight[n]));
        high = vmlal_high_s16(high, x, c->weight[n]);
    }
    return (int32x4x2_t){{low, high}};
}

/* Of the cells that have weight, the first of the heaviest. */
static inline uint16x8_t neon_heaviest(const struct neon_corners *c)
{
    uint16x8_t cell = c->cell[0];
    int16x8_t most = c->weight[0];
    for (size_t n = 1; n < 4; n++) {
        cell = vbslq_u16(vcgtq_s16(c->weight[n], most), c->cell[n], cell);
        most = vmaxq_s16(c->weight[n], most);
    }
    return cell;
}

/* The bits in which some of the four cells differs from the first. */
static inline uint16x8_t neon_differences(const struct neon_corners *c)
{
    return vorrq_u16(
        vorrq_u16(veorq_u16(c->cell[0], c->cell[1]), veorq_u16(c->cell[0], c->cell[2])),
        veorq_u16(c->cell[0], c->cell[3]));
}

/* The heights of height codes, lower bytes and upper bytes. */
struct neon_heights {
    uint8x16_t dm[2];
};

static inline struct neon_heights neon_heights_of(const uint16_t *height_dm)
{
    const uint8x16_t low = vreinterpretq_u8_u16(vld1q_u16(height_dm));
    const uint8x16_t high = vreinterpretq_u8_u16(vld1q_u16(height_dm + 8));
    return (struct neon_heights){{vuzp1q_u8(low, high), vuzp2q_u8(low, high)}};
}

/* Heights of the codes of eight cells, and of eight more. */
static inline void neon_heights_dm(const struct neon_heights *h, uint16x8_t a, uint16x8_t b,
                                   int16x8_t height_dm[2])
{
    const uint8x16_t code = vandq_u8(vuzp1q_u8(vreinterpretq_u8_u16(a), vreinterpretq_u8_u16(b)),
                                     vdupq_n_u8(LM_K_CODES - 1));
    const uint8x16_t low = vqtbl1q_u8(h->dm[0], code), high = vqtbl1q_u8(h->dm[1], code);
    height_dm[0] = vreinterpretq_s16_u8(vzip1q_u8(low, high));
    height_dm[1] = vreinterpretq_s16_u8(vzip2q_u8(low, high));
}

/* What four heights are higher than the code's, and the crown; metres * 16384. */
static inline int32x4_t neon_higher(int32x4_t sum, int32x4_t share, uint16x4_t height_dm,
                                    int16x4_t crown_q16)
{
    const int32x4_t q10 = vmulq_s32(vshrq_n_s32(sum, 9), share);
    const int32x4_t higher =
        vaddq_s32(vsraq_n_s32(q10, q10, 1), vsraq_n_s32(vshrq_n_s32(q10, 4), q10, 5));
    const uint32x4_t code_m_q14 = vshrq_n_u32(vmull_n_u16(height_dm, LM_K_Q19_OF_DM), 5);
    const int32x4_t height = vaddq_s32(vreinterpretq_s32_u32(code_m_q14), higher);
    return vaddq_s32(higher, vqdmulhq_s32(height, vshll_n_s16(crown_q16, 15)));
}

static inline int32x4_t neon_low(uint16x8_t x)
{
    return vreinterpretq_s32_u32(vmovl_u16(vget_low_u16(x)));
}

static inline int32x4_t neon_high(uint16x8_t x)
{
    return vreinterpretq_s32_u32(vmovl_high_u16(x));
}

/* Mean of the winner's cells, whose weights are left in `c`: cell, level and elevation of eight. */
static inline void neon_store_mean(const struct lm_k_blend *map, const struct neon_corners *c,
                                   int16x8_t weight, const struct neon_heights *heights,
                                   int16x8_t crown_q16, const uint32x4_t ground[2], uint32_t *cell,
                                   uint32_t *elevation)
{
    const uint8x16x4_t shares = vld1q_u8_x4(share_of_weight);
    const uint8x8_t step = vshrn_n_u16(vreinterpretq_u16_s16(vsubq_s16(weight, vdupq_n_s16(1))), 8);
    const uint16x8_t share = vmovl_u8(vqtbl4_u8(shares, step));
    const uint16x8_t best = neon_heaviest(c);
    int16x8_t number[4];
    for (size_t n = 0; n < 4; n++) {
        number[n] = vreinterpretq_s16_u16(vshrq_n_u16(c->cell[n], 8));
    }
    const int32x4x2_t gamma = neon_weighed(c, number, vreinterpretq_s16_u16(vshrq_n_u16(best, 8)));
    const int16x8_t more_db_q8 =
        vrshrn_high_n_s32(vrshrn_n_s32(vmulq_s32(gamma.val[0], neon_low(share)), 12),
                          vmulq_s32(gamma.val[1], neon_high(share)), 12);
    const uint16x8_t more = vreinterpretq_u16_s16(more_db_q8);
    vst1q_u32(cell, vreinterpretq_u32_u16(vzip1q_u16(best, more)));
    vst1q_u32(cell + 4, vreinterpretq_u32_u16(vzip2q_u16(best, more)));

    /* Most ground is of one height. */
    const uint16x8_t differs =
        vorrq_u16(vandq_u16(neon_differences(c), vdupq_n_u16(LM_K_CODES - 1)),
                  vreinterpretq_u16_s16(crown_q16));
    if (vmaxvq_u16(differs) == 0) {
        vst1q_u32(elevation, ground[0]);
        vst1q_u32(elevation + 4, ground[1]);
        return;
    }
    int16x8_t own_dm[2];
    neon_heights_dm(heights, c->cell[0], c->cell[1], number);
    neon_heights_dm(heights, c->cell[2], c->cell[3], number + 2);
    neon_heights_dm(heights, best, best, own_dm);
    const int32x4x2_t sum = neon_weighed(c, number, own_dm[0]);
    const uint16x8_t height_dm = vreinterpretq_u16_s16(own_dm[0]);
    const uint16x8_t is_flat = vtstq_u16(neon_bit_of(map->flat, neon_kinds(best)), vdupq_n_u16(1));
    const uint16x8_t height_share = vbicq_u16(share, is_flat);
    const int32x4_t low = neon_higher(sum.val[0], neon_low(height_share), vget_low_u16(height_dm),
                                      vget_low_s16(crown_q16));
    const int32x4_t high = neon_higher(sum.val[1], neon_high(height_share),
                                       vget_high_u16(height_dm), vget_high_s16(crown_q16));
    vst1q_u32(elevation, vaddq_u32(ground[0], vreinterpretq_u32_s32(low)));
    vst1q_u32(elevation + 4, vaddq_u32(ground[1], vreinterpretq_u32_s32(high)));
}

/* Take the weights of all but the winner's cells away. Returns the weight that is left. */
static inline int16x8_t neon_contest(const struct lm_k_blend *map, struct neon_corners *c,
                                     struct neon_grown grown, int16x8_t *crown_q16)
{
    int16x8_t kind[4];
    for (size_t n = 0; n < 4; n++) {
        kind[n] = neon_kinds(c->cell[n]);
    }
    const struct neon_winner w =
        neon_winner_of(c, kind, vqdmulhq_n_s16(grown.bend_q8, 230 << 7), map->natural);
    for (size_t n = 0; n < 4; n++) {
        c->weight[n] = neon_where(vceqq_s16(kind[n], w.kind), c->weight[n]);
    }
    const uint16x8_t is_crowned = vtstq_u16(neon_bit_of(map->crowned, w.kind), vdupq_n_u16(1));
    *crown_q16 = neon_where(is_crowned, grown.crown_q16);
    return w.weight;
}

void lm_k_tile_blend(const struct lm_k_blend *map, const struct lm_tile_coords *places,
                     uint32_t first, uint32_t groups, uint32_t *cell_of_line,
                     int32_t *elevation_m_q14)
{
    const struct neon_source posts_of = neon_source_of(map->points);
    const struct neon_source cells_of = neon_source_of(map->points - LM_TILE_POINTS - 1);
    const struct neon_heights heights = neon_heights_of(map->height_dm_of_code);
    struct neon_track north_track = neon_track_from(&places->north, first);
    struct neon_track east_track = neon_track_from(&places->east, first);
    uint32_t *cell = cell_of_line + first;
    uint32_t *elevation = (uint32_t *)elevation_m_q14 + first;
    for (const uint32_t *const end = cell + groups * LM_LANES; cell != end;
         cell += LM_LANES, elevation += LM_LANES) {
        uint32_t offset[2 * LM_LANES];
        neon_pair south[LM_LANES], north[LM_LANES];
        const uint32x4_t n[2] = {neon_next(&north_track), neon_next(&north_track)};
        const uint32x4_t e[2] = {neon_next(&east_track), neon_next(&east_track)};
        const uint32x4_t n_q25[2] = {neon_half_on(n[0]), neon_half_on(n[1])};
        const uint32x4_t e_q25[2] = {neon_half_on(e[0]), neon_half_on(e[1])};
        for (size_t h = 0; h < 2; h++) {
            const uint32x4_t record = vld1q_u32(cell + 4 * h);
            vst1q_u32(offset + 4 * h, neon_offsets(record, n[h], e[h]));
            vst1q_u32(offset + LM_LANES + 4 * h, neon_corner_offsets(record, n_q25[h], e_q25[h]));
        }
        __asm__("" : "+m"(offset));
        neon_fetch(&posts_of, offset, south, north);
        neon_fetch(&posts_of, offset + 4, south + 4, north + 4);
        const uint16x8x4_t s = vld4q_u16((const uint16_t *)south);
        const uint16x8x4_t f = vld4q_u16((const uint16_t *)north);
        const struct neon_posts posts = {s.val[1], s.val[3], f.val[1], f.val[3]};
        const uint32x4x2_t post_q16 =
            neon_bilerp(&posts, neon_weights(e[0], e[1]), neon_weights(n[0], n[1]));
        const uint32x4_t ground[2] = {neon_elevation(vld1q_u32(elevation), post_q16.val[0]),
                                      neon_elevation(vld1q_u32(elevation + 4), post_q16.val[1])};
        neon_fetch(&cells_of, offset + LM_LANES, south, north);
        neon_fetch(&cells_of, offset + LM_LANES + 4, south + 4, north + 4);
        const uint16x8x4_t low = vld4q_u16((const uint16_t *)south);
        const uint16x8x4_t high = vld4q_u16((const uint16_t *)north);
        struct neon_corners c = {.cell = {low.val[0], low.val[2], high.val[0], high.val[2]}};
        neon_set_weights(&c, neon_fractions(e_q25[0], e_q25[1]),
                         neon_fractions(n_q25[0], n_q25[1]));
        int16x8_t weight = vdupq_n_s16(16384), crown_q16 = vdupq_n_s16(0);
        /* Crowned cells, and those that are not of one class with all around. */
        const uint16x8_t is_crowned =
            vtstq_u16(neon_bit_of(map->crowned, neon_kinds(c.cell[0])), vdupq_n_u16(1));
        const uint16x8_t others = vandq_u16(neon_differences(&c), vdupq_n_u16(0xF0));
        if (vmaxvq_u16(vorrq_u16(is_crowned, others)) != 0) {
            weight = neon_contest(map, &c, neon_grown_at(map, n, e), &crown_q16);
        }
        neon_store_mean(map, &c, weight, &heights, crown_q16, ground, cell, elevation);
    }
}
