#include "footprint.h"
#include "gis/gdal_start.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "vectors/output.h"

#include <math.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;

/* UNSOURCED: lines are straightened by so much, and no item is shorter. */
static const double straight_m = 0.3, least_m = 0.2;

struct writing {
    const struct vector_map *map;
    const struct db_class_table *table;
    FILE *out;
    OGRCoordinateTransformationH to_degrees;
    struct vector_detail_counts *counts;
    bool is_lost; /* a place that PROJ refuses */
};

struct spot {
    double x, y;
};

static bool is_on_plane(const struct vector_map *map, struct spot p)
{
    const double *t = map->grid.geotransform;
    return p.x >= t[0] && p.x < t[0] + map->grid.width * t[1] && p.y <= t[3] &&
           p.y > t[3] + map->grid.height * t[5];
}

/* Longitude and latitude of a spot. */
static struct spot degrees_of(struct writing *w, struct spot p)
{
    if (!OCTTransform(w->to_degrees, 1, &p.x, &p.y, NULL)) {
        w->is_lost = true;
    }
    return p;
}

/* ---- buildings ---- */

/* Direction on the ground of a direction on the plane: degrees from north by east. */
static double turn_of(struct writing *w, const struct footprint_box *b)
{
    const double step_m = 10;
    const struct spot from = degrees_of(w, (struct spot){b->x, b->y}),
                      to = degrees_of(
                          w, (struct spot){b->x + step_m * b->east, b->y + step_m * b->north});
    const double turn = atan2((to.x - from.x) * cos(from.y * pi / 180), to.y - from.y) * 180 / pi;
    return turn < 0 ? turn + 360 : turn;
}

static void write_box(struct writing *w, const struct footprint_box *b,
                      const struct vector_item *item, bool is_alone)
{
    const struct spot middle = {b->x, b->y};
    const bool is_seen = b->length_m >= least_m && b->width_m >= least_m && item->height_m >= 0.1;
    if (!is_seen || !is_on_plane(w->map, middle)) {
        w->counts->outside += is_seen;
        return;
    }
    const struct spot at = degrees_of(w, middle);
    fprintf(w->out, "building %.7f %.7f %.1f %.1f %.1f %.1f %s\n", at.y, at.x,
            fmin(2000, b->length_m), fmin(2000, b->width_m), turn_of(w, b), item->height_m,
            item->is_gabled && is_alone ? "gabled" : "flat");
    w->counts->boxes++;
    w->counts->boxes_m2 += b->length_m * b->width_m;
}

static int write_polygon(struct writing *w, OGRGeometryH polygon, const struct vector_item *item)
{
    struct footprint_box boxes[FOOTPRINT_BOXES_MAX];
    const int count = footprint_cut(polygon, boxes);
    for (int i = 0; i < count; i++) {
        write_box(w, &boxes[i], item, count == 1);
    }
    return count < 0 ? hs_error(item->origin, NULL, "out of memory") : 0;
}

static int write_building(struct writing *w, const struct vector_item *item)
{
    const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(item->geometry));
    w->counts->buildings++;
    w->counts->footprint_m2 += OGR_G_Area(item->geometry);
    if (type == wkbPolygon) {
        return write_polygon(w, item->geometry, item);
    }
    int result = 0;
    for (int i = 0; i < OGR_G_GetGeometryCount(item->geometry) && result == 0; i++) {
        result = write_polygon(w, OGR_G_GetGeometryRef(item->geometry, i), item);
    }
    return result;
}

/* ---- lines ---- */

static void write_segment(struct writing *w, const struct vector_item *item, struct spot from,
                          struct spot to)
{
    static const char *const kinds[VECTOR_DETAILS] = {[VECTOR_FENCE] = "fence",
                                                      [VECTOR_RAIL] = "rail",
                                                      [VECTOR_RAILING] = "railing",
                                                      [VECTOR_WIRE] = "wire"};
    if (hypot(to.x - from.x, to.y - from.y) < least_m) {
        return;
    }
    if (!is_on_plane(w->map, from) || !is_on_plane(w->map, to)) {
        w->counts->outside++;
        return;
    }
    const struct spot a = degrees_of(w, from), b = degrees_of(w, to);
    if (item->rule->detail == VECTOR_WALL) {
        fprintf(w->out, "wall %.7f %.7f %.7f %.7f %.1f\n", a.y, a.x, b.y, b.x,
                fmax(0.1, item->height_m));
        w->counts->walls++;
    } else {
        fprintf(w->out, "line %.7f %.7f %.7f %.7f %s\n", a.y, a.x, b.y, b.x,
                kinds[item->rule->detail]);
        w->counts->lines++;
    }
}

