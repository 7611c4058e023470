/* landmass-db export: the planes of a database image as GeoTIFF with colours, names and styles. */
#include "area_option.h"
#include "commands.h"

#include "gis/class_raster.h"
#include "gis/qgis.h"
#include "gis/sensor_tag.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/options.h"
#include "hs/output_path.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "image/picture.h"

#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLANES = 4, STRIP = 256, SIDE_MAX = 65536 };
static const double no_data = -9999;

static const struct hs_usage usage = {
    .command = "export",
    .summary = "write the planes of a database image as GeoTIFF",
    .description =
        "Writes class.tif, reflectivity.tif, elevation.tif and height.tif (of structures and "
        "trees) "
        "into a folder:\n"
        "cloud-optimised, with overviews, in WGS-84, a pixel a cell of the level, with units, "
        "nodata and,\n"
        "of the classes, colours, names and a table of their areas. A style beside each (.qml) "
        "lets QGIS show it as it should; planes.qgs "
        "is a project\n"
        "of all four. Where the level has no tile the next coarser one shows through.\n\n"
        "Example:\n"
        "  landmass-db export coast.lmdb --out coast-planes --level 2",
};

struct settings {
    const char *area, *out;
    long level;
};

static bool read_settings(struct settings *s, int argc, char **argv, const char **path,
                          int *exit_code)
{
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, path, 0, 0, NULL, "the database image", true},
        {"out", HS_FOLDER, &s->out, 0, 0, "FOLDER", "where the files go", true},
        {"level", HS_INTEGER, &s->level, 0, LM_DB_LODS_MAX - 1, "L", "level of detail", false},
        {"area", HS_TEXT, &s->area, 0, 0, "LATS,LONW,LATN,LONE",
         "degrees; left out: all of that level", false},
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

struct plane {
    enum image_plane plane;
    const char *unit;
    double low, high;       /* black and white of the style */
    const char *resampling; /* of overviews */
};

/* In dB and metres; a style's range of heights is set from what is there. A mean of classes or of
 * dB is none of the ground. */
static const struct plane planes[PLANES] = {
    {IMAGE_PLANE_CLASS, "", 0, 0, "NEAREST"},
    {IMAGE_PLANE_REFLECTIVITY, "dB", -45, 5, "NEAREST"},
    {IMAGE_PLANE_ELEVATION, "m", 0, 0, "AVERAGE"},
    {IMAGE_PLANE_HEIGHT, "m", 0, 30, "AVERAGE"},
};

struct work {
    const struct settings *settings;
    struct image image;
    struct image_view view;
    struct db_grid grid;
    struct db_class_table table;
    struct db_qgis_layer layers[PLANES];
    char sources[PLANES][32], ids[PLANES][32];
    uint64_t pixels[DB_CLASS_NODATA + 1]; /* by class */
    double area_km2[DB_CLASS_NODATA + 1];
    float *values;  /* owned; a strip */
    uint8_t *bytes; /* owned; likewise */
};

_Static_assert((int)LM_DB_CLASS_NONE <= (int)DB_CLASS_MAX, "the table holds the image's classes");

/* The image's classes as a table: their names and colours; one without a name gets its number. */
static void read_table(struct work *w)
{
    for (int i = 0; i < LM_DB_CLASS_NONE; i++) {
        const struct lm_class *c = &w->image.db.classes.entry[i];
        struct db_class *item = &w->table.items[i];
        snprintf(item->name, sizeof item->name, "%.16s", c->name);
        memcpy(item->colour, c->colour, sizeof item->colour);
        if (item->name[0]) {
            w->table.count = i + 1;
        } else {
            snprintf(item->name, sizeof item->name, "unused %d", i);
        }
    }
}

