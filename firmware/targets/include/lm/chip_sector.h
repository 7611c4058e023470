/* A chip in a line of a window: each of its pixels is shared by the lines and the cells that it
 * lies between, and by its shadow the ground of them loses light. docs/EQUATIONS.md, "Signatures".
 */
#ifndef LM_CHIP_SECTOR_H
#define LM_CHIP_SECTOR_H

#include "lm/chips.h"
#include "lm/target_line.h"

enum { LM_CHIP_SPAN = 256 /* cells of a line that a chip may lie over; what is beyond is cut */ };

/* Where the origin of a chip's target is from a line. */
struct lm_chip_sector_origin {
    uint32_t range_m_q8;    /* on the ground, metres * 256 */
    int32_t off_bam;        /* azimuth of the line less that at which the target appears, */
    int32_t shadow_off_bam; /* and at which it is: Doppler does not displace a shadow */
};

/* Put the line's ground into the target's shadow, then add the target with the line's speckle,
 * which the ground has already. clutter_db_q8 is lm_clutter_area_dbm2_q8 of a cell there. Returns
 * how many cells were given something. Cost: 25 instructions a pixel of the chip, of which there
 * are at most 32 x 32, and 60 more for each that lies between this line and the next. */
uint32_t lm_chip_sector_add(const struct lm_target_candidate *candidate,
                            const struct lm_chip_sector_origin *origin,
                            const struct lm_target_line *line, int32_t clutter_db_q8,
                            int32_t *level_db_q8);

#endif
