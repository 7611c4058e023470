/* From level to grey, once, at the end: a window in decibels and gamma. docs/EQUATIONS.md, "Tone".
 */
#ifndef LM_TONE_H
#define LM_TONE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/radar.h"

/* Steps that there is room for, and how many of them a line of the curve has. */
enum {
    LM_TONE_LINES = 64,
    LM_TONE_PLACES_LOG2 = 5,
    LM_TONE_PLACES = 1 << LM_TONE_PLACES_LOG2,
    LM_TONE_STEPS = LM_TONE_LINES * LM_TONE_PLACES
};

/* The window from black, step 0, to white, step 256..2047; from 1024 on where it is 4 dB or wider.
 */
struct lm_tone {
    int16_t black_db_q8, white_db_q8;
    uint8_t step_log2; /* 0..5: a step is 2^step_log2 of 1/256 dB */
    bool has_lines;
    /* Grey of each step up to white; wide entries, because wide loads are what vector machines
     * gather. */
    int32_t grey[LM_TONE_STEPS];
    /* The same by straight lines, for machines that look up 64 bytes at once: step 32 n + k has
     * (base[n] + k slope[n]) / 256, rounded down. Rows: the two bytes of base[n] - 32 (n mod 8)
     * slope[n], modulo 2^16; slope[n]. For windows of 4 dB and more and gammas of 1 to 3: other
     * curves are too steep at one of their ends. */
    uint8_t lines[3][LM_TONE_LINES];
};

/* LM_OK, or LM_ERR_RANGE with *t unchanged. Cost: below 25 k instructions, without lines below 200
 * k; done when a knob turns, not each line. */
int lm_tone_set(struct lm_tone *t, const struct lm_tone_config *config);

/* Grey of a line's levels: 0 at black and below, 255 at white and above, never darker for more.
 * Where gamma is 1 or more, within 1 of round(255 v^gamma), v the level's place in the window;
 * below, within 1/2 of what the nearest step has. Cost: see docs/benchmarks.md. */
void lm_tone_run(const struct lm_tone *t, const int32_t *level_db_q8, uint8_t *grey,
                 uint32_t cells);

#endif
