/* The golden countries in the board's flash: this at its start, then the images where it says.
 * Written by golden_flash.c on the PC, read by images/golden.c. */
#ifndef GOLDEN_FLASH_H
#define GOLDEN_FLASH_H

#include "golden_scene.h"

enum { GOLDEN_FLASH_MAGIC = 0x444C4F47, GOLDEN_IMAGE_BYTES_MAX = 32 << 20 };

struct golden_flash {
    uint32_t magic, reserved;
    struct {
        char name[16];
        struct lm_position centre;
        uint64_t offset, size;
    } places[GOLDEN_PLACES];
};

#endif
