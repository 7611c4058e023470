/* The flash image as docs/FORMATS.md, section 1, describes it, and what stands at a place in it. */
#include "fx/crc32c.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/little_endian.h"
#include "reference/reference.h"
#include "unpack.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TILE_LOG2 = 6, POST_SHIFT_MAX = 4 };
enum {
    SECTION_CLASSES = 1,
    SECTION_BANDS,
    SECTION_DIRECTORY,
    SECTION_TILES,
    SECTION_GEOID = 8,
    SECTION_GEOID_PAGES = 13
};
enum { GEOID_BYTES = 2240, GEOID_SIDE = 33, PAGES_HEAD = 64 };
enum verdict { UNKNOWN = 0, GOOD, BAD };

enum { HEADER_BYTES = 1024, HEADER_CRC_AT = 1020, TOP_AT = 60, SECTIONS_MAX = 32 };
enum { ENTRY_BYTES = 16, ENTRY_CRC_AT = 12, UNIT_BYTES = 64 };

static const char rebuild[] = "build the image again with landmass-db";

/* The bytes of a section, or NULL when it is absent, misplaced, or not `bytes` long. */
static const uint8_t *find_section(const struct ref_db *db, uint32_t type, uint64_t bytes)
{
    const uint32_t count = hs_get_u32(db->bytes + 56);
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t *entry = db->bytes + 64 + (size_t)24 * i;
        const uint64_t offset = hs_get_u64(entry + 8);
        if (hs_get_u32(entry) == type) {
            return hs_get_u64(entry + 16) == bytes && offset % 64 == 0 && offset <= db->size &&
                           bytes <= db->size - offset
                       ? db->bytes + offset
                       : NULL;
        }
    }
    return NULL;
}

/* How long a section says it is; 0 when it is absent. */
static uint64_t section_bytes(const struct ref_db *db, uint32_t type)
{
    const uint32_t count = hs_get_u32(db->bytes + 56);
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t *entry = db->bytes + 64 + (size_t)24 * i;
        if (hs_get_u32(entry) == type) {
            return hs_get_u64(entry + 16);
        }
    }
    return 0;
}

static bool has_good_section_crc(const struct ref_db *db, uint32_t type, const uint8_t *at,
                                 uint64_t bytes)
{
    const uint32_t count = hs_get_u32(db->bytes + 56);
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t *entry = db->bytes + 64 + (size_t)24 * i;
        if (hs_get_u32(entry) == type) {
            return hs_get_u32(entry + 4) == fx_crc32c(0, at, (size_t)bytes);
        }
    }
    return false;
}

static int read_header(struct ref_db *db, const char *name)
{
    const uint8_t *h = db->bytes;
    if (db->size < HEADER_BYTES || memcmp(h, "LANDMASS", 8) != 0) {
        return hs_error(name, "give an image made by landmass-db", "this is no landmass image");
    }
    if (hs_get_u32(h + 8) != LM_DB_VERSION) {
        return hs_error(name, "`landmass-db convert OLD NEW` makes a new image of one of version 2",
                        "version %u, this program knows %d", hs_get_u32(h + 8), LM_DB_VERSION);
    }
    if (hs_get_u32(h + HEADER_CRC_AT) != fx_crc32c(0, h, HEADER_CRC_AT)) {
        return hs_error(name, rebuild, "the header's checksum does not hold");
    }
    if (h[TOP_AT] != 0) {
        return hs_error(name, "use a newer program", "its coarsest level is stored in another way");
    }
    db->shift0 = h[24];
    db->level_count = h[25];
    db->band_count = (uint32_t)(h[26] | h[27] << 8);
    db->entry_count = hs_get_u32(h + 28);
    db->record_count = hs_get_u32(h + 32);
    const bool is_sound = db->shift0 >= LM_DB_SHIFT_MIN && db->level_count >= 1 &&
                          db->level_count <= LM_DB_LODS_MAX &&
                          db->shift0 + db->level_count - 1 <= LM_DB_SHIFT_MAX &&
                          db->band_count >= 1 && db->band_count <= LM_DB_BANDS_MAX &&
                          hs_get_u32(h + 36) == LM_TILE_BYTES && hs_get_u64(h + 16) <= db->size &&
                          hs_get_u32(h + 56) >= 5 && hs_get_u32(h + 56) <= SECTIONS_MAX;
    if (!is_sound) {
        return hs_error(name, rebuild, "a number of the header is out of its range");
    }
    db->mean_elevation_m = (int32_t)hs_get_u32(h + 40) / 64.0;
    db->geoid_m = (int32_t)hs_get_u32(h + 44) / 64.0;
    db->centre.latitude_deg = (int32_t)hs_get_u32(h + 48) * (360 / 4294967296.0);
    db->centre.longitude_deg = (int32_t)hs_get_u32(h + 52) * (360 / 4294967296.0);
    return 0;
}

