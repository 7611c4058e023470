#include "visual/cdb.h"

#include "hs/error.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

int cdb_geocell_width(int latitude)
{
    const int from_equator = latitude < 0 ? -latitude - 1 : latitude;
    return from_equator < 50   ? 1
           : from_equator < 70 ? 2
           : from_equator < 75 ? 3
           : from_equator < 80 ? 4
           : from_equator < 89 ? 6
                               : 12;
}

double cdb_pixel_degrees(int level)
{
    return ldexp(1.0, -10 - level);
}

/* "N32" or "W118": a hemisphere and digits. Geocells begin below `most` and above it southwards. */
static bool read_degrees(const char *name, const char *signs, int most, int *degrees)
{
    const bool is_negative = name[0] == signs[1];
    char *end;
    if ((name[0] != signs[0] && !is_negative) || name[1] < '0' || name[1] > '9') {
        return false;
    }
    const long value = strtol(name + 1, &end, 10);
    *degrees = (int)(is_negative ? -value : value);
    return *end == '\0' && value <= most - !is_negative;
}

static bool meets(const struct cdb_area *a, const struct cdb_area *b)
{
    return a->south < b->north && b->south < a->north && a->west < b->east && b->west < a->east;
}

static struct cdb_area geocell_area(int latitude, int longitude)
{
    return (struct cdb_area){latitude, longitude, latitude + 1.0,
                             longitude + (double)cdb_geocell_width(latitude)};
}

typedef int geocell_fn(struct visual_cdb *cdb, void *context, int latitude, int longitude,
                       const char *folder);

static int walk_row(struct visual_cdb *cdb, const char *folder, int latitude, geocell_fn *take,
                    void *context)
{
    char **names = VSIReadDir(folder);
    int result = 0, longitude;
    for (int i = 0; result == 0 && names && names[i]; i++) {
        if (strlen(names[i]) != 4 || !read_degrees(names[i], "EW", 180, &longitude)) {
            continue;
        }
        if ((longitude + 180) % cdb_geocell_width(latitude) != 0) {
            cdb->strangers++;
            continue;
        }
        const struct cdb_area area = geocell_area(latitude, longitude);
        if (meets(&area, &cdb->area)) {
            char path[CDB_PATH_SIZE + 8];
            snprintf(path, sizeof path, "%.*s/%.4s", CDB_PATH_SIZE, folder, names[i]);
            result = take(cdb, context, latitude, longitude, path);
        }
    }
    CSLDestroy(names);
    return result;
}

/* Every geocell of the tree that lies in the area. */
static int walk(struct visual_cdb *cdb, geocell_fn *take, void *context)
{
    char path[CDB_PATH_SIZE];
    snprintf(path, sizeof path, "%s/Tiles", cdb->root);
    char **names = VSIReadDir(path);
    int result = 0, latitude;
    for (int i = 0; result == 0 && names && names[i]; i++) {
        if (read_degrees(names[i], "NS", 90, &latitude)) {
            snprintf(path, sizeof path, "%s/Tiles/%s", cdb->root, names[i]);
            result = walk_row(cdb, path, latitude, take, context);
        }
    }
    CSLDestroy(names);
    return result;
}

static int join_geocell(struct visual_cdb *cdb, void *context, int latitude, int longitude,
                        const char *folder)
{
    struct cdb_area *all = context;
    const struct cdb_area one = geocell_area(latitude, longitude);
    const int width = cdb_geocell_width(latitude);
    (void)folder;
    if (cdb->geocell_width != 0 && cdb->geocell_width != width) {
        return hs_error(
            cdb->root, "import them one by one: choose an --area that ends at that latitude",
            "has geocells %d and %d degrees wide in the area", cdb->geocell_width, width);
    }
    cdb->geocell_width = width;
    all->south = fmin(all->south, one.south);
    all->west = fmin(all->west, one.west);
    all->north = fmax(all->north, one.north);
    all->east = fmax(all->east, one.east);
    return 0;
}

