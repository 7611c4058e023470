#include "resample/cover.h"

#include "gis/gdal_start.h"
#include "gis/length_unit.h"
#include "gis/plausible.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int plane_open(struct resample_plane *p, const char *path, const char *what)
{
    CPLErrorReset();
    *p =
        (struct resample_plane){.path = path, .dataset = db_gdal_note(GDALOpen(path, GA_ReadOnly))};
    if (!p->dataset) {
        return hs_error(path, "check the name and that `gdalinfo` can read it",
                        "cannot be opened as %s: %s", what, db_gdal_complaint());
    }
    if (GDALGetRasterCount(p->dataset) != 1) {
        return hs_error(path, "give the file that `landmass-db` wrote, or one band of it",
                        "holds %d bands instead of one", GDALGetRasterCount(p->dataset));
    }
    int given = 0;
    p->band = GDALGetRasterBand(p->dataset, 1);
    p->nodata = GDALGetRasterNoDataValue(p->band, &given);
    p->has_nodata = given && !isnan(p->nodata);
    return resample_georef_open(&p->georef, p->dataset, path);
}

static void plane_close(struct resample_plane *p)
{
    if (p->dataset) {
        GDALClose(p->dataset);
    }
    resample_georef_close(&p->georef);
    *p = (struct resample_plane){0};
}

static int check_grids(const struct resample_cover *c)
{
    const struct resample_georef *a = &c->classes.georef, *b = &c->reflectivity.georef;
    int x = 0, y = 0;
    if (a->width == b->width && a->height == b->height && resample_is_aligned(a, b, &x, &y) &&
        x == 0 && y == 0) {
        return 0;
    }
    return hs_error(c->reflectivity.path,
                    "make it from this class raster with `landmass-db reflect`",
                    "lies on another grid (%d x %d pixels) than %s (%d x %d)", b->width, b->height,
                    c->classes.path, a->width, a->height);
}

/* Unit, scale and offset of heights. */
static int read_scale(struct resample_plane *p)
{
    double metres;
    int given;
    if (db_band_unit(p->band, p->path, "gdal_edit.py -units", &metres) != 0) {
        return -1;
    }
    const double scale = GDALGetRasterScale(p->band, &given);
    p->scale = metres * (given ? scale : 1);
    const double offset = GDALGetRasterOffset(p->band, &given);
    p->offset = metres * (given ? offset : 0);
    return 0;
}

static int open_planes(struct resample_cover *c, const char *classes, const char *reflectivity,
                       const char *heights)
{
    if (plane_open(&c->classes, classes, "a class raster") != 0 ||
        (reflectivity &&
         plane_open(&c->reflectivity, reflectivity, "a reflectivity raster") != 0) ||
        (heights && (plane_open(&c->heights, heights, "a height raster") != 0 ||
                     read_scale(&c->heights) != 0)) ||
        (reflectivity && check_grids(c) != 0)) {
        return -1;
    }
    if (resample_area(&c->classes.georef, &c->area) != 0 ||
        resample_pixel_bam(&c->classes.georef, &c->pixel_latitude_bam, &c->pixel_longitude_bam) !=
            0) {
        return hs_error(classes, "check its geotransform and CRS with gdalinfo",
                        "its middle lies nowhere on Earth");
    }
    return 0;
}

int resample_cover_open(struct resample_cover *c, const struct db_class_table *table,
                        const char *classes, const char *reflectivity, const char *heights)
{
    *c = (struct resample_cover){.table = table};
    if (!classes) {
        return 0;
    }
    if (open_planes(c, classes, reflectivity, heights) != 0) {
        resample_cover_close(c);
        return -1;
    }
    return 0;
}

int resample_cover_judge(const struct resample_cover *c, bool is_trusted)
{
    const struct resample_plane *r = &c->reflectivity, *h = &c->heights;
    if (r->dataset && db_plausible_reflectivity(r->band, r->path, is_trusted) != 0) {
        return -1;
    }
    return h->dataset
               ? db_plausible_heights(h->band, h->path, h->scale, c->classes.band, is_trusted)
               : 0;
}

