/* A slot on an MTD device. A block is erased and written as a whole. One that fails to is marked
 * bad, and the image goes on in the next good one. */
#include "drv/flash_mtd.h"
#include "hs/whole_file.h"
#include "media.h"

#include <errno.h>
#include <fcntl.h>
#include <mtd/mtd-user.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

struct mtd_medium {
    struct drv_flash_mtd device; /* reads, and knows the good blocks */
    char path[256];
    int fd; /* to write; -1 */
    uint32_t page_bytes;
    uint8_t *block; /* owned: one erase block */
};

static int read_image(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    struct mtd_medium *f = ctx;
    const struct lm_flash *port = &f->device.port;
    const int status = port->read_start(port->ctx, offset, to, length);
    return status == LM_OK && port->read_poll(port->ctx) == LM_OK ? 0 : EIO;
}

/* Take a block out of use. Those behind it move up. */
static int give_up_block(struct mtd_medium *f, uint32_t physical)
{
    loff_t at = (loff_t)physical * f->device.block_bytes;
    if (ioctl(f->fd, MEMSETBADBLOCK, &at) != 0) {
        return EIO;
    }
    drv_flash_mtd_close(&f->device);
    const int cause = drv_flash_mtd_open(&f->device, f->path);
    return cause == 0 ? EAGAIN : cause;
}

static int write_block(struct mtd_medium *f, uint32_t index, const void *from, uint32_t length)
{
    if (index >= f->device.block_count) {
        return ENOSPC;
    }
    const uint32_t bytes = f->device.block_bytes, physical = f->device.blocks[index];
    const uint32_t used = (length + f->page_bytes - 1) / f->page_bytes * f->page_bytes;
    struct erase_info_user erase = {.start = physical * bytes, .length = bytes};
    memset(f->block, 0xff, bytes);
    memcpy(f->block, from, length);
    if (ioctl(f->fd, MEMERASE, &erase) != 0 ||
        hs_write_whole(f->fd, f->block, used, (uint64_t)physical * bytes) != 0) {
        return give_up_block(f, physical);
    }
    return 0;
}

static int write_image(void *ctx, uint64_t offset, const void *from, uint32_t length)
{
    struct mtd_medium *f = ctx;
    return write_block(f, (uint32_t)(offset / f->device.block_bytes), from, length);
}

static uint32_t record_block(const struct mtd_medium *f, uint32_t copy)
{
    return f->device.block_count - LM_SLOT_COPIES + copy;
}

/* A copy that cannot be read is none: the other one counts. */
static int read_record(void *ctx, uint32_t copy, struct lm_slot_record *record)
{
    struct mtd_medium *f = ctx;
    const uint64_t at = (uint64_t)record_block(f, copy) * f->device.block_bytes;
    if (read_image(ctx, at, record, sizeof *record) != 0) {
        memset(record, 0, sizeof *record);
    }
    return 0;
}

static int write_record(void *ctx, uint32_t copy, const struct lm_slot_record *record)
{
    struct mtd_medium *f = ctx;
    return write_block(f, record_block(f, copy), record, sizeof *record);
}

static int resize(void *ctx, uint64_t bytes)
{
    const struct mtd_medium *f = ctx;
    return bytes <= (uint64_t)record_block(f, 0) * f->device.block_bytes ? 0 : ENOSPC;
}

/* The driver returns when the chip has written. */
static int sync_all(void *ctx)
{
    (void)ctx;
    return 0;
}

static void forget(void *ctx)
{
    (void)ctx;
}

static void close_all(void *ctx)
{
    struct mtd_medium *f = ctx;
    drv_flash_mtd_close(&f->device);
    if (f->fd >= 0) {
        close(f->fd);
    }
    free(f->block);
    free(f);
}

static int open_to_write(struct mtd_medium *f)
{
    struct mtd_info_user info;
    f->fd = open(f->path, O_RDWR | O_CLOEXEC);
    if (f->fd < 0 || ioctl(f->fd, MEMGETINFO, &info) != 0) {
        return errno;
    }
    f->page_bytes = info.writesize > 0 ? info.writesize : 1;
    f->block = malloc(f->device.block_bytes);
    return f->block ? 0 : ENOMEM;
}

int slot_medium_mtd(struct slot_medium *m, const char *path, enum slot_use use, int *fd)
{
    struct mtd_medium *f = calloc(1, sizeof *f);
    if (!f) {
        return ENOMEM;
    }
    f->fd = -1;
    int cause = strlen(path) < sizeof f->path ? 0 : ENAMETOOLONG;
    if (cause == 0) {
        memcpy(f->path, path, strlen(path) + 1);
        cause = drv_flash_mtd_open(&f->device, path);
    }
    if (cause != 0) {
        free(f);
        return cause;
    }
    cause = f->device.block_count <= LM_SLOT_COPIES ? ENOSPC
            : use == SLOT_TO_WRITE                  ? open_to_write(f)
                                                    : 0;
    if (cause != 0) {
        close_all(f);
        return cause;
    }
    *fd = f->fd >= 0 ? f->fd : f->device.fd;
    *m = (struct slot_medium){.ctx = f,
                              .unit_bytes = f->device.block_bytes,
                              .room_bytes = (uint64_t)record_block(f, 0) * f->device.block_bytes,
                              .read = read_image,
                              .write = write_image,
                              .read_record = read_record,
                              .write_record = write_record,
                              .resize = resize,
                              .sync = sync_all,
                              .forget = forget,
                              .close = close_all};
    return 0;
}
