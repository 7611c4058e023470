#include "gis/class_numbers.h"

#include "gis/band_walk.h"
#include "hs/error.h"
#include "hs/report.h"

#include <cpl_string.h>
#include <inttypes.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdlib.h>
#include <string.h>

/* ---- names ---- */

/* Names by number, from an attribute table with a column of names and one of numbers; the caller
 * frees them. NULL when there is none. */
static char **names_of_table(GDALRasterBandH band)
{
    const GDALRasterAttributeTableH table = GDALGetDefaultRAT(band);
    const int name = table ? GDALRATGetColOfUsage(table, GFU_Name) : -1;
    int value = table ? GDALRATGetColOfUsage(table, GFU_MinMax) : -1;
    value = value < 0 && table ? GDALRATGetColOfUsage(table, GFU_Min) : value;
    char **names = NULL;
    if (name < 0) {
        return NULL;
    }
    const char *by_number[256] = {NULL};
    for (int i = 0; i < GDALRATGetRowCount(table); i++) {
        const int number = value < 0 ? i : GDALRATGetValueAsInt(table, i, value);
        if (number >= 0 && number < 256) {
            by_number[number] = GDALRATGetValueAsString(table, i, name);
            /* The pointer lasts until the next call. */
            by_number[number] = CPLStrdup(by_number[number]);
        }
    }
    for (int i = 0; i < 256; i++) {
        names = CSLAddString(names, by_number[i] ? by_number[i] : "");
        CPLFree((void *)(uintptr_t)by_number[i]);
    }
    return names;
}

/* The caller frees them; NULL when the band names nothing. */
static char **names_of(GDALRasterBandH band)
{
    /* GDAL's GeoTIFF driver looks into the file beside it only when it is asked for the place. */
    const GDALDatasetH file = GDALGetBandDataset(band);
    double place[6];
    if (file) {
        GDALGetGeoTransform(file, place);
    }
    char **names = GDALGetRasterCategoryNames(band);
    if (names) {
        return CSLDuplicate(names);
    }
    const char *item = GDALGetMetadataItem(band, DB_CLASS_NAMES_ITEM, NULL);
    return item ? CSLTokenizeString2(item, ",", CSLT_ALLOWEMPTYTOKENS) : names_of_table(band);
}

static void match_names(struct db_class_numbers *n, char **names, const struct db_class_table *t)
{
    for (int i = 0; i < DB_CLASS_NODATA && names[i]; i++) {
        const int c = db_class_find(t, names[i]);
        n->class_of[i] = c < 0 ? DB_CLASS_UNKNOWN : (uint8_t)c;
        n->are_named = n->are_named || names[i][0];
    }
}

static void go_by_number(struct db_class_numbers *n, const struct db_class_table *t)
{
    for (int i = 0; i < t->count; i++) {
        n->class_of[i] = (uint8_t)i;
    }
}

/* ---- pixels ---- */

struct census {
    uint64_t counts[256], pixels;
    double nodata, stray; /* a value that is no class number; NAN when there is none */
    int has_nodata;
};

static bool count_pixels(void *context, const void *pixels, size_t count)
{
    struct census *c = context;
    const float *values = pixels;
    for (size_t i = 0; i < count; i++) {
        const float v = values[i];
        if (isnan(v) || (c->has_nodata && v == (float)c->nodata)) {
            c->counts[DB_CLASS_NODATA]++;
        } else if (v >= 0 && v <= 255 && v == floorf(v)) {
            c->counts[(int)v]++;
        } else {
            c->stray = (double)v;
        }
    }
    c->pixels += count;
    return isnan(c->stray);
}

static int count_band(struct census *c, GDALRasterBandH band, const char *path)
{
    *c = (struct census){.stray = (double)NAN};
    c->nodata = GDALGetRasterNoDataValue(band, &c->has_nodata);
    const struct db_band_walk walk = {GDT_Float32, "classes",
                                      "the file may be cut short; make it again", count_pixels, c};
    return db_band_walk(band, path, &walk);
}

/* ---- what they mean ---- */

static double share(const struct census *c, uint64_t count)
{
    return 100.0 * (double)count / (double)c->pixels;
}

/* Of a pixel in the middle of the raster; 0 where that is not known. */
static double pixel_km2(GDALRasterBandH band)
{
    const GDALDatasetH file = GDALGetBandDataset(band);
    const OGRSpatialReferenceH crs = file ? GDALGetSpatialRef(file) : NULL;
    double t[6];
    if (!crs || GDALGetGeoTransform(file, t) != CE_None) {
        return 0;
    }
    const double units2 = fabs(t[1] * t[5] - t[2] * t[4]);
    if (!OSRIsGeographic(crs)) {
        const double metres = OSRGetLinearUnits(crs, NULL);
        return units2 * metres * metres * 1e-6;
    }
    const double radians = OSRGetAngularUnits(crs, NULL), radius_km = 6371;
    const double middle = t[3] + 0.5 * t[4] * GDALGetRasterBandXSize(band) +
                          0.5 * t[5] * GDALGetRasterBandYSize(band);
    return units2 * radians * radians * radius_km * radius_km * cos(middle * radians);
}

