#include "build/work_sources.h"

#include "build/manifest.h"
#include "build/part.h"
#include "hs/error.h"
#include "lm/version.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What every process takes: programs, GDAL with what it keeps of open files, PROJ with its grids.
 * Measured: 60 to 90 MiB; up to 195 over three rasters of the whole Earth. */
enum { BASE_MIB = 200, VOIDS_MIB = 64 };

/* Tiles of a shard, unless memory or the caller asks for less: 134 Mi cells, a part of 0.6 GB. */
static const uint64_t tiles_most = 32768;

static const uint8_t last_zone = 3;

static const struct image_area everywhere = {-IMAGE_BAM_QUARTER, IMAGE_BAM_QUARTER, 0,
                                             IMAGE_BAM_ROUND};

/* ---- sources ---- */

static int add_file(struct build_work *w, const char *role, const char *path,
                    const struct image_area *area)
{
    struct build_source s = {.area = *area, .path = NULL};
    VSIStatBufL status;
    char *copy = strdup(path);
    s.path = copy;
    snprintf(s.role, sizeof s.role, "%s", role);
    int result = copy ? 0 : hs_error(path, NULL, "out of memory");
    if (result == 0 &&
        (VSIStatL(path, &status) != 0 || build_manifest_hash(path, &s.bytes, s.sha256) != 0)) {
        result = hs_error(path, "check that it is still there", "cannot be read for the plan");
    }
    if (result == 0) {
        s.changed = (int64_t)status.st_mtime;
        result = build_work_add_source(w, &s);
    }
    free(copy);
    return result;
}

/* The area of an open raster, or the whole Earth where it does not say. */
static struct image_area area_of(GDALDatasetH dataset, const char *path)
{
    struct image_area area = everywhere;
    struct resample_georef g;
    double transform[6];
    const char *crs = dataset ? GDALGetProjectionRef(dataset) : NULL;
    if (!crs || !*crs || GDALGetGeoTransform(dataset, transform) != CE_None ||
        resample_georef_open(&g, dataset, path) != 0) {
        return everywhere;
    }
    if (resample_area(&g, &area) != 0) {
        area = everywhere;
    }
    resample_georef_close(&g);
    return area;
}

/* A file of a dataset. What the dataset is read from directly lies where the dataset does, unless
 * that is put together from others. */
static int add_part(struct build_work *w, const char *role, GDALDatasetH whole, const char *path,
                    bool is_first)
{
    const bool is_virtual = EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(whole)), "VRT");
    if (is_first) {
        const struct image_area area = is_virtual ? everywhere : area_of(whole, path);
        return add_file(w, role, path, &area);
    }
    CPLPushErrorHandler(CPLQuietErrorHandler);
    GDALDatasetH part = is_virtual ? GDALOpen(path, GA_ReadOnly) : NULL;
    CPLPopErrorHandler();
    const struct image_area area = area_of(part, path);
    if (part) {
        GDALClose(part);
    }
    return add_file(w, role, path, &area);
}

static int add_dataset(struct build_work *w, const char *role, GDALDatasetH dataset)
{
    char **files = dataset ? GDALGetFileList(dataset) : NULL;
    int result = 0;
    for (int i = 0; files && files[i] && result == 0; i++) {
        VSIStatBufL status;
        /* As the manifest passes notes over. */
        if (!EQUAL(CPLGetExtension(files[i]), "xml") && VSIStatL(files[i], &status) == 0 &&
            !VSI_ISDIR(status.st_mode)) {
            result = add_part(w, role, dataset, files[i], i == 0);
        }
    }
    CSLDestroy(files);
    return result;
}

int build_work_find_sources(struct build_work *w, const struct build_context *b,
                            const struct build_plain_file *files, int count)
{
    int result = 0;
    for (int i = 0; i < count && result == 0; i++) {
        result = files[i].path ? add_file(w, files[i].role, files[i].path, &everywhere) : 0;
    }
    const struct {
        const char *role;
        GDALDatasetH dataset;
    } planes[] = {{"class-raster", b->cover.classes.dataset},
                  {"reflectivity", b->cover.reflectivity.dataset},
                  {"heights", b->cover.heights.dataset}};
    for (int i = 0; i < 3 && result == 0; i++) {
        result = add_dataset(w, planes[i].role, planes[i].dataset);
    }
    for (int i = 0; i < b->terrain.layer_count; i++) {
        const struct terrain_mosaic *m = &b->terrain.layers[i].mosaic;
        for (int k = 0; k < m->member_count && result == 0; k++) {
            result = add_dataset(w, "terrain", m->members[k].dataset);
        }
        w->has_voids = w->has_voids || b->terrain.layers[i].voids.run_count > 0;
    }
    return result;
}

