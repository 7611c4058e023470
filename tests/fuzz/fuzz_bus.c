/* The bus: any frames at any times, and the ownship they make. Frames of 16 bytes: selector, flags,
 * length, step of time, identifier, data. */
#include "fuzz.h"
#include "lm/nav.h"

const uint32_t fuzz_mutations = 60000;

static void check_ownship(const struct lm_ownship *o)
{
    const int32_t quarter = (int32_t)FX_BAM_90;
    FUZZ_ASSERT((int32_t)o->latitude <= quarter && (int32_t)o->latitude >= -quarter);
    FUZZ_ASSERT(o->pitch <= quarter && o->pitch >= -quarter);
    FUZZ_ASSERT(o->height_q6 >= -3500 * 64 && o->height_q6 <= 32500 * 64);
    FUZZ_ASSERT(abs(o->velocity_north_mm_s) <= 1500000 && abs(o->velocity_east_mm_s) <= 1500000);
    FUZZ_ASSERT(o->utc_s >= 0 && o->utc_s < 86400);
}

static struct lm_can_frame take_frame(struct fuzz_supply *s, uint64_t *now_us)
{
    const uint8_t selector = fuzz_u8(s), flags = fuzz_u8(s), length = fuzz_u8(s);
    /* 0..127 ms, or, rarely of use, far away in either direction */
    const uint8_t step = fuzz_u8(s);
    *now_us += step < 250 ? (uint64_t)step * 512 : (uint64_t)step << (8 * (step - 249));
    struct lm_can_frame f = {.id = fuzz_u32(s), .time_us = *now_us};
    if (selector < 0xE0) {
        f.id = lm_bus_canas17.rows[selector % LM_BUS_FIELDS].id;
    }
    f.is_extended = flags & 1;
    f.is_remote = (flags & 0x30) == 0x30;
    f.is_error = (flags & 0xC0) == 0xC0;
    f.length = length & 0x80 ? length : 8;
    const uint64_t data = fuzz_take(s, 8);
    memcpy(f.data, &data, sizeof f.data);
    return f;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    struct lm_nav *nav = malloc(sizeof *nav);
    FUZZ_ASSERT(nav);
    lm_nav_init(nav, &lm_bus_canas17);
    uint64_t now_us = 0;
    uint32_t frames = 0, sum = 0;
    while (supply.left > 0) {
        const struct lm_can_frame frame = take_frame(&supply, &now_us);
        struct lm_ownship ownship;
        lm_nav_take(nav, &frame);
        lm_nav_at(nav, now_us + (frames & 7) * 100000u, &ownship);
        check_ownship(&ownship);
        frames++;
    }
    for (int i = 0; i < LM_BUS_OUTCOMES; i++) {
        sum += nav->bus.count.outcome[i];
    }
    FUZZ_ASSERT(sum == frames && nav->bus.count.frames == frames);
    free(nav);
    return 0;
}
