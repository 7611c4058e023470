/* Tone: curve from level to grey, with a black level, a white level and a display gamma. It is
 * applied once, at the end of a line. Source: docs/EQUATIONS.md, "Tone". */
#ifndef LM_TONE_H
#define LM_TONE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/radar.h"

/* Size of the curve's table, and of its straight pieces. */
enum {
    LM_TONE_PIECES = 64,
    LM_TONE_PIECE_STEPS_LOG2 = 5,
    LM_TONE_PIECE_STEPS = 1 << LM_TONE_PIECE_STEPS_LOG2, /* steps in a straight piece */
    LM_TONE_STEPS = LM_TONE_PIECES * LM_TONE_PIECE_STEPS
};

/* Curve from black, step 0, to white, step 256..2047. White is at step 1024 or above if the curve
 * spans 4 dB or more. The caller owns it. */
struct lm_tone {
    int16_t black_db_q8, white_db_q8;
    uint8_t step_log2; /* 0..5: a step is 2^step_log2 / 256 dB */
    bool has_pieces;   /* true if `pieces` holds the curve too */
    /* Grey of each step up to white. The entries are 32 bits wide because vector machines gather
     * 32-bit words. */
    int32_t grey[LM_TONE_STEPS];
    /* The same curve as straight pieces, for machines that look up 64 bytes at once. Step 32 n + k
     * has the grey (base[n] + k slope[n]) / 256, rounded down. Rows 0 and 1 are the low and the
     * high byte of base[n] - 32 (n mod 8) slope[n], modulo 2^16; row 2 is slope[n]. Only curves of
     * 4 dB or more with gammas of 1 to 3 have them: others are too steep at one of their ends. */
    uint8_t pieces[3][LM_TONE_PIECES];
};

/* Compute the curve. Returns LM_OK, or LM_ERR_RANGE with *t unchanged if
 * - white is less than 1 dB or more than 255 dB above black;
 * - gamma is outside LM_TONE_GAMMA_MIN_Q8..LM_TONE_GAMMA_MAX_Q8.
 * Cost: below 25 k instructions; below 200 k for a curve without straight pieces. It is called when
 * a knob turns, not for each line. */
int lm_tone_set(struct lm_tone *t, const struct lm_tone_config *config);

/* Compute the grey of a line's levels: 0 at black and below, 255 at white and above, and never
 * darker for a higher level. v is the level's place between black and white, 0..1. With gamma 1 or
 * more the grey is within 1 of round(255 v^gamma); below gamma 1, within 1/2 of the curve at the
 * nearest step. Cost: docs/benchmarks.md. */
void lm_tone_run(const struct lm_tone *t, const int16_t *level_db_q8, uint8_t *grey,
                 uint32_t cells);

#endif
