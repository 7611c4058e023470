/* Replay of a recording: its ports answer as those of the recorded board did.
 *
 *     replay_open(&p, "flight.log");                      reads the head
 *     fill a board as p.head says, with the image as its flash
 *     replay_wrap(&p, &board);                            the ports are the recording's
 *     lm_unit_init(&unit, &board);
 *     while (replay_step(&p, &now_us)) { lm_unit_step(&unit, now_us); }
 *     p.error says why it ended, or is empty
 *
 * Every answer that was recorded has to be asked for, in its order, by the step that it belongs to.
 * Where it is not, the unit departs from the recording: that is counted and told with its place.
 * Anything at all in the file is safe. */
#ifndef REPLAY_H
#define REPLAY_H

#include "record.h"

enum { REPLAY_LINE_BYTES = 128, REPLAY_BUFFERS = LM_AGES };

/* What a source of lines answers. */
enum replay_line {
    REPLAY_LINE,      /* a line, without its end, and a zero byte */
    REPLAY_LINE_OVER, /* there are no more */
    REPLAY_LINE_TORN, /* the last one has no end */
    REPLAY_LINE_BAD   /* no text, or longer than REPLAY_LINE_BYTES less one */
};

/* What comes next in the recording. */
struct replay_event {
    enum {
        REPLAY_NONE, /* nothing is read ahead */
        REPLAY_HEARD,
        REPLAY_HEARD_2, /* on the second interface */
        REPLAY_SENT,
        REPLAY_OWN,
        REPLAY_OVER /* the recording is over, or broken */
    } kind;
    struct lm_can_frame frame; /* the recorder's own without RECORD_ID: enum of record.h */
    uint32_t left;             /* of RECORD_READS and RECORD_WAITS: how many are left */
    uint8_t blob[RECORD_BLOB_MAX + 1];
    uint32_t blob_bytes;
};

struct replay {
    struct record_head head;
    char path[1024]; /* of the part that is read */
    void *source;    /* of the lines: in replay_file.c an owned FILE */
    enum replay_line (*next_line)(struct replay *p, char *line);
    uint32_t line, part;
    uint32_t lines_crc; /* of the lines since the last sum */
    struct replay_event next;
    struct {
        uint8_t bytes[8];
        uint8_t count, at;
    } ticks;
    uint64_t now_us, steps;

    const struct lm_flash *image; /* borrowed */
    struct lm_board *board;       /* borrowed from replay_wrap on */
    struct lm_flash flash;
    struct lm_can can, can_2;
    struct lm_controls controls;
    struct lm_display display;
    uint8_t *destination;
    uint64_t offset;
    uint32_t length, reads_crc, reads_wanted_crc;
    bool is_reading_run;
    int acquire_status, present_status;
    uint8_t age;

    uint32_t *memory;                /* owned by replay_file.c; these lie in it: */
    uint32_t *shown[REPLAY_BUFFERS]; /* the last pictures, the newest at pictures % BUFFERS */
    uint32_t *canvas;                /* lent to the unit */
    uint32_t pictures;               /* presented so far */

    bool has_ended;  /* the recording ended in good order: no line of it is missing */
    uint32_t ceased; /* enum record_reason: the recorder gave up at its end, or 0 */
    struct {
        uint32_t departures; /* steps that did not ask for what was recorded, or for more */
        uint32_t checks, checks_failed;
        uint32_t reads_differ; /* runs of reads whose bytes are not those of the recording */
        uint32_t torn;         /* a last line that is no whole line */
    } count;
    uint64_t departed_us; /* time of the first departure */
    char error[256];      /* why the replay cannot begin or ended early; empty: it did not */
};

/* Open a recording and read its head. Returns 0; or -1 with the cause in p->error. */
int replay_open(struct replay *p, const char *path);

/* Compare the head with what this program has. Returns NULL, or in static memory what differs: the
 * version, an image, the table of the bus or the radar. `mine` is described by record_describe. Its
 * image may be a file without what lay behind it in a board's flash; it may have further images
 * that the recording lacks. */
const char *replay_difference(const struct replay *p, const struct record_head *mine);

/* Whether it was recorded by another build of this firmware. That is no reason not to show it: the
 * checks tell whether its pictures are the same. */
bool replay_is_other_build(const struct replay *p);

/* Put the recording's settings and ports into a board, whose flash becomes the source of the
 * bytes. The board must live as long as the replay. Returns 0; or -1 without memory. Before
 * lm_unit_init. */
int replay_wrap(struct replay *p, struct lm_board *board);

/* The time of the next step. False at the end of the recording. */
bool replay_step(struct replay *p, uint64_t *now_us);

/* The picture presented last: head.width_px * head.height_px pixels. */
const uint32_t *replay_glass(const struct replay *p);

void replay_close(struct replay *p);

/* The same where there are neither files nor a heap. *p is zero but for `path`, a name for errors,
 * and `source`. Reads the head from lines of at most REPLAY_LINE_BYTES with the zero. Returns 0; or
 * -1 with the cause in p->error. */
int replay_begin(struct replay *p, enum replay_line (*next_line)(struct replay *p, char *line));

/* As replay_wrap, with memory of the caller for so many pixels. */
size_t replay_pixels(const struct replay *p);
void replay_wrap_with(struct replay *p, struct lm_board *board, uint32_t *memory);

#endif
