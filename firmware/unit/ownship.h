/* Short answers about the ownship that several parts of the unit need. */
#ifndef LM_UNIT_OWNSHIP_H
#define LM_UNIT_OWNSHIP_H

#include "lm/db.h"
#include "lm/nav.h"

/* Height above mean sea level, metres * 64, as the map's elevations are: satellites measure from
 * the ellipsoid. */
static inline int32_t lm_antenna_height_m_q6(const struct lm_ownship *own, const struct lm_db *db)
{
    const bool is_ellipsoidal = own->height_source == LM_BUS_ELLIPSOID_HEIGHT;
    return own->height_m_q6 - (is_ellipsoidal ? db->geoid_m_q6 : 0);
}

static inline struct lm_position lm_ownship_place(const struct lm_ownship *own)
{
    return (struct lm_position){own->latitude, own->longitude};
}

/* True when position and heading can be used, however old they are. */
static inline bool lm_ownship_is_known(const struct lm_ownship *own)
{
    return own->position_quality != LM_NAV_DEAD && own->heading_quality != LM_NAV_DEAD;
}

#endif
