/* Sight of a track: the map at a place, on the way to it, and where the nose points at it. Private
 * to the radar's tracks. */
#ifndef LM_TRACK_SIGHT_H
#define LM_TRACK_SIGHT_H

#include "lm/track.h"

/* The LOD that single places are read from. */
uint8_t lm_track_lod(const struct lm_db *db);

/* Elevation of the map. False off the map. */
bool lm_track_ground_at(struct lm_tile_cache *tiles, struct lm_position position,
                        int32_t *elevation_m_q10);

/* Reflectivity of the map's cell; LM_LEVEL_SHADOW off the map. */
int32_t lm_track_ground_db_q8(struct lm_tile_cache *tiles, struct lm_position position);

/* True if nothing on the way rises above the line of sight. Cost: some 18,000 instructions. */
bool lm_track_sees(struct lm_track *t, const struct lm_track_scene *s,
                   const struct lm_track_seen *seen);

/* Where the line of the nose meets the map, within the display's range. False if it does not. Cost:
 * some 12,000 instructions. */
bool lm_track_ahead(const struct lm_track_scene *s, struct lm_position *position,
                    int32_t *elevation_m_q10);

#endif
