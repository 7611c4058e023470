#include "lm/chip_lay.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "fx/trig.h"

/* a b / 2^30 for a below 2^23 (a place on the chip) and b a sine or cosine. */
static int32_t part(int64_t a, int32_t b_q30)
{
    return (int32_t)(a * b_q30 >> 30);
}

/* How far the chip is turned from the line of sight. */
struct rotation {
    int32_t cos_q30, sin_q30;
};

/* Where a corner of a box lies, in pixels * 65536 from the origin, turned back: to the right and
 * beyond. */
struct corner_place {
    int32_t right_q16, beyond_q16;
};

static struct corner_place turned(const struct lm_chip_lay *lay, const struct rotation *r,
                                  int32_t column_q16, int32_t row_q16)
{
    const int32_t x = column_q16 - lay->origin_q16[0], y = row_q16 - lay->origin_q16[1];
    return (struct corner_place){part(x, r->cos_q30) - part(y, r->sin_q30),
                                 part(x, r->sin_q30) + part(y, r->cos_q30)};
}

/* Whole cells from a place on, or up to it: one more either way for the places within a cell. */
static int32_t cells_of(int32_t pixels_q16, uint32_t pixels_a_cell_q16, int32_t more)
{
    return pixels_q16 / (int32_t)fx_max_u32(pixels_a_cell_q16, 1) + more;
}

/* The cells over a box, which interpolation makes half a pixel wider all around. */
static struct lm_chip_reach reach_of(const struct lm_chip_lay *lay, const struct lm_chip_box *box,
                                     const struct rotation *turn, uint32_t scale_q16)
{
    struct lm_chip_reach r = {INT32_MAX, 0, INT32_MAX, 0};
    if (box->row_end == 0) {
        return (struct lm_chip_reach){0, 0, 0, 0};
    }
    r.right_end = r.beyond_end = INT32_MIN;
    for (int i = 0; i < 4; i++) {
        const int32_t column_q16 =
            i % 2 ? box->column_end * 65536 + 32768 : box->column * 65536 - 32768;
        const int32_t row_q16 = i / 2 ? box->row_end * 65536 + 32768 : box->row * 65536 - 32768;
        const struct corner_place c = turned(lay, turn, column_q16, row_q16);
        r.right = fx_min_i32(r.right, cells_of(c.right_q16, scale_q16, -1));
        r.right_end = fx_max_i32(r.right_end, cells_of(c.right_q16, scale_q16, 2));
        r.beyond = fx_min_i32(r.beyond, cells_of(c.beyond_q16, scale_q16, -1));
        r.beyond_end = fx_max_i32(r.beyond_end, cells_of(c.beyond_q16, scale_q16, 2));
    }
    return r;
}

void lm_chip_lay_set(struct lm_chip_lay *lay, const struct lm_chip_slot *slot, fx_bam_t turn,
                     uint32_t cell_mm)
{
    /* A chip is reduced to pixels of half a cell or more: below 2^18. */
    const uint32_t scale_q16 = (uint32_t)(((uint64_t)cell_mm << 16) / slot->pixel_mm);
    const struct rotation r = {fx_cos_q30(turn), fx_sin_q30(turn)};
    const int32_t half_q16 = (int32_t)slot->side << 15;
    const int32_t before_q16 = (int32_t)((uint32_t)slot->origin_row << 16 >> slot->key.shift);
    lay->slot = slot;
    lay->right_q16[0] = lay->beyond_q16[1] = part(scale_q16, r.cos_q30);
    lay->beyond_q16[0] = part(scale_q16, r.sin_q30);
    lay->right_q16[1] = -lay->beyond_q16[0];
    lay->origin_q16[0] = half_q16;
    lay->origin_q16[1] = before_q16;
    lay->lit = reach_of(lay, &slot->lit, &r, scale_q16);
    lay->dark = reach_of(lay, &slot->dark, &r, scale_q16);
    lay->gain_q8 = 2 * (fx_db_q8_u64(scale_q16) - fx_db_q8_u64(65536));
}

/* A place on the chip, pixels * 65536: column and row. */
struct spot {
    int32_t column_q16, row_q16;
};

/* Within the reach, which is some pixels more than the chip's 64 either way: below 2^24. */
static struct spot spot_of(const struct lm_chip_lay *lay, int32_t right_q8, int32_t beyond_q8)
{
    int32_t at_q16[2];
    for (int i = 0; i < 2; i++) {
        at_q16[i] = lay->origin_q16[i] + (int32_t)(((int64_t)right_q8 * lay->right_q16[i] +
                                                    (int64_t)beyond_q8 * lay->beyond_q16[i]) >>
                                                   8);
    }
    return (struct spot){at_q16[0], at_q16[1]};
}

