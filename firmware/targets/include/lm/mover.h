/* Targets that move, and where a radar that tells directions by Doppler puts them.
 * docs/EQUATIONS.md, "Movers". */
#ifndef LM_MOVER_H
#define LM_MOVER_H

#include "lm/target.h"

/* Where a target is and which way it faces. */
struct lm_mover_state {
    struct lm_position position;
    fx_bam_t heading;
};

/* The target at a time of the unit's clock: from its origin along its heading or its path, back
 * when that is flown, or round once more, and so on; a target without speed stays. `t` is a checked
 * record. Its heading is that of the leg's beginning all along. The same time gives the same pose
 * on every machine. Cost: 800 instructions for a mover, two divisions of 64 bits among them, and 10
 * for each leg of a path. */
struct lm_mover_state lm_mover_state_at(const struct lm_target *t, uint64_t time_us);

/* How fast a mover comes nearer, mm/s, along the ground; `back` is the direction from it to the
 * radar. */
int32_t lm_mover_closing_mm_s(uint32_t speed_mm_s, fx_bam_t heading, fx_bam_t back);

/* How far to the right (signed BAM) of its place a target of this closing speed appears, when the
 * radar flies at `speed_mm_s` and its velocity points `off` to the right of the line of sight:
 * where still ground, on the same side of the velocity, has its Doppler shift, V cos(o') = V cos(o)
 * + v. False, with 0, where none has. A radar at rest displaces nothing. |closing| < 2^21. Worst
 * error 1e-6 radian a tenth of a degree from the velocity and beyond
 * (tests/unit/firmware/targets/test_mover.c). Cost: 300 instructions and a division of 64 bits. */
bool lm_mover_shift(int32_t closing_mm_s, uint32_t speed_mm_s, fx_bam_t off, int32_t *shift);

#endif
