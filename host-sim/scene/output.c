#include "scene/output.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/png.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdlib.h>
#include <unistd.h>

/* A raster to be written. Its first pixel's north-west corner lies at (-west_m, north_m) from the
 * centre of the scene. */
struct raster {
    int width, height, bands;
    GDALDataType type;
    const void *pixels; /* bands of a pixel beside each other */
    double cell_m, west_m, north_m;
    const char *compression;
    double nodata; /* NAN for none */
};

static GDALDatasetH create(const char *temporary, const struct raster *r)
{
    const char *const options[] = {r->compression, "TILED=YES", "BIGTIFF=IF_SAFER", NULL};
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), temporary, r->width, r->height,
                                      r->bands, r->type, (CSLConstList)options);
    OGRSpatialReferenceH srs = OSRNewSpatialReference(NULL);
    double transform[6] = {SCENE_EAST_M - r->west_m,   r->cell_m, 0,
                           SCENE_NORTH_M + r->north_m, 0,         -r->cell_m};
    if (dataset && (OSRImportFromEPSG(srs, SCENE_EPSG) != OGRERR_NONE ||
                    GDALSetSpatialRef(dataset, srs) != CE_None ||
                    GDALSetGeoTransform(dataset, transform) != CE_None)) {
        GDALClose(dataset);
        dataset = NULL;
    }
    OSRDestroySpatialReference(srs);
    return dataset;
}

static int name_bands(GDALDatasetH dataset, const struct raster *r, const char *const *names)
{
    for (int b = 0; b < r->bands; b++) {
        GDALRasterBandH band = GDALGetRasterBand(dataset, b + 1);
        GDALSetDescription(band, names[b]);
        if (!isnan(r->nodata) && GDALSetRasterNoDataValue(band, r->nodata) != CE_None) {
            return -1;
        }
    }
    return 0;
}

static int write_pixels(GDALDatasetH dataset, const struct raster *r)
{
    const int size = GDALGetDataTypeSizeBytes(r->type), pixel = size * r->bands;
    /* GDAL takes a pointer to void that it only reads from. */
    void *pixels = (void *)(uintptr_t)r->pixels;
    return GDALDatasetRasterIOEx(dataset, GF_Write, 0, 0, r->width, r->height, pixels, r->width,
                                 r->height, r->type, r->bands, NULL, pixel,
                                 (GSpacing)pixel * r->width, size, NULL) == CE_None
               ? 0
               : -1;
}

static int write_raster(const char *path, const struct raster *r, const char *const *names)
{
    char *temporary = hs_atomic_temporary_name(path);
    if (!temporary) {
        return -1;
    }
    CPLErrorReset();
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALDatasetH dataset = create(temporary, r);
    int failed = !dataset || name_bands(dataset, r, names) != 0 || write_pixels(dataset, r) != 0;
    if (dataset) {
        GDALClose(dataset);
    }
    CPLPopErrorHandler();
    failed = failed || CPLGetLastErrorType() >= CE_Failure;
    int result;
    if (failed) {
        result = hs_error(path, "check that the folder can be written and has space",
                          "cannot be written: %s", CPLGetLastErrorMsg());
        hs_atomic_drop(temporary);
    } else {
        result = hs_atomic_rename(temporary, path);
    }
    free(temporary);
    return result;
}

static struct raster on_image_grid(const struct scene *s)
{
    const double half_m = 0.5 * s->size * s->cell_m;
    return (struct raster){.width = s->size,
                           .height = s->size,
                           .bands = 1,
                           .cell_m = s->cell_m,
                           .west_m = half_m,
                           .north_m = half_m,
                           .compression = "COMPRESS=DEFLATE",
                           .nodata = NAN};
}

int output_image(const struct scene *s, const struct picture *p, const char *path)
{
    struct raster r = on_image_grid(s);
    const char *names[BAND_COUNT];
    for (int b = 0; b < BAND_COUNT; b++) {
        names[b] = material_band_name(b);
    }
    r.bands = BAND_COUNT;
    r.type = GDT_UInt16;
    r.pixels = p->image;
    r.nodata = 0;
    r.compression = "COMPRESS=NONE"; /* noise does not compress, and this is three times as fast */
    return write_raster(path, &r, names);
}

int output_truth(const struct scene *s, const struct picture *p, const char *path)
{
    struct raster r = on_image_grid(s);
    static const char *const names[] = {"class"};
    r.type = GDT_Byte;
    r.pixels = p->truth;
    r.nodata = 255;
    return write_raster(path, &r, names);
}

