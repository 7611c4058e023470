#include "drv/flash_file.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file answers at once, so the read is done here and its result kept for read_poll. */
static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct drv_flash_file *f = ctx;
    if (offset > f->port.size_bytes || length > f->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    uint8_t *to = destination;
    f->last_status = LM_OK;
    while (length > 0) {
        const ssize_t got = pread(f->descriptor, to, length, (off_t)offset);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) { /* an error, or the file has become shorter */
            f->last_status = LM_ERR_IO;
            break;
        }
        to += got;
        offset += (uint64_t)got;
        length -= (uint32_t)got;
    }
    return LM_OK;
}

static int read_poll(void *ctx)
{
    const struct drv_flash_file *f = ctx;
    return f->last_status;
}

int drv_flash_file_open(struct drv_flash_file *f, const char *path)
{
    f->descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (f->descriptor < 0) {
        return errno;
    }
    struct stat status;
    if (fstat(f->descriptor, &status) == 0 && S_ISDIR(status.st_mode)) {
        drv_flash_file_close(f);
        return EISDIR;
    }
    /* A device tells its size by its end, a file too. */
    const off_t size = lseek(f->descriptor, 0, SEEK_END);
    if (size < 0) {
        const int cause = errno;
        drv_flash_file_close(f);
        return cause;
    }
    f->last_status = LM_OK;
    f->port = (struct lm_flash){
        .ctx = f, .size_bytes = (uint64_t)size, .read_start = read_start, .read_poll = read_poll};
    return 0;
}

void drv_flash_file_close(struct drv_flash_file *f)
{
    close(f->descriptor);
    f->descriptor = -1;
}
