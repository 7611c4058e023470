/* Coverage: how much of a picture the map covers, estimated from every sixteenth cell, and how
 * coarsely. */
#ifndef LM_COVERAGE_H
#define LM_COVERAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/scan_line.h"

struct lm_coverage {
    uint32_t cells_none; /* sampled cells outside the map */
    uint32_t cells_seen; /* all sampled cells */

    uint32_t cells_coarse; /* cells that coarser tiles answered for */
    uint32_t cells_drawn;  /* all cells */
    uint8_t seen_lod;      /* the coarsest LOD that answered */

    /* Results of lm_coverage_judge. */
    bool is_off_map;
    uint8_t coarsest_lod; /* the coarsest LOD that answered; 0 if it answered for few */
};

/* Sample the first `cells` cells of a line. */
void lm_coverage_add(struct lm_coverage *c, const struct lm_scan_line *line, uint32_t cells);

/* Set is_off_map: true if more than half of the sampled cells are outside the map. Set
 * coarsest_lod: if coarser tiles answered for more than a quarter of the cells. */
void lm_coverage_judge(struct lm_coverage *c);

/* Begin to sample anew. The results stay until the next judgement. */
void lm_coverage_restart(struct lm_coverage *c);

/* Length of the map's cells, millimetres, of a picture that reads LOD `lod`, where the picture's
 * cells are shorter by more than lm_scan_lod allows; else 0. */
uint32_t lm_coverage_coarse_mm(const struct lm_coverage *c, const struct lm_db *db, uint8_t lod,
                               uint32_t picture_cell_mm);

#endif
