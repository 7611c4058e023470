/* The antenna up and down: tilt, and what its elevation pattern leaves of a line. Across the line
 * it is lm/beam.h that smears. docs/EQUATIONS.md, "Real beam". */
#ifndef LM_ANTENNA_H
#define LM_ANTENNA_H

#include <stdint.h>

#include "lm/illumination.h"
#include "lm/radar.h"

/* Two-way gain behind the fan's edge, 1/256 dB: entry n for tangents (n + 1/2) / 2048 beyond it. */
enum { LM_ANTENNA_PATTERN_STEPS = 256 };
struct lm_antenna_pattern {
    int32_t gain_db_q8[LM_ANTENNA_PATTERN_STEPS];
};

/* The fan between two tangents of elevation, Q20: looks between them are not weakened. */
struct lm_antenna_fan {
    int32_t high_q20, low_q20;
};

/* Cost: about 20 k instructions; once for a radar. */
void lm_antenna_pattern_set(struct lm_antenna_pattern *e, const struct lm_antenna_table *antenna);

/* The fan that reaches `fan` below an axis at `tilt` (signed BAM, up positive). An edge steeper
 * than 89 degrees up or down counts as 89 degrees. */
struct lm_antenna_fan lm_antenna_fan_at(int32_t tilt, fx_bam_t fan);

/* AUTO: the tilt, signed BAM, that points the axis at flat ground `height_m` below the antenna at
 * ground range `range_m`. */
int32_t lm_antenna_auto_tilt(int32_t height_m, uint32_t range_m);

/* Weigh the levels of the grid's cells by the pattern, each at the tangent at which it appears. A
 * cell in shadow has none of its own and stays dark. As tangents never fall along a line, only
 * cells below and above the fan are touched. Cost: see docs/benchmarks.md. */
void lm_antenna_pattern_apply(const struct lm_antenna_pattern *e, const struct lm_antenna_fan *fan,
                              const struct lm_range_grid *grid, struct lm_lit_line *lit);

#endif