/* Class burnt at a spot; NODATA beyond the plane. */
static uint8_t class_at(const struct vector_map *map, double x, double y)
{
    const double *t = map->grid.geotransform;
    const struct spot p = {x, y};
    if (!is_on_plane(map, p)) {
        return DB_CLASS_NODATA;
    }
    const size_t column = (size_t)((x - t[0]) / t[1]), row = (size_t)((y - t[3]) / t[5]);
    return map->classes[row * (size_t)map->grid.width + column];
}

static void write_strip(struct writing *w, const char *word, struct spot from, struct spot to,
                        double width_m, int class_index)
{
    if (!is_on_plane(w->map, from) || !is_on_plane(w->map, to)) {
        w->counts->outside++;
        return;
    }
    const struct spot a = degrees_of(w, from), b = degrees_of(w, to);
    fprintf(w->out, "%s %.7f %.7f %.7f %.7f %.1f %s\n", word, a.y, a.x, b.y, b.x,
            fmax(0.1, fmin(1000, width_m)), w->table->items[class_index].name);
    w->counts->strips++;
}

/* The verge on one side of a piece, where one class grows at six places of it: a burnt cell of the
 * paving juts out by up to 0.7 of one, so they lie 0.9 and 1.5 cells from its edge. `u` and `v`
 * lead one metre to that side. */
static void write_verge(struct writing *w, double half_m, struct spot a, struct spot b, double u,
                        double v)
{
    const double wide = 1.5 * w->map->cell_m, middle = half_m + wide / 2;
    uint8_t grows = DB_CLASS_NODATA;
    for (int i = 0; i < 6; i++) {
        const double share = 0.1 + 0.4 * (i % 3), off = middle + (i < 3 ? 0.1 : 0.5) * wide;
        const uint8_t k = class_at(w->map, a.x + share * (b.x - a.x) + off * u,
                                   a.y + share * (b.y - a.y) + off * v);
        grows = i == 0 || k == grows ? k : DB_CLASS_NODATA;
        if (grows == DB_CLASS_NODATA || !w->table->items[grows].is_natural) {
            return;
        }
    }
    write_strip(w, "verge", (struct spot){a.x + middle * u, a.y + middle * v},
                (struct spot){b.x + middle * u, b.y + middle * v}, wide, grows);
}

/* A segment of paving in pieces of some 30 m, each with the verges that it has. */
static void write_surface(struct writing *w, const struct vector_item *item, struct spot from,
                          struct spot to)
{
    const double length = hypot(to.x - from.x, to.y - from.y);
    if (length < least_m || item->width_m < w->map->cell_m) {
        return; /* narrower than a cell it would cover what the map does not know */
    }
    const double u = (to.y - from.y) / length, v = (from.x - to.x) / length;
    const int pieces = (int)fmax(1, round(length / 30));
    for (int i = 0; i < pieces; i++) {
        const double s = (double)i / pieces, e = (i + 1.0) / pieces;
        const struct spot a = {from.x + s * (to.x - from.x), from.y + s * (to.y - from.y)},
                          b = {from.x + e * (to.x - from.x), from.y + e * (to.y - from.y)};
        write_verge(w, item->width_m / 2, a, b, u, v);
        write_verge(w, item->width_m / 2, a, b, -u, -v);
    }
    write_strip(w, "surface", from, to, item->width_m, item->rule->class_index);
}

