#include "tracer/projection.h"

#include <stdlib.h>
#include <string.h>

/* In columns. So near a side a ray counts as inside, on either side of it: of two triangles that
 * share it at least one is met. */
static const double edge_share = 1e-7;

/* A corner in columns and rows: rays are at the whole numbers. */
struct corner {
    double x, y;
};

static struct projection_side side_between(const struct corner *low, const struct corner *high)
{
    const double rise = high->y - low->y;
    return (struct projection_side){low->x, low->y, rise > 0 ? (high->x - low->x) / rise : 0};
}

static struct corner corner_at(const struct trace_axes *axes, const struct trace_sensor *sensor,
                               struct vec v)
{
    return (struct corner){
        (vec_dot(v, axes->across) - sensor->low_across_m) / sensor->step_across_m - 0.5,
        (vec_dot(v, axes->rise) - sensor->low_up_m) / sensor->step_up_m - 0.5};
}

static void swap_if_lower(struct corner *a, struct corner *b)
{
    if (b->y < a->y) {
        const struct corner lower = *b;
        *b = *a;
        *a = lower;
    }
}

/* Returns false when no ray can meet the triangle. */
static bool make_shape(const struct trace_axes *axes, const struct trace_sensor *sensor,
                       const struct vec corners[3], const struct scene_facet *plane,
                       double grazing_cos, struct projection_shape *shape)
{
    const double pace = vec_dot(plane->normal, axes->sight);
    struct corner a = corner_at(axes, sensor, corners[0]);
    struct corner b = corner_at(axes, sensor, corners[1]);
    struct corner c = corner_at(axes, sensor, corners[2]);
    swap_if_lower(&a, &b);
    swap_if_lower(&b, &c);
    swap_if_lower(&a, &b);
    const double left = ceil(fmin(a.x, fmin(b.x, c.x)) - edge_share);
    const double right = floor(fmax(a.x, fmax(b.x, c.x)) + edge_share);
    const double low = ceil(a.y), high = floor(c.y);
    if (fabs(pace) < grazing_cos || left > right || right < 0 || left >= sensor->columns ||
        low > high || high < 0 || low >= sensor->rows) {
        return false;
    }
    const double across = vec_dot(plane->normal, axes->across) / pace;
    const double up = vec_dot(plane->normal, axes->rise) / pace;
    const double first_across_m = sensor->low_across_m + sensor->step_across_m / 2;
    const double first_up_m = sensor->low_up_m + sensor->step_up_m / 2;
    shape->first_row = low > 0 ? (uint32_t)low : 0;
    shape->last_row = high < sensor->rows ? (uint32_t)high : sensor->rows - 1;
    shape->depth_m = plane->offset_m / pace - across * first_across_m - up * first_up_m;
    shape->depth_per_column_m = -across * sensor->step_across_m;
    shape->depth_per_row_m = -up * sensor->step_up_m;
    shape->whole = side_between(&a, &c);
    shape->lower = side_between(&a, &b);
    shape->upper = side_between(&b, &c);
    return true;
}

static bool add_shape(struct projection *p, const struct projection_shape *shape)
{
    if (p->shape_count == p->shape_room) {
        const uint32_t room = p->shape_room > 0 ? 2 * p->shape_room : 1024;
        struct projection_shape *larger = realloc(p->shapes, room * sizeof *larger);
        if (!larger) {
            return false;
        }
        p->shapes = larger;
        p->shape_room = room;
    }
    p->shapes[p->shape_count++] = *shape;
    return true;
}

static bool add_shapes(struct projection *p, const struct scene *scene,
                       const struct trace_axes *axes, const struct trace_sensor *sensor,
                       double grazing_cos, bool is_mirror)
{
    for (uint32_t i = 0; i < scene->triangle_count; i++) {
        struct projection_shape shape = {.facet = i};
        struct vec corners[3];
        struct scene_facet plane = scene->facets[i];
        scene_corners(scene, i, corners);
        if (is_mirror) {
            plane.normal.z = -plane.normal.z;
            for (int k = 0; k < 3; k++) {
                corners[k].z = -corners[k].z;
            }
        }
        if (make_shape(axes, sensor, corners, &plane, grazing_cos, &shape) &&
            !add_shape(p, &shape)) {
            return false;
        }
    }
    return true;
}

