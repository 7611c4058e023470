#include "nav/read_track.h"

#include "hs/error.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

enum { WARNINGS_SHOWN = 5 };

int nav_bad_line(struct nav_reading *r, long line, const char *cause, ...)
{
    char place[512], text[256];
    snprintf(place, sizeof place, "%s line %ld", r->name, line);
    va_list arguments;
    va_start(arguments, cause);
    vsnprintf(text, sizeof text, cause, arguments);
    va_end(arguments);
    if (r->is_strict) {
        return hs_error(place, "correct the line, or leave out --strict to pass over it", "%s",
                        text);
    }
    if (r->malformed + r->disordered < WARNINGS_SHOWN) {
        hs_warn(place, NULL, "left out: %s", text);
    }
    return 0;
}

/* Angles of attitude and velocities are refused beyond what any aircraft does, because such a value
 * is a broken column and not a flight. */
static const char *first_fault(const struct nav_fix *f)
{
    if (!(fabs(f->latitude_deg) <= 90)) {
        return "the latitude is not within -90..90";
    }
    if (!(fabs(f->longitude_deg) <= 360)) {
        return "the longitude is not within -360..360";
    }
    if (fabs(f->height_m) > 100000) {
        return "the altitude is beyond 100 km";
    }
    if (f->speed_ms < 0 || f->speed_ms > 10000) {
        return "the ground speed is negative or beyond 10 km/s";
    }
    if (fabs(f->climb_ms) > 10000) {
        return "the vertical rate is beyond 10 km/s";
    }
    if (fabs(f->track_deg) > 360 || fabs(f->heading_deg) > 360 || fabs(f->roll_deg) > 360) {
        return "an angle is beyond 360 degrees";
    }
    if (fabs(f->pitch_deg) > 90) {
        return "the pitch is beyond 90 degrees";
    }
    return NULL;
}

int nav_accept(struct nav_track *t, struct nav_reading *r, const struct nav_fix *fix, long line)
{
    const char *fault = first_fault(fix);
    if (fault) {
        const int result = nav_bad_line(r, line, "%s", fault);
        r->malformed++;
        return result;
    }
    if (t->count > 0 && fix->time_us <= t->fix[t->count - 1].time_us) {
        const int result = nav_bad_line(r, line, "its time is not after that of the fix before it");
        r->disordered++;
        return result;
    }
    struct nav_fix f = *fix;
    f.longitude_deg = nav_wrap_180(f.longitude_deg);
    return nav_track_add(t, &f);
}

char *nav_next_line(char **text)
{
    char *line = *text;
    if (*line == '\0') {
        return NULL;
    }
    char *end = line + strcspn(line, "\n");
    *text = *end ? end + 1 : end;
    if (end > line && end[-1] == '\r') {
        end--;
    }
    *end = '\0';
    return line;
}

bool nav_parse_number(const char *text, double *value)
{
    char *end;
    /* strtod would also read hexadecimal, "nan" and "infinity". */
    if (text[strspn(text, "0123456789+-.eE \t")] != '\0') {
        return false;
    }
    *value = strtod(text, &end);
    return end != text && end[strspn(end, " \t")] == '\0' && isfinite(*value);
}

/* Hours and minutes of an offset from UTC, in seconds; `text` is what follows the seconds. */
static bool parse_offset(const char *text, long *offset_s)
{
    int hours = 0, minutes = 0, used = 0;
    *offset_s = 0;
    if (*text == '\0' || strcmp(text, "Z") == 0) {
        return true;
    }
    if ((*text != '+' && *text != '-') ||
        (sscanf(text + 1, "%2d:%2d%n", &hours, &minutes, &used) < 2 &&
         sscanf(text + 1, "%2d%2d%n", &hours, &minutes, &used) < 2) ||
        text[1 + used] != '\0') {
        return false;
    }
    *offset_s = (*text == '-' ? -1L : 1L) * (hours * 3600L + minutes * 60L);
    return true;
}

