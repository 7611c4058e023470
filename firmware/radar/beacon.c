#include "lm/beacon.h"

#include "fx/mem.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "lm/antenna.h"
#include "lm/level.h"
#include "lm/units.h"

enum {
    US_M_Q8 = 38373, /* half of light's way in a microsecond, 149.896 m */
    STEP_US = 3,     /* UNSOURCED: four bits evenly between the frames */
    FRAME_US = 15,
    PULSE_M_Q8 = US_M_Q8 / 2, /* UNSOURCED: half a microsecond */
    /* UNSOURCED: a beacon answers down to 20 dB below the main lobe, there and back 40. */
    LEAST_DB_Q8 = LM_DB_Q8(-40),
    /* Half a beam off, 2^-2 of the two-way pattern's taps, which add up to 2.65 with samples of
     * 15/16 of a degree: the arc is as wide as the one-way beam. */
    SHOWN_Q24 = 3 << 19
};

/* Set a pulse that begins at a slant range: the bins that hold it, at least one. Ranges are below
 * 2^27. */
static void set_pulse(const struct lm_slant *slant, int64_t range_m_q8, uint32_t power_q24,
                      uint32_t *power)
{
    const int64_t past_m_q8 = range_m_q8 - slant->first_m_q8 + slant->cell_m_q8 / 2;
    if (past_m_q8 < 0) {
        return;
    }
    const uint32_t first = (uint32_t)past_m_q8 / slant->cell_m_q8;
    const uint32_t bins = fx_max_u32((PULSE_M_Q8 + slant->cell_m_q8 / 2) / slant->cell_m_q8, 1);
    for (uint32_t i = first; i < fx_min_u32(first + bins, slant->cells); i++) {
        power[i] = fx_max_u32(power[i], power_q24);
    }
}

static void set_reply(const struct lm_beacon_sample *b, const struct lm_target_reply *reply,
                      uint32_t *power_q24)
{
    const int32_t height_m_q10 = b->grid->height_m_q10 - b->grid->reference_m_q10;
    const uint32_t slant_m_q8 =
        fx_hypot_u32((int32_t)reply->range_m_q8, lm_m_q8_of_m_q10(height_m_q10));
    const uint32_t late_us = reply->code >> 4, pulses = 1u | (reply->code & 15u) << 1 | 1u << 5;
    for (uint32_t i = 0; i <= FRAME_US / STEP_US; i++) {
        if (pulses >> i & 1) {
            set_pulse(b->slant, (int64_t)slant_m_q8 + (int64_t)(late_us + i * STEP_US) * US_M_Q8,
                      reply->share_q24, power_q24);
        }
    }
}

void lm_beacon_sample(const struct lm_beacon_sample *b, struct lm_line *line, uint32_t *power_q24)
{
    struct lm_target_reply reply[LM_TARGET_CANDIDATES_MAX];
    const struct lm_target_horizon horizon = {line->lit.horizon, b->grid->tangent_bits};
    const struct lm_target_candidates *const of[2] = {b->targets->candidates, b->targets->live};
    memset(line->lit.level_db_q8, 0, b->grid->cells * sizeof *line->lit.level_db_q8);
    lm_antenna_pattern_apply(b->pattern, b->fan, b->grid, &line->lit);
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t replies = lm_target_line_replies(of[k], &b->targets->where, &horizon, reply);
        for (uint32_t i = 0; i < replies; i++) {
            if (line->lit.level_db_q8[reply[i].cell] - b->loss_db_q8 >= LEAST_DB_Q8) {
                set_reply(b, &reply[i], power_q24);
            }
        }
    }
}

void lm_beacon_show(const uint32_t *power_q24, uint32_t cells, int32_t bright_db_q8,
                    int16_t *level_db_q8)
{
    for (uint32_t i = 0; i < cells; i++) {
        level_db_q8[i] = power_q24[i] >= SHOWN_Q24 ? fx_sat_i16(bright_db_q8) : LM_LEVEL_SHADOW;
    }
}
