/* Datagrams of a flight simulator, each behind its length: whatever they hold, the bus gets numbers
 * that docs/bus.md lets through, in order, and falls silent when nothing usable comes. The first
 * byte chooses the simulator. */
#include "fuzz.h"
#include "nav/bridge.h"

#include <math.h>

const uint32_t fuzz_mutations = 15000;

static double value_of(const struct canas_frame *f)
{
    const uint32_t bits = (uint32_t)f->data[4] << 24 | (uint32_t)f->data[5] << 16 |
                          (uint32_t)f->data[6] << 8 | f->data[7];
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static int check_frame(void *context, const struct canas_frame *f, int64_t time_us)
{
    int64_t *last_us = context;
    FUZZ_ASSERT(time_us > *last_us && f->length == 8);
    *last_us = time_us;
    const double most = f->id == CANAS_TRUE_ALTITUDE      ? 30001 + 250
                        : f->id == CANAS_GPS_LATITUDE     ? 90
                        : f->id <= CANAS_YAW_RATE         ? 170
                        : f->id == CANAS_GPS_GROUND_SPEED ? 1500.1
                        : f->id == CANAS_EAST_VELOCITY    ? 1500.1
                        : f->id == CANAS_NORTH_VELOCITY   ? 1500.1
                        : f->id == CANAS_UP_VELOCITY      ? 500
                        : f->id == CANAS_ALTITUDE_RATE    ? 500
                        : f->id == CANAS_PITCH            ? 90
                                                          : 360;
    if (f->data[1] == CANAS_FLOAT) {
        FUZZ_ASSERT(fabs(value_of(f)) <= most);
    }
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const struct nav_bridge_settings settings = {
        .is_xplane = size > 0 && data[0] % 2 == 1,
        .send = {.interface = "can0", .position = NAV_POSITION_FLOAT, .rate_scale = 1},
        .datum = NAV_DATUM_SEA_LEVEL};
    int64_t last_us = -1, now_us = INT64_C(1700000000000000);
    if (size == 0) {
        return 0;
    }
    supply.at++;
    supply.left--;
    struct nav_bridge *b = nav_bridge_new(&settings, check_frame, &last_us);
    FUZZ_ASSERT(b);
    while (supply.left > 0) {
        const size_t wanted = fuzz_u16(&supply);
        const size_t length = wanted < supply.left ? wanted : supply.left;
        uint8_t *alone = malloc(length + 1); /* by itself, so that reading beyond it is seen */
        memcpy(alone, supply.at, length);
        nav_bridge_take(b, alone, length, 1, now_us);
        free(alone);
        supply.at += length;
        supply.left -= length;
        for (int i = 0; i < 10; i++) {
            now_us += 5000;
            FUZZ_ASSERT(nav_bridge_step(b, now_us) == 0);
        }
    }
    FUZZ_ASSERT(nav_bridge_step(b, now_us + 400000) == 0);
    FUZZ_ASSERT(nav_bridge_mood(b) == NAV_BRIDGE_WAITING ||
                nav_bridge_mood(b) == NAV_BRIDGE_SILENT);
    nav_bridge_free(b);
    return 0;
}
