#include "lm/tone.h"

#include <stddef.h>

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"
#include "lm/status.h"

_Static_assert((int)LM_TONE_PIECES == LM_K_TONE_PIECES &&
                   (int)LM_TONE_PIECE_STEPS_LOG2 == LM_K_TONE_PIECE_STEPS_LOG2,
               "a curve has what lm/kernels_radar.h wants");

/* Window from black to white: white lies `span_db_q8` above black, at step `last`. */
struct window {
    int32_t span_db_q8, last, step_log2, gamma_q8;
};

/* Law of the curve: 255 v^gamma in Q16 at a step below white. */
static uint32_t curve_grey_q16(const struct window *w, int32_t step)
{
    if (step == 0) {
        return 0;
    }
    /* log2 v is -11..0 in Q16: only white's own step may lie above 0, by half a step. Times gamma
     * up to 4 it is above -2^22. */
    const int32_t log2_q16 =
        fx_log2_q16((uint32_t)step << w->step_log2) - fx_log2_q16((uint32_t)w->span_db_q8);
    return 255u * fx_exp2_q16((int32_t)((int64_t)log2_q16 * w->gamma_q8 / 256));
}

static void set_steps(struct lm_tone *t, const struct window *w)
{
    for (int32_t step = 0; step < w->last; step++) {
        t->grey[step] = (int32_t)((curve_grey_q16(w, step) + 32768u) >> 16);
    }
    t->grey[w->last] = 255;
}

/* Curve at a joint of two straight pieces, in Q8 with the half for rounding. White is higher by as
 * much as its piece's slope may lose by rounding down. */
static int32_t knot_grey_q8(const struct window *w, int32_t step)
{
    const int32_t white_grey_q8 = 255 * 256 + 128 + LM_TONE_PIECE_STEPS - 1;
    return step < w->last ? (int32_t)(curve_grey_q16(w, step) >> 8) + 128 : white_grey_q8;
}

/* Replace the curve by chords of LM_TONE_PIECE_STEPS steps. Slopes are rounded down, so no chord
 * ends above the start of the next. */
static void set_pieces(struct lm_tone *t, const struct window *w)
{
    int32_t base = knot_grey_q8(w, 0);
    for (int32_t n = 0; n < LM_TONE_PIECES; n++) {
        const int32_t first = n * LM_TONE_PIECE_STEPS,
                      next = knot_grey_q8(w, first + LM_TONE_PIECE_STEPS);
        const int32_t steps = fx_clamp_i32(w->last - first, 1, LM_TONE_PIECE_STEPS);
        const int32_t slope = (next - base) / steps;
        const int32_t shifted = base - n % 8 * LM_TONE_PIECE_STEPS * slope;
        t->pieces[0][n] = (uint8_t)shifted;
        t->pieces[1][n] = (uint8_t)(shifted >> 8);
        t->pieces[2][n] = (uint8_t)slope;
        for (int32_t k = 0; k < LM_TONE_PIECE_STEPS; k++) {
            t->grey[first + k] = (base + k * slope) >> 8;
        }
        base = next;
    }
}

/* True if every slope fits a byte. At gamma 3 the last of 1024 steps is 255 * 3 / 1024 of a grey,
 * 191 in Q8; the 31 more of white still fit. Below gamma 1 the first steps are higher than that. */
static bool is_gentle(const struct window *w)
{
    return w->last >= LM_TONE_STEPS / 2 && w->gamma_q8 >= 256 && w->gamma_q8 <= 3 * 256;
}

/* The step is the smallest power of two times 1/256 dB with which the window fits LM_TONE_STEPS;
 * white lies at the nearest step. A window of 255 dB, below 2^16, needs steps of 2^5. */
int lm_tone_set(struct lm_tone *t, const struct lm_tone_config *config)
{
    const int32_t span_db_q8 = config->white_db_q8 - config->black_db_q8;
    if (span_db_q8 < 256 || span_db_q8 > 255 * 256 || config->gamma_q8 < LM_TONE_GAMMA_MIN_Q8 ||
        config->gamma_q8 > LM_TONE_GAMMA_MAX_Q8) {
        return LM_ERR_RANGE;
    }
    struct window w = {.span_db_q8 = span_db_q8, .last = span_db_q8, .gamma_q8 = config->gamma_q8};
    while (w.last >= LM_TONE_STEPS) {
        w.step_log2++;
        w.last = (span_db_q8 + (1 << w.step_log2 >> 1)) >> w.step_log2;
    }
    t->black_db_q8 = config->black_db_q8;
    t->white_db_q8 = config->white_db_q8;
    t->step_log2 = (uint8_t)w.step_log2;
    t->has_pieces = is_gentle(&w);
    if (t->has_pieces) {
        set_pieces(t, &w);
    } else {
        set_steps(t, &w);
    }
    return LM_OK;
}

void lm_tone_run(const struct lm_tone *t, const int16_t *level_db_q8, uint8_t *grey, uint32_t cells)
{
    const struct lm_k_tone_curve curve = {.black_db_q8 = t->black_db_q8,
                                          .white_db_q8 = t->white_db_q8,
                                          .step_log2 = t->step_log2,
                                          .grey_of_step = t->grey,
                                          .pieces = t->has_pieces ? t->pieces : NULL};
    lm_k_tone(&curve, level_db_q8, grey, cells);
}
