#include "lm/noise.h"

#include <stddef.h>

void lm_noise_line_set(struct lm_noise_line *n, const struct lm_raster *r, uint32_t cells)
{
    const uint32_t blocks = (cells + 4 * LM_NOISE_BLOCK - 1) / (4 * LM_NOISE_BLOCK) * 4;
    const uint32_t epoch = r->epoch;
    const uint64_t growth_q32 = r->growth_q32;
    uint64_t column_q32 = r->column_q32;
    for (uint32_t b = 0; b < blocks; b++) {
        n->entry[b] = lm_noise_entry_in(column_q32, b, epoch);
        column_q32 += growth_q32;
    }
}

void lm_noise_draw(const struct lm_noise_line *n, uint32_t looks_log2, int32_t *restrict draw_q8,
                   uint32_t cells)
{
    const int16_t *const row_q8 = lm_noise_q8[looks_log2];
    const uint32_t *const end = n->entry + (cells + LM_NOISE_BLOCK - 1) / LM_NOISE_BLOCK;
    for (const uint32_t *entry = n->entry; entry != end; entry++, draw_q8 += LM_NOISE_BLOCK) {
        for (int k = 0; k < LM_NOISE_BLOCK; k++) {
            draw_q8[k] = row_q8[*entry + (size_t)k];
        }
    }
}
