#include "vectors/source.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "osm_source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- other formats, by GDAL ---- */

static OGRCoordinateTransformationH to_degrees(OGRSpatialReferenceH crs)
{
    OGRSpatialReferenceH source = OSRClone(crs), degrees = OSRNewSpatialReference(NULL);
    OSRSetAxisMappingStrategy(source, OAMS_TRADITIONAL_GIS_ORDER);
    OSRSetAxisMappingStrategy(degrees, OAMS_TRADITIONAL_GIS_ORDER);
    OGRCoordinateTransformationH way = NULL;
    if (OSRImportFromEPSG(degrees, 4326) == OGRERR_NONE) {
        OSRSetAxisMappingStrategy(degrees, OAMS_TRADITIONAL_GIS_ORDER);
        way = OCTNewCoordinateTransformation(source, degrees);
    }
    OSRDestroySpatialReference(source);
    OSRDestroySpatialReference(degrees);
    return way;
}

static void widen(struct vector_source *s, double longitude, double latitude)
{
    if (!s->has_area) {
        s->area = (struct vector_area){latitude, longitude, latitude, longitude};
        s->has_area = true;
    }
    s->area.south = fmin(s->area.south, latitude);
    s->area.north = fmax(s->area.north, latitude);
    s->area.west = fmin(s->area.west, longitude);
    s->area.east = fmax(s->area.east, longitude);
}

static int find_area(struct vector_source *s)
{
    for (int i = 0; i < GDALDatasetGetLayerCount(s->file); i++) {
        OGRLayerH layer = GDALDatasetGetLayer(s->file, i);
        OGRSpatialReferenceH crs = OGR_L_GetSpatialRef(layer);
        OGREnvelope e;
        if (OGR_L_GetExtent(layer, &e, TRUE) != OGRERR_NONE) {
            continue;
        }
        if (!crs) {
            return hs_error(s->path, "give it one with ogr2ogr -a_srs",
                            "layer %s names no coordinate reference system", OGR_L_GetName(layer));
        }
        OGRCoordinateTransformationH way = to_degrees(crs);
        double x[4] = {e.MinX, e.MaxX, e.MinX, e.MaxX}, y[4] = {e.MinY, e.MinY, e.MaxY, e.MaxY};
        const bool is_place = way && OCTTransform(way, 4, x, y, NULL);
        OCTDestroyCoordinateTransformation(way);
        for (int k = 0; k < 4 && is_place; k++) {
            widen(s, x[k], y[k]);
        }
    }
    return 0;
}

enum { FIELDS_MAX = 256 };

/* Fields as tags; those without a value are left out. `layer` is one more tag. */
struct fields {
    const char *texts[2 * (FIELDS_MAX + 1)];
    char *values[FIELDS_MAX]; /* owned */
    int count;
};

static struct vector_tags read_fields(struct fields *f, OGRLayerH layer, OGRFeatureH feature)
{
    const int given = OGR_F_GetFieldCount(feature);
    f->count = 0;
    f->texts[0] = "layer";
    f->texts[1] = OGR_L_GetName(layer);
    for (int i = 0; i < given && f->count < FIELDS_MAX; i++) {
        if (OGR_F_IsFieldSetAndNotNull(feature, i)) {
            f->values[f->count] = strdup(OGR_F_GetFieldAsString(feature, i));
            f->texts[2 * f->count + 2] = OGR_Fld_GetNameRef(OGR_F_GetFieldDefnRef(feature, i));
            f->texts[2 * f->count + 3] = f->values[f->count] ? f->values[f->count] : "";
            f->count++;
        }
    }
    return (struct vector_tags){f->texts, (size_t)f->count + 1};
}

static void free_fields(struct fields *f)
{
    for (int i = 0; i < f->count; i++) {
        free(f->values[i]);
    }
}

static unsigned shape_of(OGRGeometryH g)
{
    switch (wkbFlatten(OGR_G_GetGeometryType(g))) {
    case wkbPoint:
        return 1u << VECTOR_POINT;
    case wkbLineString:
    case wkbMultiLineString:
        return 1u << VECTOR_LINE;
    case wkbPolygon:
    case wkbMultiPolygon:
        return 1u << VECTOR_AREA;
    default:
        return 0;
    }
}

