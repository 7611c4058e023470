/* CSV with a header line. Units follow the habit of ADS-B archives (feet, knots, feet a minute)
 * unless the column's name says _m or _ms. */
#include "read_formats.h"

#include "hs/error.h"
#include "hs/number.h"
#include "nav/parse.h"

#include <math.h>
#include <stddef.h>
#include <string.h>
#include <strings.h>

#define FOOT_M  0.3048
#define KNOT_MS (1852.0 / 3600.0)

enum { COLUMNS_MAX = 64 };

/* What a column of heights measures from; where a file has several, the highest counts. */
enum surface { NO_SURFACE, BAROMETRIC, SEA_LEVEL, ELLIPSOID };

struct column {
    const char *name;
    size_t offset; /* of the double in struct nav_fix; not used for the time */
    double scale;  /* to the unit of struct nav_fix; 0 marks the time */
    enum surface surface;
};

#define FIX(member)        offsetof(struct nav_fix, member)
#define HEIGHT(unit, from) FIX(height_m), unit, from

/* Where two columns give the same value the one further left in the file counts. */
static const struct column known[] = {
    {"timestamp", 0, 0, NO_SURFACE},
    {"time", 0, 0, NO_SURFACE},
    {"datetime", 0, 0, NO_SURFACE},
    {"latitude", FIX(latitude_deg), 1, NO_SURFACE},
    {"lat", FIX(latitude_deg), 1, NO_SURFACE},
    {"longitude", FIX(longitude_deg), 1, NO_SURFACE},
    {"lon", FIX(longitude_deg), 1, NO_SURFACE},
    {"lng", FIX(longitude_deg), 1, NO_SURFACE},
    {"altitude", HEIGHT(FOOT_M, BAROMETRIC)},
    {"alt", HEIGHT(FOOT_M, BAROMETRIC)},
    {"baro_altitude_m", HEIGHT(1, BAROMETRIC)},
    {"altitude_m", HEIGHT(1, SEA_LEVEL)},
    {"alt_m", HEIGHT(1, SEA_LEVEL)},
    {"height_m", HEIGHT(1, SEA_LEVEL)},
    {"geoaltitude", HEIGHT(FOOT_M, ELLIPSOID)},
    {"ellipsoid_height_m", HEIGHT(1, ELLIPSOID)},
    {"geoid_m", FIX(geoid_m), 1, NO_SURFACE},
    {"groundspeed", FIX(speed_ms), KNOT_MS, NO_SURFACE},
    {"gs", FIX(speed_ms), KNOT_MS, NO_SURFACE},
    {"groundspeed_ms", FIX(speed_ms), 1, NO_SURFACE},
    {"speed_ms", FIX(speed_ms), 1, NO_SURFACE},
    {"track", FIX(track_deg), 1, NO_SURFACE},
    {"heading", FIX(heading_deg), 1, NO_SURFACE},
    {"roll", FIX(roll_deg), 1, NO_SURFACE},
    {"pitch", FIX(pitch_deg), 1, NO_SURFACE},
    {"vertical_rate", FIX(climb_ms), FOOT_M / 60, NO_SURFACE},
    {"vertical_rate_ms", FIX(climb_ms), 1, NO_SURFACE},
};

struct csv {
    char separator;
    int count;
    const struct column *column[COLUMNS_MAX]; /* NULL for one that is passed over */
    enum surface surface;                     /* of the column of heights */
};

static char *trim(char *text)
{
    text += strspn(text, " \t\"");
    size_t n = strlen(text);
    while (n > 0 && strchr(" \t\"", text[n - 1])) {
        text[--n] = '\0';
    }
    return text;
}

/* Cut the next field off `*line`, or return NULL after the last. */
static char *next_field(char **line, char separator)
{
    char *field = *line;
    if (!field) {
        return NULL;
    }
    char *end = strchr(field, separator);
    *line = end ? end + 1 : NULL;
    if (end) {
        *end = '\0';
    }
    return trim(field);
}

static const struct column *find_column(const char *name)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcasecmp(known[i].name, name) == 0) {
            return &known[i];
        }
    }
    return NULL;
}

