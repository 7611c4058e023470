/* Import of an OGC CDB tree. */
#include "import.h"

#include "hs/error.h"
#include "hs/number.h"
#include "hs/report.h"
#include "visual/cdb_models.h"

#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char rasters[] = ".tif\0.jp2\0";

static int read_area(const struct import_options *o, struct cdb_area *a)
{
    double d[4];
    if (!o->area) {
        return 0;
    }
    if (hs_numbers(o->area, ',', d, 4) != 4 || d[0] >= d[2] || d[1] >= d[3]) {
        return hs_error("--area", "give SOUTH,WEST,NORTH,EAST in degrees", "`%s` is no area",
                        o->area);
    }
    *a = (struct cdb_area){.south = d[0], .west = d[1], .north = d[2], .east = d[3]};
    return 0;
}

static int finest_of(const struct cdb_tiles *t)
{
    return t->count > 0 ? t->items[t->count - 1].level : CDB_LEVEL_MIN;
}

/* The coarsest level whose pixels are not longer than the cell asked for, or that of the finest
 * imagery. */
static int choose_level(const struct import *im, const struct cdb_tiles *imagery)
{
    const double metres_per_degree = 111320;
    int level = finest_of(imagery);
    if (im->options->cell_m > 0) {
        level = CDB_LEVEL_MIN;
        while (level < CDB_LEVEL_MAX &&
               cdb_pixel_degrees(level) * metres_per_degree > 1.0001 * im->options->cell_m) {
            level++;
        }
    } else if (imagery->count == 0) {
        return hs_error("--cell", "say how many metres a cell shall have",
                        "%s has no imagery in the area whose pixels could be taken", im->place);
    }
    return level;
}

static void take_grid(struct db_grid *to, const struct cdb_grid *g, bool is_post, void *crs)
{
    *to = (struct db_grid){.width = g->width, .height = g->height, .has_geotransform = true};
    cdb_grid_geotransform(g, is_post, to->geotransform);
    to->crs = crs;
}

static int make_canvas(struct import *im, const struct cdb_grid *g, const struct visual_cdb *cdb)
{
    const double cells = pow(2, 20 + 2 * g->level) * (cdb->area.north - cdb->area.south) *
                         (cdb->area.east - cdb->area.west) / cdb->geocell_width;
    if (g->width == 0) {
        return hs_error(im->place, "choose a larger --cell or a smaller --area",
                        "becomes %.0f million cells; %.0f are made", cells / 1e6,
                        (double)VISUAL_CELLS_MAX / 1e6);
    }
    im->grid.crs = OSRNewSpatialReference(NULL);
    OSRSetFromUserInput(im->grid.crs, "EPSG:4326");
    OSRSetAxisMappingStrategy(im->grid.crs, OAMS_TRADITIONAL_GIS_ORDER);
    take_grid(&im->grid, g, false, im->grid.crs);
    return visual_canvas_open(&im->canvas, g->width, g->height, im->place);
}

static int read_elevation(struct import *im, struct visual_cdb *cdb, struct cdb_grid *g)
{
    struct cdb_tiles tiles = {0};
    if (visual_cdb_tiles(cdb, &tiles, CDB_ELEVATION, rasters) != 0) {
        return -1;
    }
    int result = 0;
    if (tiles.count > 0) {
        *g = cdb_grid_of(cdb, finest_of(&tiles));
        im->terrain = malloc((size_t)g->width * (size_t)g->height * sizeof *im->terrain + 1);
        result = im->terrain && g->width > 0
                     ? visual_cdb_elevation(cdb, &tiles, g, im->terrain)
                     : hs_error(im->place, "choose a smaller --area", "has too many posts");
        take_grid(&im->terrain_grid, g, true, im->grid.crs);
        hs_report_object("elevation");
        hs_report_put("tiles", tiles.count);
        hs_report_put("width_px", g->width);
        hs_report_put("height_px", g->height);
        hs_report_put("level", g->level);
        hs_report_close();
        printf("elevation: %zu tiles, %d x %d posts of level %d\n", tiles.count, g->width,
               g->height, g->level);
    } else if (im->options->terrain) {
        result = hs_error(im->place, "leave out --out-terrain, or build with --terrain none",
                          "has no elevation in the area");
    }
    cdb_tiles_free(&tiles);
    return result;
}

static int read_materials(struct import *im, struct visual_cdb *cdb, const struct cdb_grid *g)
{
    struct cdb_tiles tiles = {0};
    if (!im->options->map) {
        return 0;
    }
    if (visual_cdb_tiles(cdb, &tiles, CDB_MATERIALS, rasters) != 0) {
        return -1;
    }
    printf("materials: %zu tiles\n", tiles.count);
    hs_report_put("material_tiles", tiles.count);
    const int result = visual_cdb_materials(&tiles, g, &im->canvas, import_class_of, im);
    cdb_tiles_free(&tiles);
    return result;
}

