#include "gis/class_raster.h"

#include "hs/error.h"
#include "hs/report.h"

#include <cpl_string.h>
#include <stdio.h>
#include <string.h>

static void set_names_item(GDALRasterBandH band, const struct db_class_table *table)
{
    char names[DB_CLASS_MAX * DB_NAME_SIZE] = "";
    for (int i = 0; i < table->count; i++) {
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? "," : "", table->items[i].name);
    }
    GDALSetMetadataItem(band, DB_CLASS_NAMES_ITEM, names, NULL);
}

int db_class_raster_create(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                           const struct db_class_table *table)
{
    if (db_raster_create(out, path, grid, GDT_Byte, DB_CLASS_NODATA) != 0) {
        return -1;
    }
    const GDALRasterBandH band = GDALGetRasterBand(out->dataset, 1);
    GDALColorTableH colours = GDALCreateColorTable(GPI_RGB);
    char **names = NULL;
    for (int i = 0; i < table->count; i++) {
        const uint8_t *c = table->items[i].colour;
        const GDALColorEntry entry = {c[0], c[1], c[2], 255};
        GDALSetColorEntry(colours, i, &entry);
        names = CSLAddString(names, table->items[i].name);
    }
    GDALSetRasterColorTable(band, colours);
    GDALSetRasterCategoryNames(band, names);
    set_names_item(band, table);
    GDALDestroyColorTable(colours);
    CSLDestroy(names);
    return 0;
}

void db_class_raster_attributes(struct db_raster_out *out, const struct db_class_table *table,
                                const uint64_t *pixels, const double *area_km2)
{
    enum { NUMBER, NAME, PIXELS, AREA, RED, GREEN, BLUE };
    const GDALRasterAttributeTableH t = GDALCreateRasterAttributeTable();
    GDALRATCreateColumn(t, "Value", GFT_Integer, GFU_MinMax);
    GDALRATCreateColumn(t, "Class", GFT_String, GFU_Name);
    GDALRATCreateColumn(t, "Count", GFT_Real, GFU_PixelCount);
    GDALRATCreateColumn(t, "Area_km2", GFT_Real, GFU_Generic);
    GDALRATCreateColumn(t, "Red", GFT_Integer, GFU_Red);
    GDALRATCreateColumn(t, "Green", GFT_Integer, GFU_Green);
    GDALRATCreateColumn(t, "Blue", GFT_Integer, GFU_Blue);
    for (int i = 0; i < table->count; i++) {
        const struct db_class *c = &table->items[i];
        GDALRATSetValueAsInt(t, i, NUMBER, i);
        GDALRATSetValueAsString(t, i, NAME, c->name);
        GDALRATSetValueAsDouble(t, i, PIXELS, (double)pixels[i]);
        GDALRATSetValueAsDouble(t, i, AREA, area_km2[i]);
        for (int k = 0; k < 3; k++) {
            GDALRATSetValueAsInt(t, i, RED + k, c->colour[k]);
        }
    }
    GDALSetDefaultRAT(GDALGetRasterBand(out->dataset, 1), t);
    GDALDestroyRasterAttributeTable(t);
}

int db_class_raster_open(struct db_raster *r, struct db_class_numbers *numbers, const char *path,
                         const struct db_class_table *table, bool ignores_names)
{
    if (db_raster_open_one(r, path) != 0) {
        return -1;
    }
    if (r->band_count != 1) {
        hs_error(path, "give the output of `landmass-db segment`",
                 "has %d bands and is no class raster", r->band_count);
        db_raster_close(r);
        return -1;
    }
    if (db_class_numbers_read(numbers, r->bands[0].handle, path, table, ignores_names) != 0) {
        db_raster_close(r);
        return -1;
    }
    return 0;
}

int db_class_raster_read(const struct db_raster *r, const struct db_class_numbers *numbers, int y,
                         int rows, float *scratch, uint8_t *valid, uint8_t *classes)
{
    if (db_raster_read(r, y, rows, scratch, valid) != 0) {
        return -1;
    }
    for (size_t i = 0; i < (size_t)rows * (size_t)r->grid.width; i++) {
        const float v = scratch[i];
        const bool is_number = v >= 0 && v <= 255;
        classes[i] = !valid[i]   ? DB_CLASS_NODATA
                     : is_number ? numbers->class_of[(int)v]
                                 : DB_CLASS_UNKNOWN;
        if (classes[i] == DB_CLASS_UNKNOWN) {
            return hs_error(r->name, "run again", "was changed while it was read, at row %d",
                            y + (int)(i / (size_t)r->grid.width));
        }
    }
    return 0;
}

void db_class_counts_print(const struct db_class_table *table, const uint64_t counts[256])
{
    uint64_t total = counts[DB_CLASS_NODATA];
    for (int i = 0; i < table->count; i++) {
        total += counts[i];
    }
    hs_report_array("classes");
    for (int i = 0; i < table->count; i++) {
        const double share = (double)counts[i] / (double)total;
        printf("%-16s %12llu pixels  %5.1f %%\n", table->items[i].name,
               (unsigned long long)counts[i], 100 * share);
        hs_report_object(NULL);
        hs_report_put("class", i);
        hs_report_put("name", table->items[i].name);
        hs_report_put("pixels", counts[i]);
        hs_report_put("share", share);
        hs_report_close();
    }
    hs_report_close();
    hs_report_put("pixels_without_data", counts[DB_CLASS_NODATA]);
    printf("%-16s %12llu pixels  %5.1f %%\n", "no data",
           (unsigned long long)counts[DB_CLASS_NODATA],
           100.0 * (double)counts[DB_CLASS_NODATA] / (double)total);
}
