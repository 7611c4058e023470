/* The cursor: a place on the ground that the operator moves over the glass.
 *
 * It holds its place while the aircraft flies. In snowplow it stands half the range straight ahead,
 * moves with the aircraft and cannot be slewed until it is stabilised (lm_cursor_stabilise). At
 * home, it goes with the scale: whoever changes that puts it there anew. */
#ifndef LM_CURSOR_H
#define LM_CURSOR_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/view.h"

/* UNSOURCED: full deflection moves the cursor across half the shorter side of the glass in a
 * second. */
enum { LM_CURSOR_HALVES_PER_S = 1, LM_CURSOR_STEP_US = 20000 };

struct lm_cursor {
    struct lm_position position;
    bool is_placed;         /* false until the aircraft's position is known */
    bool is_home;           /* where lm_cursor_zero put it: nobody has moved it since */
    bool is_snowplow;       /* and not yet stabilised */
    int32_t slew_x, slew_y; /* deflection, thousandths */
    uint64_t stepped_us;
    struct lm_offset offset; /* on the glass, when is_on_glass */
    bool is_on_glass;        /* within the sector's radius or the patch */
    /* From the ownship. */
    uint32_t range_m;
    fx_bam_t bearing; /* from true north */
};

/* What the cursor is moved against. */
struct lm_cursor_scene {
    const struct lm_view *view;
    struct lm_position ownship;
    fx_bam_t heading;
    uint32_t scale_m;     /* the display's range scale */
    int32_t half_px;      /* half the shorter side of the glass */
    int32_t slew_percent; /* of the whole sector's pace over the glass, 1..100 */
};

/* To its home: straight ahead at half the scale, held there. */
void lm_cursor_zero(struct lm_cursor *c, const struct lm_cursor_scene *scene);

/* Hold the place that the cursor has now. */
void lm_cursor_stabilise(struct lm_cursor *c);

/* Follow deflection and aircraft. Does something, and says so, every LM_CURSOR_STEP_US; a gap
 * counts as one such step. Slewing stops at the edge of the sector's circle or of the patch; a
 * cursor that was left behind is brought back to that edge when it is slewed. */
bool lm_cursor_step(struct lm_cursor *c, const struct lm_cursor_scene *scene, uint64_t now_us);

/* Where the cursor lies now, on the glass and from the ownship. Whenever the view may have changed.
 * Cost: about 900 instructions. */
void lm_cursor_locate(struct lm_cursor *c, const struct lm_cursor_scene *scene);

/* What an automatic range does: 1 to the next larger scale, -1 to the next smaller, 0 to stay. Up
 * from 0.95 of the scale, down below 0.425 (FreeFalcon and FlightGear's APG-68 agree); a cursor
 * behind the aircraft or off the glass sideways changes nothing. */
int32_t lm_cursor_wants_range(const struct lm_cursor *c, uint32_t scale_m);

#endif
