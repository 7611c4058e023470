#include "lm/geo.h"

#include "fx/const.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/const.h"
#include "lm/units.h"

static const int64_t semi_major_m_q8 = LM_M_Q8((int64_t)LM_SEMI_MAJOR_M);
enum { FLATTENING_Q30 = (1 << 30) - LM_ECCENTRICITY2_Q30, DISTANCE_MAX_M_Q8 = LM_M_Q8(300000) };

static const int64_t one_q32 = 1LL << 32;

static int64_t mul_q30(int64_t a, int64_t b_q30)
{
    return (a * b_q30 + (1 << 29)) >> 30;
}

/* Root of a number in Q30, as Q30. */
static int64_t sqrt_q30(int64_t a_q30)
{
    return (int64_t)fx_sqrt_u64((uint64_t)a_q30 << 30);
}

void lm_geo_set_origin(struct lm_geo_origin *o, struct lm_position position)
{
    const int64_t one_q30 = 1 << 30;
    const int32_t pole = (int32_t)FX_BAM_90;
    const int32_t latitude = fx_clamp_i32((int32_t)position.latitude, -pole, pole);
    o->position = (struct lm_position){(fx_bam_t)latitude, position.longitude};
    o->sin_q30 = fx_sin_q30(o->position.latitude);
    o->cos_q30 = fx_cos_q30(o->position.latitude);
    const int64_t sin2_q30 = mul_q30(o->sin_q30, o->sin_q30);
    const int64_t w2_q30 = one_q30 - mul_q30(sin2_q30, LM_ECCENTRICITY2_Q30);
    const int64_t w_q30 = sqrt_q30(w2_q30);
    /* W^2 = 1 - e2 sin2, N = a / W, M = N (1 - e2) / W^2. semi_major_m_q8 << 30 is below
     * 2^31 * 2^30 = 2^61. */
    const int64_t n_q8 = (semi_major_m_q8 << 30) / w_q30;
    const int64_t m_q8 = mul_q30(n_q8, FLATTENING_Q30) * one_q30 / w2_q30;
    o->prime_vertical_radius_m_q8 = (uint32_t)n_q8;
    o->meridian_radius_m_q8 = (uint32_t)m_q8;
    o->axis_distance_m_q8 = (int32_t)mul_q30(n_q8, o->cos_q30);
}

void lm_geo_set_ray(struct lm_geo_ray *r, const struct lm_geo_origin *o, fx_bam_t azimuth)
{
    const int64_t sin_az = fx_sin_q30(azimuth), cos_az = fx_cos_q30(azimuth);
    /* Euler's radius along the azimuth: 1/R = cos2 A / M + sin2 A / N. */
    const int64_t n_q8 = o->prime_vertical_radius_m_q8, m_q8 = o->meridian_radius_m_q8;
    const int64_t mix_q8 =
        mul_q30(n_q8, mul_q30(cos_az, cos_az)) + mul_q30(m_q8, mul_q30(sin_az, sin_az));
    const int64_t radius_m_q8 = m_q8 * n_q8 / mix_q8; /* the product is below 2^31 * 2^31 */
    r->origin = o;
    r->sin_q30 = (int32_t)sin_az;
    r->cos_q30 = (int32_t)cos_az;
    r->per_radius_q62 = ((int64_t)1 << 62) / radius_m_q8; /* about 2^31.4 */
}

/* atan t = t - t^3 / 3 + t^5 / 5 for |t| up to 1/16, with an error of at most 6e-10. */
static inline fx_bam_t small_angle(int64_t t_q32)
{
    const int64_t third_q32 = 1431655765, fifth_q32 = 858993459;
    const int64_t square_q32 = t_q32 * t_q32 >> 32;
    const int64_t bend_q32 = square_q32 * (third_q32 - (square_q32 * fifth_q32 >> 32)) >> 32;
    const int64_t radians_q32 = t_q32 - (t_q32 * bend_q32 >> 32);
    return (fx_bam_t)((radians_q32 * FX_BAM_PER_RADIAN + one_q32 / 2) >> 32);
}

/* Longitude, relative to the x axis, of a point (x, east) in the plane of the equator, and its
 * distance from the Earth's axis. |x| < 2^35, |east| < 2^31. */
