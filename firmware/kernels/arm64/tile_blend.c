#include <arm_neon.h>

#include "fx/mem.h"
#include "lm/kernels_clutter.h"
#include "lm/kernels_map.h"
#include "lm/lanes.h"
#include "neon.h"
#include "neon_tile.h"
#include "neon_track.h"

/* Sixteen places at a time: what is known of a cell stands in bytes, and so do weights. Words and
 * order are those of c/tile_blend.c. The contest of classes, what has grown and heights are left
 * out where none of the sixteen needs them. */

enum { PLACES = 2 * LM_LANES, CROWNED = 2, FLAT = 4, IS_NATURAL = 0x80 };

/* share_of_weight of c/tile_blend.c. */
static const uint8_t share_of_weight[64] = {
    255, 255, 255, 255, 255, 255, 255, 255, 241, 216, 195, 178, 164, 152, 141, 132,
    124, 117, 111, 105, 100, 95,  91,  87,  84,  80,  77,  74,  72,  69,  67,  65,
    63,  61,  59,  58,  56,  55,  53,  52,  51,  49,  48,  47,  46,  45,  44,  43,
    42,  41,  41,  40,  39,  38,  38,  37,  36,  36,  35,  34,  34,  33,  33,  32,
};

/* A map, as the vectors look it up: marks of each class, and heights of height codes, lower bytes
 * and upper bytes. Of natural classes `most` and `least` are the same number, IS_NATURAL and the
 * class; of others `most` is the least and `least` the most there is. A crowned class has them the
 * wrong way round: what has grown counts where the most of four cells is above the least. */
struct neon_map {
    struct neon_source posts, cells;
    const uint8_t *grown;
    int32x4_t down; /* to texels, or to sixteenths of one */
    bool is_stepped;
    uint8x16_t marks, most, least, height_dm[2];
};

/* Where sixteen places are: north and east. */
struct neon_places {
    uint32x4_t north[4], east[4];
};

/* Which half of a turn is stored where: the second half of a last odd group is stored below the
 * first. It goes by value, because what is stored through it might change it. */
struct neon_turn {
    uint32_t *cell, *elevation;
    size_t next;
    const struct neon_places *at;
};

/* The four cells around each place: south-west, south-east, north-west, north-east. */
struct neon_corners {
    uint8x16_t low[4];   /* class and height code */
    uint8x16_t gamma[4]; /* code of the reflectivity */
    uint8x16_t kind[4];
    uint8x16_t weight[4]; /* in 256ths; the first's is one less */
};

/* What has grown at sixteen places: half the lean of a border, in 128ths, and crowns. */
struct neon_grown {
    int8x16_t lean_q7;
    int16x8_t crown_q16[2];
};

/* Of a mask of classes, the mark in the byte of each class. */
static inline uint8x16_t neon_marks(uint32_t mask, uint8_t mark)
{
    const uint8x16_t bit = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const uint8x16_t bits = vcombine_u8(vdup_n_u8((uint8_t)mask), vdup_n_u8((uint8_t)(mask >> 8)));
    return vandq_u8(vtstq_u8(bits, bit), vdupq_n_u8(mark));
}

static inline struct neon_map neon_map_of(const struct lm_k_blend *map)
{
    const uint8x16_t number = {128, 129, 130, 131, 132, 133, 134, 135,
                               136, 137, 138, 139, 140, 141, 142, 143};
    const uint8x16_t natural = neon_marks(map->natural, UINT8_MAX);
    const uint8x16_t crowned = neon_marks(map->crowned, UINT8_MAX);
    struct neon_map look_up = {
        .posts = neon_source_of(map->points),
        .cells = neon_source_of(map->points - LM_TILE_POINTS - 1),
        .grown = (const uint8_t *)map->grown,
        .down = vdupq_n_s32((map->is_stepped ? 0 : 4) - (int32_t)map->grown_shift),
        .is_stepped = map->is_stepped,
        .marks = vorrq_u8(neon_marks(map->crowned, CROWNED), neon_marks(map->flat, FLAT)),
        .most = vorrq_u8(vandq_u8(natural, number), vandq_u8(crowned, vdupq_n_u8(1))),
        .least = vbicq_u8(vornq_u8(number, natural), crowned),
    };
    neon_set_bytes(look_up.height_dm, map->height_dm_of_code);
    return look_up;
}

/* ---- places and points ---- */

/* Upper halves of the coordinates of eight places, half a cell further, in 2^-15 of a tile. */
static inline uint16x8_t neon_half_on(uint16x8_t half)
{
    return vhaddq_u16(half, vdupq_n_u16(1 << 9));
}

