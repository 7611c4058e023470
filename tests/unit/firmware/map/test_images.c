/* Several images as one map: at each place the finest that has data answers, and it alone. */
#include "lm/images.h"

#include "check.h"
#include "hs/angle.h"
#include "lm/scan_line.h"
#include "lm/tile_cache.h"
#include "memory_flash.h"
#include "packed_tile.h"
#include "tiny_image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SLOTS = 120,
    POLLS = 16,
    THEATRE_SHIFT = 9, /* cells of 4.8 m */
    WORLD_SHIFT = 13,  /* 76 m */
    WORLD_LOD = WORLD_SHIFT - THEATRE_SHIFT,
    PLACES = 1500
};

/* One image alone, or both. */
struct map {
    struct memory_flash flash;
    struct lm_db db;
    struct lm_db images[LM_IMAGES_MAX];
    struct lm_tile_cache tiles;
    void *pool;
};

struct fixture {
    struct tiny_image theatre_image, world_image;
    uint8_t *bytes; /* the theatre, then the world */
    struct lm_flash_part parts[2];
    struct map theatre, world, both;
};

/* Water in the world alone, trees and no data in the theatre alone. */
static struct tiny_cell world_cell(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const bool is_water = sin(p->east_m / 300) + cos(p->north_m / 400) > 0.3;
    return (struct tiny_cell){is_water ? -40 : -20, is_water ? TINY_WATER : TINY_SOIL, 0};
}

static struct tiny_cell theatre_cell(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    if (p->east_m + 0.4 * p->north_m > 120) {
        return (struct tiny_cell){0, TINY_NONE, 0};
    }
    return (struct tiny_cell){-15 + round(3 * sin(p->east_m / 20)), TINY_TREES, 3};
}

static double world_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300 + 40 * sin(p->east_m / 900) + 0.01 * p->north_m;
}

static double theatre_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 700 + 25 * cos(p->north_m / 150);
}

/* Of the structures of an image, which differs from LOD to LOD and from the other's. */
static struct lm_classes classes_of(bool is_theatre)
{
    struct lm_classes classes = *tiny_classes();
    for (int lod = 0; lod < LM_DB_LODS_MAX; lod++) {
        classes.entry[TINY_STRUCTURE].lod_gain_db_q8[lod] =
            (int16_t)(is_theatre ? -1200 + 410 * lod : -1500 + 770 * lod);
    }
    return classes;
}

static struct tiny_cell town_of_world(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-3, TINY_STRUCTURE, 4};
}

static struct tiny_cell town_of_theatre(void *ctx, const struct tiny_place *p)
{
    const struct tiny_cell cell = theatre_cell(ctx, p);
    return cell.class_index == TINY_NONE ? cell : (struct tiny_cell){-1, TINY_STRUCTURE, 5};
}

static void build(struct tiny_image *image, uint8_t shift, uint8_t side, bool is_theatre,
                  bool is_town)
{
    const struct lm_classes classes = classes_of(is_theatre);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = shift;
    spec.rows = spec.columns = side;
    spec.post_shift = is_theatre ? 0 : 2;
    spec.cell = is_theatre ? theatre_cell : world_cell;
    spec.elevation_m = is_theatre ? theatre_m : world_m;
    if (is_town) {
        spec.classes = &classes;
        spec.cell = is_theatre ? town_of_theatre : town_of_world;
        spec.level_count = is_theatre ? WORLD_LOD + 2 : 0; /* two that the world has, too */
    }
    assert_int_equal(tiny_image_build(image, &spec), 0);
}

static void open_map(struct fixture *f, struct map *m, uint32_t first, uint32_t count)
{
    const size_t pool_bytes = SLOTS * sizeof(struct lm_tile);
    memory_flash_open(&m->flash, f->bytes, f->parts[1].offset + f->parts[1].bytes);
    m->pool = malloc(pool_bytes);
    assert_non_null(m->pool);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(
            lm_db_open_part(&m->images[i], &m->flash.port, &f->parts[first + i], POLLS), LM_OK);
    }
    m->db = m->images[0];
    lm_images_view(&m->db, m->images, count);
    assert_int_equal(
        lm_tile_cache_init_over(&m->tiles, &m->db, m->images, count, m->pool, pool_bytes, POLLS),
        LM_OK);
}

