/* What of the plane a transmitter must light, for ends that are not plain. */
#include "hs/error.h"
#include "tracer/ends.h"

#include <math.h>

enum { EDGE_POINTS = 8 /* of a side of the picture */, STEPS = 16, TRIES = 12 };

/* How a place's across and range change along x and y. */
struct slope {
    double across[2], range[2];
};

static void add_slope(const struct end *e, struct vec place, struct slope *to)
{
    const struct end_view view = end_view(e, place);
    struct vec across = e->axes.across;
    if (e->distance_m > 0) {
        const double length_m = e->distance_m + view.way_m;
        const double cosine = vec_dot(view.along, across);
        across = vec_scale(vec_mad(across, view.along, -cosine), e->distance_m / length_m);
    }
    to->across[0] += across.x / 2;
    to->across[1] += across.y / 2;
    to->range[0] += view.along.x / 2;
    to->range[1] += view.along.y / 2;
}

static struct slope slope_at(const struct ends *e, struct vec place)
{
    struct slope s = {{0, 0}, {0, 0}};
    add_slope(&e->out, place, &s);
    add_slope(&e->back, place, &s);
    return s;
}

static double turn_of(const struct slope *s)
{
    return s->across[0] * s->range[1] - s->across[1] * s->range[0];
}

/* Move a place of the ground to where the picture has those coordinates, by Newton's method. */
static bool find_near(const struct ends *e, double across_m, double range_m, struct vec *p)
{
    double off_m = INFINITY;
    for (int i = 0; i < TRIES && off_m > 1e-9; i++) {
        const struct end_view out = end_view(&e->out, *p), back = end_view(&e->back, *p);
        const double a = across_m - (out.across_m + back.across_m) / 2;
        const double r = range_m - (out.way_m + back.way_m) / 2;
        const struct slope s = slope_at(e, *p);
        const double turn = turn_of(&s);
        p->x += (a * s.range[1] - r * s.across[1]) / turn;
        p->y += (r * s.across[0] - a * s.range[0]) / turn;
        off_m = hypot(a, r);
    }
    return off_m < 1e-6; /* false for a NaN */
}

/* Where on the ground that is. On the way there from the centre the picture must not fold, nor
 * become 20 times as coarse. */
static bool find_ground(const struct ends *e, double across_m, double range_m, struct vec *p)
{
    *p = (struct vec){0, 0, 0};
    const struct slope centre = slope_at(e, *p);
    for (int i = 1; i <= STEPS; i++) {
        const double share = (double)i / STEPS;
        if (!find_near(e, across_m * share, range_m * share, p)) {
            return false;
        }
        const struct slope s = slope_at(e, *p);
        if (!(turn_of(&s) / turn_of(&centre) > 0.05)) {
            return false;
        }
    }
    return true;
}

/* Places of the ground along the edge of the picture: 4 EDGE_POINTS. Returns false where there are
 * none. */
static bool find_edge(const struct trace_order *o, const struct ends *e, struct vec *places)
{
    const double half_across_m = o->grid.cells_across * o->grid.cell_m / 2;
    const double half_range_m = o->grid.cells_range * o->grid.cell_m / 2;
    bool is_found = true;
    for (int i = 0; i < EDGE_POINTS; i++) {
        const double share = 2.0 * i / EDGE_POINTS - 1;
        const double corners[4][2] = {{share, -1}, {1, share}, {-share, 1}, {-1, -share}};
        for (int k = 0; k < 4; k++) {
            is_found = is_found && find_ground(e, corners[k][0] * half_across_m,
                                               corners[k][1] * half_range_m, &places[4 * i + k]);
        }
    }
    return is_found;
}

static struct vec corner_of(const struct scene *s, int i)
{
    return (struct vec){i & 1 ? s->high.x : s->low.x, i & 2 ? s->high.y : s->low.y,
                        i & 4 ? s->high.z : s->low.z};
}

/* ---- the part of the plane ---- */

struct window {
    double low_across_m, high_across_m, low_up_m, high_up_m;
    double step_share, step_up_share; /* of a step on the plane at the centre */
};

/* How far in front of an end, over its distance. */
static double depth_share(const struct end *e, struct vec place)
{
    return e->distance_m > 0 ? 1 + vec_dot(place, e->axes.sight) / e->distance_m : 1;
}

static void widen(struct window *w, const struct end *e, struct vec place)
{
    const double share = depth_share(e, place);
    const double across_m = vec_dot(place, e->axes.across) / share;
    const double up_m = vec_dot(place, e->axes.rise) / share;
    w->low_across_m = fmin(w->low_across_m, across_m);
    w->high_across_m = fmax(w->high_across_m, across_m);
    w->low_up_m = fmin(w->low_up_m, up_m);
    w->high_up_m = fmax(w->high_up_m, up_m);
}

