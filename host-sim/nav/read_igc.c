/* IGC flight recorder files (FAI, "Technical specification for GNSS flight recorders", section A4):
 * the date from the H record, the fixes from B records. */
#include "read_formats.h"

#include "hs/error.h"
#include "nav/parse.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

enum { B_LENGTH = 35, DAY_S = 86400 };

/* `count` decimal digits as a number, or -1. */
static long digits(const char *text, int count)
{
    long value = 0;
    for (int i = 0; i < count; i++) {
        if (!isdigit((unsigned char)text[i])) {
            return -1;
        }
        value = 10 * value + (text[i] - '0');
    }
    return value;
}

/* HFDTE130609 or HFDTEDATE:130609,01: midnight of that day. */
static bool read_date(const char *line, int64_t *midnight_s)
{
    const char *text = line + 5;
    text += strncasecmp(text, "DATE:", 5) == 0 ? 5 : 0;
    while (*text == ' ') {
        text++;
    }
    const long day = digits(text, 2);
    const long month = day >= 0 ? digits(text + 2, 2) : -1;
    const long year = month >= 0 ? digits(text + 4, 2) : -1;
    if (day < 1 || day > 31 || month < 1 || month > 12 || year < 0) {
        return false;
    }
    /* Two digits of the year; the format is of 1995. */
    struct tm utc = {.tm_mday = (int)day,
                     .tm_mon = (int)month - 1,
                     .tm_year = (int)(year < 80 ? year + 100 : year)};
    *midnight_s = (int64_t)timegm(&utc);
    return true;
}

/* Degrees, and minutes in thousandths, as DDMMmmmN or DDDMMmmmE. */
static bool read_angle(const char *text, int degree_digits, const char *signs, double *deg)
{
    const long degrees = digits(text, degree_digits);
    const long minutes = digits(text + degree_digits, 5);
    const char sign = text[degree_digits + 5];
    if (degrees < 0 || minutes < 0 || minutes >= 60000 || sign == '\0' || !strchr(signs, sign)) {
        return false;
    }
    *deg = ((double)degrees + (double)minutes / 60000.0) * (sign == signs[0] ? 1 : -1);
    return true;
}

/* Five characters, the first of which may be a minus sign. */
static bool read_altitude(const char *text, double *metres)
{
    const bool is_negative = *text == '-';
    const long value = digits(text + is_negative, 5 - is_negative);
    *metres = is_negative ? -(double)value : (double)value;
    return value >= 0;
}

/* B HHMMSS DDMMmmmN DDDMMmmmE V PPPPP GGGGG; V is A for a fix with GNSS altitude, V for one
 * without. */
static const char *read_fix(const char *line, struct nav_fix *fix)
{
    if (strlen(line) < B_LENGTH) {
        return "the B record is too short";
    }
    const long hour = digits(line + 1, 2), minute = digits(line + 3, 2),
               second = digits(line + 5, 2);
    if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 || second > 60) {
        return "the time cannot be read";
    }
    fix->time_us = ((int64_t)hour * 3600 + minute * 60 + second) * 1000000;
    if (!read_angle(line + 7, 2, "NS", &fix->latitude_deg) ||
        !read_angle(line + 15, 3, "EW", &fix->longitude_deg)) {
        return "the position cannot be read";
    }
    fix->is_barometric = line[24] != 'A';
    if (!read_altitude(line + (fix->is_barometric ? 25 : 30), &fix->height_m)) {
        return "the altitude cannot be read";
    }
    return NULL;
}

struct igc {
    bool has_date;
    bool is_above_geoid; /* the record HFALG says that GNSS altitudes are above mean sea level */
    int64_t midnight_s;
    int64_t last_us; /* time of day of the fix before, 0 at first */
};

static int read_line(struct igc *g, const char *line, long number, struct nav_track *t,
                     struct nav_reading *r)
{
    if (strncasecmp(line, "HFDTE", 5) == 0 && !g->has_date) {
        g->has_date = read_date(line, &g->midnight_s);
    }
    if (strncasecmp(line, "HFALG", 5) == 0) {
        g->is_above_geoid = strstr(line, "GEO") != NULL;
    }
    if (*line != 'B') {
        return 0;
    }
    if (!g->has_date && !r->is_route) {
        return hs_error(r->name, "put a line such as HFDTE130609 before the first B record",
                        "line %ld: there is a fix but no readable date", number);
    }
    struct nav_fix fix = nav_fix_blank();
    const char *fault = read_fix(line, &fix);
    if (fault) {
        const int result = nav_bad_line(r, number, "%s", fault);
        r->malformed++;
        return result;
    }
    /* The records tell only the time of day; half a day back is midnight passing, not disorder. */
    if (fix.time_us + DAY_S / 2 * (int64_t)1000000 < g->last_us) {
        g->midnight_s += DAY_S;
    }
    g->last_us = fix.time_us;
    fix.time_us += g->midnight_s * 1000000;
    fix.geoid_m = g->is_above_geoid || fix.is_barometric ? NAN : 0;
    return nav_accept(t, r, &fix, number);
}

int nav_read_igc(char *text, struct nav_track *t, struct nav_reading *r)
{
    struct igc g = {0};
    char *line;
    for (long number = 1; (line = nav_next_line(&text)) != NULL; number++) {
        if (read_line(&g, line, number, t, r) != 0) {
            return -1;
        }
    }
    return 0;
}
