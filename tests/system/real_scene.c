#include "real_scene.h"

#include "drv/flash_file.h"
#include "hs/angle.h"
#include "lm/db.h"
#include "lm/scan_conv.h"
#include "lm/tile_unpack.h"
#include "support.h"

#include <gdal.h>
#include <geodesic.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

int real_scene_make(struct real_scene *scene, const char *name, const char *needed)
{
    char path[1024];
    strcpy(scene->data, "none");
    scene->is_here = !needed || (support_data_path(needed, path, sizeof path) &&
                                 support_data_path("", scene->data, sizeof scene->data));
    if (!scene->is_here) {
        return 0;
    }
    snprintf(scene->folder, sizeof scene->folder, "%s/tmp/real/%s", support_build_dir(), name);
    return support_run(
               "mkdir -p %s && sh host-sim/run/gallery_scene.sh %s/bin %s %s %s >%s/log 2>&1 || "
               "{ tail -n 20 %s/log | sed 's/^/# /'; exit 1; }",
               scene->folder, support_build_dir(), scene->data, scene->folder, name, scene->folder,
               scene->folder) == 0
               ? 0
               : -1;
}

/* The glass as grey, REAL_NO_PIXEL for symbols: they are coloured, the radar's picture is not. */
struct glass {
    int width, height;
    int *grey;
};

static int glass_read(struct glass *g, const struct real_scene *scene, const char *name)
{
    char path[2048];
    png_image image = {.version = PNG_IMAGE_VERSION};
    snprintf(path, sizeof path, "%s/%s.png", scene->folder, name);
    if (!png_image_begin_read_from_file(&image, path)) {
        printf("# %s: %s\n", path, image.message);
        return -1;
    }
    image.format = PNG_FORMAT_RGB;
    const size_t pixels = (size_t)image.width * image.height;
    uint8_t *rgb = malloc(PNG_IMAGE_SIZE(image));
    g->grey = malloc(pixels * sizeof *g->grey);
    if (!rgb || !g->grey || !png_image_finish_read(&image, NULL, rgb, 0, NULL)) {
        png_image_free(&image);
        free(rgb);
        free(g->grey);
        return -1;
    }
    g->width = (int)image.width;
    g->height = (int)image.height;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *p = rgb + 3 * i;
        g->grey[i] = p[0] == p[1] && p[1] == p[2] ? p[0] : REAL_NO_PIXEL;
    }
    free(rgb);
    return 0;
}

static void picture_clear(struct real_picture *p)
{
    for (int line = 0; line < REAL_CELLS; line++) {
        for (int cell = 0; cell < REAL_CELLS; cell++) {
            p->grey[line][cell] = REAL_NO_PIXEL;
        }
    }
}

int real_patch_read(struct real_picture *p, const struct real_scene *scene, const char *name)
{
    struct glass g;
    if (glass_read(&g, scene, name) != 0) {
        return -1;
    }
    const struct lm_frame f = lm_frame_of_display((uint16_t)g.width, (uint16_t)g.height);
    const struct lm_frame square = lm_patch_square(&f);
    const int bottom = square.top_px + square.height_px - 1;
    picture_clear(p);
    for (int line = 0; line < REAL_CELLS; line++) {
        for (int cell = 0; cell < REAL_CELLS; cell++) {
            /* The pixel that holds the middle of the cell. */
            const int right = (2 * line + 1) * square.width_px / (2 * REAL_CELLS);
            const int up = (2 * cell + 1) * square.height_px / (2 * REAL_CELLS);
            p->grey[line][cell] = g.grey[(bottom - up) * g.width + square.left_px + right];
        }
    }
    free(g.grey);
    return 0;
}

