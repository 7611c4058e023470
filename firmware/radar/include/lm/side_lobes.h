/* Side lobes of the map: strong returns of the ground and of chips have the point response. The
 * stage finds the strongest cells of each line of a patch, and gives their side lobes to the cells
 * along and across. Law: docs/EQUATIONS.md, "Side lobes of the ground".
 *
 *               .
 *               .              a cross: along the line of the cell, and on the lines beside it,
 *
 *       . . .   #   . . .      from the second cell to LM_RESPONSE_REACH on each side
 *
 *               .
 *               .
 *
 * Order of the calls: _clear for a patch, _find for each line once it has its noise and speckle,
 * _add for each line in turn, once those LM_RESPONSE_REACH lines further on were searched. A line
 * has all its side lobes when _add was called for that LM_RESPONSE_REACH lines further on. No call
 * fails. */
#ifndef LM_SIDE_LOBES_H
#define LM_SIDE_LOBES_H

#include <stdint.h>

#include "lm/radar.h"
#include "lm/response.h"

enum {
    LM_SIDE_LOBES_A_LINE = LM_RADAR_SIDE_LOBES_MAX,
    LM_SIDE_LOBES_LINES = 32,  /* lines whose strong cells are remembered */
    LM_SIDE_LOBES_OFFSETS = 8, /* places of a point in its cell, each way */
    LM_SIDE_LOBES_CELLS = 2 * LM_RESPONSE_REACH + 1
};

/* Strong cell: its level with speckle, and where in the cell its point lies, each way: place 0..7
 * is an odd sixteenth, from 7/16 before the middle to 7/16 behind it. What is kept is where the
 * place's side lobes begin, in side_db_q8 below. */
struct lm_strong_cell {
    int16_t cell, level_db_q8;
    uint16_t right, beyond;
};

/* Strong cells of the lines sampled last. The caller owns it; all fields are
 * read-only to others. */
struct lm_side_lobes {
    const struct lm_side_lobe_config *config; /* borrowed */
    struct {
        uint32_t count;
        struct lm_strong_cell strong[LM_SIDE_LOBES_A_LINE]; /* the strongest first */
    } line[LM_SIDE_LOBES_LINES];                            /* line n at n % LM_SIDE_LOBES_LINES */
    /* Side lobes of a point over its response in its own cell, mean over the places there: for each
     * place, by the cells from its own, -LM_RESPONSE_REACH first. */
    int16_t side_db_q8[LM_SIDE_LOBES_OFFSETS * LM_SIDE_LOBES_CELLS];
};

/* Forget all lines. `config` is borrowed until the next call. Cost: some 7,000 instructions. */
void lm_side_lobes_clear(struct lm_side_lobes *s, const struct lm_side_lobe_config *config);

/* Find the strong cells of line `line`, which is the one after the last. A cell is strong if its
 * level is the largest within LM_RESPONSE_REACH / 2 cells along, and stands as high over a shadow,
 * of `shadow_db_q8`, and over the cells at both ends of these as the table asks. `seed` chooses
 * where in its cell a point lies. Cost: 1 instruction a cell, 120 for each group of 16 that may
 * hold one of the strongest, and 50 for each cell in it that stands out; of a town, 4 a cell. */
void lm_side_lobes_find(struct lm_side_lobes *s, uint32_t line, const int16_t *level_db_q8,
                        uint32_t cells, int32_t shadow_db_q8, uint32_t seed);

/* Add the side lobes of the strong cells of line `line` to its levels and to those of the lines
 * around it. around[LM_RESPONSE_REACH] are its own levels, around[0] those LM_RESPONSE_REACH lines
 * before it; where the patch has no line, any that is not shown. Cost: some 150 instructions for
 * each strong cell. */
void lm_side_lobes_add(const struct lm_side_lobes *s, uint32_t line,
                       int16_t *const around[LM_SIDE_LOBES_CELLS], uint32_t cells);

#endif
