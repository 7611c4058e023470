#include "pixel_places.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>

enum { APART_MAX = 16 };

static const double degree = 3.14159265358979323846 / 180;

/* Coordinates of the middle of pixel (column, row) in the grid's CRS. */
static void pixel_middle(const struct db_grid *g, double column, double row, double *x, double *y)
{
    const double *t = g->geotransform, u = column + 0.5, v = row + 0.5;
    *x = t[0] + u * t[1] + v * t[2];
    *y = t[3] + u * t[4] + v * t[5];
}

/* Places of the pixels 0, apart, 2 apart .. of a row, `count` of them, at p->row[0 ..]. */
static void place_nodes(struct pixel_places *p, int count, int row)
{
    for (int i = 0; i < count; i++) {
        pixel_middle(p->grid, i * p->apart, row, &p->x[i], &p->y[i]);
        p->row[i] = (struct reflect_place){p->x[i], p->y[i], 0};
        p->is_found[i] = 0;
    }
    if (p->to_wgs84) {
        OCTTransformEx(p->to_wgs84, count, p->x, p->y, NULL, p->is_found);
    }
    for (int i = 0; i < count; i++) {
        if (p->is_found[i]) {
            p->row[i] = reflect_place_at(degree * p->y[i], degree * p->x[i]);
        }
    }
}

static double distance(struct reflect_place a, struct reflect_place b)
{
    return hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
}

static int open_transform(struct pixel_places *p, const char *name)
{
    if (!p->grid->crs) {
        return 0;
    }
    const OGRSpatialReferenceH wgs84 = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(wgs84, 4326);
    OSRSetAxisMappingStrategy(wgs84, OAMS_TRADITIONAL_GIS_ORDER);
    p->to_wgs84 = OCTNewCoordinateTransformation(p->grid->crs, wgs84);
    OSRDestroySpatialReference(wgs84);
    return p->to_wgs84 ? 0
                       : hs_error(name, "check its CRS with gdalinfo",
                                  "has a CRS that cannot be reached from WGS-84");
}

int pixel_places_open(struct pixel_places *p, const struct db_grid *grid, const char *name)
{
    const size_t most = (size_t)grid->width + APART_MAX + 1;
    *p = (struct pixel_places){.grid = grid, .apart = 1};
    p->x = malloc(most * sizeof *p->x);
    p->y = malloc(most * sizeof *p->y);
    p->is_found = malloc(most * sizeof *p->is_found);
    p->row = malloc(most * sizeof *p->row);
    if (!p->x || !p->y || !p->is_found || !p->row) {
        return hs_error(name, NULL, "out of memory");
    }
    if (open_transform(p, name) != 0) {
        return -1;
    }
    place_nodes(p, 1, grid->height / 2 + 1);
    const struct reflect_place south = p->row[0];
    place_nodes(p, 2, grid->height / 2);
    p->pixel_m = distance(p->row[0], south);
    if (p->to_wgs84 && grid->width > 1) {
        p->apart = (int)fmin(fmax(500 / distance(p->row[0], p->row[1]), 1), APART_MAX);
    }
    return 0;
}

void pixel_places_close(struct pixel_places *p)
{
    free(p->x);
    free(p->y);
    free(p->is_found);
    free(p->row);
    if (p->to_wgs84) {
        OCTDestroyCoordinateTransformation(p->to_wgs84);
    }
    *p = (struct pixel_places){0};
}

void pixel_places_row(struct pixel_places *p, int y)
{
    const int spans = (p->grid->width - 1) / p->apart + 1;
    place_nodes(p, spans + 1, y);
    /* Backwards, so that each node is read before it is written over. */
    for (int i = spans - 1; i >= 0; i--) {
        const struct reflect_place from = p->row[i], to = p->row[i + 1];
        for (int k = p->apart - 1; k >= 0; k--) {
            const double t = (double)k / p->apart;
            p->row[i * p->apart + k] =
                (struct reflect_place){from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                                       from.z + t * (to.z - from.z)};
        }
    }
}
