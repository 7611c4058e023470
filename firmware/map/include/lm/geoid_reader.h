/* Geoid reader: keeps the page of the geoid in memory that holds the aircraft. One read of the
 * flash brings it, wherever that is.
 *
 *     lm_geoid_reader_service(&reader, &tiles, &db, aircraft);     in every step
 *     height_m_q6 -= lm_geoid_reader_height_m_q6(&reader, &db, aircraft);
 *
 * Until the page is there, and where the image has none, the grid of the whole image answers. The
 * caller owns the struct, all zero at first. */
#ifndef LM_GEOID_READER_H
#define LM_GEOID_READER_H

#include "lm/geoid.h"
#include "lm/tile_cache.h"

/* All members but `corrupt` are private. Pages count from 1; 0 is none. */
struct lm_geoid_reader {
    struct lm_geoid page;
    const struct lm_db *db;           /* the image that the numbers are of; borrowed */
    uint32_t resident, reading, lost; /* number of what `page` holds, will hold, failed to hold */
    struct lm_flash_request read;
    uint32_t corrupt; /* pages that failed their check; only grows */
};

/* Take the page that was read, and request the one of an image of the flash that holds the place,
 * between two tiles. A page that fails is not requested again before another one was. Never waits.
 */
void lm_geoid_reader_service(struct lm_geoid_reader *r, struct lm_tile_cache *tiles,
                             const struct lm_db *db, struct lm_position place);

/* Height of mean sea level above the ellipsoid at a place, metres * 64. */
int32_t lm_geoid_reader_height_m_q6(const struct lm_geoid_reader *r, const struct lm_db *db,
                                    struct lm_position place);

#endif