static struct fixture *open_fixture_of(bool is_town, bool is_packed)
{
    struct fixture *f = calloc(1, sizeof *f);
    build(&f->theatre_image, THEATRE_SHIFT, 3, true, is_town);
    build(&f->world_image, WORLD_SHIFT, 4, false, is_town);
    if (is_packed) {
        tiny_image_pack(&f->theatre_image);
    }
    const struct tiny_image images[2] = {f->theatre_image, f->world_image};
    size_t size;
    f->bytes = tiny_images_join(images, 2, f->parts, &size);
    assert_non_null(f->bytes);
    open_map(f, &f->theatre, 0, 1);
    open_map(f, &f->world, 1, 1);
    open_map(f, &f->both, 0, 2);
    return f;
}

static struct fixture *open_fixture(void)
{
    return open_fixture_of(false, false);
}

static void close_fixture(struct fixture *f)
{
    free(f->theatre.pool);
    free(f->world.pool);
    free(f->both.pool);
    free(f->bytes);
    tiny_image_free(&f->theatre_image);
    tiny_image_free(&f->world_image);
    free(f);
}

static void serve(struct map *m)
{
    uint32_t calls = 0;
    while (!lm_tile_cache_is_idle(&m->tiles) && ++calls < 100000) {
        lm_tile_cache_service(&m->tiles, 0, 1);
    }
    assert_true(lm_tile_cache_is_idle(&m->tiles));
}

/* The cell of a map when everything that it asked for has arrived. */
static uint16_t cell_of(struct map *m, uint8_t lod, struct lm_position at)
{
    (void)lm_scan_cell(&m->tiles, lod, at);
    serve(m);
    return lm_scan_cell(&m->tiles, lod, at);
}

static int32_t elevation_of(struct map *m, uint8_t lod, struct lm_position at)
{
    return lm_scan_elevation(&m->tiles, lod, at, INT32_MIN);
}

static bool has_tile(const struct lm_db *db, uint8_t lod, struct lm_position at)
{
    const uint32_t side = (uint32_t)db->shift0 + lod + LM_TILE_CELLS_LOG2;
    return lod < db->lod_count &&
           lm_db_entry(db, lod, (at.latitude + FX_BAM_90) >> side,
                       at.longitude >> (side + lm_db_zone(at.latitude))) >= 0;
}

static bool is_none(uint16_t cell)
{
    return (cell >> 4 & 15) == LM_DB_CLASS_NONE;
}

/* What should answer at a place: the theatre's LOD, or the world's as the view counts it. */
struct answer {
    struct map *map;
    uint8_t lod; /* of that map */
    uint16_t cell;
};

static struct answer answer_at(struct fixture *f, uint8_t lod, struct lm_position at)
{
    for (; lod < f->both.db.lod_count; lod++) {
        const bool has_theatre = has_tile(&f->theatre.db, lod, at);
        const uint8_t there = (uint8_t)(lod > WORLD_LOD ? lod - WORLD_LOD : 0);
        if (has_theatre && !is_none(cell_of(&f->theatre, lod, at))) {
            return (struct answer){&f->theatre, lod, cell_of(&f->theatre, lod, at)};
        }
        if (has_theatre || (lod >= WORLD_LOD && has_tile(&f->world.db, there, at))) {
            return (struct answer){&f->world, there, cell_of(&f->world, there, at)};
        }
    }
    return (struct answer){&f->world, 0, LM_CELL_NONE};
}

/* A place within `reach_m` of 46 N 11 E. */
static struct lm_position place(double reach_m)
{
    const double north_m = reach_m * (2.0 * rand() / RAND_MAX - 1);
    const double east_m = reach_m * (2.0 * rand() / RAND_MAX - 1);
    return (struct lm_position){hs_bam(46 + north_m / 111000), hs_bam(11 + east_m / 77500)};
}

