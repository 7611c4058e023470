/* landmass-db: from imagery, exemplars and terrain to the database image of the display unit. */
#include "commands.h"

#include "gis/gdal_start.h"
#include "hs/menu.h"

static const struct hs_command commands[] = {
    {"import", "look straight down on a visual database", db_cmd_import},
    {"train", "learn the classes of an image from exemplar pixels", db_cmd_train},
    {"segment", "give each pixel of an image its class", db_cmd_segment},
    {"correct", "apply manual corrections to a class raster", db_cmd_correct},
    {"vectors", "make classes, heights and detail of OpenStreetMap or other vectors",
     db_cmd_vectors},
    {"reflect", "give each pixel its radar reflectivity", db_cmd_reflect},
    {"mosaic", "put strips of a raster together", db_cmd_mosaic},
    {"infrared", "make thermal pictures of a class raster at hours of a day", db_cmd_infrared},
    {"build", "make the database image from classes, reflectivity and terrain", db_cmd_build},
    {"plan", "cut an image into shards that are made apart", db_cmd_plan},
    {"join", "make an image of the shards of a plan", db_cmd_join},
    {"inspect", "print what a database image holds", db_cmd_inspect},
    {"convert", "make an image of version 3 from one of version 2", db_cmd_convert},
    {"sign", "sign a database image with a key of Ed25519", db_cmd_sign},
    {"verify", "check every byte of a database image", db_cmd_verify},
    {"qgis", "make a QGIS project to draw exemplars and corrections in", db_cmd_qgis},
    {"export", "write the planes of a database image as GeoTIFF", db_cmd_export},
    {"picture", "draw a plane of a database image", db_cmd_picture},
};

int main(int argc, char **argv)
{
    const struct hs_menu menu = {.program = "landmass-db",
                                 .purpose = "build the radar database of the display unit",
                                 .commands = commands,
                                 .count = sizeof commands / sizeof commands[0],
                                 .start = db_gdal_start};
    return hs_menu_main(&menu, argc, argv);
}
