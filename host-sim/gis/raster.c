#include "gis/raster.h"

#include "gis/gdal_start.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

#include <cpl_string.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { BLOCK_BYTES = 64 << 20 };

static void read_grid(struct db_grid *grid, GDALDatasetH file)
{
    grid->width = GDALGetRasterXSize(file);
    grid->height = GDALGetRasterYSize(file);
    grid->has_geotransform = GDALGetGeoTransform(file, grid->geotransform) == CE_None;
    if (!grid->has_geotransform) {
        memcpy(grid->geotransform, (double[6]){0, 1, 0, 0, 0, 1}, sizeof grid->geotransform);
    }
    const OGRSpatialReferenceH crs = GDALGetSpatialRef(file);
    grid->crs = crs ? OSRClone(crs) : NULL;
    if (grid->crs) {
        OSRSetAxisMappingStrategy(grid->crs, OAMS_TRADITIONAL_GIS_ORDER);
    }
}

/* Corners of the two grids closer than 1/1000 pixel. */
static bool is_same_place(const struct db_grid *a, const struct db_grid *b)
{
    for (int corner = 0; corner < 4; corner++) {
        const double x = corner & 1 ? a->width : 0, y = corner & 2 ? a->height : 0;
        double apart[2], pixel = 0;
        for (int i = 0; i < 2; i++) {
            const double *ga = a->geotransform + 3 * i, *gb = b->geotransform + 3 * i;
            apart[i] = ga[0] + x * ga[1] + y * ga[2] - gb[0] - x * gb[1] - y * gb[2];
            pixel = fmax(pixel, fabs(ga[1]) + fabs(ga[2]));
        }
        if (!(hypot(apart[0], apart[1]) < 1e-3 * pixel)) {
            return false;
        }
    }
    return true;
}

bool db_grid_is_same(const struct db_grid *a, const struct db_grid *b)
{
    return a->width == b->width && a->height == b->height &&
           (!a->has_geotransform || !b->has_geotransform || is_same_place(a, b));
}

static int take_bands(struct db_raster *r, int file, const struct db_raster_options *options)
{
    const int count = GDALGetRasterCount(r->files[file]);
    struct db_raster_band *bands =
        realloc(r->bands, (size_t)(r->band_count + count) * sizeof *bands);
    if (!bands) {
        return hs_error(options->paths->items[file], NULL, "out of memory");
    }
    r->bands = bands;
    for (int i = 1; i <= count; i++) {
        struct db_raster_band *band = &r->bands[r->band_count++];
        int declared = 0;
        band->handle = GDALGetRasterBand(r->files[file], i);
        band->nodata = GDALGetRasterNoDataValue(band->handle, &declared);
        band->has_nodata = declared;
        band->file = file;
        if (options->has_nodata) {
            band->has_nodata = true;
            band->nodata = options->nodata;
        }
    }
    return 0;
}

/* Take the place of the first file that has one; the others must agree with it. */
static int join_grid(struct db_grid *all, struct db_grid *one, const char *first, const char *path)
{
    const bool fits = db_grid_is_same(all, one);
    if (fits && !all->has_geotransform && one->has_geotransform) {
        all->has_geotransform = true;
        memcpy(all->geotransform, one->geotransform, sizeof all->geotransform);
    }
    if (!all->crs) {
        all->crs = one->crs;
    } else if (one->crs) {
        OSRDestroySpatialReference(one->crs);
    }
    one->crs = NULL;
    if (!fits) {
        return hs_error(path, "bring all bands to one grid first, for example with gdalwarp",
                        "lies on another grid (%d x %d pixels) than %s (%d x %d)", one->width,
                        one->height, first, all->width, all->height);
    }
    return 0;
}

