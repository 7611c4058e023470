#include "resample_mesh.h"

#include <math.h>

enum { SPAN = LM_TILE_CELLS / (RESAMPLE_NODES - 1) };

/* Largest error of the bilinear mapping that is let pass, in pixels. */
static const double tolerance_px = 0.002;

static void place(const struct image_frame *f, double row, double column, double *latitude,
                  double *longitude)
{
    *latitude = (double)f->south + row * (double)f->latitude_step;
    *longitude = (double)f->west + column * (double)f->longitude_step;
}

/* A chord misses a smooth curve by an eighth of its second difference. False for NaN. */
static bool is_straight(const double a, const double b, const double c)
{
    return fabs(a - 2.0 * b + c) / 8.0 <= tolerance_px;
}

/* Nodes first, first + stride, ... of one line of five. */
static bool line_is_smooth(const double *x, const double *y, int stride)
{
    for (int i = 0; i + 2 < RESAMPLE_NODES; i++) {
        const int a = i * stride, b = a + stride, c = b + stride;
        if (!is_straight(x[a], x[b], x[c]) || !is_straight(y[a], y[b], y[c])) {
            return false;
        }
    }
    return true;
}

void resample_mesh_make(struct resample_mesh *m, const struct resample_georef *georef,
                        const struct image_frame *frame)
{
    enum { COUNT = RESAMPLE_NODES * RESAMPLE_NODES };
    double latitude[COUNT], longitude[COUNT];
    m->georef = georef;
    m->frame = *frame;
    for (int i = 0; i < COUNT; i++) {
        place(frame, (double)(i / RESAMPLE_NODES * SPAN), (double)(i % RESAMPLE_NODES * SPAN),
              &latitude[i], &longitude[i]);
    }
    resample_to_pixels(georef, COUNT, latitude, longitude, &m->x[0][0], &m->y[0][0]);
    m->is_smooth = true;
    for (int i = 0; i < RESAMPLE_NODES; i++) {
        m->is_smooth = m->is_smooth && line_is_smooth(m->x[i], m->y[i], 1) &&
                       line_is_smooth(&m->x[0][i], &m->y[0][i], RESAMPLE_NODES);
    }
}

static double blend(double a, double b, double t)
{
    return (1.0 - t) * a + t * b;
}

/* Along a column first: on an edge of the tile the weights are exactly 0 and 1, and nothing but
 * that edge's nodes goes into the result. */
static double between(const double node[RESAMPLE_NODES][RESAMPLE_NODES], double row, double column)
{
    const int i = row >= LM_TILE_CELLS ? RESAMPLE_NODES - 2 : (int)row / SPAN;
    const int j = column >= LM_TILE_CELLS ? RESAMPLE_NODES - 2 : (int)column / SPAN;
    const double t = (row - i * SPAN) / SPAN, u = (column - j * SPAN) / SPAN;
    return blend(blend(node[i][j], node[i + 1][j], t), blend(node[i][j + 1], node[i + 1][j + 1], t),
                 u);
}

/* One row or column of positions, either from the nodes or each on its own. */
struct line {
    double row, column, row_step, column_step;
    int count;
    bool is_smooth;
};

static void map_line(const struct resample_mesh *m, const struct line *line, double *x, double *y,
                     size_t stride)
{
    for (int i = 0; i < line->count; i++) {
        const double row = line->row + i * line->row_step;
        const double column = line->column + i * line->column_step;
        const size_t at = (size_t)i * stride;
        if (line->is_smooth) {
            x[at] = between(m->x, row, column);
            y[at] = between(m->y, row, column);
        } else {
            double latitude, longitude;
            place(&m->frame, row, column, &latitude, &longitude);
            resample_to_pixels(m->georef, 1, &latitude, &longitude, &x[at], &y[at]);
        }
    }
}

void resample_mesh_posts(const struct resample_mesh *m, double *x, double *y)
{
    enum { N = LM_TILE_POSTS, LAST = LM_TILE_CELLS, NODE_LAST = RESAMPLE_NODES - 1 };
    for (int r = 0; r < N; r++) {
        const struct line inside = {r, 0, 0, 1, N, m->is_smooth};
        map_line(m, &inside, x + (size_t)r * N, y + (size_t)r * N, 1);
    }
    for (int side = 0; side < 2; side++) {
        const int node = side * NODE_LAST;
        const size_t first = (size_t)side * LAST;
        const struct line row = {side * LAST, 0, 0,
                                 1,           N, line_is_smooth(m->x[node], m->y[node], 1)};
        const struct line column = {
            0, side * LAST, 1,
            0, N,           line_is_smooth(&m->x[0][node], &m->y[0][node], RESAMPLE_NODES)};
        /* An edge that agrees with the inside has been done with it. */
        if (row.is_smooth != m->is_smooth) {
            map_line(m, &row, x + first * N, y + first * N, 1);
        }
        if (column.is_smooth != m->is_smooth) {
            map_line(m, &column, x + first, y + first, N);
        }
    }
}

void resample_mesh_cells(const struct resample_mesh *m, int parts, double *x, double *y)
{
    const int side = LM_TILE_CELLS * parts;
    const double step = 1.0 / parts;
    for (int r = 0; r < side; r++) {
        const struct line row = {(r + 0.5) * step, 0.5 * step, 0, step, side, m->is_smooth};
        map_line(m, &row, x + (size_t)r * (size_t)side, y + (size_t)r * (size_t)side, 1);
    }
}

static int clamp_int(double value, int low, int high)
{
    return value < low ? low : value > high ? high : (int)value;
}

struct resample_window resample_window_of(const struct resample_georef *georef, size_t count,
                                          const double *x, const double *y, int margin)
{
    double low_x = HUGE_VAL, high_x = -HUGE_VAL, low_y = HUGE_VAL, high_y = -HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        if (x[i] >= -margin && x[i] <= georef->width + margin && y[i] >= -margin &&
            y[i] <= georef->height + margin) {
            low_x = fmin(low_x, x[i]);
            high_x = fmax(high_x, x[i]);
            low_y = fmin(low_y, y[i]);
            high_y = fmax(high_y, y[i]);
        }
    }
    struct resample_window w = {0, 0, 0, 0};
    if (low_x <= high_x) {
        w.x = clamp_int(floor(low_x) - margin, 0, georef->width);
        w.y = clamp_int(floor(low_y) - margin, 0, georef->height);
        w.width = clamp_int(floor(high_x) + margin + 1, 0, georef->width) - w.x;
        w.height = clamp_int(floor(high_y) + margin + 1, 0, georef->height) - w.y;
    }
    return w.width > 0 && w.height > 0 ? w : (struct resample_window){0, 0, 0, 0};
}
