/* Glass options: choices about the glass that a board makes when it is installed. All false is the
 * delivered glass. docs/guide.md, "The glass", shows them. */
#ifndef LM_GLASS_OPTIONS_H
#define LM_GLASS_OPTIONS_H

#include <stdbool.h>

struct lm_glass_options {
    bool
        is_sector_whole; /* the first format: the whole sector of +-60 degrees fits the frame;
                          * false: its radius is the frame's height, and the frame cuts its wings */
    bool has_heading;    /* the heading is written above the picture */
    bool has_strobe;     /* a faint line lies along the beam */
    bool has_borders;    /* lines along the sector's edges */
};

#endif
