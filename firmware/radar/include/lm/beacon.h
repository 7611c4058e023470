/* Beacon: what a radar in beacon mode shows of the ground's radar beacons (transponders). A beacon
 * that is interrogated answers on a frequency of its own with a few pulses; ground and targets do
 * not. The display shows the pulses as short arcs, the first where the beacon is:
 *
 *     time    0     3     6     9    12    15 us        15 us are 2.2 km of range
 *             |     |     |     |     |     |
 *             F     1     2     4     8     F           F: frames; 1 to 8: the code's bits
 *
 *     code 5: F     1           4           F
 *
 * The reply is a byte: its code, 0..15, in the low half; in the high half by how many microseconds
 * the beacon answers late, 0..15. A late one seems farther away.
 *
 * Source: docs/EQUATIONS.md, "Beacons". */
#ifndef LM_BEACON_H
#define LM_BEACON_H

#include "lm/line.h"
#include "lm/slant.h"

/* A sample of a sector in beacon mode. Borrowed for the call. */
struct lm_beacon_sample {
    const struct lm_line_targets *targets;
    const struct lm_range_grid *grid;
    const struct lm_slant *slant;
    const struct lm_antenna_pattern *pattern;
    const struct lm_antenna_fan *fan;
    int32_t loss_db_q8; /* of the transmitter */
};

/* Set the bins of the replies that come back to their powers; 1.0 in Q24 is a whole reply. The
 * others keep theirs, 0. line->lit was traced; its levels are lost. Cost: some 4,000 instructions,
 * and that of lm_target_line_replies. */
void lm_beacon_sample(const struct lm_beacon_sample *b, struct lm_line *line, uint32_t *power_q24);

/* Levels of a display line from the powers behind the beam: `bright_db_q8` where a beacon within
 * the beam answers, LM_LEVEL_SHADOW elsewhere. */
void lm_beacon_show(const uint32_t *power_q24, uint32_t cells, int32_t bright_db_q8,
                    int16_t *level_db_q8);

#endif
