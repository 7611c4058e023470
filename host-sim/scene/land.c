#include "scene/land.h"

#include "erosion.h"
#include "noise.h"

#include "hs/error.h"
#include "hs/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Each use of noise has its own stream of it. */
enum {
    NOISE_COAST = 100,
    NOISE_COAST_FINE = 110,
    NOISE_ISLAND = 120,
    NOISE_LAKE = 130,
    NOISE_RIVER = 140,
    NOISE_UPLIFT = 150,
    NOISE_START = 160,
    NOISE_DETAIL = 170,
    NOISE_WOOD = 190,
    NOISE_WOOD_FINE = 200,
    NOISE_ROCK = 210
};

enum { EROSION_SPACING_M = 50, EROSION_NODES_MAX = 700 };

static uint64_t stream(const struct land *l, uint64_t use)
{
    return noise_hash(l->seed, (int64_t)use, 0);
}

struct point land_town(void)
{
    return (struct point){-250, 250};
}

struct point land_lake(void)
{
    return (struct point){4300, -2500};
}

struct point land_port(void)
{
    return (struct point){-1450, 200};
}

struct frame land_airfield(void)
{
    return frame_at((struct point){900, -4050}, 22);
}

struct point land_to_design(double east_m, double north_m)
{
    return (struct point){LAND_TURN_COS * east_m + LAND_TURN_SIN * north_m,
                          LAND_TURN_COS * north_m - LAND_TURN_SIN * east_m};
}

void land_from_design(struct point p, double *east_m, double *north_m)
{
    *east_m = LAND_TURN_COS * p.u - LAND_TURN_SIN * p.v;
    *north_m = LAND_TURN_SIN * p.u + LAND_TURN_COS * p.v;
}

double land_river_level(double along_m)
{
    const double above_plain_m = fmax(0, along_m - 6500);
    return 0.0007 * along_m + 1.3e-6 * above_plain_m * above_plain_m;
}

double land_river_width(double along_m)
{
    return 20 + 45 * exp(-along_m / 6000) + 100 * exp(-along_m / 300);
}

/* The coast runs along v with a bay in the middle; at the head of the bay it is kept straight for
 * the quays. An island lies outside. */
static double shore_at(const struct land *l, struct point p)
{
    const double from_port = (p.v - land_port().v) / 1000;
    const double calm = noise_step(0.8, 1.9, fabs(from_port));
    const double wander =
        760 * noise_fractal(stream(l, NOISE_COAST), p.u / 1900, p.v / 1900, 3) +
        calm * 260 * noise_fractal(stream(l, NOISE_COAST_FINE), p.u / 420, p.v / 420, 4);
    const double bay = 2250 * exp(-pow(from_port / 1.6, 4));
    const double main_land = p.u + 3750 - bay + (0.12 + 0.88 * calm) * wander - 50 * (1 - calm);
    const struct point island = {-5150, 2350};
    const double ring = 430 + 300 * noise_fractal(stream(l, NOISE_ISLAND), p.u / 600, p.v / 600, 4);
    return fmax(main_land, ring - point_distance(p, island));
}

static struct point lake_island_place(void)
{
    return (struct point){land_lake().u - 190, land_lake().v + 150};
}

/* However the shore wanders, it keeps away from the island. */
static double lake_ring(const struct land *l, struct point p)
{
    const double wander = noise_fractal(stream(l, NOISE_LAKE), p.u / 900, p.v / 900, 4);
    const struct point c = land_lake();
    const double shore = 760 + 620 * wander - hypot((p.u - c.u) * 1.15, p.v - c.v);
    return fmax(shore, 480 + 200 * wander - point_distance(p, lake_island_place()));
}

static double lake_island(const struct land *l, struct point p)
{
    const double wander = noise_fractal(stream(l, NOISE_ISLAND), p.u / 260, p.v / 260, 3);
    return 150 + 110 * wander - point_distance(p, lake_island_place());
}

static double lake_at(const struct land *l, struct point p)
{
    return fmin(lake_ring(l, p), -lake_island(l, p));
}

/* How steep the country is (erosion.h, steepness): hills inland and to the north, others beyond the
 * lake, and level ground where town and airfield stand. */
