/* landmass-db import: a visual database in; phototexture, patches, classes, terrain and heights
 * out. */
#include "commands.h"
#include "import.h"

#include "gis/class_raster.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/report.h"

#include <cpl_string.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    .command = "import",
    .summary = "look straight down on a visual database",
    .description =
        "Takes models (glTF, Collada, OBJ and others through Assimp, OpenFlight through "
        "OpenSceneGraph) or an\n"
        "OGC CDB tree, looks down on the middle of each cell, and writes what is topmost: colours "
        "for\n"
        "`train` and `segment`, the picture that each cell's colour comes from, classes of named "
        "materials,\n"
        "terrain and heights for `build`. Only the outputs that are named are made.\n\n"
        "Models lie in one plane: x or east, and north, from an origin that --at or --crs and "
        "--origin place.\n"
        "Which surfaces are ground is known from the classes of their materials (--map): those of "
        "the kinds\n"
        "ground and water make the terrain, all others stand on it. A cell without ground takes "
        "that around it.\n\n"
        "A CDB tree has its own coordinates. Finer tiles cover coarser ones. Heights are those of "
        "its models\n"
        "above the ground.\n\n"
        "Examples:\n"
        "  landmass-db import --model town.glb --at 52.01,4.36 --cell 1 --out-image town.tif \\\n"
        "      --classes heaton6.classes --map town.map --out-classes named.tif \\\n"
        "      --out-terrain ground.tif --out-heights heights.tif\n"
        "  landmass-db import --cdb San_Diego --area 32.5,-117.25,32.75,-117 --out-image sd.tif "
        "\\\n"
        "      --out-mask patches.tif --out-terrain sd-terrain.tif --out-heights sd-heights.tif",
};

#define OPTION(name, kind, field, value, help)                                                     \
    {                                                                                              \
        name, kind, &o->field, 0, 0, value, help, false                                            \
    }

static bool read_options(struct import_options *o, int argc, char **argv, int *exit_code)
{
    const struct hs_option table[] = {
        OPTION("model", HS_INPUTS, models, "FILE",
               "A model; may be repeated: all share one origin."),
        OPTION("cdb", HS_TEXT, cdb, "FOLDER", "Instead: the folder of a CDB that holds Tiles."),
        OPTION("unit", HS_WORD, unit, "m|cm|mm|ft|us-ft|in",
               "A model's unit, where its format has none (OBJ)."),
        OPTION("up", HS_WORD, up, "y|z",
               "What is up, where the format does not say it. With y up, north is -z."),
        OPTION("at", HS_TEXT, at, "LAT,LON[,H]",
               "Where the models' origin lies, degrees, and its height in metres. The output is "
               "in a\n"
               "transverse Mercator projection around it."),
        OPTION("crs", HS_TEXT, crs, "CRS",
               "Instead: the models lie in this projected CRS (EPSG:28992)."),
        OPTION("origin", HS_TEXT, origin, "X,Y[,H]",
               "Where in the CRS the models' origin lies; default 0,0."),
        OPTION("area", HS_TEXT, area, "S,W,N,E", "Part of a CDB, degrees; default all of it."),
        {"cell", HS_REAL, &o->cell_m, 0, 10000, "METRES",
         "Length of a cell; models need it. Of a CDB: the coarsest level with pixels that short, "
         "or "
         "with 0 the finest imagery's.",
         false},
        OPTION("classes", HS_INPUT, classes, "FILE", "The class table; needed with --map."),
        OPTION("map", HS_INPUT, map, "FILE",
               "Lines of `material = class`. Of a CDB also base materials (BM_ASPHALT) and feature "
               "codes (AL015)."),
        OPTION("boxes", HS_FLAG, boxes, NULL,
               "Features of a CDB whose model is missing become boxes of the size in its tables."),
        OPTION("out-image", HS_OUTPUT, image, "FILE",
               "Colours, 3 bands; 0 0 0 is no data, black surfaces are 1 1 1."),
        OPTION("out-mask", HS_OUTPUT, mask, "FILE",
               "Number of the picture that each cell shows, from 1, with the pictures' names; see "
               "reflect --patches."),
        OPTION("out-classes", HS_OUTPUT, class_raster, "FILE",
               "Class raster of the materials that --map names; the rest has no data."),
        OPTION("out-top", HS_OUTPUT, top, "FILE", "Metres of the topmost surface; of models only."),
        OPTION("out-terrain", HS_OUTPUT, terrain, "FILE",
               "Metres of the ground, for build --terrain."),
        OPTION("out-heights", HS_OUTPUT, heights, "FILE",
               "Metres of what stands on it, for build --heights."),
        HS_CLASHES_ROW("model", "cdb"),
        HS_NEEDS_ROW("unit", "model"),
        HS_NEEDS_ROW("up", "model"),
        HS_NEEDS_ROW("at", "model"),
        HS_CLASHES_ROW("at", "crs"),
        HS_NEEDS_ROW("crs", "model"),
        HS_NEEDS_ROW("origin", "crs"),
        HS_NEEDS_ROW("area", "cdb"),
        HS_NEEDS_ROW("boxes", "cdb"),
        HS_NEEDS_ROW("classes", "map"),
        HS_NEEDS_ROW("map", "classes"),
        HS_NEEDS_ROW("out-classes", "map"),
        HS_NEEDS_ROW("out-top", "model"),
    };
    return hs_options_read(&usage, table, sizeof table / sizeof table[0], argc, argv, exit_code);
}

