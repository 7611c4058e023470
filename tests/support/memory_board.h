/* Board of memory: what a unit under test is lent. Its flash, its glass and the unit's storage are
 * memory; bus and operator are functions of the test. Uses the firmware and nothing else, so that
 * any board can run it. */
#ifndef MEMORY_BOARD_H
#define MEMORY_BOARD_H

#include "lm/unit.h"

#include "memory_flash.h"

struct memory_board {
    struct memory_flash flash;
    struct lm_can can;
    struct lm_controls controls;
    struct lm_display display; /* its ctx is this struct, which must not move */
    uint32_t *glass;           /* borrowed: one buffer, which the firmware alone writes */
    uint32_t presented;        /* pictures */
    int acquire_status;        /* what the display answers: enum lm_status */
    int present_status;
    struct lm_board lent; /* to the unit; a test may change it before it starts the unit */
};

/* What differs from test to test. All pointers are borrowed. */
struct memory_board_parts {
    void *ctx; /* of the functions */
    int (*receive)(void *ctx, struct lm_can_frame *frame);
    int (*next_control)(void *ctx, struct lm_control *control);
    uint16_t width_px, height_px;
    uint32_t *glass; /* width_px * height_px, without gaps between rows */
    uint8_t *plane;  /* the same */
    void *tile_pool; /* 8-byte aligned */
    size_t tile_pool_bytes;
};

/* A board whose devices all work, with the radar of lm_radar_default and the image in its flash. */
void memory_board_open(struct memory_board *b, const uint8_t *image, size_t image_bytes,
                       const struct memory_board_parts *parts);

#endif
