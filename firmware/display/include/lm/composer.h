/* Composer: puts together the glass: the plane through its palette, and what a list draws over it.
 * It composes only what the surface lent does not hold yet, and as much of it in a step as there is
 * time for. A picture is shown when it is complete: it is then the plane, palette and list of that
 * very step.
 *
 *     plane, list --marks--> changed --> since[0..2]   by age of the surface
 *                                    +-> due --a step's part--> surface
 *
 * The caller owns the composer; all fields are read-only to others, but that plane and list mark
 * `changed`. Nothing here fails. */
#ifndef LM_COMPOSER_H
#define LM_COMPOSER_H

#include "lm/draw_list.h"
#include "lm/kernels_display.h"
#include "lm/palette.h"
#include "lm/scan_conv.h"

struct lm_composer {
    struct lm_rectangle glass;
    struct lm_damage changed;        /* marked by plane and list, not taken yet */
    struct lm_damage since[LM_AGES]; /* since[k]: changed since the picture shown k + 1 ago */
    struct lm_surface surface;
    bool is_lent;                /* `surface` is */
    struct lm_damage due;        /* what it lacks */
    struct lm_damage part;       /* what a step composes of it */
    uint32_t band;               /* where the next step goes on */
    struct lm_k_colours colours; /* as they stand on the surface */
    struct lm_draw_list list;
};

/* Begin with a glass of that size, on which nothing was shown. */
void lm_composer_init(struct lm_composer *c, uint16_t width_px, uint16_t height_px);

/* Begin a picture on the surface, which the composer keeps until lm_composer_finish. */
void lm_composer_begin(struct lm_composer *c, const struct lm_surface *surface);

/* Take what changed so far, the palette's colours included. Returns the pixels that are due. Cost:
 * some 5,000 instructions. */
uint32_t lm_composer_take(struct lm_composer *c, const struct lm_palette *palette);

/* Compose what is due, the list as it was noted last over the plane, until `pixels` are done. The
 * plane is NULL if the list covers all of the glass. True if nothing is due any more. Cost: some
 * 5,000 instructions; 1 to 3 a pixel (lm_k_colour_area); and what the list draws there. */
bool lm_composer_run(struct lm_composer *c, const struct lm_plane *plane, uint32_t pixels);

/* The surface was presented: the next one is older by a picture. */
void lm_composer_finish(struct lm_composer *c);

#endif
