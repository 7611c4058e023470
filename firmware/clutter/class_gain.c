#include "lm/class_gain.h"

#include "fx/log.h"
#include "fx/sat.h"

enum { SEA_STATE_STEP_DB_Q8 = LM_DB_Q8(5) }; /* Nathanson: -40 dB in state 3, -30 dB in state 5 */

/* Lobe of walls whose direction is `off` from the line of sight, before it is normalised:
 * 2^(-(off / half)^2) in Q16. Angles are at most 2^29 and halves above 2^25: quotients are at most
 * 2^19 in Q15, their squares 2^24 in Q16. */
static uint32_t lobe_q16(fx_bam_t off, fx_bam_t half)
{
    const uint64_t ratio_q15 = ((uint64_t)off << 15) / half;
    const uint64_t square_q16 = ratio_q15 * ratio_q15 >> 14;
    return fx_exp2_q16(-(int32_t)fx_min_u32((uint32_t)square_q16, 20 << 16));
}

/* Set the lobe: a floor, and the rest in the lobe such that the mean over all looks is 1. */
static void set_lobe(struct lm_class_gain *g, const struct lm_facing_config *config)
{
    uint32_t sum_q16 = 0;
    uint32_t of_step_q16[LM_FACING_STEPS + 1];
    for (uint32_t i = 0; i <= LM_FACING_STEPS; i++) {
        of_step_q16[i] = lobe_q16(i * (FX_BAM_90 / 2 / LM_FACING_STEPS), config->lobe_half);
        const uint32_t twice = i == 0 || i == LM_FACING_STEPS ? 1 : 2;
        sum_q16 += twice * of_step_q16[i];
    }
    /* The sum is that of 2 LM_FACING_STEPS parts, and above 2^18 where the lobe is narrowest:
     * quotients are below 2^16 * 2^16 * 2^7 / 2^18. */
    const uint32_t floor_q16 = config->floor_permille * 65536u / 1000;
    for (uint32_t i = 0; i <= LM_FACING_STEPS; i++) {
        const uint64_t lobe =
            (uint64_t)(65536 - floor_q16) * of_step_q16[i] * (2 * LM_FACING_STEPS) / sum_q16;
        g->lobe_db_q8[i] = (int16_t)(fx_db_q8(floor_q16 + (uint32_t)lobe) - fx_db_q8(1 << 16));
    }
}

/* Gain of walls at an angle from the line of sight: linear between steps. */
static int32_t lobe_db_q8(const struct lm_class_gain *g, fx_bam_t angle)
{
    const fx_bam_t in_quarter = angle & (FX_BAM_90 - 1);
    const fx_bam_t off = fx_min_u32(in_quarter, FX_BAM_90 - in_quarter);
    const uint32_t i = fx_min_u32(off >> 23, LM_FACING_STEPS - 1);
    const int32_t part = (int32_t)(off - (i << 23)) >> 15;
    return g->lobe_db_q8[i] + ((g->lobe_db_q8[i + 1] - g->lobe_db_q8[i]) * part >> 8);
}

void lm_class_gain_look(struct lm_class_gain *g, fx_bam_t azimuth)
{
    if (!g->is_faced) {
        return;
    }
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        if (g->facing[i] != 0) {
            const fx_bam_t wall = (g->facing[i] - 1u) * (FX_BAM_90 / LM_FACINGS);
            const int32_t faced_db_q8 = g->unfaced_db_q8[i] + lobe_db_q8(g, azimuth - wall);
            g->of_class_db_q8[i] = (int16_t)fx_min_i32(faced_db_q8, LM_CLASS_GAIN_MAX_DB_Q8);
        }
    }
}

void lm_class_gain_set(struct lm_class_gain *g, const struct lm_facing_config *facing,
                       const struct lm_classes *classes, uint8_t lod, uint8_t sea_state,
                       uint16_t loss_db_q8)
{
    const int32_t above = fx_min_i32(sea_state, LM_SEA_STATE_MAX) - LM_SEA_STATE_OF_IMAGE;
    const int32_t off_db_q8 = fx_min_i32(loss_db_q8, LM_CLUTTER_LOSS_MAX_DB_Q8);
    g->is_faced = false;
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const uint8_t kind = classes->entry[i].kind & (LM_KINDS - 1);
        const int32_t sea_db_q8 = kind == LM_KIND_WATER ? above * SEA_STATE_STEP_DB_Q8 : 0;
        const int32_t lod_db_q8 = classes->entry[i].lod_gain_db_q8[lod & (LM_DB_LODS_MAX - 1)];
        g->unfaced_db_q8[i] =
            fx_clamp_i32(sea_db_q8 + lod_db_q8, -LM_CLASS_GAIN_MAX_DB_Q8, LM_CLASS_GAIN_MAX_DB_Q8) -
            off_db_q8;
        g->of_class_db_q8[i] = (int16_t)g->unfaced_db_q8[i];
        g->facing[i] = classes->entry[i].facing;
        g->is_faced |= g->facing[i] != 0;
    }
    if (g->is_faced) {
        set_lobe(g, facing);
    }
}
