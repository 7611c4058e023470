/* Source options, which several sub-commands share: the image, the classes, the exemplars. */
#ifndef DB_SOURCE_OPTIONS_H
#define DB_SOURCE_OPTIONS_H

#include "gis/label_map.h"
#include "gis/raster.h"

struct db_image_options {
    struct hs_list paths;
    const char *nodata; /* NULL unless given */
    bool black_is_nodata;
};

/* Three entries for the table of a command. */
#define DB_IMAGE_OPTIONS(o)                                                                        \
    {.name = "image",                                                                              \
     .kind = HS_INPUTS,                                                                            \
     .target = &(o)->paths,                                                                        \
     .value_name = "FILE",                                                                         \
     .is_required = true,                                                                          \
     .help =                                                                                       \
         "The image: any raster GDAL reads. Repeat it, or separate files by commas, to stack "     \
         "bands\n"                                                                                 \
         "of several files; all must lie on one grid."},                                           \
        {.name = "nodata",                                                                         \
         .kind = HS_TEXT,                                                                          \
         .target = &(o)->nodata,                                                                   \
         .value_name = "V",                                                                        \
         .help = "Value that means no data, instead of what the files declare."},                  \
    {                                                                                              \
        .name = "black-is-nodata", .kind = HS_FLAG, .target = &(o)->black_is_nodata,               \
        .help = "Pixels that are 0 in all bands hold no data (holes of a mosaic)."                 \
    }

/* An entry for the table: the class table. `o` is a const char *. */
#define DB_CLASSES_OPTION(o)                                                                       \
    {                                                                                              \
        .name = "classes", .kind = HS_INPUT, .target = &(o), .value_name = "FILE",                 \
        .is_required = true, .help = "The class table."                                            \
    }

/* An entry for the table: go by the numbers of a class raster. `o` is a bool. */
#define DB_CLASS_NUMBERS_OPTION(o)                                                                 \
    {                                                                                              \
        .name = "class-numbers", .kind = HS_FLAG, .target = &(o),                                  \
        .help =                                                                                    \
            "Take the class raster's numbers for places in the class table, though the raster "    \
            "names its classes."                                                                   \
    }

/* Where the class of pixels is known: polygons or a raster of labels, NULL unless given. `field`
 * holds the default before. */
struct db_exemplar_options {
    const char *polygons, *field, *labels, *map;
    struct hs_list ignore; /* labels */
};

/* Five entries. */
#define DB_EXEMPLAR_OPTIONS(o)                                                                     \
    {.name = "exemplars",                                                                          \
     .kind = HS_INPUT,                                                                             \
     .target = &(o)->polygons,                                                                     \
     .value_name = "FILE",                                                                         \
     .help =                                                                                       \
         "Polygons of known class: any vector format OGR reads, or a TSV or CSV with a column "    \
         "`WKT`.\n"                                                                                \
         "Reprojected when file and image name different CRS. Pixels whose centre lies inside "    \
         "count."},                                                                                \
        {.name = "field",                                                                          \
         .kind = HS_TEXT,                                                                          \
         .target = &(o)->field,                                                                    \
         .value_name = "NAME",                                                                     \
         .help = "The polygons' field that holds the label; default `class`."},                    \
        {.name = "labels",                                                                         \
         .kind = HS_INPUT,                                                                         \
         .target = &(o)->labels,                                                                   \
         .value_name = "FILE",                                                                     \
         .help =                                                                                   \
             "Instead of --exemplars: a raster of label numbers over the same extent. Where it "   \
             "is finer\n"                                                                          \
             "than the image a pixel takes the most frequent label in it. Connected patches of "   \
             "one label\n"                                                                         \
             "take the place of polygons."},                                                       \
        {.name = "ignore",                                                                         \
         .kind = HS_LIST,                                                                          \
         .target = &(o)->ignore,                                                                   \
         .value_name = "LABEL",                                                                    \
         .help =                                                                                   \
             "Labels of what is not to be looked at, clouds say: pixels under such polygons "      \
             "belong to\n"                                                                         \
             "no class, whoever else claims them. Repeat it, or separate labels by commas."},      \
    {                                                                                              \
        .name = "map", .kind = HS_INPUT, .target = &(o)->map, .value_name = "FILE",                \
        .help =                                                                                    \
            "Lines of `source-label = class`. The class `ignore` is as --ignore. Labels it "       \
            "leaves "                                                                              \
            "out\n"                                                                                \
            "are counted. Without it "                                                             \
            "labels must be the names of classes."                                                 \
    }

/* Read the map and add the labels to be ignored. Returns 0, or -1 with the error reported. */
int db_exemplar_map_read(struct db_label_map *map, const struct db_exemplar_options *options,
                         const struct db_class_table *table);

/* Open the image the options name. Returns 0, or -1 with the error reported. */
int db_image_open(struct db_raster *r, const struct db_image_options *options);

#endif
