/* Conversions of units: each is its formula in double precision, rounded as the header says, at
 * both ends of its range, around zero and in between. */
#include "check.h"
#include "fx/const.h"
#include "lm/units.h"

#include <math.h>

/* Checks to(x) against `want`, an expression of x such as floor(x * 32 / 125), for x of
 * from..limit.
 */
#define CHECK(to, type, from, limit, want)                                                         \
    do {                                                                                           \
        for (int k_ = -2000; k_ <= 2000; k_++) {                                                   \
            const double part_ = floor((from) + ((double)(limit) - (from)) * (k_ + 2000) / 4000);  \
            const double near_[] = {part_, (double)(from) + (k_ < 0 ? 0 : k_),                     \
                                    k_ < 0 ? (double)(limit) + k_ + 1 : k_};                       \
            for (int i_ = 0; i_ < 3; i_++) {                                                       \
                const double x = near_[i_], have_ = (double)to((type)x);                           \
                if (have_ != (want)) {                                                             \
                    fail_msg(#to "(%.0f) is %.0f and should be %.0f", x, have_, (want));           \
                }                                                                                  \
            }                                                                                      \
        }                                                                                          \
    } while (0)

/* An exact conversion has a whole number to give. */
static double exact(double x)
{
    assert_true(x == rint(x));
    return x;
}

static double half_up(double x)
{
    return floor(x + 0.5);
}

#define S31  2147483647.0
#define U32  4294967295.0
#define P(n) ldexp(1, n)

TEST(metres_change_format)
{
    CHECK(lm_m_q10_of_m_q6, int32_t, 1 - P(27), P(27) - 1, exact(x * 16));
    CHECK(lm_m_q8_of_m_q6, int32_t, -S31, S31, exact(x * 4));
    CHECK(lm_m_q6_of_m_q10, int32_t, -S31, S31, trunc(x / 16));
    CHECK(lm_m_q8_of_m_q10, int32_t, -S31, S31, trunc(x / 4));
    CHECK(lm_m_q10_of_m_q8, int32_t, 1 - P(29), P(29) - 1, exact(x * 4));
    CHECK(lm_m_q14_of_m_q10, int32_t, -S31, S31, exact(x * 16));
    CHECK(lm_m_q12_of_m_q8, int64_t, -P(40), P(40), exact(x * 16));
    CHECK(lm_m_q8_of_m_q12, int64_t, 1 - P(35), P(35) - 1, floor(x / 16));
}

TEST(whole_metres_come_and_go)
{
    CHECK(lm_m_q8_of_m, uint32_t, 0, P(24) - 1, exact(x * 256));
    CHECK(lm_m_of_m_q8, uint32_t, 0, U32, trunc(x / 256));
    CHECK(lm_m_q6_of_m, int32_t, 1 - P(25), P(25) - 1, exact(x * 64));
    CHECK(lm_m_of_m_q6, int32_t, -S31, S31, trunc(x / 64));
    CHECK(lm_m_of_m_q10, int32_t, -S31, S31, trunc(x / 1024));
    assert_int_equal(LM_M_Q8(300 + 1), 301 * 256);
}

/* Products stay within the 53 bits of a double: one of Q24 ends at 2^28. */
TEST(parts_of_a_metre_come_and_go)
{
    CHECK(lm_m_q14_of_dm, int32_t, 1 - P(18), P(18) - 1, trunc(x * 8192 / 5));
    CHECK(lm_m_q8_of_mm, int32_t, -S31, S31, trunc(x * 32 / 125));
    CHECK(lm_m_q8_of_mm_u32, uint32_t, 0, U32, trunc(x * 32 / 125));
    CHECK(lm_m_q8_of_mm_nearest, uint32_t, 0, U32, half_up(x * 32 / 125));
    CHECK(lm_m_q10_of_mm, int32_t, 1 - P(24), P(24) - 1, trunc(x * 128 / 125));
    CHECK(lm_m_q24_of_mm, uint32_t, 0, P(28), trunc(x * P(24) / 1000));
    CHECK(lm_mm_of_m, uint32_t, 0, P(22) - 1, exact(x * 1000));
    CHECK(lm_mm_of_m_q8, uint32_t, 0, P(30) - 1, trunc(x * 1000 / 256));
    CHECK(lm_mm_of_m_q10, uint64_t, 0, P(32) - 1, trunc(x * 1000 / 1024));
    CHECK(lm_mm_q8_of_mm, uint32_t, 0, U32, exact(x * 256));
    CHECK(lm_mm_q8_of_m_q8, uint32_t, 0, U32, exact(x * 1000));
    CHECK(lm_um_of_mm, uint32_t, 0, U32, exact(x * 1000));
    CHECK(lm_um_of_m_q8, int64_t, -P(36), P(36), trunc(x * 15625 / 4));
    CHECK(lm_m_q8_of_um, int64_t, -P(40), P(40), trunc(x / 3906));
    CHECK(lm_um_of_nm, int64_t, -P(40), P(40), trunc(x / 1000));
    CHECK(lm_m_q6_of_nm, int64_t, 1 - P(54), P(54) - 1, trunc(x / 15625000));
}

TEST(a_metre_is_a_metre_in_every_format)
{
    assert_int_equal(lm_m_q8_of_mm(1000), LM_M_Q8(1));
    assert_int_equal(lm_m_q8_of_mm_u32(3000000000u), LM_M_Q8(3000000));
    assert_int_equal(lm_m_q8_of_mm_nearest(1000), LM_M_Q8(1));
    assert_int_equal(lm_m_q10_of_mm(-1000), -1024);
    assert_int_equal(lm_mm_of_m_q8(256), 1000);
    assert_int_equal(lm_mm_of_m_q10(1024), 1000);
    assert_int_equal(lm_um_of_m_q8(-256), -1000000);
    assert_int_equal(lm_m_q6_of_nm(-1000000000), -64);
    assert_int_equal(lm_m_q14_of_dm(10), 16384);
}

TEST(cells_pixels_and_decibels_are_in_256ths)
{
    CHECK(lm_cells_q8_of_cells, int32_t, 1 - P(23), P(23) - 1, exact(x * 256));
    CHECK(lm_cells_of_cells_q8, int32_t, -S31, S31 - 128, half_up(x / 256));
    CHECK(lm_px_q8_of_px, int32_t, 1 - P(23), P(23) - 1, exact(x * 256));
    CHECK(lm_px_of_px_q8, int32_t, -S31, S31 - 128, half_up(x / 256));
    CHECK(lm_db_q8_of_db, int32_t, 1 - P(23), P(23) - 1, exact(x * 256));
    assert_int_equal(LM_DB_Q8(-100), -25600);
    assert_int_equal(lm_cells_q8_of_m_q8(1000, 300), 853);
    assert_int_equal(lm_cells_q8_of_m_q8(-1000, 300), -853);
}

TEST(angles_and_times_change_unit)
{
    CHECK(lm_deg_of_bam, fx_bam_t, 0, U32, half_up(x * 360 / P(32)));
    CHECK(lm_deg_tenths_of_bam, int32_t, -S31, S31, half_up(x * 3600 / P(32)));
    CHECK(lm_us_of_ms, uint32_t, 0, U32, exact(x * 1000));
    CHECK(lm_ms_of_us, uint64_t, 0, P(44), trunc(x / 1000));
    assert_int_equal(lm_deg_of_bam(FX_BAM_DEG(359)), 359);
    assert_int_equal(lm_deg_tenths_of_bam((int32_t)FX_BAM_DEG(-60)), -600);
}
