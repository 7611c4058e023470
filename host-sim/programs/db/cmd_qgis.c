/* landmass-db qgis: a project of QGIS in which exemplars and corrections are drawn. */
#include "commands.h"
#include "source_options.h"

#include "gis/qgis.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/output_path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    .command = "qgis",
    .summary = "make a QGIS project to draw exemplars and corrections in",
    .description =
        "Writes into a folder: landmass.qgs, a project that shows the image, the class raster if "
        "given, and\n"
        "two empty layers of polygons over them, exemplars.gpkg and corrections.gpkg, whose form "
        "offers the\n"
        "classes, `ignore` and `nodata`. Layers that are there keep their polygons; the project is "
        "written anew.\n\n"
        "Open it in QGIS 3.22 or later, choose a layer, toggle editing, draw, save, and go on "
        "with\n"
        "  landmass-db train ... --exemplars FOLDER/exemplars.gpkg\n"
        "  landmass-db correct ... --corrections FOLDER/corrections.gpkg\n\n"
        "Example:\n"
        "  landmass-db qgis --image scene.tif --class-raster scene-classes.tif --classes "
        "heaton6.classes \\\n"
        "      --out drawing",
};

struct options {
    struct db_image_options image;
    const char *classes, *class_raster, *out;
};

static bool read_options(struct options *o, int argc, char **argv, int *exit_code)
{
    const struct hs_option table[] = {
        DB_IMAGE_OPTIONS(&o->image),
        DB_CLASSES_OPTION(o->classes),
        {"class-raster", HS_INPUT, &o->class_raster, 0, 0, "FILE",
         "The class raster, from `segment` or `correct`, to be corrected.", false},
        {"out", HS_FOLDER, &o->out, 0, 0, "FOLDER", "Where the project and its layers go.", true},
    };
    return hs_options_read(&usage, table, sizeof table / sizeof table[0], argc, argv, exit_code);
}

enum { LAYERS_MAX = 3 + HS_LIST_MAX, LOOK = 256 };

struct work {
    const struct options *options;
    struct db_class_table table;
    struct db_raster image;
    struct db_qgis_layer layers[LAYERS_MAX];
    char *paths[LAYERS_MAX]; /* owned, where the source is outside the folder */
    char ids[LAYERS_MAX][24];
    int count;
};

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Black and white from the 2nd and 98th hundredth of every n-th pixel of the bands shown. */
static int find_stretch(const struct work *w, GDALDatasetH file, struct db_qgis_layer *layer)
{
    const int bands = layer->kind == DB_QGIS_COLOUR ? 3 : 1;
    float *values = malloc((size_t)bands * LOOK * LOOK * sizeof *values);
    if (!values) {
        return hs_error(w->image.name, NULL, "out of memory");
    }
    if (GDALDatasetRasterIO(file, GF_Read, 0, 0, w->image.grid.width, w->image.grid.height, values,
                            LOOK, LOOK, GDT_Float32, bands, layer->bands, 0, 0, 0) != CE_None) {
        free(values);
        return hs_error(layer->source, "fetch the file again", "cannot be read");
    }
    size_t count = 0;
    for (size_t i = 0; i < (size_t)bands * LOOK * LOOK; i++) {
        if (values[i] == values[i]) { /* not NaN */
            values[count++] = values[i];
        }
    }
    layer->high = 1;
    if (count > 0) {
        qsort(values, count, sizeof *values, compare_floats);
        layer->low = (double)values[count / 50];
        layer->high = (double)values[count - 1 - count / 50];
    }
    layer->high = layer->high > layer->low ? layer->high : layer->low + 1;
    free(values);
    return 0;
}

static struct db_qgis_layer *add_layer(struct work *w, enum db_qgis_kind kind, const char *title,
                                       const char *source)
{
    struct db_qgis_layer *layer = &w->layers[w->count];
    snprintf(w->ids[w->count], sizeof w->ids[0], "layer_%d", w->count + 1);
    *layer = (struct db_qgis_layer){
        .kind = kind, .title = title, .source = source, .id = w->ids[w->count]};
    w->count++;
    return layer;
}

/* A file of the user's, by its full path: the project may be moved, his files are not. */
static struct db_qgis_layer *add_file(struct work *w, enum db_qgis_kind kind, const char *path)
{
    char *full = realpath(path, NULL);
    if (!full) {
        hs_error(path, "check the name", "has no path of its own on the disk");
        return NULL;
    }
    const char *slash = strrchr(full, '/');
    w->paths[w->count] = full;
    return add_layer(w, kind, slash ? slash + 1 : full, full);
}

static int add_images(struct work *w)
{
    const struct hs_list *list = &w->options->image.paths;
    for (int i = 0; i < list->count; i++) {
        const GDALDatasetH file = w->image.files[i];
        const int bands = GDALGetRasterCount(file);
        struct db_qgis_layer *layer =
            add_file(w, bands >= 3 ? DB_QGIS_COLOUR : DB_QGIS_GREY, list->items[i]);
        if (!layer) {
            return -1;
        }
        for (int b = 0; b < 3; b++) {
            layer->bands[b] = bands == 3 ? b + 1 : bands > 3 ? 3 - b : 1;
        }
        if (find_stretch(w, file, layer) != 0) {
            return -1;
        }
    }
    return 0;
}

static int add_polygons(struct work *w, const char *title, const char *file, const char *source)
{
    char path[1024];
    if (hs_output_path(path, sizeof path, w->options->out, file) != 0 ||
        db_qgis_polygons_create(path, &w->image.grid) != 0) {
        return -1;
    }
    add_layer(w, DB_QGIS_POLYGONS, title, source);
    return 0;
}

static int run(struct work *w)
{
    const struct options *o = w->options;
    char path[1024];
    if (db_class_table_read(&w->table, o->classes) != 0 ||
        db_image_open(&w->image, &o->image) != 0) {
        return -1;
    }
    if (!w->image.grid.has_geotransform) {
        return hs_error(w->image.name, "give it a place with gdal_translate -a_srs and -a_ullr",
                        "has no georeferencing: QGIS would show it upside down");
    }
    if (add_polygons(w, "exemplars", "exemplars.gpkg", "./exemplars.gpkg|layername=polygons") !=
            0 ||
        add_polygons(w, "corrections", "corrections.gpkg",
                     "./corrections.gpkg|layername=polygons") != 0 ||
        (o->class_raster && !add_file(w, DB_QGIS_CLASSES, o->class_raster)) || add_images(w) != 0 ||
        hs_output_path(path, sizeof path, o->out, "landmass.qgs") != 0 ||
        db_qgis_project_write(path, "landmass: exemplars and corrections", w->layers, w->count,
                              &w->image.grid, &w->table) != 0) {
        return -1;
    }
    printf("%s: open it in QGIS\n", path);
    return 0;
}

int db_cmd_qgis(int argc, char **argv)
{
    hs_outputs_together();
    struct options options = {0};
    int exit_code;
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        hs_error("qgis", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    w->options = &options;
    if (read_options(&options, argc, argv, &exit_code)) {
        exit_code = run(w) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    for (int i = 0; i < LAYERS_MAX; i++) {
        free(w->paths[i]);
    }
    db_raster_close(&w->image);
    hs_list_free(&options.image.paths);
    free(w);
    return exit_code;
}
