#include "hs/whole_file.h"

#include <errno.h>
#include <unistd.h>

int hs_read_whole(int fd, void *to, uint32_t length, uint64_t from)
{
    uint8_t *bytes = to;
    while (length > 0) {
        const ssize_t got = pread(fd, bytes, length, (off_t)from);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return got < 0 ? errno : EIO;
        }
        bytes += got;
        from += (uint64_t)got;
        length -= (uint32_t)got;
    }
    return 0;
}

int hs_write_whole(int fd, const void *from, uint32_t length, uint64_t to)
{
    const uint8_t *bytes = from;
    while (length > 0) {
        const ssize_t put = pwrite(fd, bytes, length, (off_t)to);
        if (put < 0 && errno == EINTR) {
            continue;
        }
        if (put <= 0) {
            return put < 0 ? errno : EIO;
        }
        bytes += put;
        to += (uint64_t)put;
        length -= (uint32_t)put;
    }
    return 0;
}