static void report_models(const struct import *im, const struct cdb_models_count *n)
{
    printf("features: %llu points; %llu with models, %llu as boxes, %llu left out\n",
           (unsigned long long)n->features, (unsigned long long)n->placed,
           (unsigned long long)n->boxed, (unsigned long long)(n->missing + n->unreadable));
    hs_report_object("features");
    hs_report_put("points", n->features);
    hs_report_put("with_models", n->placed);
    hs_report_put("as_boxes", n->boxed);
    hs_report_put("without_model", n->missing);
    hs_report_put("unreadable", n->unreadable);
    hs_report_put("without_class", n->unclassed);
    hs_report_close();
    if (n->missing > 0) {
        hs_warn(im->place, "--boxes lets boxes of the size in the tables stand for them",
                "%llu features are left out: their models are not in the tree (%s the first)",
                (unsigned long long)n->missing, n->first_missing);
    }
    if (n->unreadable > 0) {
        hs_warn(im->place, NULL, "%llu features are left out: their models cannot be read",
                (unsigned long long)n->unreadable);
    }
    if (im->options->map && n->unclassed > 0) {
        hs_warn(im->options->map, "add their feature codes, as AL015 = structure",
                "%llu features have no class", (unsigned long long)n->unclassed);
    }
    import_warn_lost(im, n->lost_textures, n->lost);
    import_warn_lost(im, im->scene.lost_textures, im->scene.lost);
}

static int place_models(struct import *im, struct visual_cdb *cdb, const struct cdb_grid *cells,
                        const struct cdb_grid *posts)
{
    struct cdb_models_count count;
    const struct cdb_models m = {.cdb = cdb,
                                 .cells = cells,
                                 .post_grid = posts,
                                 .posts = im->terrain,
                                 .class_of = import_class_of,
                                 .class_context = im,
                                 .boxes = im->options->boxes};
    for (size_t i = 0; i < (size_t)cells->width * (size_t)cells->height; i++) {
        im->canvas.top[i] = 0; /* what a model has below the ground is not seen */
    }
    if (visual_cdb_place_models(&m, cdb, &im->scene, &count) != 0 ||
        visual_scene_look(&im->scene, &im->canvas, im->is_ground, im->place) != 0) {
        return -1;
    }
    report_models(im, &count);
    return 0;
}

/* Models stand on the elevation, so that their tops are heights above it. */
static int make_heights(struct import *im)
{
    const struct visual_canvas *c = &im->canvas;
    const size_t count = (size_t)c->width * (size_t)c->height;
    im->heights = malloc(count * sizeof *im->heights);
    if (!im->heights) {
        return hs_error(im->place, "choose a larger --cell", "out of memory");
    }
    for (size_t i = 0; i < count; i++) {
        im->heights[i] = c->top[i] > 0 ? c->top[i] : (float)IMPORT_NODATA_M;
    }
    const struct db_grid *g = &im->terrain_grid;
    for (size_t i = 0; im->terrain && i < (size_t)g->width * (size_t)g->height; i++) {
        im->terrain[i] = isnan(im->terrain[i]) ? (float)IMPORT_NODATA_M : im->terrain[i];
    }
    return 0;
}

static int import_tree(struct import *im, struct visual_cdb *cdb, const struct cdb_tiles *imagery)
{
    const int level = choose_level(im, imagery);
    uint64_t coarse;
    struct cdb_grid cells = cdb_grid_of(cdb, level), posts = {0};
    if (level < CDB_LEVEL_MIN || level > CDB_LEVEL_MAX || make_canvas(im, &cells, cdb) != 0 ||
        visual_cdb_paint(imagery, &cells, &im->canvas, &im->patches, &coarse) != 0) {
        return -1;
    }
    printf("imagery: %zu tiles, %d x %d cells of level %d\n", imagery->count, cells.width,
           cells.height, level);
    hs_report_object("imagery");
    hs_report_put("tiles", imagery->count);
    hs_report_put("level", level);
    hs_report_put("coarse_pixels", coarse);
    hs_report_close();
    if (coarse > 0) {
        hs_warn(im->place, "choose an --area within the fine imagery, or a larger --cell",
                "%.1f %% of the cells show imagery at least %d times coarser than they are",
                100.0 * (double)coarse / ((double)cells.width * cells.height),
                1 << CDB_COARSE_LEVELS);
    }
    if (read_elevation(im, cdb, &posts) != 0 || read_materials(im, cdb, &cells) != 0 ||
        place_models(im, cdb, &cells, &posts) != 0) {
        return -1;
    }
    hs_report_put("files_left_out", cdb->strangers);
    if (cdb->strangers > 0) {
        hs_warn(im->place, NULL, "%llu files are left out: their names are not those of its tiles",
                (unsigned long long)cdb->strangers);
    }
    return make_heights(im);
}

int import_cdb(struct import *im)
{
    struct cdb_area area = {-90, -180, 90, 180};
    struct visual_cdb cdb;
    struct cdb_tiles imagery = {0};
    if (read_area(im->options, &area) != 0 ||
        visual_cdb_open(&cdb, im->options->cdb, im->options->area ? &area : NULL) != 0 ||
        visual_cdb_tiles(&cdb, &imagery, CDB_IMAGERY, rasters) != 0) {
        return -1;
    }
    const int result = import_tree(im, &cdb, &imagery);
    cdb_tiles_free(&imagery);
    return result;
}
