#include "gis/sieve.h"

#include "gis/gdal_start.h"
#include "hs/class_table.h"
#include "hs/error.h"

#include <gdal_alg.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>

enum { CONNECTEDNESS = 8, PIXELS_MAX = 1 << 20, MARGIN_LEAST = 256 };

/* Area of a pixel in the middle of the grid, m2; 0 when nothing tells. */
static double pixel_m2(const struct db_grid *grid)
{
    const double *t = grid->geotransform;
    if (!grid->has_geotransform || !grid->crs) {
        return 0;
    }
    const double area = fabs(t[1] * t[5] - t[2] * t[4]);
    if (OSRIsGeographic(grid->crs)) {
        const double radian = OSRGetAngularUnits(grid->crs, NULL);
        const double latitude = radian * (t[3] + t[4] * grid->width / 2 + t[5] * grid->height / 2);
        const double radius_m = 6371000;
        return area * radian * radian * radius_m * radius_m * fabs(cos(latitude));
    }
    const double metre = OSRGetLinearUnits(grid->crs, NULL);
    return area * metre * metre;
}

int db_sieve_pixels(const struct db_grid *grid, double speck_m2)
{
    const double area_m2 = pixel_m2(grid);
    return area_m2 > 0 ? (int)fmin(fmax(ceil(speck_m2 / area_m2), 1), PIXELS_MAX) : 1;
}

int db_sieve_margin(int pixels)
{
    const int64_t margin = 4 * (int64_t)pixels;
    return pixels <= 1 ? 0
           : margin <= MARGIN_LEAST
               ? MARGIN_LEAST
               : (int)((margin + MARGIN_LEAST - 1) / MARGIN_LEAST * MARGIN_LEAST);
}

/* A dataset over pixels of ours. */
static GDALDatasetH over(uint8_t *classes, int width, int rows)
{
    char name[64];
    char *options[] = {name, NULL};
    snprintf(name, sizeof name, "DATAPOINTER=%p", (void *)classes);
    GDALDatasetH d = GDALCreate(GDALGetDriverByName("MEM"), "", width, rows, 0, GDT_Byte, NULL);
    if (d && (GDALAddBand(d, GDT_Byte, options) != CE_None ||
              GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), DB_CLASS_NODATA) != CE_None)) {
        GDALClose(d);
        d = NULL;
    }
    return d;
}

int db_sieve(uint8_t *classes, int width, int rows, int pixels, const char *name)
{
    if (pixels <= 1) {
        return 0;
    }
    CPLErrorReset();
    const GDALDatasetH d = over(classes, width, rows);
    const GDALRasterBandH band = d ? GDALGetRasterBand(d, 1) : NULL;
    const CPLErr result = band ? GDALSieveFilter(band, GDALGetMaskBand(band), band, pixels,
                                                 CONNECTEDNESS, NULL, NULL, NULL)
                               : CE_Failure;
    if (d) {
        GDALFlushCache(d);
        GDALClose(d);
    }
    return result == CE_None ? 0
                             : hs_error(name, "free some memory, or give --sieve 0",
                                        "cannot be sieved: %s", db_gdal_complaint());
}
