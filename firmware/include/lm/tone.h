/* From level to grey, once, at the end: a window in decibels and gamma. docs/DESIGN.md, "Speckle,
 * noise, tone". */
#ifndef LM_TONE_H
#define LM_TONE_H

#include <stdint.h>

/* The table's steps of 1/16 dB, from -80 dB to +48 dB. */
enum { LM_TONE_STEPS = 2048, LM_TONE_STEP_Q8 = 16, LM_TONE_LOWEST_Q8 = -80 * 256 };

struct lm_tone_config {
    int16_t black_q8, white_q8; /* levels in 1/256 dB; white at least 1 dB above black */
    uint16_t gamma_q8;          /* exponent, 26..1024 (0.1..4.0) */
};

/* Grey 0..255 of each step; wide entries, because wide loads are what vector machines gather. */
struct lm_tone {
    int32_t grey[LM_TONE_STEPS];
};

/* LM_OK, or LM_ERR_RANGE with *t unchanged. Cost: below 200 k instructions; done when a knob turns,
 * not each line. */
int lm_tone_set(struct lm_tone *t, const struct lm_tone_config *config);

/* Grey of a line's levels. Cost: see docs/benchmarks.md. */
void lm_tone_run(const struct lm_tone *t, const int32_t *level_q8, uint8_t *grey, uint32_t cells);

#endif
