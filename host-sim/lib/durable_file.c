#include "hs/durable_file.h"

#include "hs/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

int hs_sync_folder(const char *path)
{
    char copy[PATH_MAX];
    if (snprintf(copy, sizeof copy, "%s", path) >= (int)sizeof copy) {
        return ENAMETOOLONG;
    }
    const int fd = open(dirname(copy), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0) {
        return errno;
    }
    const int cause = fsync(fd) == 0 || errno == EINVAL ? 0 : errno;
    close(fd);
    return cause;
}

void hs_give_to_owner(int fd, const char *path, mode_t mode)
{
    struct stat folder;
    char copy[PATH_MAX];
    snprintf(copy, sizeof copy, "%s", path);
    (void)fchmod(fd, mode);
    if (geteuid() == 0 && stat(dirname(copy), &folder) == 0 &&
        fchown(fd, folder.st_uid, folder.st_gid) != 0) {
        return; /* a file system without owners */
    }
}

static int write_new(const char *path, const void *bytes, size_t length, mode_t mode)
{
    const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
    if (fd < 0) {
        return errno;
    }
    int cause = hs_write_whole(fd, bytes, (uint32_t)length, 0);
    if (cause == 0 && fsync(fd) != 0) {
        cause = errno;
    }
    if (close(fd) != 0 && cause == 0) {
        cause = errno;
    }
    return cause;
}

int hs_replace_file(const char *path, const void *bytes, size_t length, mode_t mode)
{
    char name[PATH_MAX];
    if (snprintf(name, sizeof name, "%s.new", path) >= (int)sizeof name) {
        return ENAMETOOLONG;
    }
    int cause = write_new(name, bytes, length, mode);
    if (cause == 0 && rename(name, path) != 0) {
        cause = errno;
    }
    if (cause != 0) {
        unlink(name);
        return cause;
    }
    return hs_sync_folder(path);
}
