#include "gis/sieve.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/progress.h"

#include <gdal_alg.h>
#include <math.h>
#include <ogr_srs_api.h>

enum { CONNECTEDNESS = 8, PIXELS_MAX = 1 << 20, PROGRESS_STEPS = 1000 };

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

static int show(double share, const char *message, void *progress)
{
    (void)message;
    hs_progress_update(progress, (uint64_t)(share * PROGRESS_STEPS));
    return 1;
}

int db_sieve(struct db_raster_out *to, const struct db_raster_out *from, int pixels)
{
    const GDALRasterBandH source = GDALGetRasterBand(from->dataset, 1);
    struct hs_progress progress;
    CPLErrorReset();
    hs_progress_begin(&progress, "sieve", PROGRESS_STEPS);
    const CPLErr result =
        GDALSieveFilter(source, GDALGetMaskBand(source), GDALGetRasterBand(to->dataset, 1), pixels,
                        CONNECTEDNESS, NULL, show, &progress);
    hs_progress_end(&progress);
    if (result != CE_None) {
        return hs_error(to->path, "free some space and memory, or give --sieve 0",
                        "cannot be sieved: %s", db_gdal_complaint());
    }
    return 0;
}
