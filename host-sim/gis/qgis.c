#include "gis/qgis.h"

#include "gis/gdal_start.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

#include <cpl_conv.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char doctype[] = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n";

/* Text as XML wants it within an element or between double quotes. */
static void put_text(FILE *out, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc(*text, out);
        }
    }
}

/* ` name="value"` */
static void put_attribute(FILE *out, const char *name, const char *value)
{
    fprintf(out, " %s=\"", name);
    put_text(out, value);
    fputc('"', out);
}

/* `<name>value</name>` */
static void put_element(FILE *out, const char *name, const char *value)
{
    fprintf(out, "<%s>", name);
    put_text(out, value);
    fprintf(out, "</%s>\n", name);
}

/* ---- Styles ---- */

static void put_palette(FILE *out, const struct db_class_table *table)
{
    fputs(
        "<rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" "
        "nodataColor=\"\">\n<rasterTransparency/>\n<colorPalette>\n",
        out);
    for (int i = 0; i < table->count; i++) {
        const uint8_t *c = table->items[i].colour;
        fprintf(out, "<paletteEntry value=\"%d\" color=\"#%02x%02x%02x\" alpha=\"255\"", i, c[0],
                c[1], c[2]);
        put_attribute(out, "label", table->items[i].name);
        fputs("/>\n", out);
    }
    fputs("</colorPalette>\n</rasterrenderer>\n", out);
}

static void put_stretch(FILE *out, const char *element, double low, double high)
{
    fprintf(out,
            "<%s>\n<minValue>%.9g</minValue>\n<maxValue>%.9g</maxValue>\n"
            "<algorithm>StretchToMinimumMaximum</algorithm>\n</%s>\n",
            element, low, high, element);
}

static void put_grey(FILE *out, const struct db_qgis_layer *layer)
{
    fputs(
        "<rasterrenderer type=\"singlebandgray\" grayBand=\"1\" gradient=\"BlackToWhite\" "
        "opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\">\n<rasterTransparency/>\n",
        out);
    put_stretch(out, "contrastEnhancement", layer->low, layer->high);
    fputs("</rasterrenderer>\n", out);
}

static void put_colour(FILE *out, const struct db_qgis_layer *layer)
{
    fprintf(out,
            "<rasterrenderer type=\"multibandcolor\" redBand=\"%d\" greenBand=\"%d\" "
            "blueBand=\"%d\" opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\">\n"
            "<rasterTransparency/>\n",
            layer->bands[0], layer->bands[1], layer->bands[2]);
    put_stretch(out, "redContrastEnhancement", layer->low, layer->high);
    put_stretch(out, "greenContrastEnhancement", layer->low, layer->high);
    put_stretch(out, "blueContrastEnhancement", layer->low, layer->high);
    fputs("</rasterrenderer>\n", out);
}

static void put_pipe(FILE *out, const struct db_qgis_layer *layer,
                     const struct db_class_table *table)
{
    fputs("<pipe>\n", out);
    if (layer->kind == DB_QGIS_CLASSES) {
        put_palette(out, table);
    } else if (layer->kind == DB_QGIS_GREY) {
        put_grey(out, layer);
    } else {
        put_colour(out, layer);
    }
    fputs("</pipe>\n", out);
}

/* Half transparent within, plain at the edge, so that the image is seen through. */
static void put_symbol(FILE *out, int number, const uint8_t colour[3])
{
    fprintf(out,
            "<symbol type=\"fill\" name=\"%d\" alpha=\"1\" clip_to_extent=\"1\" force_rhr=\"0\">\n"
            "<layer class=\"SimpleFill\" enabled=\"1\" locked=\"0\" pass=\"0\">\n"
            "<prop k=\"color\" v=\"%d,%d,%d,96\"/>\n<prop k=\"style\" v=\"solid\"/>\n"
            "<prop k=\"outline_color\" v=\"%d,%d,%d,255\"/>\n"
            "<prop k=\"outline_style\" v=\"solid\"/>\n<prop k=\"outline_width\" v=\"0.6\"/>\n"
            "<prop k=\"outline_width_unit\" v=\"MM\"/>\n</layer>\n</symbol>\n",
            number, colour[0], colour[1], colour[2], colour[0], colour[1], colour[2]);
}

/* Words that are labels beside the classes. */
static const char *const more_labels[] = {"nodata", "ignore"};
enum { MORE_LABELS = 2 };
static const uint8_t more_colours[MORE_LABELS][3] = {{0, 0, 0}, {255, 255, 255}};