static int choose_grid(struct work *w)
{
    const struct settings *s = w->settings;
    if (s->level >= w->image.header.lod_count) {
        return hs_error("--level", "see `landmass-db inspect`", "the image ends at level %u",
                        w->image.header.lod_count - 1u);
    }
    if (image_view_cells(&w->image, &w->view, (int)s->level) != 0) {
        return -1;
    }
    const struct image_view *v = &w->view;
    if (v->width > SIDE_MAX || v->height > SIDE_MAX) {
        return hs_error("--level", "choose a coarser level, or an --area",
                        "gives %d x %d pixels; at most %d each way", v->width, v->height, SIDE_MAX);
    }
    w->grid = (struct db_grid){.width = v->width, .height = v->height, .has_geotransform = true};
    w->grid.geotransform[0] = image_longitude_degrees(v->area.west);
    w->grid.geotransform[1] = image_degrees(v->area.width) / v->width;
    w->grid.geotransform[3] = image_degrees(v->area.north);
    w->grid.geotransform[5] = -image_degrees(v->area.north - v->area.south) / v->height;
    w->grid.crs = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(w->grid.crs, 4326);
    OSRSetAxisMappingStrategy(w->grid.crs, OAMS_TRADITIONAL_GIS_ORDER);
    const size_t strip = (size_t)STRIP * (size_t)v->width;
    w->values = malloc(strip * sizeof *w->values);
    w->bytes = malloc(strip);
    return w->values && w->bytes ? 0 : hs_error(s->out, "choose an --area", "out of memory");
}

static int create(struct work *w, const struct plane *plane, struct db_raster_out *out,
                  const char *path)
{
    if (plane->plane == IMAGE_PLANE_CLASS) {
        return db_class_raster_create(out, path, &w->grid, &w->table);
    }
    if (db_raster_create(out, path, &w->grid, GDT_Float32, no_data) != 0) {
        return -1;
    }
    const GDALRasterBandH band = GDALGetRasterBand(out->dataset, 1);
    GDALSetDescription(band, image_plane_names[plane->plane]);
    GDALSetRasterUnitType(band, plane->unit);
    if (plane->plane == IMAGE_PLANE_REFLECTIVITY) {
        db_sensor_tag_write(out, (enum hs_sensor)w->image.header.sensor);
    }
    return 0;
}

/* Area of a pixel of row y on the ellipsoid of WGS-84: sides along the meridian and the parallel by
 * its radii of curvature. */
static double pixel_km2(const struct db_grid *grid, int y)
{
    const double degree = 3.14159265358979323846 / 180, a_km = 6378.137, e2 = 0.00669437999014;
    const double *g = grid->geotransform;
    const double latitude = (g[3] + (y + 0.5) * g[5]) * degree;
    const double w2 = 1 - e2 * sin(latitude) * sin(latitude);
    const double north_km = a_km * (1 - e2) / (w2 * sqrt(w2)) * fabs(g[5]) * degree;
    const double east_km = a_km / sqrt(w2) * cos(latitude) * g[1] * degree;
    return north_km * east_km;
}

static void count_classes(struct work *w, int y, int rows)
{
    for (int row = 0; row < rows; row++) {
        const uint8_t *classes = w->bytes + (size_t)row * (size_t)w->view.width;
        const double area_km2 = pixel_km2(&w->grid, y + row);
        for (int x = 0; x < w->view.width; x++) {
            w->pixels[classes[x]]++;
            w->area_km2[classes[x]] += area_km2;
        }
    }
}

static int write_strip(struct work *w, const struct plane *plane, struct db_raster_out *out, int y,
                       struct db_qgis_layer *layer)
{
    const int rows = y + STRIP < w->view.height ? STRIP : w->view.height - y;
    const size_t count = (size_t)rows * (size_t)w->view.width;
    if (image_view_read(&w->image, &w->view, y, rows, w->values) != 0) {
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        const double value = (double)w->values[i];
        const bool is_there = !isnan(value);
        w->bytes[i] = is_there ? (uint8_t)(int)value : DB_CLASS_NODATA;
        if (is_there && plane->plane == IMAGE_PLANE_ELEVATION) {
            layer->low = fmin(layer->low, value);
            layer->high = fmax(layer->high, value);
        }
        w->values[i] = is_there ? w->values[i] : (float)no_data;
    }
    if (plane->plane != IMAGE_PLANE_CLASS) {
        return db_raster_write(out, y, rows, w->values);
    }
    count_classes(w, y, rows);
    return db_raster_write(out, y, rows, w->bytes);
}

/* The classes, which are the first plane, show where there is data. */
static int check_classes(struct work *w, struct db_raster_out *out)
{
    const uint64_t count = (uint64_t)w->view.width * (uint64_t)w->view.height;
    if (w->pixels[DB_CLASS_NODATA] == count) {
        return db_area_is_empty(w->settings->out, w->view.level);
    }
    db_class_raster_attributes(out, &w->table, w->pixels, w->area_km2);
    return 0;
}