static uint32_t check_places(struct fixture *f, uint8_t lod, double reach_m)
{
    uint32_t of_theatre = 0;
    for (int i = 0; i < PLACES; i++) {
        const struct lm_position at = place(reach_m);
        const struct answer wanted = answer_at(f, lod, at);
        assert_int_equal(cell_of(&f->both, lod, at), wanted.cell);
        of_theatre += wanted.map == &f->theatre;
    }
    return of_theatre;
}

TEST(the_finest_image_with_data_answers_at_every_level)
{
    struct fixture *f = open_fixture();
    srand(1);
    for (uint8_t lod = 0; lod <= WORLD_LOD + 1; lod++) {
        const uint32_t near = check_places(f, lod, 450), far = check_places(f, lod, 6000);
        if (lod < f->theatre.db.lod_count) {
            assert_in_range(near, PLACES / 3, PLACES * 2 / 3);
        }
        assert_true(far < PLACES / 4);
    }
    close_fixture(f);
}

/* Cells around a place, as far as a post of its own reaches. */
static bool is_border(struct fixture *f, uint8_t lod, struct lm_position at)
{
    const struct map *here = answer_at(f, lod, at).map;
    const fx_bam_t cell = 1u << (THEATRE_SHIFT + lod);
    for (uint32_t k = 0; k < 9; k++) {
        const struct lm_position beside = {at.latitude + (k / 3 - 1) * cell,
                                           at.longitude + (k % 3 - 1) * cell};
        if (answer_at(f, lod, beside).map != here) {
            return true;
        }
    }
    return false;
}

TEST(terrain_is_that_of_the_image_whose_cell_answers)
{
    struct fixture *f = open_fixture();
    uint32_t seen[2] = {0};
    srand(2);
    for (int i = 0; i < PLACES; i++) {
        const uint8_t lod = (uint8_t)(i % 3);
        const struct lm_position at = place(430);
        const struct answer wanted = answer_at(f, lod, at);
        (void)cell_of(&f->both, lod, at);
        const int32_t m_q10 = elevation_of(&f->both, lod, at);
        const int32_t wanted_m_q10 = elevation_of(wanted.map, wanted.lod, at);
        if (wanted.map == &f->theatre) {
            assert_int_equal(m_q10, wanted_m_q10);
            seen[0]++;
        } else if (!is_border(f, lod, at) && wanted.cell != LM_CELL_NONE) {
            /* A place is told to 1/256 of a cell of the world, and a post to 1/64 m. */
            assert_true(abs(m_q10 - wanted_m_q10) < 1024 / 4);
            seen[1]++;
        }
    }
    assert_true(seen[0] > 200 && seen[1] > 200);
    close_fixture(f);
}

/* What a line of an LOD returns from a place, dB; NAN where there is no data. */
static double return_db(struct map *m, uint8_t lod, struct lm_position at)
{
    static struct lm_scan_line line;
    const struct lm_ground_path path = {.latitude = (uint64_t)at.latitude << 32,
                                        .longitude = (uint64_t)at.longitude << 32};
    (void)cell_of(m, lod, at);
    lm_scan_line_run(&line, &m->tiles, lod, NULL, &path, 1);
    const uint32_t cell = line.cell[0], class_index = cell >> 4 & 15;
    const double gain_db = m->db.classes.entry[class_index].lod_gain_db_q8[lod] / 256.0;
    return class_index == TINY_STRUCTURE
               ? (cell >> 8 & 255) / 2.0 - 80 + ((int32_t)cell >> 16) / 256.0 + gain_db
               : NAN;
}