int real_ground_map_read(struct real_picture *p, const struct real_scene *scene, const char *name,
                         double height_cells)
{
    struct glass g;
    if (glass_read(&g, scene, name) != 0) {
        return -1;
    }
    const struct lm_frame f = lm_frame_of_display((uint16_t)g.width, (uint16_t)g.height);
    const double radius = lm_ppi_radius_px(&f, false);
    const int apex_x = f.left_px + f.width_px / 2, apex_y = f.top_px + f.height_px - 1;
    picture_clear(p);
    for (int y = f.top_px; y <= apex_y; y++) {
        for (int x = f.left_px; x < f.left_px + f.width_px; x++) {
            const double right = x - apex_x + 0.5, up = apex_y - y + 0.5;
            const double line = (atan2(right, up) * 180 / pi + 60) / 120 * REAL_CELLS;
            if (line < 0 || line >= REAL_CELLS) {
                continue;
            }
            const double middle = ((floor(line) + 0.5) / REAL_CELLS * 120 - 60) * pi / 180;
            const double slant = (right * sin(middle) + up * cos(middle)) / radius * REAL_CELLS;
            const double cell = sqrt(fmax(slant * slant - height_cells * height_cells, 0));
            const int grey = g.grey[y * g.width + x];
            if (cell < REAL_CELLS && grey != REAL_NO_PIXEL) {
                p->grey[(int)line][(int)cell] = grey;
            }
        }
    }
    free(g.grey);
    return 0;
}

struct real_place real_geodesic(struct real_place from, double azimuth_deg, double distance_m)
{
    struct geod_geodesic earth;
    struct real_place to;
    geod_init(&earth, 6378137, 1 / 298.257223563);
    geod_direct(&earth, from.latitude, from.longitude, azimuth_deg, distance_m, &to.latitude,
                &to.longitude, NULL);
    return to;
}

struct real_place real_patch_place(struct real_place centre, double look_deg, double cell_m,
                                   int line, int cell)
{
    const double across = (line + 0.5 - REAL_CELLS / 2.0) * cell_m,
                 along = (cell + 0.5 - REAL_CELLS / 2.0) * cell_m;
    return real_geodesic(centre, look_deg + atan2(across, along) * 180 / pi, hypot(across, along));
}

int real_raster_read(struct real_raster *r, const char *path)
{
    memset(r, 0, sizeof *r);
    GDALAllRegister();
    GDALDatasetH file = GDALOpen(path, GA_ReadOnly);
    double forward[6];
    if (!file || GDALGetGeoTransform(file, forward) != CE_None ||
        !GDALInvGeoTransform(forward, r->inverse)) {
        return -1;
    }
    r->width = GDALGetRasterXSize(file);
    r->height = GDALGetRasterYSize(file);
    const size_t count = (size_t)r->width * (size_t)r->height;
    r->values = malloc(count * sizeof *r->values);
    GDALRasterBandH band = GDALGetRasterBand(file, 1);
    int has_nodata;
    const double nodata = GDALGetRasterNoDataValue(band, &has_nodata);
    const int status = r->values
                           ? (int)GDALRasterIO(band, GF_Read, 0, 0, r->width, r->height, r->values,
                                               r->width, r->height, GDT_Float64, 0, 0)
                           : CE_Failure;
    for (size_t i = 0; status == CE_None && has_nodata && i < count; i++) {
        if (fabs(r->values[i] - nodata) < 1e-6) {
            r->values[i] = NAN;
        }
    }
    GDALClose(file);
    return status == CE_None ? 0 : -1;
}

void real_raster_free(struct real_raster *r)
{
    free(r->values);
    r->values = NULL;
}

static double pixel(const struct real_raster *r, double column, double row)
{
    if (!(column >= 0 && column < r->width && row >= 0 && row < r->height)) {
        return NAN;
    }
    return r->values[(size_t)row * (size_t)r->width + (size_t)column];
}

double real_raster_nearest(const struct real_raster *r, double x, double y)
{
    const double *t = r->inverse;
    return pixel(r, t[0] + t[1] * x + t[2] * y, t[3] + t[4] * x + t[5] * y);
}

