/* What the firmware asks of a board. The firmware owns these interfaces; drivers implement them.
 * Every call is bounded in time and none is made more often than once a line, a tile, a bus frame
 * or a picture. */
#ifndef LM_PORT_H
#define LM_PORT_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/status.h"

/* A read-only memory with at most one read under way. */
struct lm_flash {
    void *ctx;
    uint64_t size_bytes;

    /* Begin to copy `length` bytes at `offset` into `destination`, which stays lent until read_poll
     * answers something else than LM_BUSY. Returns LM_OK, LM_ERR_RANGE past the end, or LM_ERR_IO.
     * Never waits. */
    int (*read_start)(void *ctx, uint64_t offset, void *destination, uint32_t length);

    /* LM_BUSY while the read is under way, then once LM_OK or LM_ERR_IO; after an error the
     * contents of the destination are unspecified. Never waits. */
    int (*read_poll)(void *ctx);
};

/* A frame of the bus as it arrived. */
struct lm_can_frame {
    uint32_t id;      /* 11 or 29 bits */
    bool is_extended; /* 29-bit identifier */
    bool is_remote;
    bool is_error;  /* the controller's report, not a frame of somebody's */
    uint8_t length; /* data bytes, 0..8 */
    uint8_t data[8];
    uint64_t time_us; /* of arrival, on the clock that lm_unit_step is given */
};

/* Identifiers of 11 and of 29 bits. */
enum { LM_CAN_ID_STANDARD = 0x7ff, LM_CAN_ID_EXTENDED = 0x1fffffff };

/* A data frame passes when it is of the filter's length of identifier and its identifier & mask is
 * id & mask. Remote frames never pass. */
struct lm_can_filter {
    uint32_t id, mask;
    bool is_extended; /* 29-bit identifier */
};

struct lm_can {
    void *ctx;

    /* The next frame that waits: 1 and *frame is filled; 0 when none waits; LM_ERR_IO when the bus
     * is down. */
    int (*receive)(void *ctx, struct lm_can_frame *frame);

    /* Offer a data frame; its time_us is not looked at, and it is the caller's again on return.
     * LM_OK: taken, and goes out when the bus lets it, or is dropped and counted by the driver.
     * LM_BUSY: no room now; nothing was taken, offer it again a step later. LM_ERR_IO: the bus is
     * down, and the frame lost. Never waits. NULL when the board can only listen. */
    int (*send)(void *ctx, const struct lm_can_frame *frame);
};

/* A picture in memory: 0x00RRGGBB, row 0 on top. */
struct lm_surface {
    uint32_t *pixels;
    uint32_t stride_px; /* distance between rows */
    uint16_t width_px, height_px;
};

struct lm_display {
    void *ctx;
    uint16_t width_px, height_px; /* 256..1024, constant from start to end */

    /* Lend a surface to draw the next picture in; its old contents are unspecified. LM_OK, LM_BUSY
     * when none is free yet (the picture is drawn a step later), or LM_ERR_IO. */
    int (*acquire)(void *ctx, struct lm_surface *surface);

    /* Show the surface that was lent. LM_OK or LM_ERR_IO; the surface is given back either way. */
    int (*present)(void *ctx);
};

struct lm_control; /* lm/controls.h */

struct lm_controls {
    void *ctx;

    /* The next thing the operator did: 1 and *control is filled, 0 when there is none. */
    int (*next)(void *ctx, struct lm_control *control);
};

#endif