/* A quarter of a decibel is lost where a tile is fitted, and another where it fills a gap. */
TEST(a_town_returns_what_its_own_image_says_at_every_level)
{
    struct fixture *f = open_fixture_of(true, false);
    double worst_db = 0;
    uint32_t of_world = 0;
    srand(5);
    for (uint8_t lod = 0; lod <= WORLD_LOD + 1; lod++) {
        for (int i = 0; i < 300; i++) {
            const struct lm_position at = place(i % 2 ? 450 : 6000);
            const struct answer wanted = answer_at(f, lod, at);
            const double wanted_db = return_db(wanted.map, wanted.lod, at);
            if (!isnan(wanted_db)) {
                worst_db = fmax(worst_db, fabs(return_db(&f->both, lod, at) - wanted_db));
                of_world += wanted.map == &f->world;
            }
        }
    }
    print_message("# %u places of the world, at most %.2f dB\n", of_world, worst_db);
    assert_true(of_world > 500 && worst_db <= 0.51);
    close_fixture(f);
}

TEST(the_view_has_the_gains_of_the_finest_image_that_has_a_level)
{
    struct fixture *f = open_fixture_of(true, false);
    const struct lm_db *view = &f->both.db, *theatre = &f->both.images[0];
    assert_true(view->lod_count > theatre->lod_count);
    for (uint8_t lod = 0; lod < view->lod_count; lod++) {
        const bool is_theatre = lod < theatre->lod_count;
        const struct lm_db *image = &f->both.images[is_theatre ? 0 : 1];
        const uint32_t own = is_theatre ? lod : (uint32_t)lod - WORLD_LOD;
        for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
            assert_int_equal(view->classes.entry[i].lod_gain_db_q8[lod],
                             image->classes.entry[i].lod_gain_db_q8[own]);
        }
    }
    close_fixture(f);
}

static uintptr_t broken_from, broken_to;

static bool fetch_unless_broken(void *to, const uint8_t *from, uint32_t length)
{
    if ((uintptr_t)from >= broken_from && (uintptr_t)from < broken_to) {
        return false;
    }
    memcpy(to, from, length);
    return true;
}

static void check_world_alone(struct fixture *f)
{
    for (int i = 0; i < 200; i++) {
        const struct lm_position at = place(2000);
        const uint16_t wanted = cell_of(&f->world, 0, at);
        (void)cell_of(&f->both, 0, at);
        (void)cell_of(&f->both, 0, at); /* what failed has asked for the level above */
        for (int k = 0; k < WORLD_LOD; k++) {
            (void)cell_of(&f->both, 0, at);
        }
        assert_int_equal(cell_of(&f->both, 0, at), wanted);
    }
}

TEST(where_the_theatre_cannot_be_read_the_world_answers)
{
    struct fixture *f = open_fixture();
    srand(3);
    broken_from = (uintptr_t)f->bytes;
    broken_to = broken_from + f->parts[0].bytes;
    f->both.flash.fetch = fetch_unless_broken;
    lm_tile_cache_mount(&f->both.tiles, f->both.images, 2);
    check_world_alone(f);
    assert_true(f->both.tiles.count.io_errors > 0);
    close_fixture(f);
}

TEST(an_image_that_is_unmounted_is_not_read_and_has_no_tile_any_more)
{
    struct fixture *f = open_fixture();
    srand(4);
    for (uint32_t polls = 0; polls < 60; polls += 7) { /* in the middle of entry, record, filling */
        f->both.flash.busy_polls = 3;
        lm_tile_cache_mount(&f->both.tiles, f->both.images, 2);
        (void)lm_scan_cell(&f->both.tiles, 0, place(300));
        for (uint32_t i = 0; i < polls; i++) {
            lm_tile_cache_service(&f->both.tiles, 0, 1);
        }
        lm_tile_cache_mount(&f->both.tiles, f->both.images + 1, 1);
        for (uint32_t i = 0; i < 8 && !lm_tile_cache_is_drained(&f->both.tiles); i++) {
            lm_tile_cache_service(&f->both.tiles, 0, 1);
        }
        assert_true(lm_tile_cache_is_drained(&f->both.tiles));
        broken_from = (uintptr_t)f->bytes;
        broken_to = broken_from + f->parts[0].bytes;
        f->both.flash.fetch = fetch_unless_broken;
        const uint32_t errors = f->both.tiles.count.io_errors;
        check_world_alone(f);
        assert_int_equal(f->both.tiles.count.io_errors, errors);
        f->both.flash.fetch = NULL;
    }
    close_fixture(f);
}

