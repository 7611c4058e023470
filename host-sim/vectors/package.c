#include "gis/gdal_start.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "vectors/output.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FIELD_RULE, FIELD_CLASS, FIELD_HEIGHT, FIELD_ORIGIN, FIELDS };

static OGRLayerH add_layer(GDALDatasetH package, OGRSpatialReferenceH crs, enum vector_shape shape)
{
    static const char *const names[VECTOR_SHAPES] = {"points", "lines", "areas"};
    static const struct {
        const char *name;
        OGRFieldType type;
    } fields[FIELDS] = {
        {"rule", OFTString}, {"class", OFTString}, {"height_m", OFTReal}, {"origin", OFTString}};
    OGRLayerH layer = GDALDatasetCreateLayer(package, names[shape], crs, wkbUnknown, NULL);
    for (int i = 0; i < FIELDS && layer; i++) {
        OGRFieldDefnH field = OGR_Fld_Create(fields[i].name, fields[i].type);
        layer = OGR_L_CreateField(layer, field, TRUE) == OGRERR_NONE ? layer : NULL;
        OGR_Fld_Destroy(field);
    }
    return layer;
}

static bool add_item(OGRLayerH layer, const struct vector_item *item,
                     const struct db_class_table *table)
{
    OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    OGR_F_SetFieldString(feature, FIELD_RULE, item->rule->name);
    if (item->rule->class_index >= 0) {
        OGR_F_SetFieldString(feature, FIELD_CLASS, table->items[item->rule->class_index].name);
    }
    if (item->has_height) {
        OGR_F_SetFieldDouble(feature, FIELD_HEIGHT, item->height_m);
    }
    OGR_F_SetFieldString(feature, FIELD_ORIGIN, item->origin);
    const bool is_added = OGR_F_SetGeometry(feature, item->geometry) == OGRERR_NONE &&
                          OGR_L_CreateFeature(layer, feature) == OGRERR_NONE;
    OGR_F_Destroy(feature);
    return is_added;
}

static bool fill(GDALDatasetH package, const struct vector_map *map,
                 const struct db_class_table *table)
{
    OGRLayerH layers[VECTOR_SHAPES];
    for (int i = 0; i < VECTOR_SHAPES; i++) {
        layers[i] = add_layer(package, map->grid.crs, (enum vector_shape)i);
        if (!layers[i]) {
            return false;
        }
    }
    struct hs_progress bar;
    bool is_whole = GDALDatasetStartTransaction(package, FALSE) == OGRERR_NONE;
    hs_progress_begin(&bar, "GeoPackage", map->item_count);
    for (size_t i = 0; i < map->item_count && is_whole; i++) {
        is_whole = add_item(layers[map->items[i].rule->from], &map->items[i], table);
        hs_progress_update(&bar, i);
    }
    hs_progress_end(&bar);
    return is_whole && GDALDatasetCommitTransaction(package) == OGRERR_NONE;
}

int vector_package_write(const struct vector_map *map, const struct db_class_table *table,
                         const char *path)
{
    char *temporary = hs_atomic_temporary_name(path);
    if (!temporary) {
        return -1;
    }
    unlink(temporary); /* the driver wants to make the file itself */
    CPLErrorReset();
    GDALDatasetH package =
        GDALCreate(GDALGetDriverByName("GPKG"), temporary, 0, 0, 0, GDT_Unknown, NULL);
    bool is_whole = package && fill(package, map, table);
    if (package) {
        GDALClose(package);
    }
    int result;
    if (is_whole) {
        result = hs_atomic_rename(temporary, path);
    } else {
        result = hs_error(path, "check that the folder can be written and has space",
                          "cannot be written: %s", db_gdal_complaint());
        hs_atomic_drop(temporary);
    }
    free(temporary);
    return result;
}
