/* Rasters: several files read as one stack of bands on one grid, a few rows at a time, and files
 * written on the same grid. All pixels are read as float; the formats are those of GDAL. */
#ifndef GIS_RASTER_H
#define GIS_RASTER_H

#include "hs/options.h"

#include <gdal.h>
#include <stdbool.h>
#include <stdint.h>

/* How the files of a stack are to be taken. */
struct db_raster_options {
    const struct hs_list *paths; /* borrowed; at least one */
    bool has_nodata;             /* `nodata` replaces what the files declare, for all bands */
    double nodata;
    bool black_is_nodata; /* pixels that are 0 in all bands of the stack hold no data */
};

/* Where the pixels lie. */
struct db_grid {
    int width, height;
    bool has_geotransform;
    double geotransform[6];   /* pixel corner to CRS as in GDAL; identity when there is none */
    OGRSpatialReferenceH crs; /* owned; NULL when the files name none; axis order is x, y */
};

struct db_raster_band {
    GDALRasterBandH handle;
    bool has_nodata;
    double nodata;
    int file; /* which file it came from, 0.. */
};

struct db_raster {
    struct db_grid grid;
    struct db_raster_band *bands; /* owned */
    int band_count;
    GDALDatasetH *files; /* owned */
    int file_count;
    const char *name; /* the first path, for messages; borrowed */
    bool black_is_nodata;
};

/* Open the files in order; their bands follow each other. A missing geotransform or CRS is only
 * warned of. Returns 0, or -1 with the error reported and nothing to close:
 * - a file cannot be opened, or has no band of its own (a container of sub-datasets),
 * - the files differ in size, or in geotransform where both have one (by more than 1/1000 pixel),
 * - no memory. */
int db_raster_open(struct db_raster *r, const struct db_raster_options *options);

/* The same for one file taken as it is. */
int db_raster_open_one(struct db_raster *r, const char *path);

/* Harmless on a zeroed struct. */
void db_raster_close(struct db_raster *r);

/* Rows to read at a time so that `bytes_per_pixel` times the block stays within 64 MiB; at least 1.
 */
int db_raster_block_rows(const struct db_grid *grid, size_t bytes_per_pixel);

/* Read rows y .. y + rows - 1 of all bands. `pixels` holds band_count planes of rows * width;
 * `valid` (rows * width) becomes 1 or 0.
 *
 * A pixel holds no data in a file when every band of that file that declares a nodata value has it
 * there (a lone zero in one band of dark water is data), and in the stack when it holds none in any
 * of its files, or when any band is not a finite number. Returns 0, or -1 with the error (file and
 * row) reported. */
int db_raster_read(const struct db_raster *r, int y, int rows, float *pixels, uint8_t *valid);

/* Whether two grids are the same pixels: size and, where both have it, geotransform. */
bool db_grid_is_same(const struct db_grid *a, const struct db_grid *b);

/* A GeoTIFF being written under a temporary name. */
struct db_raster_out {
    GDALDatasetH dataset;
    char *path, *temporary; /* owned */
    int width;
    GDALDataType type;
};

/* Create a one-band, tiled, DEFLATE compressed GeoTIFF on `grid`. Returns 0, or -1 with the error
 * reported and nothing left. */
int db_raster_create(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                     GDALDataType type, double nodata);

/* The same with several bands, all of one type and nodata value. */
struct db_raster_kind {
    GDALDataType type;
    double nodata;
    int bands;
};
int db_raster_create_bands(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                           const struct db_raster_kind *kind);

/* `pixels` are rows * width values of the type given at creation, of the first band or of band
 * `number`, from 1. Return 0 or -1 with the error reported. */
int db_raster_write(struct db_raster_out *out, int y, int rows, const void *pixels);
int db_raster_write_band(struct db_raster_out *out, int number, int y, int rows,
                         const void *pixels);

/* Put the file in place. Returns 0, or -1 with the error reported and nothing left. */
int db_raster_commit(struct db_raster_out *out);

/* The same as a cloud-optimised GeoTIFF: tiles and overviews in the order in which readers fetch
 * them. `resampling` is GDAL's word for how overviews are made, NEAREST or AVERAGE. Needs room for
 * the file twice. */
int db_raster_commit_cog(struct db_raster_out *out, const char *resampling);

/* Forget the file. Harmless after a commit or a failed create. */
void db_raster_abort(struct db_raster_out *out);

#endif
