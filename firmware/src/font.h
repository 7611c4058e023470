/* A font of 5 x 7 dots, drawn for this display. */
#ifndef LM_FONT_H
#define LM_FONT_H

#include <stdint.h>

enum { LM_FONT_WIDTH = 5, LM_FONT_HEIGHT = 7 };

/* Seven rows from the top, bit 4 leftmost. Space for a character the font does not have. */
const uint8_t *lm_font_glyph(char c);

#endif
