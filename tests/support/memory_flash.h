/* Flash that is memory, as rude as the contract allows: a read that fails leaves half of the
 * destination filled with something else, a late one is busy for as long as the test likes. */
#ifndef MEMORY_FLASH_H
#define MEMORY_FLASH_H

#include <stdbool.h>
#include <stddef.h>

#include "lm/port.h"

/* Copy bytes of the flash. False: the read fails. */
typedef bool memory_flash_fetch(void *to, const uint8_t *from, uint32_t length);

struct memory_flash {
    const uint8_t *bytes;      /* borrowed; a test may damage them while the firmware runs */
    memory_flash_fetch *fetch; /* for bytes that are no memory: their addresses mean what it
                                  takes them for; NULL: memcpy */
    uint32_t reads;            /* started so far */
    uint32_t fail_read;        /* number (from 1) of the one read that fails; 0: none */
    uint32_t fail_every;       /* every Nth read fails; 0: none */
    uint32_t busy_polls;       /* each read is busy for so many polls */
    struct {
        uint64_t offset;
        uint8_t *to;
        uint32_t length, polls_left;
        int is_failing;
    } now;
    struct lm_flash port; /* its ctx is this struct, which must not move */
};

void memory_flash_open(struct memory_flash *f, const uint8_t *bytes, size_t size);

#endif