int import_class_of(void *context, const char *material)
{
    const struct import *im = context;
    return im->options->map ? db_label_map_find(&im->map, material) : -1;
}

void import_warn_lost(const struct import *im, uint32_t count, const char *first)
{
    if (count > 0) {
        hs_warn(im->place, "put them where the model looks for them",
                count == 1
                    ? "%u texture is missing: `%s`; plain colour stands for it"
                    : "%u textures are missing, `%s` the first; plain colours stand for them",
                count, first);
    }
}

static int usage_error(const char *option, const char *cause)
{
    return hs_error(option, "see landmass-db import --help", "%s", cause);
}

static int check_options(const struct import_options *o)
{
    const bool is_split = o->terrain || o->heights;
    if ((o->models.count > 0) == (o->cdb != NULL)) {
        return usage_error("--model", "give either models or a --cdb");
    }
    if (!o->image && !o->mask && !o->class_raster && !o->top && !is_split) {
        return usage_error("--out-image", "no output is named");
    }
    if (o->models.count > 0 && is_split && !o->map) {
        return usage_error("--out-terrain",
                           "needs --classes and --map, to know which materials are ground");
    }
    return 0;
}

static int read_tables(struct import *im)
{
    const struct import_options *o = im->options;
    if (!o->map) {
        return 0;
    }
    if (db_class_table_read(&im->table, o->classes) != 0 ||
        db_label_map_read(&im->map, o->map, &im->table) != 0) {
        return -1;
    }
    for (int i = 0; i < im->table.count; i++) {
        const enum db_class_kind kind = im->table.items[i].kind;
        im->is_ground[i] = kind == DB_KIND_GROUND || kind == DB_KIND_WATER;
    }
    return 0;
}

enum { IMAGE, MASK, CLASSES, TOP, TERRAIN, HEIGHTS, OUTPUTS };

static void blacken(struct visual_canvas *c)
{
    for (size_t i = 0; i < (size_t)c->width * (size_t)c->height; i++) {
        const bool is_black = !(c->rgb[0][i] | c->rgb[1][i] | c->rgb[2][i]);
        for (int k = 0; k < 3 && is_black && c->patch[i] != 0; k++) {
            c->rgb[k][i] = 1;
        }
    }
}

static int write_image(const struct import *im, struct db_raster_out *out)
{
    const struct db_raster_kind kind = {GDT_Byte, 0, 3};
    if (db_raster_create_bands(out, im->options->image, &im->grid, &kind) != 0) {
        return -1;
    }
    for (int b = 0; b < 3; b++) {
        GDALSetRasterColorInterpretation(GDALGetRasterBand(out->dataset, b + 1),
                                         (GDALColorInterp)(GCI_RedBand + b));
        if (db_raster_write_band(out, b + 1, 0, im->grid.height, im->canvas.rgb[b]) != 0) {
            return -1;
        }
    }
    return 0;
}

static int write_mask(const struct import *im, struct db_raster_out *out)
{
    if (db_raster_create(out, im->options->mask, &im->grid, GDT_UInt16, 0) != 0) {
        return -1;
    }
    char **names = CSLAddString(NULL, "none");
    for (uint32_t i = 0; i < im->patches.count; i++) {
        names = CSLAddString(names, im->patches.names[i]);
    }
    GDALSetRasterCategoryNames(GDALGetRasterBand(out->dataset, 1), names);
    CSLDestroy(names);
    return db_raster_write(out, 0, im->grid.height, im->canvas.patch);
}

