/* Page: what the operator has selected, what each button means, and what its label says. It does
 * not draw. docs/guide.md, "The page", shows the keys; each page is a table of keys in
 * firmware/page/page_*.c. lm/controls.h draws the numbers of the keys around the glass. */
#ifndef LM_PAGE_H
#define LM_PAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/keys.h"
#include "lm/palette.h"
#include "lm/radar.h"
#include "lm/sar_command.h"

/* Formats: what the page shows. */
enum lm_format {
    LM_FORMAT_RADAR,
    LM_FORMAT_CNTL, /* settings, over the radar picture */
    LM_FORMAT_DCLT, /* which labels declutter takes away, over the radar picture */
    LM_FORMAT_BIT,  /* built-in test: text instead of the picture */
    LM_FORMAT_TEST, /* test pattern */
    LM_FORMATS
};

/* Effects: what a press or a command asks of the unit, bits. */
enum lm_effect {
    LM_EFFECT_SECTOR = 1 << 0,  /* start a sector with the page's mode, field of view and scales */
    LM_EFFECT_PATCH = 1 << 1,   /* start the patch again with the page's cell and geometry */
    LM_EFFECT_TONE = 1 << 2,    /* take the page's gain, knob and tone settings */
    LM_EFFECT_PALETTE = 1 << 3, /* take the page's palette settings */
    LM_EFFECT_CURSOR_HOME = 1 << 4, /* put the cursor home */
    LM_EFFECT_SNOWPLOW = 1 << 5,    /* switch snowplow on or off */
    LM_EFFECT_SWAP = 1 << 6,        /* exchange this display's page with the other's */
    LM_EFFECT_BEAM = 1 << 7,        /* take the page's tilt and beam shape */
    LM_EFFECT_HEIGHT = 1 << 8,      /* take the page's choice of height */
    LM_EFFECT_RANGE = 1 << 9,       /* the range scale changed */
    LM_EFFECT_TRACK = 1 << 10,      /* track what is at the cursor, or end the track */
    LM_EFFECT_RANGING = 1 << 11     /* range the ground ahead, or end that */
};

enum {
    LM_GAIN_MAX_DB = 30,   /* gain is within +- this */
    LM_KNOB_FULL_Q8 = 405, /* 1.58 dB, which is +-20 % of amplitude, at full deflection */
    LM_WINDOW_MAX_DB = 20, /* black and white may be moved by +- this */
    LM_GAMMA_MAX = 10      /* display gamma may be moved by +- this, in tenths */
};

/* The operator's selection: kind of picture, mode, field of view, scales, freeze and the settings
 * of the control page. It is kept nowhere else. Everybody may read it; only the functions below
 * change it. */
struct lm_page {
    const struct lm_radar *radar; /* borrowed; keeps its contract (lm/radar_check.h) */
    /* Bytes of lm_page_bytes, in this order, up to the freeze. */
    uint8_t format;        /* enum lm_format */
    uint8_t picture;       /* enum lm_picture_kind */
    uint8_t mode;          /* of the sector: enum lm_sector_mode */
    uint8_t fov;           /* of the sector: enum lm_fov, one that the mode has */
    uint8_t range_index;   /* row of the radar table's scales, 0..lm_page_range_last */
    uint8_t azimuth_index; /* index of the radar table's sectors, 0..LM_AZIMUTHS - 1 */
    bool is_baro;          /* the barometric height is used, if there is one */
    bool is_plan;          /* a patch is shown as a plan, without layover */
    bool is_tilt_manual;   /* the operator, not the radar, sets the tilt */
    bool is_pencil;        /* the beam is not spoiled into a fan */
    bool is_auto_range;    /* the scale follows the cursor */
    bool is_override;      /* the transmitter is silent */
    bool is_snowplow;      /* the cursor stays ahead of the aircraft */
    bool is_decluttered;   /* the labels in `hidden` are not shown on the radar page */
    int8_t gain_db;        /* added to the picture's level, -LM_GAIN_MAX_DB..LM_GAIN_MAX_DB */
    int8_t black_db;       /* added to the table's black, -LM_WINDOW_MAX_DB..LM_WINDOW_MAX_DB */
    int8_t white_db;       /* added to the table's white, -LM_WINDOW_MAX_DB..LM_WINDOW_MAX_DB */
    int8_t gamma_tenths;   /* added to the table's gamma, -LM_GAMMA_MAX..LM_GAMMA_MAX */
    struct lm_palette_config palette;
    bool is_frozen; /* the picture is held, and the aircraft moves over it */

