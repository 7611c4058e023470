/* Picture kind: the functions that a kind of picture implements behind lm/picture.h. */
#ifndef LM_PICTURE_KIND_H
#define LM_PICTURE_KIND_H

#include "lm/picture.h"

enum lm_sweep {
    LM_SWEEP_GOES_ON,
    LM_SWEEP_BEGUN,
    LM_SWEEP_BEGUN_AT_COST /* this part of its beginning took the time of a step */
};

/* Methods. They are called once a line, a step or a picture, never for a cell or a pixel. They must
 * not call the functions of lm/picture.h, so that the stack stays bounded. */
struct lm_picture_methods {
    bool moves; /* result of lm_picture_moves */

    /* Take the request, as lm_picture_start says. If it is refused, *p is unchanged. */
    enum lm_refusal (*start)(struct lm_picture *p, const struct lm_sar_command *patch,
                             uint64_t now_us);

    /* Go back to the first line, in a picture that has a first line. */
    void (*restart)(struct lm_picture *p);

    /* As lm_picture_prefetch and lm_picture_is_ready. */
    void (*prefetch)(struct lm_picture *p);
    bool (*is_ready)(struct lm_picture *p, uint64_t now_us);

    /* Begin a sweep if the next line is its first one. The view has then changed. A beginning of
     * several parts is called once for each of them. */
    enum lm_sweep (*begin)(struct lm_picture *p, uint64_t now_us);

    /* Trace samples that the next line needs, within *azimuths. True if it has all. False: more are
     * needed, and next_line_us may have been put off. */
    bool (*sample_ahead)(struct lm_picture *p, uint64_t now_us, uint32_t *azimuths);

    /* Draw the next line into p->line.grey. Returns the line's number. */
    uint32_t (*draw_line)(struct lm_picture *p, uint64_t now_us);

    /* Paint p->line.grey, line `number`, into the plane. */
    void (*paint)(struct lm_picture *p, uint32_t number);

    /* Time from a line to the next. */
    uint64_t (*line_us)(const struct lm_picture *p);

    void (*set_beam)(struct lm_picture *p);
    struct lm_view (*view)(const struct lm_picture *p);
    const struct lm_tone_config *(*tone)(
        const struct lm_picture *p);                      /* borrowed, of the radar table */
    uint32_t (*slew_percent)(const struct lm_picture *p); /* as in struct lm_cursor_scene */
    bool (*needs_ownship)(const struct lm_picture *p);
    void (*describe)(const struct lm_picture *p, struct lm_symbols *symbols);
};

extern const struct lm_picture_methods lm_picture_sector, lm_picture_patch;

#endif
