#include "vectors/map.h"

#include "coast.h"
#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "osm_reading.h"

#include <cpl_conv.h>
#include <gdal_alg.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the plane ---- */

static OGRSpatialReferenceH utm_of(const struct vector_area *a)
{
    const double middle = remainder((a->west + a->east) / 2, 360);
    const int zone = (int)fmin(60, floor((middle + 180) / 6) + 1);
    const bool is_north = a->south + a->north >= 0;
    OGRSpatialReferenceH crs = OSRNewSpatialReference(NULL);
    if (OSRImportFromEPSG(crs, (is_north ? 32600 : 32700) + zone) != OGRERR_NONE) {
        OSRDestroySpatialReference(crs);
        return NULL;
    }
    OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
    return crs;
}

OGRCoordinateTransformationH vector_map_from(const struct vector_map *map, OGRSpatialReferenceH crs,
                                             const char *name)
{
    OGRSpatialReferenceH source = crs ? OSRClone(crs) : OSRNewSpatialReference(NULL);
    if (!crs && OSRImportFromEPSG(source, 4326) != OGRERR_NONE) {
        OSRDestroySpatialReference(source);
        hs_error("coordinates", "check that PROJ finds its database (proj.db)",
                 "WGS 84 is not known: %s", db_gdal_complaint());
        return NULL;
    }
    OSRSetAxisMappingStrategy(source, OAMS_TRADITIONAL_GIS_ORDER);
    CPLErrorReset();
    OGRCoordinateTransformationH way = OCTNewCoordinateTransformation(source, map->grid.crs);
    OSRDestroySpatialReference(source);
    if (!way) {
        hs_error(name, "reproject it with ogr2ogr", "its CRS cannot be brought to UTM: %s",
                 db_gdal_complaint());
    }
    return way;
}

enum { EDGE_POINTS = 21 };

/* The rectangle on the plane around an area, from points along its edges. */
static bool plane_extent(const struct vector_map *map, OGREnvelope *e)
{
    double x[4 * EDGE_POINTS], y[4 * EDGE_POINTS];
    const struct vector_area *a = &map->area;
    for (int i = 0; i < EDGE_POINTS; i++) {
        const double share = (double)i / (EDGE_POINTS - 1);
        const double u = a->west + share * (a->east - a->west),
                     v = a->south + share * (a->north - a->south);
        const double places[4][2] = {{u, a->south}, {u, a->north}, {a->west, v}, {a->east, v}};
        for (int k = 0; k < 4; k++) {
            x[4 * i + k] = places[k][0];
            y[4 * i + k] = places[k][1];
        }
    }
    OGRCoordinateTransformationH way = vector_map_from(map, NULL, "area");
    const bool is_whole = way && OCTTransform(way, 4 * EDGE_POINTS, x, y, NULL);
    OCTDestroyCoordinateTransformation(way);
    *e = (OGREnvelope){HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    for (int i = 0; is_whole && i < 4 * EDGE_POINTS; i++) {
        e->MinX = fmin(e->MinX, x[i]);
        e->MaxX = fmax(e->MaxX, x[i]);
        e->MinY = fmin(e->MinY, y[i]);
        e->MaxY = fmax(e->MaxY, y[i]);
    }
    return is_whole && isfinite(e->MaxX - e->MinX) && isfinite(e->MaxY - e->MinY);
}

static int lay_grid(struct vector_map *map, const OGREnvelope *e)
{
    const double cell = map->cell_m;
    const double west = floor(e->MinX / cell) * cell, north = ceil(e->MaxY / cell) * cell;
    const double columns = ceil((e->MaxX - west) / cell), rows = ceil((north - e->MinY) / cell);
    if (!(columns >= 1 && rows >= 1 && columns * rows <= VECTOR_CELLS_MAX)) {
        return hs_error("--area", "choose a smaller one with --area, or larger cells with --cell",
                        "has %.0f x %.0f cells of %g m; there may be %d", columns, rows, cell,
                        VECTOR_CELLS_MAX);
    }
    map->grid.width = (int)columns;
    map->grid.height = (int)rows;
    map->grid.has_geotransform = true;
    const double transform[6] = {west, cell, 0, north, 0, -cell};
    memcpy(map->grid.geotransform, transform, sizeof transform);
    const size_t cells = (size_t)columns * (size_t)rows;
    map->classes = malloc(cells);
    map->heights_m = malloc(cells * sizeof *map->heights_m);
    if (!map->classes || !map->heights_m) {
        return hs_error("--area", "choose a smaller one, or larger cells", "out of memory");
    }
    memset(map->classes, DB_CLASS_NODATA, cells);
    for (size_t i = 0; i < cells; i++) {
        map->heights_m[i] = -1;
    }
    return 0;
}

int vector_map_init(struct vector_map *map, const struct vector_rules *rules,
                    const struct vector_area *area, double cell_m)
{
    *map = (struct vector_map){.rules = rules, .cell_m = cell_m, .area = *area};
    OGREnvelope e;
    if (!(area->south < area->north && area->west < area->east && area->south >= -84 &&
          area->north <= 84 && area->east - area->west <= 12)) {
        return hs_error("--area", "give SOUTH,WEST,NORTH,EAST in degrees, at most 12 degrees wide",
                        "%g,%g,%g,%g is no area between 84 S and 84 N", area->south, area->west,
                        area->north, area->east);
    }
    map->grid.crs = utm_of(area);
    if (!map->grid.crs || !plane_extent(map, &e)) {
        vector_map_free(map);
        return hs_error("--area", "check that PROJ finds its database (proj.db)",
                        "cannot be brought to UTM: %s", db_gdal_complaint());
    }
    if (lay_grid(map, &e) != 0) {
        vector_map_free(map);
        return -1;
    }
    return 0;
}

void vector_map_free(struct vector_map *map)
{
    for (size_t i = 0; i < map->item_count; i++) {
        OGR_G_DestroyGeometry(map->items[i].geometry);
        OGR_G_DestroyGeometry(map->items[i].cover);
    }
    free(map->items);
    free(map->classes);
    free(map->heights_m);
    if (map->grid.crs) {
        OSRDestroySpatialReference(map->grid.crs);
    }
    *map = (struct vector_map){.rules = NULL};
}

/* ---- features ---- */

static bool is_area(OGRGeometryH g)
{
    const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(g));
    return type == wkbPolygon || type == wkbMultiPolygon;
}

