/* QGIS: styles (.qml) and projects (.qgs) in its XML, so that rasters and polygons of ours open
 * there with the colours and names of the class table, and polygons are drawn with a list of its
 * classes.
 *
 * A style beside a file of the same name is taken by QGIS by itself. Elements are those that QGIS
 * 3.22 reads: `pipe`, `renderer-v2`, `fieldConfiguration`, `projectlayers`. */
#ifndef GIS_QGIS_H
#define GIS_QGIS_H

#include "gis/raster.h"
#include "hs/class_table.h"

enum db_qgis_kind {
    DB_QGIS_CLASSES,  /* raster of class indices, in their colours and names */
    DB_QGIS_GREY,     /* raster, black at `low` to white at `high` */
    DB_QGIS_COLOUR,   /* raster of which `bands` are red, green and blue */
    DB_QGIS_POLYGONS, /* vector layer with the field `class` */
};

struct db_qgis_layer {
    enum db_qgis_kind kind;
    const char *title;  /* as the list of layers shows it */
    const char *source; /* as the project names it: absolute, or relative to its folder */
    const char *id;     /* its own among the layers: letters, digits and _ */
    double low, high;   /* of DB_QGIS_GREY; of DB_QGIS_COLOUR of each band */
    int bands[3];       /* of DB_QGIS_COLOUR, from 1 */
};

/* Write the style of one layer. Returns 0, or -1 with the error reported. */
int db_qgis_style_write(const char *path, const struct db_qgis_layer *layer,
                        const struct db_class_table *table);

/* Write a project of `count` layers, the first on top, that shows all of `grid`. Returns 0, or -1
 * with the error reported. */
int db_qgis_project_write(const char *path, const char *title, const struct db_qgis_layer *layers,
                          int count, const struct db_grid *grid,
                          const struct db_class_table *table);

/* Make an empty GeoPackage of polygons with the text field `class`, in the grid's CRS; one that
 * exists is left as it is. Returns 0, or -1 with the error reported and nothing left. */
int db_qgis_polygons_create(const char *path, const struct db_grid *grid);

#endif
