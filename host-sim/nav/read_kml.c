/* KML 2.2 and 2.3 (OGC 07-147r2, 12-007r2), with Google's gx: names of what 2.3 took over. Fixes
 * are those of tracks (gx:Track): its n-th time belongs to its n-th place and its n-th attitude.
 * Each track begins a leg. A file without tracks may have placemarks instead, each a Point with a
 * TimeStamp: they are one leg in the order of their times. As a route: the places of tracks, or of
 * the first line (LineString), whichever the file has first. Altitudes are above mean sea level
 * where altitudeMode is absolute; all others are above a ground that is not known here. */
#include "nav/parse.h"
#include "read_formats.h"
#include "read_xml.h"

#include "hs/error.h"
#include "hs/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS_MOST = 20000000, MODE_SIZE = 24 };

struct point {
    struct nav_fix fix;
    const char *fault; /* what is wrong with it; or NULL */
    bool has_place;
    long line;
};

/* A Placemark with a TimeStamp and a Point. */
struct mark {
    struct point point;
    char mode[MODE_SIZE]; /* altitudeMode */
    bool has_time;
    size_t order; /* in the file */
};

struct kml {
    struct nav_track *track;
    struct nav_reading *reading;
    const char *shape;    /* the element that is read, "Track" or "LineString"; NULL until one is */
    bool is_in_shape;     /* `depth` elements inside one */
    unsigned depth;       /* below it; its own values lie at 1 */
    struct point *points; /* owned: of the shape being read */
    size_t times, places, attitudes, capacity;
    char mode[MODE_SIZE];        /* altitudeMode of the shape */
    size_t lines;                /* all LineStrings of the file */
    size_t links;                /* to other files */
    size_t above_ground;         /* altitudes left out */
    char ground_mode[MODE_SIZE]; /* the altitudeMode of the first of them */
    struct mark *marks;          /* owned: those with a time and a place */
    size_t mark_count, mark_capacity;
    struct mark mark; /* being read */
    bool is_in_point, is_in_stamp;
};

/* Point `index` of the shape, or NULL with the error reported. */
static struct point *point_at(struct kml *k, size_t index, long line)
{
    if (index >= k->capacity) {
        const size_t capacity = k->capacity > 0 ? 2 * k->capacity : 64;
        struct point *grown =
            capacity <= POINTS_MOST ? realloc(k->points, capacity * sizeof *grown) : NULL;
        if (!grown) {
            hs_error(k->reading->name, "cut it into parts", "has a track that is too long");
            return NULL;
        }
        for (size_t i = k->capacity; i < capacity; i++) {
            grown[i] = (struct point){.fix = nav_fix_blank()};
        }
        k->points = grown;
        k->capacity = capacity;
    }
    k->points[index].line = line;
    return &k->points[index];
}

/* Numbers between separators; an empty one counts between commas and not between blanks. Returns
 * how many, or -1 for anything else or more than three. */
static int cut_numbers(char *text, const char *separators, double value[3])
{
    int count = 0;
    for (char *part; (part = strsep(&text, separators)) != NULL;) {
        if (*part == '\0' && *separators != ',') {
            continue;
        }
        if (count == 3 || !hs_number(part, &value[count])) {
            return -1;
        }
        count++;
    }
    return count;
}

static void read_place(struct point *p, char *text, const char *separators)
{
    double value[3];
    const int count = cut_numbers(text, separators, value);
    p->has_place = true;
    if (count < 2) {
        p->fault = "the place is not longitude, latitude and altitude";
        return;
    }
    p->fix.longitude_deg = value[0];
    p->fix.latitude_deg = value[1];
    p->fix.height_m = count == 3 ? value[2] : NAN;
}

/* A year alone is a time of KML, and a number of seconds elsewhere. */
static void read_time(struct point *p, const char *text)
{
    if (!strchr(text, 'T') || !nav_parse_time(text, &p->fix.time_us)) {
        p->fault = "the time is not a date with a time of day";
    }
}

static int take_place(struct kml *k, char *text, const char *separators, long line)
{
    struct point *p = point_at(k, k->places++, line);
    if (!p || *text == '\0') {
        return p ? 0 : -1; /* an empty one honestly says that there was no fix */
    }
    read_place(p, text, separators);
    return 0;
}

static int take_line(struct kml *k, char *text, long line)
{
    char *rest;
    for (char *place = strtok_r(text, " \t\r\n", &rest); place;
         place = strtok_r(NULL, " \t\r\n", &rest)) {
        if (take_place(k, place, ",", line) != 0) {
            return -1;
        }
    }
    return 0;
}

