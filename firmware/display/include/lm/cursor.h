/* Cursor: a position on the ground that the operator moves over the glass.
 *
 *   state        position                                   left by
 *   not placed   none; the next step places it              the ownship's position becoming known
 *   home         half the range scale straight ahead of     slewing, lm_cursor_stabilise
 *                where the aircraft was when it was placed
 *   snowplow     half the range scale straight ahead of     lm_cursor_stabilise
 *                the aircraft, wherever it flies; no slewing
 *   moved        fixed on the ground
 *
 * A cursor at home belongs to the range scale: the caller that changes the scale calls
 * lm_cursor_zero again. */
#ifndef LM_CURSOR_H
#define LM_CURSOR_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/view.h"

/* Speed at full deflection, in halves of the glass's shorter side a second, and the time between
 * two steps. UNSOURCED. */
enum { LM_CURSOR_HALVES_PER_S = 1, LM_CURSOR_STEP_US = 20000 };

/* All zero is a cursor that is not placed. */
struct lm_cursor {
    struct lm_position position;
    bool is_placed;         /* false until the ownship's position is known */
    bool is_home;           /* nobody has moved it since lm_cursor_zero */
    bool is_snowplow;       /* held ahead of the aircraft until lm_cursor_stabilise */
    int32_t slew_x, slew_y; /* deflection right and up, -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION */
    uint64_t stepped_us;    /* time of the last step */

    /* Results of lm_cursor_locate. */
    struct lm_offset offset; /* on the glass, if is_on_glass */
    bool is_on_glass;        /* within the sector's radius and the frame, the window or the patch */
    uint32_t range_m;        /* ground range from the ownship */
    fx_bam_t bearing;        /* from the ownship, from true north */
};

/* Surroundings of a cursor: what it is moved against. */
struct lm_cursor_scene {
    const struct lm_view *view; /* borrowed for the call */
    struct lm_position ownship;
    fx_bam_t heading;
    uint32_t scale_m;     /* the display's range scale */
    int32_t half_px;      /* half the shorter side of the glass */
    int32_t slew_percent; /* speed over the glass, in per cent of that in a sector: 1..100 */
};

/* Put the cursor home: straight ahead at half the scale. It stays at that place on the ground. */
void lm_cursor_zero(struct lm_cursor *c, const struct lm_cursor_scene *scene);

/* Hold the cursor at its present place on the ground; ends snowplow. */
void lm_cursor_stabilise(struct lm_cursor *c);

/* Put the cursor at a place on the ground; ends snowplow. */
void lm_cursor_put(struct lm_cursor *c, struct lm_position position);

/* Move the cursor by its deflection, and in snowplow with the aircraft. Call in every step of the
 * unit; it acts every LM_CURSOR_STEP_US and returns true if it did. A longer gap counts as one
 * step.
 *
 * Slewing stops at the edge of window or patch. In a sector it stops at its radius, and at 0.95 of
 * half the frame's height: up and down from the frame's middle, and to each side. A cursor beyond
 * that edge, because the aircraft flew on, is brought back to the edge when it is slewed. */
bool lm_cursor_step(struct lm_cursor *c, const struct lm_cursor_scene *scene, uint64_t now_us);

/* Compute offset, is_on_glass, range and bearing. Call when the view may have changed. Cost: about
 * 900 instructions. */
void lm_cursor_locate(struct lm_cursor *c, const struct lm_cursor_scene *scene);

/* Range change that the automatic range asks for: 1 for the next larger scale, -1 for the next
 * smaller, 0 for none. Up from 0.95 of the scale, down below 0.425 of it: FreeFalcon and
 * FlightGear's APG-68 agree on these. 0 if the cursor is behind the aircraft, or too far for
 * lm_view_find. */
int32_t lm_cursor_wants_range(const struct lm_cursor *c, uint32_t scale_m);

#endif
