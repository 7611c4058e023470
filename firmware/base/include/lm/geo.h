/* Geodesy on WGS-84: the point at a distance and azimuth (direct problem), its inverse, and the
 * path of a range line over the ground. Laws: docs/EQUATIONS.md, "Position of a cell".
 *
 * Example: the cells of a line of 512 that starts at the antenna.
 *
 *     struct lm_geo_origin origin;
 *     struct lm_geo_ray ray;
 *     struct lm_ground_path path;
 *     lm_geo_set_origin(&origin, antenna);               once a position
 *     lm_geo_set_ray(&ray, &origin, azimuth);            once a line
 *     const struct lm_position points[3] = {antenna, lm_geo_along(&ray, length_m_q8 / 2),
 *                                           lm_geo_along(&ray, length_m_q8)};
 *     lm_ground_path_fit(&path, points, 512);
 *
 * Every pointer is borrowed for the call, but for the origin that a ray keeps. No function fails:
 * arguments out of range are clamped as stated. */
#ifndef LM_GEO_H
#define LM_GEO_H

#include <stdint.h>

#include <stdbool.h>

#include "fx/sat.h"
#include "fx/types.h"

/* Maps are drawn up to this latitude, north and south. Beyond it the parabola of a line of 80
 * nautical miles misses its geodesic by more than one of the line's 512 cells. */
enum { LM_GEO_POLAR_DEG = 85 };

/* A position: geodetic latitude and longitude. */
struct lm_position {
    fx_bam_t latitude;  /* north positive; as int32_t within +-FX_BAM_90 */
    fx_bam_t longitude; /* east positive; wraps at the antimeridian */
};

/* True if the position is too near to a pole for a map. */
static inline bool lm_geo_is_polar(struct lm_position position)
{
    return fx_abs_u32((int32_t)position.latitude) > FX_BAM_DEG(LM_GEO_POLAR_DEG);
}

/* Starting point of the direct problem, prepared once for many rays. */
struct lm_geo_origin {
    struct lm_position position;
    int32_t sin_q30, cos_q30;            /* of the latitude */
    int32_t axis_distance_m_q8;          /* from the Earth's axis */
    uint32_t meridian_radius_m_q8;       /* M */
    uint32_t prime_vertical_radius_m_q8; /* N */
};

/* Prepare an origin. Latitudes beyond a pole count as the pole. Cost: about 150 instructions. */
void lm_geo_set_origin(struct lm_geo_origin *o, struct lm_position position);

/* A direction from an origin, prepared once for many distances. */
struct lm_geo_ray {
    const struct lm_geo_origin *origin; /* borrowed while the ray is in use */
    int32_t sin_q30, cos_q30;           /* of the azimuth */
    int64_t per_radius_q62; /* 1 / (R * 256), R in metres being Euler's radius along the azimuth */
};

/* Prepare a ray; `azimuth` is from true north, clockwise. Cost: about 130 instructions. */
void lm_geo_set_ray(struct lm_geo_ray *r, const struct lm_geo_origin *o, fx_bam_t azimuth);

/* Point at a distance along the ray. Distances beyond 300 km count as 300 km.
 * Worst distance from the geodesic: 0.05 m at 148 km, at latitudes from 0 to 89
 * (tests/unit/firmware/base/test_geo.c). Cost: about 130 instructions, near a pole 300. */
struct lm_position lm_geo_along(const struct lm_geo_ray *r, uint32_t distance_m_q8);

/* Point at an azimuth and a distance, for one point: lm_geo_set_ray, then lm_geo_along. */
struct lm_position lm_geo_direct(const struct lm_geo_origin *o, fx_bam_t azimuth,
                                 uint32_t distance_m_q8);

/* Path of a range line over the ground, in equal steps of a cell.
 *
 * Latitude and longitude are parabolas of the cell number, stored as forward differences. From cell
 * to cell, the step is added to the coordinate and then the bend to the step. The unit is 2^-32
 * BAM, modulo 2^64, hence longitudes wrap at the antimeridian by themselves. */