static int open_file(struct db_raster *r, int file, const struct db_raster_options *options)
{
    const char *path = options->paths->items[file];
    const unsigned flags = GDAL_OF_RASTER | GDAL_OF_READONLY;
    CPLErrorReset();
    r->files[file] = GDALOpenEx(path, flags, NULL, NULL, NULL);
    db_gdal_note(r->files[file]);
    if (!r->files[file]) {
        return hs_error(path, "check the name and that `gdalinfo` can read it",
                        "cannot be opened as an image: %s", db_gdal_complaint());
    }
    r->file_count = file + 1;
    if (GDALGetRasterCount(r->files[file]) < 1) {
        return hs_error(path, "name one of its sub-datasets, as `gdalinfo` lists them",
                        "holds no bands of its own");
    }
    struct db_grid grid;
    read_grid(&grid, r->files[file]);
    if (file == 0) {
        r->grid = grid;
    } else if (join_grid(&r->grid, &grid, r->name, path) != 0) {
        return -1;
    }
    return take_bands(r, file, options);
}

int db_raster_open(struct db_raster *r, const struct db_raster_options *options)
{
    *r = (struct db_raster){.name = options->paths->items[0],
                            .black_is_nodata = options->black_is_nodata};
    r->files = calloc((size_t)options->paths->count, sizeof(GDALDatasetH));
    if (!r->files) {
        return hs_error(r->name, NULL, "out of memory");
    }
    for (int i = 0; i < options->paths->count; i++) {
        if (open_file(r, i, options) != 0) {
            db_raster_close(r);
            return -1;
        }
    }
    if (!r->grid.has_geotransform) {
        hs_warn(r->name, "`build` will need it; here pixels are the coordinates",
                "has no georeferencing");
    } else if (!r->grid.crs) {
        hs_warn(r->name, "`build` will need it; add it with gdal_edit.py -a_srs",
                "names no coordinate reference system");
    }
    return 0;
}

int db_raster_open_one(struct db_raster *r, const char *path)
{
    struct hs_list list = {.items = {(char *)path}, .count = 1};
    const struct db_raster_options options = {.paths = &list};
    return db_raster_open(r, &options);
}

void db_raster_close(struct db_raster *r)
{
    for (int i = 0; i < r->file_count; i++) {
        GDALClose(r->files[i]);
    }
    if (r->grid.crs) {
        OSRDestroySpatialReference(r->grid.crs);
    }
    free(r->files);
    free(r->bands);
    *r = (struct db_raster){0};
}

int db_raster_block_rows(const struct db_grid *grid, size_t bytes_per_pixel)
{
    const size_t rows = BLOCK_BYTES / (bytes_per_pixel * (size_t)grid->width + 1);
    if (rows < 1) {
        return 1;
    }
    return rows < (size_t)grid->height ? (int)rows : grid->height;
}

/* Mark in `missing` the pixels where every band of `file` that declares a nodata value has it. */
static void mark_missing(const struct db_raster *r, int file, const float *pixels, size_t count,
                         uint8_t *missing)
{
    bool any = false;
    memset(missing, 1, count);
    for (int b = 0; b < r->band_count; b++) {
        const struct db_raster_band *band = &r->bands[b];
        if (band->file != file || !band->has_nodata || isnan(band->nodata)) {
            continue; /* A NaN is no data everywhere, declared or not. */
        }
        any = true;
        const float nodata = (float)band->nodata;
        const float *plane = pixels + (size_t)b * count;
        for (size_t i = 0; i < count; i++) {
            missing[i] &= plane[i] == nodata;
        }
    }
    if (!any) {
        memset(missing, 0, count);
    }
}

static void clear_not_finite(const struct db_raster *r, float *pixels, size_t count, uint8_t *valid)
{
    for (int b = 0; b < r->band_count; b++) {
        float *plane = pixels + (size_t)b * count;
        for (size_t i = 0; i < count; i++) {
            if (!isfinite(plane[i])) {
                plane[i] = 0;
                valid[i] = 0;
            }
        }
    }
}

