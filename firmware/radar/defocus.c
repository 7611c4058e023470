#include "lm/defocus.h"

#include "fx/log.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "lm/units.h"

enum { LINES = 2 * LM_DEFOCUS_REACH + 1, WIDTH_MAX_Q8 = LINES * 256 };

uint32_t lm_defocus_lines_q8(uint32_t lateral_mm_s2, uint32_t residual_permille,
                             uint32_t wavelength_um, uint64_t dwell_us)
{
    /* 0.42 f = 0.42 pi A' T^2 / 2 l = 0.6597 A' T^2 / l.
     *
     * Range: A' in um/s2 is below 2^34. T is cut to 2^17 ms, and its square is at most 2^34 ms2.
     * Their product could be 2^68, so A' is cut to 2^29. A dwell of half a second with that is out
     * of focus altogether. */
    const uint64_t whole_ms = lm_ms_of_us(dwell_us);
    const uint64_t dwell_ms = whole_ms < 1 << 17 ? whole_ms : 1 << 17;
    uint64_t residual_um_s2 = (uint64_t)lateral_mm_s2 * residual_permille;
    residual_um_s2 = residual_um_s2 < 1 << 29 ? residual_um_s2 : 1 << 29;
    /* The unit um/s2 ms2 / um is 10^-6. The quotient is below 2^53 for a wavelength of a
     * millimetre; 0.6597 in Q8 is 169. */
    const uint64_t turns = residual_um_s2 * dwell_ms * dwell_ms / wavelength_um;
    const uint64_t smear_lines_q8 = turns * 169 / 1000000;
    if (smear_lines_q8 >= WIDTH_MAX_Q8) {
        return WIDTH_MAX_Q8;
    }
    const uint32_t width_lines_q8 = fx_hypot_u32(256, (int32_t)smear_lines_q8);
    return width_lines_q8 < WIDTH_MAX_Q8 ? width_lines_q8 : WIDTH_MAX_Q8;
}

void lm_defocus_shares(uint32_t width_lines_q8, uint32_t share_q16[LINES])
{
    /* Share of line m: the overlap of [m - 1/2, m + 1/2] with the smear [-q/2, q/2], over q.
     * Lengths are doubled to stay whole. */
    uint32_t rest_q16 = 65536;
    for (int32_t m = LM_DEFOCUS_REACH; m > 0; m--) {
        const int32_t overlap = (int32_t)width_lines_q8 - (2 * m - 1) * 256;
        const uint32_t part = overlap < 0 ? 0 : overlap < 512 ? (uint32_t)overlap : 512;
        const uint32_t share = part * 32768 / width_lines_q8;
        share_q16[LM_DEFOCUS_REACH - m] = share_q16[LM_DEFOCUS_REACH + m] = share;
        rest_q16 -= 2 * share;
    }
    share_q16[LM_DEFOCUS_REACH] = rest_q16;
}

/* P_i = sum of share_m p_(m,i). A power in Q32 is split at 16 bits before it is multiplied by a
 * share of at most 2^16: the products fit 64 bits. The shares add up to 2^16, so the sum is at most
 * the greatest power. */
void lm_defocus_run(const int16_t *const line_db_q8[LINES], const uint32_t share_q16[LINES],
                    int16_t *level_db_q8, uint64_t *power_q32, uint32_t cells)
{
    const int32_t unit_q8 = fx_db_q8_u64((uint64_t)1 << 32);
    for (uint32_t i = 0; i < cells; i++) {
        power_q32[i] = 0;
    }
    for (uint32_t m = 0; m < LINES; m++) {
        const uint64_t share = share_q16[m];
        for (uint32_t i = 0; share != 0 && i < cells; i++) {
            const uint64_t power = fx_power_q32_vec(line_db_q8[m][i]);
            power_q32[i] += (power >> 16) * share + ((power & 0xffffu) * share >> 16);
        }
    }
    for (uint32_t i = 0; i < cells; i++) {
        level_db_q8[i] = fx_sat_i16(fx_db_q8_u64(power_q32[i]) - unit_q8);
    }
}
