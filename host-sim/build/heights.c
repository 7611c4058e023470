#include "build/heights.h"

#include "hs/error.h"
#include "image/codes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CODES = 16, CELLS = LM_TILE_CELLS, SURVEY_TILES = 1024 };

/* A structure is missed as badly as so many crests: crests are rough ground, structures are known.
 */
static const double structure_share = 16;

static void note(bool *occurs, double height_m)
{
    const double dm = round(height_m * 10.0);
    if (dm > 0) {
        occurs[dm < BUILD_HEIGHT_MAX_DM ? (int)dm : BUILD_HEIGHT_MAX_DM] = true;
    }
}

/* ---- structures ---- */

static void note_classes(struct build_heights *h, const struct db_class_table *table)
{
    for (int i = 0; i < table->count; i++) {
        const enum db_class_kind kind = table->items[i].kind;
        if (kind == DB_KIND_STRUCTURE || kind == DB_KIND_TREES) {
            note(h->structures, table->items[i].height_m);
        }
        /* Tops differ (build/canopy.h); they need not be told from each other as houses are. */
        for (double part = 0.55; kind == DB_KIND_TREES && part < 1.5; part += 0.15) {
            note(h->crests, table->items[i].height_m * part);
        }
    }
}

static int note_raster(struct build_heights *h, const struct resample_plane *plane)
{
    if (!plane->dataset) {
        return 0;
    }
    const int width = GDALGetRasterXSize(plane->dataset);
    const int height = GDALGetRasterYSize(plane->dataset);
    double *row = malloc((size_t)width * sizeof *row);
    int result = row ? 0 : hs_error(plane->path, NULL, "out of memory");
    for (int y = 0; y < height && result == 0; y++) {
        if (GDALRasterIO(plane->band, GF_Read, 0, y, width, 1, row, width, 1, GDT_Float64, 0, 0) !=
            CE_None) {
            result = hs_error(plane->path, "check the file with gdalinfo", "cannot be read");
            break;
        }
        for (int x = 0; x < width; x++) {
            const bool is_value = !isnan(row[x]) && !(plane->has_nodata && row[x] == plane->nodata);
            note(h->structures, is_value ? row[x] * plane->scale + plane->offset : 0);
        }
    }
    free(row);
    return result;
}

/* ---- crests ---- */

/* A tile's terrain, as coarser ones need it. */
struct relief {
    struct lm_tile tile;
    struct image_ground ground;
    struct terrain_posts posts;
};

struct survey {
    struct build_heights *h;
    struct build_context *b;
    int base; /* level at which the terrain is read */
};

static void note_crests(struct build_heights *h, const struct relief *r)
{
    for (int i = 0; i < CELLS * CELLS; i++) {
        note(h->crests, image_ground_crest_m(&r->ground, &r->tile, i / CELLS, i % CELLS));
    }
}

static void take_below(struct relief *r, struct relief *const below[4])
{
    const struct terrain_posts *posts[4];
    for (int i = 0; i < 4; i++) {
        posts[i] = below[i] ? &below[i]->posts : NULL;
    }
    build_take_posts(&r->posts, posts);
    image_posts_encode(r->posts.q6, &r->tile);
    image_ground_init(&r->ground, &r->tile);
    for (int i = 0; i < 4; i++) {
        if (below[i]) {
            image_ground_take_tops(&r->ground, &r->tile, &below[i]->ground, i);
        }
    }
}

static int survey_tile(const struct survey *s, int level, uint32_t row, uint32_t column,
                       struct relief **out);

/* Make a tile's relief from the terrain, or from the tiles below it. Returns how many posts or
 * tiles gave something, or -1. */
