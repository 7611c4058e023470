#include <arm_neon.h>
#include <stddef.h>

#include "../plain.h"
#include "lm/kernels_display.h"

/* Sixteen pixels at a time. 256 bytes are four tables of 64, in each of which a grey is looked up:
 * beyond a table's end that leaves what is there. */

enum { RUN = 16, TABLE = 64, TABLES = LM_K_GREYS / TABLE };

/* Greys as the four tables number them. */
struct neon_greys {
    uint8x16_t of[TABLES];
};

static inline struct neon_greys neon_greys_at(const uint8_t *grey)
{
    struct neon_greys g;
    g.of[0] = vld1q_u8(grey);
    for (size_t n = 1; n < TABLES; n++) {
        g.of[n] = vsubq_u8(g.of[n - 1], vdupq_n_u8(TABLE));
    }
    return g;
}

/* The tables of one byte, which is that of all three parts, stay in registers. */
static void colour_neutral(const struct lm_k_colours *c, const struct lm_k_area *lent)
{
    const struct lm_k_area copy = *lent, *const a = &copy; /* no store can change it */
    const uint8_t *const part = c->byte[1];
    const uint8x16x4_t t0 = vld1q_u8_x4(part), t1 = vld1q_u8_x4(part + TABLE);
    const uint8x16x4_t t2 = vld1q_u8_x4(part + 2 * TABLE), t3 = vld1q_u8_x4(part + 3 * TABLE);
    const uint8x16_t lowest = vdupq_n_u8(c->shift == 0 ? 255 : 0), highest = vmvnq_u8(lowest);
    for (uint32_t row = 0; row < a->height; row++) {
        const uint8_t *grey = a->grey + row * a->grey_stride;
        uint32_t *pixel = a->pixel + row * a->pixel_stride;
        for (const uint8_t *const end = grey + a->width; grey < end; grey += RUN, pixel += RUN) {
            const struct neon_greys g = neon_greys_at(grey);
            uint8x16_t x = vqtbl4q_u8(t0, g.of[0]);
            x = vqtbx4q_u8(x, t1, g.of[1]);
            x = vqtbx4q_u8(x, t2, g.of[2]);
            x = vqtbx4q_u8(x, t3, g.of[3]);
            vst4q_u8((uint8_t *)pixel,
                     ((uint8x16x4_t){{vandq_u8(x, lowest), x, x, vandq_u8(x, highest)}}));
        }
    }
}

/* One byte of two runs' colours. */
static inline uint8x16x2_t neon_look_up(const uint8_t *table, const struct neon_greys g[2])
{
    uint8x16x4_t t = vld1q_u8_x4(table);
    uint8x16x2_t x = {{vqtbl4q_u8(t, g[0].of[0]), vqtbl4q_u8(t, g[1].of[0])}};
    for (size_t n = 1; n < TABLES; n++) {
        t = vld1q_u8_x4(table + n * TABLE);
        x.val[0] = vqtbx4q_u8(x.val[0], t, g[0].of[n]);
        x.val[1] = vqtbx4q_u8(x.val[1], t, g[1].of[n]);
    }
    return x;
}

/* Two rows at once share what is loaded of the tables; of an odd number, the last is its own pair.
 */
static void colour_tinted(const struct lm_k_colours *c, const struct lm_k_area *lent)
{
    const struct lm_k_area copy = *lent, *const a = &copy;
    for (uint32_t row = 0; row < a->height; row += 2) {
        const uint32_t next = row + 1 < a->height;
        const uint8_t *grey = a->grey + row * a->grey_stride;
        uint32_t *pixel = a->pixel + row * a->pixel_stride;
        for (const uint8_t *const end = grey + a->width; grey < end; grey += RUN, pixel += RUN) {
            const struct neon_greys g[2] = {neon_greys_at(grey),
                                            neon_greys_at(grey + next * a->grey_stride)};
            const uint8x16x2_t b0 = neon_look_up(c->byte[0], g), b1 = neon_look_up(c->byte[1], g);
            const uint8x16x2_t b2 = neon_look_up(c->byte[2], g), b3 = neon_look_up(c->byte[3], g);
            const uint8x16x4_t first = {{b0.val[0], b1.val[0], b2.val[0], b3.val[0]}};
            const uint8x16x4_t second = {{b0.val[1], b1.val[1], b2.val[1], b3.val[1]}};
            vst4q_u8((uint8_t *)pixel, first);
            vst4q_u8((uint8_t *)(pixel + next * a->pixel_stride), second);
        }
    }
}

enum { BLANK_RUN = 64 };

/* Is all of an area of whole runs of grey 0? The first picture is. */
static bool is_blank(const struct lm_k_area *a)
{
    uint64x2_t any = vdupq_n_u64(0);
    for (uint32_t row = 0; row < a->height; row++) {
        const uint8_t *grey = a->grey + row * a->grey_stride;
        for (const uint8_t *const end = grey + a->width; grey < end; grey += BLANK_RUN) {
            const uint8x16x4_t g = vld1q_u8_x4(grey);
            const uint8x16_t pair = vorrq_u8(g.val[0], g.val[1]);
            any =
                vorrq_u64(any, vreinterpretq_u64_u8(vorrq_u8(pair, vorrq_u8(g.val[2], g.val[3]))));
        }
        if ((vgetq_lane_u64(any, 0) | vgetq_lane_u64(any, 1)) != 0) {
            return false;
        }
    }
    return true;
}

static void fill(uint32_t colour, const struct lm_k_area *a)
{
    const uint32x4_t four = vdupq_n_u32(colour);
    for (uint32_t row = 0; row < a->height; row++) {
        uint32_t *pixel = a->pixel + row * a->pixel_stride;
        for (const uint32_t *const end = pixel + a->width; pixel < end; pixel += BLANK_RUN) {
            for (uint32_t n = 0; n < BLANK_RUN; n += 4) {
                vst1q_u32(pixel + n, four);
            }
        }
    }
}

void lm_k_colour_area(const struct lm_k_colours *colours, const struct lm_k_area *area)
{
    if (area->width % BLANK_RUN == 0 && is_blank(area)) {
        fill(colours->of_grey[0], area);
        return;
    }
    struct lm_k_area whole = *area, rest = *area;
    rest.width %= RUN;
    whole.width -= rest.width;
    rest.grey += whole.width;
    rest.pixel += whole.width;
    if (colours->is_neutral) {
        colour_neutral(colours, &whole);
    } else {
        colour_tinted(colours, &whole);
    }
    if (rest.width != 0) {
        lm_k_colour_area_c(colours, &rest);
    }
}