int visual_cdb_open(struct visual_cdb *cdb, const char *root, const struct cdb_area *area)
{
    const struct cdb_area all = {-90, -180, 90, 180};
    struct cdb_area found = {90, 180, -90, -180};
    *cdb = (struct visual_cdb){.root = root, .area = area ? *area : all};
    if (walk(cdb, join_geocell, &found) != 0) {
        return -1;
    }
    if (cdb->geocell_width == 0) {
        return hs_error(root, "name the folder that holds Tiles, and an --area within its geocells",
                        "holds no geocell of an OGC CDB data store in the area");
    }
    cdb->area.south = fmax(cdb->area.south, found.south);
    cdb->area.west = fmax(cdb->area.west, found.west);
    cdb->area.north = fmin(cdb->area.north, found.north);
    cdb->area.east = fmin(cdb->area.east, found.east);
    return 0;
}

/* "02" or "C07". */
static bool read_level(const char *text, int *level)
{
    const bool is_coarse = text[0] == 'C';
    if (sscanf(text + is_coarse, "%2d", level) != 1) {
        return false;
    }
    *level = is_coarse ? -*level : *level;
    return *level >= CDB_LEVEL_MIN && *level <= CDB_LEVEL_MAX;
}

/* The name of a tile, up to its ending. */
static void write_name(char *to, size_t size, const struct cdb_tile *t)
{
    snprintf(to, size, "%c%02d%c%03d_D%03d_S%03d_T%03d_L%s%02d_U%d_R%d",
             t->latitude < 0 ? 'S' : 'N', abs(t->latitude), t->longitude < 0 ? 'W' : 'E',
             abs(t->longitude), t->dataset, t->selector[0], t->selector[1], t->level < 0 ? "C" : "",
             abs(t->level), t->up, t->right);
}

/* What scanf forgives, such as signs, blanks and missing digits, the last comparison does not. */
bool cdb_tile_read_name(struct cdb_tile *t, const char *name)
{
    char latitude[4], longitude[5], level[4], whole[128];
    int end = 0;
    if (sscanf(name, "%3[NS0-9]%4[EW0-9]_D%3d_S%3d_T%3d_L%3[C0-9]_U%8d_R%8d%n", latitude, longitude,
               &t->dataset, &t->selector[0], &t->selector[1], level, &t->up, &t->right,
               &end) != 8 ||
        (name[end] != '.' && name[end] != '\0') ||
        !read_degrees(latitude, "NS", 90, &t->latitude) ||
        !read_degrees(longitude, "EW", 180, &t->longitude) || !read_level(level, &t->level)) {
        return false;
    }
    if (t->dataset < 0 || t->selector[0] < 0 || t->selector[1] < 0 || t->up < 0 || t->right < 0) {
        return false;
    }
    write_name(whole, sizeof whole, t);
    const int across = t->level > 0 ? 1 << t->level : 1;
    return strlen(whole) == (size_t)end && strncmp(name, whole, (size_t)end) == 0 &&
           t->up < across && t->right < across;
}

struct cdb_area cdb_tile_area(const struct cdb_tile *t)
{
    const double across = t->level > 0 ? ldexp(1, t->level) : 1;
    const double width = cdb_geocell_width(t->latitude);
    return (struct cdb_area){t->latitude + t->up / across, t->longitude + t->right * width / across,
                             t->latitude + (t->up + 1) / across,
                             t->longitude + (t->right + 1) * width / across};
}

static int add_tile(struct cdb_tiles *tiles, const struct cdb_tile *t)
{
    if (tiles->count == tiles->room) {
        const size_t room = tiles->room ? 2 * tiles->room : 64;
        void *items = realloc(tiles->items, room * sizeof *tiles->items);
        if (!items) {
            return hs_error(t->path, "choose a smaller --area", "out of memory for the list");
        }
        tiles->items = items;
        tiles->room = room;
    }
    tiles->items[tiles->count++] = *t;
    return 0;
}

struct finding {
    struct cdb_tiles *tiles;
    int dataset;
    const char *endings;
};

static bool has_ending(const char *name, const char *endings)
{
    const size_t length = strlen(name);
    for (const char *e = endings; *e; e += strlen(e) + 1) {
        if (length > strlen(e) && strcasecmp(name + length - strlen(e), e) == 0) {
            return true;
        }
    }
    return false;
}

