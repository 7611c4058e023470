#include "resample/mesh.h"

#include <math.h>
#include <stdbool.h>

enum { SPAN_MAX = 16, PROBES = 9 };

/* Largest error of the bilinear mapping that is let pass, in pixels. */
static const double tolerance_px = 0.002;

static void to_pixel(const struct resample_georef *g, double latitude, double longitude, double *x,
                     double *y)
{
    resample_to_pixels(g, 1, &latitude, &longitude, x, y);
}

/* What a chord of twice `step` misses of the curve through one place: an eighth of the second
 * difference. Pixels. */
static double chord_error(const struct resample_georef *g, double latitude, double longitude,
                          double north, double east)
{
    double x[3], y[3];
    for (int i = 0; i < 3; i++) {
        to_pixel(g, latitude + (i - 1) * north, longitude + (i - 1) * east, &x[i], &y[i]);
    }
    return fmax(fabs(x[0] - 2 * x[1] + x[2]), fabs(y[0] - 2 * y[1] + y[2])) / 8.0;
}

/* The largest error of a lattice of this spacing at places all over the raster. A place at a seam
 * says nothing of the rest and is passed over, and so is one that is nowhere. */
static double lattice_error(const struct resample_georef *g, const struct image_area *area,
                            double spacing, double jump_px)
{
    double worst = 0.0;
    for (int i = 0; i < PROBES * PROBES; i++) {
        const double north = (double)(i / PROBES) / (PROBES - 1);
        const double east = (double)(i % PROBES) / (PROBES - 1);
        const double latitude = (double)area->south + north * (double)(area->north - area->south);
        const double longitude = (double)area->west + east * (double)area->width;
        const double error = chord_error(g, latitude, longitude, spacing, 0.0) +
                             chord_error(g, latitude, longitude, 0.0, spacing);
        worst = error < jump_px / 8.0 ? fmax(worst, error) : worst;
    }
    return worst;
}

struct resample_lattice resample_lattice_of(const struct resample_georef *georef, uint8_t shift0)
{
    struct resample_lattice l = {0, 0.0};
    struct image_area area;
    double north_bam, east_bam;
    if (!georef->from_wgs84 || resample_area(georef, &area) != 0 ||
        resample_pixel_bam(georef, &north_bam, &east_bam) != 0) {
        return l; /* Without PROJ a point costs less than a mesh. */
    }
    for (int64_t span = SPAN_MAX; span >= 1 && l.spacing_bam == 0; span /= 2) {
        const int64_t spacing = span << shift0;
        /* Scales vary over a raster, but hardly sixteenfold. */
        l.jump_px = 16.0 * ((double)spacing / fmin(north_bam, east_bam) + 1.0);
        if (lattice_error(georef, &area, (double)spacing, l.jump_px) <= tolerance_px) {
            l.spacing_bam = spacing;
        }
    }
    return l;
}

static void place(const struct image_frame *f, double row, double column, double *latitude,
                  double *longitude)
{
    *latitude = (double)f->south + row * (double)f->latitude_step;
    *longitude = (double)f->west + column * (double)f->longitude_step;
}

void resample_mesh_make(struct resample_mesh *m, const struct resample_georef *georef,
                        const struct resample_lattice *lattice, const struct image_frame *frame)
{
    m->georef = georef;
    m->frame = *frame;
    m->jump_px = lattice->jump_px;
    m->row_span = (int)(lattice->spacing_bam / frame->latitude_step);
    m->column_span = (int)(lattice->spacing_bam / frame->longitude_step);
    if (m->row_span == 0 || m->column_span == 0) {
        m->row_span = 0;
        return;
    }
    m->rows = LM_TILE_CELLS / m->row_span + 2;
    m->columns = LM_TILE_CELLS / m->column_span + 2;
    double latitude[RESAMPLE_NODES], longitude[RESAMPLE_NODES];
    for (int i = 0; i < m->rows; i++) {
        for (int j = 0; j < m->columns; j++) {
            place(frame, (double)(i * m->row_span), (double)(j * m->column_span), &latitude[j],
                  &longitude[j]);
        }
        resample_to_pixels(georef, (size_t)m->columns, latitude, longitude, m->x + i * m->columns,
                           m->y + i * m->columns);
    }
}

/* One mesh of the lattice: its corners' positions in one of the two pixel coordinates. */
struct quad {
    double sw, se, nw, ne;
};

static struct quad quad_at(const double *node, int columns, int i, int j)
{
    const double *south = node + i * columns + j, *north = south + columns;
    return (struct quad){south[0], south[1], north[0], north[1]};
}

/* False for NaN. */
static bool hangs_together(const struct quad *q, double jump_px)
{
    return fabs(q->se - q->sw) < jump_px && fabs(q->ne - q->nw) < jump_px &&
           fabs(q->nw - q->sw) < jump_px && fabs(q->ne - q->se) < jump_px;
}

/* A weight of 0 must not let the other end in: it is another mesh's business. */
static double blend(double a, double b, double t)
{
    return t > 0.0 ? (1.0 - t) * a + t * b : a;
}

static double inside(const struct quad *q, double north, double east)
{
    return blend(blend(q->sw, q->se, east), blend(q->nw, q->ne, east), north);
}

/* Pixel position of a place given in cells from the tile's south-west corner. */
static void map(const struct resample_mesh *m, double row, double column, double *x, double *y)
{
    if (m->row_span > 0) {
        const int i = (int)row / m->row_span, j = (int)column / m->column_span;
        const struct quad qx = quad_at(m->x, m->columns, i, j);
        const struct quad qy = quad_at(m->y, m->columns, i, j);
        if (hangs_together(&qx, m->jump_px) && hangs_together(&qy, m->jump_px)) {
            const double north = (row - i * m->row_span) / m->row_span;
            const double east = (column - j * m->column_span) / m->column_span;
            *x = inside(&qx, north, east);
            *y = inside(&qy, north, east);
            return;
        }
    }
    double latitude, longitude;
    place(&m->frame, row, column, &latitude, &longitude);
    to_pixel(m->georef, latitude, longitude, x, y);
}

void resample_mesh_posts(const struct resample_mesh *m, double *x, double *y)
{
    for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
        map(m, (double)(i / LM_TILE_POSTS), (double)(i % LM_TILE_POSTS), &x[i], &y[i]);
    }
}

void resample_mesh_cells(const struct resample_mesh *m, int parts, double *x, double *y)
{
    const int side = LM_TILE_CELLS * parts;
    for (int r = 0; r < side; r++) {
        for (int c = 0; c < side; c++) {
            const size_t i = (size_t)r * (size_t)side + (size_t)c;
            map(m, (r + 0.5) / parts, (c + 0.5) / parts, &x[i], &y[i]);
        }
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
