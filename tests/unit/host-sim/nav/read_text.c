#include "read_text.h"

#include "check.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Messages of readings that are meant to fail do not belong in the test's log. */
static int hush(void)
{
    fflush(stderr);
    const int saved = dup(STDERR_FILENO), null = open("/dev/null", O_WRONLY);
    dup2(null, STDERR_FILENO);
    close(null);
    return saved;
}

static void unhush(int saved)
{
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
}

struct result read_with(struct nav_reading reading, enum nav_format format, const char *text)
{
    struct result r = {.reading = reading};
    char *copy = strdup(text);
    const int saved = hush();
    r.status = nav_read_text(copy, strlen(text), format, &r.track, &r.reading);
    unhush(saved);
    free(copy);
    return r;
}

struct result read_as(enum nav_format format, bool is_strict, const char *text)
{
    return read_with((struct nav_reading){.name = "test", .is_strict = is_strict}, format, text);
}

struct result read_route(enum nav_format format, const char *text)
{
    return read_with((struct nav_reading){.name = "test", .is_route = true}, format, text);
}

struct result read_file(struct nav_reading reading, const char *path)
{
    struct result r = {.reading = reading};
    const int saved = hush();
    r.status = nav_read_track(path, NAV_FORMAT_BY_NAME, &r.track, &r.reading);
    unhush(saved);
    return r;
}

/* cmocka compares single precision only. */
void assert_near(double is, double wanted, double tolerance)
{
    assert_true(fabs(is - wanted) <= tolerance);
}
