/* Circles of rain as the antenna sees them: what a line of a sector and a patch have in common.
 * docs/EQUATIONS.md, "Rain". */
#ifndef LM_SHOWER_H
#define LM_SHOWER_H

#include "lm/weather.h"

enum { LM_NO_RAIN_Q8 = -300 * 256 };

/* Where a place lies, off the line of sight along `azimuth`. False for a place so far off that
 * lm_geo_inverse does not take it: beyond every radar range. */
bool lm_bearing_find(struct lm_position antenna, struct lm_position position, fx_bam_t azimuth,
                     struct lm_bearing *b);

/* The part of a line that lies in a circle, ranges * 256. */
struct lm_chord {
    int32_t from_m_q8, to_m_q8;
};

/* The chord of the line that is `aside` of the line of sight (to the right); false when it misses
 * the circle. */
bool lm_shower_chord(const struct lm_shower *s, fx_bam_t aside, struct lm_chord *chord);

/* Losses of ITU-R P.838-3 at 10 GHz, horizontal, and the echo of Marshall and Palmer's drops. */
void lm_shower_set_rate(struct lm_shower *s, uint32_t mm_per_h, uint32_t wavelength_um);

/* Cells of a line, metres * 256. */
struct lm_shower_cells {
    uint32_t first_m_q8, cell_m_q8, cells; /* centre of cell 0, and from centre to centre */
};

/* Add the rain's loss to each cell's: half of its own rain's included. */
void lm_shower_add_loss(const struct lm_shower *s, const struct lm_chord *chord,
                        const struct lm_shower_cells *reach, int32_t *restrict loss_db_q8);

/* How much of the chord lies before `range_m_q8`. */
static inline int32_t lm_chord_before_m_q8(struct lm_chord c, int32_t range_m_q8)
{
    return (range_m_q8 < c.to_m_q8 ? range_m_q8 > c.from_m_q8 ? range_m_q8 : c.from_m_q8
                                   : c.to_m_q8) -
           c.from_m_q8;
}

#endif