/* The polygons among the parts of a geometry; NULL when there are none. */
static OGRGeometryH polygons_of(OGRGeometryH g)
{
    if (is_area(g)) {
        return OGR_G_Clone(g);
    }
    OGRGeometryH all = OGR_G_CreateGeometry(wkbMultiPolygon);
    for (int i = 0; i < OGR_G_GetGeometryCount(g); i++) {
        OGRGeometryH part = OGR_G_GetGeometryRef(g, i);
        if (wkbFlatten(OGR_G_GetGeometryType(part)) == wkbPolygon) {
            OGR_G_AddGeometry(all, part);
        }
        for (int k = 0; wkbFlatten(OGR_G_GetGeometryType(part)) == wkbMultiPolygon &&
                        k < OGR_G_GetGeometryCount(part);
             k++) {
            OGR_G_AddGeometry(all, OGR_G_GetGeometryRef(part, k));
        }
    }
    return all;
}

/* An area that is valid, or NULL when none is left; takes `g` over. */
static OGRGeometryH valid_area(OGRGeometryH g, struct vector_census *census)
{
    static const double least_m2 = 0.01;
    if (!OGR_G_IsValid(g)) {
        OGRGeometryH mended = OGR_G_MakeValid(g);
        OGR_G_DestroyGeometry(g);
        g = mended ? polygons_of(mended) : NULL;
        OGR_G_DestroyGeometry(mended);
        census->repaired += g && OGR_G_Area(g) >= least_m2;
    }
    if (g && !(OGR_G_Area(g) >= least_m2)) {
        OGR_G_DestroyGeometry(g);
        return NULL;
    }
    return g;
}

static bool meets_plane(const struct vector_map *map, OGRGeometryH g)
{
    const double *t = map->grid.geotransform;
    OGREnvelope e;
    OGR_G_GetEnvelope(g, &e);
    return e.MaxX >= t[0] && e.MinX <= t[0] + map->grid.width * t[1] && e.MinY <= t[3] &&
           e.MaxY >= t[3] + map->grid.height * t[5];
}

