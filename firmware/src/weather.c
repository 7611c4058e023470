#include "lm/weather.h"

#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/receiver.h"

enum { NO_RAIN_Q8 = -300 * 256 };

/* Where a place lies from the antenna, and how far off the line. */
struct bearing {
    uint32_t distance_q8; /* metres * 256 */
    fx_bam_t off;         /* of the line, signed */
};

/* False for a place so far off that lm_geo_inverse does not take it: beyond every radar range. */
static bool find(struct lm_place antenna, struct lm_place place, fx_bam_t azimuth,
                 struct bearing *b)
{
    const uint32_t far = 1u << 27;
    if (fx_abs_u32((int32_t)(place.latitude - antenna.latitude)) >= far ||
        fx_abs_u32((int32_t)(place.longitude - antenna.longitude)) >= far) {
        return false;
    }
    fx_bam_t bearing;
    lm_geo_inverse(antenna, place, &b->distance_q8, &bearing);
    b->off = bearing - azimuth;
    return true;
}

/* J - 20 log10(R_j / 18520 m) - 40 log10(2) (o / B)^2: the jammer's noise beside the receiver's. */
static int32_t jammer_q8(const struct lm_jammer *j, const struct bearing *b, fx_bam_t beam)
{
    const int32_t ten_miles_q16 = 1453379; /* log2(18520 * 256) */
    const int32_t spread_q8 =
        fx_db_q8_of_log2_q16(2 * (fx_log2_q16(fx_max_u32(b->distance_q8, 256)) - ten_miles_q16));
    /* Sixteen beams off the axis nothing is left. x in Q12: 2^32 and 3083 / 256 dB times 2^8. */
    const uint64_t x_q12 = ((uint64_t)fx_abs_u32((int32_t)b->off) << 12) / fx_max_u32(beam, 1);
    const uint64_t x = x_q12 < 16u << 12 ? x_q12 : 16u << 12;
    return j->ratio_q8 - spread_q8 - (int32_t)((x * x >> 12) * 3083 >> 12);
}

int32_t lm_noise_rise_q8(const struct lm_environment *e, const struct lm_radar *radar,
                         struct lm_place antenna, fx_bam_t azimuth)
{
    int32_t rise_q8 = 0;
    struct bearing b;
    for (uint32_t n = 0; n < fx_min_u32(e->jammer_count, LM_JAMMERS_MAX); n++) {
        const struct lm_jammer *j = &e->jammer[n];
        if (find(antenna, j->place, azimuth, &b)) {
            const int32_t jam_q8 = jammer_q8(j, &b, radar->antenna.azimuth_beam);
            rise_q8 = fx_db_q8_sum_of_many(rise_q8, jam_q8);
        }
    }
    return rise_q8;
}

/* A circle of rain where the line meets it: slant ranges from..to, and what it does there. */
struct shower {
    int32_t from_q8, to_q8;
    uint32_t loss_q32; /* dB a metre, there and back */
    int32_t echo_q8;   /* eta, dB of a cross section of a metre squared in a metre cubed */
};

/* False when the line misses the circle. */
static bool meet(const struct lm_rain *rain, const struct bearing *b, struct shower *s)
{
    /* Distance below 2^29, radius below 2^24.7. */
    const int64_t along_q8 = ((int64_t)b->distance_q8 * fx_cos_q30(b->off)) >> 30;
    const int64_t across_q8 = ((int64_t)b->distance_q8 * fx_sin_q30(b->off)) >> 30;
    const int64_t radius_q8 = (int64_t)rain->radius_m * 256;
    const int64_t square = radius_q8 * radius_q8 - across_q8 * across_q8;
    const int64_t half_q8 = square > 0 ? (int64_t)fx_sqrt_u64((uint64_t)square) : 0;
    if (half_q8 == 0 || along_q8 + half_q8 <= 0) {
        return false;
    }
    s->from_q8 = (int32_t)(along_q8 > half_q8 ? along_q8 - half_q8 : 0);
    s->to_q8 = (int32_t)(along_q8 + half_q8);
    return true;
}

