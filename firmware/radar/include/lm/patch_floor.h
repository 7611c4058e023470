/* Floor of a patch: what the processor leaves in cells from which nothing comes. It is the
 * receiver's noise, and a part of the ground around: side lobes, ambiguities and quantisation spill
 * it over the patch (multiplicative noise). Law: docs/EQUATIONS.md, "Noise" of the synthetic
 * aperture.
 *
 *     line    ... k-2  k-1   k
 *     mean  of |    |    |   |   every fourth cell, none counted above a ceiling
 *     weight   .  . o  o O   O   the mean of some LM_PATCH_FLOOR_LINES lines up to this one */
#ifndef LM_PATCH_FLOOR_H
#define LM_PATCH_FLOOR_H

#include <stdint.h>

#include "lm/radar.h"

enum { LM_PATCH_FLOOR_LINES = 32, LM_PATCH_FLOOR_STRIDE = 4 };

/* Mean of the ground so far. The caller owns it. */
struct lm_patch_floor {
    uint32_t lines;    /* that the mean is of */
    uint32_t mean_q28; /* power of gamma; 0..2^28 times that of the table's ceiling */
};

/* Forget the mean: a patch begins. */
void lm_patch_floor_clear(struct lm_patch_floor *f);

/* Take line `number` of `cells` levels (1 or more) into the mean. Returns the level that the ground
 * leaves in each of its cells, in dB * 256; -128 dB if there is no ground. `level_db_q8` holds what
 * the line receives, before speckle. Pointers are borrowed for the call. Cost: 1 instruction a
 * cell. */
int32_t lm_patch_floor_run(struct lm_patch_floor *f, const struct lm_sar_table *sar,
                           uint32_t number, const int16_t *level_db_q8, uint32_t cells);

#endif