static bool is_sound_band(const struct ref_db *db, const struct lm_band *band)
{
    const uint64_t entries = (uint64_t)band->rows * band->columns;
    return band->lod < db->level_count && band->zone <= 3 && band->rows >= 1 &&
           band->columns >= 1 && entries / band->columns == band->rows &&
           entries <= db->entry_count && band->entry0 <= db->entry_count - entries;
}

static int find_sections(struct ref_db *db, const char *name)
{
    const uint64_t classes_bytes = sizeof(struct lm_classes);
    const uint64_t bands_bytes = db->band_count * sizeof(struct lm_band);
    const uint8_t *classes = find_section(db, SECTION_CLASSES, classes_bytes);
    const uint8_t *bands = find_section(db, SECTION_BANDS, bands_bytes);
    db->directory = find_section(db, SECTION_DIRECTORY, (uint64_t)db->entry_count * ENTRY_BYTES);
    db->tiles_bytes = section_bytes(db, SECTION_TILES);
    db->records = find_section(db, SECTION_TILES, db->tiles_bytes);
    if (!classes || !bands || !db->directory || !db->records) {
        return hs_error(name, rebuild, "a section is missing or lies outside the file");
    }
    if (!has_good_section_crc(db, SECTION_CLASSES, classes, classes_bytes) ||
        !has_good_section_crc(db, SECTION_BANDS, bands, bands_bytes)) {
        return hs_error(name, rebuild, "the checksum of the classes or bands does not hold");
    }
    /* Sections start at multiples of 64 in a block from malloc, so the casts are aligned. */
    db->classes = (const struct lm_classes *)(const void *)classes;
    db->bands = (const struct lm_band *)(const void *)bands;
    for (uint32_t i = 0; i < db->band_count; i++) {
        if (!is_sound_band(db, &db->bands[i])) {
            return hs_error(name, rebuild, "band %u is out of range", i);
        }
    }
    return 0;
}

static int find_geoid(struct ref_db *db, const char *name)
{
    if (section_bytes(db, SECTION_GEOID) == 0) {
        return 0;
    }
    db->geoid = find_section(db, SECTION_GEOID, GEOID_BYTES);
    const uint8_t *g = db->geoid;
    const bool is_sound = g && has_good_section_crc(db, SECTION_GEOID, g, GEOID_BYTES) &&
                          g[8] >= 16 && g[8] <= 27 && g[9] >= 16 && g[9] <= 27 && g[10] >= 2 &&
                          g[10] <= GEOID_SIDE && g[11] >= 2 && g[11] <= GEOID_SIDE;
    return is_sound ? 0 : hs_error(name, rebuild, "the section GEOID does not hold");
}

/* Steps from the first node to a place that lies so many degrees from it, kept within the nodes. */
static double steps(double degrees, unsigned shift, unsigned nodes)
{
    return fmin(fmax(degrees / ldexp(360, (int)shift - 32), 0), nodes - 1);
}

/* The page that holds a place, or NULL. */
static const uint8_t *page_of(const struct ref_db *db, struct ref_place place)
{
    const uint64_t bytes = section_bytes(db, SECTION_GEOID_PAGES);
    const uint8_t *head = bytes < PAGES_HEAD ? NULL : find_section(db, SECTION_GEOID_PAGES, bytes);
    if (!head) {
        return NULL;
    }
    const double side = ldexp(360, (int)(hs_get_u32(head) & 31) + 5 - 32);
    const double row = floor((place.latitude_deg + 90) / side) - hs_get_u32(head + 4);
    const double east = place.longitude_deg - hs_get_u32(head + 12) * side;
    const double column = floor((east - 360 * floor(east / 360)) / side);
    const double rows = hs_get_u32(head + 8), columns = hs_get_u32(head + 16);
    const bool is_whole = PAGES_HEAD + rows * columns * GEOID_BYTES <= (double)bytes;
    return is_whole && row >= 0 && row < rows && column < columns
               ? head + PAGES_HEAD + (size_t)(row * columns + column) * GEOID_BYTES
               : NULL;
}

