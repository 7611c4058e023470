#include "lm/beam.h"

#include "fx/bits.h"
#include "fx/log.h"
#include "fx/sat.h"

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

static uint8_t fineness_of(uint32_t ratio_q8)
{
    const uint32_t ratio = ratio_q8 / 256;
    return ratio ? (uint8_t)fx_min_u32((uint32_t)(31 - fx_clz32(ratio)), LM_BEAM_FINEST) : 0;
}

/* 2^(-8 x^2) in Q16 for x in Q12, cut at 4, where nothing is left. */
static uint32_t pattern_q16(uint64_t x_q12)
{
    const int32_t x = x_q12 < 4 << 12 ? (int32_t)x_q12 : 4 << 12;
    return fx_exp2_q16(-(x * x >> 5));
}

/* x = off * ratio / beam for the samples of a look: their pattern, and what all of it is, at most
 * 2^19. */
static uint32_t weigh(const struct lm_beam *b, const struct lm_radar *radar, int32_t azimuth,
                      uint32_t ratio_q8, struct lm_beam_look *look)
{
    /* A ratio of 2^16 at the most; beams of less than 1/200 degree count as that. */
    const fx_bam_t beam = fx_max_u32(radar->antenna.azimuth_beam, 1u << 16);
    const uint64_t x_per_bam_q44 = ((uint64_t)ratio_q8 << 36) / beam;
    int32_t off = azimuth - lm_beam_azimuth(b, radar, look->first);
    uint32_t sum = 0;
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        /* |off| is below five spacings, so below 2^27, times 2^36. */
        look->weight_q16[j] = pattern_q16(fx_abs_u32(off) * x_per_bam_q44 >> 32);
        sum += look->weight_q16[j];
        off -= (int32_t)lm_beam_spacing(b, radar);
    }
    return sum;
}

void lm_beam_aim(struct lm_beam *b, const struct lm_radar *radar, int32_t azimuth,
                 uint32_t ratio_q8, struct lm_beam_look *look)
{
    const uint8_t fineness = fineness_of(ratio_q8);
    if (fineness != b->fineness) {
        b->fineness = fineness;
        b->held = 0;
    }
    /* Floor of azimuth / spacing + 1/2, for either sign. */
    const int64_t spacing = lm_beam_spacing(b, radar), shifted = (int64_t)azimuth + spacing / 2;
    const int64_t nearest = (shifted - (shifted < 0 ? spacing - 1 : 0)) / spacing;
    look->first = (int32_t)nearest - LM_BEAM_TAPS / 2;
    const uint32_t sum = weigh(b, radar, azimuth, ratio_q8, look);
    const uint64_t share_q48 = ((uint64_t)1 << 48) / fx_max_u32(sum, 1);
    uint32_t left = 65536;
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        look->weight_q16[j] = (uint32_t)(look->weight_q16[j] * share_q48 >> 32);
        left -= look->weight_q16[j];
    }
    look->weight_q16[LM_BEAM_TAPS / 2] += left; /* what rounding left goes to the middle */
}

bool lm_beam_has(const struct lm_beam *b, int32_t sample)
{
    return sample >= b->first && sample - b->first < b->held;
}

bool lm_beam_lacks(const struct lm_beam *b, const struct lm_beam_look *look, int32_t *sample)
{
    const int32_t end = b->first + b->held, look_end = look->first + LM_BEAM_TAPS;
    const bool is_apart = look->first >= end || look_end <= b->first;
    const bool is_before = look->first < b->first;
    *sample = is_apart ? look->first : is_before ? b->first - 1 : end;
    return is_apart || is_before || look_end > end;
}

uint32_t *lm_beam_room(struct lm_beam *b, int32_t sample)
{
    const int32_t end = b->first + b->held;
    const bool is_next = sample == end, is_before = sample == b->first - 1;
    b->held = is_next || is_before ? fx_min_i32(b->held + 1, LM_BEAM_TAPS) : 1;
    b->first = is_next ? end + 1 - b->held : sample;
    return b->power_q24[slot_of(sample)];
}

/* Weights add up to 2^16, so that a sum stays below 2^48. */
static void add_samples(const uint32_t *const power[LM_BEAM_TAPS],
                        const uint32_t weight_q16[LM_BEAM_TAPS], uint32_t *restrict sum,
                        uint32_t cells)
{
    const uint32_t *restrict a = power[0], *restrict b = power[1], *restrict c = power[2];
    const uint32_t *restrict d = power[3], *restrict e = power[4], *restrict f = power[5];
    const uint32_t *restrict g = power[6], *restrict h = power[7];
    const uint64_t wa = weight_q16[0], wb = weight_q16[1], wc = weight_q16[2], wd = weight_q16[3];
    const uint64_t we = weight_q16[4], wf = weight_q16[5], wg = weight_q16[6], wh = weight_q16[7];
    for (uint32_t i = 0; i < cells; i++) {
        const uint64_t sum_q40 = a[i] * wa + b[i] * wb + c[i] * wc + d[i] * wd + e[i] * we +
                                 f[i] * wf + g[i] * wg + h[i] * wh;
        sum[i] = (uint32_t)(sum_q40 >> 16);
    }
}

void lm_beam_sum(const struct lm_beam *b, const struct lm_beam_look *look, uint32_t *power_q24,
                 uint32_t cells)
{
    const uint32_t *power[LM_BEAM_TAPS];
    for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
        power[j] = b->power_q24[slot_of(look->first + j)];
    }
    add_samples(power, look->weight_q16, power_q24, cells);
}
