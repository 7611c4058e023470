/* Detail: what a record must be, and how the records of a box are read between the tiles. */
#include "lm/detail_reader.h"

#include "check.h"
#include "fx/crc32c.h"
#include "lm/image.h"
#include "memory_flash.h"
#include "tiny_image.h"

#include <stdlib.h>
#include <string.h>

enum { ROW = 5, COLUMN = 7, LOD = 2, UNITS = 2, SLOTS = 40, POLLS = 100, SIDE = 3 };

static void seal(struct lm_detail *d, uint32_t bytes)
{
    d->crc = fx_crc32c(0, (const uint8_t *)d + 4, bytes - 4);
}

/* A building, a wire and a road. */
static struct lm_detail *make_record(uint8_t lod, uint32_t row, uint32_t column)
{
    struct lm_detail *d = calloc(1, sizeof *d);
    assert_non_null(d);
    d->lod = lod;
    d->row = row;
    d->column = column;
    d->count = 3;
    d->items[0] = (struct lm_detail_item){
        .kind = LM_DETAIL_BLOCK, .class_number = 3, .length_dm = 200, .width_dm = 100};
    d->items[1] = (struct lm_detail_item){
        .kind = LM_DETAIL_LINE, .gamma_code = 9, .glint_code = 9, .length_dm = 600, .width_dm = 1};
    d->items[2] = (struct lm_detail_item){.kind = LM_DETAIL_SURFACE,
                                          .class_number = 1,
                                          .glint_code = 1,
                                          .length_dm = 1,
                                          .width_dm = 45,
                                          .height_dm = 0x7FFF};
    seal(d, UNITS * LM_DETAIL_UNIT_BYTES);
    return d;
}

static int check_of(const struct lm_detail *d, uint32_t bytes)
{
    return lm_detail_check(d, bytes, LOD, ROW, COLUMN);
}

static void spoil(struct lm_detail *d, int what)
{
    struct lm_detail_item *block = &d->items[0], *line = &d->items[1], *surface = &d->items[2];
    block->kind = what == 1 ? 0 : what == 2 ? LM_DETAIL_KINDS : block->kind;
    block->class_number = what == 3 ? LM_DB_CLASS_NONE : block->class_number;
    block->length_dm = what == 4 ? 0 : block->length_dm;
    block->width_dm = what == 5 ? 0 : block->width_dm;
    line->glint_code = what == 6 ? 8 : line->glint_code;
    surface->glint_code = what == 7 ? 2 : surface->glint_code;
    surface->height_dm = what == 8 ? 0x8000 : surface->height_dm;
    d->lod = what == 9 ? LOD + 1 : d->lod;
    d->row = what == 10 ? ROW + 1 : d->row;
    d->column = what == 11 ? COLUMN + 1 : d->column;
    d->count = what == 12 ? 7 : d->count; /* more than two units hold */
}

TEST(a_record_with_a_number_that_cannot_be_is_refused)
{
    const uint32_t bytes = UNITS * LM_DETAIL_UNIT_BYTES;
    for (int what = 0; what <= 12; what++) {
        struct lm_detail *d = make_record(LOD, ROW, COLUMN);
        spoil(d, what);
        seal(d, bytes);
        assert_int_equal(check_of(d, bytes), what == 0 ? LM_OK : LM_ERR_CORRUPT);
        d->crc ^= 1;
        assert_int_equal(check_of(d, bytes), LM_ERR_CORRUPT);
        free(d);
    }
}

TEST(a_record_is_whole_units_long_and_no_longer_than_the_longest)
{
    struct lm_detail *d = make_record(LOD, ROW, COLUMN);
    d = realloc(d, sizeof *d + LM_DETAIL_UNIT_BYTES);
    assert_non_null(d);
    memset(d + 1, 0, LM_DETAIL_UNIT_BYTES);
    for (uint32_t bytes = 0; bytes <= LM_DETAIL_BYTES_MAX + LM_DETAIL_UNIT_BYTES; bytes += 16) {
        const bool is_sound = bytes % LM_DETAIL_UNIT_BYTES == 0 && bytes > LM_DETAIL_UNIT_BYTES &&
                              bytes <= LM_DETAIL_BYTES_MAX; /* one unit holds two items */
        if (bytes >= 4) {
            seal(d, bytes);
        }
        assert_int_equal(check_of(d, bytes), is_sound ? LM_OK : LM_ERR_CORRUPT);
    }
    free(d);
}

/* A map of nine tiles, the middle one of which has detail. */
struct fixture {
    struct tiny_image image;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_detail_reader reader;
    uint32_t row, column; /* of the tile with detail */
    void *pool;
};