static inline fx_bam_t longitude_in_plane(int64_t x_q12, int64_t east_m_q12, int64_t *axis_q12)
{
    if ((east_m_q12 < 0 ? -east_m_q12 : east_m_q12) >= x_q12 / 16) { /* near a pole */
        const int32_t x_q8 = lm_m_q8_of_m_q12(x_q12), east_m_q8 = lm_m_q8_of_m_q12(east_m_q12);
        *axis_q12 = lm_m_q12_of_m_q8(fx_hypot_u32(x_q8, east_m_q8));
        return fx_atan2(east_m_q8, x_q8);
    }
    /* With t = east / x, up to 1/16, the root of x^2 + east^2 is x + east t / 2 (1 - t^2 / 4 +
     * ...). The terms left out are at most 2 cm. */
    const int64_t t_q32 = east_m_q12 * one_q32 / x_q12, square_q32 = t_q32 * t_q32 >> 32;
    const int64_t more_q12 = east_m_q12 * t_q32 >> 33;
    *axis_q12 = x_q12 + more_q12 - (more_q12 * square_q32 >> 34);
    return small_angle(t_q32);
}

/* The point follows the circle of Euler's radius R in the normal section (docs/EQUATIONS.md,
 * "Position of a cell"), in Cartesian coordinates with the Earth's axis upwards:
 *
 *     forward = R sin(s/R), split into north and east       down = R (1 - cos(s/R))
 *
 * Ranges: lengths are relative to the origin, in metres * 4096. 300 km is below 2^31. A product
 * with a sine in Q30 then stays below 2^61, and a sum of two products below 2^62. */
struct lm_position lm_geo_along(const struct lm_geo_ray *r, uint32_t distance_m_q8)
{
    const struct lm_geo_origin *const o = r->origin;
    const int64_t sin_q30 = o->sin_q30, cos_q30 = o->cos_q30;
    const int64_t sixth_q32 = 715827883, twentieth_q32 = 214748365;
    /* The arc a = s / R is below 0.05: 2^27 * 2^31.4 before the shift, 2^28 after it. Short series
     * are enough: R sin a = s - s a^2 / 6 (1 - a^2 / 20), R (1 - cos a) = s a / 2 (1 - a^2 / 12).
     */
    const int64_t s_m_q8 = fx_min_u32(distance_m_q8, DISTANCE_MAX_M_Q8),
                  s_m_q12 = lm_m_q12_of_m_q8(s_m_q8);
    const int64_t arc_q32 = s_m_q8 * r->per_radius_q62 >> 30, square_q32 = arc_q32 * arc_q32 >> 32;
    const int64_t sixth_square_q32 = square_q32 * sixth_q32 >> 32;
    const int64_t bend_q32 =
        sixth_square_q32 - (sixth_square_q32 * (square_q32 * twentieth_q32 >> 32) >> 32);
    const int64_t forward_q12 = s_m_q12 - (s_m_q12 * bend_q32 >> 32);
    const int64_t chord_q12 = s_m_q12 * arc_q32 >> 33;
    const int64_t down_q12 = chord_q12 - (chord_q12 * sixth_square_q32 >> 33);
    const int64_t north_m_q12 = mul_q30(forward_q12, r->cos_q30);
    const int64_t east_m_q12 = mul_q30(forward_q12, r->sin_q30);

    const int64_t x0_q12 = lm_m_q12_of_m_q8(o->axis_distance_m_q8);
    const int64_t x_q12 = x0_q12 - ((north_m_q12 * sin_q30 + down_q12 * cos_q30) >> 30);
    const int64_t up_q12 = (north_m_q12 * cos_q30 - down_q12 * sin_q30) >> 30; /* along the axis */
    int64_t axis_q12;
    const fx_bam_t east = longitude_in_plane(x_q12, east_m_q12, &axis_q12);
    /* tan(latitude) = z / ((1 - e2) axis), for the point and for the origin alike. Scaled so, the
     * origin is the vector of length (1 - e2) N in the direction of its latitude. The latitude's
     * difference is the small angle between the two vectors: its tangent is the part of the point's
     * vector beside that direction over the part along it. */
    const int64_t out_q12 = mul_q30(axis_q12 - x0_q12, FLATTENING_Q30);
    const int64_t beside_q42 = up_q12 * cos_q30 - out_q12 * sin_q30;
    const int64_t along_m_q12 =
        lm_m_q12_of_m_q8(mul_q30(o->prime_vertical_radius_m_q8, FLATTENING_Q30)) +
        ((out_q12 * cos_q30 + up_q12 * sin_q30) >> 30);
    return (struct lm_position){
        .latitude = o->position.latitude + small_angle(beside_q42 / (along_m_q12 >> 2)),
        .longitude = o->position.longitude + east,
    };
}