/* Ways from the middles of cells, in 128ths. */
static inline uint16x8_t neon_from_middles(uint16x8_t half_on)
{
    return vshrq_n_u16(vshlq_n_u16(half_on, 7), 9);
}

/* Upper eight bits of sixteen numbers of 14. */
static inline uint8x16_t neon_256ths(uint16x8_t low, uint16x8_t high)
{
    return vshrn_high_n_u16(vshrn_n_u16(low, 6), high, 6);
}

/* The numbers that are cut off add up to less than the first's weight: no sum is above 255. */
static inline void neon_set_weights(struct neon_corners *c, const uint16x8_t u[2],
                                    const uint16x8_t v[2])
{
    uint16x8_t of_b[2], of_c[2], of_d[2];
    for (size_t h = 0; h < 2; h++) {
        of_d[h] = vmulq_u16(u[h], v[h]);
        of_b[h] = vsubq_u16(vshlq_n_u16(u[h], 7), of_d[h]);
        of_c[h] = vsubq_u16(vshlq_n_u16(v[h], 7), of_d[h]);
    }
    c->weight[1] = neon_256ths(of_b[0], of_b[1]);
    c->weight[2] = neon_256ths(of_c[0], of_c[1]);
    c->weight[3] = neon_256ths(of_d[0], of_d[1]);
    c->weight[0] = vmvnq_u8(vaddq_u8(vaddq_u8(c->weight[1], c->weight[2]), c->weight[3]));
}

/* Lower and upper bytes of sixteen cells. */
static inline void neon_set_cells(struct neon_corners *c, size_t n, uint16x8_t low, uint16x8_t high)
{
    const uint8x16_t first = vreinterpretq_u8_u16(low), second = vreinterpretq_u8_u16(high);
    c->low[n] = vuzp1q_u8(first, second);
    c->gamma[n] = vuzp2q_u8(first, second);
}

/* ---- what has grown ---- */

/* Where the texels of eight places are, in bytes. */
static inline uint16x8_t neon_texel_offsets(uint16x8_t north, uint16x8_t east)
{
    const uint16x8_t in_side = vdupq_n_u16(LM_K_GROWN_SIDE - 1);
    const uint16x8_t row = vandq_u16(north, in_side), column = vandq_u16(east, in_side);
    return vshlq_n_u16(vmlaq_n_u16(column, row, LM_K_GROWN_STRIDE), 1);
}

/* The texels of sixteen places: bends, and crowns. */
static inline uint8x16x2_t neon_texels_of(const uint8_t *grown, const uint16_t *offset)
{
    uint16_t texel[PLACES];
    for (size_t k = 0; k < PLACES; k += 2) {
        const uint16_t first = fx_load_u16(grown + offset[k]);
        const uint16_t second = fx_load_u16(grown + offset[k + 1]);
        texel[k] = first;
        texel[k + 1] = second;
    }
    __asm__("" : "+m"(texel));
    return vld2q_u8((const uint8_t *)texel);
}

/* Half the lean of a border from eight bends times 256. */
static inline int8x8_t neon_lean_q7(int16x8_t bend_q8)
{
    return vmovn_s16(vqrdmulhq_n_s16(bend_q8, LM_K_LEAN_OF_BEND_Q7));
}

static inline int16x8_t neon_crown_q16(uint16x8_t crown_q8)
{
    return vreinterpretq_s16_u16(veorq_u16(crown_q8, vdupq_n_u16(0x8000)));
}

/* By the nearest texel alone. */
static inline struct neon_grown neon_grown_nearest(const struct neon_map *map,
                                                   const struct neon_places *at)
{
    uint16_t offset[PLACES];
    for (size_t h = 0; h < 2; h++) {
        const uint16x8_t north =
            vuzp1q_u16(vreinterpretq_u16_u32(vrshlq_u32(at->north[2 * h], map->down)),
                       vreinterpretq_u16_u32(vrshlq_u32(at->north[2 * h + 1], map->down)));
        const uint16x8_t east =
            vuzp1q_u16(vreinterpretq_u16_u32(vrshlq_u32(at->east[2 * h], map->down)),
                       vreinterpretq_u16_u32(vrshlq_u32(at->east[2 * h + 1], map->down)));
        vst1q_u16(offset + LM_LANES * h, neon_texel_offsets(north, east));
    }
    __asm__("" : "+m"(offset));
    const uint8x16x2_t texel = neon_texels_of(map->grown, offset);
    const int8x16_t bend = vreinterpretq_s8_u8(texel.val[0]);
    return (struct neon_grown){vcombine_s8(neon_lean_q7(vshll_n_s8(vget_low_s8(bend), 8)),
                                           neon_lean_q7(vshll_high_n_s8(bend, 8))),
                               {neon_crown_q16(vshll_n_u8(vget_low_u8(texel.val[1]), 8)),
                                neon_crown_q16(vshll_high_n_u8(texel.val[1], 8))}};
}

