/* Unit map: the opened flash image: its tables, the pool of tiles, and the targets with their
 * signatures and chips; the radar that looks at it; and the table of the bus, if the image has
 * one. */
#ifndef LM_UNIT_MAP_H
#define LM_UNIT_MAP_H

#include <stddef.h>

#include "lm/bus_record.h"
#include "lm/chips.h"
#include "lm/geoid_reader.h"
#include "lm/images.h"
#include "lm/radar.h"
#include "lm/target.h"
#include "lm/text.h"
#include "lm/tile_cache.h"

/* Where the radar table comes from. The board's wins over the image's, and that over the one that
 * is built in. */
enum lm_radar_origin { LM_RADAR_BUILT_IN, LM_RADAR_OF_IMAGE, LM_RADAR_OF_BOARD };

struct lm_unit_map {
    const struct lm_radar *radar; /* the table in use, whatever the image is; never NULL */
    enum lm_radar_origin radar_origin;
    struct lm_radar radar_of_image;   /* storage */
    const struct lm_bus_profile *bus; /* the image's table; NULL: none, or the board has its own */
    struct lm_bus_table bus_of_image; /* storage */

    int open_status; /* enum lm_status: of lm_db_open, of lm_radar_unpack, of lm_bus_unpack, or
                      * LM_ERR_SENSOR */
    bool is_usable;  /* false: the image cannot be used, and nothing below save db.sensor where the
                      * status is LM_ERR_SENSOR */
    struct lm_db db; /* the image; of several the view of them (lm/images.h), and its tables are
                      * those of the first place that has one */
    struct lm_db images[LM_IMAGES_MAX + 1];    /* the finest first; the last one is for sorting */
    struct lm_flash_part parts[LM_IMAGES_MAX]; /* what is at the board's places */
    uint32_t live_place;  /* whose signatures live targets name: the first that had an image at the
                           * start; while it has none, they have their cross section alone */
    uint32_t image_count; /* that answer; 0: not usable */
    int part_status[LM_IMAGES_MAX]; /* of the board's parts of the flash, each: as open_status, or
                                     * that of lm_images_judge; LM_OK also of those it has not */
    struct lm_tile_cache tiles;
    struct lm_geoid_reader geoid;
    struct lm_target targets[LM_TARGETS_MAX];
    struct lm_signature signatures[LM_SIGNATURES_MAX];
    struct lm_chip_source chip_source[LM_SIGNATURES_MAX];
    struct lm_target_set target_set; /* the entries of `targets` and `signatures` that were read, of
                                      * all images, in the order of the board's places */
    struct lm_chips chips;
    struct {
        uint32_t targets_lost;    /* targets that are damaged or beyond LM_TARGETS_MAX */
        uint32_t signatures_lost; /* signatures damaged or beyond LM_SIGNATURES_MAX; their targets
                                     return no echo */
    } count;
};

/* Flash, radar table and memory of an opened map. All pointers stay borrowed as long as the map is
 * used. */
struct lm_unit_map_lent {
    const struct lm_flash *flash;
    void *tile_pool; /* 8-byte aligned */
    size_t tile_pool_bytes;
    uint32_t flash_poll_limit;    /* polls after which a read by lm_unit_map_open is given up */
    const struct lm_radar *radar; /* the board's table, which lm_radar_check has passed; NULL: the
                                   * image's, or the one that is built in where it has none */
    bool has_bus_profile;         /* the board has its own: the image's is not read */
    const struct lm_flash_part *parts; /* LM_IMAGES_MAX; of no bytes: no image there. Without the
                                        * first the flash has one image, at its start */
};

/* Open the image: choose the radar, read tables, coarsest LOD, targets and signatures. Waits for
 * the flash. Returns
 * - LM_OK, and m->is_usable: true if the image can be used. It cannot if lm_db_open fails, if its
 *   radar table is the one to use and fails lm_radar_unpack, if its bus table is the one to use and
 *   fails lm_bus_unpack, or if its reflectivity is of another band than the radar in use
 *   (LM_ERR_SENSOR);
 * - LM_ERR_NO_MEMORY: the pool is too small (lm_tile_cache_init); *m must not be used. */
int lm_unit_map_open(struct lm_unit_map *m, const struct lm_unit_map_lent *lent);

/* Why the image is refused although it is whole, in words: "IMAGE KU  RADAR X", "OTHER VERSION".
 * Empty if it is not refused, or damaged. */
struct lm_text lm_unit_map_refusal(const struct lm_unit_map *m);

/* Turn the map to a place before a picture of what is within reach of it: lm_images_look. */
void lm_unit_map_look(struct lm_unit_map *m, struct lm_position place, uint32_t reach_m);

/* Height of mean sea level above the ellipsoid at a place, metres * 64. */
int32_t lm_unit_map_geoid_m_q6(const struct lm_unit_map *m, struct lm_position place);

/* Number in `images` of the one that begins at an offset of the flash; image_count: none does. */
uint32_t lm_unit_map_image_from(const struct lm_unit_map *m, uint64_t offset);

/* Whether that one is the only one, which lm_unit_map_mount does not let go. */
bool lm_unit_map_is_last(const struct lm_unit_map *m, uint64_t offset);

/* An image has come to a place of the board's, 0..LM_IMAGES_MAX - 1, in a part of the flash where
 * none was; or the one that is there goes, for a part of no bytes. Waits for the flash: what is
 * being read ends first. Tiles of all images leave the cache; targets are read anew, and have other
 * numbers than before. part_status tells whether the image was opened; LM_ERR_IO also if a read
 * before did not end: then no targets are shown until the next change. A board lets the flash of
 * one that has gone go when lm_tile_cache_is_drained says so of `tiles`.
 *
 * Returns LM_OK; or LM_ERR_RANGE, with nothing changed, if the map is not usable, for another
 * place, or if the image there is the last one. Radar and bus table stay those of the start. */
int lm_unit_map_mount(struct lm_unit_map *m, uint32_t place, const struct lm_flash_part *part,
                      uint32_t poll_limit);

/* Number of images that the board has and a usable map is without. */
uint32_t lm_unit_map_refused(const struct lm_unit_map *m);

/* Finish and start reads of tiles and chips. Call in every step. `aircraft` is where the aircraft
 * is, or NULL while that is not known. Never waits. */
void lm_unit_map_service(struct lm_unit_map *m, const struct lm_position *aircraft,
                         uint64_t now_us);

/* Number of tiles, chips and pages of the geoid that were read with a wrong CRC; only grows. */
uint32_t lm_unit_map_corrupt_records(const struct lm_unit_map *m);

#endif
