#include "gis/plausible.h"

#include "gis/class_numbers.h"
#include "gis/gdal_start.h"
#include "gis/length_unit.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_MOST = 64, COLUMNS_MOST = 512, STRAY_VALUES_LEAST = 3 };

/* Land lies between the Dead Sea and Everest, sea beds reach -11 km. */
static const double lowest_m = -12000, highest_m = 9500;

/* ---- sample ---- */

int db_band_sample(struct db_band_sample *s, GDALRasterBandH band, const char *path, double scale)
{
    const int width = GDALGetRasterBandXSize(band), height = GDALGetRasterBandYSize(band);
    const int columns = width < COLUMNS_MOST ? width : COLUMNS_MOST;
    const int rows = height < ROWS_MOST ? height : ROWS_MOST;
    int has_nodata;
    const double nodata = GDALGetRasterNoDataValue(band, &has_nodata);
    *s = (struct db_band_sample){malloc((size_t)rows * (size_t)columns * sizeof(double)), 0};
    if (!s->values) {
        return hs_error(path, NULL, "out of memory");
    }
    for (int i = 0; i < rows; i++) {
        double *row = s->values + s->count;
        const int y = (int)((2.0 * i + 1) / (2.0 * rows) * height);
        CPLErrorReset();
        if (GDALRasterIO(band, GF_Read, 0, y, width, 1, row, columns, 1, GDT_Float64, 0, 0) !=
            CE_None) {
            db_band_sample_free(s);
            return hs_error(path, "the file may be cut short; fetch it again",
                            "cannot be read at row %d: %s", y, db_gdal_complaint());
        }
        for (int x = 0; x < columns; x++) {
            if (!isnan(row[x]) && !(has_nodata && row[x] == nodata)) {
                s->values[s->count++] = row[x] * scale;
            }
        }
    }
    return 0;
}

void db_band_sample_free(struct db_band_sample *s)
{
    free(s->values);
    *s = (struct db_band_sample){NULL, 0};
}

/* The share of values within low..high, in per cent. */
static double share_within(const struct db_band_sample *s, double low, double high)
{
    size_t within = 0;
    for (size_t i = 0; i < s->count; i++) {
        within += s->values[i] >= low && s->values[i] <= high;
    }
    return s->count ? 100.0 * (double)within / (double)s->count : 0;
}

static bool are_whole(const struct db_band_sample *s)
{
    for (size_t i = 0; i < s->count; i++) {
        if (s->values[i] != floor(s->values[i])) {
            return false;
        }
    }
    return s->count > 0;
}

/* A single value beyond the limits marks voids; several are data. */
static bool has_strays(const struct db_band_sample *s, double low, double high)
{
    double seen[STRAY_VALUES_LEAST];
    int count = 0;
    for (size_t i = 0; i < s->count && count < STRAY_VALUES_LEAST; i++) {
        int k = 0;
        while (k < count && seen[k] != s->values[i]) {
            k++;
        }
        if ((s->values[i] < low || s->values[i] > high) && k == count) {
            seen[count++] = s->values[i];
        }
    }
    return count == STRAY_VALUES_LEAST;
}

/* ---- what it seems to be ---- */

/* NULL: numbers. */
static const char *seems(GDALRasterBandH band)
{
    if (GDALDataTypeIsComplex(GDALGetRasterDataType(band))) {
        return "radar data before detection: its numbers are complex";
    }
    const GDALColorInterp colour = GDALGetRasterColorInterpretation(band);
    if (GDALGetRasterCategoryNames(band) || GDALGetMetadataItem(band, DB_CLASS_NAMES_ITEM, NULL)) {
        return "a class raster: its numbers have names";
    }
    if (colour == GCI_PaletteIndex || GDALGetRasterColorTable(band)) {
        return "a picture or a class raster: its numbers are colours of a palette";
    }
    return colour >= GCI_RedBand && colour <= GCI_BlueBand ? "a picture: its bands are colours"
                                                           : NULL;
}