    uint8_t track;       /* a track is on: its kind, 1.. (lm/track.h); 0: none */
    int16_t tilt_tenths; /* of the beam's axis, tenths of a degree up */
    int16_t knob;        /* deflection of the knob, -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION */
    uint32_t cell_mm;    /* of the patch: the next one's, if this one cannot have it */
    uint32_t hidden;     /* bit n - 1: declutter takes OSB n's label away */
};

/* Set the page as after power-up: the first mode, NORM, the radar table's initial scale and first
 * sector width, manual range, automatic tilt. `radar` stays borrowed as long as the page is
 * used. */
void lm_page_init(struct lm_page *p, const struct lm_radar *radar);

/* The style of button 1..LM_BUTTONS on the page that is shown. */
enum lm_key_style lm_page_key_style(const struct lm_page *p, uint8_t button);

/* Carry out a press of a button 1..LM_BUTTONS. Returns the effects; 0 if the button is free on this
 * page, or its value is at the end of its range. */
uint32_t lm_page_press(struct lm_page *p, struct lm_press press);

/* Index of the largest scale that the page's mode and field of view have. */
uint8_t lm_page_range_last(const struct lm_page *p);

/* One scale up (1) or down (-1), as an automatic range does. Returns the effects. */
uint32_t lm_page_step_range(struct lm_page *p, int32_t step);

/* Direct commands of a script or an instructor's station. Each returns its effects, which are not
 * 0. It returns 0, and the page is unchanged, iff an argument is outside its range:
 * - select_range: the nautical miles of a scale that mode and field of view have. It ends the
 *   automatic range;
 * - select_azimuth: 0..LM_AZIMUTHS - 1;
 * - select_sector: mode 0..LM_SECTOR_CHOICES - 1, field of view 0..fov_last of that mode, which
 * both have the present range scale;
 * - set_gain: -LM_GAIN_MAX_DB..LM_GAIN_MAX_DB;
 * - set_knob: -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION. */
uint32_t lm_page_select_range(struct lm_page *p, int32_t range_nm);
uint32_t lm_page_select_azimuth(struct lm_page *p, int32_t azimuth);
uint32_t lm_page_select_sector(struct lm_page *p, int32_t mode, int32_t fov);
uint32_t lm_page_set_gain(struct lm_page *p, int32_t gain_db);
uint32_t lm_page_set_knob(struct lm_page *p, int32_t knob);

/* Freeze the picture, or end the freeze. */
void lm_page_set_frozen(struct lm_page *p, bool is_frozen);

/* Set the kind of the picture that begins, and end a freeze. */
void lm_page_show_picture(struct lm_page *p, enum lm_picture_kind kind);

/* Take over the cell and the geometry of the patch that begins: a command may have chosen them. */
void lm_page_note_patch(struct lm_page *p, const struct lm_sar_command *patch);

/* Set the kind of the track that is on, 0 to 3. */
void lm_page_note_track(struct lm_page *p, uint8_t kind);

/* Set the tilt, signed BAM, that the radar chose. Ignored while the operator sets the tilt. */
void lm_page_note_tilt(struct lm_page *p, int32_t tilt);

/* The selection as bytes, for another display or for after a restart. */
enum {
    LM_PAGE_SHARED_BYTES = 18, /* what a page is, wherever it is shown */
    LM_PAGE_BYTES = 24         /* and the colours, which belong to the glass, and the freeze */
};

/* Write the bytes; true and false are 1 and 0, negative numbers two's complement. */
void lm_page_bytes(const struct lm_page *p, uint8_t byte[LM_PAGE_BYTES]);

/* True if each byte is within the range that stands beside its member, and this radar has the mode
 * with the field of view and the scale. */
bool lm_page_bytes_are_sound(const struct lm_page *p, const uint8_t byte[LM_PAGE_BYTES]);

/* Take the first `count` of sound bytes, all but the kind of the picture: that begins by
 * lm_picture_start. */
void lm_page_take(struct lm_page *p, const uint8_t byte[LM_PAGE_BYTES], uint32_t count);

/* Label: text beside a key, one or two lines of at most five characters. */
struct lm_label {
    char line[2][6];
    bool is_inverse;
};

/* The label of OSB 1..20 as shown now. False, and *label unspecified, if there is none. */
bool lm_page_label(const struct lm_page *p, uint8_t osb, struct lm_label *label);

/* The value between OSB `osb` and its partner, which these two keys change. The partner is `osb` -
 * 1 on the left edge and `osb` + 1 on the right one. False, and *value unspecified, if there is
 * none. */
bool lm_page_value(const struct lm_page *p, uint8_t osb, struct lm_label *value);

/* Tone of a picture: the radar table's, changed by gain, knob and settings. lm_tone_set accepts it
 * if the table keeps its contract. */
struct lm_tone_config lm_page_tone(const struct lm_page *p, const struct lm_tone_config *table);

#endif