/* What a cache is in the middle of. */
enum { READING = 1, UNPACKING = 2, FITTING = 4, FILLING = 8, REFUSED = 16 };

static uint32_t work_of(const struct lm_tile_cache *c)
{
    return (c->reading_slot != LM_SLOT_NONE ? READING : 0u) | (c->is_unpacking ? UNPACKING : 0u) |
           (c->is_fitting ? FITTING : 0u) | (c->is_filling ? FILLING : 0u) |
           (c->is_refused ? REFUSED : 0u);
}

/* The theatre goes after so many steps of reading a tile of it. Returns what was under way. */
static uint32_t take_theatre_away(struct fixture *f, struct lm_position at, uint32_t steps)
{
    struct lm_tile_cache *tiles = &f->both.tiles;
    lm_tile_cache_mount(tiles, f->both.images, 2);
    (void)lm_scan_cell(tiles, 0, at);
    for (uint32_t i = 0; i < steps; i++) {
        lm_tile_cache_service(tiles, 0, 1);
    }
    const uint32_t work = work_of(tiles);
    lm_tile_cache_mount(tiles, f->both.images + 1, 1);
    f->both.flash.port.size_bytes = f->parts[1].offset + f->parts[1].bytes;
    for (uint32_t i = 0; i < 2 && !lm_tile_cache_is_drained(tiles); i++) {
        lm_tile_cache_service(tiles, 0, 1);
    }
    assert_true(lm_tile_cache_is_drained(tiles) && lm_tile_cache_is_idle(tiles));
    assert_int_equal(work_of(tiles), 0);
    return work;
}

TEST(an_image_may_go_in_the_middle_of_whatever_is_done_with_its_tile)
{
    struct fixture *f = open_fixture_of(true, true);
    const struct lm_position at = place(100);
    const uint16_t wanted = cell_of(&f->world, 0, at);
    uint32_t seen = 0;
    for (uint32_t steps = 0; steps < 200; steps++) {
        if (steps == 1) { /* the medium goes first */
            f->both.flash.port.size_bytes = 0;
            seen |= take_theatre_away(f, at, steps);
        }
        seen |= take_theatre_away(f, at, steps);
        assert_int_equal(cell_of(&f->both, WORLD_LOD, at), wanted);
    }
    assert_int_equal(seen, READING | UNPACKING | FITTING | FILLING | REFUSED);
    close_fixture(f);
}

/* Images of one class each, all with the same cells. The first has no data in the east. */
enum { LAYERS_MOST = LM_IMAGES_MAX, LAYER_TILES = 2, LAYER_LODS = 3, ALL_LODS = 7 };

struct layer {
    double latitude_deg;
    uint8_t class_index;
    uint8_t left_out; /* a bit for each LOD */
    bool has_gap;
};

struct layers {
    struct map map;
    struct lm_flash_part parts[LAYERS_MOST];
    uint8_t *bytes;
};

static struct tiny_cell layer_cell(void *ctx, const struct tiny_place *p)
{
    const struct layer *l = ctx;
    return (struct tiny_cell){-20, l->has_gap && p->east_m > 0 ? TINY_NONE : l->class_index, 0};
}

static bool is_left_out(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    const struct layer *l = ctx;
    (void)row;
    (void)column;
    return (l->left_out >> level & 1) != 0;
}