/* A segment, or beside it both edges of what is as wide as the item. */
static void write_edges(struct writing *w, const struct vector_item *item, struct spot a,
                        struct spot b)
{
    const double length = hypot(b.x - a.x, b.y - a.y);
    if (item->rule->detail == VECTOR_SURFACE) {
        write_surface(w, item, a, b);
        return;
    }
    const bool is_edged = item->rule->detail == VECTOR_RAILING && item->width_m > 0 && length > 0;
    if (!is_edged) {
        write_segment(w, item, a, b);
        return;
    }
    const double side = item->width_m / 2 / length;
    const double u = side * (b.y - a.y), v = -side * (b.x - a.x);
    write_segment(w, item, (struct spot){a.x + u, a.y + v}, (struct spot){b.x + u, b.y + v});
    write_segment(w, item, (struct spot){a.x - u, a.y - v}, (struct spot){b.x - u, b.y - v});
}

static void write_line(struct writing *w, const struct vector_item *item, OGRGeometryH line)
{
    for (int i = 0; i < OGR_G_GetGeometryCount(line); i++) {
        write_line(w, item, OGR_G_GetGeometryRef(line, i));
    }
    for (int i = 0; i + 1 < OGR_G_GetPointCount(line); i++) {
        write_edges(w, item, (struct spot){OGR_G_GetX(line, i), OGR_G_GetY(line, i)},
                    (struct spot){OGR_G_GetX(line, i + 1), OGR_G_GetY(line, i + 1)});
    }
}

/* Masts stand where wires bend: lines are straightened but for wires. */
static void write_lines(struct writing *w, const struct vector_item *item)
{
    OGRGeometryH straight = item->rule->detail == VECTOR_WIRE
                                ? NULL
                                : OGR_G_SimplifyPreserveTopology(item->geometry, straight_m);
    write_line(w, item, straight ? straight : item->geometry);
    OGR_G_DestroyGeometry(straight);
}

static void write_mast(struct writing *w, const struct vector_item *item)
{
    const struct spot p = {OGR_G_GetX(item->geometry, 0), OGR_G_GetY(item->geometry, 0)};
    if (!is_on_plane(w->map, p)) {
        w->counts->outside++;
        return;
    }
    const struct spot at = degrees_of(w, p);
    fprintf(w->out, "mast %.7f %.7f %.1f\n", at.y, at.x, fmax(0.1, item->height_m));
    w->counts->masts++;
}

static int write_item(struct writing *w, const struct vector_item *item)
{
    switch (item->rule->detail) {
    case VECTOR_BUILDING:
    case VECTOR_PART:
        return item->is_replaced ? 0 : write_building(w, item);
    case VECTOR_WALL:
    case VECTOR_FENCE:
    case VECTOR_RAIL:
    case VECTOR_RAILING:
    case VECTOR_WIRE:
    case VECTOR_SURFACE:
        write_lines(w, item);
        return 0;
    case VECTOR_MAST:
        write_mast(w, item);
        return 0;
    default:
        return 0;
    }
}

static int write_items(struct writing *w)
{
    int result = 0;
    for (size_t i = 0; i < w->map->item_count && result == 0; i++) {
        result = write_item(w, &w->map->items[i]);
    }
    if (result == 0 && w->is_lost) {
        return hs_error("detail", "check that PROJ finds its database (proj.db)",
                        "a place cannot be brought back to degrees: %s", db_gdal_complaint());
    }
    return result;
}

int vector_detail_write(const struct vector_map *map, const struct db_class_table *table,
                        const char *path, const char *remark, struct vector_detail_counts *counts)
{
    struct hs_atomic_file file;
    struct writing w = {.map = map, .table = table, .counts = counts};
    *counts = (struct vector_detail_counts){0};
    OGRCoordinateTransformationH to_plane = vector_map_from(map, NULL, path);
    w.to_degrees = to_plane ? OCTGetInverse(to_plane) : NULL;
    OCTDestroyCoordinateTransformation(to_plane);
    if (!w.to_degrees) {
        return hs_error(path, NULL, "no way back to degrees: %s", db_gdal_complaint());
    }
    int result = hs_atomic_open(&file, path);
    if (result == 0) {
        w.out = file.stream;
        fprintf(w.out, "# %s\n", remark);
        result = write_items(&w);
        if (result == 0) {
            result = hs_atomic_commit(&file);
        } else {
            hs_atomic_abort(&file);
        }
    }
    OCTDestroyCoordinateTransformation(w.to_degrees);
    return result;
}
