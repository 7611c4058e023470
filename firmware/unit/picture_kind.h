/* What a kind of picture has to bring: the functions behind lm/picture.h. */
#ifndef LM_PICTURE_KIND_H
#define LM_PICTURE_KIND_H

#include "lm/picture.h"

enum lm_sweep {
    LM_SWEEP_GOES_ON,
    LM_SWEEP_BEGUN,
    LM_SWEEP_BEGUN_AT_COST /* its geometry was work enough for a step */
};

/* None of these calls back into lm/picture.h: the stack stays bounded. Called once a line, a step
 * or a picture, never for a cell or a pixel. */
struct lm_picture_methods {
    bool moves; /* as lm_picture_moves says */

    /* Take the request. False: it cannot be made, and *p is unchanged. */
    bool (*start)(struct lm_picture *p, const struct lm_sar_command *patch, uint64_t now_us);

    /* Go back to the first line, where the picture has one. */
    void (*restart)(struct lm_picture *p);

    void (*prefetch)(struct lm_picture *p);
    bool (*is_ready)(struct lm_picture *p, uint64_t now_us);

    /* Begin the sweep that the next line belongs to, where that is due: the view is then another.
     */
    enum lm_sweep (*begin)(struct lm_picture *p, uint64_t now_us);

    /* Take samples that the next line needs. True when it has all; until then next_line_us may be
     * put off. */
    bool (*sample_ahead)(struct lm_picture *p, uint64_t now_us, uint32_t *azimuths);

    /* Draw the next line into p->line.grey. Returns its number. */
    uint32_t (*draw_line)(struct lm_picture *p, uint64_t now_us);

    /* Paint p->line.grey, line `number`, into the plane. */
    void (*paint)(struct lm_picture *p, uint32_t number);

    /* From a line to the next, microseconds. */
    uint64_t (*line_us)(const struct lm_picture *p);

    void (*set_beam)(struct lm_picture *p);
    struct lm_view (*view)(const struct lm_picture *p);
    const struct lm_tone_config *(*tone)(const struct lm_picture *p); /* of the radar table */
    uint32_t (*slew_percent)(const struct lm_picture *p); /* lm/cursor.h: lm_cursor_scene */
    bool (*needs_ownship)(const struct lm_picture *p);
    void (*describe)(const struct lm_picture *p, struct lm_symbols *symbols);
};

extern const struct lm_picture_methods lm_picture_sector, lm_picture_patch;

#endif