static struct tiny_cell soil(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

/* The middle tile's entry leads to the first record of DETAIL. */
static void point_to_detail(struct fixture *f)
{
    struct lm_tile_entry entry;
    const uint32_t number = (uint32_t)lm_db_entry(&f->db, 0, f->row, f->column);
    uint8_t *at = f->image.bytes + lm_db_entry_offset(&f->db, number);
    memcpy(&entry, at, sizeof entry);
    entry.detail_place = 0;
    entry.detail_size = UNITS;
    memcpy(at, &entry, sizeof entry);
    tiny_image_seal(&f->image);
}

static void open_image(struct fixture *f)
{
    memory_flash_open(&f->flash, f->image.bytes, f->image.size);
    assert_int_equal(lm_db_open(&f->db, &f->flash.port, POLLS), LM_OK);
}

static struct fixture *make_fixture(void)
{
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.rows = spec.columns = SIDE;
    spec.cell = soil;
    assert_int_equal(tiny_image_build(&f->image, &spec), 0);
    open_image(f);
    f->row = f->db.bands[0].row0 + 1;
    f->column = f->db.bands[0].column0 + 1;
    struct lm_detail *d = make_record(0, f->row, f->column);
    assert_int_equal(
        tiny_image_add_section(&f->image, LM_IMAGE_DETAIL, d, UNITS * LM_DETAIL_UNIT_BYTES), 0);
    free(d);
    open_image(f);
    point_to_detail(f);
    open_image(f);
    f->pool = malloc(SLOTS * sizeof(struct lm_tile));
    assert_int_equal(
        lm_tile_cache_init(&f->tiles, &f->db, f->pool, SLOTS * sizeof(struct lm_tile), POLLS),
        LM_OK);
    return f;
}

static void free_fixture(struct fixture *f)
{
    tiny_image_free(&f->image);
    free(f->pool);
    free(f);
}

static void read_tiles(struct fixture *f)
{
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        lm_tile_cache_want(&f->tiles, 0, f->row - 1 + i / SIDE, f->column - 1 + i % SIDE);
    }
    for (int i = 0; i < 1000 && !lm_tile_cache_is_idle(&f->tiles); i++) {
        lm_tile_cache_service(&f->tiles, 0, 1);
    }
}

/* Start to read a box of so many tiles, the middle one in its north-east corner, less `beyond`. */
static void start(struct fixture *f, uint32_t rows, uint32_t columns, uint32_t beyond)
{
    const struct lm_detail_ground ground = lm_detail_ground_of(&f->db, f->row, f->column);
    const struct lm_detail_box box = {
        .south = ground.corner.latitude - ((rows - 1) << ground.north_log2),
        .north = ground.corner.latitude,
        .west = ground.corner.longitude - ((columns - 1) << ground.east_log2),
        .east = ground.corner.longitude - (beyond << ground.east_log2)};
    lm_detail_reader_start(&f->reader, &f->db, &box);
}

/* Records that arrive until the box has been read. */
static uint32_t read_box(struct fixture *f)
{
    uint32_t arrived = 0;
    for (int i = 0; i < 1000; i++) {
        const enum lm_detail_step step = lm_detail_reader_step(&f->reader, &f->tiles);
        if (step == LM_DETAIL_ENDED) {
            return arrived;
        }
        if (step == LM_DETAIL_ARRIVED) {
            assert_int_equal(f->reader.row, f->row);
            assert_int_equal(f->reader.column, f->column);
            assert_int_equal(f->reader.record.count, 3);
            arrived++;
        }
        lm_tile_cache_service(&f->tiles, 0, 1);
    }
    fail_msg("the box has no end");
    return 0;
}

TEST(the_record_of_a_resident_tile_in_the_box_arrives_once)
{
    struct fixture *f = make_fixture();
    read_tiles(f);
    start(f, 2, 2, 0);
    assert_int_equal(read_box(f), 1);
    assert_int_equal(f->tiles.count.corrupt + f->tiles.count.io_errors, 0);
    start(f, 1, 2, 1); /* the tile beside it has none */
    assert_int_equal(read_box(f), 0);
    free_fixture(f);
}

TEST(a_tile_that_is_not_resident_is_passed_over)
{
    struct fixture *f = make_fixture();
    start(f, 2, 2, 0);
    lm_tile_cache_mount(&f->tiles, &f->db, 1);
    assert_int_equal(read_box(f), 0);
    free_fixture(f);
}

TEST(no_more_tiles_are_looked_at_than_may_be)
{
    struct fixture *f = make_fixture();
    read_tiles(f);
    start(f, 4, LM_DETAIL_TILES_MAX / 4, 0);
    assert_int_equal(read_box(f), 1); /* the last one that may be */
    start(f, 1, LM_DETAIL_TILES_MAX + 1, 0);
    assert_int_equal(read_box(f), 0);
    free_fixture(f);
}

TEST(of_an_image_without_detail_no_tile_is_looked_at)
{
    struct fixture *f = make_fixture();
    read_tiles(f);
    f->db.detail_size = 0;
    start(f, 1, 1, 0);
    assert_int_equal(f->reader.tiles_left, 0);
    assert_int_equal(read_box(f), 0);
    free_fixture(f);
}

TEST(a_record_waits_while_another_part_reads_the_flash)
{
    struct fixture *f = make_fixture();
    uint8_t header[64];
    struct lm_flash_request other = {.destination = header, .length = sizeof header};
    read_tiles(f);
    start(f, 1, 1, 0);
    assert_true(lm_tile_cache_read(&f->tiles, &other));
    assert_int_equal(lm_detail_reader_step(&f->reader, &f->tiles), LM_DETAIL_AWAITED);
    assert_int_equal(f->reader.state, LM_DETAIL_LOOKING);
    assert_int_equal(read_box(f), 1);
    assert_int_equal(other.status, LM_OK);
    free_fixture(f);
}

TEST(a_record_that_is_damaged_or_cannot_be_read_is_counted_and_passed_over)
{
    for (int is_damaged = 0; is_damaged < 2; is_damaged++) {
        struct fixture *f = make_fixture();
        read_tiles(f);
        if (is_damaged) {
            f->image.bytes[f->db.detail_offset + 50] ^= 4;
        } else {
            f->flash.fail_read = f->flash.reads + 1;
        }
        start(f, 1, 1, 0);
        assert_int_equal(read_box(f), 0);
        assert_int_equal(f->tiles.count.corrupt, is_damaged);
        assert_int_equal(f->tiles.count.io_errors, !is_damaged);
        free_fixture(f);
    }
}