int resample_cover_set_codes(struct resample_cover *c, const struct db_code_map *codes)
{
    c->codes = codes;
    return db_code_map_survey(codes, c->table, c->classes.band, c->classes.path);
}

int resample_cover_set_numbers(struct resample_cover *c, bool ignores_names, bool is_known)
{
    if (is_known) {
        db_class_numbers_match(&c->numbers, c->classes.band, c->table, ignores_names);
        return 0;
    }
    return db_class_numbers_read(&c->numbers, c->classes.band, c->classes.path, c->table,
                                 ignores_names);
}

void resample_cover_close(struct resample_cover *c)
{
    plane_close(&c->classes);
    plane_close(&c->reflectivity);
    plane_close(&c->heights);
    c->area = (struct image_area){0};
}

void resample_cover_set_cell(struct resample_cover *c, uint8_t shift0)
{
    struct resample_plane *planes[] = {&c->classes, &c->heights};
    for (int i = 0; i < 2; i++) {
        if (planes[i]->dataset) {
            planes[i]->lattice = resample_lattice_of(&planes[i]->georef, shift0);
        }
    }
}

/* A window of one plane in memory, as the type asked for. */
static void *read_window(const struct resample_plane *p, const struct resample_window *w,
                         GDALDataType type)
{
    const size_t bytes = (size_t)GDALGetDataTypeSizeBytes(type);
    void *pixels = malloc((size_t)w->width * (size_t)w->height * bytes);
    if (!pixels) {
        hs_error(p->path, "choose smaller cells", "out of memory");
        return NULL;
    }
    CPLErrorReset();
    if (GDALRasterIO(p->band, GF_Read, w->x, w->y, w->width, w->height, pixels, w->width, w->height,
                     type, 0, 0) != CE_None) {
        hs_error(p->path, "the file may be cut short; make it again",
                 "cannot be read at rows %d..%d: %s", w->y, w->y + w->height - 1,
                 db_gdal_complaint());
        free(pixels);
        return NULL;
    }
    return pixels;
}

/* Where each sample lies in a plane, and the pixels around them. */
struct lookup {
    struct resample_window window;
    double *x, *y;
};

static bool find(const struct lookup *l, size_t i, size_t *pixel)
{
    const struct resample_window *w = &l->window;
    const double x = floor(l->x[i]), y = floor(l->y[i]);
    if (!(x >= w->x && x < w->x + w->width && y >= w->y && y < w->y + w->height)) {
        return false;
    }
    *pixel = (size_t)((int)y - w->y) * (size_t)w->width + (size_t)((int)x - w->x);
    return true;
}

static int unknown_class(const struct resample_cover *c, const struct lookup *l, size_t i,
                         int value)
{
    char place[512], names[512];
    db_class_names(c->table, names, sizeof names);
    snprintf(place, sizeof place, "%s pixel %.0f, %.0f", c->classes.path, floor(l->x[i]),
             floor(l->y[i]));
    return hs_error(place, "give the class table that the raster was made with",
                    "holds class %d, but the table ends at %d (%s)", value, c->table->count - 1,
                    names);
}

/* The class of a pixel's value: an index of the table, DB_CLASS_NODATA, or -1 when it is neither.
 */
static int class_of(const struct resample_cover *c, int32_t value)
{
    if (c->classes.has_nodata && value == c->classes.nodata) {
        return DB_CLASS_NODATA;
    }
    if (c->codes) {
        return db_code_map_class(c->codes, value);
    }
    const int index = value >= 0 && value < 256 ? c->numbers.class_of[value] : DB_CLASS_UNKNOWN;
    return index == DB_CLASS_UNKNOWN ? -1 : index;
}

