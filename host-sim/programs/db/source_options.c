#include "source_options.h"

#include "hs/error.h"
#include "hs/number.h"

#include <math.h>
#include <string.h>

int db_image_open(struct db_raster *r, const struct db_image_options *options)
{
    struct db_raster_options raster = {.paths = &options->paths,
                                       .black_is_nodata = options->black_is_nodata};
    if (options->nodata) {
        raster.has_nodata = true;
        raster.nodata = (double)NAN;
        if (strcmp(options->nodata, "nan") != 0 && !hs_number(options->nodata, &raster.nodata)) {
            return hs_error("--nodata", "give a number, or nan", "`%s` is not a number",
                            options->nodata);
        }
    }
    return db_raster_open(r, &raster);
}

int db_exemplar_map_read(struct db_label_map *map, const struct db_exemplar_options *options,
                         const struct db_class_table *table)
{
    int result = db_label_map_read(map, options->map, table);
    for (int i = 0; result == 0 && i < options->ignore.count; i++) {
        result = db_label_map_ignore(map, options->ignore.items[i]);
    }
    return result;
}
