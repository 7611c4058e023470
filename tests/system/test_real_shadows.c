/* Shadows of patches against somebody else's lines of sight: GDAL's viewshed over the full terrain,
 * not over what the image's coarser levels left of it. Patches from narrow and far to wide and
 * near, where lines that were parallel would cast their shadows beside the true ones. */
#include "check.h"
#include "lm/sar.h"
#include "memory_flash.h"
#include "real_scene.h"
#include "support.h"
#include "tiny_image.h"

#include <cpl_string.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <gdalwarper.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POLLS = 16, POOL_TILES = 4000, CELLS = 256 };

static const double post_m = 20; /* of the terrain that the viewshed works on */

/* The map as the firmware reads it. */
struct world {
    uint8_t *image; /* owned */
    size_t size;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    void *pool;
    struct lm_sar sar;
    struct lm_line line;
    int16_t level_q8[LM_CELLS_ROOM];
};

struct patch {
    struct real_place centre; /* seen from the south */
    double range_m, height_m, side_m;
};

static void open_world(struct world *w)
{
    const size_t bytes = POOL_TILES * sizeof(struct lm_tile);
    memory_flash_open(&w->flash, w->image, w->size);
    w->pool = malloc(bytes);
    assert_non_null(w->pool);
    assert_int_equal(lm_db_open(&w->db, &w->flash.port, POLLS), LM_OK);
    assert_int_equal(lm_tile_cache_init(&w->tiles, &w->db, w->pool, bytes, POLLS), LM_OK);
}

static void close_world(struct world *w)
{
    free(w->pool);
    free(w->image);
    free(w);
}

static void read_tiles(struct world *w)
{
    for (int i = 0; i < 100000 && !lm_tile_cache_is_idle(&w->tiles); i++) {
        lm_tile_cache_service(&w->tiles, 0, 1);
    }
    assert_true(lm_tile_cache_is_idle(&w->tiles));
}

/* ---- the terrain as the oracle sees it ---- */

/* An empty raster in memory, equidistant about the antenna, from 1 km behind it to beyond the
 * patch. The antenna is the middle of a pixel. */
static GDALDatasetH make_raster(const struct patch *p, struct real_place antenna)
{
    const int half = (int)ceil((p->side_m / 2 + 500) / post_m);
    const int width = 2 * half + 1, ahead = (int)ceil((p->range_m + p->side_m / 2 + 500) / post_m);
    const int height = ahead + (int)(1000 / post_m);
    char srs_text[200];
    snprintf(srs_text, sizeof srs_text, "+proj=aeqd +lat_0=%.9f +lon_0=%.9f +datum=WGS84 +units=m",
             antenna.latitude, antenna.longitude);
    OGRSpatialReferenceH srs = OSRNewSpatialReference(NULL);
    assert_int_equal(OSRImportFromProj4(srs, srs_text), OGRERR_NONE);
    GDALDatasetH d =
        GDALCreate(GDALGetDriverByName("MEM"), "", width, height, 1, GDT_Float32, NULL);
    assert_non_null(d);
    double forward[6] = {-(half + 0.5) * post_m, post_m, 0, (ahead + 0.5) * post_m, 0, -post_m};
    GDALSetGeoTransform(d, forward);
    GDALSetSpatialRef(d, srs);
    OSRDestroySpatialReference(srs);
    return d;
}

static int width_of(GDALDatasetH d)
{
    return GDALGetRasterXSize(d);
}

static int height_of(GDALDatasetH d)
{
    return GDALGetRasterYSize(d);
}

static void *read_band(GDALDatasetH d, GDALDataType type, size_t bytes)
{
    void *values = malloc((size_t)width_of(d) * (size_t)height_of(d) * bytes);
    assert_non_null(values);
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(d, 1), GF_Read, 0, 0, width_of(d), height_of(d),
                                  values, width_of(d), height_of(d), type, 0, 0),
                     CE_None);
    return values;
}

