/* Weather on the bus: frames of rain cells and jammers as docs/bus.md, "Weather", defines them. */
#ifndef NAV_WEATHER_H
#define NAV_WEATHER_H

#include "nav/canas.h"

#include <stdbool.h>

enum { NAV_WEATHER_EACH = 4, NAV_WEATHER_FRAMES = 4 };

/* A circle of rain or a jammer, told once a second from `from_s` until before `until_s`, seconds
 * from the log's beginning. */
struct nav_weather_item {
    double latitude_deg, longitude_deg;
    double amount[2]; /* radius in metres and mm/h; or the ratio in dB */
    double from_s, until_s;
};

struct nav_weather {
    struct nav_weather_item rain[NAV_WEATHER_EACH], jammer[NAV_WEATHER_EACH];
    int rain_count, jammer_count;
    bool has_clear;
    double clear_s; /* when everything is taken away in one frame */
};

/* Take the numbers of --rain LAT,LON,RADIUS_M,MM_H[,FROM_S[,UNTIL_S]] or of
 * --jammer LAT,LON,DB[,FROM_S[,UNTIL_S]]. False, with *w unchanged, when they are out of range or
 * there are four already. */
bool nav_weather_add(struct nav_weather *w, bool is_jammer, const double *value, int count);

/* The frames to send in the minor frame that begins `now_s` after the log's beginning and lasts
 * `period_s`; returns how many. Each item has its own tenth of a second; at a period of a tenth or
 * less no two share a minor frame. */
int nav_weather_frames(const struct nav_weather *w, struct canas_codes *codes, double now_s,
                       double period_s,
                       struct canas_frame frames[2 * NAV_WEATHER_EACH * NAV_WEATHER_FRAMES + 1]);

#endif
