/* Chip in a line of a window: each pixel of the chip is shared between the two lines and the two
 * cells that it lies between. The chip's shadow darkens the ground in the same shares.
 * Source: docs/EQUATIONS.md, "Signatures". */
#ifndef LM_CHIP_SECTOR_H
#define LM_CHIP_SECTOR_H

#include "lm/chips.h"
#include "lm/target_line.h"

enum {
    LM_CHIP_SPAN = 256 /* cells of a line that a chip has on level ground; the rest is cut off */
};

/* Origin of a chip's target, as seen from a line. */
struct lm_chip_sector_origin {
    uint32_t range_m_q8;    /* ground range from the antenna */
    int32_t off_bam;        /* azimuth of the line less the azimuth where the target appears */
    int32_t shadow_off_bam; /* azimuth of the line less the target's true azimuth: Doppler does not
                               displace a shadow */
};

/* Darken the line's ground in the target's shadow, as far as it rises above the rays that pass over
 * the target, or falls below (lm/chip_slope.h). Then add the target, whose feet stay where the
 * ground is drawn: a window has no layover. Both are means, which take their speckle later. Returns
 * the number of cells that got power.
 *
 * - candidate->chip is resident (lm_chip_of is not NULL). All pointers are borrowed for the call.
 * - line->elevation_m_q14 is that of the line's ground; NULL: it is level.
 * - clutter_db_q8 is lm_clutter_area_dbm2_q8 of a cell there.
 * - level_db_q8 has line->cells entries.
 *
 * Cost: 25 instructions for each pixel of the chip, of which there are at most 32 x 32, and 60 more
 * for each pixel between this line and the next; 50 for each cell from the origin to the end of the
 * shadow, which is that of the line where the ground falls as a ray does. */
uint32_t lm_chip_sector_add(const struct lm_target_candidate *candidate,
                            const struct lm_chip_sector_origin *origin,
                            const struct lm_target_line *line, int32_t clutter_db_q8,
                            int16_t *level_db_q8);

#endif