/* ---- what reaches into a shard ---- */

static double coarsest_pixel_bam(const struct build_context *b)
{
    double pixel = fmax(b->cover.pixel_latitude_bam, b->cover.pixel_longitude_bam);
    for (int i = 0; i < b->terrain.layer_count; i++) {
        const struct terrain_layer *l = &b->terrain.layers[i];
        pixel = fmax(pixel, fmax(l->pixel_latitude_bam, l->pixel_longitude_bam));
    }
    return pixel;
}

struct image_area build_work_reach(const struct build_context *b, const struct build_shard *s)
{
    /* Facings look 400 m around, in squares of up to 120 m; a post blends pixels beside it. */
    const double metres = 1500 + b->detail.reach_m;
    const int64_t margin = (int64_t)(metres / IMAGE_METRES_PER_BAM + 4 * coarsest_pixel_bam(b)) +
                           ((int64_t)LM_TILE_CELLS << b->plan.shift0);
    struct image_area a = build_shard_area(&b->plan, s);
    const int64_t east = margin << s->zone;
    a.south = a.south - margin > -IMAGE_BAM_QUARTER ? a.south - margin : -IMAGE_BAM_QUARTER;
    a.north = a.north + margin < IMAGE_BAM_QUARTER ? a.north + margin : IMAGE_BAM_QUARTER;
    /* Meridians meet in the last zone. */
    const bool is_round = s->zone == last_zone || a.width + 2 * east >= IMAGE_BAM_ROUND;
    a.west = is_round ? 0 : a.west - (uint32_t)east;
    a.width = is_round ? IMAGE_BAM_ROUND : a.width + 2 * east;
    return a;
}

/* A rectangle, east and north of the corner of an area. */
struct piece {
    int64_t west, east, south, north;
};

static struct piece piece_of(const struct image_area *a, uint32_t west)
{
    const int64_t from = a->width >= IMAGE_BAM_ROUND ? -IMAGE_BAM_ROUND : (int32_t)(a->west - west);
    const int64_t width = a->width >= IMAGE_BAM_ROUND ? 2 * IMAGE_BAM_ROUND : a->width;
    return (struct piece){from, from + width, a->south, a->north};
}

static bool is_terrain(const struct build_source *s)
{
    return strcmp(s->role, "terrain") == 0;
}

/* Do files of terrain from `first` on cover a piece? What one does not cover is left to the next
 * ones. */
static bool is_covered(const struct build_work *w, uint32_t west, int first, struct piece p)
{
    if (p.west >= p.east || p.south >= p.north) {
        return true;
    }
    for (int i = first; i < w->source_count; i++) {
        const struct piece f = piece_of(&w->sources[i].area, west);
        if (!is_terrain(&w->sources[i]) || f.west >= p.east || f.east <= p.west ||
            f.south >= p.north || f.north <= p.south) {
            continue;
        }
        struct piece south = p, north = p, before = p, behind = p;
        south.north = f.south;
        north.south = f.north;
        before.south = behind.south = f.south > p.south ? f.south : p.south;
        before.north = behind.north = f.north < p.north ? f.north : p.north;
        before.east = f.west;
        behind.west = f.east;
        return is_covered(w, west, i + 1, south) && is_covered(w, west, i + 1, north) &&
               is_covered(w, west, i + 1, before) && is_covered(w, west, i + 1, behind);
    }
    return false;
}

/* Ground beyond the terrain takes the nearest edge. Of one layer it is beside the shard. */
static bool takes_all_terrain(const struct build_work *w, const struct build_context *b,
                              const struct image_area *reach)
{
    struct piece p = piece_of(reach, reach->west);
    if (b->terrain.layer_count == 0) {
        return false;
    }
    if (b->terrain.layer_count == 1 && image_areas_meet(&b->terrain.layers[0].area, reach)) {
        const struct piece layer = piece_of(&b->terrain.layers[0].area, reach->west);
        p.west = layer.west > p.west ? layer.west : p.west;
        p.east = layer.east < p.east ? layer.east : p.east;
        p.south = layer.south > p.south ? layer.south : p.south;
        p.north = layer.north < p.north ? layer.north : p.north;
    }
    return !is_covered(w, reach->west, 0, p);
}

