#include "trust/serial.h"

#include "hs/durable_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LINE_BYTES = 40 };

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

int trust_serial_write(const char *path, uint64_t serial)
{
    char line[LINE_BYTES];
    const int length = snprintf(line, sizeof line, "serial %" PRIu64 "\n", serial);
    return hs_replace_file(path, line, (size_t)length, 0644);
}