/* How many of the sub-pixels of a pixel belong to each class. */
static void count_shares(const struct canvas *c, int x, int y, uint8_t *shares)
{
    for (int k = 0; k < CANVAS_SUB * CANVAS_SUB; k++) {
        const int sub_x = CANVAS_SUB * x + k % CANVAS_SUB, sub_y = CANVAS_SUB * y + k / CANVAS_SUB;
        const size_t at = (size_t)sub_y * (size_t)c->side + (size_t)sub_x;
        shares[material_look((enum material)c->material[at])->group]++;
    }
}

int output_shares(const struct scene *s, const char *path)
{
    struct raster r = on_image_grid(s);
    const char *names[CLASS_COUNT];
    const size_t side = (size_t)s->size;
    uint8_t *shares = calloc(side * side, CLASS_COUNT);
    if (!shares) {
        return hs_error(path, "make the scene smaller", "out of memory");
    }
    for (int c = 0; c < CLASS_COUNT; c++) {
        names[c] = material_class_name((enum material_class)c);
    }
    for (size_t i = 0; i < side * side; i++) {
        count_shares(&s->canvas, (int)(i % side), (int)(i / side), shares + i * CLASS_COUNT);
    }
    r.bands = CLASS_COUNT;
    r.type = GDT_Byte;
    r.pixels = shares;
    const int result = write_raster(path, &r, names);
    free(shares);
    return result;
}

int output_heights(const struct scene *s, const struct picture *p, const char *path)
{
    struct raster r = on_image_grid(s);
    static const char *const names[] = {"height of structures and trees, m"};
    r.type = GDT_Float32;
    r.pixels = p->height_m;
    return write_raster(path, &r, names);
}

int output_terrain(const struct scene *s, const char *path)
{
    const struct land *l = &s->land;
    static const char *const names[] = {"elevation, m"};
    /* A post is the centre of its cell. */
    const struct raster r = {.width = l->posts,
                             .height = l->posts,
                             .bands = 1,
                             .type = GDT_Float32,
                             .pixels = l->height_m,
                             .cell_m = l->spacing_m,
                             .west_m = l->edge_m + 0.5 * l->spacing_m,
                             .north_m = l->edge_m + 0.5 * l->spacing_m,
                             .compression = "COMPRESS=DEFLATE",
                             .nodata = -32768};
    return write_raster(path, &r, names);
}

int output_geographic(const struct point *p, int count, double *longitude, double *latitude)
{
    OGRSpatialReferenceH utm = OSRNewSpatialReference(NULL), wgs84 = OSRNewSpatialReference(NULL);
    OGRCoordinateTransformationH way = NULL;
    if (OSRImportFromEPSG(utm, SCENE_EPSG) == OGRERR_NONE &&
        OSRImportFromEPSG(wgs84, 4326) == OGRERR_NONE) {
        OSRSetAxisMappingStrategy(utm, OAMS_TRADITIONAL_GIS_ORDER);
        OSRSetAxisMappingStrategy(wgs84, OAMS_TRADITIONAL_GIS_ORDER);
        way = OCTNewCoordinateTransformation(utm, wgs84);
    }
    for (int i = 0; i < count; i++) {
        land_from_design(p[i], &longitude[i], &latitude[i]);
        longitude[i] += SCENE_EAST_M;
        latitude[i] += SCENE_NORTH_M;
    }
    const int ok = way && OCTTransform(way, count, longitude, latitude, NULL);
    OCTDestroyCoordinateTransformation(way);
    OSRDestroySpatialReference(utm);
    OSRDestroySpatialReference(wgs84);
    return ok ? 0
              : hs_error("coordinates", "check that PROJ finds its database (proj.db)",
                         "cannot be converted to WGS 84: %s", CPLGetLastErrorMsg());
}

struct named_place {
    const char *name;
    struct point at;
};