static int find_in_folder(struct visual_cdb *cdb, const struct finding *f,
                          const struct cdb_tile *at, const char *folder)
{
    char **names = VSIReadDirRecursive(folder);
    int result = 0;
    for (int i = 0; result == 0 && names && names[i]; i++) {
        const char *slash = strrchr(names[i], '/');
        struct cdb_tile t;
        if (!has_ending(names[i], f->endings)) {
            continue;
        }
        const int length = snprintf(t.path, sizeof t.path, "%s/%s", folder, names[i]);
        if (length >= (int)sizeof t.path || !cdb_tile_read_name(&t, slash ? slash + 1 : names[i]) ||
            t.dataset != f->dataset || t.latitude != at->latitude || t.longitude != at->longitude) {
            cdb->strangers++;
            continue;
        }
        const struct cdb_area area = cdb_tile_area(&t);
        result = meets(&area, &cdb->area) ? add_tile(f->tiles, &t) : 0;
    }
    CSLDestroy(names);
    return result;
}

/* The dataset's folder begins with its number: 004_Imagery. */
static int find_tiles(struct visual_cdb *cdb, void *context, int latitude, int longitude,
                      const char *folder)
{
    const struct finding *f = context;
    const struct cdb_tile at = {.latitude = latitude, .longitude = longitude};
    char **names = VSIReadDir(folder);
    int result = 0;
    for (int i = 0; result == 0 && names && names[i]; i++) {
        char *end;
        if (strtol(names[i], &end, 10) == f->dataset && *end == '_' && end == names[i] + 3) {
            char path[CDB_PATH_SIZE];
            snprintf(path, sizeof path, "%s/%s", folder, names[i]);
            result = find_in_folder(cdb, f, &at, path);
        }
    }
    CSLDestroy(names);
    return result;
}

static int by_level(const void *a, const void *b)
{
    const struct cdb_tile *ta = a, *tb = b;
    return ta->level != tb->level ? (ta->level > tb->level) - (ta->level < tb->level)
                                  : strcmp(ta->path, tb->path);
}

int visual_cdb_tiles(struct visual_cdb *cdb, struct cdb_tiles *tiles, int dataset,
                     const char *endings)
{
    struct finding f = {tiles, dataset, endings};
    *tiles = (struct cdb_tiles){.items = NULL};
    if (walk(cdb, find_tiles, &f) != 0) {
        cdb_tiles_free(tiles);
        return -1;
    }
    if (tiles->count > 0) {
        qsort(tiles->items, tiles->count, sizeof *tiles->items, by_level);
    }
    return 0;
}

void cdb_tiles_free(struct cdb_tiles *tiles)
{
    free(tiles->items);
    *tiles = (struct cdb_tiles){.items = NULL};
}

struct cdb_grid cdb_grid_of(const struct visual_cdb *cdb, int level)
{
    const double y = cdb_pixel_degrees(level), x = y * cdb->geocell_width;
    const struct cdb_area *a = &cdb->area;
    struct cdb_grid g = {.level = level, .geocell_width = cdb->geocell_width};
    g.first[0] = (int64_t)floor((a->west + 180) / x + 1e-6);
    g.first[1] = (int64_t)floor((a->south + 90) / y + 1e-6);
    const double width = ceil((a->east + 180) / x - 1e-6) - (double)g.first[0];
    const double height = ceil((a->north + 90) / y - 1e-6) - (double)g.first[1];
    if (width >= 1 && height >= 1 && width * height <= (double)VISUAL_CELLS_MAX) {
        g.width = (int)width;
        g.height = (int)height;
    }
    return g;
}

void cdb_grid_geotransform(const struct cdb_grid *g, bool is_post, double geotransform[6])
{
    const double y = cdb_pixel_degrees(g->level), x = y * g->geocell_width;
    const double half = is_post ? 0.5 : 0;
    geotransform[0] = ((double)g->first[0] - half) * x - 180;
    geotransform[1] = x;
    geotransform[2] = 0;
    geotransform[3] = ((double)(g->first[1] + g->height) - half) * y - 90;
    geotransform[4] = 0;
    geotransform[5] = -y;
}
