#include "lm/slant.h"

#include <stdbool.h>

#include "fx/sat.h"
#include "lm/geo.h"
#include "lm/kernels_radar.h"

/* Bin r shows the ground at s = sqrt(r^2 - h^2), in cell floor((s - edge) / cell). LM_LANES entries
 * behind the last bin are set too, because kernels read whole vectors. A pair is added where the
 * next bin's cell is more than one further on. Ranges are below 400 km, 2^26.6 in Q8. */
void lm_slant_set(struct lm_slant *s, uint32_t first_m_q8, uint32_t cell_m_q8, uint32_t cells,
                  const struct lm_range_grid *grid, uint32_t ground_first_m_q8)
{
    const int32_t height_m_q10 = grid->height_m_q10 - grid->reference_m_q10;
    const int64_t edge_m_q8 = (int64_t)ground_first_m_q8 - grid->cell_m_q8 / 2;
    s->first_m_q8 = first_m_q8;
    s->cell_m_q8 = cell_m_q8;
    s->cells = cells;
    for (uint32_t i = 0; i < cells; i++) {
        const int64_t ground_m_q8 =
            lm_ground_of_slant_m_q8(first_m_q8 + i * cell_m_q8, height_m_q10);
        const int64_t past_m_q8 = ground_m_q8 - edge_m_q8;
        const uint64_t cell = past_m_q8 < 0 ? grid->cells : (uint64_t)past_m_q8 / grid->cell_m_q8;
        const bool has_ground = ground_m_q8 != 0 && cell < grid->cells;
        s->cell_of[i] = (int32_t)(has_ground ? cell : grid->cells);
    }
    for (uint32_t i = cells; i < cells + LM_LANES; i++) {
        s->cell_of[i] = (int32_t)grid->cells;
    }
    s->hole = 0;
    while (s->hole < cells && s->cell_of[s->hole] == (int32_t)grid->cells) {
        s->hole++;
    }
    s->pairs = 0;
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t next = s->cell_of[i + 1];
        if (next > s->cell_of[i] + 1 && next < (int32_t)grid->cells) {
            s->pair[s->pairs++] = (struct lm_slant_pair){(uint16_t)i, (uint16_t)(next - 1)};
        }
    }
}

void lm_slant_run(const struct lm_slant *s, const struct lm_range_grid *grid, int16_t *level_db_q8,
                  uint32_t *power_q24)
{
    int16_t bin_db_q8[LM_CELLS_ROOM];
    level_db_q8[grid->cells] = LM_LEVEL_SHADOW;
    lm_k_gather(level_db_q8, s->cell_of, bin_db_q8, s->cells);
    for (uint32_t k = 0; k < s->pairs; k++) {
        const struct lm_slant_pair *pair = &s->pair[k];
        const int16_t last_db_q8 = level_db_q8[pair->last];
        if (last_db_q8 > bin_db_q8[pair->bin]) {
            bin_db_q8[pair->bin] = last_db_q8;
        }
    }
    lm_k_powers_of_levels(bin_db_q8, power_q24, s->cells);
}
