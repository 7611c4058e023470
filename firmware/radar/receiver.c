#include "lm/receiver.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/const.h"
#include "lm/geo.h"
#include "lm/kernels_radar.h"
#include "lm/noise.h"
#include "lm/seldom.h"
#include "lm/units.h"

enum { GRAZING_MIN_Q24 = 1 << 16, GRAZING_MAX_Q24 = 1 << 25 };

/* log2 of the grazing g at a slant range, Q16: g = h / s - s / 2a, within 1/256 and 2. The beam
 * does not look steeper than that. */
static int32_t log2_grazing_q16(uint32_t slant_m_q8, int32_t height_m_q10)
{
    const uint32_t ground_m_q8 = lm_ground_of_slant_m_q8(slant_m_q8, height_m_q10);
    int64_t grazing_q24 = height_m_q10 > 0 ? GRAZING_MAX_Q24 : GRAZING_MIN_Q24;
    if (ground_m_q8 != 0) {
        /* The numerator is below 2^26 * 2^22 = 2^48. The curvature's is a range below 2^27, times
         * 2^24. */
        grazing_q24 = (int64_t)height_m_q10 * (1 << 22) / (int64_t)ground_m_q8 -
                      ((int64_t)ground_m_q8 * LM_CURVATURE_Q48 >> 32);
    }
    grazing_q24 = fx_clamp_i64(grazing_q24, GRAZING_MIN_Q24, GRAZING_MAX_Q24);
    return fx_log2_q16((uint32_t)grazing_q24) - (24 << 16);
}

/* Noise of a pulse and field where r^3 / g(r), r in m * 256, is 1: the anchor's, less r^3 / g and
 * twice the pulse's length. A simple pulse that is longer by a factor illuminates as much more
 * ground, and its receiver is as much narrower. */
static int32_t noise_at_one_db_q8(const struct lm_receiver_table *receiver,
                                  const struct lm_range_row *range, enum lm_fov fov)
{
    const uint32_t anchor_m_q8 = lm_m_q8_of_m(receiver->noise_range_m);
    const int32_t grazing_q16 =
        log2_grazing_q16(anchor_m_q8, lm_m_q10_of_m_q6(lm_m_q6_of_m(receiver->noise_height_m)));
    const int32_t longer_q16 = fx_log2_q16(fx_max_u32(range->pulse_ns[fov], 1)) -
                               fx_log2_q16(fx_max_u32(receiver->noise_pulse_ns, 1));
    return receiver->noise_db_q8 - range->code_gain_db_q8[fov] -
           fx_db_q8_of_log2_q16(3 * fx_log2_q16(anchor_m_q8) - grazing_q16 + 2 * longer_q16);
}

/* Loss of clear air to a slant range and back. Ranges are below 2^27, the loss is below 2^16. */
static int32_t air_loss_db_q8(const struct lm_receiver_table *receiver, uint32_t slant_m_q8)
{
    return (int32_t)(((uint64_t)slant_m_q8 * receiver->air_loss_db_per_km_q16 / 1000) >> 16);
}

/* Compute noise, fall and rain volume of each bin, with r its slant range:
 *
 *     noise    anchor + 30 log10(r / R) - 10 log10(g(r) / g(R)) - 20 log10(tau / tau_a) + air(r)
 *     fall     max(0, 30 log10(r / r_s)) + air(r), r_s the end of the STC
 *     volume   10 log10(r b / g(r))
 *
 * The air weakens what returns and not the noise. That is a stronger noise and a fall of both: it
 * costs nothing in a line. Logarithms are below 32 in Q16, 2^21, and three times that. */
static void set_bins(struct lm_receiver *r, const struct lm_radar *radar, int32_t height_m_q10,
                     const struct lm_range_row *range, enum lm_fov fov)
{
    const int32_t noise_db_q8 = noise_at_one_db_q8(&radar->receiver, range, fov);
    const int32_t break_q16 = fx_log2_q16(range->stc_end_m) + (8 << 16);
    /* r in metres, and the beam in radians: 2 pi / 2^32 of a BAM. */
    const int32_t beam_q16 =
        fx_log2_q16(radar->antenna.elevation_beam) + FX_LOG2_TWO_PI_Q16 - ((32 + 8) << 16);
    for (uint32_t i = 0; i < r->cells; i++) {
        const uint32_t slant_m_q8 = r->first_m_q8 + i * r->cell_m_q8;
        const int32_t range_q16 = fx_log2_q16(slant_m_q8);
        const int32_t grazing_q16 = log2_grazing_q16(slant_m_q8, height_m_q10);
        const int32_t air_db_q8 = air_loss_db_q8(&radar->receiver, slant_m_q8);
        r->noise_db_q8[i] =
            noise_db_q8 + fx_db_q8_of_log2_q16(3 * range_q16 - grazing_q16) + air_db_q8;
        r->fall_db_q8[i] =
            fx_max_i32(fx_db_q8_of_log2_q16(3 * (range_q16 - break_q16)), 0) + air_db_q8;
        r->volume_db_q8[i] = fx_db_q8_of_log2_q16(range_q16 + beam_q16 - grazing_q16);
    }
}

