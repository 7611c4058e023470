#include "drv/flash_mtd.h"

#include <errno.h>
#include <fcntl.h>
#include <mtd/mtd-user.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

static bool is_error_counted(const struct drv_flash_mtd *f, struct mtd_ecc_stats *stats)
{
    return f->has_ecc && ioctl(f->fd, ECCGETSTATS, stats) == 0;
}

static bool read_whole(const struct drv_flash_mtd *f, uint8_t *to, uint32_t length, uint64_t from)
{
    while (length > 0) {
        const ssize_t got = pread(f->fd, to, length, (off_t)from);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return false;
        }
        to += got;
        from += (uint64_t)got;
        length -= (uint32_t)got;
    }
    return true;
}

/* read() hands out the bytes of a page that could not be corrected as if nothing were wrong
 * (Linux, drivers/mtd/mtdchar.c, mtdchar_read): only the device's own counts tell. */
static int read_blocks(struct drv_flash_mtd *f, uint64_t offset, uint8_t *to, uint32_t length)
{
    struct mtd_ecc_stats before, after;
    const bool is_counted = is_error_counted(f, &before);
    while (length > 0) {
        const uint32_t within = (uint32_t)(offset % f->block_bytes);
        const uint32_t left = f->block_bytes - within;
        const uint32_t part = length < left ? length : left;
        const uint64_t block = f->blocks[offset / f->block_bytes];
        if (!read_whole(f, to, part, block * f->block_bytes + within)) {
            f->count.errors++;
            return LM_ERR_IO;
        }
        to += part;
        offset += part;
        length -= part;
    }
    if (!is_counted || !is_error_counted(f, &after)) {
        return LM_OK;
    }
    f->count.corrected += after.corrected != before.corrected;
    f->count.uncorrectable += after.failed != before.failed;
    return after.failed == before.failed ? LM_OK : LM_ERR_IO;
}

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct drv_flash_mtd *f = ctx;
    if (offset > f->port.size_bytes || length > f->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    f->last_status = read_blocks(f, offset, destination, length);
    return LM_OK;
}

static int read_poll(void *ctx)
{
    const struct drv_flash_mtd *f = ctx;
    return f->last_status;
}

/* A device without bad blocks (NOR, RAM) answers 0 for each, or that it does not know the
 * question. */
static int map_blocks(struct drv_flash_mtd *f, uint32_t all)
{
    f->blocks = malloc(all * sizeof *f->blocks);
    if (f->blocks == NULL) {
        return ENOMEM;
    }
    for (uint32_t i = 0; i < all; i++) {
        loff_t at = (loff_t)i * f->block_bytes;
        if (ioctl(f->fd, MEMGETBADBLOCK, &at) > 0) {
            f->count.bad_blocks++;
        } else {
            f->blocks[f->block_count++] = i;
        }
    }
    return 0;
}

static int examine(struct drv_flash_mtd *f)
{
    struct mtd_info_user info;
    struct mtd_ecc_stats stats;
    if (ioctl(f->fd, MEMGETINFO, &info) != 0) {
        return ENOTTY;
    }
    if (info.erasesize == 0 || info.size < info.erasesize) {
        return EINVAL;
    }
    f->block_bytes = info.erasesize;
    f->has_ecc = (info.type == MTD_NANDFLASH || info.type == MTD_MLCNANDFLASH) &&
                 ioctl(f->fd, ECCGETSTATS, &stats) == 0;
    return map_blocks(f, info.size / info.erasesize);
}

int drv_flash_mtd_open(struct drv_flash_mtd *f, const char *path)
{
    *f = (struct drv_flash_mtd){.fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (f->fd < 0) {
        return errno;
    }
    const int cause = examine(f);
    if (cause != 0) {
        drv_flash_mtd_close(f);
        return cause;
    }
    f->port = (struct lm_flash){.ctx = f,
                                .size_bytes = (uint64_t)f->block_count * f->block_bytes,
                                .read_start = read_start,
                                .read_poll = read_poll};
    return 0;
}

void drv_flash_mtd_close(struct drv_flash_mtd *f)
{
    free(f->blocks);
    f->blocks = NULL;
    if (f->fd >= 0) {
        close(f->fd);
        f->fd = -1;
    }
}