/* 1 where the ground of the raster is seen. The oracle's heights are above the ground below it. */
static uint8_t *viewshed(GDALDatasetH terrain, const struct patch *p)
{
    double forward[6];
    GDALGetGeoTransform(terrain, forward);
    float below_m;
    const int column = (int)(-forward[0] / post_m), row = (int)(forward[3] / post_m);
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(terrain, 1), GF_Read, column, row, 1, 1,
                                  &below_m, 1, 1, GDT_Float32, 0, 0),
                     CE_None);
    /* Radar waves: an Earth of 4/3 its radius takes 3/4 of the drop. */
    GDALDatasetH seen = GDALViewshedGenerate(GDALGetRasterBand(terrain, 1), "MEM", "", NULL, 0, 0,
                                             p->height_m - below_m, 0, 1, 0, 0, -1, 0.75, GVM_Max,
                                             0, NULL, NULL, GVOT_NORMAL, NULL);
    assert_non_null(seen);
    assert_int_equal(width_of(seen), width_of(terrain));
    assert_int_equal(height_of(seen), height_of(terrain));
    uint8_t *values = read_band(seen, GDT_Byte, 1);
    GDALClose(seen);
    return values;
}

/* ---- the patch ---- */

/* Which cells of which lines the firmware leaves without an echo: 1 for a shadow. */
static uint8_t *draw_shadows(struct world *w, const struct patch *p)
{
    const struct lm_sar_command command = {
        .centre = {(fx_bam_t)(int32_t)lround(p->centre.latitude / 360 * 4294967296.0),
                   (fx_bam_t)(int32_t)lround(p->centre.longitude / 360 * 4294967296.0)},
        .cell_mm = (uint32_t)lround(p->side_m / CELLS * 1000),
        .range_m = (uint32_t)p->range_m,
        .height_m_q6 = (int32_t)(p->height_m * 64)};
    const struct lm_sar_setup setup = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_sar_start(&w->sar, &lm_radar_default, &w->db, &command, &setup), LM_OK);
    uint8_t *shadows = malloc((size_t)w->sar.lines * CELLS);
    assert_non_null(shadows);
    for (uint32_t line = 0; line < w->sar.lines; line++) {
        lm_sar_prefetch(&w->sar, &w->tiles, line);
        read_tiles(w);
        lm_sar_sample_line(&w->sar, &w->tiles, line, &w->line, w->level_q8);
        for (int i = 0; i < CELLS; i++) {
            shadows[line * CELLS + (uint32_t)i] = w->line.lit.level_db_q8[i] == LM_LEVEL_SHADOW;
        }
    }
    return shadows;
}

/* ---- both ---- */

struct overlap {
    int both, either, pixels;
    int sure_both, sure_either; /* of pixels farther than a cell from any border of the viewshed */
    int cells_both, cells_either; /* of the patch's cells, the viewshed asked in their middles */
    int shown_both, shown_either; /* of pixels, the viewshed itself shown in the patch's cells */
};

/* The terrain's grid, and what its viewshed has seen. */
struct oracle {
    const uint8_t *seen;
    int width, height;
    double forward[6];
};

static bool is_hidden(const struct oracle *o, const struct patch *p, double right_m,
                      double beyond_m)
{
    const int column = (int)floor((right_m - o->forward[0]) / post_m);
    const int row = (int)floor((o->forward[3] - p->range_m - beyond_m) / post_m);
    assert_true(column >= 0 && column < o->width && row >= 0 && row < o->height);
    return !o->seen[row * o->width + column];
}

/* The patch's cell that has the place: on the ray to it, by EQUATIONS.md. */
struct cell {
    int line, cell;
};

static struct cell cell_of(const struct world *w, const struct patch *p, double right_m,
                           double beyond_m)
{
    const double cell_m = p->side_m / CELLS;
    const double line = right_m * p->range_m / (p->range_m + beyond_m) / cell_m;
    const struct cell c = {(int)floor(line + w->sar.lines / 2.0),
                           (int)floor(beyond_m / cell_m + CELLS / 2)};
    assert_true(c.line >= 0 && c.line < (int)w->sar.lines && c.cell >= 0 && c.cell < CELLS);
    return c;
}

