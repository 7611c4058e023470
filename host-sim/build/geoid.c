#include "build/geoid.h"

#include "fx/crc32c.h"
#include "gis/gdal_start.h"
#include "gis/length_unit.h"
#include "hs/error.h"
#include "hs/report.h"
#include "resample/georef.h"

#include <inttypes.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SHIFT_LEAST = 20, /* 5.3' */
    PAGE_SHIFT = 23,  /* 0.7 degrees */
    PAGE_SIDE_LOG2 = PAGE_SHIFT + LM_GEOID_PAGE_LOG2,
    NODES2 = LM_GEOID_NODES_MAX * LM_GEOID_NODES_MAX
};

/* EGM96 lies between -107 and 86 m. */
static const double most_m = 120;

/* ---- where ---- */

/* Nodes from the one at or before `from` to the one at or behind the end. */
static uint8_t lay_out(int64_t from, int64_t length, int64_t *first, uint8_t *shift)
{
    for (*shift = SHIFT_LEAST;; ++*shift) {
        *first = from >> *shift;
        const int64_t last = (from + length + ((int64_t)1 << *shift) - 1) >> *shift;
        const int64_t nodes = last - *first + 1;
        const bool fits = nodes <= LM_GEOID_NODES_MAX && (nodes - 1) << *shift <= UINT32_MAX;
        if (fits || *shift == LM_GEOID_SHIFT_MAX) {
            return (uint8_t)(nodes < 2 ? 2 : fits ? nodes : LM_GEOID_NODES_MAX - 1);
        }
    }
}

static void place_nodes(struct lm_geoid *g, const struct image_area *area)
{
    int64_t south, west;
    g->rows = lay_out(area->south, area->north - area->south, &south, &g->latitude_shift);
    g->columns = lay_out(area->west, area->width, &west, &g->longitude_shift);
    south <<= g->latitude_shift;
    g->south = (uint32_t)(south < -IMAGE_BAM_QUARTER ? -IMAGE_BAM_QUARTER : south);
    g->west = (uint32_t)(west << g->longitude_shift);
}

/* ---- how high ---- */

/* Heights at `count` places of latitude and longitude in degrees; NAN where there is none. Returns
 * 0, or -1 with the error reported. */
static int heights_of_proj(size_t count, const double *latitude, const double *longitude, double *z)
{
    OGRSpatialReferenceH from = OSRNewSpatialReference(NULL), to = OSRNewSpatialReference(NULL);
    OSRSetFromUserInput(from, "EPSG:4326+5773");
    OSRSetFromUserInput(to, "EPSG:4979");
    OSRSetAxisMappingStrategy(from, OAMS_TRADITIONAL_GIS_ORDER);
    OSRSetAxisMappingStrategy(to, OAMS_TRADITIONAL_GIS_ORDER);
    OGRCoordinateTransformationOptionsH options = OCTNewCoordinateTransformationOptions();
    OCTCoordinateTransformationOptionsSetBallparkAllowed(options, FALSE);
    OGRCoordinateTransformationH way = OCTNewCoordinateTransformationEx(from, to, options);
    OCTDestroyCoordinateTransformationOptions(options);
    OSRDestroySpatialReference(from);
    OSRDestroySpatialReference(to);
    for (size_t i = 0; i < count; i++) {
        double x = longitude[i], y = latitude[i];
        int is_found = 0;
        z[i] = 0;
        if (!way || !OCTTransformEx(way, 1, &x, &y, &z[i], &is_found) || !is_found) {
            z[i] = (double)NAN;
        }
    }
    if (way) {
        OCTDestroyCoordinateTransformation(way);
    }
    return 0;
}

/* Bilinear between the middles of pixels, at the edge the pixel's own. */
static double raster_at(GDALRasterBandH band, double x, double y)
{
    const int width = GDALGetRasterBandXSize(band), height = GDALGetRasterBandYSize(band);
    int has_nodata;
    const double nodata = GDALGetRasterNoDataValue(band, &has_nodata);
    double sum = 0;
    if (!(x >= -0.5 && y >= -0.5 && x <= width + 0.5 && y <= height + 0.5)) {
        return (double)NAN;
    }
    const double u = floor(x - 0.5), v = floor(y - 0.5);
    for (int i = 0; i < 4; i++) {
        const int column = (int)fmin(fmax(u + i % 2, 0), width - 1);
        const int row = (int)fmin(fmax(v + i / 2, 0), height - 1);
        const double a = x - 0.5 - u, b = y - 0.5 - v;
        double value = (double)NAN;
        if (GDALRasterIO(band, GF_Read, column, row, 1, 1, &value, 1, 1, GDT_Float64, 0, 0) !=
                CE_None ||
            (has_nodata && value == nodata)) {
            return (double)NAN;
        }
        sum += (i % 2 ? a : 1 - a) * (i / 2 ? b : 1 - b) * value;
    }
    return sum;
}

