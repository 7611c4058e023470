/* What page.c (keys) and labels.c share: which key is which, and what the rotaries offer. */
#ifndef LM_PAGE_KEYS_H
#define LM_PAGE_KEYS_H

#include "lm/page.h"

/* Keys by what stands beside them. */
enum {
    OSB_MODE = 1,
    OSB_AUTO = 2,
    OSB_FIELD = 3,
    OSB_OVERRIDE = 4,
    OSB_CNTL = 5,
    OSB_BARO = 6,
    OSB_FREEZE = 7,
    OSB_SNOWPLOW = 8,
    OSB_CURSOR_ZERO = 9,
    OSB_STEERPOINT = 10,
    OSB_DECLUTTER = 11,
    OSB_BIT = 12,
    OSB_RADAR = 13,
    OSB_TEST = 14,
    OSB_SWAP = 15,
    OSB_CELL = 16,
    OSB_AZIMUTH = 18,
    OSB_RANGE_DOWN = 19,
    OSB_RANGE_UP = 20,

    /* On the control page. */
    OSB_TILT = 1,
    OSB_TILT_UP = 2,
    OSB_TILT_DOWN = 3,
    OSB_BEAM = 4,
    OSB_BLACK_UP = 6,
    OSB_BLACK_DOWN = 7,
    OSB_TINT = 8,
    OSB_NIGHT = 9,
    OSB_RESET = 10,
    OSB_SLANT = 16,
    OSB_WHITE_DOWN = 17,
    OSB_WHITE_UP = 18,
    OSB_GAMMA_DOWN = 19,
    OSB_GAMMA_UP = 20
};

#define LM_OSB_BIT(osb) (1u << ((osb)-1))

/* Cells of a patch. */
struct lm_page_cell {
    uint32_t mm;
    char label[6];
};
extern const struct lm_page_cell lm_page_cells[LM_SAR_CELLS_OFFERED];

#endif
