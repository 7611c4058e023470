#include "glass_text.h"

#include "lm/font.h"

#include <string.h>

static bool is_glyph(const struct lm_surface *s, int32_t dot, int32_t x, int32_t y, char c,
                     uint32_t colour, uint32_t ground)
{
    const uint8_t *rows = lm_font_glyph(c);
    for (int32_t row = 0; row < LM_FONT_HEIGHT; row++) {
        for (int32_t column = 0; column < LM_FONT_WIDTH; column++) {
            const int lit = rows[row] >> (LM_FONT_WIDTH - 1 - column) & 1;
            const int32_t px = x + column * dot, py = y + row * dot;
            if (s->pixels[(uint32_t)py * s->stride_px + (uint32_t)px] != (lit ? colour : ground)) {
                return false;
            }
        }
    }
    return true;
}

bool glass_find(const struct lm_surface *s, const char *words, uint32_t colour, uint32_t ground,
                struct lm_point *at)
{
    const struct lm_pen pen = lm_pen_for(s, colour);
    const int32_t wide = lm_text_width(&pen, words), high = LM_FONT_HEIGHT * pen.dot_px;
    const size_t length = strlen(words);
    for (int32_t y = 0; y + high <= s->height_px; y++) {
        for (int32_t x = 0; x + wide <= s->width_px; x++) {
            size_t i = 0;
            while (i < length && is_glyph(s, pen.dot_px, x + (int32_t)i * lm_column_px(&pen), y,
                                          words[i], colour, ground)) {
                i++;
            }
            if (i == length) {
                if (at) {
                    *at = (struct lm_point){x, y};
                }
                return true;
            }
        }
    }
    return false;
}

uint32_t glass_count(const struct lm_surface *s, uint32_t colour)
{
    uint32_t count = 0;
    for (uint32_t y = 0; y < s->height_px; y++) {
        for (uint32_t x = 0; x < s->width_px; x++) {
            count += s->pixels[y * s->stride_px + x] == colour;
        }
    }
    return count;
}