static void open_layers(struct layers *f, struct layer *layer, uint32_t count)
{
    struct tiny_image images[LAYERS_MOST];
    size_t size;
    for (uint32_t i = 0; i < count; i++) {
        struct tiny_spec spec = tiny_spec_at(layer[i].latitude_deg, 11);
        spec.rows = spec.columns = LAYER_TILES;
        spec.level_count = LAYER_LODS;
        spec.cell = layer_cell;
        spec.leave_out = is_left_out;
        spec.ctx = &layer[i];
        assert_int_equal(tiny_image_build(&images[i], &spec), 0);
    }
    f->bytes = tiny_images_join(images, count, f->parts, &size);
    assert_non_null(f->bytes);
    struct map *m = &f->map;
    memory_flash_open(&m->flash, f->bytes, size);
    m->pool = malloc(SLOTS * sizeof(struct lm_tile));
    assert_non_null(m->pool);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(lm_db_open_part(&m->images[i], &m->flash.port, &f->parts[i], POLLS),
                         LM_OK);
        tiny_image_free(&images[i]);
    }
    m->db = m->images[0];
    lm_images_view(&m->db, m->images, count);
    assert_int_equal(lm_tile_cache_init_over(&m->tiles, &m->db, m->images, count, m->pool,
                                             SLOTS * sizeof(struct lm_tile), POLLS),
                     LM_OK);
}

static void close_layers(struct layers *f)
{
    free(f->map.pool);
    free(f->bytes);
}

/* The class at an LOD some way west or east of the middle of a layer; asked for until the LOD
 * itself has come. TINY_NONE where no image has data. */
static uint32_t class_at(struct layers *f, uint8_t lod, double latitude_deg, double east_m)
{
    const struct lm_position at = {hs_bam(latitude_deg + 0.0003), hs_bam(11 + east_m / 77500)};
    return cell_of(&f->map, lod, at) >> 4 & 15;
}

/* Classes at LOD 0 in the west and, where the first has no data, in the east. */
static void check_layers(struct layer *layer, uint32_t count, uint32_t west, uint32_t east)
{
    static struct layers f;
    open_layers(&f, layer, count);
    assert_int_equal(class_at(&f, 0, 46, -100), west);
    assert_int_equal(class_at(&f, 0, 46, 100), east);
    assert_int_equal(f.map.tiles.count.io_errors + f.map.tiles.count.corrupt, 0);
    close_layers(&f);
}

TEST(a_tile_that_one_image_leaves_out_is_that_of_the_next_one)
{
    struct layer some[] = {{46, TINY_TREES, 1, false}, {46, TINY_WATER, 0, false}};
    check_layers(some, 2, TINY_WATER, TINY_WATER);
    struct layer all[] = {
        {46, TINY_TREES, ALL_LODS, false}, {46, TINY_WATER, 1, false}, {46, TINY_SOIL, 0, false}};
    check_layers(all, 3, TINY_SOIL, TINY_SOIL);
    struct layer both[] = {{46, TINY_TREES, 1, false}, {46, TINY_WATER, 1, false}};
    check_layers(both, 2, TINY_TREES, TINY_TREES); /* the parent of the first */
}

TEST(a_gap_is_filled_by_the_first_image_behind_that_has_any_tile_there)
{
    struct layer elsewhere[] = {
        {46, TINY_TREES, 0, true}, {47, TINY_WATER, 0, false}, {46, TINY_SOIL, 0, false}};
    check_layers(elsewhere, 3, TINY_TREES, TINY_SOIL);
    struct layer coarser[] = {
        {46, TINY_TREES, 0, true}, {46, TINY_WATER, 3, false}, {46, TINY_SOIL, 0, false}};
    check_layers(coarser, 3, TINY_TREES, TINY_WATER);
    struct layer empty[] = {
        {46, TINY_TREES, 0, true}, {46, TINY_WATER, ALL_LODS, false}, {46, TINY_SOIL, 0, false}};
    check_layers(empty, 3, TINY_TREES, TINY_SOIL);
}

TEST(a_gap_that_no_image_behind_can_fill_stays_one)
{
    struct layer elsewhere[] = {{46, TINY_TREES, 0, true}, {47, TINY_WATER, 0, false}};
    check_layers(elsewhere, 2, TINY_TREES, TINY_NONE);
    struct layer empty[] = {{46, TINY_TREES, 0, true}, {46, TINY_WATER, ALL_LODS, false}};
    check_layers(empty, 2, TINY_TREES, TINY_NONE);
}