static int write_raster(struct work *w, const struct plane *plane, const char *path,
                        struct db_qgis_layer *layer)
{
    struct db_raster_out out;
    struct hs_progress progress;
    w->view.plane = plane->plane;
    if (create(w, plane, &out, path) != 0) {
        return -1;
    }
    hs_progress_begin(&progress, image_plane_names[plane->plane], (uint64_t)w->view.height);
    int result = 0;
    for (int y = 0; result == 0 && y < w->view.height; y += STRIP) {
        result = write_strip(w, plane, &out, y, layer);
        hs_progress_update(&progress, (uint64_t)y);
    }
    hs_progress_end(&progress);
    if (result == 0 && plane->plane == IMAGE_PLANE_CLASS) {
        result = check_classes(w, &out);
    }
    if (result == 0) {
        return db_raster_commit_cog(&out, plane->resampling);
    }
    db_raster_abort(&out);
    return -1;
}

static int export_plane(struct work *w, int i)
{
    const struct plane *plane = &planes[i];
    const char *name = image_plane_names[plane->plane];
    struct db_qgis_layer *layer = &w->layers[i];
    char path[1024], style[32];
    snprintf(w->sources[i], sizeof w->sources[i], "./%s.tif", name);
    snprintf(w->ids[i], sizeof w->ids[i], "plane_%s", name);
    *layer = (struct db_qgis_layer){.kind = plane->plane == IMAGE_PLANE_CLASS ? DB_QGIS_CLASSES
                                                                              : DB_QGIS_GREY,
                                    .title = name,
                                    .source = w->sources[i],
                                    .id = w->ids[i],
                                    .low = plane->low,
                                    .high = plane->high};
    if (plane->plane == IMAGE_PLANE_ELEVATION) {
        layer->low = INFINITY;
        layer->high = -INFINITY;
    }
    snprintf(style, sizeof style, "%s.qml", name);
    if (hs_output_path(path, sizeof path, w->settings->out, w->sources[i] + 2) != 0 ||
        write_raster(w, plane, path, layer) != 0) {
        return -1;
    }
    if (!(layer->high > layer->low)) {
        layer->low = isfinite(layer->low) ? layer->low : 0;
        layer->high = layer->low + 1;
    }
    if (hs_output_path(path, sizeof path, w->settings->out, style) != 0) {
        return -1;
    }
    return db_qgis_style_write(path, layer, &w->table);
}

static int run(struct work *w)
{
    char path[1024];
    read_table(w);
    if (choose_grid(w) != 0) {
        return -1;
    }
    for (int i = 0; i < PLANES; i++) {
        if (export_plane(w, i) != 0) {
            return -1;
        }
    }
    if (hs_output_path(path, sizeof path, w->settings->out, "planes.qgs") != 0 ||
        db_qgis_project_write(path, "landmass planes", w->layers, PLANES, &w->grid, &w->table) !=
            0) {
        return -1;
    }
    printf("%d x %d pixels of level %d (cell %.2f m), %d classes\n", w->view.width, w->view.height,
           w->view.level, w->view.pixel_m, w->table.count);
    hs_report_put("width_px", w->view.width);
    hs_report_put("height_px", w->view.height);
    hs_report_put("level", w->view.level);
    hs_report_put("cell_m", w->view.pixel_m);
    hs_report_put("classes", w->table.count);
    hs_report_put("damaged_tiles", w->view.damaged_tiles);
    if (w->view.damaged_tiles > 0) {
        hs_warn(w->settings->out, "`landmass-db verify` says more",
                "damaged tiles were left out of every plane");
    }
    return 0;
}

int db_cmd_export(int argc, char **argv)
{
    hs_outputs_together();
    struct settings settings = {0};
    const char *path = NULL;
    int exit_code;
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        hs_error("export", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    w->settings = &settings;
    if (read_settings(&settings, argc, argv, &path, &exit_code)) {
        exit_code = HS_EXIT_USAGE;
        if (!settings.area || db_area_read(&w->view.area, settings.area) == 0) {
            const int opened = image_open(&w->image, path);
            exit_code = opened == 0 && run(w) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
            if (opened == 0) {
                image_close(&w->image);
            }
        }
    }
    if (w->grid.crs) {
        OSRDestroySpatialReference(w->grid.crs);
    }
    free(w->values);
    free(w->bytes);
    free(w);
    return exit_code;
}
