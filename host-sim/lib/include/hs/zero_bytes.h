/* Zero bytes: the check that the unused bytes of a record are 0. */
#ifndef HS_ZERO_BYTES_H
#define HS_ZERO_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* True if all `count` bytes are 0; true of none. */
static inline bool db_is_zero(const void *bytes, size_t count)
{
    const uint8_t *b = bytes;
    for (size_t i = 0; i < count; i++) {
        if (b[i] != 0) {
            return false;
        }
    }
    return true;
}

#endif
