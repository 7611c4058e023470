/* Shower: a circle of rain as the antenna sees it. These functions are shared by the lines of a
 * sector (lm/weather.h) and by patches (lm/patch_rain.h).
 * Source: docs/EQUATIONS.md, "Rain"; ITU-R P.838-3; Marshall and Palmer.
 *
 *                     . - ~ ~ - .
 *                  .'             '.        radius_m
 *     o----------[=================]-----   line of sight, turned by `aside`
 *     antenna    ^ from_m_q8       ^ to_m_q8: the chord                              */
#ifndef LM_SHOWER_H
#define LM_SHOWER_H

#include "lm/units.h"
#include "lm/weather.h"

enum { LM_NO_RAIN_Q8 = LM_DB_Q8(-300) }; /* level of a cell without rain, dB */

/* Find distance and direction of a position, from a line of sight along `azimuth` (from north).
 * False, with *b unchanged, if it is 11.25 degrees of latitude or longitude away or more. That is
 * beyond every radar range, and lm_geo_inverse does not take it. */
bool lm_bearing_find(struct lm_position antenna, struct lm_position position, fx_bam_t azimuth,
                     struct lm_bearing *b);

/* Part of a line that lies in a circle, as ranges from the antenna; 0 <= from < to. */
struct lm_chord {
    int32_t from_m_q8, to_m_q8;
};

/* Find the chord of the line that is turned by `aside` to the right of the line of sight. False,
 * with *chord unchanged, if the line misses the circle or the circle lies behind the antenna. */
bool lm_shower_chord(const struct lm_shower *s, fx_bam_t aside, struct lm_chord *chord);

/* Set loss and echo of a shower from its rain rate. Loss is that of ITU-R P.838-3 at 10 GHz and
 * horizontal polarisation; echo is that of Marshall and Palmer's drops at the given wavelength. A
 * rate of 0 counts as 1. */
void lm_shower_set_rate(struct lm_shower *s, uint32_t mm_per_h, uint32_t wavelength_um);

/* Cells of a line: centre of cell 0, distance between centres, and number. */
struct lm_shower_cells {
    uint32_t first_m_q8, cell_m_q8, cells;
};

/* Add the loss of the rain before each cell to loss_db_q8. Half of the rain in the cell itself is
 * included. */
void lm_shower_add_loss(const struct lm_shower *s, const struct lm_chord *chord,
                        const struct lm_shower_cells *reach, int32_t *restrict loss_db_q8);

/* Length of the part of a chord that lies before `range_m_q8`. */
static inline int32_t lm_chord_before_m_q8(struct lm_chord c, int32_t range_m_q8)
{
    return (range_m_q8 < c.to_m_q8 ? range_m_q8 > c.from_m_q8 ? range_m_q8 : c.from_m_q8
                                   : c.to_m_q8) -
           c.from_m_q8;
}

#endif