struct lm_position lm_geo_direct(const struct lm_geo_origin *o, fx_bam_t azimuth,
                                 uint32_t distance_m_q8)
{
    struct lm_geo_ray ray;
    lm_geo_set_ray(&ray, o, azimuth);
    return lm_geo_along(&ray, distance_m_q8);
}

/* difference / cells in units of 2^-32, modulo 2^64. The whole part is taken first, because
 * difference * 2^32 would overflow. */
static int64_t per_cell(int64_t difference, int64_t cells)
{
    const int64_t whole = difference / cells, rest = difference % cells;
    return (int64_t)((uint64_t)whole << 32) + rest * one_q32 / cells;
}

/* Fit one coordinate: the parabola through (0, a), (1/2, b), (1, c), sampled at (i + 1/2) / cells.
 * With u = b - a and v = c - 2b + a it is f(x) = a + (2u - v) x + 2 v x^2. */
static void fit_coordinate(uint32_t a, uint32_t b, uint32_t c, uint32_t cells, uint64_t *value,
                           uint64_t *step, uint64_t *bend)
{
    const int64_t u = (int32_t)(b - a), v = (int32_t)(c - b) - u;
    const int64_t slope = per_cell(2 * u - v, (int64_t)cells);
    const int64_t curve = per_cell(2 * v, (int64_t)cells) / (int64_t)cells;
    /* f((i + 1/2) / n) is a + slope / 2 + curve / 4 at i = 0. The first difference is
     * slope + 2 curve, and the second 2 curve. */
    *value = ((uint64_t)a << 32) + (uint64_t)(slope / 2 + curve / 4);
    *step = (uint64_t)slope + 2 * (uint64_t)curve;
    *bend = 2 * (uint64_t)curve;
}

void lm_ground_path_fit(struct lm_ground_path *p, const struct lm_position points[3],
                        uint32_t cells)
{
    fit_coordinate(points[0].latitude, points[1].latitude, points[2].latitude, cells, &p->latitude,
                   &p->latitude_step, &p->latitude_bend);
    fit_coordinate(points[0].longitude, points[1].longitude, points[2].longitude, cells,
                   &p->longitude, &p->longitude_step, &p->longitude_bend);
}

static struct lm_ground_parabola parabola_of(fx_bam_t left, fx_bam_t middle, fx_bam_t right)
{
    return (struct lm_ground_parabola){
        .middle = middle,
        .twice_slope = (int32_t)(right - left),
        .bend = (int32_t)(right - middle) + (int64_t)(int32_t)(left - middle),
    };
}

void lm_ground_patch_set(struct lm_ground_patch *p, struct lm_position position, fx_bam_t azimuth,
                         const struct lm_ground_extent *extent)
{
    /* Each of the nine points is found by its own azimuth and distance from the position. */
    struct lm_geo_origin o;
    lm_geo_set_origin(&o, position);
    for (int row = 0; row < 3; row++) {
        const int32_t along_m_q8 =
            extent->near_m_q8 +
            (int32_t)((int64_t)(extent->far_m_q8 - extent->near_m_q8) * row / 2);
        /* Sides are below 2^26, and the apex and the row are at most 2^27 apart. */
        const int64_t from_apex_m_q8 = (int64_t)extent->apex_m_q8 + along_m_q8;
        const int32_t side_m_q8 = (int32_t)(extent->side_m_q8 * from_apex_m_q8 / extent->apex_m_q8);
        struct lm_position q[3];
        for (int column = 0; column < 3; column++) {
            const int32_t across_m_q8 = (column - 1) * side_m_q8;
            q[column] = lm_geo_direct(&o, azimuth + fx_atan2(across_m_q8, along_m_q8),
                                      fx_hypot_u32(across_m_q8, along_m_q8));
        }
        p->row[row].latitude = parabola_of(q[0].latitude, q[1].latitude, q[2].latitude);
        p->row[row].longitude = parabola_of(q[0].longitude, q[1].longitude, q[2].longitude);
    }
}

