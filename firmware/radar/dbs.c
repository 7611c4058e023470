#include "lm/dbs.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "fx/trig.h"

uint32_t lm_dbs_ratio_q8(const struct lm_radar *radar, const struct lm_dbs_scan *scan, fx_bam_t off)
{
    /* N = 2 V B^2 sin o / (l w), with B and w in BAM: a radian, 2^32 / 2 pi, then divides once. B^2
     * is below 2^56 for a beam of 20 degrees. Over w, above 2^23 (0.7 degree a second), it is below
     * 2^33. Times 2 V, 2^22, it is below 2^55; 15 bits are cut before the sine, 2^15. */
    const uint64_t beam = radar->antenna.azimuth_beam;
    const uint64_t dwell_bam = beam * beam / fx_max_u32(scan->bam_per_s, LM_RADAR_RATE_MIN);
    const uint32_t sine_q15 = fx_abs_u32(fx_sin_q15(off));
    const uint64_t swept_mm = (dwell_bam * 2 * scan->speed_mm_s >> 15) * sine_q15; /* < 2^55 */
    /* Times 2 pi / 2^32 for the radian, 1000 / l, and 256: 2 pi * 256 * 1000 is 1608495. */
    const uint64_t ratio_q8 = (swept_mm >> 16) * 1608495 / radar->wavelength_um >> 16;
    return ratio_q8 < LM_DBS_RATIO_MAX_Q8 ? (uint32_t)ratio_q8 : LM_DBS_RATIO_MAX_Q8;
}

/* Angle to the velocity, ahead or astern: 0..90 degrees. */
static fx_bam_t to_track(fx_bam_t off)
{
    const uint32_t ahead = fx_abs_u32((int32_t)off);
    return ahead <= FX_BAM_90 ? ahead : FX_BAM_180 - ahead;
}

/* Ratio at `off` nearer to the velocity than `fade`: that at `fade`, times e^((off - fade) / fade).
 * The exponent of 2 is within 0 and -1.45, so both factors are at most 2^16. */
static uint32_t faded_ratio_q8(const struct lm_radar *radar, const struct lm_dbs_scan *scan,
                               fx_bam_t off, fx_bam_t fade)
{
    const uint64_t nearer_q16 = ((uint64_t)(fade - off) << 16) / fade;
    const uint32_t share_q16 = fx_exp2_q16(-(int32_t)(nearer_q16 * FX_LOG2_E_Q16 >> 16));
    return (uint32_t)((uint64_t)lm_dbs_ratio_q8(radar, scan, fade) * share_q16 >> 16);
}

uint32_t lm_dbs_sharpening_q8(const struct lm_radar *radar, const struct lm_dbs_scan *scan,
                              uint32_t wanted, fx_bam_t off)
{
    const fx_bam_t to = to_track(off);
    const fx_bam_t fade = fx_min_u32(
        fx_min_u32(scan->line, FX_BAM_90 / LM_DBS_FADE_LINES) * LM_DBS_FADE_LINES, FX_BAM_90);
    const uint32_t ratio_q8 =
        to < fade ? faded_ratio_q8(radar, scan, to, fade) : lm_dbs_ratio_q8(radar, scan, to);
    return fx_max_u32(fx_min_u32(ratio_q8, wanted * 256), 256);
}

/* x, the angle to the nearest beam position in beams, is at most 1/2 of a step that is not longer
 * than the beam: x^2 is below 2^22.1 in Q24. */
uint32_t lm_dbs_scallop_q16(const struct lm_radar *radar, const struct lm_fov_row *fov,
                            uint32_t ratio_q8, int32_t azimuth)
{
    if (fov->beam_step == 0) {
        return 65536;
    }
    const int64_t step = fov->beam_step, shifted = (int64_t)azimuth + step / 2;
    const int64_t position = (shifted - (shifted < 0 ? step - 1 : 0)) / step;
    const uint64_t off = fx_abs_u32((int32_t)(azimuth - position * step));
    const uint64_t x_q12 = (off << 12) / fx_max_u32(radar->antenna.azimuth_beam, 1);
    /* Real beam, 1/N^2 = 1, has no beam positions. */
    const uint64_t by_doppler_q16 = 65536 - (1ull << 32) / ((uint64_t)ratio_q8 * ratio_q8);
    return fx_exp2_q16(-(int32_t)((x_q12 * x_q12 >> 5) * by_doppler_q16 >> 16));
}