static void print_scene(FILE *out, const struct scene *s)
{
    fprintf(out, "# The built-in scene of landmass: an invented place in the open Atlantic.\n");
    fprintf(out, "seed: %llu\n", (unsigned long long)s->seed);
    fprintf(out, "image: %d x %d pixels of %g m, %d bands of reflectance times 10000\n", s->size,
            s->size, s->cell_m, BAND_COUNT);
    fprintf(out, "terrain: %d x %d posts of %g m, metres above the sea\n", s->land.posts,
            s->land.posts, s->land.spacing_m);
    fprintf(out, "crs: EPSG:%d\n", SCENE_EPSG);
    fprintf(out, "lake level: %g m\n", s->land.lake_level_m);
    fprintf(out, "airfield elevation: %.1f m\n", s->land.airfield_level_m);
    fprintf(out, "classes of truth.tif:");
    for (int c = 0; c < CLASS_COUNT; c++) {
        fprintf(out, " %d %s%s", c, material_class_name((enum material_class)c),
                c + 1 < CLASS_COUNT ? "," : "\n");
    }
    fprintf(out, "# place latitude longitude (degrees, WGS 84) elevation (m)\n");
}

int output_description(const struct scene *s, const char *path)
{
    const struct frame field = land_airfield();
    const struct land *l = &s->land;
    const int valley = l->river_count / 2;
    const struct named_place places[] = {
        {"centre", {0, 0}},
        {"town", land_town()},
        {"harbour", {land_port().u - 350, land_port().v}},
        {"quay", land_port()},
        {"airfield", field.origin},
        {"runway-05", frame_point(&field, -1100, 0)},
        {"runway-23", frame_point(&field, 1100, 0)},
        {"lake", land_lake()},
        {"river-mouth", l->river[0]},
        {"river-valley", l->river[valley]},
        {"island", {-5150, 2350}},
    };
    enum { PLACES = sizeof places / sizeof *places };
    struct point at[PLACES];
    double longitude[PLACES], latitude[PLACES];
    for (int i = 0; i < PLACES; i++) {
        at[i] = places[i].at;
    }
    struct hs_atomic_file file;
    if (output_geographic(at, PLACES, longitude, latitude) != 0 ||
        hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    print_scene(file.stream, s);
    for (int i = 0; i < PLACES; i++) {
        fprintf(file.stream, "%s %.7f %.7f %.1f\n", places[i].name, latitude[i], longitude[i],
                land_at(l, l->height_m, at[i]));
    }
    return hs_atomic_commit(&file);
}

/* Points of the detail in degrees: middles and ends of lengths of the blocks, ends of the lines,
 * masts, ends of the strips, in this order. */
struct places {
    int count;
    struct point *at;
    double *longitude, *latitude;
};

static int locate(struct places *where, const struct detail *d, const char *path)
{
    where->count = 2 * d->block_count + 2 * d->line_count + d->mast_count + 2 * d->strip_count;
    const size_t room = (size_t)where->count + 1;
    where->at = calloc(room, sizeof *where->at);
    where->longitude = malloc(room * sizeof *where->longitude);
    where->latitude = malloc(room * sizeof *where->latitude);
    if (!where->at || !where->longitude || !where->latitude) {
        return hs_error(path, NULL, "out of memory");
    }
    struct point *next = where->at;
    for (int i = 0; i < d->block_count; i++) {
        *next++ = d->blocks[i].middle.origin;
        *next++ = frame_point(&d->blocks[i].middle, d->blocks[i].length_m / 2, 0);
    }
    for (int i = 0; i < d->line_count; i++) {
        *next++ = d->lines[i].from;
        *next++ = d->lines[i].to;
    }
    for (int i = 0; i < d->mast_count; i++) {
        *next++ = d->masts[i].at;
    }
    for (int i = 0; i < d->strip_count; i++) {
        *next++ = d->strips[i].from;
        *next++ = d->strips[i].to;
    }
    return output_geographic(where->at, where->count, where->longitude, where->latitude);
}

/* Azimuth from one point to the next, degrees. */
static double azimuth_deg(const struct places *where, int i)
{
    const double degree = 3.14159265358979323846 / 180;
    const double east =
        (where->longitude[i + 1] - where->longitude[i]) * cos(where->latitude[i] * degree);
    return fmod(atan2(east, where->latitude[i + 1] - where->latitude[i]) / degree + 360, 360);
}

static void print_detail(FILE *out, const struct detail *d, const struct places *where)
{
    static const char *const line_names[DETAIL_LINE_KINDS] = {"fence", "rail", "wire", "railing"};
    int n = 0;
    fprintf(out,
            "# The built-in scene of landmass: what stands on it, in degrees and metres.\n"
            "# building LATITUDE LONGITUDE LENGTH WIDTH TURN HEIGHT flat|gabled\n");
    for (int i = 0; i < d->block_count; i++, n += 2) {
        const struct detail_block *b = &d->blocks[i];
        const bool is_house = b->material == ROOF_TILE && b->height_m <= 10 && b->width_m <= 16;
        fprintf(out, "building %.7f %.7f %.1f %.1f %.2f %.1f %s\n", where->latitude[n],
                where->longitude[n], fmax(b->length_m, 0.1), fmax(b->width_m, 0.1),
                azimuth_deg(where, n), b->height_m, is_house ? "gabled" : "flat");
    }
    fprintf(out, "# line LATITUDE LONGITUDE LATITUDE LONGITUDE KIND\n");
    for (int i = 0; i < d->line_count; i++, n += 2) {
        fprintf(out, "line %.7f %.7f %.7f %.7f %s\n", where->latitude[n], where->longitude[n],
                where->latitude[n + 1], where->longitude[n + 1], line_names[d->lines[i].kind]);
    }
    fprintf(out, "# mast LATITUDE LONGITUDE HEIGHT\n");
    for (int i = 0; i < d->mast_count; i++, n++) {
        fprintf(out, "mast %.7f %.7f %.1f\n", where->latitude[n], where->longitude[n],
                d->masts[i].height_m);
    }
    fprintf(out, "# surface|verge LATITUDE LONGITUDE LATITUDE LONGITUDE WIDTH CLASS\n");
    for (int i = 0; i < d->strip_count; i++, n += 2) {
        const struct detail_strip *s = &d->strips[i];
        fprintf(out, "%s %.7f %.7f %.7f %.7f %.1f %s\n", s->is_verge ? "verge" : "surface",
                where->latitude[n], where->longitude[n], where->latitude[n + 1],
                where->longitude[n + 1], s->width_m, material_class_name(s->ground));
    }
}

int output_detail(const struct scene *s, const char *path)
{
    struct places where = {0};
    struct hs_atomic_file file;
    int result = locate(&where, &s->canvas.detail, path);
    if (result == 0) {
        result = hs_atomic_open(&file, path);
    }
    if (result == 0) {
        print_detail(file.stream, &s->canvas.detail, &where);
        result = hs_atomic_commit(&file);
    }
    free(where.at);
    free(where.longitude);
    free(where.latitude);
    return result;
}

static uint8_t tone(double value, double full)
{
    return (uint8_t)lround(255 * pow(fmin(fmax(value / full, 0), 1), 1 / 1.7));
}

int output_preview_image(const struct scene *s, const struct picture *p, const char *path)
{
    const size_t n = (size_t)s->size * (size_t)s->size;
    uint8_t *rgb = malloc(3 * n);
    if (!rgb) {
        return hs_error(path, NULL, "out of memory");
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t b = 0; b < 3; b++) {
            rgb[3 * i + b] = tone((double)p->image[i * BAND_COUNT + 2 - b] - 100, 3000);
        }
    }
    const int result = hs_png_write_rgb(path, rgb, s->size, s->size, 3 * (size_t)s->size);
    free(rgb);
    return result;
}

