/* Symbols and text over the radar picture, and the picture itself through its palette. */
#ifndef LM_OVERLAY_H
#define LM_OVERLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/port.h"
#include "lm/scan_conv.h"

/* What the page shows. Bits of `flags`; each has its word on the glass. */
enum lm_flag {
    LM_FLAG_NAV_STALE = 1 << 0, /* position too old: the sweep stands still */
    LM_FLAG_NAV_DEAD = 1 << 1,  /* no position: the picture is removed */
    LM_FLAG_DB = 1 << 2,        /* no usable database: nothing to show */
    LM_FLAG_TILE = 1 << 3,      /* map records failed within the last seconds: parts are coarse */
    LM_FLAG_BUS = 1 << 4,       /* the bus is down or silent */
    LM_FLAG_FROZEN = 1 << 5,    /* by the operator */
    LM_FLAG_OFF_MAP = 1 << 6    /* most of the picture lies outside the map */
};

struct lm_page {
    uint32_t flags;
    bool is_sar;
    bool is_sweeping;
    int32_t sweep_bam;     /* antenna from the nose, right positive */
    fx_bam_t azimuth_half; /* of the sector */
    uint16_t range_nm;
    uint8_t azimuth_tens; /* 6, 3, 1 */
    fx_bam_t heading;
    bool has_heading;
    uint16_t sar_cell_dm;  /* cell of the patch */
    uint16_t sar_percent;  /* of the lines drawn */
    uint16_t sar_look_deg; /* line of sight */
    uint32_t frame;        /* turns the mark that shows the display is alive */
};

/* Fill the whole surface: the plane through a grey palette, then the symbols. The surface is as
 * large as the plane. Cost: about 4 instructions a pixel. */
void lm_overlay_draw(const struct lm_surface *surface, const struct lm_plane *plane,
                     const struct lm_frame *frame, const struct lm_page *page);

#endif
