/* The cache between flash and sweep: right tile, its ancestor, or nothing, and every fault counted.
 */
#include "lm/tile_cache.h"

#include "check.h"
#include "hs/angle.h"
#include "memory_flash.h"
#include "tiny_image.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS = 40, POLLS = 100, SIDE = 8 };

struct fixture {
    struct tiny_image image;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache cache;
    void *pool;
};

static struct tiny_cell soil(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

static int open_cache(struct fixture *f)
{
    f->pool = malloc(SLOTS * sizeof(struct lm_tile));
    assert_int_equal(lm_db_open(&f->db, &f->flash.port, POLLS), LM_OK);
    return lm_tile_cache_init(&f->cache, &f->db, f->pool, SLOTS * sizeof(struct lm_tile), POLLS);
}

static struct fixture *make_fixture_of(uint8_t rows, uint8_t columns)
{
    struct fixture *f = calloc(1, sizeof *f);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = soil;
    spec.rows = rows;
    spec.columns = columns;
    assert_int_equal(tiny_image_build(&f->image, &spec), 0);
    memory_flash_open(&f->flash, f->image.bytes, f->image.size);
    assert_int_equal(open_cache(f), LM_OK);
    return f;
}

static struct fixture *make_fixture(void)
{
    return make_fixture_of(SIDE, SIDE);
}

static void free_fixture(struct fixture *f)
{
    tiny_image_free(&f->image);
    free(f->pool);
    free(f);
}

static const struct lm_band *finest_band(const struct fixture *f)
{
    for (uint32_t i = 0; i < f->db.band_count; i++) {
        if (f->db.bands[i].lod == 0) {
            return &f->db.bands[i];
        }
    }
    return NULL;
}

static const struct lm_tile *get(struct fixture *f, uint32_t row, uint32_t column)
{
    const struct lm_band *b = finest_band(f);
    return lm_tile_cache_get(&f->cache, 0, b->row0 + row, b->column0 + column);
}

/* Whatever happens, a slot answers with its tile while that is resident, and else with none: what
 * is read into it would be taken for the tile that it held before. */
static void check_names(const struct lm_tile_cache *c)
{
    for (uint32_t i = 0; i <= LM_TILE_SLOTS_MAX; i++) {
        const struct lm_tile_slot *s = &c->slots[i];
        assert_true(s->resident == (s->state == LM_SLOT_RESIDENT ? lm_tile_name(s->row, s->column)
                                                                 : LM_TILE_NO_NAME));
    }
}

static void serve(struct fixture *f, uint64_t now_us)
{
    int rounds = 0;
    do {
        lm_tile_cache_service(&f->cache, now_us, 1);
        check_names(&f->cache);
    } while (++rounds < 10000 && !lm_tile_cache_is_idle(&f->cache));
}

TEST(the_coarsest_level_is_resident_from_the_start)
{
    struct fixture *f = make_fixture();
    const struct lm_tile *tile = get(f, 3, 3);
    assert_non_null(tile);
    assert_int_equal(tile->lod, f->db.lod_count - 1);
    assert_int_equal(f->cache.count.substituted, 1);
    free_fixture(f);
}

TEST(a_tile_that_was_asked_for_is_the_tile_itself_later)
{
    struct fixture *f = make_fixture();
    for (uint32_t i = 0; i < SIDE; i++) {
        get(f, i, SIDE - 1 - i);
        serve(f, 0);
        const struct lm_tile *tile = get(f, i, SIDE - 1 - i);
        assert_int_equal(tile->lod, 0);
        assert_int_equal(tile->row, finest_band(f)->row0 + i);
        assert_int_equal(tile->column, finest_band(f)->column0 + SIDE - 1 - i);
    }
    free_fixture(f);
}

TEST(a_lookup_never_waits_for_a_late_read)
{
    struct fixture *f = make_fixture();
    f->flash.busy_polls = 50;
    get(f, 0, 0);
    for (int i = 0; i < 30; i++) {
        lm_tile_cache_service(&f->cache, 0, 8);
        const struct lm_tile *tile = get(f, 0, 0);
        assert_non_null(tile);
        assert_true(tile->lod > 0 || i > 10);
    }
    serve(f, 0);
    assert_int_equal(get(f, 0, 0)->lod, 0);
    free_fixture(f);
}

TEST(every_read_that_fails_is_counted_and_answered_by_an_ancestor)
{
    for (uint32_t bad = 1; bad <= 2; bad++) { /* directory entry, record */
        struct fixture *f = make_fixture();
        f->flash.fail_read = f->flash.reads + bad;
        get(f, 2, 2);
        serve(f, 1);
        assert_int_equal(f->cache.count.io_errors, 1);
        const struct lm_tile *tile = get(f, 2, 2);
        assert_non_null(tile);
        assert_true(tile->lod > 0);
        /* Not tried again at once, but after a while, and then all is well. */
        serve(f, 2);
        assert_true(get(f, 2, 2)->lod > 0);
        serve(f, 2 + 2 * LM_TILE_RETRY_US);
        get(f, 2, 2);
        serve(f, 3 + 2 * LM_TILE_RETRY_US);
        assert_int_equal(get(f, 2, 2)->lod, 0);
        free_fixture(f);
    }
}

TEST(a_read_that_the_flash_refuses_is_a_failed_one)
{
    struct fixture *f = make_fixture();
    f->flash.port.size_bytes = 0; /* as that of a medium that was taken out */
    const uint32_t reads = f->flash.reads;
    get(f, 2, 2);
    serve(f, 1);
    assert_int_equal(f->flash.reads, reads);
    assert_int_equal(f->cache.count.io_errors, 1);
    assert_true(get(f, 2, 2)->lod > 0);
    f->flash.port.size_bytes = f->image.size;
    serve(f, 2);
    assert_true(get(f, 2, 2)->lod > 0);
    serve(f, 2 + LM_TILE_RETRY_US);
    get(f, 2, 2);
    serve(f, 3 + LM_TILE_RETRY_US);
    assert_int_equal(get(f, 2, 2)->lod, 0);
    assert_int_equal(f->cache.count.io_errors, 1);
    free_fixture(f);
}

TEST(any_flipped_bit_in_a_record_or_entry_is_caught)
{
    struct fixture *f = make_fixture();
    const struct lm_band *b = finest_band(f);
    const int64_t entry = lm_db_entry(&f->db, 0, b->row0 + 1, b->column0 + 1);
    assert_true(entry >= 0);
    enum { ENTRY_BITS = 8 * sizeof(struct lm_tile_entry), RECORD_BITS = 200 };
    uint32_t place;
    uint8_t *entry_bytes = f->image.bytes + lm_db_entry_offset(&f->db, (uint32_t)entry);
    memcpy(&place, entry_bytes, 4);
    uint8_t *record_bytes =
        f->image.bytes + f->image.tiles_offset + (size_t)place * LM_DB_PLACE_BYTES;
    uint32_t faults = 0;
    for (uint32_t i = 0; i < ENTRY_BITS + RECORD_BITS; i++) {
        const uint32_t bit = i < ENTRY_BITS ? i : (i - ENTRY_BITS) * 667u % (LM_TILE_BYTES * 8u);
        uint8_t *byte = (i < ENTRY_BITS ? entry_bytes : record_bytes) + bit / 8;
        *byte = (uint8_t)(*byte ^ 1u << bit % 8);
        free(f->pool);
        assert_int_equal(open_cache(f), LM_OK);
        get(f, 1, 1);
        serve(f, 0);
        const struct lm_tile *tile = get(f, 1, 1);
        faults += f->cache.count.corrupt;
        assert_int_equal(f->cache.count.corrupt, 1);
        assert_true(tile->lod > 0);
        *byte = (uint8_t)(*byte ^ 1u << bit % 8);
    }
    assert_int_equal(faults, ENTRY_BITS + RECORD_BITS);
    free_fixture(f);
}

/* Of the image that a test has changed: tile (1, 1), whose checksums are right. */
static void assert_read_is_refused(struct fixture *f)
{
    tiny_image_seal(&f->image);
    free(f->pool);
    assert_int_equal(open_cache(f), LM_OK);
    get(f, 1, 1);
    serve(f, 0);
    assert_int_equal(f->cache.count.corrupt, 1);
    assert_true(get(f, 1, 1)->lod > 0);
}

TEST(a_record_that_answers_for_another_tile_is_refused)
{
    struct fixture *f = make_fixture();
    const struct lm_band *b = finest_band(f);
    uint8_t *directory = f->image.bytes + f->image.directory_offset;
    const size_t bytes = sizeof(struct lm_tile_entry);
    const size_t one = bytes * (size_t)lm_db_entry(&f->db, 0, b->row0 + 1, b->column0 + 1);
    const size_t two = bytes * (size_t)lm_db_entry(&f->db, 0, b->row0 + 4, b->column0 + 1);
    memcpy(directory + one, directory + two, 4); /* with its checksum put right */
    assert_read_is_refused(f);
    free_fixture(f);
}

TEST(a_record_of_an_unknown_encoding_is_refused_and_counted)
{
    struct fixture *f = make_fixture();
    const struct lm_band *b = finest_band(f);
    const int64_t entry = lm_db_entry(&f->db, 0, b->row0 + 1, b->column0 + 1);
    f->image.bytes[lm_db_entry_offset(&f->db, (uint32_t)entry) + 6] = 3;
    assert_read_is_refused(f);
    assert_int_equal(f->cache.count.encodings, 1);
    free_fixture(f);
}

static bool leave_out_middle(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    const uint32_t *hole = ctx;
    return level == 0 && row == hole[0] && column == hole[1];
}

TEST(a_tile_the_image_leaves_out_is_no_fault)
{
    struct fixture *f = make_fixture();
    uint32_t hole[2] = {finest_band(f)->row0 + 2, finest_band(f)->column0 + 5};
    free_fixture(f);
    f = calloc(1, sizeof *f);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = soil;
    spec.rows = spec.columns = SIDE;
    spec.leave_out = leave_out_middle;
    spec.ctx = hole;
    assert_int_equal(tiny_image_build(&f->image, &spec), 0);
    memory_flash_open(&f->flash, f->image.bytes, f->image.size);
    assert_int_equal(open_cache(f), LM_OK);
    get(f, 2, 5);
    serve(f, 0);
    const uint32_t misses = f->cache.count.misses, reads = f->flash.reads;
    for (int i = 0; i < 5; i++) {
        get(f, 2, 5);
        serve(f, 0);
    }
    assert_int_equal(get(f, 2, 5)->lod, 1); /* its parent, which was asked for in its place */
    assert_int_equal(f->cache.count.misses, misses);
    assert_int_equal(f->flash.reads, reads);
    assert_int_equal(f->cache.count.corrupt, 0);
    free_fixture(f);
}

TEST(the_tile_used_longest_ago_leaves_first)
{
    struct fixture *f = make_fixture();
    for (uint32_t i = 0; i < SIDE * SIDE; i++) { /* more tiles than slots */
        get(f, 0, 0);                            /* but this one is always wanted */
        get(f, i / SIDE, i % SIDE);
        serve(f, 0);
    }
    assert_true(f->cache.count.evicted > 0);
    assert_int_equal(get(f, 0, 0)->lod, 0);
    assert_int_equal(get(f, SIDE - 1, SIDE - 1)->lod, 0);
    assert_true(get(f, 0, 1)->lod > 0);
    free_fixture(f);
}

TEST(a_look_finds_what_a_get_would_answer_or_nothing)
{
    struct fixture *f = make_fixture();
    const struct lm_band *b = finest_band(f);
    uint32_t found = 0, late = 0;
    for (uint32_t i = 0; i < 40 * SIDE; i++) {
        const uint32_t n = i / 3; /* asked for, come, found */
        const uint32_t row = b->row0 + n * 5 % SIDE, column = b->column0 + n * 4 % (SIDE + 1);
        const uint32_t hits = lm_tile_cache_hits(&f->cache);
        const struct lm_tile_slot *slot = lm_tile_cache_peek(&f->cache, 0, row, column);
        assert_int_equal(lm_tile_cache_hits(&f->cache), hits + (slot != NULL));
        assert_true(!slot || slot->last_use == f->cache.clock);
        const struct lm_tile *tile = lm_tile_cache_get(&f->cache, 0, row, column);
        if (slot) {
            found++;
            const struct lm_tile_base base = lm_tile_base_of(f->pool, tile);
            assert_int_equal(tile->lod, 0);
            assert_ptr_equal(f->cache.slots + (tile - (const struct lm_tile *)f->pool), slot);
            assert_memory_equal(&slot->base, &base, sizeof base);
        }
        late += !slot && tile && tile->lod == 0;
        serve(f, 0);
    }
    assert_null(lm_tile_cache_peek(&f->cache, 0, 0, 0)); /* at the pole */
    print_message("# %u found, %u not the first of their chain\n", found, late);
    assert_true(found > 10 * SIDE && late == 0 && f->cache.count.evicted > 0);
    free_fixture(f);
}

TEST(tiles_of_a_neighbourhood_have_a_chain_each)
{
    for (int32_t row = -33; row <= 33; row++) {
        for (int32_t column = -33; column <= 33; column++) {
            const bool is_near = row * row + column * column < 34 * 34;
            const bool is_other = row != 0 || column != 0;
            assert_false(is_near && is_other &&
                         lm_tile_chain(1000u + (uint32_t)row, 70000u + (uint32_t)column) ==
                             lm_tile_chain(1000, 70000));
        }
    }
}

static bool is_resident(const struct fixture *f, uint32_t row, uint32_t column)
{
    const struct lm_band *b = finest_band(f);
    return lm_tile_cache_find(&f->cache, 0, b->row0 + row, b->column0 + column) != NULL;
}

TEST(of_two_tiles_in_one_chain_the_older_leaves_and_the_newer_stays)
{
    enum { ROW = 15, COLUMN = 31 }; /* how far the second is from the first */
    struct fixture *f = make_fixture_of(ROW + 1, COLUMN + 1);
    const struct lm_band *b = finest_band(f);
    assert_int_equal(lm_tile_chain(b->row0, b->column0),
                     lm_tile_chain(b->row0 + ROW, b->column0 + COLUMN));
    get(f, 0, 0);
    serve(f, 0);
    for (uint32_t i = 1; is_resident(f, 0, 0); i++) {
        assert_true(i < COLUMN * ROW);
        get(f, ROW, COLUMN);
        get(f, i / COLUMN, i % COLUMN);
        serve(f, 0);
        assert_true(is_resident(f, ROW, COLUMN));
    }
    for (uint32_t i = 0; i < 2; i++) { /* and the first may come back */
        get(f, 0, 0);
        serve(f, 0);
        assert_true(is_resident(f, 0, 0) && is_resident(f, ROW, COLUMN));
    }
    free_fixture(f);
}

TEST(off_the_map_there_is_nothing)
{
    struct fixture *f = make_fixture();
    assert_null(lm_tile_cache_get(&f->cache, 0, 5, 5));
    assert_int_equal(f->cache.count.off_map, 1);
    assert_true(lm_tile_cache_is_idle(&f->cache));
    free_fixture(f);
}

TEST(a_pool_of_a_few_tiles_is_refused)
{
    struct fixture *f = make_fixture();
    struct lm_tile_cache *cache = calloc(1, sizeof *cache);
    assert_int_equal(lm_tile_cache_init(cache, &f->db, f->pool, 16 * sizeof(struct lm_tile), POLLS),
                     LM_ERR_NO_MEMORY);
    free(cache);
    free_fixture(f);
}

TEST(of_a_large_pool_as_many_tiles_are_used_as_there_are_slots)
{
    struct fixture *f = make_fixture();
    const size_t bytes = (LM_TILE_SLOTS_MAX + 3) * sizeof(struct lm_tile);
    free(f->pool);
    f->pool = malloc(bytes);
    assert_non_null(f->pool);
    assert_int_equal(lm_tile_cache_init(&f->cache, &f->db, f->pool, bytes, POLLS), LM_OK);
    assert_int_equal(f->cache.slot_count, LM_TILE_SLOTS_MAX);
    for (uint32_t i = 0; i < SIDE; i++) {
        get(f, i, i);
        serve(f, 0);
        assert_int_equal(get(f, i, i)->lod, 0);
    }
    free_fixture(f);
}

/* A map of so many rows of tiles about a place, of one LOD. */
static struct fixture *make_rows_at(uint8_t rows, double latitude_deg, double longitude_deg)
{
    struct fixture *f = calloc(1, sizeof *f);
    struct tiny_spec spec = tiny_spec_at(latitude_deg, longitude_deg);
    spec.cell = soil;
    spec.rows = rows;
    spec.columns = SIDE;
    spec.level_count = 1;
    assert_int_equal(tiny_image_build(&f->image, &spec), 0);
    memory_flash_open(&f->flash, f->image.bytes, f->image.size);
    assert_int_equal(open_cache(f), LM_OK);
    return f;
}

/* 64 tiles: more than half of the pool. */
static struct fixture *make_wide_fixture(double latitude_deg, double longitude_deg)
{
    return make_rows_at(SIDE, latitude_deg, longitude_deg);
}

/* Is the tile resident that holds the place so many tiles of shift 9 north and east of another, as
 * wide as they are there? */
static bool has_beside(const struct fixture *f, struct lm_position from, int north, int east)
{
    const fx_bam_t latitude = from.latitude + ((uint32_t)north << 15);
    const uint32_t across = 15 + lm_db_zone(latitude);
    const fx_bam_t longitude = from.longitude + ((uint32_t)east << across);
    return lm_tile_cache_find(&f->cache, 0, (latitude + FX_BAM_90) >> 15, longitude >> across) !=
           NULL;
}

TEST(of_a_top_that_is_too_large_the_nine_tiles_around_the_aircraft_are_kept)
{
    static const double places[][2] = {{46, 11},     {46, 180},      {46, -180},
                                       {46, 0},      {0, 179.99999}, {61.875, 179.9999},
                                       {-73.125, 0}, {84.375, 180}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        struct fixture *f = make_wide_fixture(places[i][0], places[i][1]);
        const struct lm_position here = {hs_bam(places[i][0]), hs_bam(places[i][1])};
        assert_false(f->cache.is_top_resident);
        assert_int_equal(f->cache.count.tiles_read, 0);
        lm_tile_cache_keep_around(&f->cache, here);
        serve(f, 0);
        assert_int_equal(f->cache.count.tiles_read, 9);
        for (int n = 0; n < 9; n++) {
            assert_true(has_beside(f, here, n / 3 - 1, n % 3 - 1));
        }
        assert_false(has_beside(f, here, 2, 0));
        assert_false(has_beside(f, here, 0, -2));
        free_fixture(f);
    }
}

/* Columns are counted from Greenwich: in each zone a map across it has the last and the first. */
TEST(the_coarsest_level_is_resident_whole_across_greenwich)
{
    static const double latitudes_deg[] = {0, 46, 62, -74, 80, 85};
    for (size_t i = 0; i < sizeof latitudes_deg / sizeof latitudes_deg[0]; i++) {
        struct fixture *f = make_rows_at(2, latitudes_deg[i], 0);
        uint32_t tiles = 0, wrapped = 0;
        assert_true(f->cache.is_top_resident);
        for (uint32_t b = 0; b < f->db.band_count; b++) {
            const struct lm_band *band = &f->db.bands[b];
            const uint32_t columns = 1u << (32 - 15 - band->zone); /* round the Earth, of shift 9 */
            for (uint32_t t = 0; t < band->rows * band->columns; t++, tiles++) {
                const uint32_t row = band->row0 + t / band->columns;
                const uint32_t column = band->column0 + t % band->columns;
                wrapped += column >= columns;
                assert_non_null(lm_tile_cache_find(&f->cache, 0, row, column % columns));
            }
        }
        assert_int_equal(f->cache.count.tiles_read, tiles);
        assert_true(wrapped > 0 && wrapped < tiles);
        free_fixture(f);
    }
}

TEST(what_is_kept_around_the_aircraft_outlasts_what_is_looked_up_elsewhere)
{
    struct fixture *f = make_wide_fixture(46, 11);
    const struct lm_position here = {hs_bam(46), hs_bam(11)};
    for (uint32_t i = 0; i < 4 * SIDE * SIDE; i++) {
        lm_tile_cache_keep_around(&f->cache, here);
        get(f, i / SIDE % SIDE, i % SIDE);
        serve(f, 0);
        for (int n = 0; n < 9; n++) {
            assert_true(has_beside(f, here, n / 3 - 1, n % 3 - 1));
        }
    }
    assert_true(f->cache.count.evicted > 4 * SIDE);
    free_fixture(f);
}

TEST(round_a_pole_there_are_fewer_tiles_to_keep)
{
    struct fixture *f = make_wide_fixture(89.99999, 11);
    lm_tile_cache_keep_around(&f->cache, (struct lm_position){FX_BAM_90, hs_bam(11)});
    lm_tile_cache_keep_around(&f->cache, (struct lm_position){0u - FX_BAM_90, hs_bam(11)});
    serve(f, 0);
    assert_true(f->cache.count.tiles_read <= 6);
    assert_int_equal(f->cache.count.io_errors + f->cache.count.corrupt, 0);
    free_fixture(f);
}

TEST(a_top_that_is_resident_whole_needs_no_keeping)
{
    struct fixture *f = make_fixture();
    const uint32_t clock = f->cache.clock;
    lm_tile_cache_keep_around(&f->cache, (struct lm_position){hs_bam(46), hs_bam(11)});
    assert_true(f->cache.is_top_resident && lm_tile_cache_is_idle(&f->cache));
    assert_int_equal(f->cache.clock, clock);
    free_fixture(f);
}

TEST(a_full_queue_drops_requests_and_counts_them)
{
    struct fixture *f = make_fixture();
    const struct lm_band *b = finest_band(f);
    for (uint32_t i = 0; i < 10 * LM_TILE_REQUESTS; i++) {
        lm_tile_cache_want(&f->cache, 0, b->row0 + i / SIDE % SIDE, b->column0 + i % SIDE);
    }
    assert_true(f->cache.count.requests_dropped > 0);
    serve(f, 0);
    get(f, 7, 7);
    serve(f, 0);
    assert_int_equal(get(f, 7, 7)->lod, 0);
    free_fixture(f);
}

TEST(a_flash_request_is_read_between_two_tiles_and_one_at_a_time)
{
    struct fixture *f = make_fixture();
    uint8_t header[512];
    struct lm_flash_request request = {.destination = header, .length = sizeof header},
                            second = request;
    for (uint32_t i = 0; i < SIDE; i++) {
        get(f, i, i);
    }
    lm_tile_cache_service(&f->cache, 0, 1); /* a tile is being read */
    assert_true(lm_tile_cache_read(&f->cache, &request));
    assert_false(lm_tile_cache_read(&f->cache, &second));
    assert_false(lm_tile_cache_is_idle(&f->cache));
    int polls = 0;
    for (; request.status == LM_BUSY && polls < 100; polls++) {
        lm_tile_cache_service(&f->cache, 0, 1);
    }
    assert_true(polls < 8); /* before the other tiles */
    assert_int_equal(request.status, LM_OK);
    assert_memory_equal(header, f->image.bytes, sizeof header);
    serve(f, 0);
    assert_true(lm_tile_cache_is_idle(&f->cache) && lm_tile_cache_is_drained(&f->cache));
    assert_true(lm_tile_cache_read(&f->cache, &second));
    assert_false(lm_tile_cache_is_idle(&f->cache) || lm_tile_cache_is_drained(&f->cache));
    f->flash.fail_read = f->flash.reads + 1;
    serve(f, 0);
    assert_int_equal(second.status, LM_ERR_IO);
    assert_int_equal(f->cache.count.io_errors, 1);
    for (uint32_t i = 0; i < SIDE; i++) {
        assert_int_equal(get(f, i, i)->lod, 0);
    }
    struct lm_flash_request beyond = {
        .offset = f->image.size, .destination = header, .length = sizeof header};
    assert_true(lm_tile_cache_read(&f->cache, &beyond));
    serve(f, 0);
    assert_int_equal(beyond.status, LM_ERR_IO);
    free_fixture(f);
}
