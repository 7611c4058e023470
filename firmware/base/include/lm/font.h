/* A font of 5 x 7 dots, drawn for this display. */
#ifndef LM_FONT_H
#define LM_FONT_H

#include <stdint.h>

enum { LM_FONT_WIDTH = 5, LM_FONT_HEIGHT = 7 };

/* Characters beside ASCII's, for strings such as "10" LM_GLYPH_DEGREE. */
#define LM_GLYPH_UP     "\x01" /* a triangle that points up */
#define LM_GLYPH_DOWN   "\x02"
#define LM_GLYPH_DEGREE "\x03"

/* Seven rows from the top, bit 4 leftmost. Small letters look like capitals; a character that the
 * font does not have is a space. */
const uint8_t *lm_font_glyph(char c);

#endif
