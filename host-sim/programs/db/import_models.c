/* Import of model files: one local frame, one grid. */
#include "import.h"

#include "hs/error.h"
#include "hs/number.h"
#include "hs/report.h"

#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    double metres;
} units[] = {{"m", 1},       {"cm", 0.01},   {"mm", 0.001},
             {"ft", 0.3048}, {"in", 0.0254}, {"us-ft", 1200.0 / 3937.0}};

static int read_axes(struct visual_axes *axes, const struct import_options *o)
{
    *axes = (struct visual_axes){0};
    for (size_t i = 0; o->unit && i < sizeof units / sizeof units[0]; i++) {
        if (strcmp(o->unit, units[i].name) == 0) {
            axes->metres_per_unit = units[i].metres;
        }
    }
    if (o->up) {
        axes->up = o->up[0] == 'y' ? VISUAL_UP_Y : VISUAL_UP_Z;
    }
    return 0;
}

/* Where the models' origin lies: in the grid's CRS and metres up. */
struct frame {
    double x, y, z;
    double metres_per_unit; /* of the CRS */
};

static int read_numbers(const char *option, const char *text, double numbers[3])
{
    numbers[2] = 0;
    const int found = hs_numbers(text, ',', numbers, 3);
    if (found != 2 && found != 3) {
        return hs_error(option, "see landmass-db import --help",
                        "`%s` is not two numbers, or three with a height", text);
    }
    return 0;
}

/* A transverse Mercator projection whose origin is the models'. */
static int frame_at(struct import *im, struct frame *f)
{
    double at[3];
    char proj[160];
    if (read_numbers("--at", im->options->at, at) != 0) {
        return -1;
    }
    if (!(fabs(at[0]) <= 89) || !(fabs(at[1]) <= 180)) {
        return hs_error("--at", "give LATITUDE,LONGITUDE in degrees", "`%s` is no place",
                        im->options->at);
    }
    *f = (struct frame){0, 0, at[2], 1};
    snprintf(proj, sizeof proj,
             "+proj=tmerc +lat_0=%.12g +lon_0=%.12g +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m",
             at[0], at[1]);
    return OSRSetFromUserInput(im->grid.crs, proj) == OGRERR_NONE
               ? 0
               : hs_error("--at", NULL, "PROJ makes no projection of it");
}

static int frame_in_crs(struct import *im, struct frame *f)
{
    double at[3] = {0, 0, 0};
    const char *crs = im->options->crs;
    if (OSRSetFromUserInput(im->grid.crs, crs) != OGRERR_NONE || !OSRIsProjected(im->grid.crs)) {
        return hs_error("--crs",
                        "name a projected one, as EPSG:28992, or say where the origin is with "
                        "--at LATITUDE,LONGITUDE",
                        "`%s` is no projected coordinate reference system", crs);
    }
    if (im->options->origin && read_numbers("--origin", im->options->origin, at) != 0) {
        return -1;
    }
    *f = (struct frame){at[0], at[1], at[2], OSRGetLinearUnits(im->grid.crs, NULL)};
    return 0;
}

static int make_frame(struct import *im, struct frame *f)
{
    const struct import_options *o = im->options;
    if ((o->at != NULL) == (o->crs != NULL) || (o->origin && !o->crs)) {
        return hs_error("--at", NULL,
                        "a model does not say where it stands; give either --at "
                        "LATITUDE,LONGITUDE[,HEIGHT] of its origin, or --crs and --origin "
                        "X,Y[,HEIGHT]");
    }
    if (!(o->cell_m > 0)) {
        return hs_error("--cell", "see landmass-db import --help",
                        "say how many metres a cell shall have");
    }
    im->grid.crs = OSRNewSpatialReference(NULL);
    OSRSetAxisMappingStrategy(im->grid.crs, OAMS_TRADITIONAL_GIS_ORDER);
    return o->at ? frame_at(im, f) : frame_in_crs(im, f);
}

struct bounds {
    double low[2], high[2];
};

static void widen(struct bounds *b, const struct visual_model *m)
{
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const struct visual_triangle *t = &m->triangles[i];
        for (int k = 0; k < 3; k++) {
            b->low[0] = fmin(b->low[0], (double)t->x[k]);
            b->high[0] = fmax(b->high[0], (double)t->x[k]);
            b->low[1] = fmin(b->low[1], (double)t->y[k]);
            b->high[1] = fmax(b->high[1], (double)t->y[k]);
        }
    }
}

/* The grid whose lines are multiples of the cell, around everything. */
static int make_grid(struct import *im, const struct frame *f, const struct bounds *b)
{
    const double cell = im->options->cell_m / f->metres_per_unit;
    const double west = floor((f->x + b->low[0] / f->metres_per_unit) / cell + 1e-6) * cell;
    const double north = ceil((f->y + b->high[1] / f->metres_per_unit) / cell - 1e-6) * cell;
    const double east = f->x + b->high[0] / f->metres_per_unit;
    const double south = f->y + b->low[1] / f->metres_per_unit;
    if (visual_canvas_open(&im->canvas, ceil((east - west) / cell - 1e-6),
                           ceil((north - south) / cell - 1e-6), im->place) != 0) {
        return -1;
    }
    im->grid.width = im->canvas.width;
    im->grid.height = im->canvas.height;
    im->grid.has_geotransform = true;
    memcpy(im->grid.geotransform, (double[6]){west, cell, 0, north, 0, -cell},
           sizeof im->grid.geotransform);
    im->terrain_grid = im->grid;
    return 0;
}

