/* DisplayPort link of a transmitter to its panel. The panel's abilities are read over the AUX
 * channel, then the link is trained. Sequence: VESA DisplayPort Standard 1.2, 3.5.1.2 (training)
 * and 2.11.7 (AUX); addresses of the panel's registers: the same, table 2-73 (DPCD); registers:
 * UG1087, module DP.
 *
 * Tested in QEMU, whose panel answers and locks at once: reading, choosing and the order of the
 * steps. Tested on registers in memory: a panel that locks late or never, or does not answer. NOT
 * tested: a real panel. The first-stage loader sets the serial lanes' clocks. */
#ifndef DRV_DP_LINK_H
#define DRV_DP_LINK_H

#include <stdbool.h>

#include "drv/registers.h"

enum { DRV_DP_LANES_MAX = 4 };

struct drv_dp_link {
    drv_registers dp;
    uint64_t (*now_us)(const void *clock);
    const void *clock;   /* borrowed */
    uint8_t board_lanes; /* lanes that the board connects: 1, 2 or 4 */

    uint8_t lanes, rate; /* as trained; rate in units of 0.27 Gbit/s: 6, 10 or 20 */
    uint8_t drive;       /* voltage swing in bits 0..1, pre-emphasis in bits 3..4 */
    bool has_pattern_3;
    struct {
        uint32_t unanswered; /* requests on the AUX channel without an answer */
        uint32_t attempts;   /* trainings begun */
    } count;
};

/* Train the link for `pixel_khz` at 24 bits a pixel. Uses the slowest rate and the fewest lanes
 * that panel and board have and that train successfully. Returns
 * - LM_OK;
 * - LM_ERR_IO: no panel answers, or no combination of rate and lanes trains;
 * - LM_ERR_RANGE: no combination carries that many pixels.
 * Waits: 1 ms on success, at most 40 ms for each combination that fails. */
int drv_dp_link_train(struct drv_dp_link *l, uint32_t pixel_khz);

#endif
