/* Sea: how the return of water depends on the grazing angle and on the wind. The state's own 5 dB a
 * state are in lm/class_gain.h.
 *
 *     level of water, dB                      upwind
 *        |                 _______________      |  '.         .'
 *        |              .-'                     |    '.     .'
 *        |           .-'  fourth power          |      '...'
 *        |         .'                           |    crosswind      downwind
 *        +-------------|------------- grazing   +------------------------- look
 *               critical angle
 *
 * Law: docs/EQUATIONS.md, "Sea". */
#ifndef LM_SEA_H
#define LM_SEA_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/db.h"
#include "lm/illumination.h"
#include "lm/lanes.h"
#include "lm/radar.h"
#include "lm/units.h"

enum { LM_SEA_FALL_MAX_DB_Q8 = LM_DB_Q8(24) }; /* most that a low grazing angle takes */

/* Gain of water along a line. The caller owns it. */
struct lm_sea {
    uint32_t water;       /* bit i: class i is water */
    int32_t critical_q16; /* log2 of the critical grazing angle, in radians */
    bool has_wind;
    fx_bam_t wind_from;    /* direction that the wind blows from, from north */
    int32_t wind_db_q8[3]; /* mean, first and second harmonic over the look */
    int32_t even_db_q8;    /* what all water gains at the present look */
    uint32_t first, cells; /* cells before `first` lose nothing by their grazing angle */
    int32_t cell_db_q8[LM_CELLS_ROOM]; /* gain of each cell by its grazing angle, 0 or less */
};

/* Set what the sea is like. A state above LM_SEA_STATE_MAX counts as that; `wind_from` is NULL
 * where the wind is not known: all looks return the mean. Clears the cells: lm_sea_set_cells comes
 * next. Pointers are borrowed for the call. Cost: 300 instructions, and 6,000 with a wind. */
void lm_sea_set(struct lm_sea *s, const struct lm_radar *radar, const struct lm_classes *classes,
                uint8_t state, const fx_bam_t *wind_from);

/* Set the cells: those of `grid`, whose first is centred at `first_m_q8`. Cost: 100 instructions a
 * cell. */
void lm_sea_set_cells(struct lm_sea *s, const struct lm_range_grid *grid, uint32_t first_m_q8);

/* Look along an azimuth from north. Cost: 100 instructions with a wind. */
void lm_sea_look(struct lm_sea *s, fx_bam_t azimuth);

/* Add the gain of water to the levels of a line's water, in place. `cell` is that of struct
 * lm_scan_line. Works on whole groups of 16 cells: arrays have room for them. Cost: 3 instructions
 * a cell with a wind; without, 3 for each cell below the critical angle or near to it. */
void lm_sea_run(const struct lm_sea *s, const uint32_t *cell, int16_t *level_db_q8);

#endif
