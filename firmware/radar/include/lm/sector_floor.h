/* Floor of a sector: what antenna and processor leave of the ground in bins from which nothing
 * comes, behind the altitude hole. It is that of a patch (lm/patch_floor.h), of powers, and of the
 * lines that the beam is wide. Law: docs/EQUATIONS.md, "Floor" of the real beam.
 *
 *     line    ... k-2  k-1   k
 *     mean  of |    |    |   |   every fourth bin, none counted above a ceiling
 *     weight   .  . o  o O   O   the mean of some beam width of lines up to this one */
#ifndef LM_SECTOR_FLOOR_H
#define LM_SECTOR_FLOOR_H

#include <stdint.h>

enum { LM_SECTOR_FLOOR_STRIDE = 4 };

/* Mean of the ground so far, and what it is taken with. The caller owns it. */
struct lm_sector_floor {
    uint32_t most_q24;  /* a stronger bin counts as this one */
    uint32_t leak_q16;  /* share of the mean that is left in every bin; 0..65536 */
    uint32_t lines_max; /* lines that the beam is wide; 1 or more */
    uint32_t lines;     /* that the mean is of: 0..lines_max */
    uint64_t mean_q32;  /* power of gamma; 0..most_q24 * 2^8 */
};

/* Forget the mean: a sector starts. */
void lm_sector_floor_clear(struct lm_sector_floor *f);

/* Take the table's numbers: the leak and the ceiling as levels, and how many lines `beam` is wide.
 * The mean is kept. Leaks below -48 dB count as none, ceilings above 24 dB as that. `line` is not
 * 0. */
void lm_sector_floor_set(struct lm_sector_floor *f, int32_t leak_db_q8, int32_t most_db_q8,
                         uint32_t beam, uint32_t line);

/* Take line `number` of `bins` powers (0..LM_CELLS_MAX) into the mean. Returns the power that the
 * ground leaves in each of its bins. `power_q24` holds what the line receives behind the hole,
 * before speckle.
 * Cost: half an instruction a bin. */
uint32_t lm_sector_floor_run(struct lm_sector_floor *f, uint32_t number, const uint32_t *power_q24,
                             uint32_t bins);

#endif
