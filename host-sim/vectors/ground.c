#include "gis/class_numbers.h"
#include "gis/gdal_start.h"
#include "hs/error.h"
#include "vectors/output.h"

#include <cpl_conv.h>
#include <gdalwarper.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NOT_COVERED = -1 };

/* A raster of GDAL's over an array in memory. */
static GDALDatasetH raster_over(const struct db_grid *g, int32_t *pixels)
{
    double transform[6];
    char address[32] = "", option[64];
    memcpy(transform, g->geotransform, sizeof transform);
    CPLPrintPointer(address, pixels, sizeof address - 1);
    snprintf(option, sizeof option, "DATAPOINTER=%s", address);
    char *options[] = {option, NULL};
    GDALDatasetH raster =
        GDALCreate(GDALGetDriverByName("MEM"), "", g->width, g->height, 0, GDT_Int32, NULL);
    if (raster && (GDALAddBand(raster, GDT_Int32, options) != CE_None ||
                   GDALSetGeoTransform(raster, transform) != CE_None ||
                   GDALSetSpatialRef(raster, g->crs) != CE_None)) {
        GDALClose(raster);
        raster = NULL;
    }
    return raster;
}

/* Length of a pixel, metres: the suggested warp of the raster to the plane tells. */
static double pixel_m(GDALDatasetH ground, const struct db_grid *g)
{
    char *wkt = NULL;
    double transform[6] = {0};
    int width, height;
    OSRExportToWkt(g->crs, &wkt);
    void *way = GDALCreateGenImgProjTransformer(ground, NULL, NULL, wkt, FALSE, 0, 1);
    if (way && GDALSuggestedWarpOutput(ground, GDALGenImgProjTransform, way, transform, &width,
                                       &height) != CE_None) {
        transform[1] = 0;
    }
    if (way) {
        GDALDestroyGenImgProjTransformer(way);
    }
    CPLFree(wkt);
    return transform[1];
}

static int warp(const struct vector_map *map, GDALDatasetH ground, const char *path,
                int32_t *pixels)
{
    const double pixel = pixel_m(ground, &map->grid);
    GDALDatasetH raster = pixel > 0 ? raster_over(&map->grid, pixels) : NULL;
    const GDALResampleAlg way = pixel <= map->cell_m / 2 ? GRA_Mode : GRA_NearestNeighbour;
    CPLErrorReset();
    const bool is_warped = raster && GDALReprojectImage(ground, NULL, raster, NULL, way, 0, 0.1,
                                                        NULL, NULL, NULL) == CE_None;
    if (raster) {
        GDALClose(raster);
    }
    return is_warped ? 0
                     : hs_error(path, "check its coordinate reference system with gdalinfo",
                                "cannot be brought to the area: %s", db_gdal_complaint());
}

/* What the pixels mean: codes of a land cover, or numbers of classes. */
struct meaning {
    const struct db_code_map *codes; /* NULL: class numbers */
    struct db_class_numbers numbers;
};

static int class_of(const struct meaning *m, int32_t value)
{
    if (m->codes) {
        return db_code_map_class(m->codes, value);
    }
    const int index = value >= 0 && value < 256 ? m->numbers.class_of[value] : DB_CLASS_UNKNOWN;
    return index == DB_CLASS_UNKNOWN ? -1 : index;
}

static int take_pixels(struct vector_map *map, const int32_t *pixels, const char *path,
                       const struct meaning *meaning)
{
    const size_t cells = (size_t)map->grid.width * (size_t)map->grid.height;
    for (size_t i = 0; i < cells; i++) {
        const int class_index =
            pixels[i] == NOT_COVERED ? DB_CLASS_NODATA : class_of(meaning, pixels[i]);
        if (class_index < 0) {
            return hs_error(path, "give a --map of its codes, or the class table it was made with",
                            "holds class %d, which the table has not", pixels[i]);
        }
        map->classes[i] = (uint8_t)class_index;
    }
    return 0;
}

/* A ground that lies elsewhere would leave all to the vectors without a word. */
static int check_cover(const int32_t *pixels, size_t cells, const char *path)
{
    size_t covered = 0;
    for (size_t i = 0; i < cells; i++) {
        covered += pixels[i] != NOT_COVERED;
    }
    if (covered == 0) {
        return hs_error(path, "give the ground of the vectors' area, or another --area",
                        "lies outside the area of the vectors");
    }
    return covered == cells
               ? 0
               : hs_warn(path, "what it leaves out has the vectors alone",
                         "covers %.1f %% of the area", 100 * (double)covered / (double)cells);
}

/* Every pixel is looked at: what is unknown is refused before the work. */
static int read_meaning(struct meaning *m, GDALDatasetH ground, const char *path,
                        const struct db_class_table *table)
{
    GDALRasterBandH band = GDALGetRasterBand(ground, 1);
    if (GDALGetRasterCount(ground) != 1) {
        return hs_error(path, "give one band", "holds %d bands instead of one",
                        GDALGetRasterCount(ground));
    }
    return m->codes ? db_code_map_survey(m->codes, table, band, path)
                    : db_class_numbers_read(&m->numbers, band, path, table, false);
}

static int fill(struct vector_map *map, GDALDatasetH ground, const char *path,
                const struct meaning *meaning)
{
    const size_t cells = (size_t)map->grid.width * (size_t)map->grid.height;
    int32_t *pixels = malloc(cells * sizeof *pixels);
    if (!pixels) {
        return hs_error(path, "choose a smaller --area, or larger cells", "out of memory");
    }
    for (size_t i = 0; i < cells; i++) {
        pixels[i] = NOT_COVERED;
    }
    int result = warp(map, ground, path, pixels);
    if (result == 0) {
        result = check_cover(pixels, cells, path);
    }
    if (result == 0) {
        result = take_pixels(map, pixels, path, meaning);
    }
    free(pixels);
    return result;
}

int vector_ground(struct vector_map *map, const char *path, const struct db_code_map *codes,
                  const struct db_class_table *table)
{
    CPLErrorReset();
    GDALDatasetH ground = GDALOpen(path, GA_ReadOnly);
    if (!ground) {
        return hs_error(path, "check the name and that `gdalinfo` can read it",
                        "cannot be opened as a class raster: %s", db_gdal_complaint());
    }
    struct meaning meaning = {.codes = codes};
    int result = read_meaning(&meaning, ground, path, table);
    if (result == 0) {
        result = fill(map, ground, path, &meaning);
    }
    GDALClose(ground);
    return result;
}