static int take_time(struct kml *k, const char *text, long line)
{
    struct point *p = point_at(k, k->times++, line);
    if (!p) {
        return -1;
    }
    if (!k->reading->is_route) {
        read_time(p, text);
    }
    return 0;
}

/* Heading, tilt and roll turn about the axes up, right and ahead, as ours do. */
static int take_attitude(struct kml *k, char *text, long line)
{
    struct point *p = point_at(k, k->attitudes++, line);
    double value[3];
    if (!p || *text == '\0') {
        return p ? 0 : -1;
    }
    if (cut_numbers(text, " \t\r\n", value) != 3) {
        p->fault = "the angles are not heading, tilt and roll";
        return 0;
    }
    p->fix.heading_deg = nav_wrap_180(value[0]);
    p->fix.pitch_deg = value[1];
    p->fix.roll_deg = value[2];
    return 0;
}

static void begin_mark(struct kml *k, const char *name)
{
    if (strcmp(name, "Placemark") == 0) {
        k->mark = (struct mark){.point.fix = nav_fix_blank(), .mode = "clampToGround"};
        k->is_in_point = k->is_in_stamp = false;
    } else if (strcmp(name, "Point") == 0) {
        k->is_in_point = true;
    } else if (strcmp(name, "TimeStamp") == 0) {
        k->is_in_stamp = true;
    }
}

static int keep_mark(struct kml *k, long line)
{
    if (!k->mark.has_time || !k->mark.point.has_place) {
        return 0;
    }
    if (k->mark_count == k->mark_capacity) {
        const size_t capacity = k->mark_capacity > 0 ? 2 * k->mark_capacity : 64;
        struct mark *grown =
            capacity <= POINTS_MOST ? realloc(k->marks, capacity * sizeof *grown) : NULL;
        if (!grown) {
            return hs_error(k->reading->name, "cut it into parts", "has too many placemarks");
        }
        k->marks = grown;
        k->mark_capacity = capacity;
    }
    k->mark.point.line = line;
    k->mark.order = k->mark_count;
    k->marks[k->mark_count++] = k->mark;
    return 0;
}

static int end_mark(struct kml *k, const char *name, char *text, long line)
{
    struct mark *m = &k->mark;
    if (strcmp(name, "Placemark") == 0) {
        const int result = keep_mark(k, line);
        m->has_time = m->point.has_place = false;
        return result;
    }
    if (strcmp(name, "Point") == 0) {
        k->is_in_point = false;
    } else if (strcmp(name, "TimeStamp") == 0) {
        k->is_in_stamp = false;
    } else if (k->is_in_stamp && strcmp(name, "when") == 0) {
        m->has_time = true;
        read_time(&m->point, text);
    } else if (k->is_in_point && strcmp(name, "altitudeMode") == 0) {
        snprintf(m->mode, sizeof m->mode, "%s", text);
    } else if (k->is_in_point && strcmp(name, "coordinates") == 0) {
        read_place(&m->point, text, ",");
    }
    return 0;
}

static bool is_shape(struct kml *k, const char *name)
{
    const bool is_line = strcmp(name, "LineString") == 0;
    if (!is_line && strcmp(name, "Track") != 0) {
        return false;
    }
    k->lines += is_line;
    if (!k->shape) {
        k->shape = is_line ? "LineString" : "Track";
    }
    return strcmp(k->shape, name) == 0 && (!is_line || k->lines == 1);
}

static int begin_element(void *user, const char *name, const char **attributes)
{
    struct kml *k = user;
    (void)attributes;
    k->links += strcmp(name, "NetworkLink") == 0;
    if (k->is_in_shape) {
        k->depth++;
    } else if (is_shape(k, name)) {
        k->is_in_shape = true;
        k->depth = 0;
        k->times = k->places = k->attitudes = 0;
        free(k->points);
        k->points = NULL;
        k->capacity = 0;
        strcpy(k->mode, "clampToGround");
    } else {
        begin_mark(k, name);
    }
    return 0;
}

static int take_value(struct kml *k, const char *name, char *text, long line)
{
    if (strcmp(name, "altitudeMode") == 0) {
        snprintf(k->mode, sizeof k->mode, "%s", text);
    } else if (strcmp(k->shape, "LineString") == 0) {
        return strcmp(name, "coordinates") == 0 ? take_line(k, text, line) : 0;
    } else if (strcmp(name, "when") == 0) {
        return take_time(k, text, line);
    } else if (strcmp(name, "coord") == 0) {
        return take_place(k, text, " \t\r\n", line);
    } else if (strcmp(name, "angles") == 0) {
        return take_attitude(k, text, line);
    }
    return 0;
}

