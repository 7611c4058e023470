#include "resample/georef.h"

#include "gis/gdal_start.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EDGE_SAMPLES = 33 };

static const double bam_to_degrees = 360.0 / 4294967296.0;

static OGRSpatialReferenceH new_wgs84(void)
{
    OGRSpatialReferenceH wgs84 = OSRNewSpatialReference(NULL);
    if (wgs84 && OSRImportFromEPSG(wgs84, 4326) != OGRERR_NONE) {
        OSRDestroySpatialReference(wgs84);
        return NULL;
    }
    if (wgs84) {
        OSRSetAxisMappingStrategy(wgs84, OAMS_TRADITIONAL_GIS_ORDER);
    }
    return wgs84;
}

/* Vertical part off: heights are taken as they are, above mean sea level. */
static OGRSpatialReferenceH horizontal_crs(GDALDatasetH dataset)
{
    const OGRSpatialReferenceH declared = GDALGetSpatialRef(dataset);
    OGRSpatialReferenceH crs = declared ? OSRClone(declared) : NULL;
    if (!crs) {
        return NULL;
    }
    OSRStripVertical(crs);
    OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
    return crs;
}

static bool is_wgs84_degrees(OGRSpatialReferenceH crs, OGRSpatialReferenceH wgs84)
{
    const char *const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
                                   "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS", NULL};
    return OSRIsGeographic(crs) && OSRIsSameEx(crs, wgs84, options);
}

static int open_transformations(struct resample_georef *g, const char *path)
{
    OGRSpatialReferenceH wgs84 = new_wgs84();
    if (!wgs84) {
        return hs_error("PROJ", "install proj-data or set PROJ_DATA", "knows no EPSG:4326: %s",
                        db_gdal_complaint());
    }
    int result = 0;
    if (!is_wgs84_degrees(g->crs, wgs84)) {
        g->from_wgs84 = OCTNewCoordinateTransformation(wgs84, g->crs);
        g->to_wgs84 = OCTNewCoordinateTransformation(g->crs, wgs84);
        if (!g->from_wgs84 || !g->to_wgs84) {
            result = hs_error(path, "bring it to another CRS with gdalwarp",
                              "its coordinate reference system cannot be reached from WGS-84: %s",
                              db_gdal_complaint());
        }
    }
    OSRDestroySpatialReference(wgs84);
    return result;
}

/* What follows from geotransform and size. */
static bool settle(struct resample_georef *g)
{
    const double *t = g->geotransform;
    g->centre_x = t[0] + g->width / 2.0 * t[1] + g->height / 2.0 * t[2];
    return GDALInvGeoTransform(g->geotransform, g->to_pixel);
}

int resample_georef_open(struct resample_georef *g, GDALDatasetH dataset, const char *path)
{
    *g = (struct resample_georef){.width = GDALGetRasterXSize(dataset),
                                  .height = GDALGetRasterYSize(dataset)};
    if (GDALGetGeoTransform(dataset, g->geotransform) != CE_None || !settle(g)) {
        return hs_error(path,
                        "add a geotransform with gdal_edit.py -a_ullr, or warp it with gdalwarp",
                        "says not where on Earth its pixels lie");
    }
    g->crs = horizontal_crs(dataset);
    if (!g->crs) {
        return hs_error(path, "add it with gdal_edit.py -a_srs EPSG:...",
                        "names no coordinate reference system");
    }
    if (open_transformations(g, path) != 0) {
        resample_georef_close(g);
        return -1;
    }
    g->is_geographic = OSRIsGeographic(g->crs);
    if (g->is_geographic) {
        const double radians = OSRGetAngularUnits(g->crs, NULL);
        g->longitude_span = 2.0 * 3.14159265358979323846 / radians;
        g->longitude_span = fabs(g->longitude_span - 360.0) < 1e-6 ? 360.0 : g->longitude_span;
    }
    return 0;
}

void resample_georef_close(struct resample_georef *g)
{
    if (g->from_wgs84) {
        OCTDestroyCoordinateTransformation(g->from_wgs84);
    }
    if (g->to_wgs84) {
        OCTDestroyCoordinateTransformation(g->to_wgs84);
    }
    if (g->crs) {
        OSRDestroySpatialReference(g->crs);
    }
    *g = (struct resample_georef){0};
}

