#include "lm/antenna.h"

#include "fx/const.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/const.h"
#include "lm/units.h"

enum { STEP_Q20 = 1 << 9 };

void lm_antenna_pattern_set(struct lm_antenna_pattern *e, const struct lm_antenna_table *antenna)
{
    /* b in radians, Q20. A beam is at most half a circle: 2^31 * 2^22.7. */
    const int64_t beam_q20 = (int64_t)((uint64_t)antenna->elevation_beam * FX_TWO_PI_Q20 >> 32);
    for (int32_t n = 0; n < LM_ANTENNA_PATTERN_STEPS; n++) {
        /* x = e / b in Q12; the gain is -80 log10(2) x^2 dB. The pattern ends at -96 dB, where
         * nothing is left. */
        const int64_t off_q20 = (int64_t)n * STEP_Q20 + STEP_Q20 / 2;
        const int64_t x_q12 = (off_q20 << 12) / (beam_q20 > 0 ? beam_q20 : 1);
        const int64_t fall_db_q8 = (x_q12 * x_q12 >> 12) * LM_BEAM_TWO_WAY_DB_Q8 >> 12;
        e->gain_db_q8[n] = fall_db_q8 < LM_DB_Q8(96) ? -(int32_t)fall_db_q8 : LM_DB_Q8(-96);
    }
}

/* Tangent of an angle, held within 89 degrees, where it is 57. */
static int32_t tan_q20(int64_t angle)
{
    const int64_t steepest = FX_BAM_DEG(89);
    const int64_t held = fx_clamp_i64(angle, -steepest, steepest);
    return fx_tan_q16((fx_bam_t)held) * 16;
}

struct lm_antenna_fan lm_antenna_fan_at(int32_t tilt, fx_bam_t fan)
{
    return (struct lm_antenna_fan){.high_q20 = tan_q20(tilt),
                                   .low_q20 = tan_q20((int64_t)tilt - fan)};
}

int32_t lm_antenna_auto_tilt(int32_t height_m, uint32_t range_m)
{
    const int32_t drop_m = (int32_t)((uint64_t)range_m * range_m / LM_TWO_RADII_M);
    return (int32_t)fx_atan2(-(height_m + drop_m), (int32_t)range_m);
}

/* Attenuate cells outside of the fan. Tangents have at least 22 fractional bits; `down` leaves 20.
 */
static void weigh(const int32_t *restrict tangent, uint32_t cells, uint32_t down,
                  struct lm_antenna_fan fan, const int32_t *restrict gain_db_q8,
                  int16_t *restrict level_db_q8)
{
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t t_q20 = tangent[i] >> down;
        const int32_t off_q20 = fx_max_i32(t_q20 - fan.high_q20, fan.low_q20 - t_q20);
        const int32_t fall_db_q8 =
            gain_db_q8[fx_min_i32(off_q20 >> 9, LM_ANTENNA_PATTERN_STEPS - 1)];
        level_db_q8[i] = fx_sat_i16(level_db_q8[i] + fall_db_q8);
    }
}

/* First of the cells from `first` to before `end` that appears at `t_q20` or above, by bisection:
 * tangents never fall along a line. `end` if none does. */
static uint32_t first_at(const int32_t *tangent, uint32_t down, int32_t t_q20, uint32_t first,
                         uint32_t end)
{
    while (first < end) {
        const uint32_t middle = (first + end) / 2;
        if (tangent[middle] >> down < t_q20) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first;
}

void lm_antenna_pattern_apply(const struct lm_antenna_pattern *e, const struct lm_antenna_fan *fan,
                              const struct lm_range_grid *grid, struct lm_lit_line *lit)
{
    const int32_t *const tangent = lit->horizon + 1;
    const uint32_t cells = grid->cells, down = grid->tangent_bits - 20;
    const uint32_t within = first_at(tangent, down, fan->low_q20 + 1, 0, cells);
    const uint32_t above = first_at(tangent, down, fan->high_q20, within, cells);
    weigh(tangent, within, down, *fan, e->gain_db_q8, lit->level_db_q8);
    weigh(tangent + above, cells - above, down, *fan, e->gain_db_q8, lit->level_db_q8 + above);
}
