/* Mover: a target with a speed. This header says where it is at a time, and where a radar that
 * measures azimuth by Doppler displays it. Source: docs/EQUATIONS.md, "Movers". */
#ifndef LM_MOVER_H
#define LM_MOVER_H

#include "lm/target.h"

/* Position and motion of a target at some time. */
struct lm_mover_state {
    struct lm_position position;
    fx_bam_t heading; /* of the target's forward axis, from north */
    fx_bam_t course;  /* of its velocity: of a target of the image, its heading */
    uint32_t speed_mm_s;
};

/* State of target `t` at `time_us` of the unit's clock. `t` is a checked record.
 *
 * - The target starts at its origin, along its heading or its path, at a steady speed.
 * - At the end it turns back, or starts a round path again, and so on without end.
 * - A target without speed stays at its origin.
 * - The heading of a leg is that at its beginning, turned by 180 degrees on the way back.
 *
 * The same time gives the same state on every machine. Cost: 800 instructions for a mover, two
 * 64-bit divisions among them, and 10 for each leg of a path. */
struct lm_mover_state lm_mover_state_at(const struct lm_target *t, uint64_t time_us);

/* Closing speed of a mover along the ground; negative if it goes away. `back` is the direction from
 * the mover to the radar. */
int32_t lm_mover_closing_mm_s(uint32_t speed_mm_s, fx_bam_t course, fx_bam_t back);

/* Displacement of a mover by Doppler: *shift is the signed angle, right positive, from its true
 * azimuth to the one where it appears. That is where still ground, on the same side of the
 * velocity, has the mover's Doppler shift: V cos(o') = V cos(o) + v.
 *
 * |closing_mm_s| is below 2^21. The radar flies at `speed_mm_s`; its velocity points `off` to the
 * right of the line of sight. A radar at rest displaces nothing. False, with *shift = 0, if no
 * ground has that Doppler shift.
 *
 * Worst error 1e-6 radian from a tenth of a degree off the velocity on
 * (tests/unit/firmware/targets/test_mover.c). Cost: 300 instructions and one 64-bit division. */
bool lm_mover_shift(int32_t closing_mm_s, uint32_t speed_mm_s, fx_bam_t off, int32_t *shift);

/* Half the spread of closing speeds that still ground has within the beam: V B sin(o) / 2. What
 * moves more slowly cannot be told from the clutter beside it.
 *
 * `beam` is the one-way half-power width, at most 20 degrees; `speed_mm_s` is at most 2,000,000;
 * the velocity points `off` from the line of sight. Worst error 1 mm/s and 2^-14 of the result. */
uint32_t lm_mover_clutter_mm_s(uint32_t speed_mm_s, fx_bam_t beam, fx_bam_t off);

#endif
