/* Compressed records: to the very bytes of the raw record, in the tile's own memory, or refused;
 * and the cache that reads them, beside one that reads raw ones. */
#include "lm/tile_unpack.h"

#include "check.h"
#include "fx/crc32c.h"
#include "hs/rng.h"
#include "lm/tile_cache.h"
#include "memory_flash.h"
#include "packed_tile.h"
#include "reference/reference.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 40, POLLS = 1000, SIDE = 8, GUARD = 64, PARTS_MAX = 109 + 22 };

static void seal(struct lm_tile *t)
{
    t->crc = fx_crc32c(0, &t->lod, LM_TILE_BYTES - sizeof t->crc);
}

/* Tiles from the flattest to the roughest that still compress. */
enum { KINDS = 5 };
static void make_tile(struct lm_tile *t, int kind, struct hs_rng *rng)
{
    *t = (struct lm_tile){.lod = 2, .row = 77, .column = 5, .base_m_q6 = -640, .under = 0x3450};
    for (int i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
        const int r = i / LM_TILE_POINTS, c = i % LM_TILE_POINTS;
        const uint32_t drawn = hs_rng_below(rng, 65536);
        t->points[r][c].cell =
            (uint16_t)(kind == 0 ? 0x4210 : drawn & (kind < 4 ? 0x1F31 : 0xFF00));
        t->points[r][c].post = (uint16_t)(kind == 0   ? 0
                                          : kind == 1 ? 30 * r + 7 * c
                                          : kind == 2 ? 20000 + 3000 * sin(r * 0.1) * cos(c * 0.2)
                                          : kind == 3 ? (r + c) % 2 * 65535
                                                      : r * c % 17);
    }
    seal(t);
}

/* Unpack a record of `size` units in memory whose surroundings must stay. Returns the status. */
static int unpack(const uint8_t *record, uint16_t size, struct lm_tile *out)
{
    static _Alignas(8) uint8_t memory[LM_TILE_BYTES + 2 * GUARD];
    struct lm_tile *tile = (struct lm_tile *)(void *)(memory + GUARD);
    struct lm_tile_unpack u;
    memset(memory, 0x5A, sizeof memory);
    memcpy(lm_tile_unpack_place(tile, size), record, (size_t)size * LM_DB_PLACE_BYTES);
    int status = lm_tile_unpack_begin(&u, tile, size), parts = 0;
    while (status == LM_BUSY) {
        status = lm_tile_unpack_run(&u);
        assert_true(++parts <= PARTS_MAX);
    }
    for (int i = 0; i < GUARD; i++) {
        assert_int_equal(memory[i], 0x5A);
        assert_int_equal(memory[GUARD + LM_TILE_BYTES + i], 0x5A);
    }
    *out = *tile;
    return status;
}

TEST(a_compressed_record_becomes_the_raw_one)
{
    struct lm_tile tile, out;
    uint8_t record[LM_TILE_BYTES];
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (int i = 0; i < 20 * KINDS; i++) {
        make_tile(&tile, i % KINDS, &rng);
        assert_int_equal(unpack(record, packed_tile(&tile, record), &out), LM_OK);
        assert_memory_equal(&out, &tile, sizeof tile);
    }
}

TEST(no_damage_to_a_record_gives_another_tile)
{
    struct lm_tile tile, out;
    uint8_t record[LM_TILE_BYTES];
    int refused = 0, caught = 0;
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < 20000; i++) {
        make_tile(&tile, i % KINDS, &rng);
        const uint16_t size = packed_tile(&tile, record);
        const uint32_t bytes = size * (uint32_t)LM_DB_PLACE_BYTES;
        for (uint32_t k = hs_rng_below(&rng, 3) + 1; k > 0; k--) {
            const uint32_t at = hs_rng_below(&rng, k % 2 ? 64 : bytes);
            record[at] ^= (uint8_t)(1u << hs_rng_below(&rng, 8));
        }
        const int status = unpack(record, size, &out);
        assert_true(status == LM_OK || status == LM_ERR_CORRUPT);
        const bool is_sound = status == LM_OK && lm_tile_check(&out, 2, 77, 5) == LM_OK;
        assert_true(!is_sound || memcmp(&out, &tile, sizeof tile) == 0);
        refused += status != LM_OK;
        caught += status == LM_OK && !is_sound;
    }
    assert_true(refused > 1000 && caught > 1000);
}

TEST(a_block_of_another_length_is_refused)
{
    struct lm_tile tile, out;
    uint8_t record[LM_TILE_BYTES];
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    make_tile(&tile, 2, &rng);
    const uint16_t size = packed_tile(&tile, record);
    uint16_t right;
    memcpy(&right, record + 24, sizeof right);
    for (uint32_t wrong = 0; wrong <= UINT16_MAX; wrong += wrong < right + 300u ? 1 : 97) {
        const uint16_t bytes = (uint16_t)wrong;
        memcpy(record + 24, &bytes, sizeof bytes);
        assert_int_equal(unpack(record, size, &out), wrong == right ? LM_OK : LM_ERR_CORRUPT);
    }
}

TEST(a_record_without_a_block_is_refused)
{
    uint8_t record[LM_TILE_BYTES] = {0};
    struct lm_tile out;
    for (uint16_t size = 1; size < LM_TILE_BYTES / LM_DB_PLACE_BYTES; size++) {
        assert_int_equal(unpack(record, size, &out), LM_ERR_CORRUPT);
    }
}

struct fixture {
    struct tiny_image image;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache cache;
    struct lm_tile pool[SLOTS];
};

static struct tiny_cell rough(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const int n = (int)(p->east_m / 5) * 31 + (int)(p->north_m / 5) * 17;
    return (struct tiny_cell){-20 + n % 7, n % 3 ? TINY_SOIL : TINY_TREES,
                              (uint8_t)(n % 3 ? 0 : 4)};
}