static double beyond_m_of(const struct patch *p, struct cell c)
{
    return (c.cell + 0.5 - CELLS / 2) * p->side_m / CELLS;
}

static double right_m_of(const struct world *w, const struct patch *p, struct cell c)
{
    return (c.line + 0.5 - w->sar.lines / 2.0) * p->side_m / CELLS *
           (p->range_m + beyond_m_of(p, c)) / p->range_m;
}

static bool is_inside(const struct patch *p, double right_m, double beyond_m)
{
    return fabs(right_m) < p->side_m / 2 - 1 && fabs(beyond_m) < p->side_m / 2 - 1;
}

/* True if the viewshed says the same of all pixels within `reach` pixels. */
static bool is_sure(const uint8_t *seen, int width, int row, int column, int reach)
{
    const uint8_t here = seen[row * width + column];
    for (int y = row - reach; y <= row + reach; y++) {
        for (int x = column - reach; x <= column + reach; x++) {
            if (seen[y * width + x] != here) {
                return false;
            }
        }
    }
    return true;
}

/* Pixel by pixel of the terrain. */
static void compare_pixels(struct overlap *o, const struct world *w, const struct patch *p,
                           const struct oracle *oracle, const uint8_t *shadows)
{
    const int reach = (int)ceil(p->side_m / CELLS / post_m);
    for (int row = 0; row < oracle->height; row++) {
        for (int column = 0; column < oracle->width; column++) {
            const double right_m = oracle->forward[0] + (column + 0.5) * post_m;
            const double beyond_m = oracle->forward[3] - (row + 0.5) * post_m - p->range_m;
            if (!is_inside(p, right_m, beyond_m)) {
                continue;
            }
            const struct cell c = cell_of(w, p, right_m, beyond_m);
            const bool hidden = is_hidden(oracle, p, right_m, beyond_m);
            const bool dark = shadows[c.line * CELLS + c.cell];
            const bool shown = is_hidden(oracle, p, right_m_of(w, p, c), beyond_m_of(p, c));
            o->both += hidden && dark;
            o->either += hidden || dark;
            o->shown_both += hidden && shown;
            o->shown_either += hidden || shown;
            o->pixels++;
            if (is_sure(oracle->seen, oracle->width, row, column, reach)) {
                o->sure_both += hidden && dark;
                o->sure_either += hidden || dark;
            }
        }
    }
}

/* Cell by cell of the patch. */
static void compare_cells(struct overlap *o, const struct world *w, const struct patch *p,
                          const struct oracle *oracle, const uint8_t *shadows)
{
    for (int k = 0; k < (int)w->sar.lines * CELLS; k++) {
        const struct cell c = {k / CELLS, k % CELLS};
        const double right_m = right_m_of(w, p, c), beyond_m = beyond_m_of(p, c);
        if (is_inside(p, right_m, beyond_m)) {
            const bool hidden = is_hidden(oracle, p, right_m, beyond_m);
            o->cells_both += hidden && shadows[k];
            o->cells_either += hidden || shadows[k];
        }
    }
}

/* Overlap: the area that both have in shadow over the area that either has. Cell by cell of the
 * patch it is at least `least`. */
