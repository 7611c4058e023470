/* landmass-db mosaic: strips of a raster in, the raster out. */
#include "commands.h"
#include "cost.h"

#include "gis/gdal_start.h"
#include "gis/strips.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/options.h"
#include "hs/progress.h"
#include "hs/report.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_utils.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    "mosaic", "put strips of a raster together",
    "Takes the strips that `segment --shard` or `reflect --shard` made, in any order, and writes "
    "the raster\n"
    "that the same command makes in one go, byte for byte. A strip that is missing, given twice or "
    "of another\n"
    "raster is refused by its name.\n\n"
    "With an output whose name ends in .vrt no pixel is written: GDAL then reads the strips where "
    "they lie. Of\n"
    "such a raster `plan` knows which strips reach into a shard, and makes only those again.\n\n"
    "Example:\n"
    "  landmass-db mosaic --strip 0.tif --strip 1.tif --out classes.tif"};

struct strip {
    const char *path;  /* borrowed */
    GDALDatasetH file; /* owned */
    struct db_grid grid;
};

struct mosaic {
    struct hs_list paths;
    const char *out;
    struct strip *strips; /* owned, from the first rows to the last */
    long count;
    struct db_grid grid; /* of the whole; the CRS is the first strip's */
};

static GDALRasterBandH band_of(const struct strip *s)
{
    return GDALGetRasterBand(s->file, 1);
}

/* Open a strip and put it where its tag says. */
static int take(struct mosaic *m, const char *path)
{
    long number = -1, count = -1;
    CPLErrorReset();
    const GDALDatasetH file = db_gdal_note(GDALOpen(path, GA_ReadOnly));
    if (!file) {
        return hs_error(path, "check the name and that `gdalinfo` can read it",
                        "cannot be opened as an image: %s", db_gdal_complaint());
    }
    const char *tag = GDALGetMetadataItem(file, DB_STRIP_ITEM, NULL);
    const bool is_strip = tag && sscanf(tag, "%ld of %ld", &number, &count) == 2 && number >= 0 &&
                          number < count && count <= DB_STRIPS_MAX;
    if (is_strip && !m->strips) {
        m->strips = calloc((size_t)count, sizeof *m->strips);
        m->count = m->strips ? count : 0;
    }
    int result = 0;
    if (!is_strip) {
        result = hs_error(path, "give what `segment --shard` or `reflect --shard` wrote",
                          "is no strip of a raster");
    } else if (!m->strips) {
        result = hs_error(path, NULL, "out of memory");
    } else if (count != m->count) {
        result = hs_error(path, "give the strips of one raster",
                          "is one of %ld strips, and the others are of %ld", count, m->count);
    } else if (m->strips[number].file) {
        result = hs_error(path, "leave one of them out", "is strip %ld, and so is %s", number,
                          m->strips[number].path);
    }
    if (result != 0) {
        GDALClose(file);
        return result;
    }
    m->strips[number] = (struct strip){.path = path, .file = file};
    return 0;
}

static bool is_same_text(const char *a, const char *b)
{
    return strcmp(a ? a : "", b ? b : "") == 0;
}

/* All metadata but the tag. */
static char **metadata_of(const struct strip *s)
{
    return CSLSetNameValue(CSLDuplicate(GDALGetMetadata(s->file, NULL)), DB_STRIP_ITEM, NULL);
}

static bool are_same_lists(char **a, char **b)
{
    bool is_same = CSLCount(a) == CSLCount(b);
    for (int i = 0; is_same && i < CSLCount(a); i++) {
        is_same = is_same_text(a[i], b[i]);
    }
    return is_same;
}

static bool is_same_kind(const struct strip *a, const struct strip *b)
{
    int has_a, has_b;
    const double nodata_a = GDALGetRasterNoDataValue(band_of(a), &has_a);
    const double nodata_b = GDALGetRasterNoDataValue(band_of(b), &has_b);
    char **said_a = metadata_of(a), **said_b = metadata_of(b);
    const bool is_same =
        GDALGetRasterDataType(band_of(a)) == GDALGetRasterDataType(band_of(b)) && has_a == has_b &&
        (!has_a || !(nodata_a < nodata_b || nodata_a > nodata_b)) &&
        GDALGetRasterXSize(a->file) == GDALGetRasterXSize(b->file) &&
        is_same_text(GDALGetProjectionRef(a->file), GDALGetProjectionRef(b->file)) &&
        are_same_lists(said_a, said_b) &&
        are_same_lists(GDALGetMetadata(band_of(a), NULL), GDALGetMetadata(band_of(b), NULL));
    CSLDestroy(said_a);
    CSLDestroy(said_b);
    return is_same;
}

