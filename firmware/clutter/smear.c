#include "lm/smear.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/units.h"

static int32_t clamp_cells_q8(int64_t cells_q8, int32_t most)
{
    const int64_t most_cells_q8 = lm_cells_q8_of_cells(most);
    return (int32_t)fx_clamp_i64(cells_q8, -most_cells_q8, most_cells_q8);
}

struct lm_smear lm_smear_of(int64_t across_cells_q8, int64_t along_cells_q8)
{
    const int32_t right_cells_q8 = clamp_cells_q8(across_cells_q8, LM_SMEAR_ACROSS_MAX);
    const int32_t beyond_cells_q8 = clamp_cells_q8(along_cells_q8, LM_SMEAR_ALONG_MAX);
    const uint32_t wide_q8 = fx_abs_u32(right_cells_q8), deep_q8 = fx_abs_u32(beyond_cells_q8);
    struct lm_smear s = {.slices = 1};
    while (s.slices < LM_SMEAR_SLICES && s.slices * 256 < fx_max_u32(wide_q8, deep_q8)) {
        s.slices *= 2;
    }
    s.across_cells_q8 = right_cells_q8 / (int32_t)s.slices;
    s.along_cells_q8 = beyond_cells_q8 / (int32_t)s.slices;
    s.along_stretch_q8 = fx_max_u32(deep_q8 / s.slices, 256);
    /* Range walk also widens the response across. A target that moves through w range cells stays
     * in each for 1/w of the dwell, which has that part's azimuth resolution alone. In the shape of
     * the weights that is half as wide as the response stretched w times
     * (tests/unit/firmware/targets/test_target_patch.c). */
    s.across_stretch_q8 = fx_max_u32(fx_max_u32(wide_q8 / s.slices, deep_q8 / 2), 256);
    return s;
}

int32_t lm_smear_share_db_q8(const struct lm_smear *s, uint32_t slice)
{
    /* 10 log10 of the share of each part of the dwell under the squared weights of lm/response.h,
     * from its end to its middle: of halves, quarters and eighths. The second half is symmetric. */
    static const int16_t share_db_q8[] = {-771, -2864, -954, -4754, -3088, -2005, -1501};
    const uint32_t from_end = slice < s->slices / 2 ? slice : s->slices - 1 - slice;
    const int32_t stretch_q8 =
        fx_db_q8(s->across_stretch_q8) + fx_db_q8(s->along_stretch_q8) - 2 * fx_db_q8(256);
    /* The n / 2 entries of n slices begin at n / 2 - 1. */
    return (s->slices == 1 ? 0 : share_db_q8[s->slices / 2 - 1 + from_end]) - stretch_q8;
}