static void judge(struct world *w, const struct patch *p, GDALDatasetH terrain, double least)
{
    uint8_t *seen = viewshed(terrain, p), *shadows = draw_shadows(w, p);
    struct oracle oracle = {.seen = seen, .width = width_of(terrain), .height = height_of(terrain)};
    struct overlap o = {0};
    GDALGetGeoTransform(terrain, oracle.forward);
    compare_pixels(&o, w, p, &oracle, shadows);
    compare_cells(&o, w, p, &oracle, shadows);
    const double overlap = (double)o.both / o.either, sure = (double)o.sure_both / o.sure_either;
    const double of_cells = (double)o.cells_both / o.cells_either;
    print_message(
        "# %.1f km wide at %.0f km: %.1f %% in shadow, overlap %.3f, of cells %.3f, "
        "farther than a cell from borders %.3f; of the viewshed in such cells %.3f\n",
        p->side_m / 1000, p->range_m / 1000, 100.0 * o.both / o.pixels, overlap, of_cells, sure,
        (double)o.shown_both / o.shown_either);
    assert_true(o.both * 4 > o.pixels && of_cells >= least && sure >= 0.99);
    free(seen);
    free(shadows);
}

/* ---- hills of our own ---- */

static double hills_m(double latitude_deg, double longitude_deg)
{
    const double north = latitude_deg * 111000, east = longitude_deg * 77000;
    return 500 + 170 * sin(north / 290 + sin(east / 900)) * cos(east / 410) +
           120 * sin((north + east) / 830) + 60 * cos((north - 2 * east) / 350);
}

static double tiny_hills_m(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    return hills_m(place->latitude_deg, place->longitude_deg);
}

static void fill_with_hills(GDALDatasetH d, struct real_place antenna)
{
    double forward[6];
    GDALGetGeoTransform(d, forward);
    float *row_m = malloc((size_t)width_of(d) * sizeof *row_m);
    assert_non_null(row_m);
    for (int row = 0; row < height_of(d); row++) {
        const double north_m = forward[3] - (row + 0.5) * post_m;
        for (int column = 0; column < width_of(d); column++) {
            const double east_m = forward[0] + (column + 0.5) * post_m;
            const struct real_place p = real_geodesic(
                antenna, atan2(east_m, north_m) * 180 / acos(-1.0), hypot(east_m, north_m));
            row_m[column] = (float)hills_m(p.latitude, p.longitude);
        }
        assert_int_equal(GDALRasterIO(GDALGetRasterBand(d, 1), GF_Write, 0, row, width_of(d), 1,
                                      row_m, width_of(d), 1, GDT_Float32, 0, 0),
                         CE_None);
    }
    free(row_m);
}

/* Over the mountains the widest two patches, in cells of 40 m, have an overlap of 0.964 and 0.951
 * cell by cell, with posts 38 m apart for terrain of 92 x 66 m; with posts 76 m apart 0.947 and
 * 0.929. What each law adds, at 12 km:
 *
 *     posts 76 m apart, samples of the terrain                        0.914
 *     the same, fitted (host-sim/terrain/fit.h)                       0.929
 *     posts 38 m apart, samples                                       0.941
 *     the same, fitted                                                0.946
 *     and with the crests between cells (EQUATIONS.md)                0.951
 *
 * Fixed point loses nothing: the same law in double precision has the same figures. Pixel by pixel
 * of 20 m the viewshed's own answer, asked in the middles of these cells, has no more than
 * 0.961 and 0.949. With parallel lines the widest two have an overlap of 0.80 and 0.88 over the
 * hills, and of 0.75 and 0.84 over the mountains. */
static const struct {
    double range_m, height_m, side_m, least_of_hills, least_of_mountains, least_of_coarse_mountains;
} views[] = {
    {10000, 2000, 2560, 0.95, 0.97, 0.95},   {15000, 2500, 5120, 0.95, 0.97, 0.95},
    {20000, 3000, 5120, 0.95, 0.97, 0.95},   {30000, 4000, 5120, 0.95, 0.97, 0.95},
    {60000, 7000, 5120, 0.95, 0.97, 0.95},   {20000, 3000, 10240, 0.95, 0.96, 0.94},
    {12000, 2500, 10240, 0.95, 0.95, 0.925},
};