double ref_db_geoid_m(const struct ref_db *db, struct ref_place place)
{
    const uint8_t *page = page_of(db, place), *g = page ? page : db->geoid;
    if (!g) {
        return db->geoid_m;
    }
    const double turn = 360 / 4294967296.0, width = ldexp(360, g[9] - 32) * (g[11] - 1);
    const double middle = (int32_t)hs_get_u32(g + 4) * turn + width / 2;
    const double v = steps(place.latitude_deg - (int32_t)hs_get_u32(g) * turn, g[8], g[10]);
    const double u = steps(remainder(place.longitude_deg - middle, 360) + width / 2, g[9], g[11]);
    const double row = fmin(floor(v), g[10] - 2), column = fmin(floor(u), g[11] - 2);
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        const uint8_t *at = g + 16 + 2 * (((int)row + i / 2) * GEOID_SIDE + (int)column + i % 2);
        const double a = i % 2 ? u - column : column + 1 - u, b = i / 2 ? v - row : row + 1 - v;
        sum += a * b * (int16_t)(at[0] | at[1] << 8) / 64;
    }
    return sum;
}

static int open_bytes(struct ref_db *db, const char *name)
{
    if (read_header(db, name) == 0 && find_sections(db, name) == 0 && find_geoid(db, name) == 0) {
        db->verdicts = calloc((size_t)db->entry_count + 1, 1);
        db->unpacked = calloc((size_t)db->entry_count + 1, sizeof(struct lm_tile *));
        if (db->verdicts != NULL && db->unpacked != NULL) {
            return 0;
        }
        hs_error(name, NULL, "not enough memory");
    }
    ref_db_close(db);
    return -1;
}

int ref_db_open_memory(struct ref_db *db, const void *bytes, size_t size, const char *name)
{
    *db = (struct ref_db){.bytes = malloc(size + 1), .size = size};
    if (db->bytes == NULL) {
        return hs_error(name, NULL, "not enough memory for %zu bytes", size);
    }
    memcpy(db->bytes, bytes, size);
    return open_bytes(db, name);
}

/* The whole file in one block; `*size` bytes. NULL with the error reported. */
static uint8_t *read_whole(const char *path, size_t *size)
{
    FILE *file = hs_input_open(path, "rb");
    if (file == NULL) {
        hs_error(path, "check the path", "cannot be opened: %s", strerror(errno));
        return NULL;
    }
    uint8_t *bytes = NULL;
    const long length = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (length >= 0 && fseek(file, 0, SEEK_SET) == 0) {
        bytes = malloc((size_t)length + 1);
    }
    if (bytes == NULL || fread(bytes, 1, (size_t)length, file) != (size_t)length) {
        hs_error(path, NULL, "cannot be read whole");
        free(bytes);
        bytes = NULL;
    }
    fclose(file);
    *size = (size_t)length;
    return bytes;
}

int ref_db_open(struct ref_db *db, const char *path)
{
    *db = (struct ref_db){0};
    db->bytes = read_whole(path, &db->size);
    return db->bytes == NULL ? -1 : open_bytes(db, path);
}

void ref_db_close(struct ref_db *db)
{
    free(db->bytes);
    free(db->verdicts);
    for (uint32_t i = 0; db->unpacked != NULL && i < db->entry_count; i++) {
        free(db->unpacked[i]);
    }
    free(db->unpacked);
    *db = (struct ref_db){0};
}

double ref_db_cell_m(const struct ref_db *db, unsigned level)
{
    return ldexp(REF_MERIDIAN_M, (int)(db->shift0 + level) - 32);
}

unsigned ref_db_level_for(const struct ref_db *db, double cell_m)
{
    unsigned level = 0;
    while (level + 1 < db->level_count && ref_db_cell_m(db, level + 1) <= cell_m * 9 / 8) {
        level++;
    }
    return level;
}

/* A place on the grid of one level: which tile, which cell in it, and where in the cell (0..1). */
struct grid_place {
    uint32_t zone, row, column, r, c;
    double north, east;
};

/* A border of latitude belongs to the tile north of it, in either hemisphere (assumed). */
static uint32_t zone_of(int64_t latitude_bam)
{
    const int64_t sixteenth = (latitude_bam >= 0 ? latitude_bam : -latitude_bam - 1) >> 26;
    return (uint32_t)((sixteenth >= 11) + (sixteenth >= 13) + (sixteenth >= 15));
}

