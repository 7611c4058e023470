/* Coverage of a picture by the map: how many of its cells lie outside, a cell in sixteen. */
#ifndef LM_COVERAGE_H
#define LM_COVERAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/scan_line.h"

struct lm_coverage {
    uint32_t cells_none, cells_seen; /* outside the map, and all that were looked at */
    bool is_off_map;                 /* as judged last */
};

/* Look at the first `cells` cells of a line. */
void lm_coverage_add(struct lm_coverage *c, const struct lm_scan_line *line, uint32_t cells);

/* Off the map is a picture that has more than half of its cells outside. */
void lm_coverage_judge(struct lm_coverage *c);

#endif
