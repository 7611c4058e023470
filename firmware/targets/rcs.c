#include "lm/rcs.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/const.h"
#include "lm/units.h"

/* Powers are binary logarithms in Q16: a product is a sum, and nothing overflows. The largest, a
 * plate of 100 m by 100 m at 1 mm, is 2^50 m2; the smallest factor is 2^-62. */
enum { LOG2_ONE_Q30 = 30 * 65536, LOG2_NONE = -64 * 65536 };

/* log2 of (a / wavelength) * b in metres. Lengths are in mm and the wavelength in um, so the
 * thousands cancel. */
static int32_t log2_area(uint32_t a_mm, uint32_t b_mm, uint32_t wavelength_um)
{
    return fx_log2_q16(a_mm) + fx_log2_q16(b_mm) - fx_log2_q16(wavelength_um);
}

static int32_t log2_of_q30(uint32_t x_q30)
{
    return fx_log2_q16(x_q30) - LOG2_ONE_Q30;
}

/* log2 of sinc^2(x), with x = 2 pi (side / lambda) sine: half the phase that runs over a side, out
 * and back. */
static int32_t log2_sinc2(uint32_t side_mm, uint32_t wavelength_um, int32_t sine_q30)
{
    /* At most 10^8 um / 10^3 um = 10^5, 2^33 in Q16; times a sine of 2^30: below 2^63. */
    const uint64_t side_q16 = (lm_um_of_mm(side_mm) << 16) / wavelength_um;
    const uint64_t turns_q46 = side_q16 * fx_abs_u32(sine_q30);
    if (turns_q46 < (uint64_t)1 << 34) {
        return 0; /* 1/4096 of a turn: sinc^2 is one but for 8e-7 */
    }
    const uint32_t sine = fx_abs_u32(fx_sin_q30((fx_bam_t)(turns_q46 >> 14)));
    const int32_t log2_phase = FX_LOG2_TWO_PI_Q16 + fx_log2_q16_u64(turns_q46) - 46 * 65536;
    return 2 * (log2_of_q30(sine) - log2_phase);
}

/* Physical optics: 4 pi (A / lambda)^2 cos^2 sinc^2(right) sinc^2(up), where cos is the component
 * ahead. */
static int32_t log2_plate(const struct lm_shape *s, uint32_t wavelength_um, struct lm_direction d)
{
    if (d.ahead_q30 <= 0 && !s->is_two_sided) {
        return LOG2_NONE;
    }
    return FX_LOG2_FOUR_PI_Q16 + 2 * log2_area(s->size_mm[0], s->size_mm[1], wavelength_um) +
           2 * log2_of_q30(fx_abs_u32(d.ahead_q30)) +
           log2_sinc2(s->size_mm[0], wavelength_um, d.right_q30) +
           log2_sinc2(s->size_mm[1], wavelength_um, d.up_q30);
}

/* Component of a vector (x, y) along an axis that has `a` of x and `b` of y. Both are of length
 * one, so the sum is at most 2^60. */
static int32_t along(int32_t x_q30, int64_t a_q30, int32_t y_q30, int64_t b_q30)
{
    return (int32_t)((x_q30 * a_q30 + y_q30 * b_q30 + (1 << 29)) >> 30);
}

/* Double reflection: only the part of each face's projection that the mirror image of the other one
 * covers returns. That is twice the smaller projection. On the axis both are a / sqrt 2, and the
 * law is 4 pi (2 a h m)^2 / lambda^2 with m = (b - |r|) / sqrt 2. */
static int32_t log2_dihedral(const struct lm_shape *s, uint32_t wavelength_um,
                             struct lm_direction d)
{
    const int32_t left = along(d.ahead_q30, FX_ROOT_1_2_Q30, d.right_q30, FX_ROOT_1_2_Q30);
    const int32_t right = along(d.ahead_q30, FX_ROOT_1_2_Q30, d.right_q30, -FX_ROOT_1_2_Q30);
    const int32_t smaller = fx_min_i32(left, right);
    if (smaller <= 0) {
        return LOG2_NONE;
    }
    return FX_LOG2_FOUR_PI_Q16 +
           2 * (log2_area(s->size_mm[0], s->size_mm[1], wavelength_um) + 65536 +
                log2_of_q30((uint32_t)smaller)) +
           log2_sinc2(s->size_mm[1], wavelength_um, d.up_q30);
}

