/* Exports: what the module offers to JavaScript, and asks of it. Numbers of more than 32 bits are
 * doubles, which hold whole numbers up to 2^53. Pointers are offsets in the module's memory.
 *
 * The order of calls: open, once or again until the flash has what it reads; then, for each step,
 * frame and the acts of the operator, step; paint whenever value(WEB_PICTURES) has grown. */
#ifndef WEB_EXPORTS_H
#define WEB_EXPORTS_H

#include <stdbool.h>
#include <stdint.h>

#define WEB_EXPORT(name)            __attribute__((export_name(name)))
#define WEB_IMPORT(name)            WEB_IMPORT_OF("flash", name)
#define WEB_IMPORT_OF(module, name) __attribute__((import_module(module), import_name(name)))

/* Begin to copy bytes of the flash to an address: an answer of read_start in lm/port.h. */
WEB_IMPORT("start") int web_flash_start(double offset, void *to, uint32_t length);

/* Ask for the end: an answer of read_poll in lm/port.h. */
WEB_IMPORT("poll") int web_flash_poll(void);

enum { WEB_LINE_OVER = -1, WEB_LINE_TORN = -2, WEB_LINE_BAD = -3 };

/* The next line of a recording: copies at most `room` characters without the line's end, and
 * returns how many; WEB_LINE_OVER behind the last one; WEB_LINE_TORN if that has no end;
 * WEB_LINE_BAD if it is longer, or no text. */
WEB_IMPORT_OF("recording", "line") int web_recording_line(char *to, uint32_t room);

/* Start the unit, anew if there was one, with a flash of so many bytes and a glass of 256..1024
 * pixels a side. Reads what the unit needs at once; each read has one poll. Returns an answer of
 * lm_unit_init: LM_OK also if the image could not be read; WEB_IS_MAP_USABLE then is 0. */
int web_open(double flash_bytes, uint32_t width_px, uint32_t height_px);

/* One step of the unit, at a time in microseconds that never goes back. */
void web_step(double now_us);

/* Hand over a frame for the next step; data bytes 0..3 and 4..7 in two words, the lowest first.
 * False, and counted, if 512 wait already or it is longer than 8 bytes. */
bool web_frame(uint32_t id, bool is_extended, uint32_t length, uint32_t first, uint32_t second,
               double time_us);

/* Acts of the operator, as in lm/controls.h. More than 64 in a step are dropped and counted. */
void web_button(bool is_down, int32_t number);
void web_knob(int32_t deflection);
void web_slew(int32_t x, int32_t y);
void web_designate(void);
void web_drop(void);

/* Draw a patch around a place, given in binary angles (lm/geo.h), with cells of so many mm. */
void web_patch(uint32_t latitude, uint32_t longitude, uint32_t cell_mm);

/* The picture shown last, four bytes a pixel, red first, without gaps between rows. Only what
 * changed since the last call is copied. */
uint8_t *web_paint(void);

/* CRC-32C of that picture as the firmware has it: four bytes a pixel, blue, green, red, 0. */
uint32_t web_checksum(void);

/* ---- replay: instead of open, frame, the acts and step ----
 *
 * Open the recording whose lines web_recording_line gives, over a flash of so many bytes whose
 * reads are never late. Returns an answer of lm_unit_init; or LM_ERR_RANGE with the cause in
 * web_replay_error: no recording, or one of another firmware, image, bus table or radar. With
 * is_any these may differ. */
int web_replay_open(double flash_bytes, bool is_any);

/* The next step of the recording; returns its time in microseconds. -1 at the end, also if lines
 * have yet to come: a growing recording may be stepped while WEB_STEPS_READ is 2 or more, or while
 * the rest of what happened in the step is there, which a later line of steps shows. */
double web_replay_step(void);

/* Why the replay could not begin, or ended early; empty: it did not. */
const char *web_replay_error(void);

enum { WEB_MODE_PATCH = 4 };

/* What a page may ask for; all are whole numbers. */
enum web_value {
    WEB_PICTURES, /* shown since open */
    WEB_FLAGS,    /* enum lm_flag */
    WEB_MODE,     /* enum lm_sector_mode, or WEB_MODE_PATCH */
    WEB_FOV,      /* enum lm_fov */
    WEB_RANGE_NM, /* scale */
    WEB_CURSOR_LATITUDE,
    WEB_CURSOR_LONGITUDE, /* binary angles */
    WEB_IS_CURSOR_PLACED,
    WEB_FRAMES_LOST,
    WEB_ACTS_LOST,
    WEB_LINES_DROPPED,
    WEB_IS_FORMAT_RADAR, /* the radar page is shown, and no other */
    WEB_IS_MAP_USABLE,   /* the image was read, and can be used */
    WEB_REFUSED,         /* controls with a value out of range, or not possible then */
    /* Of a replay: */
    WEB_WIDTH_PX,
    WEB_HEIGHT_PX,
    WEB_STEPS,
    WEB_STEPS_READ, /* of the line of steps read last, how many are left */
    WEB_DEPARTURES, /* struct replay */
    WEB_CHECKS,
    WEB_CHECKS_FAILED,
    WEB_READS_DIFFER,
    WEB_HAS_ENDED,
    WEB_IS_OTHER_BUILD, /* recorded by another build of this firmware */
    WEB_CEASED          /* enum record_reason: the recorder gave up at the end; or 0 */
};

/* A value, or -1 if there is none of that number. */
double web_value(enum web_value which);

/* The word of a flag's bit, of at most eight characters and a zero, or NULL. */
const char *web_flag_word(uint32_t number);

#endif