/* Two texels side by side at each of sixteen places: bends to the west, crowns there, and both to
 * the east; to the south and to the north. */
struct neon_texels {
    uint8x16x4_t south, north;
};

static inline struct neon_texels neon_texels_at(const uint8_t *grown, const uint16_t *offset)
{
    const uint8_t *further = grown + 2 * LM_K_GROWN_STRIDE;
    uint32_t south[PLACES], north[PLACES];
    __asm__("" : "+r"(further));
    for (size_t k = 0; k < PLACES; k += 2) {
        const size_t o0 = offset[k], o1 = offset[k + 1];
        const uint32_t s0 = fx_load_u32(grown + o0), s1 = fx_load_u32(grown + o1);
        const uint32_t n0 = fx_load_u32(further + o0), n1 = fx_load_u32(further + o1);
        south[k] = s0;
        south[k + 1] = s1;
        north[k] = n0;
        north[k + 1] = n1;
    }
    __asm__("" : "+m"(south), "+m"(north));
    return (struct neon_texels){vld4q_u8((const uint8_t *)south), vld4q_u8((const uint8_t *)north)};
}

/* Sixteenths of a way, and what is left of it, as bytes and as words. */
struct neon_way {
    uint8x16_t on, left;
};

static inline struct neon_way neon_way_of(uint16x8_t low_q4, uint16x8_t high_q4)
{
    const uint8x16_t on = vandq_u8(
        vuzp1q_u8(vreinterpretq_u8_u16(low_q4), vreinterpretq_u8_u16(high_q4)), vdupq_n_u8(15));
    return (struct neon_way){on, vsubq_u8(vdupq_n_u8(16), on)};
}

/* Crowns between two texels, in sixteenths. */
static inline uint16x8x2_t neon_crowns(uint8x16x4_t texels, struct neon_way east)
{
    return (uint16x8x2_t){
        {vmlal_u8(vmull_u8(vget_low_u8(texels.val[1]), vget_low_u8(east.left)),
                  vget_low_u8(texels.val[3]), vget_low_u8(east.on)),
         vmlal_high_u8(vmull_high_u8(texels.val[1], east.left), texels.val[3], east.on)}};
}

/* Bends between two texels, in sixteenths. */
static inline int16x8x2_t neon_bends(uint8x16x4_t texels, struct neon_way east)
{
    const int8x16_t west_bend = vreinterpretq_s8_u8(texels.val[0]),
                    east_bend = vreinterpretq_s8_u8(texels.val[2]),
                    on = vreinterpretq_s8_u8(east.on), left = vreinterpretq_s8_u8(east.left);
    return (int16x8x2_t){{vmlal_s8(vmull_s8(vget_low_s8(west_bend), vget_low_s8(left)),
                                   vget_low_s8(east_bend), vget_low_s8(on)),
                          vmlal_high_s8(vmull_high_s8(west_bend, left), east_bend, on)}};
}

/* By the four texels around each place. */
static inline struct neon_grown neon_grown_between(const struct neon_map *map,
                                                   const struct neon_places *at)
{
    const uint32x4_t *const north = at->north, *const east = at->east;
    uint16x8_t north_q4[2], east_q4[2];
    uint16_t offset[PLACES];
    for (size_t h = 0; h < 2; h++) {
        north_q4[h] = vuzp1q_u16(vreinterpretq_u16_u32(vshlq_u32(north[2 * h], map->down)),
                                 vreinterpretq_u16_u32(vshlq_u32(north[2 * h + 1], map->down)));
        east_q4[h] = vuzp1q_u16(vreinterpretq_u16_u32(vshlq_u32(east[2 * h], map->down)),
                                vreinterpretq_u16_u32(vshlq_u32(east[2 * h + 1], map->down)));
        vst1q_u16(offset + LM_LANES * h,
                  neon_texel_offsets(vshrq_n_u16(north_q4[h], 4), vshrq_n_u16(east_q4[h], 4)));
    }
    __asm__("" : "+m"(offset));
    const struct neon_texels texels = neon_texels_at(map->grown, offset);
    const struct neon_way u = neon_way_of(east_q4[0], east_q4[1]);
    const struct neon_way v = neon_way_of(north_q4[0], north_q4[1]);
    const uint16x8_t on[2] = {vmovl_u8(vget_low_u8(v.on)), vmovl_high_u8(v.on)};
    const uint16x8_t left[2] = {vmovl_u8(vget_low_u8(v.left)), vmovl_high_u8(v.left)};
    const uint16x8x2_t crown[2] = {neon_crowns(texels.south, u), neon_crowns(texels.north, u)};
    const int16x8x2_t bend[2] = {neon_bends(texels.south, u), neon_bends(texels.north, u)};
    struct neon_grown g;
    int8x8_t lean_q7[2];
    for (size_t h = 0; h < 2; h++) {
        const uint16x8_t sum =
            vmlaq_u16(vmulq_u16(crown[0].val[h], left[h]), crown[1].val[h], on[h]);
        const int16x8_t bent = vmlaq_s16(vmulq_s16(bend[0].val[h], vreinterpretq_s16_u16(left[h])),
                                         bend[1].val[h], vreinterpretq_s16_u16(on[h]));
        g.crown_q16[h] = neon_crown_q16(sum);
        lean_q7[h] = neon_lean_q7(bent);
    }
    g.lean_q7 = vcombine_s8(lean_q7[0], lean_q7[1]);
    return g;
}

