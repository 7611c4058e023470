/* A line of words and numbers that is put together piece by piece; what does not fit is cut off. */
#ifndef LM_TEXT_H
#define LM_TEXT_H

#include <stdint.h>

enum { LM_TEXT_MAX = 47 };

/* Zero is an empty line. */
struct lm_text {
    char words[LM_TEXT_MAX + 1]; /* ends in a zero */
    uint8_t length;
};

void lm_text_add(struct lm_text *t, const char *words);

/* At least `digits` (up to 10) digits, with zeros in front. */
void lm_text_number(struct lm_text *t, uint32_t value, uint32_t digits);

/* With a sign, + or -, or none for zero. */
void lm_text_signed(struct lm_text *t, int32_t value);

/* Spaces up to `column`, characters from the left. */
void lm_text_tab(struct lm_text *t, uint32_t column);

#endif
