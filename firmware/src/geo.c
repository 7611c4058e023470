#include "lm/geo.h"

#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"

/* WGS-84 (NIMA TR8350.2, table 3.1): semi-major axis 6,378,137 m, first eccentricity squared
 * 0.00669437999014. */
static const int64_t semi_major_q8 = 6378137LL * 256;
static const int64_t eccentricity2_q30 =
    7188035; /* 0.00669437999014 * 2^30 = 7,188,035.7: 1e-10 low */

static int64_t mul_q30(int64_t a, int64_t b_q30)
{
    return (a * b_q30 + (1 << 29)) >> 30;
}

/* Root of a number in Q30, as Q30. */
static int64_t sqrt_q30(int64_t a_q30)
{
    return (int64_t)fx_sqrt_u64((uint64_t)a_q30 << 30);
}

void lm_geo_set_origin(struct lm_geo_origin *o, struct lm_place place)
{
    const int64_t one_q30 = 1 << 30;
    o->place = place;
    o->sin_q30 = fx_sin_q30(place.latitude);
    o->cos_q30 = fx_cos_q30(place.latitude);
    const int64_t sin2_q30 = mul_q30(o->sin_q30, o->sin_q30);
    const int64_t w2_q30 = one_q30 - mul_q30(sin2_q30, eccentricity2_q30);
    const int64_t w_q30 = sqrt_q30(w2_q30);
    /* semi_major_q8 << 30 is below 2^31 * 2^30 = 2^61. */
    const int64_t n_q8 = (semi_major_q8 << 30) / w_q30;
    const int64_t m_q8 = mul_q30(n_q8, one_q30 - eccentricity2_q30) * one_q30 / w2_q30;
    o->prime_vertical_radius_q8 = (uint32_t)n_q8;
    o->meridian_radius_q8 = (uint32_t)m_q8;
    o->x_q8 = (int32_t)mul_q30(n_q8, o->cos_q30);
    o->z_q8 = (int32_t)mul_q30(mul_q30(n_q8, one_q30 - eccentricity2_q30), o->sin_q30);
}

struct lm_place lm_geo_direct(const struct lm_geo_origin *o, fx_bam_t azimuth, uint32_t distance_q8)
{
    const int64_t one_q30 = 1 << 30;
    const int64_t sin_az = fx_sin_q30(azimuth), cos_az = fx_cos_q30(azimuth);
    /* Euler: the curvature at an azimuth, from the two principal radii. */
    const int64_t n_q8 = o->prime_vertical_radius_q8, m_q8 = o->meridian_radius_q8;
    const int64_t mix_q8 =
        mul_q30(n_q8, mul_q30(cos_az, cos_az)) + mul_q30(m_q8, mul_q30(sin_az, sin_az));
    const int64_t radius_q8 = m_q8 * n_q8 / mix_q8; /* 2^31 * 2^31 */
    /* 2^32 / (2 pi) = 683,565,275.6; the arc is below 300 km, 0.05 rad, so 2^27 * 2^30 at the most.
     */
    const fx_bam_t arc = (fx_bam_t)(((int64_t)distance_q8 * 683565276) / radius_q8);
    const int64_t sin_arc = fx_sin_q30(arc);
    const int64_t half = fx_sin_q30(arc / 2);
    const int64_t forward_q8 = mul_q30(radius_q8, sin_arc);
    const int64_t down_q8 = 2 * mul_q30(radius_q8, mul_q30(half, half));
    const int64_t north_q8 = mul_q30(forward_q8, cos_az);
    const int64_t east_q8 = mul_q30(forward_q8, sin_az);

    const int64_t x_q8 = o->x_q8 - mul_q30(north_q8, o->sin_q30) - mul_q30(down_q8, o->cos_q30);
    const int64_t z_q8 = o->z_q8 + mul_q30(north_q8, o->cos_q30) - mul_q30(down_q8, o->sin_q30);
    const uint32_t axis_q8 = fx_hypot_u32((int32_t)x_q8, (int32_t)east_q8);
    const int64_t flattened_q8 = mul_q30(axis_q8, one_q30 - eccentricity2_q30);
    return (struct lm_place){
        .latitude = fx_atan2((int32_t)z_q8, (int32_t)flattened_q8),
        .longitude = o->place.longitude + fx_atan2((int32_t)east_q8, (int32_t)x_q8),
    };
}

/* difference / cells in units of 2^-32, modulo 2^64: whole part first, so that nothing overflows on
 * the way. */
static int64_t per_cell(int64_t difference, int64_t cells)
{
    const int64_t whole = difference / cells, rest = difference % cells;
    return (int64_t)((uint64_t)whole << 32) + rest * (1LL << 32) / cells;
}

/* One coordinate of the parabola through (0, a), (1/2, b), (1, c), sampled at (i + 1/2) / cells.
 * With u = b - a and v = c - 2b + a it is f(x) = a + (2u - v) x + 2 v x^2. */