/* The area is that of the two-way beam as a rectangle, by the pulse, by the grazing. Logarithms are
 * within 2^6 in Q16, and five of them within 2^25. */
void lm_receiver_floor_at(struct lm_receiver_floor *f, const struct lm_radar *radar,
                          uint32_t slant_m_q8, int32_t height_m_q10, uint8_t range_index,
                          enum lm_fov fov)
{
    const struct lm_range_row *range = &radar->range[range_index];
    const uint32_t held_m_q8 = fx_max_u32(slant_m_q8, 1);
    const int32_t range_q16 = fx_log2_q16(held_m_q8);
    const int32_t grazing_q16 = log2_grazing_q16(held_m_q8, height_m_q10);
    const int32_t beam_q16 = fx_log2_q16(radar->antenna.azimuth_beam) + FX_LOG2_TWO_PI_Q16 -
                             (32 << 16) + LM_LOG2_TWO_WAY_Q16;
    const uint64_t pulse_m_q24 = (uint64_t)range->pulse_ns[fov] * LM_HALF_LIGHT_M_PER_NS_Q24;
    f->noise_db_q8 = noise_at_one_db_q8(&radar->receiver, range, fov) +
                     fx_db_q8_of_log2_q16(3 * range_q16 - grazing_q16) +
                     air_loss_db_q8(&radar->receiver, held_m_q8);
    f->area_db_q8 = fx_db_q8_of_log2_q16(range_q16 + beam_q16 + fx_log2_q16_u64(pulse_m_q24) +
                                         grazing_q16 - ((8 + 24) << 16));
}

/* Compute the weights of a pulse of `length_q16` bins: equal for bins that it covers wholly, less
 * for the two bins that it ends in. */
static void set_pulse(struct lm_receiver *r, uint64_t length_q16)
{
    const uint32_t one = 1 << 16, longest = (2 * LM_PULSE_REACH_MAX + 1) * one;
    const uint32_t length = length_q16 < longest ? (uint32_t)length_q16 : longest;
    /* The pulse ends at length / 2, in bin `last`, which begins at last - 1/2. */
    const uint32_t last = length > one ? (length - one + 2 * one - 1) / (2 * one) : 0;
    const uint32_t whole_q16 = length > one ? (uint32_t)(((uint64_t)one << 16) / length) : one;
    /* length + 1 - 2 last is twice the covered share of the last bin, up to 2. */
    const uint64_t covered_q17 = length + one - 2 * last * one;
    const uint32_t end_share_q16 = (uint32_t)(covered_q17 * whole_q16 >> 17);
    uint32_t left_q16 = one;
    for (uint32_t m = LM_PULSE_REACH_MAX; m > 0; m--) {
        r->weight_q16[m] = m > last ? 0 : m == last ? end_share_q16 : whole_q16;
        left_q16 -= 2 * r->weight_q16[m];
    }
    r->weight_q16[0] = left_q16; /* and the rest by rounding */
}

LM_SELDOM void lm_receiver_set(struct lm_receiver *r, const struct lm_radar *radar,
                               const struct lm_slant *slant, int32_t height_m_q10,
                               uint8_t range_index, enum lm_fov fov)
{
    const struct lm_range_row *range = &radar->range[range_index];
    r->first_m_q8 = slant->first_m_q8;
    r->cell_m_q8 = slant->cell_m_q8;
    r->cells = slant->cells;
    r->unlit = slant->hole;
    r->looks_log2 = fx_min_u32(radar->receiver.noise_looks_log2, LM_NOISE_LOOKS_LOG2_MAX);
    r->loss_db_q8 = r->rise_db_q8 = 0;
    set_bins(r, radar, height_m_q10, range, fov);
    /* 2^32 times 2^21.3; over metres in Q8 it is bins in Q16. */
    const uint64_t pulse_m_q24 = (uint64_t)range->pulse_ns[fov] * LM_HALF_LIGHT_M_PER_NS_Q24;
    const uint64_t pulse_q16 = pulse_m_q24 / fx_max_u32(slant->cell_m_q8, 1);
    set_pulse(r, pulse_q16);
    r->grain_step_q16 = pulse_q16 > 65536 ? (uint32_t)(((uint64_t)1 << 32) / pulse_q16) : 65536;
}

