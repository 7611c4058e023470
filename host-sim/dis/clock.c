#include "dis/clock.h"

enum { PERIOD_US = 1000000, TYPE_FLOAT = 2, TYPE_LONG = 3 };

#define FLOAT_ONE UINT32_C(0x3f800000)

static int64_t time_us(const struct dis_clock *c, int64_t now_us)
{
    return c->exercise_us + (c->is_standing || now_us < c->from_us ? 0 : now_us - c->from_us);
}

static void begin(struct dis_clock *c, int64_t now_us)
{
    if (!c->has_begun) {
        c->has_begun = c->is_due = true;
        c->from_us = now_us;
    }
}

void dis_clock_set(struct dis_clock *c, bool is_standing, int64_t now_us)
{
    begin(c, now_us);
    c->exercise_us = time_us(c, now_us);
    c->from_us = now_us;
    c->is_standing = is_standing;
    c->is_due = true;
}

static struct lm_can_frame frame(uint16_t id, uint8_t node, uint8_t type, uint8_t code,
                                 uint32_t word)
{
    return (struct lm_can_frame){.id = id,
                                 .length = 8,
                                 .data = {node, type, 0, code, (uint8_t)(word >> 24),
                                          (uint8_t)(word >> 16), (uint8_t)(word >> 8),
                                          (uint8_t)word}};
}

int dis_clock_frames(struct dis_clock *c, uint8_t node, int64_t now_us,
                     struct lm_can_frame frames[DIS_CLOCK_FRAMES])
{
    begin(c, now_us);
    if (!c->is_due && now_us - c->told_us < PERIOD_US) {
        return 0;
    }
    /* 24 days are as much as the frame can say; then it stands. */
    const int64_t ms = time_us(c, now_us) / 1000;
    const uint32_t told_ms = ms < INT32_MAX ? (uint32_t)ms : INT32_MAX;
    frames[0] =
        frame(DIS_ID_EXERCISE_RATE, node, TYPE_FLOAT, c->code, c->is_standing ? 0 : FLOAT_ONE);
    frames[1] = frame(DIS_ID_EXERCISE_TIME, node, TYPE_LONG, c->code, told_ms);
    c->code++;
    c->told_us = now_us;
    c->is_due = false;
    return DIS_CLOCK_FRAMES;
}
