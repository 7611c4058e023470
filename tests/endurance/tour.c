#include "tour.h"

#include "bus_frames.h"

#include <math.h>

enum {
    S = 1000000,
    EIGHTS = 64, /* over a place: some six hours */
    TICKS_A_SECOND = S / TOUR_TICK_US,
    SHIPS = 8,
    DAY_S = 86400,
    FREIGHTER = 12 /* kind of live target: a ship of 200 t */
};

static const double pi = 3.14159265358979323846, m_a_degree = 111132;
static const double circle_m = 2000, circling_m_s = 150, way_m_s = 500;
static const double height_m = 2500;

const struct tour_place tour_places[TOUR_PLACES] = {
    {"0 N, 0 E", 0, 0},
    {"84.99 N, 180 E", 84.99, 180},
    {"46 N, 180 E", 46, 180},
    {"84.99 S, 0 E", -84.99, 0},
};
/* The places along the great circle: degrees from the equator at 0 E, northward. */
static const double along_deg[TOUR_PLACES + 1] = {0, 95.01, 134, 275.01, 360};

static double eight_s(void)
{
    return 2 * 2 * pi * circle_m / circling_m_s;
}

static double way_s(int from)
{
    return (along_deg[from + 1] - along_deg[from]) * m_a_degree / way_m_s;
}

static double lap_s(void)
{
    return TOUR_PLACES * EIGHTS * eight_s() + 360 * m_a_degree / way_m_s;
}

uint64_t tour_lap_us(void)
{
    return (uint64_t)(lap_s() * S);
}

static void put(struct tour_point *p, double deg)
{
    const bool is_back = deg > 90 && deg < 270;
    p->latitude_deg = is_back ? 180 - deg : deg >= 270 ? deg - 360 : deg;
    p->longitude_deg = is_back ? 180 : 0;
    p->track_deg = is_back ? 180 : 0;
}

/* Circles of one radius, to the right and to the left of the meridian in turn. */
static void circle(struct tour_point *p, double t_s)
{
    const double turned = fmod(t_s, eight_s()) * circling_m_s / circle_m;
    const bool is_left = turned >= 2 * pi;
    const double side = is_left ? -1 : 1, angle = fmod(turned, 2 * pi);
    const double ahead_m = circle_m * sin(angle), right_m = side * circle_m * (1 - cos(angle));
    const double north = p->track_deg == 0 ? 1 : -1;
    p->latitude_deg += north * ahead_m / m_a_degree;
    p->longitude_deg += north * right_m / (m_a_degree * cos(p->latitude_deg * pi / 180));
    p->longitude_deg -= p->longitude_deg > 180 ? 360 : 0;
    p->track_deg = fmod(p->track_deg + side * angle * 180 / pi + 360, 360);
    p->turn_deg_s = side * circling_m_s / circle_m * 180 / pi;
    p->speed_m_s = circling_m_s;
    p->distance_km = hypot(ahead_m, right_m) / 1000;
}

struct tour_point tour_at(uint64_t world_us)
{
    const double all_s = (double)world_us / S, laps = floor(all_s / lap_s());
    struct tour_point p = {.lap = (uint64_t)laps, .circling = -1};
    double t_s = all_s - laps * lap_s();
    for (int i = 0; i < TOUR_PLACES; i++) {
        const double circling_s = EIGHTS * eight_s();
        if (t_s < circling_s) {
            put(&p, along_deg[i]);
            p.circling = i;
            circle(&p, t_s);
            return p;
        }
        t_s -= circling_s;
        if (t_s < way_s(i) || i == TOUR_PLACES - 1) {
            const double gone_deg = t_s * way_m_s / m_a_degree;
            const double left_deg = along_deg[i + 1] - along_deg[i] - gone_deg;
            put(&p, along_deg[i] + gone_deg);
            p.speed_m_s = way_m_s;
            p.distance_km = fmin(gone_deg, left_deg) * m_a_degree / 1000;
            return p;
        }
        t_s -= way_s(i);
    }
    return p;
}

/* ---- the bus ---- */

struct writer {
    struct lm_can_frame *frames;
    uint32_t count;
    uint64_t time_us;
};

static void say(struct writer *w, uint32_t id, uint8_t type, uint64_t code, uint32_t word)
{
    w->frames[w->count++] = bus_frame(id, type, (uint8_t)code, word, w->time_us);
}

static void say_float(struct writer *w, uint32_t id, uint64_t code, double value)
{
    say(w, id, LM_CANAS_FLOAT, code, bus_float_bits(value));
}

