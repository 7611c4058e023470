/* A slot in a file or on a block device, or in a file that is the contents of a flash chip. */
#include "hs/durable_file.h"
#include "hs/whole_file.h"
#include "media.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    UNIT_BYTES = 64 << 10,
    RECORD_BYTES = 4096,
    /* From copy to copy: farther than the pages that cards write at once, so that a cut while one
     * is written leaves the other. */
    RECORD_STEP = 64 << 10,
    RECORDS_BYTES = LM_SLOT_COPIES * RECORD_STEP,
    FILE_MODE = 0644 /* the panel's user reads what another may have written */
};

struct file_medium {
    int image_fd, records_fd;
    uint64_t records_at; /* of the first copy, in records_fd */
    bool is_device;
};

static int read_image(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    const struct file_medium *f = ctx;
    return hs_read_whole(f->image_fd, to, length, offset);
}

static int write_image(void *ctx, uint64_t offset, const void *from, uint32_t length)
{
    const struct file_medium *f = ctx;
    return hs_write_whole(f->image_fd, from, length, offset);
}

static int read_record(void *ctx, uint32_t copy, struct lm_slot_record *record)
{
    const struct file_medium *f = ctx;
    memset(record, 0, sizeof *record);
    const ssize_t got = pread(f->records_fd, record, sizeof *record,
                              (off_t)(f->records_at + (uint64_t)copy * RECORD_STEP));
    if (got >= 0 && got < (ssize_t)sizeof *record) {
        memset(record, 0, sizeof *record); /* a file that is shorter has none */
    }
    return got < 0 ? errno : 0;
}

static int write_record(void *ctx, uint32_t copy, const struct lm_slot_record *record)
{
    const struct file_medium *f = ctx;
    uint8_t block[RECORD_BYTES] = {0};
    memcpy(block, record, sizeof *record);
    return hs_write_whole(f->records_fd, block, sizeof block,
                          f->records_at + (uint64_t)copy * RECORD_STEP);
}

/* Room is taken before the first byte is written: a full disk is known then. */
static int resize(void *ctx, uint64_t bytes)
{
    const struct file_medium *f = ctx;
    if (f->is_device) {
        return bytes <= f->records_at ? 0 : ENOSPC;
    }
    if (bytes > INT64_MAX) {
        return EFBIG;
    }
    if (ftruncate(f->image_fd, (off_t)bytes) != 0) {
        return errno;
    }
    const int cause = posix_fallocate(f->image_fd, 0, (off_t)bytes);
    return cause == EOPNOTSUPP || cause == EINVAL ? 0 : cause;
}

static int sync_all(void *ctx)
{
    const struct file_medium *f = ctx;
    if (fsync(f->image_fd) != 0) {
        return errno;
    }
    return f->is_device || fsync(f->records_fd) == 0 ? 0 : errno;
}

static void forget(void *ctx)
{
    const struct file_medium *f = ctx;
    (void)posix_fadvise(f->image_fd, 0, 0, POSIX_FADV_DONTNEED);
}

static void close_all(void *ctx)
{
    struct file_medium *f = ctx;
    close(f->image_fd);
    if (f->records_fd >= 0 && f->records_fd != f->image_fd) {
        close(f->records_fd);
    }
    free(f);
}

/* Devices are often named by links; a link in the place of a file could lead anywhere. */
static int open_one(const char *path, enum slot_use use, int *fd)
{
    const bool is_device = strncmp(path, "/dev/", 5) == 0;
    const int flags = O_CLOEXEC | (is_device ? 0 : O_NOFOLLOW) |
                      (use == SLOT_TO_READ ? O_RDONLY : O_RDWR | (is_device ? 0 : O_CREAT));
    *fd = open(path, flags, FILE_MODE);
    if (*fd < 0) {
        return errno;
    }
    struct stat about;
    if (fstat(*fd, &about) != 0 || (!S_ISREG(about.st_mode) && !S_ISBLK(about.st_mode))) {
        close(*fd);
        *fd = -1;
        return S_ISDIR(about.st_mode) ? EISDIR : EINVAL;
    }
    if (use == SLOT_TO_WRITE && S_ISREG(about.st_mode)) {
        hs_give_to_owner(*fd, path, FILE_MODE);
    }
    return 0;
}

/* Erased flash behind what the file has. */
static int fill_chip(int fd, uint64_t from, uint64_t to)
{
    uint8_t erased[RECORD_BYTES];
    memset(erased, 0xff, sizeof erased);
    int cause = 0;
    while (from < to && cause == 0) {
        const uint64_t left = to - from;
        const uint32_t length = left < sizeof erased ? (uint32_t)left : (uint32_t)sizeof erased;
        cause = hs_write_whole(fd, erased, length, from);
        from += length;
    }
    return cause;
}

static int find_records(struct file_medium *f, const char *path, uint64_t chip_bytes,
                        enum slot_use use)
{
    struct stat about;
    char name[PATH_MAX];
    if (fstat(f->image_fd, &about) != 0) {
        return errno;
    }
    if (chip_bytes != 0 && S_ISREG(about.st_mode) && use == SLOT_TO_WRITE) {
        const int cause = fill_chip(f->image_fd, (uint64_t)about.st_size, chip_bytes);
        if (cause != 0) {
            return cause;
        }
    }
    f->is_device = S_ISBLK(about.st_mode) || chip_bytes != 0;
    if (f->is_device) {
        const off_t end = lseek(f->image_fd, 0, SEEK_END);
        if (chip_bytes != 0 && (uint64_t)end != chip_bytes) {
            return EINVAL;
        }
        f->records_fd = f->image_fd;
        f->records_at = end < RECORDS_BYTES ? 0 : ((uint64_t)end - RECORDS_BYTES) & ~UINT64_C(4095);
        return end < 2 * RECORDS_BYTES ? ENOSPC : 0;
    }
    if (snprintf(name, sizeof name, "%s.state", path) >= (int)sizeof name) {
        return ENAMETOOLONG;
    }
    const int cause = open_one(name, use, &f->records_fd);
    /* The name of a new file is on the medium when its folder is. */
    return cause == 0 && use == SLOT_TO_WRITE ? hs_sync_folder(path) : cause;
}

int slot_medium_file(struct slot_medium *m, const char *path, uint64_t chip_bytes,
                     enum slot_use use, int *fd)
{
    struct file_medium *f = malloc(sizeof *f);
    if (!f) {
        return ENOMEM;
    }
    *f = (struct file_medium){.image_fd = -1, .records_fd = -1};
    int cause = open_one(path, use, &f->image_fd);
    if (cause != 0) {
        free(f);
        return cause;
    }
    cause = find_records(f, path, chip_bytes, use);
    if (cause != 0) {
        close_all(f);
        return cause;
    }
    *fd = f->image_fd;
    *m = (struct slot_medium){.ctx = f,
                              .unit_bytes = UNIT_BYTES,
                              .room_bytes = f->is_device ? f->records_at : UINT64_MAX,
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
