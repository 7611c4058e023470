#include "lm/beam.h"

#include "fx/bits.h"
#include "fx/const.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"
#include "lm/seldom.h"

_Static_assert((int)LM_BEAM_TAPS == LM_K_TAPS, "as many taps as lm/kernels_radar.h sums");

_Static_assert(1 << LM_BEAM_FINEST == LM_RADAR_SHARPENING_MAX, "what the table may ask for");

static uint32_t slot_of(int32_t sample)
{
    return (uint32_t)sample % LM_BEAM_TAPS;
}

void lm_beam_clear(struct lm_beam *b)
{
    b->fineness = 0;
    b->held = 0;
}

fx_bam_t lm_beam_spacing(const struct lm_beam *b, const struct lm_radar *radar)
{
    return radar->sample >> b->fineness;
}

int32_t lm_beam_azimuth(const struct lm_beam *b, const struct lm_radar *radar, int32_t sample)
{
    const int32_t spacing = (int32_t)lm_beam_spacing(b, radar);
    return sample * spacing + spacing / 2;
}

/* log2 of the ratio, rounded to the nearest: floor(log2(N sqrt 2)). The ratio is below 2^17. */
static uint8_t fineness_of(uint32_t ratio_q8)
{
    const uint32_t ratio = (uint32_t)((uint64_t)ratio_q8 * FX_ROOT_1_2_Q30 >> (30 + 8 - 1));
    return ratio ? (uint8_t)fx_min_u32((uint32_t)(31 - fx_clz32(ratio)), LM_BEAM_FINEST) : 0;
}

/* Two-way pattern 2^(-8 x^2) in Q16 for x in Q12. It is cut at x = 4, where nothing is left. */
static uint32_t pattern_q16(uint64_t x_q12)
{
    const int32_t x = x_q12 < 4 << 12 ? (int32_t)x_q12 : 4 << 12;
    return fx_exp2_q16(-(x * x >> 5));
}

/* Compute the unscaled weights of the taps, 2^(-8 x^2) with x = offset * ratio / beam. Returns
 * their sum, at most 2^19. */
static uint32_t weigh(const struct lm_beam *b, const struct lm_radar *radar, int32_t azimuth,
                      uint32_t ratio_q8, struct lm_beam_taps *taps)
{
    /* The ratio is at most 2^16 in Q8. Beams of less than 1/200 degree count as that. */
    const fx_bam_t beam = fx_max_u32(radar->antenna.azimuth_beam, 1u << 16);
    const uint64_t x_per_bam_q44 = ((uint64_t)ratio_q8 << 36) / beam;
    int32_t off = azimuth - lm_beam_azimuth(b, radar, taps->first);
    uint32_t sum = 0;
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        /* |off| is below five spacings, so below 2^27, times 2^36. */
        taps->weight_q16[j] = pattern_q16(fx_abs_u32(off) * x_per_bam_q44 >> 32);
        sum += taps->weight_q16[j];
        off -= (int32_t)lm_beam_spacing(b, radar);
    }
    return sum;
}

/* w_n = 2^(-8 x^2) / sum, x = N (a - a_n) / B, over the eight samples around the azimuth. They are
 * scaled by 2^48 / sum; a weight is at most the sum, so no product is above 2^48. What rounding
 * leaves of 65536 goes to a middle tap. */
LM_SELDOM void lm_beam_set_taps(struct lm_beam *b, const struct lm_radar *radar, int32_t azimuth,
                                uint32_t ratio_q8, struct lm_beam_taps *taps)
{
    const uint8_t fineness = fineness_of(ratio_q8);
    if (fineness != b->fineness) {
        b->fineness = fineness;
        b->held = 0;
    }
    /* The taps are the four samples on either side of the azimuth: floor(azimuth / spacing + 1/2) -
     * 4 and on. The division rounds down for either sign. */
    const int64_t spacing = lm_beam_spacing(b, radar), shifted = (int64_t)azimuth + spacing / 2;
    const int64_t nearest = (shifted - (shifted < 0 ? spacing - 1 : 0)) / spacing;
    taps->first = (int32_t)nearest - LM_BEAM_TAPS / 2;
    const uint32_t sum = weigh(b, radar, azimuth, ratio_q8, taps);
    const uint64_t share_q48 = ((uint64_t)1 << 48) / fx_max_u32(sum, 1);
    uint32_t left = 65536;
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        taps->weight_q16[j] = (uint32_t)(taps->weight_q16[j] * share_q48 >> 32);
        left -= taps->weight_q16[j];
    }
    taps->weight_q16[LM_BEAM_TAPS / 2] += left; /* the rest by rounding goes to a middle tap */
}

void lm_beam_weaken(struct lm_beam_taps *taps, uint32_t share_q16)
{
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        taps->weight_q16[j] = (uint32_t)((uint64_t)taps->weight_q16[j] * share_q16 >> 16);
    }
}

bool lm_beam_has(const struct lm_beam *b, int32_t sample)
{
    return sample >= b->first && sample - b->first < b->held;
}

bool lm_beam_next_missing(const struct lm_beam *b, const struct lm_beam_taps *taps, int32_t *sample)
{
    const int32_t end = b->first + b->held, look_end = taps->first + LM_BEAM_TAPS;
    const bool is_apart = taps->first >= end || look_end <= b->first;
    const bool is_before = taps->first < b->first;
    *sample = is_apart ? taps->first : is_before ? b->first - 1 : end;
    return is_apart || is_before || look_end > end;
}

uint32_t *lm_beam_slot(struct lm_beam *b, int32_t sample)
{
    const int32_t end = b->first + b->held;
    const bool is_next = sample == end, is_before = sample == b->first - 1;
    b->held = is_next || is_before ? fx_min_i32(b->held + 1, LM_BEAM_TAPS) : 1;
    b->first = is_next ? end + 1 - b->held : sample;
    b->has_steady[slot_of(sample)] = false;
    return b->power_q24[slot_of(sample)];
}

void lm_beam_sum(const struct lm_beam *b, const struct lm_beam_taps *taps, uint32_t *power_q24,
                 uint32_t cells)
{
    const uint32_t *power[LM_BEAM_TAPS];
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        power[j] = b->power_q24[slot_of(taps->first + j)];
    }
    lm_k_beam_sum(power, taps->weight_q16, power_q24, cells);
}

uint32_t *lm_beam_steady_slot(struct lm_beam *b, int32_t sample)
{
    b->has_steady[slot_of(sample)] = true;
    return b->steady_q24[slot_of(sample)];
}

/* Slots without scatterers have whatever was there, and no weight. */
bool lm_beam_steady_sum(const struct lm_beam *b, const struct lm_beam_taps *taps,
                        uint32_t *power_q24, uint32_t cells)
{
    const uint32_t *power[LM_BEAM_TAPS];
    uint32_t weight_q16[LM_BEAM_TAPS];
    bool has_any = false;
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        const uint32_t slot = slot_of(taps->first + j);
        power[j] = b->steady_q24[slot];
        weight_q16[j] = b->has_steady[slot] ? taps->weight_q16[j] : 0;
        has_any |= b->has_steady[slot];
    }
    if (has_any) {
        lm_k_beam_sum(power, weight_q16, power_q24, cells);
    }
    return has_any;
}