void build_work_choose(const struct build_work *w, const struct build_context *b,
                       const struct build_shard *s, bool *counts)
{
    const struct image_area reach = build_work_reach(b, s);
    const bool all = takes_all_terrain(w, b, &reach);
    for (int i = 0; i < w->source_count; i++) {
        counts[i] =
            image_areas_meet(&w->sources[i].area, &reach) || (all && is_terrain(&w->sources[i]));
    }
}

/* ---- keys ---- */

/* A digest that is fed with text. */
static void feed(struct image_sha256 *sha, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void feed(struct image_sha256 *sha, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    image_sha256_add(sha, text, strlen(text));
}

static void feed_area(struct image_sha256 *sha, const struct image_area *a)
{
    feed(sha, "area %" PRId64 " %" PRId64 " %" PRIu32 " %" PRId64 "\n", a->south, a->north, a->west,
         a->width);
}

static void feed_voids(struct image_sha256 *sha, const struct terrain_voids *v)
{
    uint64_t values = 0;
    for (size_t i = 0; i < v->run_count; i++) {
        const struct terrain_run *run = &v->runs[i];
        feed(sha, "run %d %d %d %u\n", run->y, run->x0, run->x1, (unsigned)run->region);
    }
    for (size_t i = 0; i < v->region_count; i++) {
        feed(sha, "region %d %d\n", (int)v->regions[i].filling, v->regions[i].has_values);
        values += v->regions[i].has_values ? v->regions[i].pixels : 0;
    }
    if (values > 0) {
        image_sha256_add(sha, v->values, values * sizeof *v->values);
    }
}

static void feed_layer(struct image_sha256 *sha, const struct build_context *b, int number)
{
    const struct terrain_layer *l = &b->terrain.layers[number];
    const struct resample_georef *g = &l->mosaic.georef;
    char *wkt = NULL;
    feed(sha, "layer %d %d %d %.17g %.17g\n", b->terrain_level[number], g->width, g->height,
         l->pixel_latitude_bam, l->pixel_longitude_bam);
    for (int i = 0; i < 6; i++) {
        feed(sha, "%.17g\n", g->geotransform[i]);
    }
    if (g->crs && OSRExportToWkt(g->crs, &wkt) == OGRERR_NONE) {
        image_sha256_add(sha, wkt, strlen(wkt));
    }
    CPLFree(wkt);
    feed_area(sha, &l->area);
    for (int i = 0; i < l->mosaic.member_count; i++) {
        const struct terrain_member *m = &l->mosaic.members[i];
        feed(sha, "member %d %d %.17g %.17g %d %.17g %s\n", m->x, m->y, m->scale, m->offset,
             m->has_nodata, m->nodata, m->vertical.said);
    }
    feed_voids(sha, &l->voids);
}

/* What counts everywhere. */
static struct image_sha256 common_digest(const struct build_work *w, const struct build_context *b,
                                         const char *choices)
{
    struct image_sha256 sha;
    image_sha256_begin(&sha);
    feed(&sha, "tiles of landmass %s, parts of version %d\n", LM_VERSION, BUILD_PART_VERSION);
    image_sha256_add(&sha, choices, strlen(choices));
    feed(&sha, "grid %s facings %d parts %d\n", w->grid_sha256, b->facing.facings, b->parts);
    image_sha256_add(&sha, b->classes.height_dm, sizeof b->classes.height_dm);
    feed_area(&sha, &b->cover.area);
    feed(&sha, "pixel %.17g %.17g\n", b->cover.pixel_latitude_bam, b->cover.pixel_longitude_bam);
    for (int i = 0; i < b->terrain.layer_count; i++) {
        feed_layer(&sha, b, i);
    }
    return sha;
}

static bool has_role(const struct build_source *s, const char *const roles[], int count)
{
    bool is_one = false;
    for (int i = 0; i < count; i++) {
        is_one = is_one || strcmp(s->role, roles[i]) == 0;
    }
    return is_one;
}

/* Vector detail reaches over the borders of its tile. */
static void feed_detail(struct image_sha256 *sha, const struct build_context *b,
                        const struct image_area *reach)
{
    for (uint32_t i = 0; i < b->detail.count; i++) {
        const struct build_detail_item *item = &b->detail.items[i];
        const struct image_frame f = image_frame_of(
            b->plan.shift0, image_row_zone(b->plan.shift0, item->row), item->row, item->column);
        const struct image_area area = image_frame_area(&f);
        if (image_areas_meet(&area, reach)) {
            image_sha256_add(sha, &item->row, sizeof item->row);
            image_sha256_add(sha, &item->column, sizeof item->column);
            image_sha256_add(sha, &item->item, sizeof item->item);
        }
    }
}

static void make_key(const struct build_work *w, const struct build_context *b,
                     const struct image_sha256 *common, bool *counts, struct build_work_shard *s)
{
    static const char *const of_tiles[] = {"classes",      "map",     "class-raster",
                                           "reflectivity", "heights", "terrain"};
    const struct image_area reach = build_work_reach(b, &s->place);
    struct image_sha256 sha = *common;
    build_work_choose(w, b, &s->place, counts);
    feed(&sha, "shard %d %d %u %u %u %u\n", s->place.level, s->place.zone, (unsigned)s->place.row0,
         (unsigned)s->place.rows, (unsigned)s->place.column0, (unsigned)s->place.columns);
    for (int i = 0; i < w->source_count; i++) {
        const struct build_source *source = &w->sources[i];
        if (counts[i] && has_role(source, of_tiles, 6)) {
            feed(&sha, "%s %s\n", source->role, source->sha256);
        }
    }
    feed_detail(&sha, b, &reach);
    image_sha256_end(&sha, s->key);
}

/* ---- cutting ---- */

static uint32_t estimate_mib(const struct build_work *w, const struct build_context *b,
                             const struct build_work_shard *s)
{
    const struct image_area area = build_shard_area(&b->plan, &s->place);
    const double block = 60 / IMAGE_METRES_PER_BAM;
    const bool has_facings = b->facing.facings > 0 && b->cover.classes.dataset &&
                             image_areas_meet(&area, &b->cover.area);
    const double side = LM_TILE_CELLS * b->parts;
    double bytes = (double)s->tiles * 64;
    bytes += has_facings ? 24 * (double)(area.north - area.south) / block * (double)area.width /
                               block / (double)(1u << s->place.zone)
                         : 0;
    bytes += b->cover.classes.dataset ? side * side * 16 : 0;
    bytes += (double)b->detail.count * 3 * sizeof(struct build_detail_item);
    bytes += (double)b->plan.level_count * 5 * sizeof(struct build_tile);
    return (uint32_t)BASE_MIB + BUILD_WORK_CACHE_MIB + (w->has_voids ? VOIDS_MIB : 0u) +
           (uint32_t)ceil(fmin(bytes / 1048576, 1e6));
}

/* Cut, and estimate. Returns the largest estimate, or -1 with the error reported. */
static int64_t cut(struct build_work *w, const struct build_context *b, int count, uint64_t most)
{
    static struct build_shard places[BUILD_SHARDS_MAX];
    const int made = build_shards_cut(&b->plan, count, most, places);
    int64_t largest = 0;
    free(w->shards);
    w->shards = made > 0 ? calloc((size_t)made, sizeof *w->shards) : NULL;
    w->shard_count = w->shards ? made : 0;
    if (!w->shards) {
        return made < 0 ? -1 : hs_error("plan", NULL, "out of memory");
    }
    for (int i = 0; i < made; i++) {
        struct build_work_shard *s = &w->shards[i];
        s->place = places[i];
        s->tiles = build_shard_tiles_all(&b->plan, &s->place);
        s->memory_mib = estimate_mib(w, b, s);
        largest = (int64_t)s->memory_mib > largest ? (int64_t)s->memory_mib : largest;
    }
    return largest;
}

int build_work_cut(struct build_work *w, const struct build_context *b, int count,
                   uint32_t memory_mib, const char *choices)
{
    uint64_t most = tiles_most;
    int64_t largest = cut(w, b, count, most);
    while (largest > memory_mib && most > 1) {
        most /= 2;
        largest = cut(w, b, count, most);
    }
    if (largest < 0) {
        return -1;
    }
    if (largest > memory_mib) {
        return hs_error("--memory", "allow more, or give fewer inputs",
                        "a shard would need %" PRId64 " MiB however small it is", largest);
    }
    const struct image_sha256 common = common_digest(w, b, choices);
    bool *counts = calloc((size_t)w->source_count + 1, sizeof *counts);
    for (int i = 0; counts && i < w->shard_count; i++) {
        make_key(w, b, &common, counts, &w->shards[i]);
    }
    free(counts);
    return counts ? 0 : hs_error("plan", NULL, "out of memory");
}
