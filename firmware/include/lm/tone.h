/* From level to grey, once, at the end: a window in decibels and gamma. docs/DESIGN.md, "Speckle, noise, tone". */
#ifndef LM_TONE_H
#define LM_TONE_H

#include <stdint.h>

enum { LM_TONE_STEPS = 1024 };

struct lm_tone_config {
    int16_t black_q8, white_q8; /* levels in 1/256 dB; white at least 1 dB above black */
    uint16_t gamma_q8;          /* exponent, 26..1024 (0.1..4.0) */
};

struct lm_tone {
    int32_t black_q8;
    uint32_t scale_q16; /* table steps a level unit */
    uint8_t grey[LM_TONE_STEPS];
};

/* LM_OK, or LM_ERR_RANGE with *t unchanged. Cost: about 100 k instructions; done when a knob turns, not each line. */
int lm_tone_set(struct lm_tone *t, const struct lm_tone_config *config);

/* Grey of a line's levels. Cost: about 7 instructions a cell. */
void lm_tone_run(const struct lm_tone *t, const int32_t *level_q8, uint8_t *grey, uint32_t cells);

#endif
