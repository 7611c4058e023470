/* Defocus: smear of a whole patch across its lines by unsteady flight. Motion compensation leaves a
 * part of the lateral acceleration, and each point is spread over several lines.
 * Source: docs/EQUATIONS.md, "Unsteady flight". */
#ifndef LM_DEFOCUS_H
#define LM_DEFOCUS_H

#include <stdint.h>

enum { LM_DEFOCUS_REACH = 4 /* lines each way */ };

/* Width of the smear in lines: q = sqrt(1 + (0.42 f)^2), where f is the quadratic phase at the ends
 * of the aperture. 256 is perfect focus; the most is 2 * LM_DEFOCUS_REACH + 1 lines. lateral_mm_s2
 * is below 2^24; residual_permille of it, up to 1000, stays uncompensated over the dwell. */
uint32_t lm_defocus_lines_q8(uint32_t lateral_mm_s2, uint32_t residual_permille,
                             uint32_t wavelength_um, uint64_t dwell_us);

/* Compute the shares of lines m - LM_DEFOCUS_REACH .. m + LM_DEFOCUS_REACH in line m. They add up
 * to 65536. */
void lm_defocus_shares(uint32_t width_lines_q8, uint32_t share_q16[2 * LM_DEFOCUS_REACH + 1]);

/* Compute a line as the mean of the powers of its neighbours by their shares. Levels above 90 dB
 * saturate. `level_db_q8` (result) and `power_q32` (work space) have `cells` entries. Cost: about
 * 15 instructions a cell for each line with a share. */
void lm_defocus_run(const int16_t *const line_db_q8[2 * LM_DEFOCUS_REACH + 1],
                    const uint32_t share_q16[2 * LM_DEFOCUS_REACH + 1], int16_t *level_db_q8,
                    uint64_t *power_q32, uint32_t cells);

#endif
