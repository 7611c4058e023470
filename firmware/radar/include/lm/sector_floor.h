/* Floor of a sector: what antenna and processor leave of the ground in bins from which nothing
 * comes, behind the altitude hole. It is that of a patch (lm/patch_floor.h), of powers, and of the
 * lines that the beam is wide. It follows the ground along range, so that land does not whiten a
 * lake far behind it. Law: docs/EQUATIONS.md, "Floor" of the real beam.
 *
 *     line    ... k-2  k-1   k
 *     mean  of |    |    |   |   every fourth bin of each stretch, none counted above a ceiling
 *     weight   .  . o  o O   O   the mean of some beam width of lines up to this one
 *
 *     bin     | stretch | stretch | the last, up to twice as long |
 *     floor        ^---------^-----------^                  linear between the stretches' means */
#ifndef LM_SECTOR_FLOOR_H
#define LM_SECTOR_FLOOR_H

#include <stdint.h>

#include "lm/config.h"

enum {
    LM_SECTOR_FLOOR_STRIDE = 4,
    LM_SECTOR_FLOOR_REACH_M =
        1500, /* a stretch is the least power of two of bins as long as this */
    LM_SECTOR_FLOOR_BINS_LOG2_MIN = 5,
    LM_SECTOR_FLOOR_STRETCHES = LM_CELLS_MAX >> LM_SECTOR_FLOOR_BINS_LOG2_MIN
};

/* Means of the ground so far, and what they are taken with. The caller owns it. */
struct lm_sector_floor {
    uint32_t bins_log2; /* of a stretch */
    uint32_t most_q24;  /* a stronger bin counts as this one; below 2^26 */
    uint32_t leak_q16;  /* share of the mean that is left in every bin; 0..65536 */
    uint32_t lines_max; /* lines that the beam is wide; 1 or more */
    uint32_t lines;     /* that the means are of: 0..lines_max */
    uint32_t mean_q29[LM_SECTOR_FLOOR_STRETCHES]; /* power of gamma; 0..most_q24 * 2^5 */
};

/* Forget the means: a sector starts. */
void lm_sector_floor_clear(struct lm_sector_floor *f);

/* What the floor is taken with: levels of the table, the antenna's beam, and distances of a
 * sector's lines and bins. */
struct lm_sector_floor_setting {
    int32_t leak_db_q8;  /* below -48 dB it counts as nothing */
    int32_t most_db_q8;  /* ceiling; above 6 dB it counts as that */
    uint32_t beam, line; /* width, and from line to line, BAM; `line` is not 0 */
    uint32_t cell_m_q8;  /* from bin to bin; not 0 */
};

/* The means are kept if the stretches are as long as before. */
void lm_sector_floor_set(struct lm_sector_floor *f, const struct lm_sector_floor_setting *setting);

/* Take line `number` of `bins` powers (0..LM_CELLS_MAX) into the means, and add to each of its bins
 * the power that the ground leaves there. What does not fit is the largest power. `power_q24` holds
 * what the line receives behind the hole, before speckle.
 * Cost: 2 instructions a bin. */
void lm_sector_floor_run(struct lm_sector_floor *f, uint32_t number, uint32_t *power_q24,
                         uint32_t bins);

#endif
