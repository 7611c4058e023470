/* Recording of a flight: everything that a board gives its unit, so that the unit shows the same
 * again, bit for bit, on any machine (docs/FORMATS.md, "Recordings").
 *
 * A unit is a function of its board's settings, of the image, of the times of its steps, and of
 * what the ports answer. The recorder stands between a board's ports and the unit and writes those
 * answers down, in the order of the calls, as lines of a candump log. What follows from the rest is
 * not written: the bytes of the flash, the pictures.
 *
 *     record_begin(&r, &sink, &board, zero_us);    before lm_unit_init: it exchanges the ports
 *     lm_unit_init(&unit, &board);
 *     for (;;) { record_step(&r, now_us); lm_unit_step(&unit, now_us); }
 *     record_end(&r); */
#ifndef RECORD_H
#define RECORD_H

#include <stddef.h>

#include "lm/unit.h"

enum {
    RECORD_VERSION = 2,
    RECORD_ID = 0x1F4C4D00,  /* identifier of the recorder's own frames, of 29 bits, plus one of: */
    RECORD_HEAD = 0,         /* blob: the head, a text */
    RECORD_STEPS = 1,        /* times of steps */
    RECORD_CONTROL = 2,      /* blob: a control that the unit took */
    RECORD_READS = 3,        /* reads of the flash that ended well in this step */
    RECORD_READ_FAILED = 4,  /* one that ended badly */
    RECORD_READ_REFUSED = 5, /* one that could not be started */
    RECORD_WAITS = 6,        /* polls of a read at the start that found it under way */
    RECORD_BUS_DOWN = 7,     /* an interface answered that it is down: which */
    RECORD_UNSENT = 8,       /* a frame that the bus did not take: its answer */
    RECORD_ACQUIRE = 9,      /* what the display answers from now on, and the age of its buffers */
    RECORD_PRESENT = 10,     /* the same of pictures presented */
    RECORD_CHECK = 11,       /* checksum of some rows of a picture presented */
    RECORD_PART = 12,        /* a part of a recording begins: its number */
    RECORD_END = 13,         /* the recording ends in good order */
    RECORD_VOICE = 14, /* whether the bus can be sent to, from this step on; not before the first */
    RECORD_NODES = 15, /* blob: the nodes that are heard, where not all are */
    RECORD_RESTART = 16, /* blob: the cause of the restart, where it is learnt after the start */
    RECORD_CEASED = 17,  /* the recorder gave up here, and the unit flew on: why, lines lost */
    RECORD_SETTINGS =
        18,          /* blob: the settings that the unit began with, where not those of power-up */
    RECORD_ROW = 19, /* checksum of one row of a picture presented */
    RECORD_SUM = 20, /* checksum of the lines since the last such line, or since the beginning */
    RECORD_IMAGES = 21, /* blob: the further images, where there are any */
    RECORD_KINDS
};

/* Interfaces of the lines: frames heard and sent, and the recorder's own. */
#define RECORD_HEARD   "can0"
#define RECORD_HEARD_2 "can1"
#define RECORD_SENT    "sent"
#define RECORD_OWN     "unit"

/* Why a recorder gave up. */
enum record_reason {
    RECORD_FULL = 1, /* the recording is as long as it may be */
    RECORD_BEHIND,   /* lines came faster than they could be written */
    RECORD_BROKEN,   /* they cannot be written */
    RECORD_REASONS
};

enum {
    RECORD_FURTHER = 3,      /* images beside the first */
    RECORD_IMAGE_BYTES = 12, /* of one in the blob */
    RECORD_BLOB_MAX = 255,
    RECORD_LINE_MAX = 80,
    RECORD_TICK_US = 2000,  /* the pause between steps that costs least to write */
    RECORD_CHECK_ROWS = 16, /* a check covers every 16th row, the next one the rows below */
    RECORD_ROW_STEP = 37,   /* a check of one row: the next one so many rows below */
    RECORD_SUM_LINES = 16   /* a sum stands behind so many lines, or some more */
};

/* Where lines go. `put` borrows them for the call. */
struct record_sink {
    void *ctx;
    void (*put)(void *ctx, const char *line, size_t bytes);
};

/* Identity of this build: a hash of the sources that decide the pictures, 12 hexadecimal digits.
 * The same on every board. */
extern const char record_build[];

/* An image beside the first: its bytes, 0 if there is none, and a checksum as of the first. */
struct record_image {
    uint64_t bytes;
    uint32_t crc;
};

/* What a recording says of itself. */
struct record_head {
    char version[16];     /* of the firmware */
    uint64_t zero_us;     /* time of the log at which the unit's clock is 0 */
    uint64_t image_bytes; /* of the flash, or of its first image where it has several */
    uint32_t image_crc;   /* CRC-32C of its first 4 KiB without the header's own checksum */
    uint32_t profile_crc; /* of the bus's table, every number of it */
    uint32_t radar_crc;   /* of the board's radar table; 0: the image's or the built-in one */
    char profile[32];     /* name of the bus's table, as one word */
    uint32_t width_px, height_px;
    uint32_t tile_slots, glass_step_px, noise_seed, flash_poll_limit;
    uint32_t node, hardware_revision;
    uint32_t switches; /* bits: magnetic, reports, obeys, whole, heading, strobe, borders,
                          knows_profile, has a second interface, unsigned database; from
                          bit 16 on the partner's node */
    char restart[24];  /* "-": none */
    char build[16];    /* record_build of the program that recorded */
    /* Not words of the head, but lines below it. */
    bool has_settings;
    struct lm_settings settings;                 /* of before the restart */
    struct record_image further[RECORD_FURTHER]; /* images of the start; none: all zero */
    bool has_nodes;
    uint8_t nodes[LM_BUS_NODE_BYTES]; /* that are heard; without has_nodes all are */
};

