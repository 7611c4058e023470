#include "lm/bus.h"

#include "lm/bus_bitfield.h"

/* A BAM is 360 / 2^32 deg, hence 2^31 / 180. No product passes 2^62: 360 deg * 2^31 is 2^40,
 * 1500 m/s * 2^20 * 1000 is 2^41. */
const struct lm_bus_scale lm_bus_scales[LM_BUS_UNITS] = {
    [LM_BUS_BAM] = {"deg", "BAM", 1, 180, 31},
    [LM_BUS_BAM_A_SECOND] = {"deg/s", "BAM/s", 1, 180, 31},
    [LM_BUS_Q6] = {"m", "m x 64", 1, 1, 6},
    [LM_BUS_MM_S] = {"m/s", "mm/s", 1000, 1 << 20, 20},
    [LM_BUS_SECONDS] = {"s", "s", 1, 1, 0},
    [LM_BUS_MM_H] = {"mm/h", "mm/h", 1, 256, 8},
    [LM_BUS_DB_Q8] = {"dB", "dB x 256", 1, 1, 8},
    [LM_BUS_BITS] = {"bits", "bits", 1, 1, 0},
};

const struct lm_bus_field_info lm_bus_fields[LM_BUS_FIELDS] = {
    [LM_BUS_LATITUDE] = {"latitude", LM_BUS_BAM},
    [LM_BUS_LONGITUDE] = {"longitude", LM_BUS_BAM},
    [LM_BUS_ELLIPSOID_HEIGHT] = {"ellipsoid-height", LM_BUS_Q6},
    [LM_BUS_GROUND_SPEED] = {"ground-speed", LM_BUS_MM_S},
    [LM_BUS_TRUE_TRACK] = {"true-track", LM_BUS_BAM},
    [LM_BUS_PITCH] = {"pitch", LM_BUS_BAM},
    [LM_BUS_ROLL] = {"roll", LM_BUS_BAM},
    [LM_BUS_HEADING] = {"heading", LM_BUS_BAM},
    [LM_BUS_TRUE_HEADING] = {"true-heading", LM_BUS_BAM},
    [LM_BUS_BARO_ALTITUDE] = {"baro-altitude", LM_BUS_Q6},
    [LM_BUS_TRUE_ALTITUDE] = {"true-altitude", LM_BUS_Q6},
    [LM_BUS_ALTITUDE_RATE] = {"altitude-rate", LM_BUS_MM_S},
    [LM_BUS_EAST_VELOCITY] = {"east-velocity", LM_BUS_MM_S},
    [LM_BUS_NORTH_VELOCITY] = {"north-velocity", LM_BUS_MM_S},
    [LM_BUS_UP_VELOCITY] = {"up-velocity", LM_BUS_MM_S},
    [LM_BUS_PITCH_RATE] = {"pitch-rate", LM_BUS_BAM_A_SECOND},
    [LM_BUS_YAW_RATE] = {"yaw-rate", LM_BUS_BAM_A_SECOND},
    [LM_BUS_WAYPOINT_LATITUDE] = {"waypoint-latitude", LM_BUS_BAM},
    [LM_BUS_WAYPOINT_LONGITUDE] = {"waypoint-longitude", LM_BUS_BAM},
    [LM_BUS_UTC] = {"utc", LM_BUS_SECONDS},
    [LM_BUS_RAIN_LATITUDE] = {"rain-latitude", LM_BUS_BAM},
    [LM_BUS_RAIN_LONGITUDE] = {"rain-longitude", LM_BUS_BAM},
    [LM_BUS_RAIN_RADIUS] = {"rain-radius", LM_BUS_Q6},
    [LM_BUS_RAIN_RATE] = {"rain-rate", LM_BUS_MM_H},
    [LM_BUS_JAMMER_LATITUDE] = {"jammer-latitude", LM_BUS_BAM},
    [LM_BUS_JAMMER_LONGITUDE] = {"jammer-longitude", LM_BUS_BAM},
    [LM_BUS_JAMMER_RATIO] = {"jammer-ratio", LM_BUS_DB_Q8},
    [LM_BUS_WEATHER_CLEAR] = {"weather-clear", LM_BUS_BITS},
};

int64_t lm_bus_divide(int64_t n, int64_t divisor)
{
    return (n < 0 ? n - divisor / 2 : n + divisor / 2) / divisor;
}

int64_t lm_bus_counts(enum lm_bus_field field, int32_t amount)
{
    const struct lm_bus_scale *scale = lm_bus_scale_of(field);
    return lm_bus_divide((int64_t)amount * (1LL << scale->frac_bits) * scale->multiplier,
                         scale->divisor);
}

void lm_bus_init(struct lm_bus *b, const struct lm_bus_profile *profile)
{
    *b = (struct lm_bus){.profile = profile};
}

/* Which of several redundant senders: the bits of the mask, moved together to the right. */
static uint32_t channel_of(uint32_t id, uint32_t mask)
{
    uint32_t channel = 0, place = 0;
    for (uint32_t bit = 0; bit < 29; bit++) {
        if (mask >> bit & 1) {
            channel |= (id >> bit & 1) << place++;
        }
    }
    return channel;
}

/* A number of each row that takes the frame. */
static uint32_t take_packed(struct lm_bus *b, const struct lm_can_frame *frame,
                            struct lm_bus_event events[LM_BUS_EVENTS])
{
    const struct lm_bus_profile *p = b->profile;
    uint32_t count = 0;
    bool has_row = false;
    for (uint32_t i = 0; i < p->row_count && count < LM_BUS_EVENTS; i++) {
        if (!lm_bus_bitfield_is_row(&p->rows[i], frame)) {
            continue;
        }
        has_row = true;
        enum lm_bus_outcome outcome = LM_BUS_NO_DATA;
        if ((frame->id & p->invalid_mask) == 0) {
            outcome = lm_bus_bitfield_read(&p->rows[i], frame, &events[count]);
        }
        b->count.outcome[outcome]++;
        if (outcome == LM_BUS_VALUE) {
            events[count].row = (uint8_t)i;
            events[count].channel = (uint8_t)channel_of(frame->id, p->channel_mask);
            events[count].node = events[count].service = events[count].code = 0;
            count++;
        }
    }
    b->count.outcome[LM_BUS_UNUSED] += !has_row;
    return count;
}

uint32_t lm_bus_take(struct lm_bus *b, const struct lm_can_frame *frame,
                     struct lm_bus_event events[LM_BUS_EVENTS])
{
    b->count.frames++;
    enum lm_bus_outcome outcome;
    if (frame->is_error || frame->is_remote) {
        outcome = LM_BUS_NOT_DATA;
    } else if (b->profile->framing == LM_BUS_CANAEROSPACE) {
        outcome = lm_canas_take(&b->canas, b->profile, frame, &events[0]);
    } else if (!frame->is_extended || frame->id > 0x1fffffff) {
        outcome = LM_BUS_FOREIGN;
    } else {
        return take_packed(b, frame, events);
    }
    b->count.outcome[outcome]++;
    return outcome == LM_BUS_VALUE;
}
