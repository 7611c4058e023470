/* The check of a picture. Needs no C library. */
#include "record.h"

#include "fx/crc32c.h"

enum { PIXELS_AT_ONCE = 64 }; /* few: this is called at the end of deep chains */

uint32_t record_row_crc(uint32_t crc, const struct lm_surface *s, uint32_t y)
{
    const uint32_t *row = s->pixels + (size_t)y * s->stride_px;
    for (uint32_t x = 0; x < s->width_px;) {
        uint8_t bytes[3 * PIXELS_AT_ONCE];
        uint32_t n = 0;
        for (; n < sizeof bytes && x < s->width_px; x++) {
            const uint32_t pixel = row[x] >> s->shift;
            bytes[n++] = (uint8_t)pixel;
            bytes[n++] = (uint8_t)(pixel >> 8);
            bytes[n++] = (uint8_t)(pixel >> 16);
        }
        crc = fx_crc32c(crc, bytes, n);
    }
    return crc;
}

uint32_t record_rows_crc(const struct lm_surface *s, uint32_t number)
{
    uint32_t crc = 0;
    for (uint32_t y = number % RECORD_CHECK_ROWS; y < s->height_px; y += RECORD_CHECK_ROWS) {
        crc = record_row_crc(crc, s, y);
    }
    return crc;
}