static int write_classes(const struct import *im, struct db_raster_out *out)
{
    return db_class_raster_create(out, im->options->class_raster, &im->grid, &im->table) == 0
               ? db_raster_write(out, 0, im->grid.height, im->canvas.classes)
               : -1;
}

static int write_metres(struct db_raster_out *out, const char *path, const struct db_grid *grid,
                        const float *metres)
{
    return db_raster_create(out, path, grid, GDT_Float32, IMPORT_NODATA_M) == 0
               ? db_raster_write(out, 0, grid->height, metres)
               : -1;
}

static int write_all(struct import *im, struct db_raster_out out[OUTPUTS])
{
    const struct import_options *o = im->options;
    struct visual_canvas *c = &im->canvas;
    blacken(c);
    for (size_t i = 0; o->top && i < (size_t)c->width * (size_t)c->height; i++) {
        c->top[i] = isnan(c->top[i]) ? (float)IMPORT_NODATA_M : c->top[i];
    }
    return (o->image && write_image(im, &out[IMAGE]) != 0) ||
                   (o->mask && write_mask(im, &out[MASK]) != 0) ||
                   (o->class_raster && write_classes(im, &out[CLASSES]) != 0) ||
                   (o->top && write_metres(&out[TOP], o->top, &im->grid, c->top) != 0) ||
                   (o->terrain &&
                    write_metres(&out[TERRAIN], o->terrain, &im->terrain_grid, im->terrain) != 0) ||
                   (o->heights &&
                    write_metres(&out[HEIGHTS], o->heights, &im->grid, im->heights) != 0)
               ? -1
               : 0;
}

static int put_in_place(struct import *im)
{
    struct db_raster_out out[OUTPUTS] = {{0}};
    int result = write_all(im, out);
    for (int i = 0; i < OUTPUTS; i++) {
        if (result == 0 && out[i].dataset) {
            result = db_raster_commit(&out[i]);
        }
        db_raster_abort(&out[i]);
    }
    return result;
}

static void print_report(const struct import *im)
{
    const struct visual_canvas *c = &im->canvas;
    uint64_t counts[256] = {0}, seen = 0, high = 0;
    const size_t cells = (size_t)c->width * (size_t)c->height;
    for (size_t i = 0; i < cells; i++) {
        counts[c->classes[i]]++;
        seen += c->patch[i] != 0;
        high += im->heights && im->heights[i] > 0;
    }
    printf("%d x %d cells, %.1f %% of them seen, %u patches\n", c->width, c->height,
           100.0 * (double)seen / (double)cells, im->patches.count);
    hs_report_put("width_px", c->width);
    hs_report_put("height_px", c->height);
    hs_report_put("seen_pixels", seen);
    hs_report_put("patches", im->patches.count);
    if (im->heights) {
        hs_report_put("pixels_above_ground", high);
        printf("heights: %llu cells stand above the ground\n", (unsigned long long)high);
    }
    if (im->options->class_raster) {
        db_class_counts_print(&im->table, counts);
    }
}

static int run(struct import *im)
{
    const struct import_options *o = im->options;
    if (o->cdb) {
        hs_input_note_folder(o->cdb);
    }
    if (read_tables(im) != 0 || (o->cdb ? import_cdb(im) : import_models(im)) != 0 ||
        put_in_place(im) != 0) {
        return HS_EXIT_FAILED;
    }
    print_report(im);
    return HS_EXIT_OK;
}

int db_cmd_import(int argc, char **argv)
{
    hs_outputs_together();
    struct import_options o = {.cdb = NULL};
    int exit_code;
    struct import *im = calloc(1, sizeof *im);
    if (!im) {
        hs_error("import", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    im->options = &o;
    if (read_options(&o, argc, argv, &exit_code)) {
        im->place = o.cdb ? o.cdb : o.models.count > 0 ? o.models.items[0] : "import";
        im->scene.patches = &im->patches;
        exit_code = check_options(&o) == 0 ? run(im) : HS_EXIT_USAGE;
    }
    visual_scene_free(&im->scene);
    visual_canvas_close(&im->canvas);
    visual_patches_free(&im->patches);
    if (im->grid.crs) {
        OSRDestroySpatialReference(im->grid.crs);
    }
    free(im->terrain);
    free(im->heights);
    hs_list_free(&o.models);
    free(im);
    return exit_code;
}