/* ---- the contest of classes ---- */

/* A class with its weight: the one that has won so far, or one that challenges it. */
struct neon_winner {
    uint8x16_t kind, weight, most; /* the map's `most` of the class */
};

/* Factors of the weight of a class that is above the winner's, and of one that is below. */
struct neon_factors {
    uint8x16_t above, below;
};

static inline void neon_take(struct neon_winner *w, const struct neon_winner *k, uint8x16_t takes)
{
    w->kind = vbslq_u8(takes, k->kind, w->kind);
    w->weight = vbslq_u8(takes, k->weight, w->weight);
    w->most = vbslq_u8(takes, k->most, w->most);
}

/* Let a class challenge the winner. It wins if weight f > winner's (256 - f), with f = 128 + lean:
 * if both weights f > 256 winner's, and that over 256, rounded up, > winner's. Two classes have 256
 * at most; 255 says the same of 256. A class that challenges itself may win: it changes nothing. */
static inline void neon_challenge(struct neon_winner *w, const struct neon_winner *k,
                                  struct neon_factors factors)
{
    const uint8x16_t are_natural =
        vreinterpretq_u8_s8(vshrq_n_s8(vreinterpretq_s8_u8(vandq_u8(k->most, w->most)), 7));
    const uint8x16_t leaning = vbslq_u8(vcgtq_u8(k->kind, w->kind), factors.above, factors.below);
    const uint8x16_t f = vbslq_u8(are_natural, leaning, vdupq_n_u8(128));
    const uint8x16_t both = vqaddq_u8(k->weight, w->weight);
    const uint16x8_t low = vmull_u8(vget_low_u8(both), vget_low_u8(f));
    const uint16x8_t up = vdupq_n_u16(255);
    const uint8x16_t share = vaddhn_high_u16(vaddhn_u16(low, up), vmull_high_u8(both, f), up);
    neon_take(w, k, vcgtq_u8(share, w->weight));
}

/* Weight of all cells of the class of the first: up to 255. */
static inline uint8x16_t neon_of_class(uint8x16_t own, uint8x16_t is_b, uint8x16_t b,
                                       uint8x16_t is_c, uint8x16_t c, uint8x16_t is_d, uint8x16_t d)
{
    return vqaddq_u8(vqaddq_u8(own, vandq_u8(is_b, b)),
                     vqaddq_u8(vandq_u8(is_c, c), vandq_u8(is_d, d)));
}

/* The class of each of the four cells with its weight. */
static inline void neon_set_classes(const struct neon_map *map, const struct neon_corners *corners,
                                    struct neon_winner of[4])
{
    const uint8x16_t *const kind = corners->kind;
    const uint8x16_t ab = vceqq_u8(kind[0], kind[1]), ac = vceqq_u8(kind[0], kind[2]);
    const uint8x16_t ad = vceqq_u8(kind[0], kind[3]), bc = vceqq_u8(kind[1], kind[2]);
    const uint8x16_t bd = vceqq_u8(kind[1], kind[3]), cd = vceqq_u8(kind[2], kind[3]);
    const uint8x16_t a = vqaddq_u8(corners->weight[0], vdupq_n_u8(1));
    const uint8x16_t b = corners->weight[1], c = corners->weight[2], d = corners->weight[3];
    of[0].weight = neon_of_class(a, ab, b, ac, c, ad, d);
    of[1].weight = neon_of_class(b, ab, a, bc, c, bd, d);
    of[2].weight = neon_of_class(c, ac, a, bc, b, cd, d);
    of[3].weight = neon_of_class(d, ad, a, bd, b, cd, c);
    for (size_t n = 0; n < 4; n++) {
        of[n].kind = kind[n];
        of[n].most = vqtbl1q_u8(map->most, kind[n]);
    }
}

