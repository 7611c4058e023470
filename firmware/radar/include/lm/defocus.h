/* What unsteady flight leaves of a patch's focus: every point is smeared across lines.
 * docs/EQUATIONS.md, "Unsteady flight". */
#ifndef LM_DEFOCUS_H
#define LM_DEFOCUS_H

#include <stdint.h>

enum { LM_DEFOCUS_REACH = 4 /* lines each way */ };

/* Width of the smear, lines * 256: q = sqrt(1 + (0.42 f)^2), 256 for perfect focus and at most
 * 2 * LM_DEFOCUS_REACH + 1 lines. A lateral acceleration (mm/s2, below 2^24), of which
 * residual_permille (up to 1000) stays uncompensated, over the dwell. */
uint32_t lm_defocus_lines_q8(uint32_t lateral_mm_s2, uint32_t residual_permille,
                             uint32_t wavelength_um, uint64_t dwell_us);

/* Shares of the lines m - LM_DEFOCUS_REACH.. in line m, Q16, adding up to 65536. */
void lm_defocus_shares(uint32_t width_lines_q8, uint32_t share_q16[2 * LM_DEFOCUS_REACH + 1]);

/* The line whose power is that mean of the lines' powers. Levels above 90 dB saturate. Cost: about
 * 15 instructions a cell for each line with a share. */
void lm_defocus_run(const int32_t *const line_db_q8[2 * LM_DEFOCUS_REACH + 1],
                    const uint32_t share_q16[2 * LM_DEFOCUS_REACH + 1], int32_t *level_db_q8,
                    uint64_t *power_q32, uint32_t cells);

#endif
