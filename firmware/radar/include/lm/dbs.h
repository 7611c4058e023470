/* Doppler beam sharpening (DBS): how much finer than the beam the picture can be at each azimuth.
 *
 *     sharpening ratio
 *       8 |-----.                                 .-----    the field of view's `sharpening`
 *         |      \                               /
 *         |       \                             /           N(o), what is available
 *         |        '.                         .'
 *       1 |          '-----------------------'              notch: real beam
 *         +-----------------------^---------------------> azimuth
 *                              velocity
 *
 * Source: docs/EQUATIONS.md, "Doppler beam sharpening". */
#ifndef LM_DBS_H
#define LM_DBS_H

#include "lm/radar.h"

enum { LM_DBS_RATIO_MAX_Q8 = (1 << 24) - 1 };
enum { LM_DBS_FADE_LINES = 11 }; /* between two lines the ratio changes by less than a tenth */

/* Scan of the antenna over a moving aircraft. */
struct lm_dbs_scan {
    uint32_t bam_per_s;  /* antenna rate; counts as at least LM_RADAR_RATE_MIN */
    uint32_t speed_mm_s; /* of the aircraft; 0..2,000,000 */
    fx_bam_t line;       /* azimuth between two lines of the display; above 0 */
};

/* Sharpening ratio available at `off` from the velocity: N(o) = 2 V B^2 sin o / (lambda w), cells
 * in a beam width. At most LM_DBS_RATIO_MAX_Q8. */
uint32_t lm_dbs_ratio_q8(const struct lm_radar *radar, const struct lm_dbs_scan *scan,
                         fx_bam_t off);

/* Sharpening ratio used at `off` from the velocity, where a field of view wants `wanted`
 * (1..LM_RADAR_SHARPENING_MAX): what is available, at most what is wanted, at least 256, real beam.
 * Within LM_DBS_FADE_LINES lines of the velocity it falls exponentially, so that no two lines
 * differ by a tenth at any speed. */
uint32_t lm_dbs_sharpening_q8(const struct lm_radar *radar, const struct lm_dbs_scan *scan,
                              uint32_t wanted, fx_bam_t off);

/* Scalloping: power of a sharpened line at `azimuth` from the sector's middle, in a beam position
 * that points up to half of fov->beam_step beside it; 65536 in the middle of a position, in real
 * beam, and where the field has no step. `ratio_q8` is what lm_dbs_sharpening_q8 returned. */
uint32_t lm_dbs_scallop_q16(const struct lm_radar *radar, const struct lm_fov_row *fov,
                            uint32_t ratio_q8, int32_t azimuth);

#endif
