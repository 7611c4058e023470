/* Everything on the glass: the picture through its palette, symbols, labels, warnings and pages of
 * text. Looks at nothing but what it is given and remembers nothing. */
#ifndef LM_OVERLAY_H
#define LM_OVERLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/page.h"
#include "lm/port.h"
#include "lm/scan_conv.h"
#include "lm/text.h"
#include "lm/view.h"

/* What the glass says about the unit, bits. Each has its word. */
enum lm_flag {
    LM_FLAG_NAV_STALE = 1 << 0, /* position too old: the sweep stands still */
    LM_FLAG_NAV_DEAD = 1 << 1,  /* no position: the picture is removed */
    LM_FLAG_DB = 1 << 2,        /* no usable database: nothing to show */
    LM_FLAG_TILE = 1 << 3,      /* map records failed within the last seconds: parts are coarse */
    LM_FLAG_BUS = 1 << 4,       /* the bus is down or silent */
    LM_FLAG_FROZEN = 1 << 5,    /* by the operator */
    LM_FLAG_OFF_MAP = 1 << 6,   /* most of the picture lies outside the map */
    LM_FLAG_SILENT = 1 << 7,    /* not emitting, by the operator: the sweep stands still */
    LM_FLAG_UNABLE = 1 << 8,    /* the last patch asked for cannot be made */
    LM_FLAG_WEATHER = 1 << 9    /* the bus's weather was not told anew: it will be removed */
};
enum { LM_FLAGS = 10 };

/* The word of flag number 0..LM_FLAGS - 1, at most eight characters. */
const char *lm_flag_word(uint32_t number);

/* Longer than the read-out has room for: 100 minutes. */
enum { LM_TO_GO_NONE = 6000 };

/* The symbols of the radar picture. */
struct lm_symbols {
    struct lm_view view;
    bool is_sweeping;
    uint16_t range_nm;     /* of the sector */
    fx_bam_t azimuth_half; /* of the sector */
    int32_t antenna_azimuth,
        antenna_elevation; /* signed BAM: right of the nose, above the horizon */
    int32_t gain_db;

    fx_bam_t heading;
    bool has_heading;

    bool has_cursor, is_cursor_on_glass;
    struct lm_offset cursor;
    struct lm_position cursor_position;
    uint32_t cursor_range_m;
    fx_bam_t cursor_bearing;
    int32_t cursor_elevation_m_q10; /* metres * 1024 */
    bool has_cursor_elevation;

    bool has_steerpoint, is_steerpoint_on_glass;
    struct lm_point steerpoint;
    uint32_t to_go_s; /* to it; LM_TO_GO_NONE: not to be had */

    bool is_cue_shown; /* window: where the cursor would be in the whole sector */
    struct lm_point cue;
    bool is_finer_offered; /* window: show what the next field of view will cut out */

    bool is_ownship_shown; /* over a frozen picture */
    struct lm_offset ownship;
    fx_bam_t ownship_heading; /* from straight up */

    uint32_t patch_cell_mm;
    uint16_t patch_percent; /* of the lines drawn */
    uint32_t patch_to_go_s; /* dwell that is left; not written when 0 */
    fx_bam_t patch_look;    /* line of sight */
};

/* The glass and how it looks. All borrowed. */
struct lm_glass {
    struct lm_surface surface;
    const struct lm_frame *frame;
    const struct lm_palette *palette;
};

/* Fill the whole surface: the plane, which is as large, through the palette; or nothing.
 * Cost: 3 instructions a pixel, and one where it is black. */
void lm_overlay_picture(const struct lm_glass *g, const struct lm_plane *plane);
void lm_overlay_blank(const struct lm_glass *g);

void lm_overlay_symbols(const struct lm_glass *g, const struct lm_symbols *symbols);
void lm_overlay_labels(const struct lm_glass *g, const struct lm_page *page);

/* The words of `flags`, one below the other from the top of the frame. */
void lm_overlay_warnings(const struct lm_glass *g, uint32_t flags);

/* A hand that turns one eighth with every picture: when it stands, the display has stopped. */
void lm_overlay_alive(const struct lm_glass *g, uint32_t picture);

/* Row 0.. of a page of text. Every glass has room for 20 rows of 34 characters. */
void lm_overlay_row(const struct lm_glass *g, uint32_t row, const char *words);

/* Grey steps, geometry, every colour and every character. */
void lm_overlay_test_pattern(const struct lm_glass *g);

#endif