static double steepness_at(const struct land *l, struct point p)
{
    const double x = p.u / 1000, y = p.v / 1000;
    const double wander = noise_fractal(stream(l, NOISE_UPLIFT), x / 2.6, y / 2.6, 3);
    const double north = noise_step(1.7, 4.6, 0.9 * y + 0.42 * x + 1.1 * wander);
    const double south_east = noise_step(5.0, 8.0, 0.8 * x - 0.75 * y + 1.2 * wander);
    const double rolling = 3.6 + 6.5 * noise_step(0.5, 4.5, x) * (0.5 + 0.5 * wander);
    /* Harder and softer rock keeps the ridges from standing like a comb. */
    const double rock = 1 + 0.75 * noise_fractal(stream(l, NOISE_ROCK), x / 1.1, y / 1.1, 4);
    const struct frame airfield = land_airfield();
    const double level = noise_step(900, 2100, point_distance(p, land_town())) *
                         noise_step(1000, 2200, point_distance(p, airfield.origin));
    return rolling * (0.3 + 0.7 * level) + level * rock * (64 * north + 45 * south_east);
}

static void make_river(struct land *l)
{
    static const struct point control[] = {
        {-4300, -2450}, {-3300, -2350}, {-2000, -2150}, {-700, -1950}, {500, -1450}, {1500, -600},
        {2500, 500},    {3350, 1750},   {4500, 2950},   {6000, 4250},  {8000, 6000}, {11000, 8500}};
    const int controls = (int)(sizeof control / sizeof *control);
    struct point smooth[LAND_RIVER_MAX];
    const int n = line_smooth(control, controls, 44, smooth);
    double along = 0;
    bool is_inland = false;
    l->river_count = 0;
    for (int i = 0; i < n; i++) {
        const struct point before = smooth[i > 0 ? i - 1 : i],
                           after = smooth[i + 1 < n ? i + 1 : i];
        const double step = point_distance(before, after);
        const double x = i * 28.0;
        const double swing = 130 * noise_value(stream(l, NOISE_RIVER), x / 420, 0) +
                             60 * noise_value(stream(l, NOISE_RIVER), x / 170, 7);
        const struct point p = {smooth[i].u - swing * (after.v - before.v) / step,
                                smooth[i].v + swing * (after.u - before.u) / step};
        /* The mouth is where the line first meets land. */
        is_inland = is_inland || shore_at(l, p) > 0;
        if (!is_inland) {
            continue;
        }
        along += l->river_count > 0 ? point_distance(l->river[l->river_count - 1], p) : 0;
        l->river_m[l->river_count] = along;
        l->river[l->river_count++] = p;
    }
}

/* The nodes of the erosion lie in the axes of the design and reach beyond the image's corners. */
static struct point node_place(const struct erosion *e, int32_t i)
{
    const double middle = 0.5 * (e->width - 1);
    return (struct point){(i % e->width - middle) * e->spacing_m,
                          (i / e->width - middle) * e->spacing_m};
}

static int32_t node_at(const struct erosion *e, struct point p)
{
    const double middle = 0.5 * (e->width - 1);
    const long x = lround(p.u / e->spacing_m + middle), y = lround(p.v / e->spacing_m + middle);
    return x < 0 || y < 0 || x >= e->width || y >= e->height ? -1 : (int32_t)(y * e->width + x);
}

/* Hold a closed chain of nodes at the river's level, so that the hills drain into it. */
static void lay_river(const struct land *l, struct erosion *e)
{
    for (int i = 0; i + 1 < l->river_count; i++) {
        for (int k = 0; k < 8; k++) {
            const int32_t node = node_at(e, point_between(l->river[i], l->river[i + 1], k / 8.0));
            if (node >= 0 && (!e->is_base[node] || e->z_m[node] > 0)) {
                e->is_base[node] = 1;
                e->z_m[node] = land_river_level(l->river_m[i]);
            }
        }
    }
}

/* The lake fills to the lowest place of its shore. */
static void fill_lake(struct land *l, struct erosion *e)
{
    const int32_t n = e->width * e->height;
    double level = INFINITY;
    for (int32_t i = 0; i < n; i++) {
        const double ring = lake_ring(l, node_place(e, i));
        if (ring > 0 && ring < 150) {
            level = fmin(level, e->z_m[i]);
        }
    }
    l->lake_level_m = floor(fmax(4, level) * 2) / 2;
    for (int32_t i = 0; i < n; i++) {
        if (lake_ring(l, node_place(e, i)) > 0) {
            e->is_base[i] = 1;
            e->z_m[i] = l->lake_level_m;
        }
    }
}

