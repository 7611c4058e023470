#include "gis/gdal_start.h"

#include <cpl_error.h>
#include <gdal.h>

enum { CACHE_BYTES = 128 << 20 };

void db_gdal_start(void)
{
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    GDALSetCacheMax64(CACHE_BYTES);
}

const char *db_gdal_complaint(void)
{
    const char *message = CPLGetLastErrorMsg();
    return message[0] ? message : "unknown cause";
}