static void warn_coarse(const struct import *im, const char *name, const struct bounds *b)
{
    const double farthest =
        fmax(fmax(fabs(b->low[0]), fabs(b->high[0])), fmax(fabs(b->low[1]), fabs(b->high[1])));
    const double step = farthest * ldexp(1, -23);
    if (step > im->options->cell_m / 8) {
        hs_warn(name, "move it near its origin, and say with --origin where that is",
                "lies %.0f km from its origin, where single precision leaves %.2f m",
                farthest / 1e3, step);
    }
}

static void print_model(const struct visual_model *m, const char *name)
{
    printf("%s: %u triangles, %u upright or without area, %u materials\n", name, m->triangle_count,
           m->upright, m->material_count);
    hs_report_object(NULL);
    hs_report_put("path", name);
    hs_report_put("triangles", m->triangle_count);
    hs_report_put("upright_or_without_area", m->upright);
    hs_report_put("materials", m->material_count);
    hs_report_put("left_out", m->not_finite);
    hs_report_close();
    if (m->not_finite > 0) {
        hs_warn(name, "mend the model", "%u triangles are left out: a corner is no number",
                m->not_finite);
    }
}

static int place_model(struct import *im, const struct visual_model *m, const struct frame *f)
{
    const double *g = im->grid.geotransform;
    const double by = 1 / (f->metres_per_unit * g[1]);
    const struct visual_place place = {.at = {(f->x - g[0]) / g[1], (g[3] - f->y) / g[1]},
                                       .by = {{by, 0}, {0, -by}},
                                       .up = f->z,
                                       .up_by = 1};
    const int64_t first = visual_scene_skins(&im->scene, m, "");
    uint8_t *classes = first >= 0 ? malloc(m->material_count + 1) : NULL;
    if (!classes) {
        return first < 0 ? -1 : hs_error(im->place, NULL, "out of memory");
    }
    uint32_t unknown = 0, used = 0;
    const char *name = "";
    for (uint32_t i = 0; i < m->material_count; i++) {
        const int found = im->options->map ? import_class_of(im, m->materials[i].name) : -1;
        classes[i] = found >= 0 ? (uint8_t)found : DB_CLASS_NODATA;
        used += m->materials[i].is_used;
        if (m->materials[i].is_used && found < 0 && unknown++ == 0) {
            name = m->materials[i].name;
        }
    }
    if (im->options->map && unknown > 0) {
        hs_warn(im->options->map, "add them, or classify --out-image",
                "%u of %u materials have no class, `%s` the first", unknown, used, name);
    }
    const int result = visual_scene_place(&im->scene, m, (uint32_t)first, &place, classes);
    free(classes);
    return result;
}

static int look(struct import *im)
{
    if (visual_scene_look(&im->scene, &im->canvas, im->is_ground, im->place) != 0) {
        return -1;
    }
    if (!im->options->terrain && !im->options->heights) {
        return 0;
    }
    const struct visual_canvas *c = &im->canvas;
    const int64_t filled = visual_canvas_fill_ground(&im->canvas, im->place);
    im->heights = malloc((size_t)c->width * (size_t)c->height * sizeof *im->heights);
    im->terrain = malloc((size_t)c->width * (size_t)c->height * sizeof *im->terrain);
    if (filled < 0 || !im->heights || !im->terrain) {
        return filled < 0 ? -1 : hs_error(im->place, "choose a larger --cell", "out of memory");
    }
    hs_report_put("ground_pixels_filled", filled);
    printf("ground: %lld cells have none from above and take that around them\n",
           (long long)filled);
    for (size_t i = 0; i < (size_t)c->width * (size_t)c->height; i++) {
        const bool is_seen = c->patch[i] != 0;
        im->terrain[i] = isnan(c->ground[i]) ? (float)IMPORT_NODATA_M : c->ground[i];
        im->heights[i] = !is_seen                       ? (float)IMPORT_NODATA_M
                         : im->is_ground[c->classes[i]] ? 0
                                                        : fmaxf(0, c->top[i] - c->ground[i]);
    }
    return 0;
}

static int place_all(struct import *im, const struct frame *f, const struct visual_model *models)
{
    for (int i = 0; i < im->options->models.count; i++) {
        if (place_model(im, &models[i], f) != 0) {
            return -1;
        }
        import_warn_lost(im, models[i].lost_textures, models[i].lost);
    }
    import_warn_lost(im, im->scene.lost_textures, im->scene.lost);
    return look(im);
}

static int read_all(struct import *im, struct visual_model *models, struct bounds *all)
{
    struct visual_axes axes;
    if (read_axes(&axes, im->options) != 0) {
        return -1;
    }
    hs_report_array("models");
    for (int i = 0; i < im->options->models.count; i++) {
        const char *name = im->options->models.items[i];
        struct bounds own = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
        if (visual_model_read(&models[i], name, NULL, &axes) != 0) {
            return -1;
        }
        print_model(&models[i], name);
        widen(&own, &models[i]);
        widen(all, &models[i]);
        warn_coarse(im, name, &own);
    }
    hs_report_close();
    return all->low[0] < all->high[0]
               ? 0
               : hs_error(im->place, "see whether its --up is right", "shows nothing from above");
}

int import_models(struct import *im)
{
    const int count = im->options->models.count;
    struct frame f = {0};
    struct bounds b = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    struct visual_model *models = calloc((size_t)count, sizeof *models);
    if (!models) {
        return hs_error(im->place, NULL, "out of memory");
    }
    int result = make_frame(im, &f) == 0 ? read_all(im, models, &b) : -1;
    if (result == 0 && make_grid(im, &f, &b) == 0) {
        result = place_all(im, &f, models);
    } else {
        result = -1;
    }
    for (int i = 0; i < count; i++) {
        visual_model_free(&models[i]);
    }
    free(models);
    return result;
}
