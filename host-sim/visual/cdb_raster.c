#include "visual/cdb.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/progress.h"

#include <cpl_minixml.h>
#include <gdal.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static int tile_side(const struct cdb_tile *t)
{
    return t->level < 0 ? 1024 >> -t->level : 1024;
}

/* Read bands 1..bands of a tile as planes; pixels of `type`. NULL with the error reported. */
static void *read_tile(const struct cdb_tile *t, int bands, GDALDataType type)
{
    const int side = tile_side(t), bytes = GDALGetDataTypeSizeBytes(type);
    CPLErrorReset();
    GDALDatasetH file = GDALOpenEx(t->path, GDAL_OF_RASTER | GDAL_OF_READONLY, NULL, NULL, NULL);
    if (!file) {
        hs_error(t->path, "fetch it again", "cannot be read: %s", db_gdal_complaint());
        return NULL;
    }
    const size_t plane = (size_t)side * (size_t)side * (size_t)bytes;
    uint8_t *pixels = NULL;
    if (GDALGetRasterXSize(file) != side || GDALGetRasterYSize(file) != side ||
        GDALGetRasterCount(file) < bands) {
        hs_error(t->path, "write the tree anew by the standard",
                 "is %d x %d pixels with %d bands; its name says %d x %d with %d",
                 GDALGetRasterXSize(file), GDALGetRasterYSize(file), GDALGetRasterCount(file), side,
                 side, bands);
    } else if (!(pixels = malloc(plane * (size_t)bands))) {
        hs_error(t->path, NULL, "out of memory");
    }
    for (int b = 0; pixels && b < bands; b++) {
        if (GDALRasterIO(GDALGetRasterBand(file, b + 1), GF_Read, 0, 0, side, side,
                         pixels + plane * (size_t)b, side, side, type, 0, 0) != CE_None) {
            hs_error(t->path, "fetch it again", "cannot be read: %s", db_gdal_complaint());
            free(pixels);
            pixels = NULL;
        }
    }
    GDALClose(file);
    return pixels;
}

/* The cells of a grid that a tile covers, clipped, and how to get from them to its pixels. */
struct overlap {
    int x0, x1, y0, y1; /* columns and rows of the grid, rows from the north */
    int64_t first[2];   /* pixels of the tile's west and south edges, at the tile's own level */
    int side, finer, coarser; /* the tile is 2^finer finer than the grid, or 2^coarser coarser */
};

static int clip(int64_t v, int most)
{
    return v < 0 ? 0 : v > most ? most : (int)v;
}

/* Pixel number `p` of a level counted at another one, `shift` finer. */
static int64_t at_level(int64_t p, int shift)
{
    return shift >= 0 ? p * ((int64_t)1 << shift) : p >> -shift;
}

static struct overlap overlap_of(const struct cdb_tile *t, const struct cdb_grid *g)
{
    struct overlap o = {.side = tile_side(t)};
    const int shift = g->level - t->level;
    const struct cdb_area a = cdb_tile_area(t);
    const double y = cdb_pixel_degrees(t->level), x = y * g->geocell_width;
    o.first[0] = llround((a.west + 180) / x);
    o.first[1] = llround((a.south + 90) / y);
    o.finer = shift < 0 ? -shift : 0;
    o.coarser = shift > 0 ? shift : 0;
    o.x0 = clip(at_level(o.first[0], shift) - g->first[0], g->width);
    o.x1 = clip(at_level(o.first[0] + o.side, shift) - g->first[0], g->width);
    const int64_t south = at_level(o.first[1], shift) - g->first[1];
    const int64_t north = at_level(o.first[1] + o.side, shift) - g->first[1];
    o.y0 = clip(g->height - north, g->height);
    o.y1 = clip(g->height - south, g->height);
    return o;
}

/* The first pixel (column, row from the north) of the tile under a cell of the grid. */
static void pixel_under(const struct overlap *o, const struct cdb_grid *g, int x, int y, int at[2])
{
    const int shift = o->finer - o->coarser;
    const int64_t column = at_level(g->first[0] + x, shift);
    const int64_t row = at_level(g->first[1] + g->height - 1 - y, shift);
    at[0] = (int)(column - o->first[0]);
    at[1] = o->side - (1 << o->finer) - (int)(row - o->first[1]);
}