static void raise_hills(struct land *l, struct erosion *e)
{
    const int32_t n = e->width * e->height;
    for (int32_t i = 0; i < n; i++) {
        const struct point p = node_place(e, i);
        const double shore = shore_at(l, p);
        e->is_base[i] = shore <= 0;
        e->steepness[i] = steepness_at(l, p);
        const double rough = noise_fractal(stream(l, NOISE_START), p.u / 800, p.v / 800, 5);
        e->z_m[i] = shore <= 0 ? 0
                               : 1 + 0.002 * shore + e->steepness[i] * (2.5 + 2.2 * rough) +
                                     2 * noise_at(stream(l, NOISE_START), i, 0);
    }
    lay_river(l, e);
    erosion_run(e, 90, 0.25, 0.95);
    fill_lake(l, e);
    erosion_run(e, 30, 0.25, 0.95);
}

/* Follow the water from `node` down to a base or to a stream already known. */
static void trace_stream(struct land *l, const struct erosion *e, int32_t node, uint8_t *is_known)
{
    struct land_stream *s = &l->stream[l->stream_count];
    double area = 0;
    s->count = 0;
    for (bool ends = false; !ends && s->count < LAND_STREAM_POINTS;) {
        s->p[s->count++] = node_place(e, node);
        area = fmax(area, e->is_base[node] ? 0 : e->area_m2[node]);
        ends = is_known[node] || e->receiver[node] == node;
        is_known[node] = 1;
        node = e->receiver[node];
    }
    /* The grid's eight directions show; averaging neighbours a few times hides them. */
    for (int pass = 0; pass < 6; pass++) {
        for (int i = 1; i + 1 < s->count; i++) {
            s->p[i] = point_between(s->p[i], point_between(s->p[i - 1], s->p[i + 1], 0.5), 0.5);
        }
    }
    s->width_m = 3 + 2.2 * sqrt(area * 1e-6);
    l->stream_count += s->count > 8;
}

/* Streams begin where 1.3 km2 drain through a node and through none of its donors. */
static int find_streams(struct land *l, const struct erosion *e)
{
    const double least_m2 = 1.3e6;
    const int32_t n = e->width * e->height;
    uint8_t *is_fed = calloc((size_t)n, 1), *is_known = calloc((size_t)n, 1);
    l->stream = calloc(LAND_STREAM_MAX, sizeof *l->stream);
    if (!is_fed || !is_known || !l->stream) {
        free(is_fed);
        free(is_known);
        return hs_error("terrain", "make the scene smaller", "out of memory");
    }
    for (int32_t i = 0; i < n; i++) {
        if (e->area_m2[i] > least_m2 && e->receiver[i] != i) {
            is_fed[e->receiver[i]] = 1;
        }
    }
    /* Down from the top, so that the longest arms come first. */
    for (int32_t k = n - 1; k >= 0 && l->stream_count < LAND_STREAM_MAX; k--) {
        const int32_t i = e->order[k];
        if (e->area_m2[i] > least_m2 && !is_fed[i] && !e->is_base[i]) {
            trace_stream(l, e, i, is_known);
        }
    }
    free(is_fed);
    free(is_known);
    return 0;
}

