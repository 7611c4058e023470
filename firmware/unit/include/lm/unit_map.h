/* The flash image as the unit holds it: the database's tables, the pool of tiles, and the targets
 * with their signatures and chips. */
#ifndef LM_UNIT_MAP_H
#define LM_UNIT_MAP_H

#include <stddef.h>

#include "lm/chips.h"
#include "lm/target.h"
#include "lm/tile_cache.h"

struct lm_unit_map {
    bool is_usable; /* false: the image could not be opened, and nothing below may be used */
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_target targets[LM_TARGETS_MAX];
    struct lm_signature signatures[LM_SIGNATURES_MAX];
    struct lm_target_set target_set; /* those of the two arrays that were read */
    struct lm_chips chips;
    struct {
        uint32_t targets_lost;    /* damaged, or no room for them */
        uint32_t signatures_lost; /* likewise; their targets return nothing */
    } count;
};

/* Memory and patience that an opened map keeps; both are lent for as long as the map lives. */
struct lm_unit_map_lent {
    const struct lm_flash *flash;
    void *tile_pool; /* 8-byte aligned */
    size_t tile_pool_bytes;
    uint32_t flash_poll_limit; /* polls after which a read at start-up is given up */
};

/* Read the tables, the coarsest level, the targets and the signatures. Waits for the flash. Returns
 * - LM_OK: the map can be used; or the image cannot, and m->is_usable is false;
 * - LM_ERR_NO_MEMORY: the pool has no room for the coarsest level of this image. */
int lm_unit_map_open(struct lm_unit_map *m, const struct lm_unit_map_lent *lent);

/* Move the reading of tiles and chips on. Never waits. */
void lm_unit_map_service(struct lm_unit_map *m, uint64_t now_us);

/* Records of the image, tiles and chips alike, that were read and did not check; only grows. */
uint32_t lm_unit_map_corrupt_records(const struct lm_unit_map *m);

#endif