static int make_relief(const struct survey *s, const struct image_frame *f, int level,
                       struct relief *r)
{
    struct relief *below[4] = {NULL, NULL, NULL, NULL};
    int found = 0;
    if (level == s->base) {
        found = terrain_posts(&s->b->terrain, f, &r->posts);
    }
    for (int i = 0; i < 4 && level > s->base && found >= 0; i++) {
        const int status = survey_tile(s, level - 1, 2 * f->row + (uint32_t)(i / 2),
                                       2 * f->column + (uint32_t)(i % 2), &below[i]);
        found = status < 0 ? -1 : found + (below[i] != NULL);
    }
    if (found > 0) {
        /* Where there is no tile below, what is there must not look like a cliff. */
        for (int i = 0; i < 4 && level > s->base; i++) {
            if (!below[i]) {
                found = terrain_posts(&s->b->terrain, f, &r->posts) < 0 ? -1 : found;
                break;
            }
        }
        take_below(r, below);
        note_crests(s->h, r);
    }
    for (int i = 0; i < 4; i++) {
        free(below[i]);
    }
    return found;
}

static int survey_tile(const struct survey *s, int level, uint32_t row, uint32_t column,
                       struct relief **out)
{
    const struct lm_band *band = build_plan_band(&s->b->plan, level, row);
    *out = NULL;
    if (!band) {
        return 0;
    }
    const uint8_t shift = (uint8_t)(s->b->plan.shift0 + level);
    const uint32_t mask = image_columns_round(shift, band->zone) - 1;
    if (((column - band->column0) & mask) >= band->columns) {
        return 0;
    }
    const struct image_frame f = image_frame_of(shift, band->zone, row, column & mask);
    struct relief *r = calloc(1, sizeof *r);
    if (!r) {
        return hs_error("heights", "choose larger cells", "out of memory");
    }
    const int found = make_relief(s, &f, level, r);
    if (found <= 0) {
        free(r);
        return found;
    }
    *out = r;
    return 0;
}

/* The finest level at which terrain gives tiles of its own, but not so fine that there are more
 * than SURVEY_TILES. */
static int choose_base(const struct build_context *b)
{
    int level = b->plan.level_count - 1;
    for (int i = 0; i < b->terrain.layer_count; i++) {
        level = b->terrain_level[i] < level ? b->terrain_level[i] : level;
    }
    for (; level < b->plan.level_count - 1; level++) {
        uint64_t tiles = 0;
        for (int i = 0; i < b->plan.band_count; i++) {
            const struct lm_band *band = &b->plan.bands[i];
            tiles += band->lod == level ? (uint64_t)band->rows * band->columns : 0;
        }
        if (tiles <= SURVEY_TILES) {
            break;
        }
    }
    return level;
}

static int note_terrain(struct build_heights *h, struct build_context *b)
{
    const struct survey s = {h, b, choose_base(b)};
    int result = 0;
    const uint64_t beyond = b->terrain.posts_beyond;
    for (int i = 0; i < b->plan.band_count; i++) {
        const struct lm_band *band = &b->plan.bands[i];
        const uint32_t tiles =
            band->lod == b->plan.level_count - 1 ? band->rows * band->columns : 0;
        for (uint32_t k = 0; k < tiles && result == 0; k++) {
            struct relief *top;
            result = survey_tile(&s, band->lod, band->row0 + k / band->columns,
                                 band->column0 + k % band->columns, &top);
            free(top);
        }
    }
    b->terrain.posts_beyond = beyond;
    return result;
}

int build_heights_survey(struct build_heights *h, struct build_context *b)
{
    *h = (struct build_heights){0};
    note_classes(h, &b->table);
    return note_raster(h, &b->cover.heights) == 0 ? note_terrain(h, b) : -1;
}

/* ---- the table ---- */

/* Heights that occur, ascending, and sums over all before each: of weight, weight * height, and
 * weight * height^2. The weight is one over the square of what may be missed. */
struct misses {
    int count;
    double *height, *sums[3]; /* count, and count + 1 of each sum */
};

static double weight_of(const struct build_heights *h, int dm)
{
    const double structure_dm = fmax(0.02 * dm, 5.0), crest_dm = fmax(0.1 * dm, 20.0);
    return structure_share * h->structures[dm] / (structure_dm * structure_dm) +
           h->crests[dm] / (crest_dm * crest_dm);
}

