/* The link of a DisplayPort transmitter to its panel: asked over the AUX channel what it can do,
 * then trained. Sequence: VESA DisplayPort Standard 1.2, 3.5.1.2 (training) and 2.11.7 (AUX);
 * addresses of the panel's registers: the same, table 2-73 (DPCD); registers: UG1087, module DP.
 *
 * QEMU's panel answers and is content at once, so that asking, choosing and the order of the steps
 * are tested there; a panel that is content late, never, or not at all on registers in memory. NOT
 * tested: a real one. The serial lanes' clocks are the first-stage loader's. */
#ifndef DRV_DP_LINK_H
#define DRV_DP_LINK_H

#include <stdbool.h>

#include "drv/registers.h"

enum { DRV_DP_LANES_MAX = 4 };

struct drv_dp_link {
    drv_registers dp;
    uint64_t (*now_us)(const void *clock);
    const void *clock;   /* borrowed */
    uint8_t board_lanes; /* connected on the board: 1, 2 or 4 */

    uint8_t lanes, rate; /* as trained; rate in units of 0.27 Gbit/s: 6, 10 or 20 */
    uint8_t drive;       /* voltage swing in bits 0..1, pre-emphasis in bits 3..4 */
    bool has_pattern_3;
    struct {
        uint32_t unanswered; /* requests on the AUX channel without an answer */
        uint32_t attempts;   /* trainings begun */
    } count;
};

/* Train the link so that it carries `pixel_khz` at 24 bits: the slowest rate and the fewest lanes
 * that panel and board have and that come up. LM_OK; LM_ERR_IO when no panel answers or none of
 * them comes up; LM_ERR_RANGE when none would carry so much. Takes 1 ms where all is well, 40 ms
 * at the most for each combination. */
int drv_dp_link_train(struct drv_dp_link *l, uint32_t pixel_khz);

#endif