/* The altitude of a point, given up where it is above the ground. Zero is what those write who have
 * none. */
static void settle_height(struct kml *k, struct nav_fix *fix)
{
    if (strcmp(k->mode, "absolute") == 0 || k->reading->is_datum_given || isnan(fix->height_m)) {
        return;
    }
    if (fix->height_m < 0 || fix->height_m > 0) {
        if (k->above_ground++ == 0) {
            memcpy(k->ground_mode, k->mode, sizeof k->mode);
        }
    }
    fix->height_m = NAN;
}

static int accept_point(struct kml *k, struct point *p, bool *begins_leg)
{
    const size_t before = k->track->count;
    int result = 0;
    if (p->fault) {
        result = nav_bad_line(k->reading, p->line, "%s", p->fault);
        k->reading->malformed++;
    } else if (!p->has_place) {
        k->reading->missing++;
    } else {
        settle_height(k, &p->fix);
        p->fix.starts_leg = *begins_leg;
        result = nav_accept(k->track, k->reading, &p->fix, p->line);
    }
    *begins_leg = *begins_leg && k->track->count == before;
    return result;
}

static int end_shape(struct kml *k, long line)
{
    bool begins_leg = true;
    k->is_in_shape = false;
    if (!k->reading->is_route && k->times != k->places) {
        char place[512];
        snprintf(place, sizeof place, "%s line %ld", k->reading->name, line);
        return hs_error(place, "export the track again",
                        "a track has %zu times and %zu places, so none can be told", k->times,
                        k->places);
    }
    for (size_t i = 0; i < k->places; i++) {
        if (accept_point(k, &k->points[i], &begins_leg) != 0) {
            return -1;
        }
    }
    return 0;
}

static int end_element(void *user, const char *name, char *text, long line)
{
    struct kml *k = user;
    if (!k->is_in_shape) {
        return end_mark(k, name, text, line);
    }
    if (k->depth == 0) {
        return end_shape(k, line);
    }
    k->depth--;
    return k->depth == 0 ? take_value(k, name, text, line) : 0;
}

static int compare_marks(const void *a, const void *b)
{
    const struct mark *m = a, *n = b;
    const int64_t first = m->point.fix.time_us, second = n->point.fix.time_us;
    return first != second ? (first > second) - (first < second)
                           : (m->order > n->order) - (m->order < n->order);
}

/* Placemarks are a track only where the file has no other: many programs write both. */
static int fly_marks(struct kml *k)
{
    bool begins_leg = true;
    if (k->track->count > 0 || k->mark_count == 0) {
        return 0;
    }
    qsort(k->marks, k->mark_count, sizeof *k->marks, compare_marks);
    for (size_t i = 0; i < k->mark_count; i++) {
        memcpy(k->mode, k->marks[i].mode, sizeof k->mode);
        if (accept_point(k, &k->marks[i].point, &begins_leg) != 0) {
            return -1;
        }
    }
    return 0;
}

static void tell(const struct kml *k)
{
    const struct nav_reading *r = k->reading;
    if (k->links > 0) {
        hs_warn(r->name, "save what they show as one file",
                "%zu links to other files are not followed", k->links);
    }
    if (k->above_ground > 0) {
        hs_warn(r->name, "--datum msl takes them as they are",
                "%zu altitudes are left out: their altitudeMode is %s, above a ground that is not "
                "known here",
                k->above_ground, k->ground_mode);
    }
    const size_t flown = k->shape && strcmp(k->shape, "LineString") == 0;
    if (r->is_route && k->lines > flown) {
        hs_warn(r->name, NULL, "%zu lines are left out: the route is the %s", k->lines - flown,
                flown ? "first" : "track");
    } else if (!r->is_route && k->lines > 0 && k->track->count == 0) {
        hs_warn(r->name, "--speed flies a line as a route", "its lines have no times");
    }
}

int nav_read_kml(const char *text, size_t size, struct nav_track *t, struct nav_reading *r)
{
    static const struct nav_xml_format format = {begin_element, end_element};
    struct kml k = {.track = t, .reading = r, .shape = r->is_route ? NULL : "Track"};
    int result = nav_read_xml(text, size, r->name, &format, &k);
    if (result == 0) {
        result = fly_marks(&k);
    }
    if (result == 0) {
        tell(&k);
    }
    free(k.points);
    free(k.marks);
    return result;
}