/* Heights are taken together in steps of half a per cent, or of a decimetre. */
static bool misses_make(struct misses *m, const struct build_heights *h)
{
    const size_t room = BUILD_HEIGHT_MAX_DM + 2;
    double *memory = calloc(4 * room, sizeof *memory);
    *m = (struct misses){.height = memory,
                         .sums = {memory + room, memory + 2 * room, memory + 3 * room}};
    for (int dm = 1, next; memory && dm <= BUILD_HEIGHT_MAX_DM; dm = next) {
        double sum[3] = {0, 0, 0};
        next = dm + 1 + dm / 200;
        for (int k = dm; k < next && k <= BUILD_HEIGHT_MAX_DM; k++) {
            const double w = weight_of(h, k);
            sum[0] += w;
            sum[1] += w * k;
            sum[2] += w * k * k;
        }
        if (sum[0] > 0) {
            const int i = m->count++;
            m->height[i] = sum[1] / sum[0];
            for (int k = 0; k < 3; k++) {
                m->sums[k][i + 1] = m->sums[k][i] + sum[k];
            }
        }
    }
    return memory != NULL;
}

/* The whole decimetres that stand best for heights first..end - 1. */
static double best_of(const struct misses *m, int first, int end)
{
    const double w = m->sums[0][end] - m->sums[0][first];
    return round((m->sums[1][end] - m->sums[1][first]) / w);
}

/* What heights first..end - 1 miss by if `height` stands for them. */
static double missed(const struct misses *m, int first, int end, double height)
{
    const double w = m->sums[0][end] - m->sums[0][first];
    const double wh = m->sums[1][end] - m->sums[1][first];
    const double whh = m->sums[2][end] - m->sums[2][first];
    return whh - 2 * height * wh + height * height * w;
}

/* best[k][n]: the least that the lowest n heights miss with codes 0..k; from[k][n]: the first of
 * those that code k stands for. */
static void choose(const struct misses *m, double *best[CODES], int *from[CODES])
{
    for (int n = 0; n <= m->count; n++) {
        best[0][n] = missed(m, 0, n, 0);
        from[0][n] = 0;
    }
    for (int k = 1; k < CODES; k++) {
        for (int n = 0; n <= m->count; n++) {
            best[k][n] = best[k - 1][n];
            from[k][n] = n;
            for (int first = 0; first < n; first++) {
                const double all = best[k - 1][first] + missed(m, first, n, best_of(m, first, n));
                if (all < best[k][n]) {
                    best[k][n] = all;
                    from[k][n] = first;
                }
            }
        }
    }
}

/* The table from the choices made, from the highest code down. A code that stands for nothing takes
 * the height above it. */
static void trace_back(const struct misses *m, int *const from[CODES], uint16_t table_dm[16])
{
    int end = m->count;
    uint16_t above = 0;
    for (int k = CODES - 1; k > 0; k--) {
        const int first = from[k][end];
        table_dm[k] = first < end ? (uint16_t)best_of(m, first, end) : above;
        above = table_dm[k];
        end = first;
    }
    table_dm[0] = 0;
    for (int k = CODES - 1; k > 0 && table_dm[k] == 0; k--) {
        table_dm[k] = (uint16_t)(m->count ? m->height[m->count - 1] : 0);
    }
}

void build_heights_choose(const struct build_heights *h, uint16_t table_dm[16])
{
    struct misses m;
    const bool has_memory = misses_make(&m, h);
    const size_t columns = (size_t)m.count + 1;
    double *costs = calloc(CODES * columns, sizeof *costs);
    int *places = calloc(CODES * columns, sizeof *places);
    memset(table_dm, 0, CODES * sizeof *table_dm);
    if (has_memory && costs && places) {
        double *best[CODES];
        int *from[CODES];
        for (int k = 0; k < CODES; k++) {
            best[k] = costs + (size_t)k * columns;
            from[k] = places + (size_t)k * columns;
        }
        choose(&m, best, from);
        trace_back(&m, from, table_dm);
    }
    free(costs);
    free(places);
    free(m.height);
}
