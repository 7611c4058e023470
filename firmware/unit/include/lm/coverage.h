/* Coverage: how much of a picture the map covers, estimated from every sixteenth cell. */
#ifndef LM_COVERAGE_H
#define LM_COVERAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/scan_line.h"

struct lm_coverage {
    uint32_t cells_none; /* sampled cells outside the map */
    uint32_t cells_seen; /* all sampled cells */
    bool is_off_map;     /* result of lm_coverage_judge */
};

/* Sample the first `cells` cells of a line. */
void lm_coverage_add(struct lm_coverage *c, const struct lm_scan_line *line, uint32_t cells);

/* Set is_off_map: true if more than half of the sampled cells are outside the map. */
void lm_coverage_judge(struct lm_coverage *c);

#endif
