#include "gis/band_walk.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/progress.h"

#include <stdlib.h>

enum { BLOCK_BYTES = 64 << 20 };

static int walk_rows(GDALRasterBandH band, const char *path, const struct db_band_walk *walk,
                     void *pixels, int block_rows)
{
    const int width = GDALGetRasterBandXSize(band), height = GDALGetRasterBandYSize(band);
    struct hs_progress bar;
    int result = 0;
    bool goes_on = true;
    hs_progress_begin(&bar, walk->label, (uint64_t)height);
    for (int y = 0; y < height && result == 0 && goes_on; y += block_rows) {
        const int rows = height - y < block_rows ? height - y : block_rows;
        CPLErrorReset();
        if (GDALRasterIO(band, GF_Read, 0, y, width, rows, pixels, width, rows, walk->type, 0, 0) !=
            CE_None) {
            result = hs_error(path, walk->remedy, "cannot be read at rows %d..%d: %s", y,
                              y + rows - 1, db_gdal_complaint());
        } else {
            goes_on = walk->take(walk->context, pixels, (size_t)width * (size_t)rows);
            hs_progress_update(&bar, (uint64_t)(y + rows));
        }
    }
    hs_progress_end(&bar);
    return result;
}

int db_band_walk(GDALRasterBandH band, const char *path, const struct db_band_walk *walk)
{
    const size_t row_bytes =
        (size_t)GDALGetRasterBandXSize(band) * (size_t)GDALGetDataTypeSizeBytes(walk->type);
    const int fit = (int)(BLOCK_BYTES / row_bytes), rows = fit > 0 ? fit : 1;
    void *pixels = malloc(row_bytes * (size_t)rows);
    if (!pixels) {
        return hs_error(path, NULL, "out of memory");
    }
    const int result = walk_rows(band, path, walk, pixels, rows);
    free(pixels);
    return result;
}