static int take_classes(const struct resample_cover *c, const struct lookup *l,
                        const int32_t *pixels, size_t count, struct resample_sample *samples)
{
    int found = 0;
    for (size_t i = 0; i < count; i++) {
        size_t at;
        samples[i] = (struct resample_sample){.class_number = LM_DB_CLASS_NONE};
        const int class_index = find(l, i, &at) ? class_of(c, pixels[at]) : DB_CLASS_NODATA;
        if (class_index < 0) {
            return unknown_class(c, l, i, pixels[at]);
        }
        if (class_index != DB_CLASS_NODATA) {
            samples[i].class_number = (uint8_t)class_index;
            found++;
        }
    }
    return found;
}

static bool is_value(const struct resample_plane *p, float value)
{
    return isfinite(value) && !(p->has_nodata && value == (float)p->nodata);
}

static int take_reflectivity(const struct resample_cover *c, const struct lookup *l, size_t count,
                             struct resample_sample *samples)
{
    float *pixels = read_window(&c->reflectivity, &l->window, GDT_Float32);
    if (!pixels) {
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        size_t at;
        if (find(l, i, &at) && is_value(&c->reflectivity, pixels[at])) {
            samples[i].has_gamma = true;
            samples[i].gamma_db = pixels[at];
        }
    }
    free(pixels);
    return 0;
}

static int take_heights(const struct resample_cover *c, const struct lookup *l, size_t count,
                        struct resample_sample *samples)
{
    if (l->window.width == 0) {
        return 0;
    }
    float *pixels = read_window(&c->heights, &l->window, GDT_Float32);
    if (!pixels) {
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        size_t at;
        if (find(l, i, &at) && is_value(&c->heights, pixels[at])) {
            samples[i].has_height = true;
            samples[i].height_m = (float)(pixels[at] * c->heights.scale + c->heights.offset);
        }
    }
    free(pixels);
    return 0;
}

static void locate(struct lookup *l, const struct resample_plane *p,
                   const struct image_frame *frame, int parts, size_t count)
{
    struct resample_mesh mesh;
    resample_mesh_make(&mesh, &p->georef, &p->lattice, frame);
    resample_mesh_cells(&mesh, parts, l->x, l->y);
    l->window = resample_window_of(&p->georef, count, l->x, l->y, 0);
}

static int sample_planes(const struct resample_cover *c, const struct image_frame *frame, int parts,
                         struct lookup *l, struct resample_sample *samples)
{
    const size_t count = (size_t)(LM_TILE_CELLS * parts) * (size_t)(LM_TILE_CELLS * parts);
    locate(l, &c->classes, frame, parts, count);
    if (l->window.width == 0) {
        return 0;
    }
    int32_t *pixels = read_window(&c->classes, &l->window, GDT_Int32);
    if (!pixels) {
        return -1;
    }
    const int found = take_classes(c, l, pixels, count, samples);
    free(pixels);
    if (found <= 0) {
        return found;
    }
    if (c->reflectivity.dataset && take_reflectivity(c, l, count, samples) != 0) {
        return -1;
    }
    if (c->heights.dataset) {
        locate(l, &c->heights, frame, parts, count);
        if (take_heights(c, l, count, samples) != 0) {
            return -1;
        }
    }
    return found;
}

int resample_cover_tile(const struct resample_cover *c, const struct image_frame *frame, int parts,
                        struct resample_sample *samples)
{
    const size_t count = (size_t)(LM_TILE_CELLS * parts) * (size_t)(LM_TILE_CELLS * parts);
    const struct image_area area = image_frame_area(frame);
    for (size_t i = 0; i < count; i++) {
        samples[i] = (struct resample_sample){.class_number = LM_DB_CLASS_NONE};
    }
    if (!c->classes.dataset || !image_areas_meet(&c->area, &area)) {
        return 0;
    }
    struct lookup l = {.x = malloc(count * sizeof(double)), .y = malloc(count * sizeof(double))};
    int found = -1;
    if (l.x && l.y) {
        found = sample_planes(c, frame, parts, &l, samples);
    } else {
        hs_error(c->classes.path, "choose smaller cells", "out of memory");
    }
    free(l.x);
    free(l.y);
    return found;
}