static void clear_black(const struct db_raster *r, const float *pixels, size_t count,
                        uint8_t *scratch, uint8_t *valid)
{
    memset(scratch, 1, count);
    for (int b = 0; b < r->band_count; b++) {
        for (size_t i = 0; i < count; i++) {
            scratch[i] &= pixels[(size_t)b * count + i] == 0.0f;
        }
    }
    for (size_t i = 0; i < count; i++) {
        valid[i] &= !scratch[i];
    }
}

static int find_valid(const struct db_raster *r, float *pixels, size_t count, uint8_t *valid)
{
    uint8_t *scratch = malloc(count);
    if (!scratch) {
        return hs_error(r->name, NULL, "out of memory");
    }
    memset(valid, 1, count);
    for (int file = 0; file < r->file_count; file++) {
        mark_missing(r, file, pixels, count, scratch);
        for (size_t i = 0; i < count; i++) {
            valid[i] &= !scratch[i];
        }
    }
    clear_not_finite(r, pixels, count, valid);
    if (r->black_is_nodata) {
        clear_black(r, pixels, count, scratch, valid);
    }
    free(scratch);
    return 0;
}

int db_raster_read(const struct db_raster *r, int y, int rows, float *pixels, uint8_t *valid)
{
    const int width = r->grid.width;
    const size_t count = (size_t)rows * (size_t)width;
    for (int b = 0; b < r->band_count; b++) {
        CPLErrorReset();
        if (GDALRasterIO(r->bands[b].handle, GF_Read, 0, y, width, rows, pixels + (size_t)b * count,
                         width, rows, GDT_Float32, 0, 0) != CE_None) {
            return hs_error(r->name, "the file may be cut short; fetch it again",
                            "band %d cannot be read at rows %d..%d: %s", b + 1, y, y + rows - 1,
                            db_gdal_complaint());
        }
    }
    return find_valid(r, pixels, count, valid);
}

static GDALDatasetH create_dataset(const char *temporary, const struct db_grid *grid,
                                   GDALDataType type, int bands)
{
    char **options = NULL;
    options = CSLSetNameValue(options, "COMPRESS", "DEFLATE");
    options = CSLSetNameValue(options, "TILED", "YES");
    options = CSLSetNameValue(options, "BIGTIFF", "IF_SAFER");
    GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("GTiff"), temporary, grid->width,
                                      grid->height, bands, type, options);
    CSLDestroy(options);
    return dataset;
}

int db_raster_create(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                     GDALDataType type, double nodata)
{
    return db_raster_create_bands(out, path, grid, &(struct db_raster_kind){type, nodata, 1});
}

int db_raster_create_bands(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                           const struct db_raster_kind *kind)
{
    const GDALDataType type = kind->type;
    *out = (struct db_raster_out){.width = grid->width, .type = type};
    out->temporary = hs_atomic_temporary_name(path);
    if (!out->temporary) {
        return -1;
    }
    out->path = strdup(path);
    CPLErrorReset();
    out->dataset = out->path ? create_dataset(out->temporary, grid, type, kind->bands) : NULL;
    if (!out->dataset) {
        hs_error(path, "check that the folder exists and can be written", "cannot be created: %s",
                 db_gdal_complaint());
        db_raster_abort(out);
        return -1;
    }
    if (grid->has_geotransform) {
        GDALSetGeoTransform(out->dataset, (double *)grid->geotransform);
    }
    if (grid->crs) {
        GDALSetSpatialRef(out->dataset, grid->crs);
    }
    for (int b = 1; b <= kind->bands; b++) {
        GDALSetRasterNoDataValue(GDALGetRasterBand(out->dataset, b), kind->nodata);
    }
    return 0;
}

int db_raster_write(struct db_raster_out *out, int y, int rows, const void *pixels)
{
    return db_raster_write_band(out, 1, y, rows, pixels);
}