static struct grid_place locate(const struct ref_db *db, unsigned level, struct ref_place place)
{
    const double circle = 4294967296.0;
    const double latitude = place.latitude_deg / 360 * circle;
    const double turns = place.longitude_deg / 360;
    struct grid_place g = {.zone = zone_of((int64_t)floor(latitude))};
    const int shift = (int)(db->shift0 + level);
    const double y = ldexp(fmin(fmax(latitude + circle / 4, 0), circle / 2 - 1), -shift);
    const double x = ldexp((turns - floor(turns)) * circle, -shift - (int)g.zone);
    const uint32_t columns = UINT32_C(1) << (32 - shift - (int)g.zone);
    const uint32_t whole_y = (uint32_t)floor(y), whole_x = (uint32_t)floor(x) % columns;
    g.row = whole_y >> TILE_LOG2;
    g.column = whole_x >> TILE_LOG2;
    g.r = whole_y % LM_TILE_CELLS;
    g.c = whole_x % LM_TILE_CELLS;
    g.north = y - floor(y);
    g.east = x - floor(x);
    return g;
}

/* The tile of a compressed record, kept from then on; NULL if it cannot be unpacked or there is no
 * memory. */
static const struct lm_tile *unpacked_tile(const struct ref_db *db, uint32_t entry,
                                           const uint8_t *record, uint32_t bytes)
{
    if (db->unpacked[entry] == NULL && db->verdicts[entry] == UNKNOWN) {
        struct lm_tile *tile = malloc(sizeof *tile);
        if (tile == NULL || !ref_unpack(record, bytes, tile)) {
            db->verdicts[entry] = BAD;
            free(tile);
            return NULL;
        }
        db->unpacked[entry] = tile;
    }
    return db->unpacked[entry];
}

static bool is_good_record(const struct ref_db *db, uint32_t entry, const struct lm_tile *tile)
{
    if (db->verdicts[entry] == UNKNOWN) {
        const uint8_t *checked = (const uint8_t *)tile + sizeof tile->crc;
        const bool is_good = tile->crc == fx_crc32c(0, checked, LM_TILE_BYTES - sizeof tile->crc);
        db->verdicts[entry] = is_good ? GOOD : BAD;
    }
    return db->verdicts[entry] == GOOD;
}

/* The record of a directory entry, or NULL: no such tile, or something is wrong with it. */
static const struct lm_tile *entry_tile(const struct ref_db *db, uint32_t entry, unsigned level,
                                        const struct grid_place *g)
{
    const uint8_t *at = db->directory + (size_t)entry * ENTRY_BYTES;
    uint8_t checked[4 + ENTRY_CRC_AT];
    memcpy(checked, &entry, 4);
    memcpy(checked + 4, at, ENTRY_CRC_AT);
    const uint32_t place = hs_get_u32(at);
    const uint32_t size = (uint32_t)(at[4] | at[5] << 8);
    const bool is_raw = at[6] == 0 && size * UNIT_BYTES == LM_TILE_BYTES;
    const bool is_packed = at[6] == 1 && size > 0 && size * UNIT_BYTES < LM_TILE_BYTES;
    if (hs_get_u32(at + ENTRY_CRC_AT) != fx_crc32c(0, checked, sizeof checked) ||
        place == UINT32_MAX || !(is_raw || is_packed) ||
        ((uint64_t)place + size) * UNIT_BYTES > db->tiles_bytes) {
        return NULL;
    }
    const uint8_t *record = db->records + (size_t)place * UNIT_BYTES;
    const struct lm_tile *tile = is_raw ? (const struct lm_tile *)(const void *)record
                                        : unpacked_tile(db, entry, record, size * UNIT_BYTES);
    if (tile == NULL) {
        return NULL;
    }
    const bool is_asked_for = tile->lod == level && tile->zone == g->zone && tile->row == g->row &&
                              tile->column == g->column;
    return is_good_record(db, entry, tile) && is_asked_for && tile->post_shift <= POST_SHIFT_MAX
               ? tile
               : NULL;
}

static const struct lm_tile *find_tile(const struct ref_db *db, unsigned level,
                                       const struct grid_place *g)
{
    const uint32_t columns = UINT32_C(1) << (32 - TILE_LOG2 - db->shift0 - level - g->zone);
    for (uint32_t i = 0; i < db->band_count; i++) {
        const struct lm_band *band = &db->bands[i];
        const uint32_t along = (g->column - band->column0) & (columns - 1);
        if (band->lod == level && band->zone == g->zone && g->row >= band->row0 &&
            g->row - band->row0 < band->rows && along < band->columns) {
            return entry_tile(db, band->entry0 + (g->row - band->row0) * band->columns + along,
                              level, g);
        }
    }
    return NULL;
}

