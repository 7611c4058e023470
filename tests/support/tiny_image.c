#include "tiny_image.h"

#include "fx/crc32c.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    POST_SHIFT_MAX = 4,
    TILE_LOG2 = 6,
    TILE = 64,
    SECTION_COUNT = 5, /* that every image has */
    SECTION_COUNT_AT = 56,
    SECTION_ENTRY = 24,
    HEADER_BYTES = 1024,
    TITLE_AT = 832,
    CRC_AT = HEADER_BYTES - 4,
    UNIT = 64, /* of places and sizes in the directory */
    ENTRY = 16,
    NONE = -1 /* place of what there is not */
};

static const double semi_axis_m = 6378137.0, e2 = 0.00669437999014;

/* The highest terrain of a cell and its place in the cell, 0..1 from the south-west corner. */
struct top {
    double m, north, east;
};

/* What coarser levels are made of: cells with heights of structures alone, tops, and the tile's own
 * posts in metres. */
struct ground {
    uint16_t cells[TILE][TILE];
    struct top tops[TILE][TILE];
    double posts_m[TILE + 1][TILE + 1];
};

struct builder {
    const struct tiny_spec *spec;
    const struct lm_classes *classes;
    struct lm_band bands[LM_DB_BANDS_MAX];
    uint32_t first_band[LM_DB_LODS_MAX + 1]; /* of each level, and the end of the last */
    uint32_t band_count, entry_count, record_count;
    uint8_t level_count;
    int64_t south, north, west, east; /* of the wanted area, BAM; longitudes may pass 2^32 */
    struct lm_tile **tiles;           /* by directory entry; NULL where left out */
    struct ground **grounds;          /* of each tile */
    double land_sum_m;
    uint32_t land_count;
    double meridian_m, parallel_m; /* radii at the centre */
};

static const struct lm_classes built_in = {
    .entry =
        {
            [TINY_SOIL] =
                {"soil", LM_KIND_GROUND, {150, 110, 70}, -20 * 256, 768, 0, 1, 0, 0, {0}, {0}},
            [TINY_ASPHALT] =
                {"asphalt", LM_KIND_GROUND, {80, 80, 80}, -30 * 256, 768, 0, 1, 0, 0, {0}, {0}},
            [TINY_CONCRETE] =
                {"concrete", LM_KIND_GROUND, {180, 180, 180}, -28 * 256, 768, 0, 1, 0, 0, {0}, {0}},
            [TINY_STRUCTURE] =
                {"structure", LM_KIND_STRUCTURE, {200, 60, 60}, 0, 768, 100, 1, 0, 0, {0}, {0}},
            [TINY_TREES] =
                {"trees", LM_KIND_TREES, {30, 120, 40}, -15 * 256, 768, 150, 1, 0, 0, {0}, {0}},
            [TINY_WATER] =
                {"water", LM_KIND_WATER, {40, 70, 160}, -40 * 256, 768, 0, 1, 0, 0, {0}, {0}},
            [TINY_NONE] =
                {"no data", LM_KIND_GROUND, {0, 0, 0}, -80 * 256, 0, 0, 1, 0, 0, {0}, {0}},
        },
    .height_dm = {0, 20, 40, 60, 80, 100, 120, 150, 200, 250, 300, 400, 500, 600, 800, 1000},
};

const struct lm_classes *tiny_classes(void)
{
    return &built_in;
}