static const char *label_of(const struct db_class_table *table, int i)
{
    return i < table->count ? table->items[i].name : more_labels[i - table->count];
}

static void put_categories(FILE *out, const struct db_class_table *table)
{
    const int count = table->count + MORE_LABELS;
    fputs(
        "<renderer-v2 type=\"categorizedSymbol\" attr=\"class\" symbollevels=\"0\" "
        "enableorderby=\"0\" forceraster=\"0\">\n<categories>\n",
        out);
    for (int i = 0; i < count; i++) {
        fprintf(out, "<category render=\"true\" symbol=\"%d\"", i);
        put_attribute(out, "value", label_of(table, i));
        put_attribute(out, "label", label_of(table, i));
        fputs("/>\n", out);
    }
    fputs("</categories>\n<symbols>\n", out);
    for (int i = 0; i < count; i++) {
        put_symbol(out, i,
                   i < table->count ? table->items[i].colour : more_colours[i - table->count]);
    }
    fputs("</symbols>\n</renderer-v2>\n", out);
}

/* The form of a new polygon offers the labels and takes no other. */
static void put_form(FILE *out, const struct db_class_table *table)
{
    fputs(
        "<fieldConfiguration>\n<field name=\"class\">\n<editWidget type=\"ValueMap\">\n<config>\n"
        "<Option type=\"Map\">\n<Option name=\"map\" type=\"List\">\n",
        out);
    for (int i = 0; i < table->count + MORE_LABELS; i++) {
        fputs("<Option type=\"Map\"><Option type=\"QString\"", out);
        put_attribute(out, "name", label_of(table, i));
        put_attribute(out, "value", label_of(table, i));
        fputs("/></Option>\n", out);
    }
    fputs("</Option>\n</Option>\n</config>\n</editWidget>\n</field>\n</fieldConfiguration>\n", out);
}

static void put_style(FILE *out, const struct db_qgis_layer *layer,
                      const struct db_class_table *table)
{
    if (layer->kind == DB_QGIS_POLYGONS) {
        put_categories(out, table);
        put_form(out, table);
    } else {
        put_pipe(out, layer, table);
    }
}

int db_qgis_style_write(const char *path, const struct db_qgis_layer *layer,
                        const struct db_class_table *table)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs(doctype, file.stream);
    fputs("<qgis version=\"3.22.0\" styleCategories=\"AllStyleCategories\">\n", file.stream);
    put_style(file.stream, layer, table);
    fputs("</qgis>\n", file.stream);
    return hs_atomic_commit(&file);
}

/* ---- Projects ---- */

/* The CRS as WKT, of which QGIS finds the rest. */
static void put_crs(FILE *out, const struct db_grid *grid)
{
    char *wkt = NULL;
    fputs("<spatialrefsys>\n", out);
    if (grid->crs && OSRExportToWkt(grid->crs, &wkt) == OGRERR_NONE) {
        put_element(out, "wkt", wkt);
    }
    CPLFree(wkt);
    const char *authority = grid->crs ? OSRGetAuthorityName(grid->crs, NULL) : NULL;
    const char *code = grid->crs ? OSRGetAuthorityCode(grid->crs, NULL) : NULL;
    if (authority && code) {
        char id[64];
        snprintf(id, sizeof id, "%s:%s", authority, code);
        put_element(out, "authid", id);
    }
    fputs("</spatialrefsys>\n", out);
}

static void put_tree(FILE *out, const struct db_qgis_layer *layers, int count)
{
    fputs("<layer-tree-group>\n", out);
    for (int i = 0; i < count; i++) {
        const bool is_vector = layers[i].kind == DB_QGIS_POLYGONS;
        fprintf(out, "<layer-tree-layer checked=\"%s\" expanded=\"1\" providerKey=\"%s\"",
                layers[i].kind == DB_QGIS_GREY ? "Qt::Unchecked" : "Qt::Checked",
                is_vector ? "ogr" : "gdal");
        put_attribute(out, "id", layers[i].id);
        put_attribute(out, "name", layers[i].title);
        put_attribute(out, "source", layers[i].source);
        fputs("/>\n", out);
    }
    fputs("</layer-tree-group>\n", out);
}

