#include "lm/weather.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/const.h"
#include "lm/receiver.h"
#include "lm/units.h"
#include "shower.h"

/* Noise of a jammer relative to the receiver's: J - 20 log10(R_j / 18520 m) - 40 log10(2) (o /
 * B)^2. J is given on the axis at ten nautical miles, 18520 m. */
static int32_t jammer_db_q8(const struct lm_jammer *j, const struct lm_bearing *b, fx_bam_t beam)
{
    const int32_t spread_db_q8 = fx_db_q8_of_log2_q16(
        2 * (fx_log2_q16(fx_max_u32(b->distance_m_q8, LM_M_Q8(1))) - LM_LOG2_TEN_NM_M_Q8_Q16));
    /* Sixteen beams off the axis nothing is left. x is in Q12, its square below 2^32. */
    const uint64_t x_q12 = ((uint64_t)fx_abs_u32((int32_t)b->off) << 12) / fx_max_u32(beam, 1);
    const uint64_t x = x_q12 < 16u << 12 ? x_q12 : 16u << 12;
    return j->noise_ratio_db_q8 - spread_db_q8 -
           (int32_t)((x * x >> 12) * LM_BEAM_ONE_WAY_DB_Q8 >> 12);
}

int32_t lm_noise_rise_db_q8(const struct lm_environment *e, const struct lm_radar *radar,
                            struct lm_position antenna, fx_bam_t azimuth)
{
    int32_t rise_db_q8 = 0;
    struct lm_bearing b;
    for (uint32_t n = 0; n < fx_min_u32(e->jammer_count, LM_JAMMERS_MAX); n++) {
        const struct lm_jammer *j = &e->jammer[n];
        if (lm_bearing_find(antenna, j->position, azimuth, &b)) {
            const int32_t jam_db_q8 = jammer_db_q8(j, &b, radar->antenna.azimuth_beam);
            rise_db_q8 = fx_db_q8_sum_vec(rise_db_q8, jam_db_q8);
        }
    }
    return rise_db_q8;
}

/* Shower that the line meets, and its chord. */
struct met {
    struct lm_shower shower;
    struct lm_chord chord;
};

static uint32_t find_showers(struct met met[LM_RAINS_MAX], const struct lm_environment *e,
                             const struct lm_radar *radar, struct lm_position antenna,
                             fx_bam_t azimuth)
{
    uint32_t count = 0;
    for (uint32_t n = 0; n < fx_min_u32(e->rain_count, LM_RAINS_MAX); n++) {
        struct lm_shower *s = &met[count].shower;
        s->radius_m = e->rain[n].radius_m;
        if (lm_bearing_find(antenna, e->rain[n].centre, azimuth, &s->at) &&
            lm_shower_chord(s, 0, &met[count].chord)) {
            lm_shower_set_rate(s, e->rain[n].mm_per_h, radar->wavelength_um);
            count++;
        }
    }
    return count;
}

/* Add the echo of a shower after its loss, by the share of each bin that the rain fills: at most 1
 * in Q32. */
static void add_echo(const struct met *m, const struct lm_shower_cells *reach,
                     const int32_t *loss_db_q8, int32_t *restrict echo_db_q8)
{
    const int32_t step_m_q8 = (int32_t)reach->cell_m_q8;
    const int32_t edge_m_q8 = (int32_t)reach->first_m_q8 - step_m_q8 / 2;
    const uint32_t per_step_q32 = UINT32_MAX / fx_max_u32(reach->cell_m_q8, 1);
    const struct lm_chord c = m->chord;
    for (uint32_t i = 0; i < reach->cells; i++) {
        const int32_t near_m_q8 = edge_m_q8 + (int32_t)i * step_m_q8;
        const int32_t filled_q8 =
            lm_chord_before_m_q8(c, near_m_q8 + step_m_q8) - lm_chord_before_m_q8(c, near_m_q8);
        const uint32_t share_q32 = (uint32_t)filled_q8 * per_step_q32;
        const int32_t share_db_q8 = fx_db_q8_vec(share_q32) - 32 * FX_DB_PER_OCTAVE_Q14 / 64;
        echo_db_q8[i] =
            fx_db_q8_sum_vec(echo_db_q8[i], m->shower.echo_db_q8 + share_db_q8 - loss_db_q8[i]);
    }
}

/* All showers add their losses before any echo is added: the echo of one is weakened by the rain of
 * another before it. Echoes are volumes; the receiver's volume turns them into gamma. */
void lm_weather_line(struct lm_weather *w, const struct lm_environment *environment,
                     const struct lm_receiver *receiver, const struct lm_radar *radar,
                     struct lm_position antenna, fx_bam_t azimuth)
{
    struct met met[LM_RAINS_MAX];
    const struct lm_shower_cells reach = {receiver->first_m_q8, receiver->cell_m_q8,
                                          receiver->cells};
    w->noise_rise_db_q8 = lm_noise_rise_db_q8(environment, radar, antenna, azimuth);
    const uint32_t count = find_showers(met, environment, radar, antenna, azimuth);
    w->has_rain = count != 0;
    if (!w->has_rain) {
        return;
    }
    for (uint32_t i = 0; i < receiver->cells; i++) {
        w->loss_db_q8[i] = 0;
        w->rain_db_q8[i] = LM_NO_RAIN_Q8;
    }
    for (uint32_t n = 0; n < count; n++) {
        lm_shower_add_loss(&met[n].shower, &met[n].chord, &reach, w->loss_db_q8);
    }
    for (uint32_t n = 0; n < count; n++) {
        add_echo(&met[n], &reach, w->loss_db_q8, w->rain_db_q8);
    }
    for (uint32_t i = 0; i < receiver->cells; i++) {
        w->rain_db_q8[i] += receiver->volume_db_q8[i];
    }
}
