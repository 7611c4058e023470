/* The bus: any frames at any times, the ownship they make, and what the display answers. Frames of
 * 16 bytes: selector, flags, length, step of time, identifier, data. What is left over of the size
 * chooses the profile. */
#include "fuzz.h"
#include "fx/sat.h"
#include "lm/bus.h"
#include "lm/canas_service.h"
#include "lm/exercise.h"
#include "lm/live_bus.h"
#include "lm/malfunction_bus.h"
#include "lm/nav.h"
#include "lm/status.h"
#include "lm/weather_bus.h"

const uint32_t fuzz_mutations = 60000;

static void check_ownship(const struct lm_ownship *o)
{
    const int32_t quarter = (int32_t)FX_BAM_90;
    FUZZ_ASSERT((int32_t)o->latitude <= quarter && (int32_t)o->latitude >= -quarter);
    FUZZ_ASSERT(o->pitch <= quarter && o->pitch >= -quarter);
    FUZZ_ASSERT(o->height_m_q6 >= -3500 * 64 && o->height_m_q6 <= 32500 * 64);
    FUZZ_ASSERT(abs(o->velocity_north_mm_s) <= 1500000 && abs(o->velocity_east_mm_s) <= 1500000);
    FUZZ_ASSERT(o->utc_s >= 0 && o->utc_s < 86400);
}

static void check_weather(struct lm_weather_bus *w, const struct lm_bus_event *events,
                          uint32_t count, uint64_t now_us)
{
    struct lm_environment e = {0};
    for (uint32_t i = 0; i < count; i++) {
        lm_weather_bus_take(w, &events[i]);
    }
    lm_weather_bus_at(w, now_us, &e);
    FUZZ_ASSERT(lm_environment_check(&e) == LM_OK);
    FUZZ_ASSERT(w->count.sets >= (uint32_t)e.rain_count + e.jammer_count);
}

static void check_exercise(struct lm_exercise *x, const struct lm_bus_event *events, uint32_t count,
                           uint64_t now_us)
{
    const struct lm_exercise was = *x;
    for (uint32_t i = 0; i < count; i++) {
        lm_exercise_take(x, &events[i]);
    }
    lm_exercise_at(x, now_us);
    FUZZ_ASSERT(x->rate_q8 <= LM_EXERCISE_RATE_MAX && x->seed <= INT32_MAX);
    FUZZ_ASSERT(x->is_told || x->time_us == now_us);
    FUZZ_ASSERT(!was.is_told || x->is_told);
    FUZZ_ASSERT(x->rate_q8 == 0 || !was.is_told || x->time_us >= was.time_us ||
                was.time_us - x->time_us >= LM_EXERCISE_STEP_US);
}

/* Whatever is believed of a live target can be reckoned on, to any time. */
static void check_live(struct lm_live_bus *live, const struct lm_bus_event *events, uint32_t count,
                       uint64_t now_us)
{
    uint32_t there = 0;
    for (uint32_t i = 0; i < count; i++) {
        lm_live_bus_take(live, &events[i], now_us);
        const struct lm_live_target *t = &live->live.target[events[i].service];
        const struct lm_live_state s = lm_live_at(t, now_us + events[i].code * 100000u);
        FUZZ_ASSERT(t->kind < LM_LIVE_KINDS && t->reckoning < LM_LIVE_RECKONINGS);
        FUZZ_ASSERT(s.speed_mm_s < 1 << 20);
        FUZZ_ASSERT(fx_abs_u32((int32_t)s.position.latitude) <= FX_BAM_90);
    }
    lm_live_bus_age(live, now_us);
    for (uint32_t i = 0; i < LM_LIVE_MAX; i++) {
        there += live->live.target[i].is_there;
    }
    FUZZ_ASSERT(live->live.count == there && live->count.sets >= there);
}

static void check_malfunctions(struct lm_malfunction_bus *b, const struct lm_bus_event *events,
                               uint32_t count, uint64_t now_us)
{
    for (uint32_t i = 0; i < count; i++) {
        lm_malfunction_bus_take(b, &events[i]);
    }
    lm_malfunction_bus_at(b, now_us);
    FUZZ_ASSERT(b->now.set < 1u << LM_MALFUNCTIONS && (b->now.set != 0 || !b->is_stale));
    const int32_t loss_db_q8 = lm_malfunction_loss_db_q8(&b->now);
    FUZZ_ASSERT(loss_db_q8 >= 0 && loss_db_q8 <= LM_NO_TRANSMIT_DB_Q8);
    FUZZ_ASSERT(abs(lm_malfunction_q8(&b->now, LM_MALFUNCTION_TILT)) <= 30 * 256);
}