double real_raster_bilinear(const struct real_raster *r, double x, double y)
{
    const double *t = r->inverse;
    const double column = t[0] + t[1] * x + t[2] * y - 0.5, row = t[3] + t[4] * x + t[5] * y - 0.5;
    const double c = floor(column), s = floor(row), u = column - c, v = row - s;
    return (1 - v) * ((1 - u) * pixel(r, c, s) + u * pixel(r, c + 1, s)) +
           v * ((1 - u) * pixel(r, c, s + 1) + u * pixel(r, c + 1, s + 1));
}

static int read_flash(const struct lm_flash *flash, uint64_t offset, void *to, uint32_t length)
{
    if (flash->read_start(flash->ctx, offset, to, length) != LM_OK) {
        return -1;
    }
    int status;
    do {
        status = flash->read_poll(flash->ctx);
    } while (status == LM_BUSY);
    return status == LM_OK ? 0 : -1;
}

/* The tile of a directory entry, unpacked. False when it cannot be read. */
static bool read_tile(const struct lm_db *db, const struct lm_tile_entry *e, struct lm_tile *tile)
{
    struct lm_tile_unpack unpack;
    const uint32_t bytes = (uint32_t)LM_DB_PLACE_BYTES * e->size;
    if (read_flash(db->flash, lm_db_tile_offset(db, e), lm_tile_unpack_place(tile, e->size),
                   bytes) != 0) {
        return false;
    }
    if (e->encoding == LM_TILE_RAW) {
        return true;
    }
    int status = lm_tile_unpack_begin(&unpack, tile, e->size);
    while (status == LM_BUSY) {
        status = lm_tile_unpack_run(&unpack);
    }
    return status == LM_OK;
}

/* The class index, or LM_DB_CLASS_NONE. */
static unsigned class_at(const struct lm_db *db, struct real_place place)
{
    const uint32_t latitude = hs_bam(place.latitude) + (1u << 30),
                   longitude = hs_bam(place.longitude);
    const uint32_t zone = lm_db_zone(hs_bam(place.latitude)), down = db->shift0,
                   across = db->shift0 + zone;
    const uint32_t row = latitude >> (down + LM_TILE_CELLS_LOG2),
                   column = longitude >> (across + LM_TILE_CELLS_LOG2);
    const int64_t entry = lm_db_entry(db, 0, row, column);
    struct lm_tile_entry e;
    struct lm_tile tile;
    if (entry < 0 ||
        read_flash(db->flash, lm_db_entry_offset(db, (uint32_t)entry), &e, sizeof e) != 0 ||
        lm_db_entry_check(db, (uint32_t)entry, &e) != LM_OK || e.place == LM_TILE_ABSENT ||
        !read_tile(db, &e, &tile) || lm_tile_check(&tile, 0, row, column) != LM_OK) {
        return LM_DB_CLASS_NONE;
    }
    const uint32_t r = latitude >> down & (LM_TILE_CELLS - 1);
    const uint32_t c = longitude >> across & (LM_TILE_CELLS - 1);
    return tile.points[r + LM_TILE_BORDER][c + LM_TILE_BORDER].cell >> 4 & 15u;
}

const char *real_image_class(const struct real_scene *scene, struct real_place place, char name[17])
{
    char path[2048];
    struct drv_flash_file flash;
    struct lm_db db;
    memset(name, 0, 17);
    snprintf(path, sizeof path, "%s/scene.lmdb", scene->folder);
    if (drv_flash_file_open(&flash, path) != 0) {
        return name;
    }
    if (lm_db_open(&db, &flash.port, 1000) == LM_OK) {
        const unsigned index = class_at(&db, place);
        if (index != LM_DB_CLASS_NONE) {
            memcpy(name, db.classes.entry[index].name, 16);
        }
    }
    drv_flash_file_close(&flash);
    return name;
}
