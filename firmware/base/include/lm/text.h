/* Text: a line of words and numbers, assembled piece by piece without a heap. Each function
 * appends, and drops what does not fit.
 *
 *     struct lm_text t = {0};
 *     lm_text_add(&t, "TILES");
 *     lm_text_tab(&t, 10);
 *     lm_text_number(&t, 42, 4);          "TILES     0042" */
#ifndef LM_TEXT_H
#define LM_TEXT_H

#include <stdint.h>

enum { LM_TEXT_MAX = 47 }; /* characters of the longest line */

/* A line of text. All zero is an empty line. The caller owns it. */
struct lm_text {
    char words[LM_TEXT_MAX + 1]; /* ends in a zero byte */
    uint8_t length;              /* characters, 0..LM_TEXT_MAX */
};

/* Append a string that ends in a zero byte; borrowed for the call. */
void lm_text_add(struct lm_text *t, const char *words);

/* Append a decimal number with at least `digits` digits, 0..10, padded with zeros. */
void lm_text_number(struct lm_text *t, uint32_t value, uint32_t digits);

/* Append a decimal number with its sign, + or -. Zero has no sign. */
void lm_text_signed(struct lm_text *t, int32_t value);

/* Append spaces until the line has `column` characters. A longer line stays as it is. */
void lm_text_tab(struct lm_text *t, uint32_t column);

#endif