TEST(a_tile_that_cannot_be_read_is_that_of_the_next_image_with_cells_as_fine)
{
    static struct layers f;
    struct layer layer[] = {{46, TINY_TREES, 0, false}, {46, TINY_WATER, 0, false}};
    open_layers(&f, layer, 2);
    broken_from = (uintptr_t)f.bytes;
    broken_to = broken_from + f.parts[0].bytes;
    f.map.flash.fetch = fetch_unless_broken;
    assert_int_equal(class_at(&f, 0, 46, 100), TINY_WATER);
    assert_int_equal(f.map.tiles.count.io_errors, 1);
    close_layers(&f);
}

TEST(as_many_images_as_there_may_be_answer_each_at_its_place)
{
    static struct layers f;
    struct layer layer[LAYERS_MOST];
    for (uint32_t i = 0; i < LAYERS_MOST; i++) {
        layer[i] = (struct layer){40 + 2 * i, i % 2 ? TINY_TREES : TINY_SOIL, 0, false};
    }
    open_layers(&f, layer, LAYERS_MOST);
    for (uint32_t pass = 0; pass < 2; pass++) { /* at first all wait, each for its image's tile */
        for (uint32_t i = 0; i < LAYERS_MOST; i++) {
            const struct lm_position at = {hs_bam(40.0003 + 2 * i), hs_bam(11.001)};
            const uint16_t cell = lm_scan_cell(&f.map.tiles, 0, at);
            assert_int_equal(cell >> 4 & 15, layer[i].class_index);
        }
        assert_int_equal(lm_tile_cache_waiting(&f.map.tiles), pass == 0 ? LAYERS_MOST : 0);
        serve(&f.map);
    }
    assert_int_equal(f.map.tiles.count.misses, LAYERS_MOST);
    assert_int_equal(class_at(&f, 0, 39, 100), TINY_NONE);
    assert_int_equal(f.map.tiles.count.off_map, 2);
    close_layers(&f);
}

TEST(a_pool_without_room_for_filling_is_refused)
{
    struct fixture *f = open_fixture();
    struct map *m = &f->both;
    assert_int_equal(lm_tile_cache_init_over(&m->tiles, &m->db, m->images, 2, m->pool,
                                             sizeof(struct lm_tile) - 1, POLLS),
                     LM_ERR_NO_MEMORY);
    close_fixture(f);
}

TEST(images_of_other_classes_or_another_band_are_refused)
{
    struct fixture *f = open_fixture();
    struct lm_db *world = &f->world.db;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_OK);
    world->classes.entry[TINY_WATER].colour[0] ^= 1;
    world->classes.entry[TINY_WATER].gamma_db_q8 += 7;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_OK);
    world->classes.height_dm[9]++;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_TABLE);
    world->classes.height_dm[9]--;
    world->classes.entry[TINY_WATER].kind ^= 1;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_TABLE);
    world->classes.entry[TINY_WATER].kind ^= 1;
    world->classes.entry[TINY_WATER].name[0] ^= 1;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_TABLE);
    world->classes.entry[TINY_WATER].name[0] ^= 1;
    world->classes.entry[TINY_WATER].facing ^= 1;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_TABLE);
    world->classes.entry[TINY_WATER].facing ^= 1;
    world->classes.entry[TINY_WATER].flags ^= 1;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_TABLE);
    world->classes.entry[TINY_WATER].flags ^= 1;
    world->radar_bytes = 628;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_TABLE);
    f->theatre.db.radar_bytes = 628;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_OK);
    world->radar_crc ^= 1;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_TABLE);
    world->radar_crc ^= 1;
    f->theatre.db.radar_bytes = 0;
    world->radar_bytes = 0;
    world->sensor ^= 1;
    assert_int_equal(lm_images_judge(&f->theatre.db, world), LM_ERR_SENSOR);
    close_fixture(f);
}