/* True if some border is one of two natural classes, or a class has crowns. */
static inline bool neon_needs_grown(const struct neon_map *map, const struct neon_winner of[4])
{
    uint8x16_t most = of[0].most, least = vqtbl1q_u8(map->least, of[0].kind);
    for (size_t n = 1; n < 4; n++) {
        most = vmaxq_u8(most, of[n].most);
        least = vminq_u8(least, vqtbl1q_u8(map->least, of[n].kind));
    }
    return neon_any(vcgtq_u8(most, least));
}

/* Of four classes, the first of most weight. */
static inline uint8x16_t neon_contest_plain(const struct neon_winner of[4])
{
    uint8x16_t kind = of[0].kind, weight = of[0].weight;
    for (size_t n = 1; n < 4; n++) {
        kind = vbslq_u8(vcgtq_u8(of[n].weight, weight), of[n].kind, kind);
        weight = vmaxq_u8(weight, of[n].weight);
    }
    return kind;
}

/* The same where the ground leans, and the crowns of the winners. */
static inline uint8x16_t neon_contest_grown(const struct neon_map *map,
                                            const struct neon_places *at,
                                            const struct neon_winner of[4], int16x8_t crown_q16[2])
{
    const struct neon_grown grown =
        map->is_stepped ? neon_grown_nearest(map, at) : neon_grown_between(map, at);
    const uint8x16_t even = vdupq_n_u8(128), lean_q7 = vreinterpretq_u8_s8(grown.lean_q7);
    const struct neon_factors factors = {vaddq_u8(even, lean_q7), vsubq_u8(even, lean_q7)};
    struct neon_winner w = of[0];
    for (size_t n = 1; n < 4; n++) {
        neon_challenge(&w, &of[n], factors);
    }
    const int8x16_t is_crowned =
        vreinterpretq_s8_u8(vtstq_u8(vqtbl1q_u8(map->marks, w.kind), vdupq_n_u8(CROWNED)));
    crown_q16[0] = vandq_s16(grown.crown_q16[0], vmovl_s8(vget_low_s8(is_crowned)));
    crown_q16[1] = vandq_s16(grown.crown_q16[1], vmovl_high_s8(is_crowned));
    return w.kind;
}

/* Find the winners, and take the weights of all but their cells away. */
static inline uint8x16_t neon_contest(const struct neon_map *map, const struct neon_places *at,
                                      struct neon_corners *c, int16x8_t crown_q16[2])
{
    struct neon_winner of[4];
    neon_set_classes(map, c, of);
    const uint8x16_t kind = neon_needs_grown(map, of) ? neon_contest_grown(map, at, of, crown_q16)
                                                      : neon_contest_plain(of);
    for (size_t n = 0; n < 4; n++) {
        c->weight[n] = vandq_u8(vceqq_u8(c->kind[n], kind), c->weight[n]);
    }
    return kind;
}

/* ---- means ---- */

/* Of the cells that have weight, the first of the heaviest: lower byte and code. */
struct neon_cell {
    uint8x16_t low, gamma;
};

static inline struct neon_cell neon_heaviest(const struct neon_corners *c)
{
    struct neon_cell best = {c->low[0], c->gamma[0]};
    uint8x16_t most = c->weight[0];
    for (size_t n = 1; n < 4; n++) {
        const uint8x16_t is_more = vcgtq_u8(c->weight[n], most);
        best.low = vbslq_u8(is_more, c->low[n], best.low);
        best.gamma = vbslq_u8(is_more, c->gamma[n], best.gamma);
        most = vmaxq_u8(most, c->weight[n]);
    }
    return best;
}

/* What the mean of eight reflectivities is above the heaviest cell's. */
static inline int16x8_t neon_more_db_q8(uint16x8_t gamma_sum, uint8x8_t share)
{
    const int16x8_t share_q15 = vreinterpretq_s16_u16(vshll_n_u8(share, 7));
    return vshlq_n_s16(vqrdmulhq_s16(vreinterpretq_s16_u16(gamma_sum), share_q15), 2);
}

