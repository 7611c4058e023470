/* Unit map: the opened flash image: its tables, the pool of tiles, and the targets with their
 * signatures and chips. */
#ifndef LM_UNIT_MAP_H
#define LM_UNIT_MAP_H

#include <stddef.h>

#include "lm/chips.h"
#include "lm/target.h"
#include "lm/tile_cache.h"

struct lm_unit_map {
    int open_status; /* of lm_db_open: enum lm_status */
    bool is_usable;  /* false: the image could not be opened; nothing below may be used */
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_target targets[LM_TARGETS_MAX];
    struct lm_signature signatures[LM_SIGNATURES_MAX];
    struct lm_target_set target_set; /* the entries of `targets` and `signatures` that were read */
    struct lm_chips chips;
    struct {
        uint32_t targets_lost; /* targets of the image that are damaged or beyond LM_TARGETS_MAX */
        uint32_t signatures_lost; /* signatures damaged or beyond LM_SIGNATURES_MAX; their targets
                                     return no echo */
    } count;
};

/* Flash and memory of an opened map. Both pointers stay borrowed as long as the map is used. */
struct lm_unit_map_lent {
    const struct lm_flash *flash;
    void *tile_pool; /* 8-byte aligned */
    size_t tile_pool_bytes;
    uint32_t flash_poll_limit; /* polls after which a read by lm_unit_map_open is given up */
};

/* Open the image: read its tables, coarsest LOD, targets and signatures. Waits for the flash.
 * Returns
 * - LM_OK, and m->is_usable: true if the image can be used, false if it cannot;
 * - LM_ERR_NO_MEMORY: the pool is too small for the coarsest LOD and 16 tiles; *m must not be
 *   used. */
int lm_unit_map_open(struct lm_unit_map *m, const struct lm_unit_map_lent *lent);

/* Finish and start reads of tiles and chips. Call in every step. Never waits. */
void lm_unit_map_service(struct lm_unit_map *m, uint64_t now_us);

/* Number of tiles and chips that were read with a wrong CRC; only grows. */
uint32_t lm_unit_map_corrupt_records(const struct lm_unit_map *m);

#endif