/* Four places in a cell, a quarter of it from its middle both ways: closer together than pixels
 * are, so that none is missed. */
enum { PLACES = 4, QUARTER_Q8 = 64 };

static void places_in(const struct lm_chip_lay *lay, int32_t right_q8, int32_t beyond_q8,
                      struct spot place[PLACES])
{
    for (int32_t i = 0; i < PLACES; i++) {
        place[i] = spot_of(lay, right_q8 + (i % 2 * 2 - 1) * QUARTER_Q8,
                           beyond_q8 + (i / 2 * 2 - 1) * QUARTER_Q8);
    }
}

/* The four pixels that a place lies between: the lower left of them, behind the border, and how
 * far on to the others it is. False beside the chip. */
struct corner {
    uint32_t column, row, right_q8, up_q8;
};

static bool find_corner(const struct lm_chip_slot *slot, struct spot at, struct corner *c)
{
    /* Pixel k has its middle at k + 1/2 and is number k + 1 of the row. */
    const uint32_t column_q16 = (uint32_t)(at.column_q16 + 32768);
    const uint32_t row_q16 = (uint32_t)(at.row_q16 + 32768);
    *c = (struct corner){column_q16 >> 16, row_q16 >> 16, column_q16 >> 8 & 255u,
                         row_q16 >> 8 & 255u};
    return c->column <= slot->side && c->row <= slot->side;
}

/* Share of the total of two pixels side by side, weighted by nearness: Q40, below 2^40. */
static uint64_t pair_q40(const uint16_t *amplitude_q16, uint32_t right_q8)
{
    const uint32_t left = (uint32_t)amplitude_q16[0] * amplitude_q16[0];
    const uint32_t right = (uint32_t)amplitude_q16[1] * amplitude_q16[1];
    return (uint64_t)left * (256 - right_q8) + (uint64_t)right * right_q8;
}

/* Share of the total a pixel, interpolated between the middles of four of them: Q48. */
static uint64_t share_q48(const struct lm_chip_slot *slot, struct spot at)
{
    struct corner c;
    if (!find_corner(slot, at, &c)) {
        return 0;
    }
    const uint64_t near_q40 = pair_q40(&slot->amplitude_q16[c.row][c.column], c.right_q8);
    const uint64_t far_q40 = pair_q40(&slot->amplitude_q16[c.row + 1][c.column], c.right_q8);
    return near_q40 * (256 - c.up_q8) + far_q40 * c.up_q8;
}

/* The same of the shadow: 255 in Q16 for all of it. */
static uint32_t shadow_q16(const struct lm_chip_slot *slot, struct spot at)
{
    struct corner c;
    if (!find_corner(slot, at, &c)) {
        return 0;
    }
    const uint8_t *near = &slot->shadow[c.row][c.column], *far = &slot->shadow[c.row + 1][c.column];
    return (near[0] * (256 - c.right_q8) + near[1] * c.right_q8) * (256 - c.up_q8) +
           (far[0] * (256 - c.right_q8) + far[1] * c.right_q8) * c.up_q8;
}

int32_t lm_chip_cell_q8(const struct lm_chip_lay *lay, int32_t right_q8, int32_t beyond_q8)
{
    struct spot place[PLACES];
    uint64_t sum_q50 = 0;
    places_in(lay, right_q8, beyond_q8, place);
    for (uint32_t i = 0; i < PLACES; i++) {
        sum_q50 += share_q48(lay->slot, place[i]);
    }
    return sum_q50 == 0 ? LM_RCS_NONE_Q8
                        : lay->slot->total_q8 + lay->gain_q8 + fx_db_q8_u64(sum_q50) -
                              fx_db_q8_u64((uint64_t)1 << 50);
}

uint32_t lm_chip_cell_shadow(const struct lm_chip_lay *lay, int32_t right_q8, int32_t beyond_q8)
{
    struct spot place[PLACES];
    uint32_t sum_q16 = 0;
    places_in(lay, right_q8, beyond_q8, place);
    for (uint32_t i = 0; i < PLACES; i++) {
        sum_q16 += shadow_q16(lay->slot, place[i]);
    }
    return sum_q16 >> 16;
}