/* What is burnt of an item: an area itself, a line as wide as it is. NULL: nothing. */
static OGRGeometryH cover_of(const struct vector_map *map, const struct vector_item *item)
{
    enum { QUARTER_CORNERS = 2 };
    const struct vector_rule *rule = item->rule;
    const bool is_burnt = rule->class_index >= 0 && rule->detail != VECTOR_COAST;
    if (!is_burnt) {
        return NULL;
    }
    if (rule->from == VECTOR_AREA) {
        return OGR_G_Clone(item->geometry);
    }
    if (item->width_m < map->cell_m / 2) {
        return NULL;
    }
    return item->width_m < map->cell_m
               ? OGR_G_Clone(item->geometry)
               : OGR_G_Buffer(item->geometry, item->width_m / 2, QUARTER_CORNERS);
}

static void measure(struct vector_map *map, struct vector_item *item,
                    const struct vector_candidate *c)
{
    const struct vector_rule *rule = item->rule;
    struct vector_rule_counts *n = &map->counts[c->rule];
    const struct vector_measured height = vector_measure_of(&rule->height, &c->tags),
                                 width = vector_measure_of(&rule->width, &c->tags),
                                 base = vector_measure_of(&rule->min_height, &c->tags);
    item->height_m = height.metres;
    item->has_height = rule->height.count > 0;
    item->width_m = width.metres;
    item->base_m = base.metres;
    item->is_gabled = rule->gabled.count > 0 && vector_conditions_hold(&rule->gabled, &c->tags);
    n->features++;
    n->odd += (uint64_t)height.is_odd + width.is_odd + base.is_odd;
    n->above_ground += base.metres > 0;
    n->heights[height.term]++;
}

static int take_item(struct vector_map *map, const struct vector_candidate *c, OGRGeometryH g)
{
    struct vector_item item = {.rule = &map->rules->items[c->rule], .geometry = g};
    if (!osm_room((void **)&map->items, &map->item_capacity, map->item_count + 1,
                  sizeof *map->items)) {
        OGR_G_DestroyGeometry(g);
        return hs_error(c->origin, "choose a smaller --area", "out of memory");
    }
    memcpy(item.origin, c->origin, sizeof item.origin);
    const struct vector_rule_counts before = map->counts[c->rule];
    measure(map, &item, c);
    item.cover = cover_of(map, &item);
    if (!item.cover && item.rule->detail == VECTOR_PLAIN) {
        map->counts[c->rule] = before;
        OGR_G_DestroyGeometry(g);
        return VECTOR_TOO_SMALL;
    }
    map->items[map->item_count++] = item;
    return VECTOR_MADE;
}

int vector_map_add(struct vector_map *map, const struct vector_candidate *c,
                   OGRCoordinateTransformationH to_plane, struct vector_census *census)
{
    const struct vector_rule *rule = &map->rules->items[c->rule];
    OGRGeometryH g = c->geometry;
    OGR_G_FlattenTo2D(g);
    if (rule->leave_out[0] || OGR_G_IsEmpty(g)) {
        OGR_G_DestroyGeometry(g);
        return rule->leave_out[0] ? VECTOR_LEFT_OUT : VECTOR_NO_AREA;
    }
    if (to_plane && OGR_G_Transform(g, to_plane) != OGRERR_NONE) {
        OGR_G_DestroyGeometry(g);
        return VECTOR_OUTSIDE; /* so far from the zone that it has no place in it */
    }
    if (!meets_plane(map, g)) {
        OGR_G_DestroyGeometry(g);
        return VECTOR_OUTSIDE;
    }
    if (rule->from == VECTOR_AREA) {
        g = valid_area(g, census);
    } else if (rule->from == VECTOR_LINE && !(OGR_G_Length(g) > 0)) {
        OGR_G_DestroyGeometry(g);
        g = NULL;
    }
    return g ? take_item(map, c, g) : VECTOR_NO_AREA;
}

/* ---- outlines and their parts ---- */

struct part {
    double x, y, area_m2;
    OGRGeometryH point; /* owned */
};

