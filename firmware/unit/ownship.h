/* Ownship helpers that several parts of the unit use. */
#ifndef LM_UNIT_OWNSHIP_H
#define LM_UNIT_OWNSHIP_H

#include "lm/nav.h"
#include "lm/sector.h"
#include "lm/unit_map.h"
#include "lm/units.h"

static inline struct lm_position lm_ownship_position(const struct lm_ownship *own)
{
    return (struct lm_position){own->latitude, own->longitude};
}

/* Height above mean sea level, which the map's elevations refer to. Satellite navigation gives the
 * height above the ellipsoid. */
static inline int32_t lm_antenna_height_m_q6(const struct lm_ownship *own,
                                             const struct lm_unit_map *map)
{
    const bool is_ellipsoidal = own->height_source == LM_BUS_ELLIPSOID_HEIGHT;
    if (!is_ellipsoidal) {
        return own->height_m_q6;
    }
    return own->height_m_q6 - lm_unit_map_geoid_m_q6(map, lm_ownship_position(own));
}

/* Where the antenna is and how it moves, at a time of the exercise. */
static inline struct lm_platform
lm_ownship_platform(const struct lm_ownship *own, const struct lm_unit_map *map, uint64_t time_us)
{
    return (struct lm_platform){
        .position = lm_ownship_position(own),
        .height_m_q10 = lm_m_q10_of_m_q6(lm_antenna_height_m_q6(own, map)),
        .heading = own->heading,
        .track = own->track,
        .speed_mm_s = (uint32_t)own->ground_speed_mm_s,
        .time_us = time_us,
    };
}

/* True if position and heading are good or stale. */
static inline bool lm_ownship_is_known(const struct lm_ownship *own)
{
    return own->position_quality != LM_NAV_DEAD && own->heading_quality != LM_NAV_DEAD;
}

#endif
