#include "source_options.h"

#include "hs/error.h"

#include <stdlib.h>

int db_image_open(struct db_raster *r, const struct db_image_options *options)
{
    struct db_raster_options raster = {.paths = &options->paths,
                                       .black_is_nodata = options->black_is_nodata};
    if (options->nodata) {
        char *end;
        raster.has_nodata = true;
        raster.nodata = strtod(options->nodata, &end);
        if (end == options->nodata || *end != '\0') {
            return hs_error("--nodata", "give a number, or nan", "`%s` is not a number",
                            options->nodata);
        }
    }
    return db_raster_open(r, &raster);
}
