/* Positions on WGS-84: the point at a distance and azimuth, and the path of a scan line over the
 * ground. Equations: docs/EQUATIONS.md, "Position of a cell". */
#ifndef LM_GEO_H
#define LM_GEO_H

#include <stdint.h>

#include "fx/types.h"

/* Lengths are metres * 256, but the sizes of cells are told in millimetres, cut to whole ones. */
static inline uint32_t lm_mm_of_m_q8(uint32_t length_m_q8)
{
    return (uint32_t)((uint64_t)length_m_q8 * 1000 / 256);
}

struct lm_position {
    fx_bam_t latitude; /* signed: +-FX_BAM_90 */
    fx_bam_t longitude;
};

/* What the direct problem needs of its starting point, worked out once. Lengths in metres * 256. */
struct lm_geo_origin {
    struct lm_position position;
    int32_t sin_q30, cos_q30;            /* of the latitude */
    int32_t axis_distance_m_q8;          /* from the Earth's axis */
    uint32_t meridian_radius_m_q8;       /* M */
    uint32_t prime_vertical_radius_m_q8; /* N */
};

/* Latitudes beyond a pole count as the pole. Cost: about 150 instructions. */
void lm_geo_set_origin(struct lm_geo_origin *o, struct lm_position position);

/* A direction from an origin, and what all points along it have in common. */
struct lm_geo_ray {
    const struct lm_geo_origin *origin; /* borrowed */
    int32_t sin_q30, cos_q30;           /* of the azimuth */
    int64_t per_radius_q62;             /* one over the Earth's radius along it, metres * 256 */
};

/* `azimuth` from north by east. Cost: about 130 instructions. */
void lm_geo_set_ray(struct lm_geo_ray *r, const struct lm_geo_origin *o, fx_bam_t azimuth);

/* The point `distance_m_q8` (metres * 256; beyond 300 km counts as 300 km) away along the ray, and
 * the same for one point.
 * Worst distance from the geodesic: 0.05 m at 148 km, at latitudes from 0 to 89
 * (tests/unit/firmware/base/test_geo.c). Cost: about 130 instructions, near a pole 300. */
struct lm_position lm_geo_along(const struct lm_geo_ray *r, uint32_t distance_m_q8);
struct lm_position lm_geo_direct(const struct lm_geo_origin *o, fx_bam_t azimuth,
                                 uint32_t distance_m_q8);

/* A path over the ground in equal steps: latitude and longitude are parabolas of the step number,
 * kept as forward differences in units of 2^-32 BAM. Longitudes wrap, as they should. */
struct lm_ground_path {
    uint64_t latitude, longitude;
    uint64_t latitude_step, longitude_step;
    uint64_t latitude_bend, longitude_bend; /* what a step adds to the step */
};

/* The path whose cell i (0..cells-1) is centred (i + 1/2) / cells of the way, through three points
 * at the start, middle and end. cells >= 1. */
void lm_ground_path_fit(struct lm_ground_path *p, const struct lm_position points[3],
                        uint32_t cells);

/* One coordinate across a rectangle: the parabola through its values at the left edge, the middle
 * and the right edge. */
struct lm_ground_parabola {
    fx_bam_t middle;
    int32_t twice_slope; /* right less left */
    int64_t bend;        /* right and left less twice the middle */
};

/* A rectangle of ground whose `along` axis runs at an azimuth through a place: nine points that
 * carry a biquadratic surface in latitude and longitude, rows from near to far, across from left to
 * right as seen along the azimuth. */
struct lm_ground_patch {
    struct {
        struct lm_ground_parabola latitude, longitude;
    } row[3];
};

/* How far a rectangle reaches, metres * 256: along its axis from `near_m_q8` to `far_m_q8` ahead of
 * the place (behind it when negative), and to either side. All within 300 km. */
struct lm_ground_extent {
    int32_t near_m_q8, far_m_q8, side_m_q8;
};

/* Cost: about 4,500 instructions. */
void lm_ground_patch_set(struct lm_ground_patch *p, struct lm_position position, fx_bam_t azimuth,
                         const struct lm_ground_extent *extent);

/* The beginning, middle and end of line `line` of `lines`, whose across offset is (line + 1/2 -
 * lines/2) / lines of the width. The surface goes on beyond the last line: line < lines + 32. */
void lm_ground_patch_line(const struct lm_ground_patch *p, uint32_t line, uint32_t lines,
                          struct lm_position points[3]);

/* The path of `cells` cells along that line. Cost: about 130 instructions. */
void lm_ground_patch_path(struct lm_ground_path *path, const struct lm_ground_patch *p,
                          uint32_t line, uint32_t lines, uint32_t cells);

/* Great-circle style distance and azimuth of a point up to 300 km away, by the midpoint's radii;
 * error under 0.2 % of the distance below 75 degrees of latitude. For looking at a place, not for
 * navigation. Cost: about 300 instructions. */
void lm_geo_inverse(struct lm_position from, struct lm_position to, uint32_t *distance_m_q8,
                    fx_bam_t *azimuth);

/* Ground range of slant range `slant_m_q8`, and back, for flat ground `height_m_q10` (metres *
 * 1024, either sign) below; 0 in the altitude hole. Up to 400 km. Cost: about 150 instructions. */
uint32_t lm_ground_of_slant_m_q8(uint32_t slant_m_q8, int32_t height_m_q10);
uint32_t lm_slant_of_ground_m_q8(uint32_t ground_m_q8, int32_t height_m_q10);

#endif
