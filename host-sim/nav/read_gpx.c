/* GPX 1.0 and 1.1: the points of tracks (trkpt), in the order of the file. Each segment begins a
 * leg, because GPX says that a track is broken there. As a route: points of routes (rtept) or of
 * tracks, whichever the file has first. Elevations are above mean sea level; geoidheight, that of
 * the geoid above the ellipsoid. */
#include "hs/error.h"
#include "hs/number.h"
#include "nav/parse.h"
#include "read_formats.h"
#include "read_xml.h"

#include <string.h>

struct gpx {
    struct nav_track *track;
    struct nav_reading *reading;
    struct nav_fix fix;
    const char *point; /* the element that is a point of this reading */
    bool is_in_point, has_time, begins_segment;
    const char *fault; /* what is wrong with the point being read */
    size_t left_out;   /* points of routes */
};

static void begin_point(struct gpx *g, const char **attributes)
{
    g->fix = nav_fix_blank();
    g->fault = NULL;
    g->is_in_point = true;
    g->has_time = false;
    bool has_latitude = false, has_longitude = false;
    for (; attributes[0]; attributes += 2) {
        if (strcmp(attributes[0], "lat") == 0) {
            has_latitude = hs_number(attributes[1], &g->fix.latitude_deg);
        } else if (strcmp(attributes[0], "lon") == 0) {
            has_longitude = hs_number(attributes[1], &g->fix.longitude_deg);
        }
    }
    if (!has_latitude || !has_longitude) {
        g->fault = "the point has no readable latitude and longitude";
    }
}

static bool is_point(struct gpx *g, const char *name)
{
    if (!g->point && (strcmp(name, "trkpt") == 0 || strcmp(name, "rtept") == 0)) {
        g->point = strcmp(name, "trkpt") == 0 ? "trkpt" : "rtept";
    }
    return g->point && strcmp(name, g->point) == 0;
}

static int begin_element(void *user, const char *name, const char **attributes)
{
    struct gpx *g = user;
    if (strcmp(name, "trkseg") == 0) {
        g->begins_segment = true;
    } else if (is_point(g, name)) {
        begin_point(g, attributes);
    } else {
        g->left_out += strcmp(name, "rtept") == 0;
    }
    return 0;
}

static void end_value(struct gpx *g, const char *name, const char *text)
{
    double *value = strcmp(name, "ele") == 0           ? &g->fix.height_m
                    : strcmp(name, "geoidheight") == 0 ? &g->fix.geoid_m
                    : strcmp(name, "speed") == 0       ? &g->fix.speed_ms
                    : strcmp(name, "course") == 0      ? &g->fix.track_deg
                                                       : NULL;
    if (strcmp(name, "time") == 0) {
        g->has_time = nav_parse_time(text, &g->fix.time_us);
        g->fault = g->has_time ? g->fault : "the time cannot be read";
    } else if (value && !hs_number(text, value)) {
        g->fault = "a value of the point is not a number";
    }
}

static int end_point(struct gpx *g, long line)
{
    const size_t before = g->track->count;
    int result;
    g->is_in_point = false;
    if (!g->fault && !g->has_time && !g->reading->is_route) {
        g->fault = "the point has no time (--speed flies it as a route)";
    }
    if (g->fault) {
        result = nav_bad_line(g->reading, line, "%s", g->fault);
        g->reading->malformed++;
    } else {
        g->fix.starts_leg = g->begins_segment;
        result = nav_accept(g->track, g->reading, &g->fix, line);
    }
    if (g->track->count > before) {
        g->begins_segment = false;
    }
    return result;
}

static int end_element(void *user, const char *name, char *text, long line)
{
    struct gpx *g = user;
    if (is_point(g, name)) {
        return end_point(g, line);
    }
    if (g->is_in_point) {
        end_value(g, name, text);
    }
    return 0;
}

int nav_read_gpx(const char *text, size_t size, struct nav_track *t, struct nav_reading *r)
{
    static const struct nav_xml_format format = {begin_element, end_element};
    struct gpx g = {.track = t, .reading = r, .point = r->is_route ? NULL : "trkpt"};
    const int result = nav_read_xml(text, size, r->name, &format, &g);
    if (result == 0 && t->count == 0 && g.left_out > 0) {
        hs_warn(r->name, "--speed flies them", "its %zu points of a route have no times",
                g.left_out);
    }
    return result;
}
