/* The options that say which image, shared by the sub-commands that read one. */
#ifndef DB_SOURCE_OPTIONS_H
#define DB_SOURCE_OPTIONS_H

#include "raster.h"

struct db_image_options {
    struct db_list paths;
    const char *nodata; /* NULL unless given */
    bool black_is_nodata;
};

/* Three entries for the table of a command. */
#define DB_IMAGE_OPTIONS(o)                                                                        \
    {.name = "image",                                                                              \
     .kind = DB_LIST,                                                                              \
     .target = &(o)->paths,                                                                        \
     .value_name = "FILE",                                                                         \
     .is_required = true,                                                                          \
     .help =                                                                                       \
         "The image: any raster GDAL reads. Repeat it, or separate files by commas, to stack "     \
         "bands\n"                                                                                 \
         "of several files; all must lie on one grid."},                                           \
        {.name = "nodata",                                                                         \
         .kind = DB_TEXT,                                                                          \
         .target = &(o)->nodata,                                                                   \
         .value_name = "V",                                                                        \
         .help = "Value that means no data, instead of what the files declare."},                  \
    {                                                                                              \
        .name = "black-is-nodata", .kind = DB_FLAG, .target = &(o)->black_is_nodata,               \
        .help = "Pixels that are 0 in all bands hold no data (holes of a mosaic)."                 \
    }

/* Open the image the options name. Returns 0, or -1 with the error reported. */
int db_image_open(struct db_raster *r, const struct db_image_options *options);

#endif