/* Store the cells of a turn, and what the means of their reflectivities are above them. */
static inline void neon_store_cells(const struct neon_corners *c, struct neon_turn turn,
                                    struct neon_cell best, uint8x16_t weight, uint8x16_t share)
{
    uint16x8_t low = vmull_u8(vget_low_u8(c->weight[0]), vget_low_u8(c->gamma[0]));
    uint16x8_t high = vmull_high_u8(c->weight[0], c->gamma[0]);
    for (size_t n = 1; n < 4; n++) {
        low = vmlal_u8(low, vget_low_u8(c->weight[n]), vget_low_u8(c->gamma[n]));
        high = vmlal_high_u8(high, c->weight[n], c->gamma[n]);
    }
    low = vmlsl_u8(low, vget_low_u8(weight), vget_low_u8(best.gamma));
    high = vmlsl_high_u8(high, weight, best.gamma);
    const uint16x8_t first = vreinterpretq_u16_u8(vzip1q_u8(best.low, best.gamma));
    const uint16x8_t second = vreinterpretq_u16_u8(vzip2q_u8(best.low, best.gamma));
    const uint16x8_t more = vreinterpretq_u16_s16(neon_more_db_q8(low, vget_low_u8(share)));
    const uint16x8_t further = vreinterpretq_u16_s16(neon_more_db_q8(high, vget_high_u8(share)));
    vst1q_u16((uint16_t *)(turn.cell + turn.next), vzip1q_u16(second, further));
    vst1q_u16((uint16_t *)(turn.cell + turn.next + 4), vzip2q_u16(second, further));
    vst1q_u16((uint16_t *)turn.cell, vzip1q_u16(first, more));
    vst1q_u16((uint16_t *)(turn.cell + 4), vzip2q_u16(first, more));
}

/* Heights of the codes of sixteen cells. */
static inline uint16x8x2_t neon_heights_dm(const struct neon_map *map, uint8x16_t low)
{
    return neon_words_of_16(map->height_dm, vandq_u8(low, vdupq_n_u8(LM_K_CODES - 1)));
}

/* Metres * 16384 of four heights. */
static inline int32x4_t neon_metres_q14(uint16x4_t height_dm)
{
    return vreinterpretq_s32_u32(vshrq_n_u32(vmull_n_u16(height_dm, LM_K_Q19_OF_DM), 5));
}

/* What four heights are higher than the code's: metres * 16384. */
static inline int32x4_t neon_higher(int32x4_t sum, int32x4_t share)
{
    const int32x4_t q10 = vshrq_n_s32(vmulq_s32(vshrq_n_s32(sum, 1), share), 2);
    return vaddq_s32(vsraq_n_s32(q10, q10, 1), vsraq_n_s32(vshrq_n_s32(q10, 4), q10, 5));
}

/* The same of sixteen places. */
static inline int32x4x4_t neon_higher_of_16(const struct neon_map *map,
                                            const struct neon_corners *c, uint16x8x2_t own_dm,
                                            uint8x16_t share)
{
    int32x4x4_t sum = {{vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0)}};
    for (size_t n = 0; n < 4; n++) {
        const uint16x8x2_t height = neon_heights_dm(map, c->low[n]);
        const int16x8_t weight[2] = {vreinterpretq_s16_u16(vmovl_u8(vget_low_u8(c->weight[n]))),
                                     vreinterpretq_s16_u16(vmovl_high_u8(c->weight[n]))};
        for (size_t h = 0; h < 2; h++) {
            const int16x8_t apart = vreinterpretq_s16_u16(vsubq_u16(height.val[h], own_dm.val[h]));
            sum.val[2 * h] =
                vmlal_s16(sum.val[2 * h], vget_low_s16(apart), vget_low_s16(weight[h]));
            sum.val[2 * h + 1] = vmlal_high_s16(sum.val[2 * h + 1], apart, weight[h]);
        }
    }
    for (size_t h = 0; h < 2; h++) {
        const uint16x8_t wide = h == 0 ? vmovl_u8(vget_low_u8(share)) : vmovl_high_u8(share);
        sum.val[2 * h] =
            neon_higher(sum.val[2 * h], vreinterpretq_s32_u32(vmovl_u16(vget_low_u16(wide))));
        sum.val[2 * h + 1] =
            neon_higher(sum.val[2 * h + 1], vreinterpretq_s32_u32(vmovl_high_u16(wide)));
    }
    return sum;
}