static void read_grid(struct strip *s)
{
    s->grid.width = GDALGetRasterXSize(s->file);
    s->grid.height = GDALGetRasterYSize(s->file);
    s->grid.has_geotransform = GDALGetGeoTransform(s->file, s->grid.geotransform) == CE_None;
    s->grid.crs = GDALGetSpatialRef(s->file);
}

static int check_strip(struct mosaic *m, long k)
{
    struct strip *s = &m->strips[k];
    if (!s->file) {
        return hs_error("--strip", "make it, and give all of them", "strip %ld of %ld is missing",
                        k, m->count);
    }
    read_grid(s);
    if (k == 0) {
        m->grid = s->grid;
        return 0;
    }
    struct db_grid wanted = db_strips_grid(
        &m->strips[0].grid, (struct db_rows){m->grid.height, m->grid.height + s->grid.height});
    const bool fits = is_same_kind(s, &m->strips[0]) && db_grid_is_same(&wanted, &s->grid) &&
                      m->grid.height % DB_STRIP_ROWS == 0;
    if (!fits) {
        return hs_error(s->path, "give the strips of one raster",
                        "does not go on where strip %ld (%s) ends, or has other classes or values",
                        k - 1, m->strips[k - 1].path);
    }
    if (s->grid.height > INT_MAX - m->grid.height) {
        return hs_error(s->path, NULL, "ends beyond row %d", INT_MAX);
    }
    m->grid.height += s->grid.height;
    return 0;
}

static int open_strips(struct mosaic *m)
{
    int result = 0;
    for (int i = 0; i < m->paths.count && result == 0; i++) {
        result = take(m, m->paths.items[i]);
    }
    for (long k = 0; k < m->count && result == 0; k++) {
        result = check_strip(m, k);
    }
    return result;
}

/* In the order in which `segment` and `reflect` say it. */
static void say_what_it_is(const struct strip *first, GDALDatasetH to)
{
    const GDALRasterBandH from = band_of(first), band = GDALGetRasterBand(to, 1);
    const GDALColorTableH colours = GDALGetRasterColorTable(from);
    char **said = metadata_of(first);
    if (colours) {
        GDALSetRasterColorTable(band, colours);
    }
    GDALSetRasterCategoryNames(band, GDALGetRasterCategoryNames(from));
    for (int i = 0; i < CSLCount(said); i++) {
        char *key = NULL;
        const char *value = CPLParseNameValue(said[i], &key);
        if (key && value && strcmp(key, "AREA_OR_POINT") != 0) {
            GDALSetMetadataItem(to, key, value, NULL);
        }
        CPLFree(key);
    }
    char **of_band = GDALGetMetadata(from, NULL);
    for (int i = 0; i < CSLCount(of_band); i++) {
        char *key = NULL;
        const char *value = CPLParseNameValue(of_band[i], &key);
        if (key && value) {
            GDALSetMetadataItem(band, key, value, NULL);
        }
        CPLFree(key);
    }
    CSLDestroy(said);
}

static int copy_strip(const struct strip *s, struct db_row_writer *writer, void *rows)
{
    const GDALDataType type = GDALGetRasterDataType(band_of(s));
    int result = 0;
    for (int y = 0; y < s->grid.height && result == 0; y += DB_STRIP_WRITE) {
        const int count = y + DB_STRIP_WRITE < s->grid.height ? DB_STRIP_WRITE : s->grid.height - y;
        CPLErrorReset();
        result = GDALRasterIO(band_of(s), GF_Read, 0, y, s->grid.width, count, rows, s->grid.width,
                              count, type, 0, 0) == CE_None
                     ? db_row_writer_add(writer, count, rows)
                     : hs_error(s->path, "make the strip again", "cannot be read at row %d: %s", y,
                                db_gdal_complaint());
    }
    return result;
}