struct lm_ground_path {
    uint64_t latitude, longitude;           /* of the centre of cell 0 */
    uint64_t latitude_step, longitude_step; /* from cell 0 to cell 1 */
    uint64_t latitude_bend, longitude_bend; /* added to the step at each cell */
};

/* Fit a path through three points, at the line's start, middle and end. The centre of cell
 * i = 0..cells - 1 lies (i + 1/2) / cells of the length behind the start; cells >= 1.
 *
 *     points[0]          points[1]          points[2]
 *        |---.---|---.---|---.---|---.---|---.---|        . centre of a cell
 *         cell 0                           cell cells - 1
 *
 * Cost: less than that of lm_ground_patch_path. */
void lm_ground_path_fit(struct lm_ground_path *p, const struct lm_position points[3],
                        uint32_t cells);

/* One coordinate across a patch: the parabola through its values at the left edge, the middle and
 * the right edge. All in BAM. */
struct lm_ground_parabola {
    fx_bam_t middle;
    int32_t twice_slope; /* right - left */
    int64_t bend;        /* right + left - 2 middle */
};

/* Ground patch: the part of a fan of lines that lies around a position. The lines meet in the apex,
 * the antenna, and the axis runs from it through the position.
 *
 * Nine points carry a biquadratic surface in latitude and longitude.
 *
 *     row[2]   +-------+-------+   far_m_q8      ^ azimuth
 *               \      |      /                  |
 *     row[1]     +-----+-----+                   |
 *                 \    |    /                    o position
 *     row[0]       +---+---+   near_m_q8
 *                left     right
 *                     \ /
 *                      o   apex, apex_m_q8 before the position */
struct lm_ground_patch {
    struct {
        struct lm_ground_parabola latitude, longitude;
    } row[3];
};

/* Extent of a ground patch: along its axis from near_m_q8 to far_m_q8 ahead of the position, behind
 * it if negative. At the position it reaches side_m_q8 to either side, at y ahead of it
 * side_m_q8 (apex_m_q8 + y) / apex_m_q8. The near end is not behind the apex, and all corners are
 * within 300 km. */
struct lm_ground_extent {
    int32_t near_m_q8, far_m_q8, side_m_q8;
    uint32_t apex_m_q8; /* > 0 */
};

/* Prepare a patch about `position`, with its axis at `azimuth`. Cost: about 4,500 instructions. */
void lm_ground_patch_set(struct lm_ground_patch *p, struct lm_position position, fx_bam_t azimuth,
                         const struct lm_ground_extent *extent);

/* Start, middle and end of one of `lines` lines of the fan. Line 0 is the leftmost, and line k is
 * (k + 1/2 - lines/2) / lines of the patch's width right of the axis. The surface continues beyond
 * the last line: line < lines + 32. */
void lm_ground_patch_line(const struct lm_ground_patch *p, uint32_t line, uint32_t lines,
                          struct lm_position points[3]);

/* Path of `cells` cells along a line of the patch: lm_ground_patch_line, then lm_ground_path_fit.
 * Cost: about 130 instructions. */
void lm_ground_patch_path(struct lm_ground_path *path, const struct lm_ground_patch *p,
                          uint32_t line, uint32_t lines, uint32_t cells);

/* Distance and azimuth from one position to another up to 300 km away (inverse problem), by the
 * radii at the midpoint. The error is under 0.2 % of the distance below 75 degrees of latitude, and
 * under 1 % below 85. That is enough to point the antenna, not for navigation. Cost: about 300
 * instructions. */
void lm_geo_inverse(struct lm_position from, struct lm_position to, uint32_t *distance_m_q8,
                    fx_bam_t *azimuth);

/* Ground range of a slant range over flat ground that lies height_m_q10 below, of either sign. 0 in
 * the altitude hole, where the slant range is shorter than the height. Up to 400 km.
 * Law: docs/EQUATIONS.md, "Slant range". Cost: about 150 instructions. */
uint32_t lm_ground_of_slant_m_q8(uint32_t slant_m_q8, int32_t height_m_q10);

/* Slant range of a ground range: the inverse, with the same ranges and cost. */
uint32_t lm_slant_of_ground_m_q8(uint32_t ground_m_q8, int32_t height_m_q10);

#endif
