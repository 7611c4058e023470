/* Font of 5 x 7 dots, drawn for this display. */
#ifndef LM_FONT_H
#define LM_FONT_H

#include <stdint.h>

enum { LM_FONT_WIDTH = 5, LM_FONT_HEIGHT = 7 };

/* Characters beyond ASCII, as string literals: "10" LM_GLYPH_DEGREE. */
#define LM_GLYPH_UP     "\x01" /* a triangle that points up */
#define LM_GLYPH_DOWN   "\x02" /* a triangle that points down */
#define LM_GLYPH_DEGREE "\x03"

/* Glyph of a character: LM_FONT_HEIGHT rows from the top, bit 4 leftmost. Read-only, lives as long
 * as the program. Small letters get the glyph of the capital, and a character that the font does
 * not have gets a space. */
const uint8_t *lm_font_glyph(char c);

#endif