/* The tile that holds the place at this level or the nearest coarser one that has it. */
static const struct lm_tile *find_nearest(const struct ref_db *db, unsigned level,
                                          struct ref_place place, struct grid_place *g)
{
    for (; level < db->level_count; level++) {
        *g = locate(db, level, place);
        const struct lm_tile *tile = find_tile(db, level, g);
        if (tile != NULL) {
            return tile;
        }
    }
    return NULL;
}

static double gain_db(const struct ref_db *db, int class_index, unsigned level)
{
    return db->classes->entry[class_index].lod_gain_db_q8[level] / 256.0;
}

void ref_db_cell(const struct ref_db *db, unsigned level, struct ref_place place,
                 struct ref_bin *bin)
{
    struct grid_place g;
    const struct lm_tile *tile = find_nearest(db, level, place, &g);
    const uint32_t cell = tile ? tile->points[1 + g.r][1 + g.c].cell : LM_DB_CLASS_NONE << 4;
    bin->class_index = (int)(cell >> 4 & 15);
    bin->has_data = bin->class_index != LM_DB_CLASS_NONE;
    bin->kind = db->classes->entry[bin->class_index].kind;
    bin->facing = db->classes->entry[bin->class_index].facing;
    bin->gamma_db =
        (cell >> 8) / 2.0 - 80 + gain_db(db, bin->class_index, tile ? tile->lod : level);
    bin->height_m = db->classes->height_dm[cell & 15] / 10.0;
}

/* The four cells around a place of a tile, by the points of its record. */
static struct ref_corners corners_of(const struct ref_db *db, const struct lm_tile *tile,
                                     const struct grid_place *g, double cell_m, bool is_exact)
{
    const double half = 0.5;
    const double y = g->r + g->north + half, x = g->c + g->east + half; /* rows of points */
    const double v = y - floor(y), u = x - floor(x);
    const struct lm_tile_point *low = &tile->points[(int)y][(int)x];
    const struct lm_tile_point *high = &tile->points[(int)y + 1][(int)x];
    const double map_m = ref_db_cell_m(db, tile->lod);
    const bool has_crowns = cell_m < 3.5 && map_m > 3.5;
    const double texels = has_crowns ? ldexp(1, (int)db->shift0 + tile->lod - 7) : 4;
    const double row = (g->r + g->north) * texels, column = (g->c + g->east) * texels;
    const bool is_stepped = cell_m >= 1.5 * map_m / texels;
    return (struct ref_corners){
        .cell = {low[0].cell, low[1].cell, high[0].cell, high[1].cell},
        .north = is_exact ? v : floor(v * 128) / 128,
        .east = is_exact ? u : floor(u * 128) / 128,
        .texel_row = fmod(is_stepped ? floor(row + half) : row, 64),
        .texel_column = fmod(is_stepped ? floor(column + half) : column, 64),
        .has_crowns = has_crowns,
    };
}

void ref_db_ground(const struct ref_db *db, double cell_m, struct ref_place place, bool is_exact,
                   struct ref_bin *bin)
{
    struct grid_place g;
    const struct lm_tile *tile = find_nearest(db, 0, place, &g);
    if (tile != NULL && cell_m < 2 * ref_db_cell_m(db, tile->lod) / 3) {
        const struct ref_corners corners = corners_of(db, tile, &g, cell_m, is_exact);
        ref_blend_cells(db, &corners, bin);
        bin->gamma_db += gain_db(db, bin->class_index, tile->lod);
    } else {
        ref_db_cell(db, ref_db_level_for(db, cell_m), place, bin);
    }
}

bool ref_db_elevation(const struct ref_db *db, unsigned level, struct ref_place place,
                      bool is_exact, double *elevation_m)
{
    struct grid_place g;
    const struct lm_tile *tile = find_nearest(db, level, place, &g);
    if (tile == NULL) {
        *elevation_m = 0;
        return false;
    }
    const double north = is_exact ? g.north : floor(g.north * 256) / 256;
    const double east = is_exact ? g.east : floor(g.east * 256) / 256;
    const struct lm_tile_point *low = &tile->points[1 + g.r][1 + g.c];
    const struct lm_tile_point *high = &tile->points[2 + g.r][1 + g.c];
    const double south_side = low[0].post * (1 - east) + low[1].post * east;
    const double north_side = high[0].post * (1 - east) + high[1].post * east;
    const double code = south_side * (1 - north) + north_side * north;
    *elevation_m = (tile->base_m_q6 + ldexp(code, tile->post_shift)) / 64;
    return true;
}
