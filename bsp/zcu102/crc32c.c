/* fx/crc32c.h with the core's CRC32C instructions (DDI 0487, C6.2): the linker finds this before
 * the one of fixed/, which gives the same numbers with tables, at seven times the instructions. */
#include "fx/crc32c.h"

#include <arm_acle.h>

/* Aligned words of whatever the caller has there. */
typedef uint64_t __attribute__((may_alias)) word_t;

uint32_t fx_crc32c(uint32_t crc, const void *data, size_t len)
{
    const uint8_t *p = data;
    uint32_t c = ~crc;
    for (; len > 0 && ((uintptr_t)p & 7) != 0; len--, p++) {
        c = __crc32cb(c, *p);
    }
    for (; len >= 8; len -= 8, p += 8) {
        c = __crc32cd(c, *(const word_t *)p);
    }
    for (; len > 0; len--, p++) {
        c = __crc32cb(c, *p);
    }
    return ~c;
}
