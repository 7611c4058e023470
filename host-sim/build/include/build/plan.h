/* Plan of an image: its levels, and the rectangles of tiles on each (docs/FORMATS.md, 1.2 and
 * 1.4). */
#ifndef BUILD_PLAN_H
#define BUILD_PLAN_H

#include "image/grid.h"
#include "lm/db.h"

#include <stdint.h>

/* An area that has data of its own from a level upward: a 90 m terrain model gives nothing to a
 * level of 5 m. */
struct build_extent {
    struct image_area area;
    int level;
};

struct build_plan {
    uint8_t shift0, level_count;
    uint16_t band_count;
    uint32_t entry_count;
    struct lm_band bands[LM_DB_BANDS_MAX];
};

/* Lay out levels until one has at most 4 tiles and all extents have begun, or the format ends.
 * Extents whose level lies beyond the last one are moved to it. Returns 0, or -1 with the error
 * (too many tiles) reported. */
int build_plan_make(struct build_plan *plan, uint8_t shift0, struct build_extent *extents,
                    int count);

/* The band that holds a row of a level, or NULL. */
const struct lm_band *build_plan_band(const struct build_plan *plan, int level, uint32_t row);

/* The level whose cells are the largest that are not larger than `pixel_bam`, negative when level 0
 * is too large. */
int build_plan_level(uint8_t shift0, double pixel_bam);

#endif
