#include "follow.h"

#include "commands.h"
#include "flags.h"
#include "lm/units.h"
#include "ownship.h"
#include "tracking.h"

enum {
    ELEVATION_CELL_MM = 30000 /* cell size of the LOD that elevations are read from */
};

static void follow_view(struct lm_unit *u)
{
    lm_picture_follow_view(&u->picture, (u->flags & LM_FLAGS_STANDING) != 0);
}

int32_t lm_elevation_at(struct lm_unit *u, struct lm_position position)
{
    return u->map.is_usable
               ? lm_scan_elevation(&u->map.tiles, lm_scan_lod(&u->map.db, ELEVATION_CELL_MM),
                                   position, LM_NO_ELEVATION)
               : LM_NO_ELEVATION;
}

/* What is tracked wants the next scale beyond 0.9 of this one, and a smaller one below 0.4
 * [FreeFalcon, gmscope.cpp]. Ranges are below 400 km. */
static int32_t track_wants_range(const struct lm_unit *u, uint32_t scale_m)
{
    const uint32_t range_m = lm_m_of_m_q8(u->track.seen.slant_m_q8);
    return range_m * 10 > scale_m * 9 ? 1 : range_m * 10 < scale_m * 4 ? -1 : 0;
}

/* Change the range scale as the cursor asks, if the range is automatic. */
static void follow_range(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t scale_m = u->map.radar->range[u->page.range_index].range_m;
    if (!lm_picture_moves(&u->picture) || !u->page.is_auto_range || u->picture.is_view_held) {
        return;
    }
    const int32_t step = lm_tracking_is_locked(u) ? track_wants_range(u, scale_m)
                                                  : lm_cursor_wants_range(&u->cursor, scale_m);
    const uint32_t effects = step != 0 ? lm_page_step_range(&u->page, step) : 0;
    if (effects) {
        lm_apply_effects(u, effects, now_us);
        follow_view(u);
    }
}

void lm_follow_cursor(struct lm_unit *u, uint64_t now_us)
{
    follow_view(u);
    if (!lm_ownship_is_known(&u->ownship)) {
        return;
    }
    const struct lm_cursor_scene scene = lm_picture_cursor_scene(&u->picture);
    if (!lm_cursor_step(&u->cursor, &scene, now_us)) {
        return;
    }
    lm_tracking_hold_cursor(u); /* nothing slews it away from what is tracked */
    lm_cursor_locate(&u->cursor, &scene);
    u->cursor_elevation_m_q10 = lm_elevation_at(u, u->cursor.position);
    u->ground_m_q10 = lm_elevation_at(u, lm_ownship_position(&u->ownship));
    if (u->picture.is_cursor_awaited) { /* the step has placed it */
        lm_apply_effects(u, LM_EFFECT_SECTOR, now_us);
    }
    follow_range(u, now_us);
}