/* Value of the parabola at x, where -1 is the left edge and 1 the right edge; |x| up to 64:
 * middle + (twice_slope / 2) x + (bend / 2) x^2. */
static inline fx_bam_t parabola_at(const struct lm_ground_parabola *a, int32_t x_q16)
{
    /* twice_slope is below 2^31, bend below 2^32 and |x| <= 2^22. So |bent| <= 2^38, and the last
     * product is below 2^61. */
    const int64_t bent = a->bend * x_q16 >> 16;
    return a->middle + (uint32_t)(((a->twice_slope + bent) * x_q16 + (1 << 16)) >> 17);
}

void lm_ground_patch_line(const struct lm_ground_patch *p, uint32_t line, uint32_t lines,
                          struct lm_position points[3])
{
    const int32_t x_q16 = (int32_t)(((int64_t)(2 * line + 1) << 16) / lines) - (1 << 16);
    for (int row = 0; row < 3; row++) {
        points[row].latitude = parabola_at(&p->row[row].latitude, x_q16);
        points[row].longitude = parabola_at(&p->row[row].longitude, x_q16);
    }
}

void lm_ground_patch_path(struct lm_ground_path *path, const struct lm_ground_patch *p,
                          uint32_t line, uint32_t lines, uint32_t cells)
{
    struct lm_position points[3];
    lm_ground_patch_line(p, line, lines, points);
    lm_ground_path_fit(path, points, cells);
}

void lm_geo_inverse(struct lm_position from, struct lm_position to, uint32_t *distance_m_q8,
                    fx_bam_t *azimuth)
{
    /* Flat-Earth law about the midpoint: north = M dlat, east = N cos(lat) dlon. The azimuth at
     * `from` is that at the midpoint less half the convergence of the meridians, dlon sin(lat). */
    struct lm_geo_origin middle;
    /* Differences are clamped at 11 degrees of latitude and 45 of longitude, beyond the 300 km of
     * the contract up to 86 degrees of latitude. An arc is then below 2^31.7, and its product with
     * a radius below 2^63. */
    const int32_t far = 1 << 27, far_east = 1 << 29;
    const int32_t dlat = fx_clamp_i32((int32_t)(to.latitude - from.latitude), -far, far);
    const int32_t dlon =
        fx_clamp_i32((int32_t)(to.longitude - from.longitude), -far_east, far_east);
    const struct lm_position half_way = {from.latitude + (uint32_t)(dlat / 2), from.longitude};
    lm_geo_set_origin(&middle, half_way);
    /* An arc is angle * 2 pi / 2^32 * radius. */
    const int64_t arc_north = (int64_t)dlat * FX_TWO_PI_Q28 >> 28;
    const int64_t arc_east = mul_q30((int64_t)dlon * FX_TWO_PI_Q28 >> 28, middle.cos_q30);
    const int64_t north_m_q8 = arc_north * middle.meridian_radius_m_q8 >> 32;
    const int64_t east_m_q8 = arc_east * middle.prime_vertical_radius_m_q8 >> 32;
    *distance_m_q8 = fx_hypot_u32((int32_t)north_m_q8, (int32_t)east_m_q8);
    const int64_t convergence = mul_q30(dlon, middle.sin_q30) / 2;
    *azimuth = fx_atan2((int32_t)east_m_q8, (int32_t)north_m_q8) - (uint32_t)convergence;
}

/* Square of a length in metres * 256. Ranges are below 2^26.7 and heights below 2^22.9, so squares
 * are below 2^54. */
static uint64_t square_q16(int64_t q8)
{
    return (uint64_t)(q8 * q8);
}

uint32_t lm_ground_of_slant_m_q8(uint32_t slant_m_q8, int32_t height_m_q10)
{
    const uint64_t slant = square_q16(slant_m_q8),
                   height = square_q16(lm_m_q8_of_m_q10(height_m_q10));
    return slant > height ? fx_sqrt_u64(slant - height) : 0;
}

uint32_t lm_slant_of_ground_m_q8(uint32_t ground_m_q8, int32_t height_m_q10)
{
    return fx_sqrt_u64(square_q16(ground_m_q8) + square_q16(lm_m_q8_of_m_q10(height_m_q10)));
}
