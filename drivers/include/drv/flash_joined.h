/* Joined flash: several flashes as one, so that a unit reads several images of a database
 * (lm/images.h). Flash n begins at n << DRV_FLASH_JOINED_LOG2; what may come and go are the further
 * ones.
 *
 * It does one read at a time, as each of them does. What lies between the end of one and the
 * beginning of the next is beyond the end: LM_ERR_RANGE. */
#ifndef DRV_FLASH_JOINED_H
#define DRV_FLASH_JOINED_H

#include "lm/port.h"

enum { DRV_FLASH_JOINED_LOG2 = 48 };

struct drv_flash_joined {
    struct lm_flash port;                        /* its ctx is this struct, which must not move */
    const struct lm_flash *flash[LM_IMAGES_MAX]; /* borrowed; each below 2^48 bytes; NULL: none */
    const struct lm_flash *reading;              /* that was asked last */
};

/* Join `count` flashes, 1..LM_IMAGES_MAX, and fill `parts`, of which there are LM_IMAGES_MAX, with
 * where they lie. All but the first may be NULL: a place for one that comes later. */
void drv_flash_joined_open(struct drv_flash_joined *j, const struct lm_flash *const flash[],
                           uint32_t count, struct lm_flash_part *parts);

/* Put a flash at a place, 1..LM_IMAGES_MAX - 1, or take away the one that is there (NULL). Nothing
 * may be reading from that place; reads of other places may be under way, on another thread too.
 * Returns where it lies; of no bytes: there is none. */
struct lm_flash_part drv_flash_joined_put(struct drv_flash_joined *j, uint32_t number,
                                          const struct lm_flash *flash);

#endif