/* Add to the elevations what the means of heights and the crowns are above the codes' heights. */
static inline void neon_add_heights(const struct neon_map *map, const struct neon_corners *c,
                                    struct neon_turn turn, uint8x16_t low, uint8x16_t share,
                                    bool do_differ, const int16x8_t crown_q16[2])
{
    const uint16x8x2_t own_dm = neon_heights_dm(map, low);
    int32x4x4_t more = {{vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0)}};
    if (do_differ) {
        more = neon_higher_of_16(map, c, own_dm, share);
    }
    for (size_t h = 0; h < 2; h++) {
        const int32x4_t first =
            vaddq_s32(neon_metres_q14(vget_low_u16(own_dm.val[h])), more.val[2 * h]);
        const int32x4_t second =
            vaddq_s32(neon_metres_q14(vget_high_u16(own_dm.val[h])), more.val[2 * h + 1]);
        more.val[2 * h] = vaddq_s32(
            more.val[2 * h], vqdmulhq_s32(first, vshll_n_s16(vget_low_s16(crown_q16[h]), 15)));
        more.val[2 * h + 1] =
            vaddq_s32(more.val[2 * h + 1],
                      vqdmulhq_s32(second, vshll_n_s16(vget_high_s16(crown_q16[h]), 15)));
    }
    int32_t *const low_half = (int32_t *)turn.elevation, *const high_half = low_half + turn.next;
    const int32x4x4_t ground = neon_load_8_and_8(low_half, high_half);
    vst1q_s32(high_half, vaddq_s32(ground.val[2], more.val[2]));
    vst1q_s32(high_half + 4, vaddq_s32(ground.val[3], more.val[3]));
    vst1q_s32(low_half, vaddq_s32(ground.val[0], more.val[0]));
    vst1q_s32(low_half + 4, vaddq_s32(ground.val[1], more.val[1]));
}

/* ---- a turn ---- */

/* Elevation of the terrain at eight places, whose halves are given. */
static inline uint32x4x2_t neon_elevations(const uint32_t *scale, const neon_pair *south,
                                           const neon_pair *north, uint16x8_t east_half,
                                           uint16x8_t north_half)
{
    const uint16x8x4_t s = vld4q_u16((const uint16_t *)south);
    const uint16x8x4_t f = vld4q_u16((const uint16_t *)north);
    const struct neon_posts posts = {s.val[1], s.val[3], f.val[1], f.val[3]};
    const uint32x4x2_t post_q16 =
        neon_bilerp(&posts, neon_weights(east_half), neon_weights(north_half));
    return (uint32x4x2_t){{neon_elevation(vld1q_u32(scale), post_q16.val[0]),
                           neon_elevation(vld1q_u32(scale + 4), post_q16.val[1])}};
}

/* What a turn fetches: one pointer reaches all of it. */
struct neon_scratch {
    uint32_t post[PLACES], cell[PLACES]; /* offsets */
    neon_pair south[PLACES], north[PLACES];
};

/* Store the elevations of the terrain, and find the four cells around each place. */
static inline void neon_read(const struct neon_map *map, struct neon_turn turn,
                             struct neon_corners *c)
{
    const struct neon_places *const at = turn.at;
    struct neon_scratch room, *scratch = &room;
    uint16x8_t e[2], n[2], u[2], v[2];
    __asm__("" : "+r"(scratch));
    for (size_t h = 0; h < 2; h++) {
        const uint32_t *const cell = turn.cell + h * turn.next;
        const uint32x4x2_t record = {{vld1q_u32(cell), vld1q_u32(cell + 4)}};
        e[h] = neon_halves(at->east[2 * h], at->east[2 * h + 1]);
        n[h] = neon_halves(at->north[2 * h], at->north[2 * h + 1]);
        neon_store_offsets(scratch->post + LM_LANES * h, record, vshrq_n_u16(n[h], 10),
                           vshrq_n_u16(e[h], 10));
        u[h] = neon_half_on(e[h]);
        v[h] = neon_half_on(n[h]);
        neon_store_offsets(scratch->cell + LM_LANES * h, record, vshrq_n_u16(v[h], 9),
                           vshrq_n_u16(u[h], 9));
        u[h] = neon_from_middles(u[h]);
        v[h] = neon_from_middles(v[h]);
    }
    __asm__("" : "+m"(*scratch));
    for (size_t k = 0; k < PLACES; k += 4) {
        neon_fetch(&map->posts, scratch->post + k, scratch->south + k, scratch->north + k);
    }
    uint32_t *const further = turn.elevation + turn.next;
    const uint32x4x2_t low =
        neon_elevations(turn.elevation, scratch->south, scratch->north, e[0], n[0]);
    const uint32x4x2_t high =
        neon_elevations(further, scratch->south + LM_LANES, scratch->north + LM_LANES, e[1], n[1]);
    vst1q_u32(further, high.val[0]);
    vst1q_u32(further + 4, high.val[1]);
    vst1q_u32(turn.elevation, low.val[0]);
    vst1q_u32(turn.elevation + 4, low.val[1]);
    for (size_t k = 0; k < PLACES; k += 4) {
        neon_fetch(&map->cells, scratch->cell + k, scratch->south + k, scratch->north + k);
    }
    neon_set_weights(c, u, v);
    const uint16x8x4_t s[2] = {vld4q_u16((const uint16_t *)scratch->south),
                               vld4q_u16((const uint16_t *)(scratch->south + LM_LANES))};
    const uint16x8x4_t f[2] = {vld4q_u16((const uint16_t *)scratch->north),
                               vld4q_u16((const uint16_t *)(scratch->north + LM_LANES))};
    neon_set_cells(c, 0, s[0].val[0], s[1].val[0]);
    neon_set_cells(c, 1, s[0].val[2], s[1].val[2]);
    neon_set_cells(c, 2, f[0].val[0], f[1].val[0]);
    neon_set_cells(c, 3, f[0].val[2], f[1].val[2]);
}

