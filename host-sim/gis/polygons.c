#include "gis/polygons.h"

#include "gis/gdal_start.h"
#include "hs/error.h"

#include <math.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Everything one feature after another needs. */
struct reader {
    const char *path;
    int field;
    OGRCoordinateTransformationH to_image; /* NULL when none is needed */
    double to_pixel[6];
    size_t without_area;
};

static size_t count_points(OGRGeometryH g)
{
    const int parts = OGR_G_GetGeometryCount(g);
    size_t count = parts == 0 ? (size_t)OGR_G_GetPointCount(g) : 0;
    for (int i = 0; i < parts; i++) {
        count += count_points(OGR_G_GetGeometryRef(g, i));
    }
    return count;
}

static size_t count_rings(OGRGeometryH g)
{
    const int parts = OGR_G_GetGeometryCount(g);
    size_t count = parts == 0;
    for (int i = 0; i < parts; i++) {
        count += count_rings(OGR_G_GetGeometryRef(g, i));
    }
    return count;
}

/* Append the rings of `g`, whatever it is nested in, to `p`, in pixels. */
static void copy_rings(const struct reader *r, OGRGeometryH g, struct db_polygon *p, size_t *used)
{
    const int parts = OGR_G_GetGeometryCount(g);
    for (int i = 0; i < parts; i++) {
        copy_rings(r, OGR_G_GetGeometryRef(g, i), p, used);
    }
    if (parts > 0) {
        return;
    }
    const double *t = r->to_pixel;
    const int points = OGR_G_GetPointCount(g);
    for (int i = 0; i < points; i++, (*used)++) {
        const double x = OGR_G_GetX(g, i), y = OGR_G_GetY(g, i);
        p->xy[2 * *used] = t[0] + x * t[1] + y * t[2];
        p->xy[2 * *used + 1] = t[3] + x * t[4] + y * t[5];
    }
    p->ring_ends[p->ring_count++] = *used;
}

static bool has_area(OGRGeometryH g)
{
    const OGRwkbGeometryType type = g ? wkbFlatten(OGR_G_GetGeometryType(g)) : wkbUnknown;
    return type == wkbPolygon || type == wkbMultiPolygon || type == wkbCurvePolygon ||
           type == wkbMultiSurface;
}

static int add_polygon(struct reader *r, struct db_polygons *all, OGRFeatureH feature)
{
    OGRGeometryH original = OGR_F_GetGeometryRef(feature);
    if (!has_area(original) || OGR_G_IsEmpty(original)) {
        r->without_area++;
        return 0;
    }
    struct db_polygon *p = &all->items[all->count];
    *p = (struct db_polygon){.id = (long)all->count + (long)r->without_area + 1};
    OGRGeometryH g = OGR_G_GetLinearGeometry(original, 0, NULL); /* Arcs become short chords. */
    CPLErrorReset();
    if (g && r->to_image && OGR_G_Transform(g, r->to_image) != OGRERR_NONE) {
        OGR_G_DestroyGeometry(g);
        return hs_error(r->path, "reproject the polygons to the image's CRS with ogr2ogr",
                        "feature %ld cannot be brought to the image's CRS: %s", p->id,
                        db_gdal_complaint());
    }
    p->xy = g ? malloc(2 * sizeof *p->xy * (count_points(g) + 1)) : NULL;
    p->ring_ends = g ? malloc(sizeof *p->ring_ends * count_rings(g)) : NULL;
    all->count++;
    if (!p->xy || !p->ring_ends) {
        OGR_G_DestroyGeometry(g);
        return hs_error(r->path, NULL, "out of memory");
    }
    size_t used = 0;
    copy_rings(r, g, p, &used);
    OGR_G_DestroyGeometry(g);
    snprintf(p->label, sizeof p->label, "%s", OGR_F_GetFieldAsString(feature, r->field));
    return 0;
}

static int read_features(struct reader *r, struct db_polygons *all, OGRLayerH layer)
{
    size_t capacity = 0;
    OGRFeatureH feature;
    OGR_L_ResetReading(layer);
    while ((feature = OGR_L_GetNextFeature(layer)) != NULL) {
        int result = 0;
        if (all->count == capacity) {
            capacity = 2 * capacity + 64;
            struct db_polygon *items = realloc(all->items, capacity * sizeof *items);
            if (items) {
                all->items = items;
            } else {
                result = hs_error(r->path, NULL, "out of memory");
            }
        }
        if (result == 0) {
            result = add_polygon(r, all, feature);
        }
        OGR_F_Destroy(feature);
        if (result != 0) {
            return -1;
        }
    }
    return 0;
}

static OGRLayerH find_layer(GDALDatasetH file, const char *field, int *field_index)
{
    for (int i = 0; i < GDALDatasetGetLayerCount(file); i++) {
        OGRLayerH layer = GDALDatasetGetLayer(file, i);
        *field_index = OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(layer), field);
        if (*field_index >= 0) {
            return layer;
        }
    }
    return NULL;
}

static int prepare_transformation(struct reader *r, OGRLayerH layer, const struct db_grid *grid)
{
    double geotransform[6];
    memcpy(geotransform, grid->geotransform, sizeof geotransform);
    if (!GDALInvGeoTransform(geotransform, r->to_pixel)) {
        return hs_error(r->path, "correct the image's geotransform",
                        "the image's pixels have no size");
    }
    const OGRSpatialReferenceH found = OGR_L_GetSpatialRef(layer);
    if (!found || !grid->crs) {
        return 0;
    }
    OGRSpatialReferenceH source = OSRClone(found);
    OSRSetAxisMappingStrategy(source, OAMS_TRADITIONAL_GIS_ORDER);
    CPLErrorReset();
    if (!OSRIsSame(source, grid->crs)) {
        r->to_image = OCTNewCoordinateTransformation(source, grid->crs);
        if (!r->to_image) {
            OSRDestroySpatialReference(source);
            return hs_error(r->path, "reproject the polygons with ogr2ogr",
                            "its CRS cannot be brought to the image's: %s", db_gdal_complaint());
        }
    }
    OSRDestroySpatialReference(source);
    return 0;
}