int db_raster_write_band(struct db_raster_out *out, int number, int y, int rows, const void *pixels)
{
    const GDALRasterBandH band = GDALGetRasterBand(out->dataset, number);
    CPLErrorReset();
    if (GDALRasterIO(band, GF_Write, 0, y, out->width, rows, (void *)pixels, out->width, rows,
                     out->type, 0, 0) != CE_None) {
        return hs_error(out->path, "free some space and run again", "cannot be written: %s",
                        db_gdal_complaint());
    }
    return 0;
}

/* GDAL keeps what TIFF has no place for, such as category names, in a file beside it. */
static char *side_name(const char *path)
{
    char *name = NULL;
    return asprintf(&name, "%s.aux.xml", path) < 0 ? NULL : name;
}

static int rename_or_remove(const char *from, const char *to)
{
    if (access(from, F_OK) == 0) {
        return hs_atomic_rename(from, to);
    }
    hs_atomic_remove(to); /* It belonged to the file that is replaced. */
    return 0;
}

static int rename_side_file(const struct db_raster_out *out)
{
    char *from = side_name(out->temporary), *to = side_name(out->path);
    const int result =
        from && to ? rename_or_remove(from, to) : hs_error(out->path, NULL, "out of memory");
    free(from);
    free(to);
    return result;
}

static void drop_temporary(struct db_raster_out *out)
{
    char *side = side_name(out->temporary);
    hs_atomic_drop(out->temporary);
    if (side) {
        hs_atomic_drop(side);
    }
    free(side);
    free(out->temporary);
    out->temporary = NULL;
}

/* GDALClose of this version returns nothing: a full disk shows only as a complaint. */
static int finish(struct db_raster_out *out)
{
    CPLErrorReset();
    GDALClose(out->dataset);
    out->dataset = NULL;
    return CPLGetLastErrorType() < CE_Failure
               ? 0
               : hs_error(out->path, "free some space and run again", "cannot be written: %s",
                          db_gdal_complaint());
}

static int put_in_place(struct db_raster_out *out)
{
    const int result = rename_side_file(out);
    return result == 0 ? hs_atomic_rename(out->temporary, out->path) : result;
}

/* A copy of the dataset under another temporary name, which takes the place of the first. */
static int copy_as_cog(struct db_raster_out *out, const char *resampling)
{
    char *name = NULL, **options = NULL;
    char *copy = asprintf(&name, "%s.cog", out->path) < 0 ? NULL : hs_atomic_temporary_name(name);
    options = CSLSetNameValue(options, "COMPRESS", "DEFLATE");
    options = CSLSetNameValue(options, "BLOCKSIZE", "256");
    options = CSLSetNameValue(options, "BIGTIFF", "IF_SAFER");
    options = CSLSetNameValue(options, "RESAMPLING", resampling);
    const GDALDatasetH from = GDALOpen(out->temporary, GA_ReadOnly);
    if (copy && from) {
        out->dataset =
            GDALCreateCopy(GDALGetDriverByName("COG"), copy, from, 0, options, NULL, NULL);
    }
    if (from) {
        GDALClose(from);
    }
    CSLDestroy(options);
    free(name);
    drop_temporary(out);
    out->temporary = copy;
    return out->dataset ? finish(out)
                        : hs_error(out->path, "free some space and run again",
                                   "cannot be written: %s", db_gdal_complaint());
}

int db_raster_commit(struct db_raster_out *out)
{
    const int result = finish(out) == 0 ? put_in_place(out) : -1;
    db_raster_abort(out);
    return result;
}

int db_raster_commit_cog(struct db_raster_out *out, const char *resampling)
{
    const int result =
        finish(out) == 0 && copy_as_cog(out, resampling) == 0 ? put_in_place(out) : -1;
    db_raster_abort(out);
    return result;
}

void db_raster_abort(struct db_raster_out *out)
{
    if (out->dataset) {
        GDALClose(out->dataset);
    }
    if (out->temporary) {
        drop_temporary(out);
    }
    free(out->path);
    *out = (struct db_raster_out){0};
}