TEST(shadows_of_hills_fall_where_gdal_has_them)
{
    struct world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    const struct real_place centre = {46, 11};
    struct tiny_spec spec = tiny_spec_at(46 - 0.24, 11);
    spec.shift0 = 11;
    spec.rows = 60;
    spec.columns = 12;
    spec.elevation_m = tiny_hills_m;
    struct tiny_image image;
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    w->image = image.bytes;
    w->size = image.size;
    open_world(w);
    GDALAllRegister();
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        const struct patch p = {centre, views[i].range_m, views[i].height_m, views[i].side_m};
        const struct real_place antenna = real_geodesic(centre, 180, p.range_m);
        GDALDatasetH terrain = make_raster(&p, antenna);
        fill_with_hills(terrain, antenna);
        judge(w, &p, terrain, views[i].least_of_hills);
        GDALClose(terrain);
    }
    close_world(w);
}

/* ---- real mountains ---- */

/* The Alps behind Nice, made into an image of about this cell by the builder; 0: its default. False
 * where the data are not here. */
static bool open_mountains(struct world *w, int cell_m, char *terrain_path, size_t size)
{
    char path[1024], image_path[1100];
    if (!support_data_path("srtm_hgt/N43E007.hgt.zip", path, sizeof path)) {
        return false;
    }
    snprintf(terrain_path, size, "/vsizip/%s/N43E007.hgt", path);
    snprintf(image_path, sizeof image_path, "%s/tmp/shadows.lmdb", support_build_dir());
    assert_int_equal(support_run("mkdir -p %s/tmp && %s/bin/landmass-db build --title shadows "
                                 "--classes host-sim/gallery/terrain.classes --terrain %s "
                                 "--cell %d --land-class land --water-class sea --out %s",
                                 support_build_dir(), support_build_dir(), path, cell_m,
                                 image_path),
                     0);
    FILE *f = fopen(image_path, "rb");
    assert_non_null(f);
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    w->size = (size_t)ftell(f);
    rewind(f);
    w->image = malloc(w->size);
    assert_non_null(w->image);
    assert_int_equal(fread(w->image, 1, w->size, f), w->size);
    fclose(f);
    return true;
}

/* The terrain of a file, its voids filled by GDAL: left as they are, they would be pits down to the
 * sea, hidden from everywhere. */
static void fill_from(GDALDatasetH d, const char *path)
{
    GDALDatasetH file = GDALOpen(path, GA_ReadOnly);
    assert_non_null(file);
    GDALDatasetH from =
        GDALCreateCopy(GDALGetDriverByName("MEM"), "", file, FALSE, NULL, NULL, NULL);
    assert_non_null(from);
    assert_int_equal(GDALFillNodata(GDALGetRasterBand(from, 1), NULL, 100, 0, 0, NULL, NULL, NULL),
                     CE_None);
    assert_int_equal(GDALReprojectImage(from, NULL, d, NULL, GRA_Bilinear, 0, 0, NULL, NULL, NULL),
                     CE_None);
    GDALClose(from);
    GDALClose(file);
}

/* False where the data are not here. */
static bool judge_mountains(int cell_m)
{
    char path[1200];
    struct world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    if (!open_mountains(w, cell_m, path, sizeof path)) {
        free(w);
        return false;
    }
    open_world(w);
    GDALAllRegister();
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        const struct real_place centre = {43.93, 7.3};
        const struct patch p = {centre, views[i].range_m, views[i].height_m + 1500,
                                views[i].side_m};
        GDALDatasetH terrain = make_raster(&p, real_geodesic(centre, 180, p.range_m));
        fill_from(terrain, path);
        judge(w, &p, terrain,
              cell_m ? views[i].least_of_coarse_mountains : views[i].least_of_mountains);
        GDALClose(terrain);
    }
    close_world(w);
    return true;
}

TEST(shadows_of_real_mountains_fall_where_gdal_has_them)
{
    if (!judge_mountains(0)) {
        skip();
    }
}

TEST(posts_as_far_apart_as_the_terrain_s_leave_them_less_near)
{
    if (!judge_mountains(76)) {
        skip();
    }
}