static bool has_value(const struct csv *c, size_t offset, bool is_time)
{
    for (int i = 0; i < c->count; i++) {
        if (c->column[i] && (c->column[i]->scale == 0) == is_time &&
            c->column[i]->offset == offset) {
            return true;
        }
    }
    return false;
}

/* Pass over the column of heights that was taken before a better one came. */
static void drop_heights(struct csv *c)
{
    for (int i = 0; i < c->count; i++) {
        if (c->column[i] && c->column[i]->surface != NO_SURFACE) {
            c->column[i] = NULL;
        }
    }
}

static int read_header(struct csv *c, char *line, struct nav_reading *r)
{
    c->separator = strchr(line, ';') ? ';' : strchr(line, '\t') ? '\t' : ',';
    if (strncmp(line, "\xEF\xBB\xBF", 3) == 0) {
        line += 3; /* the byte order mark of some spreadsheets */
    }
    for (char *name; (name = next_field(&line, c->separator)) != NULL; c->count++) {
        if (c->count == COLUMNS_MAX) {
            return hs_error(r->name, "leave out the columns that are not needed",
                            "there are more than %d columns", COLUMNS_MAX);
        }
        const struct column *found = find_column(name);
        if (found && found->surface > c->surface) {
            drop_heights(c);
            c->surface = found->surface;
        } else if (found && has_value(c, found->offset, found->scale == 0)) {
            found = NULL;
        }
        c->column[c->count] = found;
    }
    if ((!has_value(c, 0, true) && !r->is_route) || !has_value(c, FIX(latitude_deg), false) ||
        !has_value(c, FIX(longitude_deg), false)) {
        return hs_error(r->name, "name the columns in the first line (see landmass-nav --help)",
                        "the header does not name a time, a latitude and a longitude (a route, "
                        "which --speed flies, needs no time)");
    }
    return 0;
}

/* Returns what is wrong with the line, or NULL. An empty field is a value that is not known. */
static const char *read_fix(const struct csv *c, char *line, struct nav_fix *fix, bool *has_time)
{
    *has_time = false;
    for (int i = 0; i < c->count; i++) {
        const struct column *column = c->column[i];
        const char *field = next_field(&line, c->separator);
        if (!field) {
            return "it has fewer columns than the header";
        }
        if (!column || *field == '\0') {
            continue;
        }
        if (column->scale == 0) {
            *has_time = nav_parse_time(field, &fix->time_us);
            if (!*has_time) {
                return "the time cannot be read";
            }
            continue;
        }
        double value;
        if (!hs_number(field, &value)) {
            return "a field is not a number";
        }
        *(double *)(void *)((char *)fix + column->offset) = value * column->scale;
    }
    return line ? "it has more columns than the header" : NULL;
}

static int read_line(const struct csv *c, char *line, long number, struct nav_track *t,
                     struct nav_reading *r)
{
    struct nav_fix fix = nav_fix_blank();
    bool has_time;
    const char *fault = read_fix(c, line, &fix, &has_time);
    if (fault) {
        const int result = nav_bad_line(r, number, "%s", fault);
        r->malformed++;
        return result;
    }
    fix.is_barometric = c->surface == BAROMETRIC;
    if (c->surface == ELLIPSOID) {
        fix.geoid_m = 0;
    }
    if ((!has_time && !r->is_route) || isnan(fix.latitude_deg) || isnan(fix.longitude_deg)) {
        r->missing++;
        return 0;
    }
    return nav_accept(t, r, &fix, number);
}

int nav_read_csv(char *text, struct nav_track *t, struct nav_reading *r)
{
    struct csv c = {0};
    char *line = nav_next_line(&text);
    if (!line) {
        return hs_error(r->name, NULL, "the file is empty");
    }
    if (read_header(&c, line, r) != 0) {
        return -1;
    }
    for (long number = 2; (line = nav_next_line(&text)) != NULL; number++) {
        if (line[strspn(line, " \t")] != '\0' && read_line(&c, line, number, t, r) != 0) {
            return -1;
        }
    }
    return 0;
}