void resample_georef_reframe(struct resample_georef *g, double x, double y, int width, int height)
{
    double *t = g->geotransform;
    const double origin[2] = {t[0] + x * t[1] + y * t[2], t[3] + x * t[4] + y * t[5]};
    t[0] = origin[0];
    t[3] = origin[1];
    g->width = width;
    g->height = height;
    settle(g);
}

/* The representative of longitude `x` nearest to `centre`. */
static double wrap_near(double x, double centre, double span)
{
    return x - span * floor((x - centre) / span + 0.5);
}

void resample_to_pixels(const struct resample_georef *g, size_t count, const double *latitude_bam,
                        const double *longitude_bam, double *x, double *y)
{
    for (size_t i = 0; i < count; i++) {
        x[i] = wrap_near(longitude_bam[i] * bam_to_degrees, 0.0, 360.0);
        y[i] = latitude_bam[i] * bam_to_degrees;
    }
    if (g->from_wgs84) {
        OCTTransformEx(g->from_wgs84, (int)count, x, y, NULL, NULL);
    }
    const double *t = g->to_pixel;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(x[i]) || !isfinite(y[i])) {
            x[i] = y[i] = (double)NAN;
            continue;
        }
        const double u = g->is_geographic ? wrap_near(x[i], g->centre_x, g->longitude_span) : x[i];
        const double v = y[i];
        x[i] = t[0] + u * t[1] + v * t[2];
        y[i] = t[3] + u * t[4] + v * t[5];
    }
}

/* Longitude and latitude in degrees of pixel positions; NaN where there is no such place. */
static void to_degrees(const struct resample_georef *g, size_t count, double *x, double *y)
{
    const double *t = g->geotransform;
    for (size_t i = 0; i < count; i++) {
        const double u = x[i], v = y[i];
        x[i] = t[0] + u * t[1] + v * t[2];
        y[i] = t[3] + u * t[4] + v * t[5];
    }
    if (g->to_wgs84) {
        OCTTransformEx(g->to_wgs84, (int)count, x, y, NULL, NULL);
    }
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(x[i]) || !isfinite(y[i]) || fabs(y[i]) > 90.0 + 1.0 / 60.0) {
            x[i] = y[i] = (double)NAN;
        }
    }
}

static bool holds_place(const struct resample_georef *g, double latitude_degrees)
{
    const double latitude = latitude_degrees / bam_to_degrees, longitude = 0.0;
    double x, y;
    resample_to_pixels(g, 1, &latitude, &longitude, &x, &y);
    return x >= 0.0 && x <= g->width && y >= 0.0 && y <= g->height;
}

struct bounds {
    double south, north, west, east; /* degrees; west and east around `middle` */
    double middle;
};

/* Widen the bounds by a lattice of samples over the whole raster. Returns how many were on Earth.
 */
static int sample_bounds(const struct resample_georef *g, struct bounds *b)
{
    int found = 0;
    for (int i = 0; i < EDGE_SAMPLES; i++) {
        double x[EDGE_SAMPLES], y[EDGE_SAMPLES];
        for (int j = 0; j < EDGE_SAMPLES; j++) {
            x[j] = g->width * (double)j / (EDGE_SAMPLES - 1);
            y[j] = g->height * (double)i / (EDGE_SAMPLES - 1);
        }
        to_degrees(g, EDGE_SAMPLES, x, y);
        for (int j = 0; j < EDGE_SAMPLES; j++) {
            if (isnan(x[j])) {
                continue;
            }
            const double longitude = g->to_wgs84 ? wrap_near(x[j], b->middle, 360.0) : x[j];
            b->south = fmin(b->south, y[j]);
            b->north = fmax(b->north, y[j]);
            b->west = fmin(b->west, longitude);
            b->east = fmax(b->east, longitude);
            found++;
        }
    }
    return found;
}

