/* Lanes: length of the arrays of a range line, which holds whole groups of cells for vector
 * machines.
 *
 *     array  |0 1 2 ... cells - 1|    room     |      LM_CELLS_ROOM entries
 *            |    the line       | for a group |
 *
 * A loop over a line's cells may run to the end of the last group. What it leaves behind the last
 * cell means nothing. Rules of the kernels: lm/kernels_map.h. */
#ifndef LM_LANES_H
#define LM_LANES_H

#include "lm/config.h"

enum {
    LM_LANES = 8,                           /* cells of a group: a vector of 256 bits */
    LM_CELLS_ROOM = LM_CELLS_MAX + LM_LANES /* entries of an array with one for each cell */
};

#endif
