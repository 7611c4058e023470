#include "gis/strips.h"

#include "gis/gdal_start.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct db_rows db_rows_around(struct db_rows rows, int reach, const struct db_grid *grid)
{
    const int64_t first = (int64_t)rows.first - reach, end = (int64_t)rows.end + reach;
    return (struct db_rows){first > 0 ? (int)first : 0,
                            end < grid->height ? (int)end : grid->height};
}

const char *db_strips_fault(const struct db_strip_options *o, const char *out, const char **option)
{
    *option = "--shards";
    if (o->shards > 0 && o->shard < 0 && !o->plan) {
        return "needs --shard, which of them to make, or --plan";
    }
    *option = "--plan";
    if (o->plan && (out || o->shard >= 0)) {
        return "makes no raster: leave --out and --shard out";
    }
    *option = "--out";
    return o->plan || out ? NULL : "is missing: name the raster to write";
}

/* Multiples of DB_STRIP_ROWS, the last perhaps short. */
static int64_t bands_of(const struct db_grid *grid)
{
    return ((int64_t)grid->height + DB_STRIP_ROWS - 1) / DB_STRIP_ROWS;
}

static struct db_rows rows_of(const struct db_grid *grid, int64_t count, int64_t number)
{
    const int64_t bands = bands_of(grid);
    const int64_t end = (number + 1) * bands / count * DB_STRIP_ROWS;
    return (struct db_rows){(int)(number * bands / count * DB_STRIP_ROWS),
                            end < grid->height ? (int)end : grid->height};
}

int db_strips_rows(const struct db_strip_options *o, const struct db_grid *grid,
                   struct db_rows *rows)
{
    const int64_t bands = bands_of(grid);
    *rows = (struct db_rows){0, grid->height};
    if (o->shards <= 0) {
        return 0;
    }
    if (o->shards > bands) {
        return hs_error("--shards", "ask for fewer", "%ld strips of %d rows are more than %d rows",
                        o->shards, DB_STRIP_ROWS, grid->height);
    }
    if (o->shard >= o->shards) {
        return hs_error("--shard", NULL, "%ld is none of 0..%ld", o->shard, o->shards - 1);
    }
    *rows = o->shard >= 0 ? rows_of(grid, o->shards, o->shard) : *rows;
    return 0;
}

struct db_grid db_strips_grid(const struct db_grid *whole, struct db_rows rows)
{
    struct db_grid strip = *whole;
    strip.height = rows.end - rows.first;
    strip.geotransform[0] += rows.first * whole->geotransform[2];
    strip.geotransform[3] += rows.first * whole->geotransform[5];
    return strip;
}

void db_strips_tag(struct db_raster_out *out, const struct db_strip_options *o)
{
    char text[48];
    if (o->shards > 0) {
        snprintf(text, sizeof text, "%ld of %ld", o->shard, o->shards);
        GDALSetMetadataItem(out->dataset, DB_STRIP_ITEM, text, NULL);
    }
}

/* ---- the plan ---- */

/* Which rows of `grid` a file covers; all where it does not say. */
static struct db_rows rows_under(const struct db_grid *grid, const char *path)
{
    const struct db_rows all = {0, grid->height};
    double to_pixel[6], transform[6], low = INFINITY, high = -INFINITY;
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALDatasetH file = GDALOpen(path, GA_ReadOnly);
    CPLPopErrorHandler();
    const OGRSpatialReferenceH crs = file ? GDALGetSpatialRef(file) : NULL;
    const bool is_placed = file && GDALGetGeoTransform(file, transform) == CE_None &&
                           (!crs || !grid->crs || OSRIsSame(crs, grid->crs)) &&
                           GDALInvGeoTransform((double *)grid->geotransform, to_pixel);
    for (int corner = 0; is_placed && corner < 4; corner++) {
        double x, y, column, row;
        GDALApplyGeoTransform(transform, corner & 1 ? GDALGetRasterXSize(file) : 0,
                              corner & 2 ? GDALGetRasterYSize(file) : 0, &x, &y);
        GDALApplyGeoTransform(to_pixel, x, y, &column, &row);
        low = fmin(low, row);
        high = fmax(high, row);
    }
    if (file) {
        GDALClose(file);
    }
    if (!is_placed) {
        return all;
    }
    low = fmin(fmax(floor(low + 1e-3), 0), grid->height);
    high = fmin(fmax(ceil(high - 1e-3), 0), grid->height);
    return (struct db_rows){(int)low, (int)high};
}

struct source {
    char *path; /* owned */
    struct db_rows rows;
};

struct source_list {
    struct source *items; /* owned */
    size_t count;
};