/* The mean of the pixels under a cell that are not black. */
static bool mean_colour(const uint8_t *pixels, const struct overlap *o, const int at[2],
                        uint8_t rgb[3])
{
    const size_t plane = (size_t)o->side * (size_t)o->side;
    unsigned sum[3] = {0, 0, 0}, count = 0;
    for (int i = 0; i < 1 << (2 * o->finer); i++) {
        const int x = at[0] + (i & ((1 << o->finer) - 1)), y = at[1] + (i >> o->finer);
        const uint8_t *p = pixels + (size_t)y * (size_t)o->side + (size_t)x;
        if (x < o->side && y >= 0 && y < o->side && (p[0] | p[plane] | p[2 * plane])) {
            for (int c = 0; c < 3; c++) {
                sum[c] += p[(size_t)c * plane];
            }
            count++;
        }
    }
    for (int c = 0; c < 3 && count > 0; c++) {
        rgb[c] = (uint8_t)((sum[c] + count / 2) / count);
    }
    return count > 0;
}

static void paint_tile(const uint8_t *pixels, const struct overlap *o, const struct cdb_grid *g,
                       struct visual_canvas *c, uint16_t patch)
{
    for (int y = o->y0; y < o->y1; y++) {
        for (int x = o->x0; x < o->x1; x++) {
            const size_t i = (size_t)y * (size_t)c->width + (size_t)x;
            uint8_t rgb[3];
            int at[2];
            pixel_under(o, g, x, y, at);
            if (mean_colour(pixels, o, at, rgb)) {
                c->patch[i] = patch;
                c->rgb[0][i] = rgb[0];
                c->rgb[1][i] = rgb[1];
                c->rgb[2][i] = rgb[2];
            }
        }
    }
}

/* Component selectors 1 and 1: the picture itself, or layer 1. */
static bool is_primary(const struct cdb_tile *t)
{
    return t->selector[0] == 1 && t->selector[1] == 1;
}

enum { FINER_MAX = 9 /* levels; finer tiles would be averaged to nothing that is seen */ };

static bool has_part(const struct cdb_tile *t, const struct cdb_grid *g, struct overlap *o)
{
    if (!is_primary(t) || t->level - g->level > FINER_MAX) {
        return false;
    }
    *o = overlap_of(t, g);
    return o->x0 < o->x1 && o->y0 < o->y1;
}

static uint64_t count_coarse(const struct visual_canvas *c, const bool *is_coarse)
{
    uint64_t count = 0;
    for (size_t i = 0; i < (size_t)c->width * (size_t)c->height; i++) {
        count += is_coarse[c->patch[i]];
    }
    return count;
}

int visual_cdb_paint(const struct cdb_tiles *tiles, const struct cdb_grid *g,
                     struct visual_canvas *c, struct visual_patches *patches, uint64_t *coarse)
{
    static bool is_coarse[VISUAL_PATCHES_MAX + 1];
    struct hs_progress progress;
    hs_progress_begin(&progress, "imagery", tiles->count);
    int result = 0;
    for (size_t i = 0; result == 0 && i < tiles->count; i++) {
        const struct cdb_tile *t = &tiles->items[i];
        struct overlap o;
        if (has_part(t, g, &o)) {
            const uint32_t patch = visual_patch(patches, base_name(t->path));
            uint8_t *pixels = patch ? read_tile(t, 3, GDT_Byte) : NULL;
            result = pixels ? 0
                     : patch
                         ? -1
                         : hs_error(t->path, "choose a smaller --area", "is one patch too many");
            if (pixels) {
                is_coarse[patch] = o.coarser >= CDB_COARSE_LEVELS;
                paint_tile(pixels, &o, g, c, (uint16_t)patch);
            }
            free(pixels);
        }
        hs_progress_update(&progress, i + 1);
    }
    hs_progress_end(&progress);
    *coarse = count_coarse(c, is_coarse);
    return result;
}

/* What the indices of a tile of materials stand for: classes, by the tile's descriptor. */
static int class_of_material(const CPLXMLNode *composite, cdb_class_fn *class_of, void *context)
{
    CPLXMLNode *node = (CPLXMLNode *)composite;
    const char *names[] = {CPLGetXMLValue(node, "Name", ""),
                           CPLGetXMLValue(node, "Surface_Substrate.Material.Name", ""),
                           CPLGetXMLValue(node, "Primary_Substrate.Material.Name", "")};
    int found = -1;
    for (size_t i = 0; found < 0 && i < sizeof names / sizeof names[0]; i++) {
        char name[64] = "";
        sscanf(names[i], " %63[^\n\t ]", name);
        found = name[0] ? class_of(context, name) : -1;
    }
    return found;
}

