#include "nav/read_track.h"

#include "read_formats.h"
#include "whole_text.h"

#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>
#include <zlib.h>

static bool ends_in(const char *name, size_t length, const char *extension)
{
    const size_t n = strlen(extension);
    return length >= n && strncasecmp(name + length - n, extension, n) == 0;
}

static enum nav_format format_by_name(const char *path)
{
    size_t length = strlen(path);
    if (ends_in(path, length, ".gz")) {
        length -= 3;
    }
    return ends_in(path, length, ".csv")   ? NAV_FORMAT_CSV
           : ends_in(path, length, ".gpx") ? NAV_FORMAT_GPX
           : ends_in(path, length, ".igc") ? NAV_FORMAT_IGC
           : ends_in(path, length, ".kml") ? NAV_FORMAT_KML
           : ends_in(path, length, ".kmz") ? NAV_FORMAT_KML
                                           : NAV_FORMAT_BY_NAME;
}

static int read_kml(const char *text, size_t size, struct nav_track *t, struct nav_reading *r)
{
    if (!nav_is_kmz(text, size)) {
        return nav_read_kml(text, size, t, r);
    }
    size_t kml_size = 0;
    char *kml = nav_unpack_kmz(text, size, r->name, &kml_size);
    const int result = kml ? nav_read_kml(kml, kml_size, t, r) : -1;
    free(kml);
    return result;
}

static int read_format(char *text, size_t size, enum nav_format format, struct nav_track *t,
                       struct nav_reading *r)
{
    if ((format == NAV_FORMAT_CSV || format == NAV_FORMAT_IGC) && strlen(text) != size) {
        return hs_error(r->name, "name the format with --format", "holds binary data, not text");
    }
    switch (format) {
    case NAV_FORMAT_CSV:
        return nav_read_csv(text, t, r);
    case NAV_FORMAT_GPX:
        return nav_read_gpx(text, size, t, r);
    case NAV_FORMAT_IGC:
        return nav_read_igc(text, t, r);
    case NAV_FORMAT_KML:
        return read_kml(text, size, t, r);
    case NAV_FORMAT_BY_NAME:
        break;
    }
    return hs_error(r->name, "name it with --format csv, gpx, igc or kml",
                    "the name does not tell the format");
}

int nav_read_text(char *text, size_t size, enum nav_format format, struct nav_track *t,
                  struct nav_reading *r)
{
    const size_t before = t->count;
    if (read_format(text, size, format, t, r) != 0) {
        return -1;
    }
    r->heights_left_out = nav_track_settle_heights(t);
    const size_t good = t->count - before, bad = r->malformed + r->disordered;
    if (bad > NAV_WARNINGS_SHOWN) {
        hs_warn(r->name, NULL, "%zu more lines were left out", bad - NAV_WARNINGS_SHOWN);
    }
    if (good == 0) {
        return hs_error(r->name, "check the format and the columns", "there is no fix in it");
    }
    if (bad > good) {
        return hs_error(r->name, "check the format and the columns",
                        "%zu lines cannot be used and only %zu can", bad, good);
    }
    return 0;
}

#define LARGEST_TEXT_BYTES ((size_t)1 << 31)

static int64_t read_gz(void *context, void *to, size_t bytes)
{
    const size_t most = 1 << 30; /* gzread counts in int */
    return gzread(context, to, (unsigned)(bytes < most ? bytes : most));
}

/* The whole text of a plain or compressed file, ending in '\0'; the caller frees. NULL when
 * reported. */
static char *read_all(gzFile file, const char *name, size_t *size)
{
    char *text;
    int code;
    switch (nav_whole_text(read_gz, file, LARGEST_TEXT_BYTES, &text, size)) {
    case NAV_WHOLE_UNREADABLE:
        hs_error(name, "copy the file again", "cannot be read: %s", gzerror(file, &code));
        break;
    case NAV_WHOLE_TOO_LARGE:
        hs_error(name, "cut it into parts", "is too large");
        break;
    case NAV_WHOLE_DONE:
        break;
    }
    return text;
}

int nav_read_track(const char *path, enum nav_format format, struct nav_track *t,
                   struct nav_reading *r)
{
    const bool is_stdin = strcmp(path, "-") == 0;
    r->name = is_stdin ? "standard input" : path;
    if (format == NAV_FORMAT_BY_NAME) {
        format = format_by_name(path);
    }
    hs_input_note(path);
    const int fd = is_stdin ? dup(STDIN_FILENO) : open(path, O_RDONLY | O_CLOEXEC);
    gzFile file = fd >= 0 ? gzdopen(fd, "rb") : NULL;
    if (!file) {
        const int cause = errno;
        if (fd >= 0) {
            close(fd);
        }
        return hs_error(r->name, "check the name", "cannot be opened: %s", strerror(cause));
    }
    size_t size = 0;
    char *text = read_all(file, r->name, &size);
    gzclose(file);
    const int result = text ? nav_read_text(text, size, format, t, r) : -1;
    free(text);
    return result;
}
