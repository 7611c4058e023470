#include "trust/serial.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <libgen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LINE_BYTES = 40, PATH_BYTES = 4096 };

/* "serial 7\n" and nothing else. */
static int parse(const char *line, uint64_t *serial)
{
    static const char word[] = "serial ";
    const size_t length = strlen(word);
    if (strncmp(line, word, length) != 0 || line[length] < '0' || line[length] > '9') {
        return EBADMSG;
    }
    char *end;
    errno = 0;
    const uint64_t value = strtoull(line + length, &end, 10);
    if (errno != 0 || strcmp(end, "\n") != 0) {
        return EBADMSG;
    }
    *serial = value;
    return 0;
}

int trust_serial_read(const char *path, uint64_t *serial)
{
    char line[LINE_BYTES];
    *serial = 0;
    const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        return errno == ENOENT ? 0 : errno;
    }
    const ssize_t got = read(descriptor, line, sizeof line - 1);
    const int cause = errno;
    close(descriptor);
    if (got < 0) {
        return cause;
    }
    line[got] = '\0';
    return parse(line, serial);
}

static int write_line(const char *path, const char *line)
{
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0) {
        return errno;
    }
    const ssize_t bytes = (ssize_t)strlen(line);
    errno = ENOSPC; /* of a write that is cut short */
    int cause =
        write(descriptor, line, (size_t)bytes) == bytes && fsync(descriptor) == 0 ? 0 : errno;
    if (close(descriptor) != 0 && cause == 0) {
        cause = errno;
    }
    return cause;
}

/* Bring the new name to the medium. */
static int sync_folder(const char *path)
{
    char copy[PATH_BYTES];
    snprintf(copy, sizeof copy, "%s", path);
    const int descriptor = open(dirname(copy), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) {
        return errno;
    }
    const int cause = fsync(descriptor) == 0 ? 0 : errno;
    close(descriptor);
    return cause;
}

int trust_serial_write(const char *path, uint64_t serial)
{
    char temporary[PATH_BYTES], line[LINE_BYTES];
    const int length = snprintf(temporary, sizeof temporary, "%s.new", path);
    if (length < 0 || length >= (int)sizeof temporary) {
        return ENAMETOOLONG;
    }
    snprintf(line, sizeof line, "serial %" PRIu64 "\n", serial);
    int cause = write_line(temporary, line);
    if (cause == 0 && rename(temporary, path) != 0) {
        cause = errno;
    }
    if (cause != 0) {
        unlink(temporary);
        return cause;
    }
    return sync_folder(path);
}