static void sort(int32_t c[3])
{
    for (int i = 0; i < 3; i++) {
        const int32_t low = fx_min_i32(c[i % 2], c[i % 2 + 1]);
        c[i % 2 + 1] = fx_max_i32(c[i % 2], c[i % 2 + 1]);
        c[i % 2] = low;
    }
}

/* The triple reflection leaves mirrored at the apex. The area that returns is what the corner's
 * outline shares with its mirror image [Spencer; Keen]. With the direction cosines p <= q <= r
 * towards the legs and s = p + q + r, it is, over the square of the leg,
 *
 *     4 p q / s    if p + q <= r: the shared area is a parallelogram
 *     s - 2 / s    otherwise: a hexagon */
static int32_t log2_trihedral(const struct lm_shape *shape, uint32_t wavelength_um,
                              struct lm_direction d)
{
    const int32_t low = along(d.ahead_q30, FX_ROOT_1_3_Q30, d.up_q30, -FX_ROOT_1_6_Q30);
    int32_t c[3] = {along(low, 1 << 30, d.right_q30, FX_ROOT_1_2_Q30),
                    along(low, 1 << 30, d.right_q30, -FX_ROOT_1_2_Q30),
                    along(d.ahead_q30, FX_ROOT_1_3_Q30, d.up_q30, FX_ROOT_2_3_Q30)};
    sort(c);
    if (c[0] <= 0) {
        return LOG2_NONE;
    }
    /* s is at most the root of 3: 2^30.8, its square 2^61.6. The hexagon is (s^2 - 2) / s; the
     * division by s is in the sum below. */
    const uint32_t s = (uint32_t)c[0] + (uint32_t)c[1] + (uint32_t)c[2];
    int32_t log2_share = 0;
    if (c[0] + c[1] <= c[2]) {
        log2_share = 2 * 65536 + log2_of_q30((uint32_t)c[0]) + log2_of_q30((uint32_t)c[1]);
    } else {
        const int64_t hexagon_q60 = (int64_t)((uint64_t)s * s) - ((int64_t)2 << 60);
        if (hexagon_q60 <= 0) {
            return LOG2_NONE;
        }
        log2_share = fx_log2_q16_u64((uint64_t)hexagon_q60) - 60 * 65536;
    }
    return FX_LOG2_FOUR_PI_Q16 +
           2 * (log2_area(shape->size_mm[0], shape->size_mm[0], wavelength_um) + log2_share -
                log2_of_q30(s));
}

static int32_t log2_rcs(const struct lm_shape *shape, uint32_t wavelength_um,
                        struct lm_direction radar)
{
    switch (shape->kind) {
    case LM_SHAPE_SPHERE:
        return FX_LOG2_PI_Q16 + 2 * fx_log2_q16(shape->size_mm[0]) + LM_LOG2_MM2_Q16;
    case LM_SHAPE_PLATE:
        return log2_plate(shape, wavelength_um, radar);
    case LM_SHAPE_DIHEDRAL:
        return log2_dihedral(shape, wavelength_um, radar);
    case LM_SHAPE_TRIHEDRAL:
        return log2_trihedral(shape, wavelength_um, radar);
    default:
        return LOG2_NONE;
    }
}

int32_t lm_rcs_dbsm_q8(const struct lm_shape *shape, uint32_t wavelength_um,
                       struct lm_direction radar)
{
    const int32_t rcs_dbsm_q8 = fx_db_q8_of_log2_q16(log2_rcs(shape, wavelength_um, radar));
    return fx_max_i32(rcs_dbsm_q8, LM_RCS_NONE_DBSM_Q8);
}