/* Count the shapes of each strip, let each strip's list begin behind the last, and fill them. */
static bool make_lists(struct projection *p)
{
    p->begins = calloc((size_t)p->strip_count + 1, sizeof *p->begins);
    if (!p->begins) {
        return false;
    }
    size_t total = 0;
    for (uint32_t i = 0; i < p->shape_count; i++) {
        const struct projection_shape *shape = &p->shapes[i];
        const uint32_t last = shape->last_row / p->strip_rows;
        for (uint32_t strip = shape->first_row / p->strip_rows; strip <= last; strip++) {
            p->begins[strip + 1]++;
            total++;
        }
    }
    p->lists = total < UINT32_MAX ? malloc((total + 1) * sizeof *p->lists) : NULL;
    if (!p->lists) {
        return false;
    }
    for (uint32_t strip = 0; strip < p->strip_count; strip++) {
        p->begins[strip + 1] += p->begins[strip];
    }
    /* Backwards, from each strip's end: afterwards begins[i + 1] is where strip i begins. */
    for (uint32_t i = p->shape_count; i-- > 0;) {
        const struct projection_shape *shape = &p->shapes[i];
        const uint32_t last = shape->last_row / p->strip_rows;
        for (uint32_t strip = shape->first_row / p->strip_rows; strip <= last; strip++) {
            p->lists[--p->begins[strip + 1]] = i;
        }
    }
    memmove(p->begins, p->begins + 1, p->strip_count * sizeof *p->begins);
    p->begins[p->strip_count] = (uint32_t)total;
    return true;
}

int projection_open(struct projection *p, const struct scene *scene, const struct trace_axes *axes,
                    const struct trace_sensor *sensor, uint32_t strip_rows, double grazing_cos,
                    bool is_mirror)
{
    *p = (struct projection){
        .columns = sensor->columns,
        .rows = sensor->rows,
        .strip_rows = strip_rows,
        .strip_count = (sensor->rows + strip_rows - 1) / strip_rows,
    };
    if (!add_shapes(p, scene, axes, sensor, grazing_cos, is_mirror) || !make_lists(p)) {
        projection_close(p);
        return -1;
    }
    return 0;
}

void projection_close(struct projection *p)
{
    free(p->shapes);
    free(p->begins);
    free(p->lists);
    *p = (struct projection){0};
}

static double x_at(const struct projection_side *side, uint32_t row)
{
    return side->x + (row - side->y) * side->x_per_row;
}

/* The columns of a row that lie inside: none when *first >= *end. */
static void span_of(const struct projection *p, const struct projection_shape *shape, uint32_t row,
                    uint32_t *first, uint32_t *end)
{
    const double one = x_at(&shape->whole, row);
    const double other = x_at(row < shape->upper.y ? &shape->lower : &shape->upper, row);
    const double left = (one < other ? one : other) - edge_share;
    const double right = (one < other ? other : one) + edge_share;
    const double columns = p->columns;
    *first = left <= 0 ? 0 : left < columns ? (uint32_t)(int32_t)left + 1 : p->columns;
    *end = right < 0 ? 0 : right < columns ? (uint32_t)(int32_t)right + 1 : p->columns;
}

static void draw_span(uint32_t count, float depth_m, float per_column_m, float near_m,
                      uint32_t facet, float *restrict depths_m, uint32_t *restrict facets)
{
    for (uint32_t i = 0; i < count; i++) {
        const float here_m = depth_m + (float)(int32_t)i * per_column_m;
        const bool is_nearest = (here_m > near_m) & (here_m < depths_m[i]);
        depths_m[i] = is_nearest ? here_m : depths_m[i];
        facets[i] = is_nearest ? facet : facets[i];
    }
}

void projection_draw(const struct projection *p, uint32_t strip, const float *near_m,
                     float *depths_m, uint32_t *facets)
{
    const uint32_t low = strip * p->strip_rows;
    const uint32_t high = low + p->strip_rows < p->rows ? low + p->strip_rows - 1 : p->rows - 1;
    for (uint32_t i = p->begins[strip]; i < p->begins[strip + 1]; i++) {
        const struct projection_shape *shape = &p->shapes[p->lists[i]];
        const uint32_t from = shape->first_row > low ? shape->first_row : low;
        const uint32_t to = shape->last_row < high ? shape->last_row : high;
        for (uint32_t row = from; row <= to; row++) {
            uint32_t first, end;
            span_of(p, shape, row, &first, &end);
            if (first < end) {
                const size_t at = (size_t)(row - low) * p->columns + first;
                const double depth_m = shape->depth_m + first * shape->depth_per_column_m +
                                       row * shape->depth_per_row_m;
                draw_span(end - first, (float)depth_m, (float)shape->depth_per_column_m,
                          near_m[row - low], shape->facet, depths_m + at, facets + at);
            }
        }
    }
}