/* Rays spread on their way, and meet the ground more slantingly far away. */
static void refine(struct window *w, const struct end *e, struct vec ground)
{
    const double share = depth_share(e, ground), down = -end_view(e, ground).along.z;
    const double slant = down / sqrt(fmax(1 - down * down, 1e-12));
    w->step_share = fmin(w->step_share, 1 / share);
    w->step_up_share = fmin(w->step_up_share, fmin(1, slant) / share);
}

struct trace_sensor ends_sensor_for(const struct scene *s, const struct trace_order *o)
{
    const struct ends e = ends_of(&o->look, &o->ends, o->look.azimuth_deg);
    struct window w = {0, 0, 0, 0, 1, 1};
    struct vec edge[4 * EDGE_POINTS];
    const int places = find_edge(o, &e, edge) ? 4 * EDGE_POINTS : 0;
    for (int i = 0; i < places; i++) {
        widen(&w, &e.out, edge[i]);
        refine(&w, &e.out, edge[i]);
    }
    for (int i = 0; i < 8; i++) {
        widen(&w, &e.out, corner_of(s, i));
    }
    const double step_m = o->grid.cell_m / o->rays_per_cell / 2;
    const double step_across_m = step_m * w.step_share, step_up_m = step_m * w.step_up_share;
    const double columns = ceil((w.high_across_m - w.low_across_m) / step_across_m);
    const double rows = ceil((w.high_up_m - w.low_up_m) / step_up_m);
    return (struct trace_sensor){
        .columns = (uint32_t)fmin(fmax(columns, 1), TRACE_RAYS_MAX),
        .rows = (uint32_t)fmin(fmax(rows, 1), TRACE_RAYS_MAX),
        .step_across_m = step_across_m,
        .step_up_m = step_up_m,
        .low_across_m = w.low_across_m,
        .low_up_m = w.low_up_m,
    };
}

double ends_ground_half_m(const struct trace_order *o)
{
    double half_m = trace_ground_half_m(&o->grid, o->look.depression_deg);
    const struct ends e = ends_of(&o->look, &o->ends, o->look.azimuth_deg);
    struct vec edge[4 * EDGE_POINTS];
    if (!ends_are_plain(&o->ends) && find_edge(o, &e, edge)) {
        for (int i = 0; i < 4 * EDGE_POINTS; i++) {
            half_m = fmax(half_m, hypot(edge[i].x, edge[i].y) + o->grid.cell_m);
        }
    }
    return half_m;
}

/* ---- what is refused ---- */

/* A ray that leaves the model for an end must not meet anything behind it. */
static int check_end(const struct scene *s, const struct end *e, const char *option)
{
    double reach_m = 0;
    for (int i = 0; i < 8; i++) {
        reach_m = fmax(reach_m, vec_length(corner_of(s, i)));
    }
    if (e->distance_m == 0) {
        return 0;
    }
    const double height_m = -e->axes.sight.z * e->distance_m;
    if (e->distance_m <= reach_m) {
        return hs_error(option, "give a longer one",
                        "%g m from the centre is within the model, which reaches %.3g m",
                        e->distance_m, reach_m);
    }
    return height_m > s->high.z
               ? 0
               : hs_error(option, "give a longer one, or a steeper depression",
                          "it stands %.3g m high, and the model %.3g m: give it a place above",
                          height_m, s->high.z);
}

int ends_check(const struct scene *s, const struct trace_order *o)
{
    if (ends_are_plain(&o->ends)) {
        return 0;
    }
    const struct ends e = ends_of(&o->look, &o->ends, o->look.azimuth_deg);
    const double turn_deg = o->ends.receiver_azimuth_deg - o->look.azimuth_deg;
    const double apart_deg = o->ends.is_apart ? fabs(remainder(turn_deg, 360)) : 0;
    if (apart_deg > ENDS_APART_MAX_DEG) {
        return hs_error("--receiver-azimuth", "bring transmitter and receiver closer together",
                        "is %.4g degrees from the transmitter's; beyond %g a step on the ground "
                        "makes one way longer and the other as much shorter",
                        apart_deg, ENDS_APART_MAX_DEG);
    }
    if (check_end(s, &e.out, "--distance") != 0 ||
        check_end(s, &e.back, "--receiver-distance") != 0) {
        return -1;
    }
    struct vec edge[4 * EDGE_POINTS];
    return find_edge(o, &e, edge)
               ? 0
               : hs_error(
                     "--distance", "give a longer one, fewer --cells or a smaller --cell",
                     "nothing on the ground has the place of a corner of a picture %g m wide and "
                     "%g m deep: it reaches nearer than the ground below the radar",
                     o->grid.cells_across * o->grid.cell_m, o->grid.cells_range * o->grid.cell_m);
}