static void say_double(struct writer *w, uint32_t id, uint64_t tick, double value)
{
    const uint64_t bits = bus_double_bits(value);
    say(w, id, LM_CANAS_DOUBLEH, 2 * tick, (uint32_t)(bits >> 32));
    say(w, id, LM_CANAS_DOUBLEL, 2 * tick + 1, (uint32_t)bits);
}

static void say_navigation(struct writer *w, uint64_t tick, const struct tour_point *p)
{
    say_double(w, 1036, tick, p->latitude_deg);
    say_double(w, 1037, tick, p->longitude_deg);
    say_float(w, 1038, tick, height_m);
    say_float(w, 320, tick, height_m + 300);
    say_float(w, 1133, tick, p->track_deg);
    say_float(w, 321, tick, p->track_deg);
    say_float(w, 1039, tick, p->speed_m_s);
    say_float(w, 1040, tick, p->track_deg);
    say_float(w, 311, tick, 2);
    say_float(w, 312, tick, p->turn_deg_s * 10);
    say_float(w, 303, tick, 0);
    say_float(w, 305, tick, p->turn_deg_s);
}

/* The exercise's time is that of a day: at midnight it begins again. */
static void say_exercise(struct writer *w, uint64_t second)
{
    say(w, 1820, LM_CANAS_LONG, second,
        (uint32_t)((second + DAY_S - TOUR_MIDNIGHT_S) % DAY_S * 1000));
    say_float(w, 1821, second, 1);
}

static void say_rain(struct writer *w, uint64_t second, const struct tour_place *place)
{
    const double values[] = {place->latitude_deg + 0.02, place->longitude_deg, 3000, 20};
    for (uint32_t i = 0; i < 4; i++) {
        say_float(w, 1800 + i, second, values[i]);
    }
}

/* A ship that goes to and fro, 5 km beside the middle of the place. */
static void say_ship(struct writer *w, uint64_t second, uint32_t ship,
                     const struct tour_place *place)
{
    const double angle = ship * 2 * pi / SHIPS;
    const double along_m = 10.0 * fabs((double)(second % 200) - 100);
    const double east_m = 5000 * sin(angle) + along_m, north_m = 5000 * cos(angle);
    const double latitude = place->latitude_deg + north_m / m_a_degree;
    double longitude =
        place->longitude_deg + east_m / (m_a_degree * cos(place->latitude_deg * pi / 180));
    longitude -= longitude > 180 ? 360 : 0;
    const int32_t east_twentieths = second % 200 < 100 ? -200 : 200;
    const uint64_t set = second * SHIPS + ship;
    const uint32_t from = w->count;
    say(w, 1810, LM_CANAS_LONG, set, (uint32_t)(int32_t)lround(latitude * 1e7));
    say(w, 1811, LM_CANAS_LONG, set, (uint32_t)(int32_t)lround(longitude * 1e7));
    say(w, 1815, LM_CANAS_UCHAR4, set, FREIGHTER << 24 | 2u << 16 | 2);
    say(w, 1813, LM_CANAS_SHORT2, set, (uint32_t)east_twentieths << 16);
    for (uint32_t i = from; i < w->count; i++) {
        w->frames[i].data[2] = (uint8_t)ship;
    }
}

/* The place that is nearest on the tour, where the exercise's rain and ships are. */
static const struct tour_place *scene_of(const struct tour_point *p)
{
    const struct tour_place *nearest = tour_places;
    for (int i = 1; i < TOUR_PLACES; i++) {
        if (fabs(tour_places[i].latitude_deg - p->latitude_deg) <
            fabs(nearest->latitude_deg - p->latitude_deg)) {
            nearest = &tour_places[i];
        }
    }
    return nearest;
}

uint32_t tour_frames(uint64_t tick, struct lm_can_frame frames[TOUR_FRAMES])
{
    struct writer w = {.frames = frames, .time_us = tick * TOUR_TICK_US};
    const struct tour_point p = tour_at(w.time_us);
    const uint64_t second = tick / TICKS_A_SECOND, part = tick % TICKS_A_SECOND;
    say_navigation(&w, tick, &p);
    if (part == 0) {
        say_exercise(&w, second);
    } else if (part == 1) {
        say_rain(&w, second, scene_of(&p));
    } else if (part < 2 + SHIPS) {
        say_ship(&w, second, (uint32_t)part - 2, scene_of(&p));
    }
    return w.count;
}