static void read_composites(CPLXMLNode *parent, cdb_class_fn *class_of, void *context,
                            uint8_t classes[256])
{
    for (CPLXMLNode *n = parent->psChild; n; n = n->psNext) {
        if (n->eType == CXT_Element && strcmp(n->pszValue, "Composite_Material") == 0) {
            const int index = atoi(CPLGetXMLValue(n, "index", "-1"));
            const int found = class_of_material(n, class_of, context);
            if (index >= 0 && index < 256 && found >= 0) {
                classes[index] = (uint8_t)found;
            }
        }
    }
}

/* 005_RMTexture/.../N32W118_D005_S001_T001_x.tif is described by 006_RMDescriptor/.../..D006...xml
 */
static int descriptor_path(const struct cdb_tile *t, char *path)
{
    char folder[CDB_PATH_SIZE], name[80];
    const char *at = strstr(t->path, "/005_");
    const char *under = at ? strchr(at + 1, '/') : NULL;
    const char *file = base_name(t->path), *dataset = strstr(file, "_D005_");
    if (!under || !dataset || strlen(file) >= sizeof name) {
        return -1;
    }
    snprintf(folder, sizeof folder, "%.*s/006_RMDescriptor%.*s", (int)(at - t->path), t->path,
             (int)(file - under), under);
    snprintf(name, sizeof name, "%.*s_D006_%.*s.xml", (int)(dataset - file), file,
             (int)strcspn(dataset + 6, "."), dataset + 6);
    const int length = snprintf(path, CDB_PATH_SIZE, "%s%s", folder, name);
    return length < CDB_PATH_SIZE ? 0 : -1;
}

static int read_descriptor(const struct cdb_tile *t, cdb_class_fn *class_of, void *context,
                           uint8_t classes[256])
{
    char path[CDB_PATH_SIZE];
    memset(classes, DB_CLASS_NODATA, 256);
    CPLErrorReset();
    CPLXMLNode *tree = descriptor_path(t, path) == 0 ? CPLParseXMLFile(path) : NULL;
    if (!tree) {
        return hs_error(t->path, "add its tile of dataset 006, RMDescriptor",
                        "has no table of materials that can be read: %s", db_gdal_complaint());
    }
    CPLXMLNode *table = CPLSearchXMLNode(tree, "=Composite_Material_Table");
    if (table) {
        read_composites(table, class_of, context, classes);
    }
    CPLDestroyXMLNode(tree);
    return table ? 0
                 : hs_error(path, "write it by the standard", "holds no Composite_Material_Table");
}

static int material_tile(const struct cdb_tile *t, const struct cdb_grid *g,
                         struct visual_canvas *c, const uint8_t classes[256])
{
    const struct overlap o = overlap_of(t, g);
    uint8_t *pixels = read_tile(t, 1, GDT_Byte);
    for (int y = o.y0; pixels && y < o.y1; y++) {
        for (int x = o.x0; x < o.x1; x++) {
            int at[2];
            pixel_under(&o, g, x, y, at);
            /* The pixel in the middle of a cell that is larger. */
            at[0] += (1 << o.finer) / 2;
            at[1] += (1 << o.finer) / 2;
            const uint8_t found = classes[pixels[(size_t)at[1] * (size_t)o.side + (size_t)at[0]]];
            if (found != DB_CLASS_NODATA) {
                c->classes[(size_t)y * (size_t)c->width + (size_t)x] = found;
            }
        }
    }
    const int result = pixels ? 0 : -1;
    free(pixels);
    return result;
}

int visual_cdb_materials(const struct cdb_tiles *tiles, const struct cdb_grid *g,
                         struct visual_canvas *c, cdb_class_fn *class_of, void *context)
{
    for (size_t i = 0; i < tiles->count; i++) {
        uint8_t classes[256];
        struct overlap o;
        if (has_part(&tiles->items[i], g, &o) &&
            (read_descriptor(&tiles->items[i], class_of, context, classes) != 0 ||
             material_tile(&tiles->items[i], g, c, classes) != 0)) {
            return -1;
        }
    }
    return 0;
}

