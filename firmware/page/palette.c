#include "lm/palette.h"

#include "fx/log.h"
#include "fx/sat.h"

/* UNSOURCED, chosen by eye: symbols differ from the picture in hue if it has one, and warnings from
 * both. By night three eighths of the light. */
static const struct tint {
    uint32_t white, symbol, warning;
} tints[LM_TINTS] = {
    [LM_TINT_GREY] = {0x00FFFFFF, 0x0040E060, 0x00FFB020},
    [LM_TINT_GREEN] = {0x0050FF60, 0x00E0F0E0, 0x00FFB020},
    [LM_TINT_AMBER] = {0x00FFB040, 0x00F0F0D8, 0x00FF6040},
};

enum { NIGHT_Q8 = 96, NIGHT_WARNING_Q8 = 128, GREYS_A_STEP = 12 };

/* Each part of the colour times `factor_q8` (0..4095), not beyond full light. */
static uint32_t times(uint32_t colour, uint32_t factor_q8)
{
    uint32_t out = 0;
    for (uint32_t shift = 0; shift <= 16; shift += 8) {
        const uint32_t part = (colour >> shift & 255u) * factor_q8 >> 8;
        out |= fx_min_u32(part, 255) << shift;
    }
    return out;
}

/* Black for 0, `white` for 255, each part rounded; then the light. */
static uint32_t shade(uint32_t white, uint32_t grey, uint32_t light_q8)
{
    uint32_t out = 0;
    for (uint32_t shift = 0; shift <= 16; shift += 8) {
        out |= ((white >> shift & 255u) * grey + 127u) / 255u << shift;
    }
    return times(out, light_q8);
}

void lm_palette_set(struct lm_palette *p, const struct lm_palette_config *config)
{
    const int32_t steps = LM_ROCKER_STEPS;
    const struct tint *tint = &tints[config->tint < LM_TINTS ? config->tint : LM_TINT_GREY];
    const int32_t brightness = fx_clamp_i32(config->brightness, -steps, steps);
    const int32_t contrast = fx_clamp_i32(config->contrast, -steps, steps);
    const int32_t symbology = fx_clamp_i32(config->symbology, -steps, steps);
    const uint32_t light_q8 = config->is_night ? NIGHT_Q8 : 256;
    /* 4^(contrast / 8): 1/4..4 in Q16. */
    const int32_t slope_q16 = (int32_t)fx_exp2_q16(contrast * 16384);
    for (int32_t i = 0; i < 256; i++) {
        const int32_t grey = 128 + ((i - 128) * slope_q16 >> 16) + brightness * GREYS_A_STEP;
        p->picture[i] = shade(tint->white, (uint32_t)fx_clamp_i32(grey, 0, 255), light_q8);
    }
    const uint32_t symbols_q8 = (uint32_t)(10 + symbology) * light_q8 / 10;
    p->symbol = times(tint->symbol, symbols_q8);
    p->faint = times(tint->symbol, symbols_q8 / 2);
    p->warning = times(tint->warning, config->is_night ? NIGHT_WARNING_Q8 : 256);
    p->ink = 0;
}
