#include "lm/dbs.h"

#include "fx/bits.h"
#include "fx/sat.h"
#include "fx/trig.h"

uint32_t lm_dbs_ratio_q8(const struct lm_radar *radar, uint32_t bam_per_s, uint32_t speed_mm_s,
                         fx_bam_t off)
{
    /* N = 2 V B^2 sin o / (l w), with B and w in BAM: a radian, 2^32 / 2 pi, then divides once. B^2
     * is below 2^56 for a beam of 20 degrees. Over w, above 2^23 (0.7 degree a second), it is below
     * 2^33. Times 2 V, 2^22, it is below 2^55; 15 bits are cut before the sine, 2^15. */
    const uint64_t beam = radar->antenna.azimuth_beam;
    const uint64_t dwell_bam = beam * beam / fx_max_u32(bam_per_s, LM_RADAR_RATE_MIN);
    const uint32_t sine_q15 = fx_abs_u32(fx_sin_q15(off));
    const uint64_t swept_mm = (dwell_bam * 2 * speed_mm_s >> 15) * sine_q15; /* < 2^55 */
    /* Times 2 pi / 2^32 for the radian, 1000 / l, and 256: 2 pi * 256 * 1000 is 1608495. */
    const uint64_t ratio_q8 = (swept_mm >> 16) * 1608495 / radar->wavelength_um >> 16;
    return ratio_q8 < UINT16_MAX ? (uint32_t)ratio_q8 : UINT16_MAX;
}

uint32_t lm_dbs_sharpening_q8(const struct lm_fov_row *fov, uint32_t available_q8)
{
    if (available_q8 < fov->sharpening_least * 256u) {
        return 256;
    }
    const uint32_t ratio = fx_min_u32(available_q8 / 256, fov->sharpening);
    return 256u << (31 - fx_clz32(fx_max_u32(ratio, 1)));
}