/* Posts of one level with a margin around those wanted, so that the next level has neighbours. */
struct posts {
    struct cdb_grid grid;
    float *z; /* owned */
};

static float post_at(const struct posts *p, int64_t column, int64_t row)
{
    const int x = clip(column - p->grid.first[0], p->grid.width - 1);
    const int up = clip(row - p->grid.first[1], p->grid.height - 1);
    return p->z[(size_t)(p->grid.height - 1 - up) * (size_t)p->grid.width + (size_t)x];
}

/* Mean of the posts of the level before that lie beside a place of this one. */
static float from_coarser(const struct posts *p, int64_t column, int64_t row)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < 4; i++) {
        const float z = post_at(p, (column + (i & 1)) >> 1, (row + (i >> 1)) >> 1);
        if (!isnan(z)) {
            sum += (double)z;
            count++;
        }
    }
    return count > 0 ? (float)(sum / count) : NAN;
}

static int next_level(struct posts *p, const struct posts *before)
{
    const struct cdb_grid *g = &p->grid;
    p->z = calloc((size_t)g->width * (size_t)g->height, sizeof *p->z);
    if (!p->z) {
        return hs_error("--cdb", "choose a smaller --area", "out of memory for its elevation");
    }
    for (int y = 0; y < g->height; y++) {
        for (int x = 0; x < g->width; x++) {
            p->z[(size_t)y * (size_t)g->width + (size_t)x] =
                before->z ? from_coarser(before, g->first[0] + x, g->first[1] + g->height - 1 - y)
                          : NAN;
        }
    }
    return 0;
}

static double nodata_of(const struct cdb_tile *t)
{
    GDALDatasetH file = GDALOpenEx(t->path, GDAL_OF_RASTER, NULL, NULL, NULL);
    int has = 0;
    const double value = file ? GDALGetRasterNoDataValue(GDALGetRasterBand(file, 1), &has) : NAN;
    if (file) {
        GDALClose(file);
    }
    return has ? value : NAN;
}

static int put_posts(const struct cdb_tile *t, struct posts *p)
{
    const struct overlap o = overlap_of(t, &p->grid);
    if (o.x0 >= o.x1 || o.y0 >= o.y1) {
        return 0;
    }
    float *z = read_tile(t, 1, GDT_Float32);
    const float nodata = (float)nodata_of(t);
    for (int y = o.y0; z && y < o.y1; y++) {
        for (int x = o.x0; x < o.x1; x++) {
            int at[2];
            pixel_under(&o, &p->grid, x, y, at);
            const float v = z[(size_t)at[1] * (size_t)o.side + (size_t)at[0]];
            if (isfinite(v) && v != nodata) {
                p->z[(size_t)y * (size_t)p->grid.width + (size_t)x] = v;
            }
        }
    }
    const int result = z ? 0 : -1;
    free(z);
    return result;
}

/* The posts of a level that those of the wanted grid may need, two more on each side. */
static struct cdb_grid with_margin(const struct visual_cdb *cdb, int level)
{
    struct cdb_grid g = cdb_grid_of(cdb, level);
    g.first[0] -= 2;
    g.first[1] -= 2;
    g.width += 5;
    g.height += 5;
    return g;
}

static int make_levels(const struct visual_cdb *cdb, const struct cdb_tiles *tiles, int finest,
                       struct posts *last)
{
    size_t i = 0;
    int result = 0;
    for (int level = CDB_LEVEL_MIN; result == 0 && level <= finest; level++) {
        struct posts p = {.grid = with_margin(cdb, level)};
        result = next_level(&p, last);
        for (; result == 0 && i < tiles->count && tiles->items[i].level == level; i++) {
            result = is_primary(&tiles->items[i]) ? put_posts(&tiles->items[i], &p) : 0;
        }
        free(last->z);
        *last = p;
    }
    return result;
}

int visual_cdb_elevation(const struct visual_cdb *cdb, const struct cdb_tiles *tiles,
                         const struct cdb_grid *g, float *posts)
{
    struct posts last = {.z = NULL};
    const int result = make_levels(cdb, tiles, g->level, &last);
    for (int y = 0; result == 0 && last.z && y < g->height; y++) {
        for (int x = 0; x < g->width; x++) {
            posts[(size_t)y * (size_t)g->width + (size_t)x] =
                post_at(&last, g->first[0] + x, g->first[1] + g->height - 1 - y);
        }
    }
    free(last.z);
    return result;
}
