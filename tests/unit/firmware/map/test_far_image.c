/* An image of more than 4 GiB, in a sparse file: directory and tiles lie beyond 2^32 bytes, and
 * tiles beyond 2^32 bytes of their section. */
#include "lm/tile_cache.h"

#include "check.h"
#include "drv/flash_file.h"
#include "fx/crc32c.h"
#include "lm/image.h"
#include "support.h"
#include "tiny_image.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { POLLS = 100, SLOTS = 32, SIDE = 3, IMAGE_GIB = 26 };

static const uint64_t gib = (uint64_t)1 << 30;

static struct tiny_cell soil(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

static struct lm_image_section *section_of(struct lm_image_header *h, uint32_t type)
{
    uint32_t i = 0;
    while (h->sections[i].type != type) {
        i++;
    }
    return &h->sections[i];
}

static void write_at(int file, uint64_t offset, const void *bytes, size_t count)
{
    assert_int_equal(pwrite(file, bytes, count, (off_t)offset), (ssize_t)count);
}

/* Put every record of `tiny` 5 GiB and more into TILES, at the end of its section the last. */
static void write_far(int file, const struct tiny_image *tiny)
{
    struct lm_image_header h;
    memcpy(&h, tiny->bytes, sizeof h);
    struct lm_image_section *directory = section_of(&h, LM_IMAGE_DIRECTORY);
    struct lm_image_section *tiles = section_of(&h, LM_IMAGE_TILES);
    directory->offset = 5 * gib;
    tiles->offset = 6 * gib;
    tiles->bytes = 20 * gib;
    h.image_bytes = IMAGE_GIB * gib;
    h.crc = fx_crc32c(0, &h, sizeof h - sizeof h.crc);
    write_at(file, 0, tiny->bytes, tiny->directory_offset);
    write_at(file, 0, &h, sizeof h);
    for (uint32_t i = 0; i < tiny->entry_count; i++) {
        struct lm_tile_entry e;
        memcpy(&e, tiny->bytes + tiny->directory_offset + i * sizeof e, sizeof e);
        const uint8_t *record = tiny->bytes + tiny->tiles_offset + 64 * (uint64_t)e.place;
        const uint64_t at = i + 1 == tiny->entry_count ? 20 * gib - LM_TILE_BYTES : (5 + i) * gib;
        e.place = (uint32_t)(at / LM_DB_PLACE_BYTES);
        e.crc = fx_crc32c(fx_crc32c(0, &i, sizeof i), &e, offsetof(struct lm_tile_entry, crc));
        write_at(file, directory->offset + i * sizeof e, &e, sizeof e);
        write_at(file, tiles->offset + at, record, LM_TILE_BYTES);
    }
    assert_int_equal(ftruncate(file, (off_t)h.image_bytes), 0);
}

static bool may_write(uint64_t bytes)
{
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    return limit.rlim_cur >= bytes;
}

TEST(an_image_of_26_GiB_is_read_to_its_last_record)
{
    static struct lm_db db;
    static struct lm_tile_cache cache;
    static struct lm_tile pool[SLOTS];
    char path[512];
    if (!may_write(IMAGE_GIB * gib)) {
        print_message("# skipped: files may not become so large here (ulimit -f)\n");
        skip();
    }
    snprintf(path, sizeof path, "%s/tmp/test_far_image.lmdb", support_build_dir());
    assert_int_equal(support_run("mkdir -p %s/tmp", support_build_dir()), 0);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image tiny;
    spec.cell = soil;
    spec.rows = spec.columns = SIDE;
    assert_int_equal(tiny_image_build(&tiny, &spec), 0);
    const int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    assert_true(file >= 0);
    write_far(file, &tiny);
    close(file);

    struct drv_flash_file flash;
    assert_int_equal(drv_flash_file_open(&flash, path), 0);
    assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_OK);
    assert_int_equal(lm_tile_cache_init(&cache, &db, pool, sizeof pool, POLLS), LM_OK);
    uint32_t wanted = 0;
    for (uint32_t b = 0; b < db.band_count; b++) {
        const struct lm_band *band = &db.bands[b];
        for (uint32_t i = 0; i < band->rows * band->columns; i++, wanted++) {
            const uint32_t row = band->row0 + i / band->columns;
            const uint32_t column = band->column0 + i % band->columns;
            lm_tile_cache_want(&cache, band->lod, row, column);
            lm_tile_cache_service(&cache, 0, POLLS);
            assert_non_null(lm_tile_cache_find(&cache, band->lod, row, column));
        }
    }
    assert_int_equal(wanted, tiny.entry_count);
    assert_int_equal(cache.count.corrupt + cache.count.io_errors, 0);
    drv_flash_file_close(&flash);
    tiny_image_free(&tiny);
    unlink(path);
}
