#include "lm/bus_fields.h"

/* A BAM is 360 / 2^32 deg, hence 2^31 / 180. No product exceeds 2^62: 360 deg * 2^31 is 2^40,
 * 1500 m/s * 2^20 * 1000 is 2^41. */
const struct lm_bus_scale lm_bus_scales[LM_BUS_UNITS] = {
    [LM_BUS_BAM] = {"deg", "BAM", 1, 180, 31},
    [LM_BUS_BAM_A_SECOND] = {"deg/s", "BAM/s", 1, 180, 31},
    [LM_BUS_M_Q6] = {"m", "m x 64", 1, 1, 6},
    [LM_BUS_MM_S] = {"m/s", "mm/s", 1000, 1 << 20, 20},
    [LM_BUS_SECONDS] = {"s", "s", 1, 1, 0},
    [LM_BUS_MM_H] = {"mm/h", "mm/h", 1, 256, 8},
    [LM_BUS_DB_Q8] = {"dB", "dB x 256", 1, 1, 8},
    [LM_BUS_BITS] = {"bits", "bits", 1, 1, 0},
    [LM_BUS_STATE] = {"state", "state", 1, 1, 0},
    [LM_BUS_MS] = {"ms", "ms", 1, 1, 0},
    [LM_BUS_RATE] = {"x", "x 256", 1, 1, 8},
    [LM_BUS_AMOUNT] = {"amount", "amount x 256", 1, 1, 8},
    [LM_BUS_NUMBER] = {"number", "number", 1, 1, 0},
    [LM_BUS_WORD] = {"word", "word", 1, 1, 0},
};

const struct lm_bus_field_info lm_bus_fields[LM_BUS_FIELDS] = {
    [LM_BUS_LATITUDE] = {"latitude", LM_BUS_BAM},
    [LM_BUS_LONGITUDE] = {"longitude", LM_BUS_BAM},
    [LM_BUS_ELLIPSOID_HEIGHT] = {"ellipsoid-height", LM_BUS_M_Q6},
    [LM_BUS_GROUND_SPEED] = {"ground-speed", LM_BUS_MM_S},
    [LM_BUS_TRUE_TRACK] = {"true-track", LM_BUS_BAM},
    [LM_BUS_PITCH] = {"pitch", LM_BUS_BAM},
    [LM_BUS_ROLL] = {"roll", LM_BUS_BAM},
    [LM_BUS_HEADING] = {"heading", LM_BUS_BAM},
    [LM_BUS_TRUE_HEADING] = {"true-heading", LM_BUS_BAM},
    [LM_BUS_BARO_ALTITUDE] = {"baro-altitude", LM_BUS_M_Q6},
    [LM_BUS_TRUE_ALTITUDE] = {"true-altitude", LM_BUS_M_Q6},
    [LM_BUS_ALTITUDE_RATE] = {"altitude-rate", LM_BUS_MM_S},
    [LM_BUS_EAST_VELOCITY] = {"east-velocity", LM_BUS_MM_S},
    [LM_BUS_NORTH_VELOCITY] = {"north-velocity", LM_BUS_MM_S},
    [LM_BUS_UP_VELOCITY] = {"up-velocity", LM_BUS_MM_S},
    [LM_BUS_PITCH_RATE] = {"pitch-rate", LM_BUS_BAM_A_SECOND},
    [LM_BUS_YAW_RATE] = {"yaw-rate", LM_BUS_BAM_A_SECOND},
    [LM_BUS_STEERPOINT_LATITUDE] = {"steerpoint-latitude", LM_BUS_BAM},
    [LM_BUS_STEERPOINT_LONGITUDE] = {"steerpoint-longitude", LM_BUS_BAM},
    [LM_BUS_UTC] = {"utc", LM_BUS_SECONDS},
    [LM_BUS_MAGNETIC_HEADING] = {"magnetic-heading", LM_BUS_BAM},
    [LM_BUS_MAGNETIC_VARIATION] = {"magnetic-variation", LM_BUS_BAM},
    [LM_BUS_RAIN_LATITUDE] = {"rain-latitude", LM_BUS_BAM},
    [LM_BUS_RAIN_LONGITUDE] = {"rain-longitude", LM_BUS_BAM},
    [LM_BUS_RAIN_RADIUS] = {"rain-radius", LM_BUS_M_Q6},
    [LM_BUS_RAIN_RATE] = {"rain-rate", LM_BUS_MM_H},
    [LM_BUS_JAMMER_LATITUDE] = {"jammer-latitude", LM_BUS_BAM},
    [LM_BUS_JAMMER_LONGITUDE] = {"jammer-longitude", LM_BUS_BAM},
    [LM_BUS_JAMMER_RATIO] = {"jammer-ratio", LM_BUS_DB_Q8},
    [LM_BUS_WEATHER_CLEAR] = {"weather-clear", LM_BUS_BITS},
    [LM_BUS_SEA_STATE] = {"sea-state", LM_BUS_STATE},
    [LM_BUS_WIND_DIRECTION] = {"wind-direction", LM_BUS_BAM},
    [LM_BUS_EXERCISE_TIME] = {"exercise-time", LM_BUS_MS},
    [LM_BUS_EXERCISE_RATE] = {"exercise-rate", LM_BUS_RATE},
    [LM_BUS_EXERCISE_SEED] = {"exercise-seed", LM_BUS_NUMBER},
    [LM_BUS_LIVE_LATITUDE] = {"live-latitude", LM_BUS_BAM},
    [LM_BUS_LIVE_LONGITUDE] = {"live-longitude", LM_BUS_BAM},
    [LM_BUS_LIVE_HEIGHT] = {"live-height", LM_BUS_M_Q6},
    [LM_BUS_LIVE_VELOCITY] = {"live-velocity", LM_BUS_WORD},
    [LM_BUS_LIVE_HEADING] = {"live-heading", LM_BUS_WORD},
    [LM_BUS_LIVE_KIND] = {"live-kind", LM_BUS_WORD},
    [LM_BUS_LIVE_RCS] = {"live-rcs", LM_BUS_DB_Q8},
    [LM_BUS_LIVE_ACCELERATION] = {"live-acceleration", LM_BUS_WORD},
    [LM_BUS_LIVE_REMOVE] = {"live-remove", LM_BUS_BITS},
    [LM_BUS_LIVE_CLEAR] = {"live-clear", LM_BUS_BITS},
    [LM_BUS_MALFUNCTION] = {"malfunction", LM_BUS_AMOUNT},
    [LM_BUS_MALFUNCTION_CLEAR] = {"malfunction-clear", LM_BUS_NUMBER},
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
