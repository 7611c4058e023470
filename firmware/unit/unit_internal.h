/* The unit's parts: unit.c knows the order of things, commands.c what the operator wants, pacing.c
 * when lines are drawn, present.c what the glass shows. */
#ifndef LM_UNIT_INTERNAL_H
#define LM_UNIT_INTERNAL_H

#include "lm/unit.h"

enum {
    /* Nothing is drawn while one of these stands; while one of the latter does, the picture stays
     * and the aircraft moves over it. */
    LM_FLAGS_STANDING = LM_FLAG_FROZEN | LM_FLAG_SILENT,
    LM_FLAGS_NO_LINES = LM_FLAG_DB | LM_FLAG_NAV_DEAD | LM_FLAG_NAV_STALE | LM_FLAGS_STANDING
};

/* Begin the picture that u->page asks for: nothing of the last one stays. */
void lm_begin_picture(struct lm_unit *u, uint64_t now_us);

/* Elevation of the map where a patch lies, metres * 1024, from the tiles that are there; asks for
 * the one that knows best. */
int32_t lm_patch_elevation_q10(struct lm_unit *u, const struct lm_sar_command *command);

/* Put the environment together: what was commanded, and behind it, where there is room, what the
 * bus tells. */
void lm_look_at_weather(struct lm_unit *u, uint64_t now_us);

/* Do what a press asked for (enum lm_effect). */
void lm_apply(struct lm_unit *u, uint32_t effects, uint64_t now_us);

/* Take keys and commands that wait. */
void lm_take_controls(struct lm_unit *u, uint64_t now_us);

/* Move view and cursor on, and the range when it follows the cursor. */
void lm_follow_cursor(struct lm_unit *u, uint64_t now_us);

/* How the picture lies on the glass. A picture that stands keeps the view it was drawn with. */
void lm_follow_view(struct lm_unit *u);

/* Draw the lines whose time has come, at most LM_STEP_LINES with the azimuths traced for them. */
void lm_draw_due_lines(struct lm_unit *u, uint64_t now_us);

/* Draw the glass and show it. */
void lm_show_frame(struct lm_unit *u, uint64_t now_us);

/* Height above mean sea level, metres * 64, as the map's elevations are: satellites measure from
 * the ellipsoid. */
static inline int32_t lm_antenna_height_q6(const struct lm_unit *u)
{
    const bool is_ellipsoidal = u->ownship.height_source == LM_BUS_ELLIPSOID_HEIGHT;
    return u->ownship.height_q6 - (is_ellipsoidal ? u->map.db.geoid_q6 : 0);
}

static inline struct lm_place lm_ownship_place(const struct lm_unit *u)
{
    return (struct lm_place){u->ownship.latitude, u->ownship.longitude};
}

/* Whether there is an aircraft to speak of. */
static inline bool lm_has_ownship(const struct lm_unit *u)
{
    return u->ownship.position_quality != LM_NAV_DEAD && u->ownship.heading_quality != LM_NAV_DEAD;
}

#endif
