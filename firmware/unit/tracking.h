/* Tracking: the unit's track (lm/track.h): what commands it, what it does to picture and cursor,
 * and how it stands on the glass. */
#ifndef LM_UNIT_TRACKING_H
#define LM_UNIT_TRACKING_H

#include "lm/unit.h"

/* Track what is at the cursor: a mover where the mode shows movers or ships, else what stands
 * still. In snowplow, stabilise the cursor instead. */
enum lm_refusal lm_tracking_designate(struct lm_unit *u, uint64_t now_us);

/* Range the ground straight ahead, or end that. */
enum lm_refusal lm_tracking_range(struct lm_unit *u, uint64_t now_us);

/* End the track. False if there was none. */
bool lm_tracking_drop(struct lm_unit *u, uint64_t now_us);

/* Checksum of the record of an image's target that is tracked; 0: none is. */
uint32_t lm_tracking_listed(const struct lm_unit *u);

/* The images' targets have other numbers: go on with the one of that checksum. The track ends if it
 * has gone with its image; a search begins again. */
void lm_tracking_renumber(struct lm_unit *u, uint32_t tracked, uint64_t now_us);

/* Measure what is due; hold the cursor at what is tracked. Call in every step. */
void lm_tracking_step(struct lm_unit *u, uint64_t now_us);

/* True if there are measured values: the track is held or coasts. */
static inline bool lm_tracking_is_locked(const struct lm_unit *u)
{
    return u->track.state >= LM_TRACK_HELD;
}

/* True if the antenna stays on the track instead of sweeping a sector. */
static inline bool lm_tracking_holds_antenna(const struct lm_unit *u)
{
    return lm_tracking_is_locked(u) && u->page.picture == LM_PICTURE_SECTOR;
}

/* Put the cursor on a target or place that is tracked. */
void lm_tracking_hold_cursor(struct lm_unit *u);

/* Set the members of *s that belong to the track. */
void lm_tracking_describe(const struct lm_unit *u, struct lm_symbols *s);

#endif
