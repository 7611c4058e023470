/* Doppler beam sharpening (DBS): how much finer than the beam the picture can be at each azimuth.
 *
 *     sharpening ratio
 *       8 |-------.                             .-------    the field of view's `sharpening`
 *       4 |       '--.                       .--'           largest power of two available
 *       2 |          '-.                   .-'
 *       1 |             '-----------------'                 notch: real beam
 *         +-----------------------^---------------------> azimuth
 *                              velocity
 *
 * Source: docs/EQUATIONS.md, "Doppler beam sharpening". */
#ifndef LM_DBS_H
#define LM_DBS_H

#include "lm/radar.h"

/* Sharpening ratio available at `off` from the velocity: N(o) = 2 V B^2 sin o / (lambda w), cells
 * in a beam width. The beam scans at `bam_per_s`, which counts as at least LM_RADAR_RATE_MIN;
 * speed_mm_s is 0..2,000,000. At most 2^16 - 1. */
uint32_t lm_dbs_ratio_q8(const struct lm_radar *radar, uint32_t bam_per_s, uint32_t speed_mm_s,
                         fx_bam_t off);

/* Sharpening ratio that a field of view uses where `available_q8` is available:
 * - real beam, 256, below fov->sharpening_least (the notch);
 * - otherwise fov->sharpening, or the largest power of two available if that is less. Doppler
 *   filters come in powers of two. */
uint32_t lm_dbs_sharpening_q8(const struct lm_fov_row *fov, uint32_t available_q8);

#endif
