#include "drv/not_fitted.h"

#include <stddef.h>

static int no_read(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    (void)ctx;
    (void)offset;
    (void)destination;
    (void)length;
    return LM_ERR_IO;
}

static int no_poll(void *ctx)
{
    (void)ctx;
    return LM_ERR_IO;
}

static int no_frame(void *ctx, struct lm_can_frame *frame)
{
    (void)ctx;
    (void)frame;
    return 0;
}

static int no_control(void *ctx, struct lm_control *control)
{
    (void)ctx;
    (void)control;
    return 0;
}

const struct lm_flash drv_no_flash = {NULL, 0, no_read, no_poll};
const struct lm_can drv_no_can = {NULL, no_frame, NULL};
const struct lm_controls drv_no_controls = {.next = no_control};
