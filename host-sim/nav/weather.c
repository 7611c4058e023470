#include "nav/weather.h"

#include <math.h>

enum { NODE_INSTRUCTOR = 30 };

bool nav_weather_add(struct nav_weather *w, bool is_jammer, const double *value, int count)
{
    const int amounts = is_jammer ? 1 : 2, must = 2 + amounts;
    int *const known = is_jammer ? &w->jammer_count : &w->rain_count;
    if (*known == NAV_WEATHER_EACH || count < must || count > must + 2) {
        return false;
    }
    const struct nav_weather_item item = {
        .latitude_deg = value[0],
        .longitude_deg = value[1],
        .amount = {value[2], is_jammer ? 0 : value[3]},
        .from_s = count > must ? value[must] : 0,
        .until_s = count > must + 1 ? value[must + 1] : INFINITY,
    };
    const bool is_place = fabs(item.latitude_deg) <= 90 && fabs(item.longitude_deg) <= 180;
    const bool is_told = item.from_s >= 0 && item.until_s > item.from_s;
    const bool is_amount = is_jammer ? item.amount[0] >= -20 && item.amount[0] <= 80
                                     : item.amount[0] >= 100 && item.amount[0] <= 100000 &&
                                           item.amount[1] >= 1 && item.amount[1] <= 150;
    if (!is_place || !is_told || !is_amount) {
        return false;
    }
    (is_jammer ? w->jammer : w->rain)[(*known)++] = item;
    return true;
}

/* Whether a moment `phase_s` into some second falls into the minor frame. */
static bool is_due(double phase_s, double now_s, double period_s)
{
    return ceil(now_s - phase_s) < now_s - phase_s + period_s;
}

/* The set of an item: the identifiers from `id` on. All of them are always sent together, so that
 * their message codes stay the same. */
static int put_set(const struct nav_weather_item *item, struct canas_codes *codes, uint16_t id,
                   int amounts, int number, struct canas_frame *frames)
{
    frames[0] = canas_float(codes, id, NODE_INSTRUCTOR, item->latitude_deg);
    frames[1] = canas_float(codes, id + 1, NODE_INSTRUCTOR, item->longitude_deg);
    for (int i = 0; i < amounts; i++) {
        frames[2 + i] =
            canas_float(codes, (uint16_t)(id + 2 + i), NODE_INSTRUCTOR, item->amount[i]);
    }
    for (int i = 0; i < 2 + amounts; i++) {
        frames[i].data[2] = (uint8_t)number;
    }
    return 2 + amounts;
}

static bool is_told(const struct nav_weather_item *item, double phase_s, double now_s,
                    double period_s)
{
    return now_s >= item->from_s && now_s < item->until_s && is_due(phase_s, now_s, period_s);
}

int nav_weather_frames(const struct nav_weather *w, struct canas_codes *codes, double now_s,
                       double period_s,
                       struct canas_frame frames[2 * NAV_WEATHER_EACH * NAV_WEATHER_FRAMES + 1])
{
    int count = 0;
    for (int i = 0; i < w->rain_count; i++) {
        if (is_told(&w->rain[i], 0.05 + 0.1 * i, now_s, period_s)) {
            count += put_set(&w->rain[i], codes, CANAS_RAIN_LATITUDE, 2, i, frames + count);
        }
    }
    for (int i = 0; i < w->jammer_count; i++) {
        if (is_told(&w->jammer[i], 0.55 + 0.1 * i, now_s, period_s)) {
            count += put_set(&w->jammer[i], codes, CANAS_JAMMER_LATITUDE, 1, i, frames + count);
        }
    }
    if (w->has_clear && w->clear_s >= now_s && w->clear_s < now_s + period_s) {
        frames[count++] = canas_uchar(codes, CANAS_WEATHER_CLEAR, NODE_INSTRUCTOR, 255);
    }
    return count;
}