static struct tiny_cell soil_everywhere(void *ctx, const struct tiny_place *place)
{
    (void)ctx;
    (void)place;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

struct tiny_spec tiny_spec_at(double latitude_deg, double longitude_deg)
{
    return (struct tiny_spec){.latitude_deg = latitude_deg,
                              .longitude_deg = longitude_deg,
                              .shift0 = 9,
                              .rows = 1,
                              .columns = 1,
                              .cell = soil_everywhere};
}

static int64_t bam_from_deg(double deg)
{
    return llround(deg / 360 * 4294967296.0);
}

/* A tile lies in one zone, so its first latitude tells: at or above a border in the north, below
 * the mirrored one in the south. */
static uint8_t zone_of_row(uint32_t row, uint32_t shift)
{
    const int64_t south = ((int64_t)row << (shift + TILE_LOG2)) - (1 << 30);
    const int64_t outward = south >= 0 ? south : -south - 1;
    const int64_t sixteenth = outward >> 26;
    return (uint8_t)((sixteenth >= 11) + (sixteenth >= 13) + (sixteenth >= 15));
}

static uint32_t tile_width_log2(const struct builder *b, uint32_t level, uint32_t zone)
{
    return b->spec->shift0 + level + TILE_LOG2 + zone;
}

/* Which tile of size 2^shift holds x; >> rounds down, also below zero. */
static int64_t tile_index(int64_t x, uint32_t shift)
{
    return x >> shift;
}

static int64_t tile_start(int64_t x, uint32_t shift)
{
    return tile_index(x, shift) * (INT64_C(1) << shift);
}

/* The area is as many tiles of level 0 as were asked for, the centre as near its middle as whole
 * tiles allow. */
static void choose_area(struct builder *b)
{
    const struct tiny_spec *spec = b->spec;
    const int64_t latitude = bam_from_deg(spec->latitude_deg) + (1 << 30);
    const int64_t longitude = bam_from_deg(spec->longitude_deg) & 0xFFFFFFFF;
    const uint32_t high = spec->shift0 + TILE_LOG2;
    const uint32_t wide = high + zone_of_row((uint32_t)(latitude >> high), spec->shift0);
    const int64_t half_rows = ((int64_t)spec->rows - 1) << (high - 1);
    const int64_t half_columns = ((int64_t)spec->columns - 1) << (wide - 1);
    b->south = tile_start(latitude - half_rows, high);
    b->north = b->south + ((int64_t)spec->rows << high);
    b->west = tile_start(longitude - half_columns, wide);
    b->east = b->west + ((int64_t)spec->columns << wide);
}

static void widen_area(struct builder *b, uint32_t shift)
{
    const int64_t side = (int64_t)b->spec->margin << (shift + TILE_LOG2);
    const int64_t middle = (b->south + b->north) / 2;
    const uint8_t zone = zone_of_row((uint32_t)(middle >> (shift + TILE_LOG2)), shift);
    b->south -= side;
    b->north += side;
    b->west -= side << zone;
    b->east += side << zone;
}

static int add_band(struct builder *b, uint8_t level, uint8_t zone, uint32_t row0, uint32_t rows)
{
    if (b->band_count == LM_DB_BANDS_MAX) {
        return -1;
    }
    const uint32_t wide = tile_width_log2(b, level, zone);
    const int64_t round_the_world = (int64_t)1 << (32 - wide);
    const int64_t first = tile_index(b->west, wide);
    int64_t count = tile_index(b->east - 1, wide) - first + 1;
    count = count < round_the_world ? count : round_the_world;
    b->bands[b->band_count++] =
        (struct lm_band){.lod = level,
                         .zone = zone,
                         .row0 = row0,
                         .rows = rows,
                         .column0 = (uint32_t)(first & (round_the_world - 1)),
                         .columns = (uint32_t)count,
                         .entry0 = b->entry_count};
    b->entry_count += rows * (uint32_t)count;
    return 0;
}

/* The bands of one level: one for each zone that the area touches. Returns the number of tiles. */
static int64_t add_level(struct builder *b, uint8_t level)
{
    const uint32_t shift = b->spec->shift0 + level, high = shift + TILE_LOG2;
    const int64_t top = (INT64_C(1) << 31) - 1;
    const int64_t south = b->south > 0 ? b->south : 0;
    const int64_t north = b->north - 1 < top ? b->north - 1 : top;
    const uint32_t last = (uint32_t)(north >> high), before = b->entry_count;
    for (uint32_t row = (uint32_t)(south >> high); row <= last;) {
        const uint8_t zone = zone_of_row(row, shift);
        uint32_t end = row;
        while (end <= last && zone_of_row(end, shift) == zone) {
            end++;
        }
        if (add_band(b, level, zone, row, end - row) != 0) {
            return -1;
        }
        row = end;
    }
    return b->entry_count - before;
}

static int choose_bands(struct builder *b)
{
    const uint8_t asked = b->spec->level_count;
    if (asked == 0 && b->spec->margin > 0) {
        return -1;
    }
    for (uint32_t i = 0; i < LM_DB_LODS_MAX; i++) {
        const uint8_t level = (uint8_t)i;
        if (b->spec->shift0 + level > LM_DB_SHIFT_MAX) {
            break;
        }
        if (level > 0) {
            widen_area(b, (uint32_t)b->spec->shift0 + level);
        }
        const int64_t tiles = add_level(b, level);
        if (tiles < 0) {
            return -1;
        }
        b->level_count = (uint8_t)(level + 1);
        b->first_band[level + 1] = b->band_count;
        if (asked != 0 ? b->level_count == asked : tiles <= 4) {
            break;
        }
    }
    return asked == 0 || b->level_count == asked ? 0 : -1;
}

static struct tiny_place place_at(const struct builder *b, int64_t latitude_bam,
                                  int64_t longitude_bam)
{
    const double deg = 360 / 4294967296.0, rad = acos(-1.0) / 180;
    struct tiny_place p;
    p.latitude_deg = (double)latitude_bam * deg - 90;
    p.longitude_deg = (double)(int32_t)(uint32_t)longitude_bam * deg;
    p.north_m = (p.latitude_deg - b->spec->latitude_deg) * rad * b->meridian_m;
    p.east_m = remainder(p.longitude_deg - b->spec->longitude_deg, 360) * rad * b->parallel_m;
    return p;
}

static void measure_earth(struct builder *b)
{
    const double rad = acos(-1.0) / 180;
    const double sine = sin(b->spec->latitude_deg * rad), w = 1 - e2 * sine * sine;
    b->meridian_m = semi_axis_m * (1 - e2) / (w * sqrt(w));
    b->parallel_m = semi_axis_m / sqrt(w) * cos(b->spec->latitude_deg * rad);
}

static uint16_t pack_cell(struct tiny_cell cell)
{
    const double code = fmin(fmax(round((cell.gamma_db + 80) * 2), 0), 255);
    return (uint16_t)((uint32_t)code << 8 | (uint32_t)(cell.class_index & 15) << 4 |
                      (cell.height_code & 15u));
}

static struct tiny_cell unpack_cell(uint16_t packed)
{
    return (struct tiny_cell){(packed >> 8) / 2.0 - 80, (uint8_t)(packed >> 4 & 15),
                              (uint8_t)(packed & 15)};
}

/* The code whose height is nearest; the lower one when two are. */
static uint8_t nearest_height_code(const struct lm_classes *classes, double dm)
{
    uint8_t best = 0;
    for (uint8_t code = 1; code < 16; code++) {
        if (fabs(classes->height_dm[code] - dm) < fabs(classes->height_dm[best] - dm)) {
            best = code;
        }
    }
    return best;
}

static bool is_built(const struct builder *b, uint8_t k)
{
    return b->classes->entry[k].kind == LM_KIND_STRUCTURE;
}

/* FORMATS.md 1.6: mean power; structures where they return more than a quarter of it, else the
 * commonest class (the lower number when equal, data before none); and the mean height of the cells
 * of that class. The classes of these images differ in more than their facing. */
static uint16_t mean_of_four(const struct builder *b, const uint16_t four[4])
{
    double power = 0, built = 0, dm = 0;
    int votes[16] = {0};
    for (int i = 0; i < 4; i++) {
        const struct tiny_cell cell = unpack_cell(four[i]);
        const double own = pow(10, cell.gamma_db / 10) / 4;
        power += own;
        built += is_built(b, cell.class_index) ? own : 0;
        votes[cell.class_index]++;
    }
    uint8_t winner = 0;
    for (uint8_t k = 1; k < 16; k++) {
        winner = votes[k] > votes[winner] ? k : winner;
    }
    for (uint8_t k = 0; k < 16 && 4 * built > power; k++) {
        const bool is_better = !is_built(b, winner) || votes[k] > votes[winner];
        winner = is_built(b, k) && votes[k] > 0 && is_better ? k : winner;
    }
    for (int i = 0; i < 4; i++) {
        const struct tiny_cell cell = unpack_cell(four[i]);
        if (cell.class_index == winner) {
            dm += (double)b->classes->height_dm[cell.height_code] / votes[winner];
        }
    }
    return pack_cell(
        (struct tiny_cell){10 * log10(power), winner, nearest_height_code(b->classes, dm)});
}

/* A tile's own point; row 0 and column 0 are the southernmost and the westernmost. */
static struct lm_tile_point *point(struct lm_tile *tile, uint32_t r, uint32_t c)
{
    return &tile->points[1 + r][1 + c];
}

/* The tile's directory entry, or -1. */
static int64_t find_entry(const struct builder *b, uint8_t level, uint32_t row, uint32_t column)
{
    for (uint32_t i = b->first_band[level]; i < b->first_band[level + 1]; i++) {
        const struct lm_band *band = &b->bands[i];
        if (row - band->row0 >= band->rows) {
            continue;
        }
        const uint32_t wide = tile_width_log2(b, level, band->zone);
        const uint32_t along = (column - band->column0) & ((UINT32_C(1) << (32 - wide)) - 1);
        if (along < band->columns) {
            return band->entry0 + (row - band->row0) * band->columns + along;
        }
    }
    return -1;
}

static struct lm_tile *find_tile(const struct builder *b, uint8_t level, uint32_t row,
                                 uint32_t column)
{
    const int64_t entry = find_entry(b, level, row, column);
    return entry < 0 ? NULL : b->tiles[entry];
}

/* The ground below a cell of a coarser level, or NULL. */
static const struct ground *ground_below(const struct builder *b, const struct lm_tile *tile,
                                         uint32_t r, uint32_t c)
{
    const int64_t entry = tile->lod == 0
                              ? -1
                              : find_entry(b, (uint8_t)(tile->lod - 1), tile->row * 2 + r / 32,
                                           tile->column * 2 + c / 32);
    return entry < 0 ? NULL : b->grounds[entry];
}

static uint16_t make_cell(const struct builder *b, const struct lm_tile *tile, uint32_t r,
                          uint32_t c)
{
    const struct ground *below = ground_below(b, tile, r, c);
    if (below != NULL) {
        const uint32_t y = r * 2 % TILE, x = c * 2 % TILE;
        const uint16_t four[4] = {below->cells[y][x], below->cells[y][x + 1],
                                  below->cells[y + 1][x], below->cells[y + 1][x + 1]};
        return mean_of_four(b, four);
    }
    const uint32_t high = b->spec->shift0 + tile->lod, wide = high + tile->zone;
    const int64_t latitude = ((int64_t)tile->row * TILE + r) * (1 << high) + (1 << (high - 1));
    const int64_t longitude = ((int64_t)tile->column * TILE + c) * (1 << wide) + (1 << (wide - 1));
    const struct tiny_place place = place_at(b, latitude, longitude);
    return pack_cell(b->spec->cell(b->spec->ctx, &place));
}

/* The post at a row and column of a level, counted from the pole and Greenwich, from a tile that
 * has it; NAN where none has. */
static double find_post_m(const struct builder *b, uint8_t level, uint8_t zone, int64_t row,
                          int64_t column)
{
    const int64_t around = INT64_C(1) << (32 - b->spec->shift0 - level - zone);
    for (int i = 0; i < 4; i++) {
        const int64_t south = row - i / 2, west = (column - i % 2 + around) % around;
        const int64_t entry =
            find_entry(b, level, (uint32_t)(south / TILE), (uint32_t)(west / TILE));
        if (entry >= 0 && b->grounds[entry]) {
            return b->grounds[entry]->posts_m[row - south / TILE * TILE][west % TILE + i % 2];
        }
    }
    return (double)NAN;
}

/* FORMATS.md 1.6: the mean of the nine posts around one, weighted 1, 2, 1, to the nearest 1/64 m.
 * NAN on edges of tiles, and where a post is missing. */
static double smooth_post_m(const struct builder *b, uint8_t level, uint8_t zone, int64_t row,
                            int64_t column)
{
    static const double weight[3] = {0.25, 0.5, 0.25};
    double sum = 0;
    if (level == 0 || row % TILE == 0 || column % TILE == 0) {
        return (double)NAN;
    }
    for (int i = 0; i < 9; i++) {
        sum +=
            weight[i / 3] * weight[i % 3] *
            find_post_m(b, (uint8_t)(level - 1), zone, 2 * row + i / 3 - 1, 2 * column + i % 3 - 1);
    }
    return floor(sum * 64 + 0.5) / 64;
}

/* A post of a tile, or of its border, which is the neighbour's: in another zone columns differ. */
static double post_at_m(const struct builder *b, const struct lm_tile *tile, int64_t row,
                        int64_t column)
{
    const uint32_t high = b->spec->shift0 + tile->lod, wide = high + tile->zone;
    const struct tiny_place place =
        place_at(b, row * (INT64_C(1) << high), column * (INT64_C(1) << wide));
    const uint8_t zone = row < 0                 ? tile->zone
                         : (row + 1) % TILE == 0 ? zone_of_row((uint32_t)(row / TILE), high)
                                                 : tile->zone;
    const int64_t longitude = (int64_t)((uint64_t)column << wide & UINT32_MAX);
    const double smooth_m = smooth_post_m(b, tile->lod, zone, row, longitude >> (high + zone));
    const double m = b->spec->elevation_m ? b->spec->elevation_m(b->spec->ctx, &place) : 0;
    return isnan(smooth_m) ? floor(m * 64 + 0.5) / 64 : smooth_m;
}

static void sample_posts(const struct builder *b, const struct lm_tile *tile,
                         double posts_m[LM_TILE_POINTS][LM_TILE_POINTS])
{
    for (uint32_t i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
        const uint32_t r = i / LM_TILE_POINTS, c = i % LM_TILE_POINTS;
        posts_m[r][c] = post_at_m(b, tile, (int64_t)tile->row * TILE + r - 1,
                                  (int64_t)tile->column * TILE + c - 1);
    }
}

/* The base is a whole number of post steps, so that posts shared by tiles of one step agree. */
static int make_posts(struct builder *b, struct lm_tile *tile, struct ground *g)
{
    double posts_m[LM_TILE_POINTS][LM_TILE_POINTS];
    sample_posts(b, tile, posts_m);
    for (uint32_t r = 0; r <= TILE; r++) {
        memcpy(g->posts_m[r], &posts_m[1 + r][1], sizeof g->posts_m[r]);
    }
    double low = posts_m[0][0], high = low;
    for (uint32_t i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
        low = fmin(low, posts_m[i / LM_TILE_POINTS][i % LM_TILE_POINTS]);
        high = fmax(high, posts_m[i / LM_TILE_POINTS][i % LM_TILE_POINTS]);
    }
    uint8_t shift = b->spec->post_shift;
    while ((high - low) * 64 / (1 << shift) > 65534) {
        shift++;
    }
    const double step = 1 << shift;
    tile->post_shift = shift;
    tile->base_m_q6 = (int32_t)(floor(low * 64 / step) * step);
    for (uint32_t r = 0; r < LM_TILE_POINTS; r++) {
        for (uint32_t c = 0; c < LM_TILE_POINTS; c++) {
            tile->points[r][c].post =
                (uint16_t)lround((posts_m[r][c] * 64 - tile->base_m_q6) / step);
        }
    }
    return shift <= POST_SHIFT_MAX && abs(tile->base_m_q6) <= 1 << 20 ? 0 : -1;
}

/* Posts of land count towards the mean elevation of the header. */
static void count_land(struct builder *b, struct lm_tile *tile)
{
    for (uint32_t r = 0; r < TILE; r++) {
        for (uint32_t c = 0; c < TILE; c++) {
            const uint8_t class_index = unpack_cell(point(tile, r, c)->cell).class_index;
            if (class_index != LM_DB_CLASS_NONE &&
                b->classes->entry[class_index].kind != LM_KIND_WATER) {
                b->land_sum_m +=
                    (tile->base_m_q6 + point(tile, r, c)->post * (1 << tile->post_shift)) / 64.0;
                b->land_count++;
            }
        }
    }
}

/* Terrain of a tile in metres, at a place in cells from its own south-west post. */
static double terrain_m(struct lm_tile *tile, double y, double x)
{
    const uint32_t r = (uint32_t)y, c = (uint32_t)x;
    const double v = y - r, u = x - c;
    const double code =
        (point(tile, r, c)->post * (1 - u) + point(tile, r, c + 1)->post * u) * (1 - v) +
        (point(tile, r + 1, c)->post * (1 - u) + point(tile, r + 1, c + 1)->post * u) * v;
    return (tile->base_m_q6 + code * (1 << tile->post_shift)) / 64;
}

/* FORMATS.md 1.6: of the tops of the level below, the one that stands out of a cell most. */
static struct top find_top(struct lm_tile *tile, const struct ground *below, uint32_t r, uint32_t c)
{
    struct top best = {terrain_m(tile, r + 0.5, c + 0.5), 0.5, 0.5};
    double most_m = 0;
    for (uint32_t i = 0; below && i < 4; i++) { /* south-west, south-east, north-west, north-east */
        struct top top = below->tops[2 * r % TILE + i / 2][2 * c % TILE + i % 2];
        top.north = (top.north + i / 2) / 2;
        top.east = (top.east + i % 2) / 2;
        const double out_m = top.m - terrain_m(tile, r + top.north, c + top.east);
        if (out_m > most_m) {
            most_m = out_m;
            best = top;
        }
    }
    return best;
}

/* How far the line of sight is to be lifted for a cell's top. */
static double crest_m(struct lm_tile *tile, const struct top *top, uint32_t r, uint32_t c)
{
    const double z = terrain_m(tile, r + top->north, c + top->east);
    const double out_m = fmax(top->m - z, 0);
    return out_m + fmin(out_m / 2, fmax(z - terrain_m(tile, r + 0.5, c + 0.5), 0));
}

/* Cells of a tile that has its posts. */
static void make_cells(const struct builder *b, struct lm_tile *tile, struct ground *g)
{
    for (uint32_t i = 0; i < TILE * TILE; i++) {
        const uint32_t r = i / TILE, c = i % TILE;
        const struct ground *below = ground_below(b, tile, r, c);
        g->cells[r][c] = make_cell(b, tile, r, c);
        g->tops[r][c] = find_top(tile, below, r, c);
        const double crest = crest_m(tile, &g->tops[r][c], r, c);
        struct tiny_cell cell = unpack_cell(g->cells[r][c]);
        const uint8_t crest_code = crest > 0 ? nearest_height_code(b->classes, 10 * crest) : 0;
        if (cell.class_index != LM_DB_CLASS_NONE && crest_code > cell.height_code) {
            cell.height_code = crest_code;
        }
        point(tile, r, c)->cell = pack_cell(cell);
    }
}

static int make_tile(struct builder *b, const struct lm_band *band, uint32_t r, uint32_t c)
{
    const uint32_t wide = tile_width_log2(b, band->lod, band->zone);
    const uint32_t row = band->row0 + r;
    const uint32_t column = (band->column0 + c) & ((UINT32_C(1) << (32 - wide)) - 1);
    if (b->spec->leave_out && b->spec->leave_out(b->spec->ctx, band->lod, row, column)) {
        return 0;
    }
    struct lm_tile *tile = calloc(1, sizeof *tile);
    if (tile == NULL) {
        return -1;
    }
    b->tiles[band->entry0 + r * band->columns + c] = tile;
    b->record_count++;
    tile->lod = band->lod;
    tile->zone = band->zone;
    tile->row = row;
    tile->column = column;
    struct ground *ground = calloc(1, sizeof *ground);
    b->grounds[band->entry0 + r * band->columns + c] = ground;
    if (ground == NULL || make_posts(b, tile, ground) != 0) {
        return -1;
    }
    make_cells(b, tile, ground);
    if (band->lod == 0) {
        count_land(b, tile);
    }
    return 0;
}

/* FORMATS.md 1.6: the neighbour's cell at the middle of this one, or the tile's nearest. */
static uint16_t border_cell(const struct builder *b, struct lm_tile *tile, uint32_t r, uint32_t c)
{
    const uint32_t shift = b->spec->shift0 + tile->lod, wide = shift + tile->zone;
    const int64_t row = (int64_t)tile->row * TILE + r - 1;
    const int64_t middle =
        ((int64_t)tile->column * TILE + c - 1) * (INT64_C(1) << wide) + (INT64_C(1) << (wide - 1));
    struct lm_tile *neighbour = NULL;
    uint32_t column = 0;
    if (row >= 0 && row < INT64_C(1) << (31 - shift)) {
        const uint8_t zone = zone_of_row((uint32_t)(row / TILE), shift);
        column = (uint32_t)middle >> (shift + zone);
        neighbour = find_tile(b, tile->lod, (uint32_t)(row / TILE), column / TILE);
    }
    if (neighbour) {
        return point(neighbour, (uint32_t)(row % TILE), column % TILE)->cell;
    }
    const uint32_t y = r < 1 ? 1 : r > TILE ? TILE : r, x = c < 1 ? 1 : c > TILE ? TILE : c;
    return tile->points[y][x].cell;
}

static void fill_borders(struct builder *b)
{
    enum { LAST = LM_TILE_POINTS - 1 };
    for (uint32_t entry = 0; entry < b->entry_count; entry++) {
        struct lm_tile *tile = b->tiles[entry];
        for (uint32_t i = 0; tile && i <= LAST; i++) {
            tile->points[0][i].cell = border_cell(b, tile, 0, i);
            tile->points[LAST][i].cell = border_cell(b, tile, LAST, i);
            tile->points[i][0].cell = border_cell(b, tile, i, 0);
            tile->points[i][LAST].cell = border_cell(b, tile, i, LAST);
        }
    }
}

static int make_tiles(struct builder *b)
{
    b->tiles = calloc(b->entry_count, sizeof *b->tiles);
    b->grounds = calloc(b->entry_count, sizeof *b->grounds);
    if (b->tiles == NULL || b->grounds == NULL) {
        return -1;
    }
    for (uint32_t i = 0; i < b->band_count; i++) {
        const struct lm_band *band = &b->bands[i];
        for (uint32_t k = 0; k < band->rows * band->columns; k++) {
            if (make_tile(b, band, k / band->columns, k % band->columns) != 0) {
                return -1;
            }
        }
    }
    fill_borders(b);
    return 0;
}

/* Numbers are stored in the order of this machine, which is the image's: lm/db.h relies on it too.
 */
static void put_u32(uint8_t *at, uint32_t value)
{
    memcpy(at, &value, sizeof value);
}

static void put_u64(uint8_t *at, uint64_t value)
{
    memcpy(at, &value, sizeof value);
}

static size_t to_64(size_t offset)
{
    return (offset + 63) / 64 * 64;
}

static void put_header(const struct builder *b, struct tiny_image *image, size_t manifest_bytes)
{
    uint8_t *h = image->bytes;
    memcpy(h, "LANDMASS", 8);
    put_u32(h + 8, LM_DB_VERSION);
    put_u32(h + 12, HEADER_BYTES);
    put_u64(h + 16, image->size);
    h[24] = b->spec->shift0;
    h[25] = b->level_count;
    h[26] = (uint8_t)b->band_count;
    put_u32(h + 28, b->entry_count);
    put_u32(h + 32, b->record_count);
    put_u32(h + 36, LM_TILE_BYTES);
    const double mean_m = b->land_count > 0 ? b->land_sum_m / b->land_count : 0;
    put_u32(h + 40, (uint32_t)lround(mean_m * 64));
    put_u32(h + 44, (uint32_t)lround(b->spec->geoid_m * 64));
    put_u32(h + 48, (uint32_t)bam_from_deg(b->spec->latitude_deg));
    put_u32(h + 52, (uint32_t)bam_from_deg(b->spec->longitude_deg));
    put_u32(h + SECTION_COUNT_AT, SECTION_COUNT);
    const size_t sections[SECTION_COUNT][2] = {
        {image->classes_offset, sizeof(struct lm_classes)},
        {image->bands_offset, b->band_count * sizeof(struct lm_band)},
        {image->directory_offset, (size_t)b->entry_count * ENTRY},
        {image->tiles_offset, (size_t)b->record_count * LM_TILE_BYTES},
        {image->manifest_offset, manifest_bytes}};
    for (uint32_t i = 0; i < SECTION_COUNT; i++) {
        uint8_t *entry = h + 64 + (size_t)i * SECTION_ENTRY;
        put_u32(entry, i + 1);
        put_u64(entry + 8, sections[i][0]);
        put_u64(entry + 16, sections[i][1]);
    }
    memcpy(h + TITLE_AT, "tiny image of the tests", 23);
}

static void put_tiles(const struct builder *b, struct tiny_image *image)
{
    uint32_t record = 0;
    for (uint32_t entry = 0; entry < b->entry_count; entry++) {
        const struct lm_tile *tile = b->tiles[entry];
        uint8_t *at = image->bytes + image->directory_offset + (size_t)entry * ENTRY;
        put_u32(at, tile ? record * (LM_TILE_BYTES / UNIT) : (uint32_t)NONE);
        put_u32(at + 4, tile ? LM_TILE_BYTES / UNIT : 0); /* encoding 0, no detail */
        put_u32(at + 8, (uint32_t)NONE);
        if (tile) {
            memcpy(image->bytes + image->tiles_offset + (size_t)record * LM_TILE_BYTES, tile,
                   LM_TILE_BYTES);
            record++;
        }
    }
}

static int assemble(const struct builder *b, struct tiny_image *image)
{
    static const char manifest[] = "builder: tests/support/tiny_image.c\n";
    image->band_count = b->band_count;
    image->entry_count = b->entry_count;
    image->record_count = b->record_count;
    image->classes_offset = HEADER_BYTES;
    image->bands_offset = to_64(image->classes_offset + sizeof(struct lm_classes));
    image->directory_offset = to_64(image->bands_offset + b->band_count * sizeof(struct lm_band));
    image->tiles_offset = to_64(image->directory_offset + (size_t)b->entry_count * ENTRY);
    image->manifest_offset = to_64(image->tiles_offset + (size_t)b->record_count * LM_TILE_BYTES);
    image->size = image->manifest_offset + sizeof manifest - 1;
    image->bytes = calloc(1, image->size);
    if (image->bytes == NULL) {
        return -1;
    }
    put_header(b, image, sizeof manifest - 1);
    memcpy(image->bytes + image->classes_offset, b->classes, sizeof *b->classes);
    memcpy(image->bytes + image->bands_offset, b->bands, b->band_count * sizeof b->bands[0]);
    put_tiles(b, image);
    memcpy(image->bytes + image->manifest_offset, manifest, sizeof manifest - 1);
    tiny_image_seal(image);
    return 0;
}

int tiny_image_build(struct tiny_image *image, const struct tiny_spec *spec)
{
    struct builder b = {.spec = spec, .classes = spec->classes ? spec->classes : &built_in};
    memset(image, 0, sizeof *image);
    choose_area(&b);
    measure_earth(&b);
    int status = choose_bands(&b);
    if (status == 0) {
        status = make_tiles(&b);
    }
    if (status == 0) {
        status = assemble(&b, image);
    }
    for (uint32_t i = 0; b.grounds != NULL && i < b.entry_count; i++) {
        free(b.tiles[i]);
        free(b.grounds[i]);
    }
    free(b.tiles);
    free(b.grounds);
    return status;
}

int tiny_image_add_section(struct tiny_image *image, uint32_t type, const void *bytes, size_t count)
{
    const size_t at = to_64(image->size);
    uint8_t *whole = realloc(image->bytes, at + count);
    uint32_t sections;
    if (whole == NULL) {
        return -1;
    }
    memset(whole + image->size, 0, at - image->size);
    memcpy(whole + at, bytes, count);
    memcpy(&sections, whole + SECTION_COUNT_AT, sizeof sections);
    uint8_t *entry = whole + 64 + (size_t)sections * SECTION_ENTRY;
    put_u32(entry, type);
    put_u64(entry + 8, at);
    put_u64(entry + 16, count);
    put_u32(whole + SECTION_COUNT_AT, sections + 1);
    put_u64(whole + 16, at + count);
    image->bytes = whole;
    image->size = at + count;
    tiny_image_seal(image);
    return 0;
}

uint8_t *tiny_images_join(const struct tiny_image *images, uint32_t count,
                          struct lm_flash_part *parts, size_t *size)
{
    *size = 0;
    for (uint32_t i = 0; i < count; i++) {
        parts[i] = (struct lm_flash_part){*size, images[i].size};
        *size += to_64(images[i].size);
    }
    uint8_t *bytes = calloc(1, *size);
    for (uint32_t i = 0; bytes && i < count; i++) {
        memcpy(bytes + parts[i].offset, images[i].bytes, images[i].size);
    }
    return bytes;
}

void tiny_image_seal(struct tiny_image *image)
{
    for (uint32_t i = 0; i < image->record_count; i++) {
        uint8_t *record = image->bytes + image->tiles_offset + (size_t)i * LM_TILE_BYTES;
        put_u32(record, fx_crc32c(0, record + 4, LM_TILE_BYTES - 4));
    }
    for (uint32_t i = 0; i < image->entry_count; i++) {
        uint8_t *entry = image->bytes + image->directory_offset + (size_t)i * ENTRY;
        uint8_t checked[ENTRY];
        put_u32(checked, i);
        memcpy(checked + 4, entry, ENTRY - 4);
        put_u32(entry + ENTRY - 4, fx_crc32c(0, checked, sizeof checked));
    }
    uint32_t sections;
    memcpy(&sections, image->bytes + SECTION_COUNT_AT, sizeof sections);
    for (uint32_t i = 0; i < sections; i++) {
        uint8_t *section = image->bytes + 64 + (size_t)i * SECTION_ENTRY;
        uint64_t offset, bytes;
        memcpy(&offset, section + 8, sizeof offset);
        memcpy(&bytes, section + 16, sizeof bytes);
        put_u32(section + 4, fx_crc32c(0, image->bytes + offset, bytes));
    }
    put_u32(image->bytes + CRC_AT, fx_crc32c(0, image->bytes, CRC_AT));
}

int tiny_image_write(const struct tiny_image *image, const char *path)
{
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return -1;
    }
    const bool is_whole = fwrite(image->bytes, 1, image->size, file) == image->size;
    return fclose(file) == 0 && is_whole ? 0 : -1;
}

void tiny_image_free(struct tiny_image *image)
{
    free(image->bytes);
    memset(image, 0, sizeof *image);
}