int resample_area(const struct resample_georef *g, struct image_area *area)
{
    double x = g->width / 2.0, y = g->height / 2.0;
    to_degrees(g, 1, &x, &y);
    struct bounds b = {91.0, -91.0, 1e9, -1e9, isnan(x) ? 0.0 : x};
    double latitude, longitude;
    if (sample_bounds(g, &b) == 0 || resample_pixel_bam(g, &latitude, &longitude) != 0) {
        return -1;
    }
    const bool has_north_pole = g->to_wgs84 && holds_place(g, 90.0);
    const bool has_south_pole = g->to_wgs84 && holds_place(g, -90.0);
    /* The edges bulge between the samples by less than this. */
    const int64_t margin = g->to_wgs84 ? (int64_t)latitude + 1 : 0;
    area->south = image_bam(has_south_pole ? -90.0 : fmax(b.south, -90.0)) - margin;
    area->north = image_bam(has_north_pole ? 90.0 : fmin(b.north, 90.0)) + margin;
    area->south = area->south < -IMAGE_BAM_QUARTER ? -IMAGE_BAM_QUARTER : area->south;
    area->north = area->north > IMAGE_BAM_QUARTER ? IMAGE_BAM_QUARTER : area->north;
    const bool is_round = has_north_pole || has_south_pole || b.east - b.west >= 360.0 - 1e-9;
    area->west = is_round ? 0 : (uint32_t)(image_bam(b.west) - margin);
    area->width = is_round ? IMAGE_BAM_ROUND : image_bam(b.east) - image_bam(b.west) + 2 * margin;
    return 0;
}

int resample_pixel_bam(const struct resample_georef *g, double *latitude, double *longitude)
{
    const double cx = g->width / 2.0, cy = g->height / 2.0;
    double x[3] = {cx - 0.5, cx + 0.5, cx - 0.5}, y[3] = {cy - 0.5, cy - 0.5, cy + 0.5};
    to_degrees(g, 3, x, y);
    const double middle = y[0];
    for (int i = 1; i < 3; i++) {
        x[i] = wrap_near(x[i], x[0], 360.0) - x[0];
        y[i] -= y[0];
    }
    /* On the ground, so that the two axes of a rotated raster can be told apart from its pixel's
     * sides. */
    const double narrowing = cos(middle * (3.14159265358979323846 / 180.0));
    const double along_x = hypot(x[1] * narrowing, y[1]), along_y = hypot(x[2] * narrowing, y[2]);
    const bool x_is_north = fabs(y[1]) > fabs(x[1] * narrowing);
    *latitude = (x_is_north ? along_x : along_y) / bam_to_degrees;
    *longitude = (x_is_north ? along_y : along_x) / narrowing / bam_to_degrees;
    return isfinite(*latitude) && isfinite(*longitude) && *latitude > 0 && *longitude > 0 ? 0 : -1;
}

static bool is_close(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance;
}

bool resample_is_aligned(const struct resample_georef *a, const struct resample_georef *b, int *x,
                         int *y)
{
    const double *s = a->geotransform, *t = b->geotransform;
    const double pixel = hypot(s[1], s[4]);
    const int extent = (a->width > b->width ? a->width : b->width) +
                       (a->height > b->height ? a->height : b->height);
    for (int i = 0; i < 6; i++) {
        if (i % 3 != 0 && !is_close(s[i], t[i], 0.01 * pixel / extent)) {
            return false;
        }
    }
    if (!OSRIsSame(a->crs, b->crs)) {
        return false;
    }
    const double origin_x = a->is_geographic ? wrap_near(t[0], s[0], a->longitude_span) : t[0];
    const double dx = a->to_pixel[0] + origin_x * a->to_pixel[1] + t[3] * a->to_pixel[2];
    const double dy = a->to_pixel[3] + origin_x * a->to_pixel[4] + t[3] * a->to_pixel[5];
    if (fabs(dx) > 1e8 || fabs(dy) > 1e8 || !is_close(dx, round(dx), 0.01) ||
        !is_close(dy, round(dy), 0.01)) {
        return false;
    }
    *x = (int)lround(dx);
    *y = (int)lround(dy);
    return true;
}
