#include "drv/flash_joined.h"

#include <stddef.h>

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct drv_flash_joined *j = ctx;
    const uint64_t number = offset >> DRV_FLASH_JOINED_LOG2;
    if (number >= LM_IMAGES_MAX || j->flash[number] == NULL) {
        return LM_ERR_RANGE;
    }
    j->reading = j->flash[number];
    return j->reading->read_start(j->reading->ctx, offset - (number << DRV_FLASH_JOINED_LOG2),
                                  destination, length);
}

static int read_poll(void *ctx)
{
    const struct drv_flash_joined *j = ctx;
    return j->reading->read_poll(j->reading->ctx);
}

struct lm_flash_part drv_flash_joined_put(struct drv_flash_joined *j, uint32_t number,
                                          const struct lm_flash *flash)
{
    j->flash[number] = flash;
    return (struct lm_flash_part){(uint64_t)number << DRV_FLASH_JOINED_LOG2,
                                  flash != NULL ? flash->size_bytes : 0};
}

void drv_flash_joined_open(struct drv_flash_joined *j, const struct lm_flash *const flash[],
                           uint32_t count, struct lm_flash_part *parts)
{
    *j = (struct drv_flash_joined){.reading = flash[0]};
    for (uint32_t i = 0; i < LM_IMAGES_MAX; i++) {
        parts[i] = drv_flash_joined_put(j, i, i < count ? flash[i] : NULL);
    }
    j->port = (struct lm_flash){.ctx = j,
                                .size_bytes = (uint64_t)LM_IMAGES_MAX << DRV_FLASH_JOINED_LOG2,
                                .read_start = read_start,
                                .read_poll = read_poll};
}
