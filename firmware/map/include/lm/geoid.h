/* Geoid: heights of mean sea level above the WGS-84 ellipsoid, at the nodes of a grid (section
 * GEOID of the image; docs/FORMATS.md, 1.11). An image of a wide area has finer grids besides, its
 * pages (section GEOID_PAGES, 1.15): lm/geoid_reader.h. */
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
    LM_GEOID_PAGE_LOG2 = 5,  /* a page has 2^5 steps a side */
};

struct lm_geoid {
    fx_bam_t south, west; /* of node [0][0]; south within -90..90 degrees */
    uint8_t latitude_shift, longitude_shift;
    uint8_t rows, columns; /* nodes, 2..LM_GEOID_NODES_MAX; rows 0: there is no grid */
    uint8_t reserved0[4];
    int16_t height_m_q6[LM_GEOID_NODES_MAX][LM_GEOID_NODES_MAX]; /* northwards, eastwards */
    uint8_t reserved1[42];
    uint32_t crc; /* of a page: CRC-32C of the bytes before it; else 0 */
};
_Static_assert(sizeof(struct lm_geoid) == 2240, "the record must be what FORMATS.md says");

/* Pages of an image: squares of 2^(shift + 5) BAM, whose rows count from the south pole and whose
 * columns from Greenwich eastwards, round the Earth. */
struct lm_geoid_pages {
    uint64_t offset; /* in the flash, of the first; the others follow row by row */
    uint32_t shift, row0, rows, column0, columns; /* rows 0: there are none */
};

/* Head of the section GEOID_PAGES. The pages follow it. */
struct lm_geoid_pages_head {
    uint32_t shift, row0, rows, column0, columns;
    uint8_t reserved[40];
    uint32_t crc; /* CRC-32C of the bytes before it */
};
_Static_assert(sizeof(struct lm_geoid_pages_head) == 64, "the record must be what FORMATS.md says");

/* Can pages lie so in a section of so many bytes? Every number is allowed. */
bool lm_geoid_pages_are_sound(const struct lm_geoid_pages_head *h, uint64_t bytes);

/* Number of the page that holds a place, from 1; 0 if none does. */
uint32_t lm_geoid_page_of(const struct lm_geoid_pages *p, struct lm_position place);

/* Is this page `number` of the image, whole and within its ranges? Every byte is allowed. */
bool lm_geoid_page_is_sound(const struct lm_geoid_pages *p, uint32_t number,
                            const struct lm_geoid *page);

/* Are all numbers of a grid within their ranges, and its nodes less than once round the Earth?
 * Every byte is allowed. */
bool lm_geoid_is_sound(const struct lm_geoid *g);

/* Height at a place, bilinear between the four nodes around it, rounded down; beyond the grid that
 * of its nearest edge. The grid is sound. Within -512..512 m, x 64. Cost: some 60 instructions. */
int32_t lm_geoid_height_m_q6(const struct lm_geoid *g, struct lm_position place);

#endif