static struct lm_can_frame take_frame(struct fuzz_supply *s, const struct lm_bus_profile *profile,
                                      uint64_t *now_us)
{
    const uint8_t selector = fuzz_u8(s), flags = fuzz_u8(s), length = fuzz_u8(s);
    /* 0..127 ms, or, rarely of use, far away in either direction */
    const uint8_t step = fuzz_u8(s);
    *now_us += step < 250 ? (uint64_t)step * 512 : (uint64_t)step << (8 * (step - 249));
    struct lm_can_frame f = {.id = fuzz_u32(s), .time_us = *now_us};
    const bool is_packed = profile->framing == LM_BUS_PACKED;
    if (selector < 0xD0) {
        const struct lm_bus_row *row = &profile->rows[selector % profile->row_count];
        f.id = row->id | (is_packed ? f.id & ~row->packing.mask & 0x1fffffff : 0);
    } else if (selector < 0xE0) {
        f.id = LM_CANAS_REQUEST_ID;
    }
    f.is_extended = is_packed ? !(flags & 1) : flags & 1;
    f.is_remote = (flags & 0x30) == 0x30;
    f.is_error = (flags & 0xC0) == 0xC0;
    f.length = length & 0x80 ? length & 31 : 8;
    const uint64_t data = fuzz_take(s, 8);
    memcpy(f.data, &data, sizeof f.data);
    return f;
}

struct sent {
    uint32_t count;
    int answer;
};

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct sent *sent = ctx;
    FUZZ_ASSERT(frame->length == 8 && !frame->is_extended && frame->data[0] == 20);
    FUZZ_ASSERT(frame->id == LM_CANAS_RESPONSE_ID || frame->id == LM_CANAS_STATE_ID);
    sent->count += sent->answer == LM_OK;
    return sent->answer;
}

/* One of them by its number; canas17, the first, for one more than there are. */
static const struct lm_bus_profile *chosen_profile(size_t number)
{
    size_t count = 0;
    while (lm_bus_profiles[count].name != NULL) {
        count++;
    }
    number %= count + 1;
    return lm_bus_profiles[number < count ? number : 0].profile;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct lm_bus_profile *profile = chosen_profile(size);
    struct fuzz_supply supply = {data, size};
    struct lm_bus *bus = malloc(sizeof *bus);
    struct lm_nav *nav = malloc(sizeof *nav);
    struct lm_live_bus *live = calloc(1, sizeof *live);
    FUZZ_ASSERT(bus && nav && live);
    lm_bus_init(bus, profile);
    lm_nav_init(nav);
    struct lm_weather_bus weather = {0};
    struct lm_malfunction_bus malfunctions = {0};
    struct lm_exercise exercise;
    lm_exercise_init(&exercise, 1);
    struct lm_canas_service service;
    lm_canas_service_init(&service, 20, 1, 0x12);
    struct sent sent = {0};
    const struct lm_can can = {.ctx = &sent, .send = send_frame};
    uint64_t now_us = 0;
    uint32_t frames = 0, sum = 0;
    while (supply.left > 0) {
        const struct lm_can_frame frame = take_frame(&supply, profile, &now_us);
        struct lm_ownship ownship;
        struct lm_bus_event events[LM_BUS_EVENTS];
        const uint32_t count = lm_bus_take(bus, &frame, events);
        for (uint32_t i = 0; i < count; i++) {
            lm_nav_take(nav, &events[i]);
        }
        check_weather(&weather, events, count, now_us);
        check_exercise(&exercise, events, count, now_us);
        check_live(live, events, count, now_us);
        check_malfunctions(&malfunctions, events, count, now_us);
        lm_nav_at(nav, now_us + (frames & 7) * 100000u, &ownship);
        check_ownship(&ownship);
        lm_canas_service_take(&service, &frame);
        sent.answer = frames % 5 == 4 ? LM_ERR_IO : frames % 5 == 3 ? LM_BUSY : LM_OK;
        lm_canas_service_answer(&service, &can, frames, now_us);
        frames++;
    }
    for (int i = 0; i < LM_BUS_OUTCOMES; i++) {
        sum += bus->count.outcome[i];
    }
    FUZZ_ASSERT(bus->count.frames == frames && sum >= frames);
    FUZZ_ASSERT(sum == frames || profile->framing == LM_BUS_PACKED);
    FUZZ_ASSERT(sent.count == service.count.answered && sent.count <= frames);
    free(live);
    free(nav);
    free(bus);
    return 0;
}