static int read_layer(struct db_polygons *p, const char *path, GDALDatasetH file, const char *field,
                      const struct db_grid *grid)
{
    struct reader r = {.path = path};
    OGRLayerH layer = find_layer(file, field, &r.field);
    if (!layer) {
        return hs_error(path, "name the field of the labels with --field", "has no field `%s`",
                        field);
    }
    int result = prepare_transformation(&r, layer, grid);
    if (result == 0) {
        result = read_features(&r, p, layer);
    }
    if (r.to_image) {
        OCTDestroyCoordinateTransformation(r.to_image);
    }
    if (result == 0 && r.without_area > 0) {
        hs_warn(path, "check the geometry column", "%zu features without a polygon are left out",
                r.without_area);
    }
    if (result == 0 && p->count == 0) {
        return hs_error(path, "draw some polygons first", "holds no polygon");
    }
    return result;
}

int db_polygons_read(struct db_polygons *p, const char *path, const char *field,
                     const struct db_grid *grid)
{
    *p = (struct db_polygons){0};
    CPLErrorReset();
    GDALDatasetH file =
        db_gdal_note(GDALOpenEx(path, GDAL_OF_VECTOR | GDAL_OF_READONLY, NULL, NULL, NULL));
    if (!file) {
        return hs_error(path, "check the name and that `ogrinfo` can read it",
                        "cannot be opened as polygons: %s", db_gdal_complaint());
    }
    const int result = read_layer(p, path, file, field, grid);
    GDALClose(file);
    if (result != 0) {
        db_polygons_free(p);
    }
    return result;
}

void db_polygons_free(struct db_polygons *p)
{
    for (size_t i = 0; i < p->count; i++) {
        free(p->items[i].xy);
        free(p->items[i].ring_ends);
    }
    free(p->items);
    *p = (struct db_polygons){0};
}

/* Where an edge passes the centre line of a row. */
struct crossing {
    int row;
    double x;
};

struct crossings {
    struct crossing *items;
    size_t count, capacity;
};

static int compare_crossings(const void *a, const void *b)
{
    const struct crossing *p = a, *q = b;
    if (p->row != q->row) {
        return p->row < q->row ? -1 : 1;
    }
    return (p->x > q->x) - (p->x < q->x);
}

static int add_crossing(struct crossings *all, int row, double x)
{
    if (all->count == all->capacity) {
        const size_t capacity = 2 * all->capacity + 256;
        struct crossing *items = realloc(all->items, capacity * sizeof *items);
        if (!items) {
            return -1;
        }
        all->items = items;
        all->capacity = capacity;
    }
    all->items[all->count++] = (struct crossing){row, x};
    return 0;
}

/* Rows whose centre lies at or above one end of the edge and below the other: each vertex belongs
 * to exactly one of two edges that meet there. Coordinates that are not finite cross nothing. */
static int cross_edge(struct crossings *all, const double *a, const double *b, int y_begin,
                      int y_end)
{
    const double top = fmin(a[1], b[1]), bottom = fmax(a[1], b[1]);
    if (!(isfinite(top) && isfinite(bottom) && isfinite(a[0]) && isfinite(b[0]))) {
        return 0;
    }
    const int first = (int)fmax(y_begin, fmin(ceil(top - 0.5), y_end));
    const int end = (int)fmin(y_end, fmax(ceil(bottom - 0.5), y_begin));
    for (int row = first; row < end; row++) {
        const double x = a[0] + (row + 0.5 - a[1]) * (b[0] - a[0]) / (b[1] - a[1]);
        if (add_crossing(all, row, x) != 0) {
            return -1;
        }
    }
    return 0;
}

static int find_crossings(struct crossings *all, const struct db_polygon *p, int y_begin, int y_end)
{
    size_t begin = 0;
    for (size_t ring = 0; ring < p->ring_count; ring++) {
        const size_t end = p->ring_ends[ring];
        for (size_t i = begin; i < end; i++) {
            const size_t next = i + 1 < end ? i + 1 : begin;
            if (cross_edge(all, p->xy + 2 * i, p->xy + 2 * next, y_begin, y_end) != 0) {
                return -1;
            }
        }
        begin = end;
    }
    return 0;
}

/* The first pixel whose centre is not left of x. */
static int first_pixel(double x, int width)
{
    return (int)fmax(0, fmin(ceil(x - 0.5), width));
}

int db_polygon_walk(const struct db_polygon *p, int y_begin, int y_end, int width, db_span_fn *take,
                    void *context)
{
    struct crossings all = {0};
    int result = find_crossings(&all, p, y_begin, y_end);
    if (result == 0 && all.count > 0) {
        qsort(all.items, all.count, sizeof *all.items, compare_crossings);
    }
    /* Closed rings cross each centre line an even number of times. */
    for (size_t i = 0; result == 0 && i + 1 < all.count; i += 2) {
        const int begin = first_pixel(all.items[i].x, width);
        const int end = first_pixel(all.items[i + 1].x, width);
        if (begin < end) {
            result = take(context, all.items[i].row, begin, end);
        }
    }
    free(all.items);
    return result;
}