/* A weak signal is a stronger noise and a fall of both, as with the air. */
void lm_receiver_impair(struct lm_receiver *r, int32_t loss_db_q8, int32_t rise_db_q8)
{
    r->loss_db_q8 = loss_db_q8;
    r->rise_db_q8 = rise_db_q8;
    if (loss_db_q8 == 0 && rise_db_q8 == 0) {
        return;
    }
    for (uint32_t i = 0; i < r->cells; i++) {
        r->noise_db_q8[i] += loss_db_q8 + rise_db_q8;
        r->fall_db_q8[i] += loss_db_q8;
    }
}

/* (a + b) w, for the powers of two bins and a weight of at most 2^15, in whole parts of 2^24. Upper
 * and lower halves are multiplied separately, and 32 bits suffice. */
static inline uint32_t share_q24(uint32_t a, uint32_t b, uint32_t weight_q16)
{
    const uint32_t high = ((a >> 16) + (b >> 16)) * weight_q16;
    const uint32_t low = ((a & 0xffffu) + (b & 0xffffu)) * weight_q16;
    return high + (low >> 16);
}

/* Mean over a pulse that reaches `reach` bins to either side. `reach` is a constant in each call,
 * so the compiler unrolls the loop over it. */
static inline void smear_by(uint32_t reach, const uint32_t weight_q16[], const uint32_t *padded,
                            uint32_t *restrict power_q24, uint32_t cells)
{
    uint32_t w[LM_PULSE_REACH_MAX + 1];
    const uint32_t *before[LM_PULSE_REACH_MAX + 1], *after[LM_PULSE_REACH_MAX + 1];
    for (uint32_t m = 0; m <= reach; m++) {
        w[m] = weight_q16[m];
        before[m] = padded + LM_PULSE_REACH_MAX - m;
        after[m] = padded + LM_PULSE_REACH_MAX + m;
    }
    for (uint32_t i = 0; i < cells; i++) {
        uint32_t sum_q24 = share_q24(after[0][i], 0, w[0]);
        for (uint32_t m = 1; m <= reach; m++) {
            sum_q24 += share_q24(before[m][i], after[m][i], w[m]);
        }
        power_q24[i] = sum_q24;
    }
}

/* Replace each bin's power by the mean over the pulse. It is at most 9 / 2^24 too low, by the
 * halves that are cut. Beyond the ends of the line there is no power. The weights add up to 2^16,
 * so the sum fits. */
static void smear(const struct lm_receiver *r, uint32_t *restrict power_q24)
{
    enum { REACH = LM_PULSE_REACH_MAX, SHORT = REACH / 2 };
    uint32_t padded[REACH + LM_CELLS_ROOM + REACH];
    const uint32_t cells = r->cells;
    memset(padded, 0, REACH * sizeof *padded);
    memcpy(padded + REACH, power_q24, cells * sizeof *padded);
    memset(padded + REACH + cells, 0, REACH * sizeof *padded);
    if (r->weight_q16[SHORT + 1] == 0) {
        smear_by(SHORT, r->weight_q16, padded, power_q24, cells);
    } else {
        smear_by(REACH, r->weight_q16, padded, power_q24, cells);
    }
}

void lm_receiver_pulse(const struct lm_receiver *r, uint32_t *power_q24)
{
    if (r->weight_q16[1] != 0) {
        smear(r, power_q24);
    }
}

void lm_receiver_join(const struct lm_receiver *r, const uint32_t *restrict steady_q24,
                      uint32_t *restrict power_q24)
{
    for (uint32_t i = 0; i < r->cells; i++) {
        const uint32_t sum_q24 = power_q24[i] + steady_q24[i];
        power_q24[i] = sum_q24 < power_q24[i] ? UINT32_MAX : sum_q24;
    }
}

void lm_receiver_run(const struct lm_receiver *r, const struct lm_weather *weather, uint32_t line,
                     uint32_t sweep, const uint32_t *power_q24, int16_t *level_db_q8)
{
    const struct lm_noise_key noise_key = lm_noise_key_of(LM_NOISE_RECEIVER, line, sweep);
    struct lm_noise_line noise;
    lm_noise_line_set(&noise, &noise_key, r->cells);
    const struct lm_k_receiver k = {.noise_db_q8 = r->noise_db_q8,
                                    .fall_db_q8 = r->fall_db_q8,
                                    .rise_db_q8 = weather ? weather->noise_rise_db_q8 : 0,
                                    .row_db_q8 = lm_noise_db_q8[r->looks_log2],
                                    .entry = noise.entry};
    if (weather && weather->has_rain) {
        const struct lm_k_rain rain = {weather->loss_db_q8, weather->rain_db_q8};
        lm_k_detect_in_rain(&k, &rain, power_q24, level_db_q8, r->cells);
    } else {
        lm_k_detect(&k, power_q24, level_db_q8, r->cells);
    }
}