static int say_assumption(const struct db_class_numbers *n, const struct census *c,
                          GDALRasterBandH band, const char *path, const struct db_class_table *t,
                          bool ignores_names)
{
    const double km2 = pixel_km2(band);
    hs_report_array("class_numbers_assumed");
    for (int i = 0; i < t->count; i++) {
        if (c->counts[i] > 0 && n->class_of[i] < DB_CLASS_UNKNOWN) {
            printf("class number %d is taken for %-16s %12" PRIu64 " pixels  %5.1f %%", i,
                   t->items[i].name, c->counts[i], share(c, c->counts[i]));
            hs_report_object(NULL);
            hs_report_put("class", i);
            hs_report_put("name", t->items[i].name);
            hs_report_put("pixels", c->counts[i]);
            hs_report_put("area_km2", km2 > 0 ? (double)c->counts[i] * km2 : (double)NAN);
            hs_report_close();
            printf(km2 > 0 ? "  %.3f km2\n" : "\n", (double)c->counts[i] * km2);
        }
    }
    hs_report_close();
    return hs_warn(path, "compare the areas printed; `landmass-db segment` writes the names",
                   "%s: its numbers are taken for places in the class table",
                   ignores_names ? "is not asked for its class names" : "names no classes");
}

static int refuse_name(const struct census *c, const char *path, const struct db_class_table *t,
                       const char *name, int number)
{
    char names[DB_CLASS_MAX * DB_NAME_SIZE];
    db_class_names(t, names, sizeof names);
    return hs_error(path,
                    "give the class table that the raster was made with, or --class-numbers to go "
                    "by the numbers",
                    "calls class %d `%s` (%" PRIu64
                    " pixels, %.1f %%), which the class table has not (it has %s)",
                    number, name, c->counts[number], share(c, c->counts[number]), names);
}

static int refuse_number(const struct census *c, const char *path, const struct db_class_table *t,
                         int number)
{
    char names[DB_CLASS_MAX * DB_NAME_SIZE];
    db_class_names(t, names, sizeof names);
    return hs_error(path, "give the class table that the raster was made with",
                    "holds class %d (%" PRIu64 " pixels), but the table ends at %d (%s)", number,
                    c->counts[number], t->count - 1, names);
}

static int judge(const struct db_class_numbers *n, const struct census *c, const char *path,
                 const struct db_class_table *t, char **names)
{
    if (!isnan(c->stray)) {
        return hs_error(path, "give the output of `landmass-db segment`, or whole numbers 0..255",
                        "holds the value %g, which is no class number", c->stray);
    }
    for (int i = 0; i < DB_CLASS_NODATA; i++) {
        if (c->counts[i] > 0 && n->class_of[i] == DB_CLASS_UNKNOWN) {
            const bool is_named = names && n->are_named && i < CSLCount(names) && names[i][0];
            return is_named ? refuse_name(c, path, t, names[i], i) : refuse_number(c, path, t, i);
        }
    }
    return 0;
}

/* The names, which the caller frees; NULL when the band has none or is not asked for them. */
static char **match_band(struct db_class_numbers *n, GDALRasterBandH band,
                         const struct db_class_table *table, bool ignores_names)
{
    memset(n->class_of, DB_CLASS_UNKNOWN, sizeof n->class_of);
    n->class_of[DB_CLASS_NODATA] = DB_CLASS_NODATA;
    n->are_named = false;
    char **names = ignores_names ? NULL : names_of(band);
    if (names) {
        match_names(n, names, table);
    }
    if (!n->are_named) {
        go_by_number(n, table);
    }
    return names;
}

void db_class_numbers_match(struct db_class_numbers *n, GDALRasterBandH band,
                            const struct db_class_table *table, bool ignores_names)
{
    CSLDestroy(match_band(n, band, table, ignores_names));
}

int db_class_numbers_read(struct db_class_numbers *n, GDALRasterBandH band, const char *path,
                          const struct db_class_table *table, bool ignores_names)
{
    struct census c;
    char **names = match_band(n, band, table, ignores_names);
    int result = count_band(&c, band, path) == 0 ? judge(n, &c, path, table, names) : -1;
    if (result == 0 && !n->are_named) {
        result = say_assumption(n, &c, band, path, table, ignores_names);
    }
    CSLDestroy(names);
    return result;
}