/* Where cells with weight are of other heights than the heaviest. All of them are of one class. */
static inline uint8x16_t neon_heights_differ(const struct neon_corners *c, struct neon_cell best)
{
    uint8x16_t differs = vdupq_n_u8(0);
    for (size_t n = 0; n < 4; n++) {
        const uint8x16_t counts = vtstq_u8(c->weight[n], c->weight[n]);
        differs = vorrq_u8(differs, vandq_u8(veorq_u8(c->low[n], best.low), counts));
    }
    return differs;
}

/* Blend the cells of a turn. */
static inline void neon_blend(const struct neon_map *map, struct neon_turn turn)
{
    struct neon_corners c;
    neon_read(map, turn, &c);
    for (size_t n = 0; n < 4; n++) {
        c.kind[n] = vshrq_n_u8(c.low[n], 4);
    }
    const uint8x16_t differences =
        vorrq_u8(vorrq_u8(veorq_u8(c.low[0], c.low[1]), veorq_u8(c.low[0], c.low[2])),
                 veorq_u8(c.low[0], c.low[3]));
    int16x8_t crown_q16[2] = {vdupq_n_s16(0), vdupq_n_s16(0)};
    uint8x16_t kind = c.kind[0];
    const uint8x16_t is_crowned = vtstq_u8(vqtbl1q_u8(map->marks, kind), vdupq_n_u8(CROWNED));
    if (neon_any(vorrq_u8(vshrq_n_u8(differences, 4), is_crowned))) {
        kind = neon_contest(map, turn.at, &c, crown_q16);
    }
    const uint8x16_t weight =
        vaddq_u8(vaddq_u8(c.weight[0], c.weight[1]), vaddq_u8(c.weight[2], c.weight[3]));
    const uint8x16_t share = vqtbl4q_u8(vld1q_u8_x4(share_of_weight), vshrq_n_u8(weight, 2));
    const struct neon_cell best = neon_heaviest(&c);
    neon_store_cells(&c, turn, best, weight, share);

    /* Most ground is of one height. */
    const uint8x16_t is_flat = vtstq_u8(vqtbl1q_u8(map->marks, kind), vdupq_n_u8(FLAT));
    const uint8x16_t differs = vbicq_u8(neon_heights_differ(&c, best), is_flat);
    const uint8x16_t crown = vreinterpretq_u8_s16(vorrq_s16(crown_q16[0], crown_q16[1]));
    if (neon_any(vorrq_u8(differs, crown))) {
        neon_add_heights(map, &c, turn, best.low, vbicq_u8(share, is_flat), neon_any(differs),
                         crown_q16);
    }
}

void lm_k_tile_blend(const struct lm_k_blend *map, const struct lm_tile_coords *places,
                     uint32_t first, uint32_t groups, uint32_t *cell, int32_t *elevation_m_q14)
{
    const struct neon_map look_up = neon_map_of(map);
    struct neon_track north_track = neon_track_from(&places->north, first);
    struct neon_track east_track = neon_track_from(&places->east, first);
    struct neon_places at;
    struct neon_turn turn = {.at = &at,
                             .cell = cell + first,
                             .elevation = (uint32_t *)elevation_m_q14 + first,
                             .next = LM_LANES};
    for (const uint32_t *const end = turn.cell + groups * LM_LANES; turn.cell < end;
         turn.cell += PLACES, turn.elevation += PLACES) {
        for (size_t h = 0; h < 4; h++) {
            at.north[h] = neon_next(&north_track);
            at.east[h] = neon_next(&east_track);
        }
        turn.next = turn.cell + LM_LANES == end ? 0 : LM_LANES;
        neon_blend(&look_up, turn);
    }
}
