#include "nav/route.h"

#include "hs/error.h"

#include <math.h>

static const double degree = 3.14159265358979323846 / 180.0;

/* An aircraft on its way to point `next` of a route. */
struct pilot {
    const struct nav_track *route;
    struct geod_geodesic earth;
    size_t next;
    double speed_ms, turn_deg_s, radius_m;
    double leg_m; /* from the point before `next` to it */
    struct nav_fix now;
};

static double distance(const struct pilot *p, const struct nav_fix *a, const struct nav_fix *b,
                       double *azimuth_deg)
{
    double distance_m;
    geod_inverse(&p->earth, a->latitude_deg, a->longitude_deg, b->latitude_deg, b->longitude_deg,
                 &distance_m, azimuth_deg, NULL);
    return distance_m;
}

/* Aim at the next point that lies elsewhere. False at the end of the route. */
static bool aim(struct pilot *p)
{
    do {
        if (++p->next == p->route->count) {
            return false;
        }
        p->leg_m = distance(p, &p->route->fix[p->next - 1], &p->route->fix[p->next], NULL);
    } while (p->leg_m < 1);
    return true;
}

/* How far before the next point the turn onto the leg behind it begins. */
static double lead_m(const struct pilot *p, double course_deg)
{
    if (p->next + 1 >= p->route->count) {
        return 0;
    }
    double onward_deg;
    distance(p, &p->route->fix[p->next], &p->route->fix[p->next + 1], &onward_deg);
    const double turn_deg = fmin(150, fabs(nav_wrap_180(onward_deg - course_deg)));
    return fmin(p->radius_m * tan(turn_deg / 2 * degree), p->leg_m / 2);
}

static double height_on_leg(const struct pilot *p, double left_m)
{
    const struct nav_fix *a = &p->route->fix[p->next - 1], *b = a + 1;
    const double done = fmin(1, fmax(0, 1 - left_m / p->leg_m));
    return a->height_m + (b->height_m - a->height_m) * done;
}

/* Fly for a second. False at the end of the route. */
static bool fly_on(struct pilot *p)
{
    double course_deg;
    double left_m = distance(p, &p->now, &p->route->fix[p->next], &course_deg);
    while (left_m <= fmax(lead_m(p, course_deg), p->speed_ms)) {
        if (!aim(p)) {
            return false;
        }
        left_m = distance(p, &p->now, &p->route->fix[p->next], &course_deg);
    }
    const double error_deg = nav_wrap_180(course_deg - p->now.track_deg);
    p->now.track_deg += fmax(-p->turn_deg_s, fmin(p->turn_deg_s, error_deg));
    /* A point within the turning circle would be flown round for ever. */
    if (fabs(error_deg) > 90 && left_m < 2 * p->radius_m && !aim(p)) {
        return false;
    }
    geod_direct(&p->earth, p->now.latitude_deg, p->now.longitude_deg, p->now.track_deg, p->speed_ms,
                &p->now.latitude_deg, &p->now.longitude_deg, NULL);
    p->now.height_m = height_on_leg(p, left_m - p->speed_ms);
    p->now.time_us += 1000000;
    return true;
}

int nav_fly_route(const struct nav_track *route, double speed_ms, int64_t begin_us,
                  struct nav_track *flight)
{
    struct pilot p = {.route = route, .speed_ms = speed_ms};
    geod_init(&p.earth, 6378137.0, 1 / 298.257223563);
    const double gravity = 9.80665, bank = tan(NAV_ROUTE_BANK_DEG * degree);
    p.turn_deg_s = gravity * bank / speed_ms / degree;
    p.radius_m = speed_ms * speed_ms / (gravity * bank);
    if (route->count < 2 || !aim(&p)) {
        return hs_error("route", "give it another point", "has fewer than two different points");
    }
    p.now = nav_fix_blank();
    p.now.latitude_deg = route->fix[0].latitude_deg;
    p.now.longitude_deg = route->fix[0].longitude_deg;
    p.now.height_m = route->fix[0].height_m;
    p.now.time_us = begin_us;
    p.now.speed_ms = speed_ms;
    distance(&p, &p.now, &route->fix[p.next], &p.now.track_deg);
    flight->datum = route->datum;
    do {
        if (nav_track_add(flight, &p.now) != 0) {
            return -1;
        }
        if ((double)flight->count > NAV_ROUTE_MOST_S) {
            return hs_error("route", "fly it faster, or in parts", "takes longer than %.0f s",
                            NAV_ROUTE_MOST_S);
        }
    } while (fly_on(&p));
    return 0;
}