int output_preview_truth(const struct scene *s, const struct picture *p, const char *path)
{
    static const uint8_t colour[CLASS_COUNT][3] = {{176, 140, 90}, {96, 96, 104}, {208, 208, 200},
                                                   {216, 48, 40},  {48, 136, 48}, {32, 64, 160}};
    const size_t n = (size_t)s->size * (size_t)s->size;
    uint8_t *rgb = malloc(3 * n);
    if (!rgb) {
        return hs_error(path, NULL, "out of memory");
    }
    for (size_t i = 0; i < 3 * n; i++) {
        rgb[i] = colour[p->truth[i / 3]][i % 3];
    }
    const int result = hs_png_write_rgb(path, rgb, s->size, s->size, 3 * (size_t)s->size);
    free(rgb);
    return result;
}

int output_preview_terrain(const struct scene *s, const char *path)
{
    const struct land *l = &s->land;
    uint8_t *grey = malloc((size_t)l->posts * (size_t)l->posts);
    if (!grey) {
        return hs_error(path, NULL, "out of memory");
    }
    for (size_t i = 0; i < (size_t)l->posts * (size_t)l->posts; i++) {
        grey[i] = (uint8_t)fmin(255, 150 * (double)l->light[i]);
    }
    const int result = hs_png_write_grey(path, grey, l->posts, l->posts, (size_t)l->posts);
    free(grey);
    return result;
}