/* The corners of a turned image are turned with it. */
static void put_canvas(FILE *out, const struct db_grid *grid)
{
    const double *g = grid->geotransform;
    double low[2] = {g[0], g[3]}, high[2] = {g[0], g[3]};
    for (int corner = 1; corner < 4; corner++) {
        const double x = corner & 1 ? grid->width : 0, y = corner & 2 ? grid->height : 0;
        for (int axis = 0; axis < 2; axis++) {
            const double v = g[3 * axis] + x * g[3 * axis + 1] + y * g[3 * axis + 2];
            low[axis] = v < low[axis] ? v : low[axis];
            high[axis] = v > high[axis] ? v : high[axis];
        }
    }
    fprintf(out,
            "<mapcanvas name=\"theMapCanvas\">\n<extent>\n<xmin>%.12g</xmin>\n<ymin>%.12g</ymin>\n"
            "<xmax>%.12g</xmax>\n<ymax>%.12g</ymax>\n</extent>\n<destinationsrs>\n",
            low[0], low[1], high[0], high[1]);
    put_crs(out, grid);
    fputs("</destinationsrs>\n</mapcanvas>\n", out);
}

static void put_layer(FILE *out, const struct db_qgis_layer *layer, const struct db_grid *grid,
                      const struct db_class_table *table)
{
    const bool is_vector = layer->kind == DB_QGIS_POLYGONS;
    fprintf(out, "<maplayer type=\"%s\"%s>\n", is_vector ? "vector" : "raster",
            is_vector ? " geometry=\"Polygon\"" : "");
    put_element(out, "id", layer->id);
    put_element(out, "datasource", layer->source);
    put_element(out, "layername", layer->title);
    fputs("<srs>\n", out);
    put_crs(out, grid);
    fprintf(out, "</srs>\n<provider%s>%s</provider>\n", is_vector ? " encoding=\"UTF-8\"" : "",
            is_vector ? "ogr" : "gdal");
    put_style(out, layer, table);
    fputs("</maplayer>\n", out);
}

int db_qgis_project_write(const char *path, const char *title, const struct db_qgis_layer *layers,
                          int count, const struct db_grid *grid, const struct db_class_table *table)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    FILE *out = file.stream;
    fputs(doctype, out);
    fputs("<qgis version=\"3.22.0\"", out);
    put_attribute(out, "projectname", title);
    fputs(">\n", out);
    put_element(out, "title", title);
    fputs("<projectCrs>\n", out);
    put_crs(out, grid);
    fputs("</projectCrs>\n", out);
    put_tree(out, layers, count);
    put_canvas(out, grid);
    fputs("<projectlayers>\n", out);
    for (int i = 0; i < count; i++) {
        put_layer(out, &layers[i], grid, table);
    }
    /* Without ProjectionsEnabled QGIS does not read the project's CRS. */
    fputs(
        "</projectlayers>\n<properties>\n<SpatialRefSys>\n"
        "<ProjectionsEnabled type=\"int\">1</ProjectionsEnabled>\n</SpatialRefSys>\n"
        "<Paths><Absolute type=\"bool\">false</Absolute></Paths>\n</properties>\n</qgis>\n",
        out);
    return hs_atomic_commit(&file);
}

/* ---- Polygons to draw in ---- */

static int create_layer(GDALDatasetH file, const struct db_grid *grid)
{
    OGRLayerH layer = GDALDatasetCreateLayer(file, "polygons", grid->crs, wkbPolygon, NULL);
    if (!layer) {
        return -1;
    }
    OGRFieldDefnH field = OGR_Fld_Create("class", OFTString);
    const OGRErr error = OGR_L_CreateField(layer, field, FALSE);
    OGR_Fld_Destroy(field);
    return error == OGRERR_NONE ? 0 : -1;
}

int db_qgis_polygons_create(const char *path, const struct db_grid *grid)
{
    if (access(path, F_OK) == 0) {
        return 0;
    }
    char *temporary = hs_atomic_temporary_name(path);
    CPLErrorReset();
    GDALDatasetH file =
        temporary ? GDALCreate(GDALGetDriverByName("GPKG"), temporary, 0, 0, 0, GDT_Unknown, NULL)
                  : NULL;
    int result = file ? create_layer(file, grid) : -1;
    if (file) {
        GDALClose(file);
    }
    if (result == 0) {
        result = hs_atomic_rename(temporary, path);
    } else {
        hs_error(path, "check that the folder can be written", "cannot be created: %s",
                 db_gdal_complaint());
        if (temporary) {
            unlink(temporary);
        }
    }
    free(temporary);
    return result;
}
