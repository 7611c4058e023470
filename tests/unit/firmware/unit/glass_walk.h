/* A unit in flight whose glass is of any size, and which texts are on it. A test that uses it is
 * linked with --wrap=lm_draw_text. */
#ifndef GLASS_WALK_H
#define GLASS_WALK_H

#include "glass_text.h"
#include "unit_rig.h"

enum { WALK_TEXTS = 100 };

/* A text of the frame drawn last: its words and the pixels from its first to behind its last. */
struct walk_text {
    char words[48];
    int32_t left, top, right, bottom;
};

struct walk {
    struct rig *rig;
    int32_t side_px;
    uint32_t *glass; /* side_px * side_px */
    uint8_t *plane;
    uint8_t *is_text; /* of each pixel: a text or the dot of ground around it stands there */
    struct walk_text text[WALK_TEXTS];
    uint32_t texts;
};

/* A unit on a square glass, in good flight at 10 nm. One walk takes part in a call of run at a
 * time: the one begun or run last. */
struct walk *walk_begin(uint16_t side_px, const struct lm_glass_options *options);
void walk_end(struct walk *w);

int32_t walk_dot_px(const struct walk *w);

/* Whether a text of the frame on the glass, or the ground around it, is on this pixel. */
bool walk_has_text(const struct walk *w, int32_t x, int32_t y);

/* Whether a text of the frame on the glass is or holds these words. */
bool walk_says(const struct walk *w, const char *words);

#endif