static int doubt_kind(GDALRasterBandH band, const char *path, const char *wanted, bool is_trusted)
{
    const char *kind = seems(band);
    return kind ? hs_doubt(is_trusted, path, "give a raster of it", "is no %s but seems to be %s",
                           wanted, kind)
                : 0;
}

/* ---- terrain ---- */

static int judge_terrain(const struct db_band_sample *s, GDALRasterBandH band, const char *path,
                         double metres, bool is_trusted)
{
    int has_nodata;
    (void)GDALGetRasterNoDataValue(band, &has_nodata);
    const double strays = 100 - share_within(s, lowest_m, highest_m);
    if (strays > 1 && has_strays(s, lowest_m, highest_m)) {
        return hs_doubt(is_trusted, path, "name the unit with --terrain-unit, for example cm",
                        "%.1f %% of its heights lie nowhere on Earth, at %g m a unit", strays,
                        metres);
    }
    const double marks[] = {-9999, -32767};
    for (int i = 0; i < 2 && !has_nodata; i++) {
        const double mark = marks[i] * metres, share = share_within(s, mark, mark);
        if (share > 0) {
            return hs_doubt(is_trusted, path, "declare it with gdal_edit.py -a_nodata",
                            "%.1f %% of its posts are exactly %g, and it declares no nodata value",
                            share, marks[i]);
        }
    }
    return 0;
}

int db_plausible_terrain(GDALRasterBandH band, const char *path, double metres, bool is_trusted)
{
    struct db_band_sample s;
    if (doubt_kind(band, path, "terrain", is_trusted) != 0 ||
        db_band_sample(&s, band, path, metres) != 0) {
        return -1;
    }
    const int result = judge_terrain(&s, band, path, metres, is_trusted);
    db_band_sample_free(&s);
    return result;
}

/* ---- reflectivity ---- */

static int doubt_emptiness(const struct db_band_sample *s, const char *path, bool is_trusted)
{
    return s->count > 0 ? 0
                        : hs_doubt(is_trusted, path, "check it with gdalinfo -stats",
                                   "has no value at all in a sample of its pixels");
}

static int judge_reflectivity(const struct db_band_sample *s, const char *path, bool is_trusted)
{
    const char *remedy = "give gamma in dB, as `landmass-db reflect` writes it";
    const double beyond = 100 - share_within(s, -100, 60);
    if (s->count == 0) {
        return doubt_emptiness(s, path, is_trusted);
    }
    if (beyond > 0) {
        return hs_doubt(is_trusted, path, remedy,
                        "%.1f %% of its values lie beyond -100..60 dB, or are an undeclared nodata "
                        "value",
                        beyond);
    }
    return share_within(s, 0, 60) > 99.999
               ? hs_doubt(is_trusted, path, remedy, "has no value below 0 dB: %s",
                          are_whole(s) ? "whole numbers alone, as in a class raster"
                                       : "it may be linear power, or heights")
               : 0;
}

int db_plausible_reflectivity(GDALRasterBandH band, const char *path, bool is_trusted)
{
    struct db_band_sample s;
    if (doubt_kind(band, path, "reflectivity", is_trusted) != 0 ||
        db_band_sample(&s, band, path, 1) != 0) {
        return -1;
    }
    const int result = judge_reflectivity(&s, path, is_trusted);
    db_band_sample_free(&s);
    return result;
}

/* ---- radar imagery ---- */

/* Mean gamma0 of a scene: calm water returns about -30 dB and a town's middle about 0 dB. 10 dB
 * beyond both is left for other bands, polarisations and calibrations (UNSOURCED). */
static const double least_mean_db = -40, greatest_mean_db = 10;

static int doubt_mean(double mean_db, const char *unit, const char *path, bool is_trusted)
{
    return mean_db >= least_mean_db && mean_db <= greatest_mean_db
               ? 0
               : hs_doubt(is_trusted, path, "give calibrated gamma0 or sigma0, and its unit",
                          "has a mean of %.1f dB as %s, and ground returns %g to %g dB", mean_db,
                          unit, least_mean_db, greatest_mean_db);
}