static int add_feature(struct vector_source *s, struct vector_map *map, OGRLayerH layer,
                       OGRFeatureH feature, OGRCoordinateTransformationH way)
{
    OGRGeometryH given = OGR_F_GetGeometryRef(feature);
    if (!given || OGR_G_IsEmpty(given)) {
        return VECTOR_NO_AREA;
    }
    OGRGeometryH g = OGR_G_GetLinearGeometry(given, 0, NULL); /* arcs become chords */
    if (!g) {
        return VECTOR_NO_AREA;
    }
    struct fields *f = malloc(sizeof *f);
    if (!f) {
        OGR_G_DestroyGeometry(g);
        return hs_error(s->path, NULL, "out of memory");
    }
    struct vector_candidate c = {.geometry = g, .tags = read_fields(f, layer, feature)};
    c.rule = vector_rules_find(map->rules, shape_of(g), &c.tags);
    snprintf(c.origin, sizeof c.origin, "%.15s %lld", OGR_L_GetName(layer),
             (long long)OGR_F_GetFID(feature));
    int fate = VECTOR_NO_RULE;
    if (c.rule >= 0) {
        fate = vector_map_add(map, &c, way, &s->census);
    } else {
        OGR_G_DestroyGeometry(g);
    }
    free_fields(f);
    free(f);
    return fate;
}

static int add_layer(struct vector_source *s, struct vector_map *map, OGRLayerH layer)
{
    OGRCoordinateTransformationH way = vector_map_from(map, OGR_L_GetSpatialRef(layer), s->path);
    if (!way) {
        return -1;
    }
    struct hs_progress bar;
    uint64_t done = 0;
    int fate = 0;
    OGRFeatureH feature = NULL;
    hs_progress_begin(&bar, OGR_L_GetName(layer),
                      (uint64_t)fmax(1, (double)OGR_L_GetFeatureCount(layer, TRUE)));
    OGR_L_ResetReading(layer);
    CPLErrorReset();
    while (fate >= 0 && (feature = OGR_L_GetNextFeature(layer)) != NULL) {
        s->census.read[VECTOR_FEATURES]++;
        fate = add_feature(s, map, layer, feature, way);
        if (fate >= 0) {
            s->census.fates[VECTOR_FEATURES][fate]++;
        }
        OGR_F_Destroy(feature);
        hs_progress_update(&bar, ++done);
        CPLErrorReset();
    }
    hs_progress_end(&bar);
    OCTDestroyCoordinateTransformation(way);
    if (fate >= 0 && CPLGetLastErrorType() >= CE_Failure) {
        return hs_error(s->path, "get it again", "layer %s cannot be read to its end: %s",
                        OGR_L_GetName(layer), db_gdal_complaint());
    }
    return fate < 0 ? -1 : 0;
}

static int open_other(struct vector_source *s)
{
    CPLErrorReset();
    s->file = GDALOpenEx(s->path, GDAL_OF_VECTOR | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (!s->file) {
        return hs_error(s->path, "check the name and that `ogrinfo` can read it",
                        "cannot be opened as vectors: %s", db_gdal_complaint());
    }
    if (GDALDatasetGetLayerCount(s->file) == 0) {
        return hs_error(s->path, "give a file with vectors", "has no layer");
    }
    return find_area(s);
}

/* ---- all ---- */

static int open_osm(struct vector_source *s)
{
    s->store = calloc(1, sizeof *s->store);
    if (!s->store) {
        return hs_error(s->path, NULL, "out of memory");
    }
    if (osm_store_read(s->store, s->path) != 0) {
        return -1;
    }
    s->has_area = osm_source_area(s->store, &s->area);
    return 0;
}

int vector_source_open(struct vector_source *s, const char *path)
{
    *s = (struct vector_source){.path = path};
    const int result = osm_file_is_one(path) ? open_osm(s) : open_other(s);
    if (result != 0) {
        vector_source_close(s);
    }
    return result;
}

int vector_source_add(struct vector_source *s, struct vector_map *map)
{
    if (s->store) {
        return osm_source_add(s, map);
    }
    for (int i = 0; i < GDALDatasetGetLayerCount(s->file); i++) {
        if (add_layer(s, map, GDALDatasetGetLayer(s->file, i)) != 0) {
            return -1;
        }
    }
    return 0;
}

void vector_source_close(struct vector_source *s)
{
    if (s->store) {
        osm_store_free(s->store);
        free(s->store);
    }
    if (s->file) {
        GDALClose(s->file);
    }
    *s = (struct vector_source){.path = NULL};
}
