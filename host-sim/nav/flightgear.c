/* FlightGear's generic protocol as host-sim/nav/share/landmass.xml describes it: a line of text. */
#include "hs/number.h"
#include "nav/parse.h"
#include "nav/simulator.h"

#include <math.h>
#include <string.h>

static const char mark[] = "landmass1 ";

/* The values in the order of the file's chunks; the fifth, the time, is text. */
enum {
    CLOCK,
    PAUSED,
    ELAPSED,
    DELTA,
    LATITUDE,
    LONGITUDE,
    HEIGHT,
    ROLL,
    PITCH,
    HEADING,
    MAGNETIC,
    NORTH,
    EAST,
    DOWN,
    ROLL_RATE,
    PITCH_RATE,
    YAW_RATE,
    VALUES,
    TIME = 4
};

/* Cut the text up to the next comma, or to the end, off *text. */
static char *cut(char **text)
{
    char *word = *text, *comma = word ? strchr(word, ',') : NULL;
    *text = comma ? comma + 1 : NULL;
    if (comma) {
        *comma = '\0';
    }
    return word;
}

static bool read_values(char *text, double value[VALUES], int64_t *utc_us)
{
    for (int i = 0; i < VALUES; i++) {
        char *word;
        if (i == TIME) {
            word = cut(&text);
            if (!word || !nav_parse_time(word, utc_us)) {
                *utc_us = -1; /* before its clock is set the simulator writes another word here */
            }
        }
        word = cut(&text);
        if (!word || !hs_number(word, &value[i])) {
            return false;
        }
    }
    return text == NULL;
}

static enum nav_told_fault fill(const double value[VALUES], struct nav_told *t)
{
    if (!(fabs(value[CLOCK]) <= 1e9) || (value[PAUSED] != 0 && value[PAUSED] != 1)) {
        return NAV_TOLD_RANGE;
    }
    t->order = value[CLOCK] > 0 ? (int64_t)(value[CLOCK] * 1e4) : -1;
    t->paused = value[PAUSED] != 0;
    t->elapsed_s = fmax(0, value[ELAPSED] - fmax(0, fmin(value[DELTA], 1)));
    t->latitude_deg = value[LATITUDE];
    t->longitude_deg = value[LONGITUDE];
    t->height_m = value[HEIGHT];
    t->roll_deg = value[ROLL];
    t->pitch_deg = value[PITCH];
    t->heading_deg = value[HEADING];
    t->magnetic_deg = value[MAGNETIC];
    t->north_ms = value[NORTH];
    t->east_ms = value[EAST];
    t->up_ms = -value[DOWN];
    t->roll_rate = value[ROLL_RATE];
    t->pitch_rate = value[PITCH_RATE];
    t->yaw_rate = value[YAW_RATE];
    return nav_told_judge(t);
}

enum nav_told_fault nav_flightgear_read(const uint8_t *bytes, size_t length, struct nav_told *t)
{
    char text[NAV_TOLD_BYTES];
    double value[VALUES];
    nav_told_blank(t);
    if (length < sizeof mark - 1 || memcmp(bytes, mark, sizeof mark - 1) != 0) {
        return NAV_TOLD_FOREIGN;
    }
    if (length >= sizeof text || bytes[length - 1] != '\n' || memchr(bytes, '\0', length)) {
        return NAV_TOLD_MALFORMED;
    }
    memcpy(text, bytes, length - 1);
    text[length - 1] = '\0';
    return read_values(text + sizeof mark - 1, value, &t->utc_us) ? fill(value, t)
                                                                  : NAV_TOLD_MALFORMED;
}