/* Of the powers, as those of linear imagery: a few bright places must not hide in a mean of dB. */
static int judge_decibels(const struct db_band_sample *s, const char *path, bool is_trusted)
{
    double sum = 0;
    bool is_negative = false;
    for (size_t i = 0; i < s->count; i++) {
        sum += pow(10, s->values[i] / 10);
        is_negative = is_negative || s->values[i] < 0;
    }
    if (s->count > 0 && !is_negative) {
        return hs_doubt(is_trusted, path, "is it --radar-unit linear?",
                        "holds nothing below 0, as linear power does and dB of ground do not");
    }
    return s->count == 0 ? 0
                         : doubt_mean(10 * log10(sum / (double)s->count), "dB", path, is_trusted);
}

static int judge_powers(const struct db_band_sample *s, const char *path, bool is_trusted)
{
    const char *remedy = "give calibrated gamma0 or sigma0";
    double sum = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (s->values[i] < 0) {
            return 0;
        }
        sum += s->values[i];
    }
    if (are_whole(s)) {
        return hs_doubt(is_trusted, path, remedy,
                        "holds whole numbers alone, as a class raster or raw numbers do");
    }
    const double mean_db = s->count > 0 ? 10 * log10(sum / (double)s->count) : least_mean_db;
    return doubt_mean(mean_db, "linear power", path, is_trusted);
}

static int doubt_unit(GDALRasterBandH band, const char *path, bool is_trusted)
{
    double metres;
    const char *unit = GDALGetRasterUnitType(band);
    return unit[0] && db_length_unit(unit, &metres)
               ? hs_doubt(is_trusted, path, "give a raster of it",
                          "is no radar imagery but seems to be elevations: its unit is `%s`", unit)
               : 0;
}

int db_plausible_radar(GDALRasterBandH band, const char *path, bool is_linear, bool is_trusted)
{
    struct db_band_sample s;
    if (doubt_kind(band, path, "radar imagery", is_trusted) != 0 ||
        doubt_unit(band, path, is_trusted) != 0 || db_band_sample(&s, band, path, 1) != 0) {
        return -1;
    }
    const int result =
        is_linear ? judge_powers(&s, path, is_trusted) : judge_decibels(&s, path, is_trusted);
    db_band_sample_free(&s);
    return result;
}

/* ---- heights ---- */

static int compare_with_classes(const struct db_band_sample *s, const char *path,
                                GDALRasterBandH classes, bool is_trusted)
{
    struct db_band_sample c;
    if (db_band_sample(&c, classes, path, 1) != 0) {
        return -1;
    }
    const bool is_same = c.count > 0 && c.count == s->count &&
                         memcmp(c.values, s->values, c.count * sizeof *c.values) == 0;
    db_band_sample_free(&c);
    return is_same ? hs_doubt(is_trusted, path, "give heights above ground in metres",
                              "holds the same numbers as the class raster")
                   : 0;
}

static int judge_heights(const struct db_band_sample *s, const char *path, bool is_trusted)
{
    if (s->count == 0) {
        return doubt_emptiness(s, path, is_trusted);
    }
    const double below = share_within(s, -INFINITY, -2), above = share_within(s, 100, INFINITY);
    if (below > 5) {
        return hs_doubt(is_trusted, path, "give heights above ground in metres",
                        "%.1f %% of its values are below -2 m", below);
    }
    return above > 50
               ? hs_doubt(is_trusted, path, "subtract the terrain: heights are above ground",
                          "%.1f %% of its values are above 100 m, as elevations above the sea are",
                          above)
               : 0;
}

int db_plausible_heights(GDALRasterBandH band, const char *path, double metres,
                         GDALRasterBandH classes, bool is_trusted)
{
    struct db_band_sample s;
    if (doubt_kind(band, path, "raster of heights", is_trusted) != 0 ||
        db_band_sample(&s, band, path, metres) != 0) {
        return -1;
    }
    int result = compare_with_classes(&s, path, classes, is_trusted);
    if (result == 0) {
        result = judge_heights(&s, path, is_trusted);
    }
    db_band_sample_free(&s);
    return result;
}
