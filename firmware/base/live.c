#include "lm/live.h"

#include "fx/const.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"

enum { SPEED_MOST_MM_S = (1 << 20) - 1, STEPS = 8 };

const struct lm_live_echo lm_live_echoes[LM_LIVE_KINDS] = {
    [LM_LIVE_UNKNOWN] = {10, 1},
    [LM_LIVE_PERSON] = {0, 1},
    [LM_LIVE_CAR] = {20, 1},
    [LM_LIVE_TRUCK] = {23, 1},
    [LM_LIVE_ARMOUR] = {20, 1},
    [LM_LIVE_TRAIN] = {30, 1},
    [LM_LIVE_LIGHT_AIRCRAFT] = {0, 1},
    [LM_LIVE_FIGHTER] = {8, 1},
    [LM_LIVE_LARGE_AIRCRAFT] = {16, 1},
    [LM_LIVE_HELICOPTER] = {5, 1},
    [LM_LIVE_MISSILE] = {-3, 1},
    [LM_LIVE_BOAT] = {10, 1},
    [LM_LIVE_SMALL_SHIP] = {23, 1},
    [LM_LIVE_SHIP] = {33, 1},
    [LM_LIVE_LARGE_SHIP] = {43, 1},
    [LM_LIVE_STRUCTURE] = {20, 0},
    [LM_LIVE_REFLECTOR] = {30, 0},
    [LM_LIVE_BEACON] = {0, 0},
};

static bool has_acceleration(uint8_t reckoning)
{
    return reckoning == LM_LIVE_RVW || reckoning == LM_LIVE_FVW || reckoning >= LM_LIVE_RVB;
}

static bool turns_body(uint8_t reckoning)
{
    return reckoning == LM_LIVE_RPW || reckoning == LM_LIVE_RVW || reckoning == LM_LIVE_RPB ||
           reckoning == LM_LIVE_RVB;
}

static bool turns_velocity(uint8_t reckoning)
{
    return reckoning == LM_LIVE_RPB || reckoning == LM_LIVE_RVB;
}

/* Milliseconds from the message to a time, at most LM_LIVE_RECKONED_MS either way. */
static int32_t since_ms(const struct lm_live_target *t, uint64_t motion_us)
{
    const bool is_after = motion_us >= t->motion_us;
    const uint64_t apart_ms =
        (is_after ? motion_us - t->motion_us : t->motion_us - motion_us) / 1000;
    const int32_t ms = apart_ms < LM_LIVE_RECKONED_MS ? (int32_t)apart_ms : LM_LIVE_RECKONED_MS;
    return is_after ? ms : -ms;
}

/* Angle after `ms`. 0.01 degree is 2^32 / 36000 BAM: 6000 * 12000 * 2^32 is below 2^59. */
static int64_t turned_bam(const struct lm_live_target *t, int64_t ms)
{
    return t->turn * ms * (1LL << 32) / 36000000;
}

/* East or north of the velocity after `ms`, before it turns: mm/s, below 2^23. */
static int64_t speed_mm_s(const struct lm_live_target *t, uint32_t axis, int64_t ms)
{
    const int64_t gained_mm_s =
        has_acceleration(t->reckoning) ? t->acceleration[axis] * ms / 100 : 0;
    return t->velocity[axis] * 50 + gained_mm_s;
}

struct pair {
    int64_t east, north;
};

/* Velocity after `ms`. Courses grow clockwise: a turn of `angle` takes north to the east. */
static struct pair velocity_mm_s(const struct lm_live_target *t, int64_t ms)
{
    const struct pair v = {speed_mm_s(t, 0, ms), speed_mm_s(t, 1, ms)};
    if (!turns_velocity(t->reckoning)) {
        return v;
    }
    const fx_bam_t angle = (fx_bam_t)turned_bam(t, ms);
    const int64_t sin_q30 = fx_sin_q30(angle), cos_q30 = fx_cos_q30(angle);
    return (struct pair){(v.east * cos_q30 + v.north * sin_q30) >> 30,
                         (v.north * cos_q30 - v.east * sin_q30) >> 30};
}

/* Chord of an arc over its length: sin(x) / x in Q30, x being half the angle. The angle is below a
 * right one, 2^30: its product with pi is below 2^60. */
static int64_t chord_q30(int64_t angle)
{
    const int64_t whole = angle < 0 ? -angle : angle;
    const int64_t half_q28 = whole * (FX_TWO_PI_Q28 / 2) >> 32;
    return half_q28 < 1 << 14 ? 1 << 30
                              : ((int64_t)fx_sin_q30((fx_bam_t)(whole / 2)) << 28) / half_q28;
}

/* Way gone after `ms`: the velocities in the middle of STEPS equal parts of the time, each along
 * the chord of its arc. That is exact for a turn at steady speed, and for a steady acceleration
 * without a turn.
 *
 * A sum is below 2^26 mm/s, times 2^13.6 ms and 256 below 2^48; the way is below 2^24, times 2^30
 * below 2^54. */
static struct pair way_m_q8(const struct lm_live_target *t, int64_t ms)
{
    const bool turns = turns_velocity(t->reckoning) && t->turn != 0;
    const int64_t steps = turns ? STEPS : 1;
    struct pair sum = {0, 0};
    for (int64_t k = 0; k < steps; k++) {
        const struct pair v = velocity_mm_s(t, ms * (2 * k + 1) / (2 * steps));
        sum.east += v.east;
        sum.north += v.north;
    }
    const int64_t chord = turns ? chord_q30(turned_bam(t, ms) / steps) : 1 << 30;
    return (struct pair){(sum.east * ms * 256 / (steps * 1000000)) * chord >> 30,
                         (sum.north * ms * 256 / (steps * 1000000)) * chord >> 30};
}

struct lm_live_state lm_live_at(const struct lm_live_target *t, uint64_t motion_us)
{
    struct lm_live_state s = {.position = t->position, .heading = t->heading};
    const int32_t ms = since_ms(t, motion_us);
    if (turns_body(t->reckoning)) {
        s.heading += (fx_bam_t)turned_bam(t, ms);
    }
    if (t->reckoning == LM_LIVE_STATIC) {
        return s;
    }
    const struct pair v = velocity_mm_s(t, ms), way = way_m_q8(t, ms);
    s.speed_mm_s = fx_min_u32(fx_hypot_u32((int32_t)v.east, (int32_t)v.north), SPEED_MOST_MM_S);
    s.course = fx_atan2((int32_t)v.east, (int32_t)v.north);
    if (way.east != 0 || way.north != 0) {
        struct lm_geo_origin origin;
        lm_geo_set_origin(&origin, t->position);
        s.position = lm_geo_direct(&origin, fx_atan2((int32_t)way.east, (int32_t)way.north),
                                   fx_hypot_u32((int32_t)way.east, (int32_t)way.north));
    }
    return s;
}