static void fit_coordinate(uint32_t a, uint32_t b, uint32_t c, uint32_t cells, uint64_t *value,
                           uint64_t *step, uint64_t *bend)
{
    const int64_t u = (int32_t)(b - a), v = (int32_t)(c - b) - u;
    const int64_t slope = per_cell(2 * u - v, (int64_t)cells);
    const int64_t curve = per_cell(2 * v, (int64_t)cells) / (int64_t)cells;
    /* f((i + 1/2) / n) starts at a + slope / 2 + curve / 4 and grows by slope + 2 curve, then by 2
     * curve more each. */
    *value = ((uint64_t)a << 32) + (uint64_t)(slope / 2 + curve / 4);
    *step = (uint64_t)slope + 2 * (uint64_t)curve;
    *bend = 2 * (uint64_t)curve;
}

void lm_ground_path_fit(struct lm_ground_path *p, const struct lm_place points[3], uint32_t cells)
{
    fit_coordinate(points[0].latitude, points[1].latitude, points[2].latitude, cells, &p->latitude,
                   &p->latitude_step, &p->latitude_bend);
    fit_coordinate(points[0].longitude, points[1].longitude, points[2].longitude, cells,
                   &p->longitude, &p->longitude_step, &p->longitude_bend);
}

void lm_ground_path_skip(struct lm_ground_path *p, int32_t cells)
{
    /* Sum of a first difference that grows: n step + n (n - 1) / 2 bend, all modulo 2^64. */
    const uint64_t n = (uint64_t)(int64_t)cells;
    const uint64_t pairs = (uint64_t)((int64_t)cells * (cells - 1) / 2);
    p->latitude += n * p->latitude_step + pairs * p->latitude_bend;
    p->longitude += n * p->longitude_step + pairs * p->longitude_bend;
    p->latitude_step += n * p->latitude_bend;
    p->longitude_step += n * p->longitude_bend;
}

void lm_ground_patch_set(struct lm_ground_patch *p, struct lm_place place, fx_bam_t azimuth,
                         const struct lm_ground_extent *extent)
{
    struct lm_geo_origin o;
    lm_geo_set_origin(&o, place);
    for (int row = 0; row < 3; row++) {
        const int32_t along_q8 =
            extent->near_q8 + (int32_t)((int64_t)(extent->far_q8 - extent->near_q8) * row / 2);
        for (int column = 0; column < 3; column++) {
            const int32_t across_q8 = (column - 1) * extent->side_q8;
            p->points[row][column] = lm_geo_direct(&o, azimuth + fx_atan2(across_q8, along_q8),
                                                   fx_hypot_u32(across_q8, along_q8));
        }
    }
}

/* The parabola through three values at -1, 0, 1, at x in Q16, |x| up to 64. */
static uint32_t parabola(uint32_t left, uint32_t middle, uint32_t right, int32_t x_q16)
{
    const int64_t odd = (int32_t)(right - left); /* twice the slope */
    const int64_t even = (int32_t)(right - middle) + (int64_t)(int32_t)(left - middle);
    /* |odd| < 2^31, |even| < 2^32 and |x| <= 2^22: |bent| <= 2^38, and the last product < 2^61. */
    const int64_t bent = even * x_q16 >> 16;
    return middle + (uint32_t)(((odd + bent) * x_q16 + (1 << 16)) >> 17);
}

void lm_ground_patch_line(const struct lm_ground_patch *p, uint32_t line, uint32_t lines,
                          struct lm_place points[3])
{
    const int32_t x_q16 = (int32_t)(((int64_t)(2 * line + 1) << 16) / lines) - (1 << 16);
    for (int row = 0; row < 3; row++) {
        const struct lm_place *q = p->points[row];
        points[row].latitude = parabola(q[0].latitude, q[1].latitude, q[2].latitude, x_q16);
        points[row].longitude = parabola(q[0].longitude, q[1].longitude, q[2].longitude, x_q16);
    }
}

void lm_geo_inverse(struct lm_place from, struct lm_place to, uint32_t *distance_q8,
                    fx_bam_t *azimuth)
{
    struct lm_geo_origin middle;
    /* 2^27 BAM is 11 degrees, beyond the 300 km promised; more would overflow. */
    const int32_t far = 1 << 27;
    const int32_t dlat = fx_clamp_i32((int32_t)(to.latitude - from.latitude), -far, far);
    const int32_t dlon = fx_clamp_i32((int32_t)(to.longitude - from.longitude), -far, far);
    const struct lm_place half_way = {from.latitude + (uint32_t)(dlat / 2), from.longitude};
    lm_geo_set_origin(&middle, half_way);
    /* BAM to metres: angle * 2 pi / 2^32 * radius; 2 pi in Q28 is 1,686,629,713. */
    const int64_t arc_north = (int64_t)dlat * 1686629713 >> 28;
    const int64_t arc_east = mul_q30((int64_t)dlon * 1686629713 >> 28, middle.cos_q30);
    const int64_t north_q8 = arc_north * middle.meridian_radius_q8 >> 32;
    const int64_t east_q8 = arc_east * middle.prime_vertical_radius_q8 >> 32;
    *distance_q8 = fx_hypot_u32((int32_t)north_q8, (int32_t)east_q8);
    /* The azimuth at the midpoint, turned back by half the convergence of the meridians. */
    const int64_t convergence = mul_q30(dlon, middle.sin_q30) / 2;
    *azimuth = fx_atan2((int32_t)east_q8, (int32_t)north_q8) - (uint32_t)convergence;
}
