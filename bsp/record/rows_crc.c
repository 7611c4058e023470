/* The check of a picture. Needs no C library. */
#include "record.h"

#include "fx/crc32c.h"

uint32_t record_rows_crc(const struct lm_surface *s, uint32_t number)
{
    uint32_t crc = 0;
    for (uint32_t y = number % RECORD_CHECK_ROWS; y < s->height_px; y += RECORD_CHECK_ROWS) {
        const uint32_t *row = s->pixels + (size_t)y * s->stride_px;
        uint8_t bytes[3 * 1024];
        uint32_t n = 0;
        for (uint32_t x = 0; x < s->width_px && x < 1024; x++) {
            const uint32_t pixel = row[x] >> s->shift;
            bytes[n++] = (uint8_t)pixel;
            bytes[n++] = (uint8_t)(pixel >> 8);
            bytes[n++] = (uint8_t)(pixel >> 16);
        }
        crc = fx_crc32c(crc, bytes, n);
    }
    return crc;
}
