/* Tops of a line's cells, in the form of the kernels: shared by illumination.c and foreground.c. */
#ifndef TOPS_H
#define TOPS_H

#include "lm/illumination.h"
#include "lm/kernels_clutter.h"

/* View of grid, table and line as the kernels' argument. It borrows the arrays of all three. */
static inline struct lm_k_tops tops_of(const struct lm_range_grid *grid,
                                       const struct lm_class_lut *class_lut,
                                       const struct lm_scan_line *line)
{
    return (struct lm_k_tops){.first = grid->first,
                              .cells = grid->cells,
                              .cell = line->cell,
                              .elevation_m_q14 = line->elevation_m_q14,
                              .fall_m_q14 = grid->fall_m_q14,
                              .inverse_range = grid->inverse_range,
                              .height_dm_of_code = class_lut->height_dm};
}

#endif
