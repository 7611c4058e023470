#include "lm/composer.h"

#include "fx/mem.h"
#include "fx/sat.h"

enum { BLOCK_PX = LM_BLOCK_WIDTH_PX * LM_BLOCK_HEIGHT_PX };

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

/* Set what the kernel reads beside the colours. */
static void describe_colours(struct lm_k_colours *c)
{
    uint32_t tinted = 0;
    for (uint32_t grey = 0; grey < LM_K_GREYS; grey++) {
        const uint32_t colour = c->of_grey[grey], parts = colour >> c->shift;
        for (uint32_t k = 0; k < LM_K_COLOUR_BYTES; k++) {
            c->byte[k][grey] = (uint8_t)(colour >> 8 * k);
        }
        tinted |= parts ^ (parts & 255) * 0x10101u;
    }
    c->is_neutral = tinted == 0;
}

/* Take the palette's colours. Other ones change the whole glass. */
static void take_colours(struct lm_composer *c, const struct lm_palette *palette)
{
    uint32_t differs = 0;
    for (uint32_t grey = 0; grey < LM_K_GREYS; grey++) {
        const uint32_t colour = palette->picture[grey] << c->surface.shift;
        differs |= colour ^ c->colours.of_grey[grey];
        c->colours.of_grey[grey] = colour;
    }
    if (differs != 0) {
        c->colours.shift = c->surface.shift;
        describe_colours(&c->colours);
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
        const struct lm_k_area area = {
            .grey = plane->pixels + (uint32_t)r.top * plane->width_px + r.left,
            .pixel = c->surface.pixels + (uint32_t)r.top * c->surface.stride_px + r.left,
            .grey_stride = plane->width_px,
            .pixel_stride = c->surface.stride_px,
            .width = (uint32_t)(r.right - r.left),
            .height = (uint32_t)(r.bottom - r.top)};
        lm_k_colour_area(&c->colours, &area);
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