static int add_source(struct source_list *list, const char *path, struct db_rows rows)
{
    struct source *items = realloc(list->items, (list->count + 1) * sizeof *items);
    if (!items) {
        return hs_error(path, NULL, "out of memory");
    }
    list->items = items;
    items[list->count] = (struct source){strdup(path), rows};
    return items[list->count].path ? (list->count++, 0) : hs_error(path, NULL, "out of memory");
}

static int add_dataset(struct source_list *list, GDALDatasetH dataset, const struct db_grid *grid)
{
    const bool is_virtual = EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(dataset)), "VRT");
    char **files = GDALGetFileList(dataset);
    int result = 0;
    for (int i = 0; files && files[i] && result == 0; i++) {
        if (db_gdal_is_data(files[i])) {
            const bool is_part = is_virtual && i > 0;
            result = add_source(list, files[i],
                                is_part ? rows_under(grid, files[i])
                                        : (struct db_rows){0, grid->height});
        }
    }
    CSLDestroy(files);
    return result;
}

static int find_sources(struct source_list *list, const struct db_grid *grid,
                        const struct db_strip_sources *s)
{
    int result = 0;
    for (int i = 0; i < s->raster_count; i++) {
        for (int k = 0; k < s->rasters[i]->file_count && result == 0; k++) {
            result = add_dataset(list, s->rasters[i]->files[k], grid);
        }
    }
    for (int i = 0; i < s->plain_count && result == 0; i++) {
        result = s->plain[i] ? add_source(list, s->plain[i], (struct db_rows){0, grid->height}) : 0;
    }
    return result;
}

static void print_plan(FILE *out, const struct db_strip_options *o, const struct db_grid *grid,
                       const struct source_list *list, int reach)
{
    fprintf(out, "landmass strips 1\nraster %d %d\n", grid->width, grid->height);
    for (long k = 0; k < o->shards; k++) {
        const struct db_rows own = rows_of(grid, o->shards, k);
        const struct db_rows seen = db_rows_around(own, reach, grid);
        fprintf(out, "strip %ld %d %d\n", k, own.first, own.end);
        for (size_t i = 0; i < list->count; i++) {
            const struct source *s = &list->items[i];
            if (s->rows.first < seen.end && s->rows.end > seen.first) {
                fprintf(out, "source %ld %s\n", k, s->path);
            }
        }
    }
}

int db_strips_write_plan(const struct db_strip_options *o, const struct db_grid *grid,
                         const struct db_strip_sources *sources)
{
    struct source_list list = {NULL, 0};
    struct hs_atomic_file file;
    int result = find_sources(&list, grid, sources);
    if (result == 0) {
        result = hs_atomic_open(&file, o->plan);
        if (result == 0) {
            print_plan(file.stream, o, grid, &list, sources->reach);
            result = hs_atomic_commit(&file);
            hs_atomic_abort(&file);
        }
    }
    for (size_t i = 0; i < list.count; i++) {
        free(list.items[i].path);
    }
    free(list.items);
    return result;
}

/* ---- writing ---- */

int db_row_writer_init(struct db_row_writer *w, struct db_raster_out *out)
{
    const size_t bytes = (size_t)out->width * (size_t)GDALGetDataTypeSizeBytes(out->type);
    *w = (struct db_row_writer){
        .out = out, .row_bytes = bytes, .held = malloc(DB_STRIP_WRITE * bytes)};
    return w->held ? 0 : hs_error(out->path, NULL, "out of memory");
}

/* The order of the file's tiles is then that of the rows, whatever GDAL's cache holds besides. */
int db_row_writer_end(struct db_row_writer *w)
{
    if (w->count == 0) {
        return 0;
    }
    const int result = db_raster_write(w->out, w->next - w->count, w->count, w->held);
    w->count = 0;
    CPLErrorReset();
    GDALFlushRasterCache(GDALGetRasterBand(w->out->dataset, 1));
    return result != 0 || CPLGetLastErrorType() < CE_Failure
               ? result
               : hs_error(w->out->path, "free some space and run again", "cannot be written: %s",
                          db_gdal_complaint());
}

int db_row_writer_add(struct db_row_writer *w, int rows, const void *pixels)
{
    int result = 0;
    for (int i = 0; i < rows && result == 0; i++) {
        memcpy(w->held + (size_t)w->count * w->row_bytes,
               (const uint8_t *)pixels + (size_t)i * w->row_bytes, w->row_bytes);
        w->count++;
        w->next++;
        result = w->count == DB_STRIP_WRITE ? db_row_writer_end(w) : 0;
    }
    return result;
}

void db_row_writer_free(struct db_row_writer *w)
{
    free(w->held);
    *w = (struct db_row_writer){.held = NULL};
}