/* Of the switches. */
enum {
    RECORD_HAS_TABLE = 1u << 7,
    RECORD_HAS_SECOND = 1u << 8,
    RECORD_IS_UNSIGNED = 1u << 9,
    RECORD_PARTNER_BIT = 16
};

/* What a recording has besides what is needed. */
struct record_options {
    uint32_t check_every;     /* a checksum with every so many pictures; 0: never */
    bool is_check_of_one_row; /* for slow processors: some 9 instructions a pixel of the check */
    bool has_sums;            /* for media that may lose or change bytes */
};

/* Recorder; the caller owns it, and it must not move while the unit runs. */
struct recorder {
    struct record_sink sink;
    /* The board's ports, borrowed, and those that the unit is given. */
    const struct lm_flash *flash;
    const struct lm_can *can, *can_2;
    const struct lm_controls *controls;
    const struct lm_display *display;
    struct lm_flash flash_of_unit;
    struct lm_can can_of_unit, can_2_of_unit;
    struct lm_controls controls_of_unit;
    struct lm_display display_of_unit;

    uint64_t zero_us;
    uint64_t now_us;     /* of the step */
    uint64_t written_us; /* time of the last step that is in a line */
    uint64_t steps;      /* so far; 0: the unit is being initialised */
    struct {
        uint8_t bytes[8];
        uint8_t count;
        uint64_t base_us; /* time of the step before its first */
    } ticks;
    struct {
        const void *destination;
        uint32_t length;
        uint32_t count, crc; /* of those that ended well and are not written yet */
        uint32_t waits;
    } read;
    int acquire_status, present_status;
    uint8_t age;
    struct lm_surface surface;
    uint32_t pictures;
    struct record_options options;
    struct {
        uint32_t count, crc; /* since the last sum */
    } lines;
};

/* Fill the head for a board. Reads 4 KiB of each image of the flash, and waits for them, at most
 * flash_poll_limit polls. */
void record_describe(struct record_head *head, const struct lm_board *board, uint64_t zero_us);

/* The same of a board that brings neither tables of the bus nor a radar table: a small program. */
void record_describe_plain(struct record_head *head, const struct lm_board *board,
                           uint64_t zero_us);

/* Checksum of an image that lies in a part of a flash: CRC-32C of its first 4 KiB without the
 * header's own checksum. 0 if they cannot be read. */
uint32_t record_image_crc(const struct lm_flash *flash, const struct lm_flash_part *part,
                          uint32_t polls);

/* Read the text of a head. Returns false for any other text. */
bool record_head_read(struct record_head *head, const char *text);

/* Begin: write the head, and put the recorder's ports into *board, before lm_unit_init. A checksum
 * of the picture is written with every `check_every`th one; 0: never. */
void record_begin(struct recorder *r, const struct record_sink *sink, struct lm_board *board,
                  uint64_t zero_us, uint32_t check_every);

/* The same with a head that is filled already, and a choice of what it has. */
void record_begin_as(struct recorder *r, const struct record_sink *sink, struct lm_board *board,
                     const struct record_head *head, const struct record_options *options);

/* Announce a step, before lm_unit_step. */
void record_step(struct recorder *r, uint64_t now_us);

/* Write what is pending, such as before another part begins. */
void record_flush(struct recorder *r);

/* Write that part `number` begins here. Call record_flush before. */
void record_part(struct recorder *r, uint32_t number);

/* The cause of the board's restart, which was not in *board yet when the recording began. NULL:
 * power was switched on. */
void record_restart(struct recorder *r, const char *restart);

/* The last line of a recording that goes no further, though the unit does. What is pending is left
 * out if lines were lost before it. */
void record_cease(struct recorder *r, enum record_reason reason, uint32_t lines_lost);

/* Why a recorder gave up, in words: "it is as long as it may be". */
const char *record_reason_words(uint32_t reason);

/* The last line. */
void record_end(struct recorder *r);

/* A control as bytes, and back. record_control_bytes returns how many; record_control_read returns
 * false if they are no control. */
uint32_t record_control_bytes(const struct lm_control *control, uint8_t bytes[RECORD_BLOB_MAX]);
bool record_control_read(struct lm_control *control, const uint8_t *bytes, uint32_t count);

/* Checksum of a row of a surface, which goes on from `crc`. */
uint32_t record_row_crc(uint32_t crc, const struct lm_surface *s, uint32_t y);

/* Checksum of the rows of a surface that the check of picture `number` covers. */
uint32_t record_rows_crc(const struct lm_surface *s, uint32_t number);

#endif
