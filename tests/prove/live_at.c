/* Where a live target is between two messages (lm/live.h): the time and the velocity that all else
 * is reckoned from.
 *
 * Proved, for any numbers of a target and any time: the time is within LM_LIVE_RECKONED_MS; a
 * velocity is within 2^24 mm/s, also while it grows and turns; no overflow, no shift too wide.
 *
 * Assumed: the turn is within the limits of lm/live.h (`live`). Sine and cosine are at most 1. */
#include "firmware/base/live.c"

#include "prove.h"

struct lm_live_target nondet_target(void);

int32_t fx_sin_q30(fx_bam_t angle)
{
    const int32_t sine = nondet_i32();
    ASSUME(sine >= -(1 << 30) && sine <= 1 << 30);
    return sine;
}

int32_t fx_cos_q30(fx_bam_t angle)
{
    return fx_sin_q30(angle);
}

static bool is_within(int64_t value, int64_t most)
{
    return value >= -most && value <= most;
}

static struct lm_live_target a_target(void)
{
    const struct lm_live_target t = nondet_target();
    ASSUME(is_within(t.turn, LM_LIVE_TURN_MAX));
    return t;
}

static int64_t a_time_ms(void)
{
    const int64_t ms = nondet_i64();
    ASSUME(is_within(ms, LM_LIVE_RECKONED_MS));
    return ms;
}

void prove_time(void)
{
    const struct lm_live_target t = nondet_target();
    PROVE(is_within(since_ms(&t, nondet_u64()), LM_LIVE_RECKONED_MS));
}

void prove_velocity(void)
{
    const struct lm_live_target t = a_target();
    const struct pair v = velocity_mm_s(&t, a_time_ms());
    PROVE(is_within(v.east, 1 << 24) && is_within(v.north, 1 << 24));
}