static int heights_of_raster(const char *path, size_t count, const double *latitude,
                             const double *longitude, double *z)
{
    struct resample_georef georef;
    double metres = 1;
    CPLErrorReset();
    const GDALDatasetH file = db_gdal_note(GDALOpen(path, GA_ReadOnly));
    if (!file || GDALGetRasterCount(file) < 1) {
        return hs_error(path, "give egm96, or a raster of geoid heights",
                        "cannot be opened as a geoid: %s", db_gdal_complaint());
    }
    const GDALRasterBandH band = GDALGetRasterBand(file, 1);
    int result = resample_georef_open(&georef, file, path);
    if (result == 0) {
        result = db_band_unit(band, path, "gdal_edit.py -units", &metres);
        for (size_t i = 0; i < count && result == 0; i++) {
            const double y = latitude[i] / 360 * 4294967296.0;
            const double x = longitude[i] / 360 * 4294967296.0;
            double column, row;
            resample_to_pixels(&georef, 1, &y, &x, &column, &row);
            z[i] = metres * raster_at(band, column, row);
        }
        resample_georef_close(&georef);
    }
    GDALClose(file);
    return result;
}

/* ---- all of it ---- */

struct nodes {
    double latitude[NODES2], longitude[NODES2], z[NODES2];
    size_t count;
};

/* Nodes, or with `half` 0.5 the middles between them. */
static int find_heights(struct nodes *n, const struct lm_geoid *g, double half, const char *source)
{
    n->count = 0;
    for (int r = 0; r + half <= g->rows - 1; r++) {
        for (int c = 0; c + half <= g->columns - 1; c++) {
            const double north = ldexp(r + half, g->latitude_shift);
            const double east = ldexp(c + half, g->longitude_shift);
            n->latitude[n->count] = fmin(((int32_t)g->south + north) / 4294967296.0 * 360, 90);
            n->longitude[n->count++] = remainder((g->west + east) / 4294967296.0 * 360, 360);
        }
    }
    return strcmp(source, "egm96") == 0
               ? heights_of_proj(n->count, n->latitude, n->longitude, n->z)
               : heights_of_raster(source, n->count, n->latitude, n->longitude, n->z);
}

static int take_heights(struct lm_geoid *g, const struct nodes *n, const char *source)
{
    for (size_t i = 0; i < n->count; i++) {
        if (!(fabs(n->z[i]) <= most_m)) {
            return hs_error(
                source, "install the package proj-data, or give a raster that covers it",
                "has no height of the geoid at %.3f, %.3f", n->latitude[i], n->longitude[i]);
        }
        g->height_m_q6[i / g->columns][i % g->columns] = (int16_t)lround(64 * n->z[i]);
    }
    return 0;
}

static void say(const struct lm_geoid *g, const struct nodes *between, const char *source)
{
    double low = most_m, high = -most_m, off = 0;
    for (int i = 0; i < g->rows * g->columns; i++) {
        const double m = g->height_m_q6[i / g->columns][i % g->columns] / 64.0;
        low = fmin(low, m);
        high = fmax(high, m);
    }
    for (size_t i = 0; i < between->count; i++) {
        const struct lm_position at = {(uint32_t)image_bam(between->latitude[i]),
                                       (uint32_t)image_bam(between->longitude[i])};
        off = fmax(off, fabs(between->z[i] - lm_geoid_height_m_q6(g, at) / 64.0));
    }
    printf("geoid from %s: %u x %u nodes, %.1f to %.1f m, %.2f m off at most between them\n",
           source, g->rows, g->columns, low, high, off);
    hs_report_object("geoid_grid");
    hs_report_put("source", source);
    hs_report_put("rows", g->rows);
    hs_report_put("columns", g->columns);
    hs_report_put("least_m", low);
    hs_report_put("greatest_m", high);
    hs_report_put("error_m", off);
    hs_report_close();
}

int build_geoid_make(struct lm_geoid *g, const struct image_area *area, const char *source)
{
    struct nodes *n = malloc(sizeof *n);
    if (!n) {
        return hs_error("--geoid-grid", NULL, "out of memory");
    }
    *g = (struct lm_geoid){0};
    place_nodes(g, area);
    int result = find_heights(n, g, 0, source);
    if (result == 0) {
        result = take_heights(g, n, source);
    }
    if (result == 0) {
        result = find_heights(n, g, 0.5, source);
    }
    if (result == 0) {
        say(g, n, source);
    }
    free(n);
    return result;
}