static int copy_strips(struct mosaic *m, struct db_raster_out *out)
{
    struct db_row_writer writer = {0};
    struct hs_progress progress;
    int result = db_row_writer_init(&writer, out);
    void *rows = result == 0 ? malloc(DB_STRIP_WRITE * writer.row_bytes) : NULL;
    if (result == 0 && !rows) {
        result = hs_error(m->out, NULL, "out of memory");
    }
    hs_progress_begin(&progress, "mosaic", (uint64_t)m->count);
    for (long k = 0; k < m->count && result == 0; k++) {
        result = copy_strip(&m->strips[k], &writer, rows);
        hs_progress_update(&progress, (uint64_t)k + 1);
    }
    hs_progress_end(&progress);
    result = result == 0 ? db_row_writer_end(&writer) : result;
    free(rows);
    db_row_writer_free(&writer);
    return result;
}

static int write_whole(struct mosaic *m)
{
    const struct strip *first = &m->strips[0];
    struct db_raster_out out;
    const GDALDataType type = GDALGetRasterDataType(band_of(first));
    const double nodata = GDALGetRasterNoDataValue(band_of(first), NULL);
    if (db_raster_create(&out, m->out, &m->grid, type, nodata) != 0) {
        return -1;
    }
    say_what_it_is(first, out.dataset);
    const int result = copy_strips(m, &out) == 0 ? db_raster_commit(&out) : -1;
    db_raster_abort(&out);
    return result;
}

/* GDAL writes the names of the strips as they are seen from the folder of the file. */
static int write_virtual(const struct mosaic *m)
{
    GDALDatasetH *files = calloc((size_t)m->count, sizeof(GDALDatasetH));
    char *temporary = files ? hs_atomic_temporary_name(m->out) : NULL;
    for (long k = 0; files && k < m->count; k++) {
        files[k] = m->strips[k].file;
    }
    CPLErrorReset();
    const GDALDatasetH whole =
        temporary ? GDALBuildVRT(temporary, (int)m->count, files, NULL, NULL, NULL) : NULL;
    free(files);
    if (whole) {
        say_what_it_is(&m->strips[0], whole);
        GDALClose(whole);
    }
    int result = temporary ? 0 : -1;
    if (result == 0 && (!whole || CPLGetLastErrorType() >= CE_Failure)) {
        result = hs_error(m->out, "free some space and run again", "cannot be written: %s",
                          db_gdal_complaint());
        hs_atomic_drop(temporary);
    }
    result = result == 0 ? hs_atomic_rename(temporary, m->out) : result;
    free(temporary);
    return result;
}

static void close_strips(struct mosaic *m)
{
    for (long k = 0; k < m->count; k++) {
        if (m->strips[k].file) {
            GDALClose(m->strips[k].file);
        }
    }
    free(m->strips);
}

static int make(struct mosaic *m)
{
    const double start = db_cost_seconds();
    int result = open_strips(m);
    if (result == 0) {
        result = EQUAL(CPLGetExtension(m->out), "vrt") ? write_virtual(m) : write_whole(m);
    }
    if (result == 0) {
        printf("%s: %d x %d pixels of %ld strips\n", m->out, m->grid.width, m->grid.height,
               m->count);
        hs_report_put("width_px", m->grid.width);
        hs_report_put("height_px", m->grid.height);
        hs_report_put("strips", m->count);
        db_cost_report(db_cost_seconds() - start);
    }
    close_strips(m);
    return result;
}

int db_cmd_mosaic(int argc, char **argv)
{
    struct mosaic m = {.out = NULL};
    int exit_code;
    const struct hs_option options[] = {
        {"strip", HS_INPUTS, &m.paths, 0, 0, "FILE", "A strip. Repeat it, for each of them.", true},
        {"out", HS_OUTPUT, &m.out, 0, 0, "FILE", "Where the raster goes.", true},
    };
    if (hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                        &exit_code)) {
        exit_code = make(&m) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    hs_list_free(&m.paths);
    return exit_code;
}
