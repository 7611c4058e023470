/* Far shore: the brightness of land behind water, which falls with the distance from the shore.
 * docs/EQUATIONS.md, "Illumination". Shared by the kernels lm_k_light of all folders. */
#ifndef SHORE_H
#define SHORE_H

#include "fx/sat.h"
#include "lm/kernels_clutter.h"
#include "lm/level.h"

/* LM_K_WATER in each of eight bytes. */
#define EACH_IS_WATER 0x0101010101010101

/* Brighten lit cells from cell i on, of which the first gets `shore_db_q8`, to the next water or to
 * where nothing is left. */
static inline void add_shore(const struct lm_k_lit_line *line, uint32_t i, int32_t shore_db_q8)
{
    int16_t *level_db_q8 = line->level_db_q8;
    for (; i < line->tops.cells && shore_db_q8 > 0; i++, shore_db_q8 -= line->shore_fall_db_q8) {
        if (line->mark_of_class[line->tops.cell[i] >> 4 & (LM_K_CODES - 1)] & LM_K_WATER) {
            return;
        }
        const int32_t more_db_q8 = level_db_q8[i] != LM_LEVEL_SHADOW ? shore_db_q8 : 0;
        level_db_q8[i] = fx_sat_i16(level_db_q8[i] + more_db_q8);
    }
}

#endif