static int compare_parts(const void *a, const void *b)
{
    const struct part *p = a, *q = b;
    return (p->x > q->x) - (p->x < q->x);
}

static size_t first_part(const struct part *parts, size_t count, double x)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const bool is_before = parts[middle].x < x;
        low = is_before ? middle + 1 : low;
        high = is_before ? high : middle;
    }
    return low;
}

/* An outline whose parts are half of it or more is drawn as its parts. */
static bool has_parts(OGRGeometryH outline, const struct part *parts, size_t count)
{
    OGREnvelope e;
    double area_m2 = 0;
    OGR_G_GetEnvelope(outline, &e);
    for (size_t i = first_part(parts, count, e.MinX); i < count && parts[i].x <= e.MaxX; i++) {
        if (parts[i].y >= e.MinY && parts[i].y <= e.MaxY &&
            OGR_G_Contains(outline, parts[i].point)) {
            area_m2 += parts[i].area_m2;
        }
    }
    return area_m2 >= 0.5 * OGR_G_Area(outline);
}

static size_t gather_parts(const struct vector_map *map, struct part *parts)
{
    size_t count = 0;
    for (size_t i = 0; i < map->item_count; i++) {
        const struct vector_item *item = &map->items[i];
        OGRGeometryH point =
            item->rule->detail == VECTOR_PART ? OGR_G_PointOnSurface(item->geometry) : NULL;
        if (point) {
            parts[count++] = (struct part){OGR_G_GetX(point, 0), OGR_G_GetY(point, 0),
                                           OGR_G_Area(item->geometry), point};
        }
    }
    qsort(parts, count, sizeof *parts, compare_parts);
    return count;
}

static int replace_outlines(struct vector_map *map)
{
    struct part *parts = calloc(map->item_count + 1, sizeof *parts);
    if (!parts) {
        return hs_error("buildings", NULL, "out of memory");
    }
    const size_t count = gather_parts(map, parts);
    for (size_t i = 0; i < map->item_count && count > 0; i++) {
        struct vector_item *item = &map->items[i];
        if (item->rule->detail == VECTOR_BUILDING && has_parts(item->geometry, parts, count)) {
            item->is_replaced = true;
            map->counts[item->rule - map->rules->items].replaced++;
        }
    }
    for (size_t i = 0; i < count; i++) {
        OGR_G_DestroyGeometry(parts[i].point);
    }
    free(parts);
    return 0;
}

/* ---- burning ---- */

static int compare_covers(const void *a, const void *b)
{
    const struct vector_item *p = *(const struct vector_item *const *)a,
                             *q = *(const struct vector_item *const *)b;
    const int by_order = p->rule->order - q->rule->order;
    const int by_height = (p->height_m > q->height_m) - (p->height_m < q->height_m);
    /* Items lie in one array: of equals the later one is over the earlier. */
    return by_order ? by_order : by_height ? by_height : (p > q) - (p < q);
}

struct burning {
    OGRGeometryH *covers; /* in the order of burning; owned by the items */
    double *classes, *heights;
    int count;
};

static void sort_covers(struct vector_map *map, struct burning *b, struct vector_item **order)
{
    for (size_t i = 0; i < map->item_count; i++) {
        if (map->items[i].cover && !map->items[i].is_replaced) {
            order[b->count++] = &map->items[i];
        }
    }
    qsort(order, (size_t)b->count, sizeof(struct vector_item *), compare_covers);
    for (int i = 0; i < b->count; i++) {
        b->covers[i] = order[i]->cover;
        b->classes[i] = order[i]->rule->class_index;
        b->heights[i] = order[i]->has_height ? order[i]->height_m : -1;
    }
}

static int CPL_STDCALL on_progress(double share, const char *message, void *bar)
{
    (void)message;
    hs_progress_update(bar, (uint64_t)(1000 * share));
    return TRUE;
}