static bool parse_iso_time(const char *text, int64_t *time_us)
{
    int year, month, day, hour, minute, used = 0;
    double second;
    char separator;
    if (sscanf(text, "%4d-%2d-%2d%c%2d:%2d:%n", &year, &month, &day, &separator, &hour, &minute,
               &used) < 6 ||
        used == 0 || (separator != 'T' && separator != ' ') || !isdigit(text[used])) {
        return false;
    }
    char *end;
    second = strtod(text + used, &end);
    long offset_s;
    struct tm utc = {.tm_year = year - 1900, .tm_mon = month - 1, .tm_mday = day};
    const time_t midnight = timegm(&utc);
    /* timegm carries 31 June over to 1 July; such a date is a mistake here. */
    if (utc.tm_mon != month - 1 || utc.tm_mday != day || hour > 23 || minute > 59 ||
        !(second < 61) || hour < 0 || minute < 0 || !parse_offset(end, &offset_s)) {
        return false;
    }
    *time_us = ((int64_t)midnight + hour * 3600 + minute * 60 - offset_s) * 1000000 +
               llround(second * 1e6);
    return *time_us >= 0;
}

bool nav_parse_time(const char *text, int64_t *time_us)
{
    double count;
    if (!nav_parse_number(text, &count)) {
        return parse_iso_time(text, time_us);
    }
    const double unit_us = count < 1e11 ? 1e6 : count < 1e14 ? 1e3 : 1;
    if (count < 0 || count > 4e15) {
        return false;
    }
    *time_us = llround(count * unit_us);
    return true;
}

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
                                           : NAV_FORMAT_BY_NAME;
}

int nav_read_text(char *text, size_t size, enum nav_format format, struct nav_track *t,
                  struct nav_reading *r)
{
    const size_t before = t->count;
    int failed = -1;
    if (format != NAV_FORMAT_GPX && strlen(text) != size) {
        return hs_error(r->name, "name the format with --format", "holds binary data, not text");
    }
    switch (format) {
    case NAV_FORMAT_CSV:
        failed = nav_read_csv(text, t, r);
        break;
    case NAV_FORMAT_GPX:
        failed = nav_read_gpx(text, size, t, r);
        break;
    case NAV_FORMAT_IGC:
        failed = nav_read_igc(text, t, r);
        break;
    case NAV_FORMAT_BY_NAME:
        return hs_error(r->name, "name it with --format csv, gpx or igc",
                        "the name does not tell the format");
    }
    if (failed) {
        return -1;
    }
    const size_t good = t->count - before, bad = r->malformed + r->disordered;
    if (bad > WARNINGS_SHOWN) {
        hs_warn(r->name, NULL, "%zu more lines were left out", bad - WARNINGS_SHOWN);
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

enum { CHUNK_BYTES = 1 << 20 };
#define LARGEST_TEXT_BYTES ((size_t)1 << 31)

/* The whole text of a plain or compressed file, ending in '\0'; the caller frees. NULL when
 * reported. */
static char *read_all(gzFile file, const char *name, size_t *size)
{
    size_t capacity = CHUNK_BYTES, used = 0;
    char *text = malloc(capacity + 1);
    while (text) {
        const int n = gzread(file, text + used, (unsigned)(capacity - used));
        if (n < 0) {
            int code;
            hs_error(name, "copy the file again", "cannot be read: %s", gzerror(file, &code));
            break;
        }
        used += (size_t)n;
        if (n == 0) {
            text[used] = '\0';
            *size = used;
            return text;
        }
        if (used == capacity) {
            capacity *= 2;
            char *grown = capacity <= LARGEST_TEXT_BYTES ? realloc(text, capacity + 1) : NULL;
            if (!grown) {
                hs_error(name, "cut it into parts", "is too large");
                break;
            }
            text = grown;
        }
    }
    free(text);
    return NULL;
}

int nav_read_track(const char *path, enum nav_format format, struct nav_track *t,
                   struct nav_reading *r)
{
    const bool is_stdin = strcmp(path, "-") == 0;
    r->name = is_stdin ? "standard input" : path;
    if (format == NAV_FORMAT_BY_NAME) {
        format = format_by_name(path);
    }
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
