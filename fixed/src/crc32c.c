#include "fx/crc32c.h"

#include "fx/tables.h"

/* Slicing by four: four independent table look-ups replace four that wait for each other. After
 * M. Kounavis and F. Berry, "A Systematic Approach to Building High Performance Software-Based CRC
 * Generators", 2005. */
uint32_t fx_crc32c(uint32_t crc, const void *data, size_t len)
{
    const uint8_t *p = data;
    uint32_t c = ~crc;
    for (; len >= 4; len -= 4, p += 4) {
        c ^= (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
        c = fx_table_crc32c[3][c & 255u] ^ fx_table_crc32c[2][c >> 8 & 255u] ^
            fx_table_crc32c[1][c >> 16 & 255u] ^ fx_table_crc32c[0][c >> 24];
    }
    for (; len > 0; len--, p++) {
        c = c >> 8 ^ fx_table_crc32c[0][(c ^ *p) & 255u];
    }
    return ~c;
}
