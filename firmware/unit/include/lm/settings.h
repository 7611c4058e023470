/* Settings: what an operator has selected on a display, for another display (lm/swap.h). Its bytes
 * are those of docs/bus.md, "Two displays". */
#ifndef LM_SETTINGS_H
#define LM_SETTINGS_H

#include "lm/page.h"

struct lm_settings {
    uint8_t page[LM_PAGE_BYTES]; /* lm_page_bytes */
    uint32_t hidden;             /* of the page; and bits 24 to 26: cursor placed, home, snowplow */
    int32_t tilt_tenths;         /* of the page */
    struct lm_position centre;   /* of the patch */
    uint32_t cell_mm;            /* of the patch; without one, of the page */
    fx_bam_t look_azimuth;       /* of the patch, as its range and height */
    uint32_t range_m;
    int32_t height_m_q6;
    struct lm_position cursor;
};

enum { LM_SETTINGS_BYTES = 64 };

#endif
