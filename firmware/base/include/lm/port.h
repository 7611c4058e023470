/* Port: the interfaces that a board implements, for flash, CAN bus, display and controls.
 *
 * The firmware owns these interfaces and drivers implement them. docs/PORTING.md leads through it.
 *
 * - Each interface is a struct of functions and a context. The board owns it, fills it before
 *   lm_unit_init and leaves it unchanged while the unit runs.
 * - `ctx` is the driver's own. The firmware passes it back unchanged to every function.
 * - All calls come from inside lm_unit_init and lm_unit_step, on their thread. Every call is
 * bounded in time.
 * - No call is made more often than once a line, a tile, a bus frame or a picture.
 *
 * Example: a flash that is mapped into memory.
 *
 *     static int start(void *ctx, uint64_t offset, void *destination, uint32_t length)
 *     {
 *         if (offset > IMAGE_BYTES || length > IMAGE_BYTES - offset) {
 *             return LM_ERR_RANGE;
 *         }
 *         memcpy(destination, (const uint8_t *)ctx + offset, length);
 *         return LM_OK;
 *     }
 *     static int poll(void *ctx)
 *     {
 *         (void)ctx;
 *         return LM_OK;
 *     }
 *     const struct lm_flash flash = {image, IMAGE_BYTES, start, poll}; */
#ifndef LM_PORT_H
#define LM_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/config.h"
#include "lm/damage.h"
#include "lm/refusal.h"
#include "lm/status.h"

/* Flash: a read-only memory that does one read at a time.
 *
 *     idle --read_start: LM_OK--> reading --read_poll: LM_OK, LM_ERR_IO--> idle
 *                                 ^      |
 *                                 +------+ read_poll: LM_BUSY                   */
struct lm_flash {
    void *ctx;
    uint64_t size_bytes;

    /* Begin to copy `length` bytes at `offset` into `destination`. Never waits. Returns
     * - LM_OK: the read is under way. The driver borrows `destination` until read_poll returns
     *   something else than LM_BUSY.
     * - LM_ERR_RANGE: the bytes reach past the end. No read is under way.
     * - LM_ERR_IO: the device failed. No read is under way. */
    int (*read_start)(void *ctx, uint64_t offset, void *destination, uint32_t length);

    /* Ask for the end of the read that is under way. Never waits. Returns
     * - LM_BUSY: not yet; poll again.
     * - LM_OK, once: the bytes are there.
     * - LM_ERR_IO, once: the device failed. The bytes at the destination are unspecified. */
    int (*read_poll)(void *ctx);
};

/* A part of a flash that holds an image; of no bytes: there is none. */
struct lm_flash_part {
    uint64_t offset, bytes;
};

/* A CAN frame, as it arrived or as it is to be sent. */
struct lm_can_frame {
    uint32_t id;      /* 11 or 29 bits */
    bool is_extended; /* 29-bit identifier */
    bool is_remote;
    bool is_error;  /* an error report of the controller, not a frame of another node */
    uint8_t length; /* data bytes, 0..8 */
    uint8_t data[8];
    uint64_t time_us; /* time of arrival, on the clock of lm_unit_step; ignored when sending */
};

/* Largest identifiers of 11 and of 29 bits; as masks they compare every bit. */
enum { LM_CAN_ID_STANDARD = 0x7ff, LM_CAN_ID_EXTENDED = 0x1fffffff };

/* Acceptance filter of a CAN controller. A data frame passes if
 * - its identifier has the filter's length (is_extended), and
 * - its id & mask equals the filter's id & mask.
 * Remote frames never pass. */
struct lm_can_filter {
    uint32_t id, mask;
    bool is_extended; /* 29-bit identifier */
};

/* CAN bus. */
struct lm_can {
    void *ctx;

    /* Take the oldest frame that was received. Never waits. Returns
     * - 1: *frame is filled.
     * - 0: no frame waits; *frame is unspecified.
     * - LM_ERR_IO: the bus is down; *frame is unspecified. */
    int (*receive)(void *ctx, struct lm_can_frame *frame);

    /* Offer a data frame for sending; `frame` is borrowed for the call. Never waits. Returns
     * - LM_OK: taken. The driver sends it when the bus is free, or drops and counts it.
     * - LM_BUSY: no room now. Nothing was taken: offer it again a step later.
     * - LM_ERR_IO: the bus is down and the frame is lost.
     * NULL if the board can only listen. */
    int (*send)(void *ctx, const struct lm_can_frame *frame);
};

/* Surface: memory of a picture. A pixel is 0x00RRGGBB << shift; row 0 is on top. The firmware
 * writes pixels and reads none. */
struct lm_surface {
    uint32_t *pixels;
    uint32_t stride_px; /* distance between rows, width_px or more */
    uint16_t width_px, height_px;
    uint8_t shift; /* 0 or 8 */
    uint8_t age;   /* what the memory holds: the picture presented `age` calls of `present` ago, all
                      of it, as in EGL_EXT_buffer_age; 0: anything */
};

/* The greatest age that spares work: with more buffers a whole picture is drawn each time. */
enum { LM_AGES = 3 };

/* Display. */
struct lm_display {
    void *ctx;
    uint16_t width_px, height_px; /* 256..1024 each; constant while the unit runs */

    /* Lend a surface to the firmware, for the next picture. Where surface->age is set, only what
     * changed since then is drawn. Called no sooner than LM_DISPLAY_REST_US after `present`: a
     * screen of 60 pictures a second has then left the memory that it showed before. Never waits.
     * Returns
     * - LM_OK: *surface is filled and lent until `present`, perhaps over several steps.
     * - LM_BUSY: no surface is free; the picture is drawn a step later.
     * - LM_ERR_IO: the device failed; nothing is lent. */
    int (*acquire)(void *ctx, struct lm_surface *surface);

    /* Show the lent surface, which is complete. It differs from the picture presented before within
     * the blocks of *changed, borrowed for the call. LM_OK, or LM_ERR_IO if the device failed. The
     * surface is the driver's again in both cases. */
    int (*present)(void *ctx, const struct lm_damage *changed);
};

/* Time between `present` and the next `acquire`, at least. */
enum { LM_DISPLAY_REST_US = 17000 };

struct lm_control; /* lm/controls.h */

/* Source of the operator's controls. */
struct lm_controls {
    void *ctx;

    /* Take the operator's next act. Never waits. Returns 1 with *control filled, or 0 if there is
     * none, with *control unspecified. */
    int (*next)(void *ctx, struct lm_control *control);

    /* Learn that the control handed out last was refused. NULL if nobody asks. */
    void (*refused)(void *ctx, enum lm_refusal reason);
};

#endif