TEST(a_picture_begins_with_the_finest_image_that_it_touches)
{
    struct fixture *f = open_fixture();
    const struct lm_position here = {hs_bam(46), hs_bam(11)};
    const struct lm_position there = {hs_bam(46.1), hs_bam(11)}; /* 11 km */
    struct map *b = &f->both;
    lm_images_look(&b->db, b->images, 2, here, 500);
    assert_int_equal(b->db.finest, 0);
    lm_images_look(&b->db, b->images, 2, there, 9000);
    assert_int_equal(b->db.finest, WORLD_LOD);
    lm_images_look(&b->db, b->images, 2, there, 12000);
    assert_int_equal(b->db.finest, 0);
    assert_int_equal(lm_images_at(b->images, 2, here), 0);
    assert_int_equal(lm_images_at(b->images, 2, there), 1);
    close_fixture(f);
}

/* Half of an extent in degrees, and those of the tiles of a finest level with shift 9. */
struct extent {
    double latitude_deg, longitude_deg, north_deg, east_deg;
};

/* True if both have a place in common when the first is so much larger on each side. */
static bool meet(const struct extent *a, const struct extent *b, double north_deg, double east_deg)
{
    const double apart_deg = fabs(remainder(a->longitude_deg - b->longitude_deg, 360));
    return fabs(a->latitude_deg - b->latitude_deg) < a->north_deg + b->north_deg + north_deg &&
           apart_deg < a->east_deg + b->east_deg + east_deg;
}

/* Bands and pictures anywhere, in every zone, across the antimeridian and Greenwich. Tiles decide:
 * where two of them more or less would, nothing is promised. */
TEST(an_image_is_touched_by_what_comes_near_its_tiles_anywhere)
{
    static struct lm_db images[2], view;
    uint32_t touched = 0, missed = 0;
    images[0].shift0 = THEATRE_SHIFT;
    images[0].band_count = 1;
    images[1].shift0 = WORLD_SHIFT;
    view.shift0 = THEATRE_SHIFT;
    for (int i = 0; i < 20000; i++) {
        const double latitude_deg = 160.0 * rand() / RAND_MAX - 80;
        const double turned_deg = i % 3 * 90 + 30.0 * rand() / RAND_MAX - 15;
        const uint32_t side_log2 = THEATRE_SHIFT + LM_TILE_CELLS_LOG2;
        const uint32_t row = (hs_bam(latitude_deg) + FX_BAM_90) >> side_log2;
        const uint8_t zone = (uint8_t)lm_db_zone(hs_bam(latitude_deg));
        const double tile_deg = 360 / 4294967296.0 * (1u << side_log2);
        const double east_tile_deg = tile_deg * (1u << zone);
        const uint32_t column = hs_bam(turned_deg) >> (side_log2 + zone);
        const struct lm_band band = {.lod = 0,
                                     .zone = zone,
                                     .row0 = row,
                                     .rows = (uint16_t)(1 + rand() % 9),
                                     .column0 = column,
                                     .columns = (uint16_t)(1 + rand() % 90)};
        images[0].bands[0] = band;
        const struct extent map = {row * tile_deg - 90 + band.rows * tile_deg / 2,
                                   (column + band.columns / 2.0) * east_tile_deg,
                                   band.rows * tile_deg / 2, band.columns * east_tile_deg / 2};
        const uint32_t reach_m = 100 + (uint32_t)rand() % 9000;
        const double north_deg = reach_m / 111320.0;
        const struct extent picture = {
            map.latitude_deg + 12 * tile_deg * (2.0 * rand() / RAND_MAX - 1),
            map.longitude_deg + 90 * east_tile_deg * (2.0 * rand() / RAND_MAX - 1), north_deg,
            north_deg / cos(latitude_deg * 0.017453)};
        const struct lm_position at = {hs_bam(picture.latitude_deg),
                                       hs_bam(remainder(picture.longitude_deg, 360))};
        view.finest = 77;
        lm_images_look(&view, images, 2, at, reach_m);
        if (meet(&map, &picture, -2 * tile_deg, -2 * east_tile_deg)) {
            assert_int_equal(view.finest, 0);
            touched++;
        } else if (!meet(&map, &picture, 2 * tile_deg, 2 * east_tile_deg)) {
            assert_int_equal(view.finest, WORLD_LOD);
            missed++;
        }
    }
    assert_true(touched > 5000 && missed > 2000);
}