/* Burn into an array in memory, as a raster of GDAL's that lies over it. */
static int burn_plane(const struct vector_map *map, const struct burning *b, void *pixels,
                      GDALDataType type)
{
    const struct db_grid *g = &map->grid;
    double transform[6];
    int band = 1;
    memcpy(transform, g->geotransform, sizeof transform);
    GDALDatasetH raster =
        GDALCreate(GDALGetDriverByName("MEM"), "", g->width, g->height, 0, type, NULL);
    char address[32] = "", option[64];
    CPLPrintPointer(address, pixels, sizeof address - 1);
    snprintf(option, sizeof option, "DATAPOINTER=%s", address);
    char *options[] = {option, NULL};
    CPLErrorReset();
    bool is_burnt = raster && GDALAddBand(raster, type, options) == CE_None &&
                    GDALSetGeoTransform(raster, transform) == CE_None;
    struct hs_progress bar;
    hs_progress_begin(&bar, type == GDT_Byte ? "classes" : "heights", 1000);
    is_burnt = is_burnt && GDALRasterizeGeometries(raster, 1, &band, b->count, b->covers, NULL,
                                                   NULL, type == GDT_Byte ? b->classes : b->heights,
                                                   NULL, on_progress, &bar) == CE_None;
    hs_progress_end(&bar);
    if (raster) {
        GDALClose(raster);
    }
    return is_burnt ? 0
                    : hs_error("burning", "choose a smaller --area", "GDAL failed: %s",
                               db_gdal_complaint());
}

static int burn_covers(struct vector_map *map)
{
    const size_t n = map->item_count + 1;
    struct burning b = {.covers = malloc(n * sizeof(OGRGeometryH)),
                        .classes = malloc(n * sizeof(double)),
                        .heights = malloc(n * sizeof(double))};
    struct vector_item **order = malloc(n * sizeof(struct vector_item *));
    int result = 0;
    if (b.covers && b.classes && b.heights && order) {
        sort_covers(map, &b, order);
        if (b.count > 0 && (burn_plane(map, &b, map->classes, GDT_Byte) != 0 ||
                            burn_plane(map, &b, map->heights_m, GDT_Float32) != 0)) {
            result = -1;
        }
    } else {
        result = hs_error("burning", "choose a smaller --area", "out of memory");
    }
    free(b.covers);
    free(b.classes);
    free(b.heights);
    free(order);
    return result;
}

int vector_map_burn(struct vector_map *map)
{
    return replace_outlines(map) != 0 || coast_burn(map) != 0 ? -1 : burn_covers(map);
}

/* ---- report ---- */

static void print_row(const char *what, uint64_t count)
{
    if (count > 0) {
        printf("    %-28s %10" PRIu64 "\n", what, count);
    }
}

static void print_heights(const struct vector_rule *rule, const struct vector_rule_counts *n)
{
    for (int i = 0; i < rule->height.count; i++) {
        const struct vector_term *t = &rule->height.terms[i];
        char text[VECTOR_KEY_SIZE];
        if (!t->tag[0]) {
            snprintf(text, sizeof text, "no height, taken as %g m", t->factor);
        }
        print_row(t->tag[0] ? t->tag : text, n->heights[i]);
    }
}

static void report_rule(const struct vector_rule *rule, const struct vector_rule_counts *n)
{
    hs_report_object(NULL);
    hs_report_put("rule", rule->name);
    hs_report_put("features", n->features);
    hs_report_array("heights");
    for (int i = 0; i < rule->height.count; i++) {
        const struct vector_term *t = &rule->height.terms[i];
        hs_report_object(NULL);
        hs_report_put("tag", t->tag[0] ? (const char *)t->tag : NULL);
        hs_report_put("features", n->heights[i]);
        hs_report_close();
    }
    hs_report_close();
    hs_report_put("drawn_as_parts", n->replaced);
    hs_report_put("above_ground", n->above_ground);
    hs_report_put("with_a_bad_number", n->odd);
    hs_report_close();
}

void vector_map_print(const struct vector_map *map)
{
    hs_report_array("rules");
    for (int i = 0; i < map->rules->count; i++) {
        const struct vector_rule *rule = &map->rules->items[i];
        const struct vector_rule_counts *n = &map->counts[i];
        if (n->features == 0) {
            continue;
        }
        report_rule(rule, n);
        printf("rule %-27s %10" PRIu64 "\n", rule->name, n->features);
        print_heights(rule, n);
        print_row("drawn as their parts", n->replaced);
        print_row("above the ground, made on it", n->above_ground);
        print_row("with a number that is none", n->odd);
    }
    hs_report_close();
}
