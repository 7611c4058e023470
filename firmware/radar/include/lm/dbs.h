/* Doppler beam sharpening: how sharp the picture can be where. docs/EQUATIONS.md, "Doppler beam
 * sharpening". */
#ifndef LM_DBS_H
#define LM_DBS_H

#include "lm/radar.h"

/* N(o): cells in a beam width, times 256, that a beam scanning at `bam_per_s` gets at `off` from
 * the velocity of `speed_mm_s` (0..2,000,000). At most 2^16 - 1. */
uint32_t lm_dbs_ratio_q8(const struct lm_radar *radar, uint32_t bam_per_s, uint32_t speed_mm_s,
                         fx_bam_t off);

/* The ratio that a field uses where `available_q8` is to be had: what it wants, or the power of two
 * below what there is, as filters come; real beam, 256, in the notch. */
uint32_t lm_dbs_sharpening_q8(const struct lm_fov_row *fov, uint32_t available_q8);

#endif
