/* Antenna in elevation: tilt of its axis, and the elevation pattern of a fan beam. lm/beam.h is the
 * antenna in azimuth. Source: docs/EQUATIONS.md, "Elevation pattern".
 *
 *     o - - - - - - - - - - - - - - - - - - horizontal
 *      \ ' - .     tilt
 *       \      ' - .
 *        \           ' - . axis = high edge     above it: attenuated by the pattern
 *         \                                     within the fan: not attenuated
 *          \ low edge, `fan` below the axis     below it: attenuated by the pattern       */
#ifndef LM_ANTENNA_H
#define LM_ANTENNA_H

#include <stdint.h>

#include "lm/illumination.h"
#include "lm/radar.h"

/* Two-way elevation pattern outside the fan. Entry n is the gain where the tangent of elevation is
 * (n + 1/2) / 2048 beyond the edge; 0 or less. The last entry stands for everything beyond. */
enum { LM_ANTENNA_PATTERN_STEPS = 256 };
struct lm_antenna_pattern {
    int32_t gain_db_q8[LM_ANTENNA_PATTERN_STEPS];
};

/* Edges of the fan as tangents of elevation. Echoes between them are not attenuated. */
struct lm_antenna_fan {
    int32_t high_q20, low_q20;
};

/* Compute the pattern. Cost: about 20 k instructions; once for a radar. */
void lm_antenna_pattern_set(struct lm_antenna_pattern *e, const struct lm_antenna_table *antenna);

/* Compute the fan that reaches `fan` below an axis at `tilt` (signed BAM, up positive). A pencil
 * beam has fan 0. Edges steeper than 89 degrees up or down count as 89 degrees. */
struct lm_antenna_fan lm_antenna_fan_at(int32_t tilt, fx_bam_t fan);

/* Tilt of AUTO, signed BAM: it points the axis at flat ground `height_m` below the antenna, at
 * ground range `range_m` (not 0). */
int32_t lm_antenna_auto_tilt(int32_t height_m, uint32_t range_m);

/* Attenuate the levels of a line's cells by the pattern, each at the tangent at which the cell
 * appears. A cell in shadow has no tangent of its own and stays dark. Tangents never fall along a
 * line, so only cells below and above the fan are touched. Cost: docs/benchmarks.md. */
void lm_antenna_pattern_apply(const struct lm_antenna_pattern *e, const struct lm_antenna_fan *fan,
                              const struct lm_range_grid *grid, struct lm_lit_line *lit);

#endif
