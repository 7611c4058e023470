/* Crests between cells: what stands higher between two points of a line than at both.
 *
 * A line looks at the ground once a cell: a ridge between two cells would throw no shadow. Law:
 * docs/EQUATIONS.md, "Crests between cells". */
#ifndef LM_CRESTS_H
#define LM_CRESTS_H

#include <stdbool.h>

#include "lm/illumination.h"

/* True if crests between cells are worth their cost: cells of 24 m and more that read the finest
 * LOD as it is. Coarser LODs know the tops of their cells, and ground that is finer than the map
 * has none. */
bool lm_crests_are_wanted(const struct lm_db *db, uint8_t lod, bool is_blended, uint32_t cell_mm);

/* Raise the elevations of a line's cells to the crests between them and the next. Cells are at most
 * 100 m long, and displayed from 4,096 m on. `work` has LM_CELLS_ROOM entries and means nothing
 * afterwards. Both are borrowed for the call. Cost: about 6 instructions a cell with vectors of
 * four. */
void lm_crests_raise(const struct lm_range_grid *grid, struct lm_scan_line *line, int32_t *work);

#endif
