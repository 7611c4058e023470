/* Geoid: heights of mean sea level above the WGS-84 ellipsoid, at the nodes of a grid (section
 * GEOID of the image; docs/FORMATS.md, 1.11). */
#ifndef LM_GEOID_H
#define LM_GEOID_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/geo.h"

enum {
    LM_GEOID_NODES_MAX = 33, /* along a side */
    LM_GEOID_SHIFT_MIN = 16, /* nodes lie 2^shift BAM apart: 150 m .. */
    LM_GEOID_SHIFT_MAX = 27, /* .. 11 degrees */
};

struct lm_geoid {
    fx_bam_t south, west; /* of node [0][0]; south within -90..90 degrees */
    uint8_t latitude_shift, longitude_shift;
    uint8_t rows, columns; /* nodes, 2..LM_GEOID_NODES_MAX; rows 0: there is no grid */
    uint8_t reserved0[4];
    int16_t height_m_q6[LM_GEOID_NODES_MAX][LM_GEOID_NODES_MAX]; /* northwards, eastwards */
    uint8_t reserved1[46];
};
_Static_assert(sizeof(struct lm_geoid) == 2240, "the record must be what FORMATS.md says");

/* Are all numbers of a grid within their ranges, and its nodes less than once round the Earth?
 * Every byte is allowed. */
bool lm_geoid_is_sound(const struct lm_geoid *g);

/* Height at a place, bilinear between the four nodes around it, rounded down; beyond the grid that
 * of its nearest edge. The grid is sound. Within -512..512 m, x 64. Cost: some 60 instructions. */
int32_t lm_geoid_height_m_q6(const struct lm_geoid *g, struct lm_position place);

#endif