/* ---- pages ---- */

static struct lm_geoid_pages_head lay_out_pages(const struct image_area *area)
{
    const int64_t south = area->south + IMAGE_BAM_QUARTER, north = area->north + IMAGE_BAM_QUARTER;
    const uint32_t row0 = (uint32_t)(south >> PAGE_SIDE_LOG2);
    const int64_t into_page = area->west & (((int64_t)1 << PAGE_SIDE_LOG2) - 1);
    const uint32_t columns = (uint32_t)((into_page + area->width - 1) >> PAGE_SIDE_LOG2) + 1;
    const uint32_t round = 1u << (32 - PAGE_SIDE_LOG2);
    struct lm_geoid_pages_head head = {
        .shift = PAGE_SHIFT,
        .row0 = row0,
        .rows = (uint32_t)((north - 1) >> PAGE_SIDE_LOG2) - row0 + 1,
        .column0 = area->west >> PAGE_SIDE_LOG2,
        .columns = columns < round ? columns : round,
    };
    head.crc = fx_crc32c(0, &head, offsetof(struct lm_geoid_pages_head, crc));
    return head;
}

/* Make page number `i`. Adds to *off what is lost between nodes at most, *n is work space. */
static int make_page(struct lm_geoid *page, const struct lm_geoid_pages_head *head, uint32_t i,
                     const struct lm_geoid *whole, const char *source, struct nodes *n, double *off)
{
    *page = (struct lm_geoid){
        .south = ((head->row0 + i / head->columns) << PAGE_SIDE_LOG2) - (1u << 30),
        .west = (head->column0 + i % head->columns) << PAGE_SIDE_LOG2,
        .latitude_shift = PAGE_SHIFT,
        .longitude_shift = PAGE_SHIFT,
        .rows = LM_GEOID_NODES_MAX,
        .columns = LM_GEOID_NODES_MAX,
    };
    if (find_heights(n, page, 0, source) != 0) {
        return -1;
    }
    for (size_t k = 0; k < n->count; k++) {
        const struct lm_position at = {(uint32_t)image_bam(n->latitude[k]),
                                       (uint32_t)image_bam(n->longitude[k])};
        n->z[k] = fabs(n->z[k]) <= most_m ? n->z[k] : lm_geoid_height_m_q6(whole, at) / 64.0;
    }
    if (take_heights(page, n, source) != 0 || find_heights(n, page, 0.5, source) != 0) {
        return -1;
    }
    for (size_t k = 0; k < n->count; k++) {
        const struct lm_position at = {(uint32_t)image_bam(n->latitude[k]),
                                       (uint32_t)image_bam(n->longitude[k])};
        const double miss_m = fabs(n->z[k] - lm_geoid_height_m_q6(page, at) / 64.0);
        *off = miss_m > *off ? miss_m : *off; /* not where the source has none */
    }
    page->crc = fx_crc32c(0, page, offsetof(struct lm_geoid, crc));
    return 0;
}

int build_geoid_pages_make(struct image_bytes *section, const struct lm_geoid *g,
                           const struct image_area *area, const char *source)
{
    *section = (struct image_bytes){0};
    if (g->latitude_shift <= PAGE_SHIFT && g->longitude_shift <= PAGE_SHIFT) {
        return 0;
    }
    const struct lm_geoid_pages_head head = lay_out_pages(area);
    const uint32_t count = head.rows * head.columns;
    const size_t bytes = sizeof head + count * sizeof(struct lm_geoid);
    uint8_t *data = malloc(bytes);
    struct nodes *n = malloc(sizeof *n);
    double off = 0;
    int result = data && n ? 0 : hs_error("--geoid-grid", NULL, "out of memory");
    for (uint32_t i = 0; i < count && result == 0; i++) {
        struct lm_geoid page;
        result = make_page(&page, &head, i, g, source, n, &off);
        memcpy(data + sizeof head + i * sizeof page, &page, sizeof page);
    }
    free(n);
    if (result != 0) {
        free(data);
        return -1;
    }
    memcpy(data, &head, sizeof head);
    *section = (struct image_bytes){data, bytes};
    printf("geoid pages: %" PRIu32 " of 33 x 33 nodes, %.2f m off at most between them\n", count,
           off);
    hs_report_object("geoid_pages");
    hs_report_put("pages", count);
    hs_report_put("error_m", off);
    hs_report_close();
    return 0;
}
