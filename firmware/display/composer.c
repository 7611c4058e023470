#include "lm/composer.h"

#include "fx/mem.h"
#include "fx/sat.h"

enum { RUN_PX = 16, BLOCK_PX = LM_BLOCK_WIDTH_PX * LM_BLOCK_HEIGHT_PX };

/* Compose eight pixels, the first of them the lowest byte. */
static inline void compose_eight(uint32_t *restrict out, uint64_t greys,
                                 const uint32_t *restrict colours)
{
    for (uint32_t k = 0; k < 8; k++) {
        out[k] = colours[greys >> 8 * k & 255];
    }
}

/* One table look-up a pixel, except in runs of black: more than half of the glass is beside the
 * sector or patch. `restrict` tells the compiler that table and picture do not overlap. */
static void compose_row(uint32_t *restrict out, const uint8_t *restrict grey,
                        const uint32_t *restrict colours, uint32_t pixels)
{
    const uint32_t black = colours[0];
    const uint32_t *const end = out + pixels;
    for (; end - out >= RUN_PX; out += RUN_PX, grey += RUN_PX) {
        const uint64_t first = fx_load_u64(grey), second = fx_load_u64(grey + 8);
        if ((first | second) == 0) {
            for (size_t k = 0; k < RUN_PX; k++) {
                out[k] = black;
            }
        } else {
            compose_eight(out, first, colours);
            compose_eight(out + 8, second, colours);
        }
    }
    while (out < end) {
        *out++ = colours[*grey++];
    }
}

void lm_composer_init(struct lm_composer *c, uint16_t width_px, uint16_t height_px)
{
    memset(c, 0, sizeof *c);
    c->glass = (struct lm_rectangle){0, 0, width_px, height_px};
    for (uint32_t age = 0; age < LM_AGES; age++) {
        lm_damage_mark(&c->since[age], &c->glass);
    }
}

void lm_composer_begin(struct lm_composer *c, const struct lm_surface *surface)
{
    c->surface = *surface;
    c->is_lent = true;
    if (surface->age >= 1 && surface->age <= LM_AGES) {
        c->due = c->since[surface->age - 1];
    } else {
        lm_damage_mark(&c->due, &c->glass);
    }
}

/* Take the palette's colours. Other ones change the whole glass. */
static void take_colours(struct lm_composer *c, const struct lm_palette *palette)
{
    uint32_t differs = 0;
    for (uint32_t grey = 0; grey < 256; grey++) {
        const uint32_t colour = palette->picture[grey] << c->surface.shift;
        differs |= colour ^ c->colour[grey];
        c->colour[grey] = colour;
    }
    if (differs != 0) {
        lm_damage_mark(&c->changed, &c->glass);
    }
}

static void take_changes(struct lm_composer *c)
{
    for (uint32_t age = 0; age < LM_AGES; age++) {
        lm_damage_add(&c->since[age], &c->changed);
    }
    lm_damage_add(&c->due, &c->changed);
    lm_damage_clear(&c->changed);
}

static uint32_t count_blocks(uint64_t blocks)
{
    uint32_t count = 0;
    for (; blocks != 0; blocks &= blocks - 1) {
        count++;
    }
    return count;
}

/* Move bands from what is due to the step's part, until they have `pixels` or all were looked at.
 * Each step goes on where the one before ended, so that what changes in every step does not keep
 * the rest waiting. */
static void take_part(struct lm_composer *c, uint32_t pixels)
{
    uint32_t taken = 0;
    lm_damage_clear(&c->part);
    for (uint32_t n = 0; n < LM_BANDS && taken < pixels; n++) {
        const uint64_t blocks = c->due.band[c->band];
        c->part.band[c->band] = blocks;
        c->due.band[c->band] = 0;
        taken += count_blocks(blocks) * BLOCK_PX;
        c->band = (c->band + 1) % LM_BANDS;
    }
}

static void compose_plane(const struct lm_composer *c, const struct lm_plane *plane)
{
    struct lm_rectangle r;
    struct lm_damage_walk walk = lm_damage_walk(&c->glass);
    while (lm_damage_next(&c->part, &walk, &r)) {
        for (int32_t y = r.top; y < r.bottom; y++) {
            compose_row(c->surface.pixels + (uint32_t)y * c->surface.stride_px + r.left,
                        plane->pixels + (uint32_t)y * plane->width_px + r.left, c->colour,
                        (uint32_t)(r.right - r.left));
        }
    }
}

uint32_t lm_composer_take(struct lm_composer *c, const struct lm_palette *palette)
{
    uint32_t blocks = 0;
    take_colours(c, palette);
    take_changes(c);
    for (uint32_t band = 0; band < LM_BANDS; band++) {
        blocks += count_blocks(c->due.band[band]);
    }
    return blocks * BLOCK_PX;
}

bool lm_composer_run(struct lm_composer *c, const struct lm_plane *plane, uint32_t pixels)
{
    take_changes(c);
    take_part(c, pixels);
    if (plane) {
        compose_plane(c, plane);
    }
    lm_draw_list_paint(&c->list, &c->surface, &c->part);
    return lm_damage_is_empty(&c->due);
}

void lm_composer_finish(struct lm_composer *c)
{
    c->is_lent = false;
    for (uint32_t age = LM_AGES - 1; age > 0; age--) {
        c->since[age] = c->since[age - 1];
    }
    lm_damage_clear(&c->since[0]);
}
