/* Lanes: how long the arrays of a range line are, so that a vector machine can take whole groups of
 * cells. A loop over a line's cells may run on to a whole group; what it leaves behind the last
 * cell means nothing. */
#ifndef LM_LANES_H
#define LM_LANES_H

#include "lm/config.h"

enum {
    LM_LANES = 8,                           /* cells of a group: a vector of 256 bits */
    LM_CELLS_ROOM = LM_CELLS_MAX + LM_LANES /* entries of an array with one for each cell */
};

#endif