/* Uniform cubic B-spline through the grid: smooth slopes, and it never overshoots. */
static double smooth_height(const struct erosion *e, struct point p)
{
    const double middle = 0.5 * (e->width - 1);
    const double x = fmin(fmax(p.u / e->spacing_m + middle, 1), e->width - 3);
    const double y = fmin(fmax(p.v / e->spacing_m + middle, 1), e->height - 3);
    const int ix = (int)x, iy = (int)y;
    double wx[4], wy[4], sum = 0;
    for (int axis = 0; axis < 2; axis++) {
        double *w = axis == 0 ? wx : wy;
        const double t = axis == 0 ? x - ix : y - iy;
        w[0] = (1 - t) * (1 - t) * (1 - t) / 6;
        w[1] = (3 * t * t * t - 6 * t * t + 4) / 6;
        w[2] = (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6;
        w[3] = t * t * t / 6;
    }
    for (int k = 0; k < 16; k++) {
        sum += wx[k % 4] * wy[k / 4] * e->z_m[(iy + k / 4 - 1) * e->width + ix + k % 4 - 1];
    }
    return sum;
}

/* The distance from the river's line and along it; cheap far away, where only "far" matters. */
static double river_distance(const struct land *l, struct point p, double *along)
{
    enum { BLOCK = 32 };
    const double far_m = 800;
    double best = far_m;
    for (int i = 0; i + 1 < l->river_count; i += BLOCK) {
        const int count = i + BLOCK + 1 < l->river_count ? BLOCK + 1 : l->river_count - i;
        const double reach = l->river_m[i + count - 1] - l->river_m[i];
        if (point_distance(l->river[i], p) > reach + best) {
            continue;
        }
        double here;
        const double d = line_distance(l->river + i, count, p, &here);
        if (d < best) {
            best = d;
            *along = l->river_m[i] + here;
        }
    }
    return best;
}

/* Lower the valley's floor to the river and raise what would lie below it. */
static double at_river(const struct land *l, struct point p, double height)
{
    double along = 0;
    const double d = river_distance(l, p, &along);
    const double floor_m = fmax(0.5 * land_river_width(along), 1.5 * LAND_SPACING_M);
    const double level = land_river_level(along);
    const double rise = fmax(height - level, 1.5) * noise_step(floor_m, floor_m + 160, d);
    const double near = 1 - noise_step(350, 700, d);
    return near * (level + rise) + (1 - near) * height;
}

static double at_lake(const struct land *l, struct point p, double height)
{
    const double ring = lake_ring(l, p);
    if (ring > 0) {
        const double island = lake_island(l, p);
        return l->lake_level_m + (island > 0 ? 0.5 + 16 * noise_step(0, 150, island) : 0);
    }
    const double near = 1 - noise_step(60, 400, -ring);
    const double bank = l->lake_level_m + 0.4 + 0.012 * -ring;
    return near * fmax(height, bank) + (1 - near) * height;
}

/* How much of `p` belongs to a levelled rectangle: 1 inside, falling to 0 within `margin_m`. */
static double levelled(const struct frame *f, struct point p, double half_x, double half_y,
                       double margin_m)
{
    const double du = p.u - f->origin.u, dv = p.v - f->origin.v;
    const double x = fabs(f->cos * du + f->sin * dv) - half_x;
    const double y = fabs(f->cos * dv - f->sin * du) - half_y;
    return 1 - noise_step(0, margin_m, hypot(fmax(x, 0), fmax(y, 0)));
}

static double height_at(const struct land *l, const struct erosion *e, struct point p, double shore)
{
    if (shore <= 0) {
        return 0;
    }
    const double steep = fmin(1, steepness_at(l, p) / 40);
    const double detail = noise_fractal(stream(l, NOISE_DETAIL), p.u / 240, p.v / 240, 4);
    double h = smooth_height(e, p) + (0.6 + 16 * steep) * detail;
    h = fmax(h, fmin(2.5, 0.5 + 0.02 * shore));
    h = at_lake(l, p, h);
    const struct frame airfield = land_airfield();
    const double flat = levelled(&airfield, p, 1500, 330, 350);
    h += flat * (l->airfield_level_m - h);
    const struct frame port = frame_at(land_port(), 0);
    const double quay = levelled(&port, p, 330, 820, 200);
    h += quay * (LAND_PORT_M - h);
    return at_river(l, p, h);
}

/* Woodland: on the hills, in the valleys' sides, and in patches of the plain. */
static double wood_at(const struct land *l, struct point p, double height)
{
    const double patches = noise_fractal(stream(l, NOISE_WOOD), p.u / 1300, p.v / 1300, 4);
    const double edges = noise_fractal(stream(l, NOISE_WOOD_FINE), p.u / 170, p.v / 170, 3);
    const double hills = fmin(1, steepness_at(l, p) / 28);
    const double summit = noise_step(330, 560, height);
    return patches + 0.22 * edges - 0.36 + 0.52 * hills - 0.75 * summit;
}

static void fill_grid(struct land *l, const struct erosion *e)
{
    const struct frame airfield = land_airfield();
    l->airfield_level_m = fmax(6, smooth_height(e, airfield.origin));
    struct hs_progress progress;
    hs_progress_begin(&progress, "laying the land", (uint64_t)l->posts);
    for (int y = 0; y < l->posts; y++) {
        hs_progress_update(&progress, (uint64_t)y);
        for (int x = 0; x < l->posts; x++) {
            const size_t i = (size_t)y * (size_t)l->posts + (size_t)x;
            const struct point p =
                land_to_design(x * l->spacing_m - l->edge_m, l->edge_m - y * l->spacing_m);
            const double shore = shore_at(l, p);
            const double height = height_at(l, e, p, shore);
            l->shore_m[i] = (float)shore;
            l->height_m[i] = (float)height;
            l->lake_m[i] = (float)lake_at(l, p);
            l->wood[i] = (float)wood_at(l, p, height);
        }
    }
    hs_progress_end(&progress);
}

/* Slope, and the sun's light on it, from the heights of the neighbours. */
static void light_grid(struct land *l)
{
    const int last = l->posts - 1;
    for (int y = 0; y <= last; y++) {
        for (int x = 0; x <= last; x++) {
            const size_t row = (size_t)y * (size_t)l->posts;
            const size_t i = row + (size_t)x;
            const size_t west = row + (size_t)(x > 0 ? x - 1 : x);
            const size_t east = row + (size_t)(x < last ? x + 1 : x);
            const size_t north = y > 0 ? i - (size_t)l->posts : i;
            const size_t south = y < last ? i + (size_t)l->posts : i;
            const double run = 2 * l->spacing_m;
            const double to_east = (double)(l->height_m[east] - l->height_m[west]) / run;
            const double to_north = (double)(l->height_m[north] - l->height_m[south]) / run;
            const double facing = LAND_SUN_UP - LAND_SUN_EAST * to_east - LAND_SUN_NORTH * to_north;
            const double squared = to_east * to_east + to_north * to_north;
            l->slope[i] = (float)sqrt(squared);
            l->light[i] = (float)(fmax(0, facing) / sqrt(1 + squared) / LAND_SUN_UP);
        }
    }
}

static int allocate_grid(struct land *l, double extent_m)
{
    /* Posts reach past the image on every side, so that none of its pixels lies off the terrain. */
    const int intervals = 2 * (int)ceil(0.5 * extent_m / LAND_SPACING_M + 4);
    l->spacing_m = LAND_SPACING_M;
    l->posts = intervals + 1;
    l->edge_m = 0.5 * intervals * l->spacing_m;
    const size_t n = (size_t)l->posts * (size_t)l->posts;
    l->height_m = malloc(n * sizeof(float));
    l->shore_m = malloc(n * sizeof(float));
    l->lake_m = malloc(n * sizeof(float));
    l->wood = malloc(n * sizeof(float));
    l->slope = malloc(n * sizeof(float));
    l->light = malloc(n * sizeof(float));
    if (!l->height_m || !l->shore_m || !l->lake_m || !l->wood || !l->slope || !l->light) {
        return hs_error("terrain", "make the scene smaller", "out of memory");
    }
    return 0;
}

int land_make(struct land *l, uint64_t seed, double extent_m)
{
    *l = (struct land){.seed = seed};
    const double across_m = 1.45 * fmax(extent_m, LAND_DESIGN_M);
    const double spacing_m = fmax(EROSION_SPACING_M, across_m / EROSION_NODES_MAX);
    const int nodes = (int)ceil(across_m / spacing_m);
    struct erosion e;
    if (allocate_grid(l, extent_m) != 0 || erosion_init(&e, nodes, nodes, spacing_m) != 0) {
        land_free(l);
        return -1;
    }
    make_river(l);
    raise_hills(l, &e);
    const int failed = find_streams(l, &e);
    if (!failed) {
        fill_grid(l, &e);
        light_grid(l);
    }
    erosion_free(&e);
    if (failed) {
        land_free(l);
    }
    return failed;
}

void land_free(struct land *l)
{
    free(l->height_m);
    free(l->shore_m);
    free(l->lake_m);
    free(l->wood);
    free(l->slope);
    free(l->light);
    free(l->stream);
    *l = (struct land){0};
}

struct land_reader land_reader_at(const struct land *l, double east_m, double north_m)
{
    const double last = l->posts - 1.001;
    const double x = fmin(fmax((east_m + l->edge_m) / l->spacing_m, 0), last);
    const double y = fmin(fmax((l->edge_m - north_m) / l->spacing_m, 0), last);
    const int ix = (int)x, iy = (int)y;
    return (struct land_reader){(size_t)iy * (size_t)l->posts + (size_t)ix, (size_t)l->posts,
                                x - ix, y - iy};
}

double land_read(const struct land_reader *r, const float *field)
{
    const float *a = field + r->post, *b = a + r->posts;
    const double top = (double)a[0] + (double)(a[1] - a[0]) * r->tx;
    const double bottom = (double)b[0] + (double)(b[1] - b[0]) * r->tx;
    return top + (bottom - top) * r->ty;
}

double land_at(const struct land *l, const float *field, struct point p)
{
    double east, north;
    land_from_design(p, &east, &north);
    const struct land_reader r = land_reader_at(l, east, north);
    return land_read(&r, field);
}
