/* GPX 1.0 and 1.1: the points of tracks (trkpt), in the order of the file. Each segment begins a
 * leg, because GPX says that a track is broken there. As a route: points of routes (rtept) or of
 * tracks, whichever the file has first. Elevations are above mean sea level; geoidheight, that of
 * the geoid above the ellipsoid. */
#include "read_formats.h"

#include "hs/error.h"
#include "nav/parse.h"

#include <expat.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_MAX = 64 };

struct gpx {
    XML_Parser parser;
    struct nav_track *track;
    struct nav_reading *reading;
    struct nav_fix fix;
    const char *point; /* the element that is a point of this reading */
    bool is_in_point, has_time, begins_segment;
    const char *fault;       /* what is wrong with the point being read */
    char text[TEXT_MAX + 1]; /* of the innermost element */
    size_t text_length;
    bool has_stopped; /* an error has been reported */
};

static void stop(struct gpx *g)
{
    g->has_stopped = true;
    XML_StopParser(g->parser, XML_FALSE);
}

static const char *local_name(const char *name)
{
    const char *colon = strrchr(name, ':');
    return colon ? colon + 1 : name;
}

static void begin_point(struct gpx *g, const char **attributes)
{
    g->fix = nav_fix_blank();
    g->fault = NULL;
    g->is_in_point = true;
    g->has_time = false;
    bool has_latitude = false, has_longitude = false;
    for (; attributes[0]; attributes += 2) {
        if (strcmp(attributes[0], "lat") == 0) {
            has_latitude = nav_parse_number(attributes[1], &g->fix.latitude_deg);
        } else if (strcmp(attributes[0], "lon") == 0) {
            has_longitude = nav_parse_number(attributes[1], &g->fix.longitude_deg);
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

static void XMLCALL begin_element(void *user, const char *name, const char **attributes)
{
    struct gpx *g = user;
    g->text_length = 0;
    name = local_name(name);
    if (strcmp(name, "trkseg") == 0) {
        g->begins_segment = true;
    } else if (is_point(g, name)) {
        begin_point(g, attributes);
    }
}

static void end_value(struct gpx *g, const char *name)
{
    double *value = strcmp(name, "ele") == 0           ? &g->fix.height_m
                    : strcmp(name, "geoidheight") == 0 ? &g->fix.geoid_m
                    : strcmp(name, "speed") == 0       ? &g->fix.speed_ms
                    : strcmp(name, "course") == 0      ? &g->fix.track_deg
                                                       : NULL;
    if (strcmp(name, "time") == 0) {
        g->has_time = nav_parse_time(g->text, &g->fix.time_us);
        g->fault = g->has_time ? g->fault : "the time cannot be read";
    } else if (value && !nav_parse_number(g->text, value)) {
        g->fault = "a value of the point is not a number";
    }
}

static void end_point(struct gpx *g)
{
    const XML_Size line = XML_GetCurrentLineNumber(g->parser);
    const size_t before = g->track->count;
    int failed;
    g->is_in_point = false;
    if (!g->fault && !g->has_time && !g->reading->is_route) {
        g->fault = "the point has no time (--speed flies it as a route)";
    }
    if (g->fault) {
        failed = nav_bad_line(g->reading, (long)line, "%s", g->fault);
        g->reading->malformed++;
    } else {
        g->fix.starts_leg = g->begins_segment;
        failed = nav_accept(g->track, g->reading, &g->fix, (long)line);
    }
    if (g->track->count > before) {
        g->begins_segment = false;
    }
    if (failed) {
        stop(g);
    }
}

static void XMLCALL end_element(void *user, const char *name)
{
    struct gpx *g = user;
    name = local_name(name);
    g->text[g->text_length] = '\0';
    if (is_point(g, name)) {
        end_point(g);
    } else if (g->is_in_point) {
        end_value(g, name);
    }
    g->text_length = 0;
}

/* Text longer than any number or time is cut; it then fails to parse. */
static void XMLCALL add_text(void *user, const char *text, int length)
{
    struct gpx *g = user;
    for (int i = 0; i < length && g->text_length < TEXT_MAX; i++) {
        if (g->text_length > 0 || !strchr(" \t\r\n", text[i])) {
            g->text[g->text_length++] = text[i];
        }
    }
}

/* A track has no use for a document type, and entities are how XML is made to eat memory. */
static void XMLCALL refuse_document_type(void *user, const char *name, const char *system,
                                         const char *public, int has_internal)
{
    (void)name, (void)system, (void)public, (void)has_internal;
    struct gpx *g = user;
    hs_error(g->reading->name, "remove the <!DOCTYPE> line",
             "declares a document type, which GPX does not have");
    stop(g);
}

int nav_read_gpx(const char *text, size_t size, struct nav_track *t, struct nav_reading *r)
{
    struct gpx g = {.parser = XML_ParserCreate(NULL),
                    .track = t,
                    .reading = r,
                    .point = r->is_route ? NULL : "trkpt"};
    if (!g.parser || size > INT_MAX) {
        XML_ParserFree(g.parser);
        return hs_error(r->name, "cut it into parts", "is too large");
    }
    XML_SetUserData(g.parser, &g);
    XML_SetElementHandler(g.parser, begin_element, end_element);
    XML_SetCharacterDataHandler(g.parser, add_text);
    XML_SetStartDoctypeDeclHandler(g.parser, refuse_document_type);
    int result = 0;
    if (XML_Parse(g.parser, text, (int)size, XML_TRUE) != XML_STATUS_OK) {
        result = -1;
        if (!g.has_stopped) {
            hs_error(r->name, "export the track again", "is not well-formed XML at line %lu: %s",
                     (unsigned long)XML_GetCurrentLineNumber(g.parser),
                     XML_ErrorString(XML_GetErrorCode(g.parser)));
        }
    }
    XML_ParserFree(g.parser);
    return result;
}
