/* Overlay: everything drawn over the picture: symbols, labels, warnings and pages of text. It
 * remembers nothing and nothing fails. All pointers are borrowed for the call.
 *
 * lm/controls.h draws where the option select buttons (OSB) stand around the glass.
 */
#ifndef LM_OVERLAY_H
#define LM_OVERLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/glass_options.h"
#include "lm/page.h"
#include "lm/port.h"
#include "lm/scan_conv.h"
#include "lm/text.h"
#include "lm/view.h"

/* Flags: states of the unit that the glass shows in a word each; bits. */
enum lm_flag {
    LM_FLAG_NAV_STALE = 1 << 0, /* position too old: the sweep stands still */
    LM_FLAG_NAV_DEAD = 1 << 1,  /* no position: the picture is removed */
    LM_FLAG_DB = 1 << 2,        /* no usable database: nothing to show */
    LM_FLAG_TILE = 1 << 3,      /* map records failed within the last seconds, a read does not end,
                                   or one of several images is refused: parts are coarse */
    LM_FLAG_BUS = 1 << 4,       /* the bus is down or silent */
    LM_FLAG_FROZEN = 1 << 5,    /* the operator holds the picture */
    LM_FLAG_OFF_MAP = 1 << 6,   /* most of the picture lies outside the map */
    LM_FLAG_SILENT = 1 << 7,    /* the operator silences the radar: the sweep stands still */
    LM_FLAG_UNABLE = 1 << 8,    /* the last patch asked for cannot be made */
    LM_FLAG_WEATHER = 1 << 9,   /* the bus's weather is stale and will be removed */
    LM_FLAG_BELOW = 1 << 10,    /* the aircraft is below the map's terrain */
    LM_FLAG_MAGNETIC = 1 << 11, /* the heading is from magnetic north, and there is no variation */
    LM_FLAG_EXERCISE = 1 << 12, /* the sender of the exercise is silent: its clock runs on by
                                   itself, its malfunctions will end, or its live targets go */
    LM_FLAG_SENDER = 1 << 13,   /* a sender of the bus is stuck, has a rival, or is contradicted */
    LM_FLAG_MALFUNCTION = 1 << 14, /* the exercise has broken something: not written over the
                                      picture */
    LM_FLAG_RESTART = 1 << 15,     /* the display has restarted */
    LM_FLAG_UNSIGNED = 1 << 16,    /* the board does not know who made the database */
    LM_FLAG_POLE = 1 << 17         /* too near to a pole: the picture is removed */
};
enum { LM_FLAGS = 18 };

/* The word of flag `number`, 0..LM_FLAGS - 1, which is the number of its bit: at most eight
 * characters, in static memory. */
const char *lm_flag_word(uint32_t number);

/* Time to go that is unknown, or 100 minutes and longer, for which the read-out has no room. */
enum { LM_TO_GO_NONE = 6000 };

/* Shape of what marks a track. */
enum lm_track_shape { LM_SHAPE_NONE, LM_SHAPE_FILLED, LM_SHAPE_HOLLOW, LM_SHAPE_CROSS };

/* The symbols of the radar picture: which are shown, where, and with which numbers. */
struct lm_symbols {
    struct lm_view view;
    struct lm_glass_options options;
    bool is_sweeping;          /* the beam and the antenna's marks are drawn */
    uint16_t range_nm;         /* range scale of the sector */
    fx_bam_t azimuth_half;     /* half the width of the sector */
    int32_t antenna_azimuth;   /* signed BAM, to the right of the nose */
    int32_t antenna_elevation; /* signed BAM, above the horizon */
    int32_t gain_db;           /* -LM_GAIN_MAX_DB..LM_GAIN_MAX_DB */

    fx_bam_t heading; /* of the aircraft, from north */
    bool has_heading;

    bool has_cursor;         /* its numbers are written */
    bool is_cursor_on_glass; /* it is drawn */
    struct lm_offset cursor;
    struct lm_position cursor_position;
    uint32_t cursor_range_m; /* from the ownship */
    fx_bam_t cursor_bearing; /* from the ownship, from north */
    int32_t cursor_elevation_m_q10;
    bool has_cursor_elevation;

    bool has_steerpoint;         /* the time to go is written */
    bool is_steerpoint_on_glass; /* the steerpoint is drawn */
    struct lm_point steerpoint;
    uint32_t to_go_s; /* to the steerpoint; or LM_TO_GO_NONE */

    enum lm_track_shape track_shape;
    struct lm_point track;
    bool has_track_course; /* a line shows it */
    fx_bam_t track_course; /* clockwise from straight up */
    struct lm_text track_words;

    bool is_cue_shown;     /* window: `cue` is drawn */
    struct lm_point cue;   /* where the cursor would be in the whole sector */
    bool is_finer_offered; /* window: mark what the next field of view will cut out */

    uint32_t coarse_mm; /* length of the map's cells where the picture's are shorter; 0: not written
                         */

    bool is_ownship_shown; /* over a picture that stands */
    struct lm_offset ownship;
    fx_bam_t ownship_heading; /* clockwise from straight up */

    uint32_t patch_cell_mm;
    uint16_t patch_percent; /* of the patch's lines that are drawn */
    uint32_t patch_to_go_s; /* dwell that is left; 0 is not written */
    fx_bam_t patch_look;    /* azimuth of the line of sight, from north */
};

/* Glass: what is drawn on, and in which colours. */
struct lm_glass {
    struct lm_surface surface;
    const struct lm_frame *frame;
    const struct lm_palette *palette;
    struct lm_draw_list *list; /* notes what is drawn; NULL: it is drawn at once */
};

/* Fill the surface with the palette's ink: the ground of a page of text. */
void lm_overlay_blank(const struct lm_glass *g);

/* Draw the symbols of the radar picture, none beyond the frame, and write its numbers above and
 * below the frame. */
void lm_overlay_symbols(const struct lm_glass *g, const struct lm_symbols *symbols);

/* Draw the labels of all keys, and the values between them. */
void lm_overlay_labels(const struct lm_glass *g, const struct lm_page *page);

/* Reasons that are written below the word of their flag; "" for none. Borrowed. */
struct lm_warning_reasons {
    const char *database, *unable, *exercise, *sender; /* of LM_FLAG_DB, _UNABLE, _EXERCISE, _SENDER
                                                        */
};

/* Write the words of `flags` (enum lm_flag) below each other, from the top of the frame. */
void lm_overlay_warnings(const struct lm_glass *g, uint32_t flags,
                         const struct lm_warning_reasons *reasons);

/* Draw a hand that turns one eighth with every frame, in the lower right corner. A hand that stands
 * still shows that the display has stopped. */
void lm_overlay_alive(const struct lm_glass *g, uint32_t picture);

/* Write row `row`, from 0, of a page of text. The smallest glass has room for 20 rows of 34
 * characters. */
void lm_overlay_row(const struct lm_glass *g, uint32_t row, const char *words);

/* Draw the test pattern: greys, geometry, every colour and every character. */
void lm_overlay_test_pattern(const struct lm_glass *g);

#endif