/* Losses of ITU-R P.838-3 at 10 GHz, horizontal, and the echo of Marshall and Palmer's drops. */
static void weigh(const struct lm_rain *rain, uint32_t wavelength_um, struct shower *s)
{
    /* log2(2 k) with k = 0.01217, and alpha = 1.2571, in Q16; below 2^19.7 dB a kilometre * 65536.
     */
    const int32_t rate_q16 = fx_log2_q16(fx_max_u32(rain->mm_per_h, 1));
    const uint32_t loss_q16 = fx_exp2_q16((int32_t)((int64_t)rate_q16 * 82385 >> 16) - 351307);
    s->loss_q32 = (uint32_t)(((uint64_t)loss_q16 << 16) / 1000);
    /* pi^5 |K|^2 200 10^-18 / l^4: -132.4479 dB, and 240 dB for the micrometres; 16 log10 R. */
    s->echo_q8 = 27533 + fx_db_q8_of_log2_q16((int32_t)((int64_t)rate_q16 * 8 / 5)) -
                 fx_db_q8_of_log2_q16(4 * fx_log2_q16(wavelength_um));
}

/* How much of the shower lies before `range_q8`. */
static inline int32_t depth_q8(const struct shower *s, int32_t range_q8)
{
    return (range_q8 < s->to_q8 ? range_q8 > s->from_q8 ? range_q8 : s->from_q8 : s->to_q8) -
           s->from_q8;
}

/* Add the shower's loss to each bin's: half of its own rain's included. Depths are below 2^27, a
 * loss below 2^26; their product is dB * 256 in Q32. */
static void add_loss(const struct shower *s, const struct lm_receiver *r, int32_t *restrict loss_q8)
{
    const int32_t step_q8 = (int32_t)r->cell_q8;
    const int32_t edge_q8 = (int32_t)r->first_q8 - step_q8 / 2;
    for (uint32_t i = 0; i < r->cells; i++) {
        const int32_t near_q8 = edge_q8 + (int32_t)i * step_q8;
        const int32_t twice_q8 = depth_q8(s, near_q8) + depth_q8(s, near_q8 + step_q8);
        loss_q8[i] += (int32_t)((uint64_t)(uint32_t)twice_q8 * s->loss_q32 >> 33);
    }
}

/* Add the shower's return, by the share of each bin that it fills. A share is at most 1 in Q32. */
static void add_echo(const struct shower *s, const struct lm_receiver *r, const int32_t *loss_q8,
                     int32_t *restrict rain_q8)
{
    const int32_t step_q8 = (int32_t)r->cell_q8;
    const int32_t edge_q8 = (int32_t)r->first_q8 - step_q8 / 2;
    const uint32_t per_step_q32 = UINT32_MAX / fx_max_u32(r->cell_q8, 1);
    for (uint32_t i = 0; i < r->cells; i++) {
        const int32_t near_q8 = edge_q8 + (int32_t)i * step_q8;
        const int32_t filled_q8 = depth_q8(s, near_q8 + step_q8) - depth_q8(s, near_q8);
        const uint32_t share_q32 = (uint32_t)filled_q8 * per_step_q32;
        const int32_t share_q8 = fx_db_q8_of_many(share_q32) - 32 * FX_DB_OCTAVE_Q14 / 64;
        const int32_t echo_q8 = s->echo_q8 + r->volume_q8[i] + share_q8 - loss_q8[i];
        rain_q8[i] = fx_db_q8_sum_of_many(rain_q8[i], echo_q8);
    }
}

static uint32_t find_showers(struct shower showers[LM_RAINS_MAX], const struct lm_environment *e,
                             const struct lm_radar *radar, struct lm_place antenna,
                             fx_bam_t azimuth)
{
    uint32_t count = 0;
    struct bearing b;
    for (uint32_t n = 0; n < fx_min_u32(e->rain_count, LM_RAINS_MAX); n++) {
        const struct lm_rain *rain = &e->rain[n];
        if (find(antenna, rain->centre, azimuth, &b) && meet(rain, &b, &showers[count])) {
            weigh(rain, radar->wavelength_um, &showers[count]);
            count++;
        }
    }
    return count;
}

void lm_weather_line(struct lm_weather *w, const struct lm_environment *environment,
                     const struct lm_receiver *receiver, const struct lm_radar *radar,
                     struct lm_place antenna, fx_bam_t azimuth)
{
    struct shower showers[LM_RAINS_MAX];
    w->noise_rise_q8 = lm_noise_rise_q8(environment, radar, antenna, azimuth);
    const uint32_t count = find_showers(showers, environment, radar, antenna, azimuth);
    w->has_rain = count != 0;
    if (!w->has_rain) {
        return;
    }
    for (uint32_t i = 0; i < receiver->cells; i++) {
        w->loss_q8[i] = 0;
        w->rain_q8[i] = NO_RAIN_Q8;
    }
    for (uint32_t n = 0; n < count; n++) {
        add_loss(&showers[n], receiver, w->loss_q8);
    }
    for (uint32_t n = 0; n < count; n++) {
        add_echo(&showers[n], receiver, w->loss_q8, w->rain_q8);
    }
}