static double hilly(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 100 + 40 * sin(p->east_m / 300) * cos(p->north_m / 200);
}

static struct fixture *make_fixture(bool is_packed)
{
    struct fixture *f = calloc(1, sizeof *f);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    assert_non_null(f);
    spec.cell = rough;
    spec.elevation_m = hilly;
    spec.rows = spec.columns = SIDE;
    assert_int_equal(tiny_image_build(&f->image, &spec), 0);
    if (is_packed) {
        tiny_image_pack(&f->image);
    }
    memory_flash_open(&f->flash, f->image.bytes, f->image.size);
    assert_int_equal(lm_db_open(&f->db, &f->flash.port, POLLS), LM_OK);
    assert_int_equal(lm_tile_cache_init(&f->cache, &f->db, f->pool, sizeof f->pool, POLLS), LM_OK);
    return f;
}

static void free_fixture(struct fixture *f)
{
    tiny_image_free(&f->image);
    free(f);
}

/* Ask for a tile and wait for it. Returns what the cache then has; *calls of the service it took.
 */
static const struct lm_tile *fetch(struct fixture *f, uint32_t row, uint32_t column, int *calls)
{
    const struct lm_band *b = &f->db.bands[0];
    while (b->lod != 0) {
        b++;
    }
    (void)lm_tile_cache_get(&f->cache, 0, b->row0 + row, b->column0 + column);
    for (*calls = 0; *calls < 10000 && !lm_tile_cache_is_idle(&f->cache); ++*calls) {
        lm_tile_cache_service(&f->cache, 0, 1);
    }
    return lm_tile_cache_get(&f->cache, 0, b->row0 + row, b->column0 + column);
}

TEST(the_cache_has_the_same_tiles_of_either_image)
{
    struct fixture *raw = make_fixture(false), *packed = make_fixture(true);
    uint64_t before = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        int calls;
        const struct lm_tile *a = fetch(raw, i / SIDE, i % SIDE, &calls);
        const struct lm_tile *b = fetch(packed, i / SIDE, i % SIDE, &calls);
        assert_int_equal(b->lod, 0);
        assert_memory_equal(a, b, sizeof *a);
        /* Entry and record are each begun and polled; the rest are parts, which no step exceeds. */
        assert_in_range(calls, 4 + 22, 4 + PARTS_MAX);
        before = packed->cache.count.bytes_read;
    }
    assert_int_equal(packed->cache.count.corrupt, 0);
    assert_int_equal(packed->cache.count.tiles_read, raw->cache.count.tiles_read);
    assert_true(before * 3 < raw->cache.count.bytes_read * 2);
    free_fixture(raw);
    free_fixture(packed);
}

TEST(a_damaged_record_is_counted_and_its_parent_answers)
{
    struct fixture *f = make_fixture(true);
    const uint32_t offset = (uint32_t)f->image.tiles_offset;
    struct hs_rng rng;
    hs_rng_seed(&rng, 6);
    for (uint32_t i = 0; i < f->image.record_count; i++) {
        for (uint32_t k = 0; k < 40; k++) {
            f->image.bytes[offset + i * LM_TILE_BYTES + 32 + hs_rng_below(&rng, 900)] ^= 0x21;
        }
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        int calls;
        const uint32_t corrupt = f->cache.count.corrupt;
        assert_true(fetch(f, i / SIDE, i % SIDE, &calls)->lod > 0);
        assert_true(f->cache.count.corrupt > corrupt);
    }
    assert_int_equal(f->cache.count.io_errors, 0);
    free_fixture(f);
}

TEST(late_and_failing_reads_are_as_those_of_raw_records)
{
    struct fixture *f = make_fixture(true);
    int calls;
    f->flash.busy_polls = 300;
    assert_int_equal(fetch(f, 1, 1, &calls)->lod, 0);
    assert_true(calls > 600);
    f->flash.busy_polls = 0;
    f->flash.fail_read = f->flash.reads + 2;
    assert_true(fetch(f, 2, 2, &calls)->lod > 0);
    assert_int_equal(f->cache.count.io_errors, 1);
    assert_int_equal(f->cache.count.corrupt, 0);
    assert_int_equal(fetch(f, 3, 3, &calls)->lod, 0);
    free_fixture(f);
}

/* The reference unpacks with the library's decoder and code of its own. */
TEST(the_reference_reads_the_same_ground_of_either_image)
{
    struct fixture *raw = make_fixture(false), *packed = make_fixture(true);
    struct ref_db a, b;
    int with_data = 0;
    assert_int_equal(ref_db_open_memory(&a, raw->image.bytes, raw->image.size, "raw"), 0);
    assert_int_equal(ref_db_open_memory(&b, packed->image.bytes, packed->image.size, "packed"), 0);
    for (int i = 0; i < 4000; i++) {
        const struct ref_place place = {45.99 + i % 61 * 0.0003, 10.985 + i / 61 * 0.0005};
        struct ref_bin bin[2];
        double elevation_m[2];
        memset(bin, 0, sizeof bin);
        ref_db_cell(&a, 0, place, &bin[0]);
        ref_db_cell(&b, 0, place, &bin[1]);
        (void)ref_db_elevation(&a, 0, place, true, &elevation_m[0]);
        (void)ref_db_elevation(&b, 0, place, true, &elevation_m[1]);
        assert_memory_equal(&bin[0], &bin[1], sizeof bin[0]);
        assert_true(elevation_m[0] == elevation_m[1]);
        with_data += bin[0].has_data;
    }
    assert_true(with_data > 1000);
    ref_db_close(&a);
    ref_db_close(&b);
    free_fixture(raw);
    free_fixture(packed);
}
