/* Tile records stored compressed or raw: the same tiles, the same image from either side, and no
 * damage that is overlooked. */
#include "image/pack.h"

#include "check.h"
#include "fx/crc32c.h"
#include "hs/rng.h"
#include "image/recode.h"
#include "image/verify.h"
#include "packed_tile.h"
#include "support.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct lm_tile tile_of(uint32_t noise, struct hs_rng *rng)
{
    struct lm_tile t = {.lod = 1, .row = 9, .column = 4, .base_m_q6 = 128};
    for (int i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
        const int r = i / LM_TILE_POINTS, c = i % LM_TILE_POINTS;
        t.points[r][c].cell = (uint16_t)(0x5020 + 256 * hs_rng_below(rng, noise));
        t.points[r][c].post =
            (uint16_t)(9000 + 1000 * sin(r / 9.0 + c / 17.0) + hs_rng_below(rng, noise * noise));
    }
    t.crc = fx_crc32c(0, &t.lod, LM_TILE_BYTES - sizeof t.crc);
    return t;
}

TEST(a_record_is_what_the_page_of_formats_says_or_raw)
{
    uint8_t record[LM_TILE_BYTES], expected[LM_TILE_BYTES];
    struct hs_rng rng;
    int compressed = 0;
    hs_rng_seed(&rng, 1);
    for (uint32_t i = 0; i < 100; i++) {
        const struct lm_tile t = tile_of(1 + i, &rng);
        struct lm_tile back;
        const uint16_t size = image_pack(&t, IMAGE_COMPRESSION_LZ4, record);
        assert_true(image_unpack(record, size, &back));
        assert_memory_equal(&back, &t, sizeof t);
        if (size < LM_TILE_BYTES / LM_DB_PLACE_BYTES) {
            compressed++;
            assert_int_equal(packed_tile(&t, expected), size);
            assert_memory_equal(record, expected, size * LM_DB_PLACE_BYTES);
        } else {
            assert_memory_equal(record, &t, sizeof t);
        }
        assert_int_equal(image_pack(&t, IMAGE_COMPRESSION_NONE, record), 273);
        assert_memory_equal(record, &t, sizeof t);
    }
    assert_true(compressed > 20);
}

TEST(what_is_too_noisy_to_compress_is_raw)
{
    uint8_t record[LM_TILE_BYTES];
    struct lm_tile t;
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (size_t i = 0; i < sizeof t; i++) {
        ((uint8_t *)&t)[i] = (uint8_t)hs_rng_below(&rng, 256);
    }
    assert_int_equal(image_pack(&t, IMAGE_COMPRESSION_LZ4, record), 273);
    assert_memory_equal(record, &t, sizeof t);
}

static struct tiny_cell fields(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const bool is_wood = sin(p->east_m / 90) > sin(p->north_m / 70);
    return (struct tiny_cell){is_wood ? -15 : -20, is_wood ? TINY_TREES : TINY_SOIL,
                              is_wood ? 7 : 0};
}

static double hills(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300 + 60 * sin(p->east_m / 400) * cos(p->north_m / 300);
}

static void make_tiny(struct tiny_image *tiny)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = fields;
    spec.elevation_m = hills;
    spec.rows = 3;
    spec.columns = 4;
    assert_int_equal(tiny_image_build(tiny, &spec), 0);
}

static const char *path_of(const char *name)
{
    static char path[4][512];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/tmp/test_pack_%s", support_build_dir(), name);
    return path[next];
}

static uint64_t faults_of(struct image *image)
{
    struct image_findings findings = {NULL, 0, 0, false, NULL};
    struct image_verify_counts counts;
    assert_int_equal(image_verify(image, &findings, &counts), 0);
    return findings.count;
}

static void recode(const char *from, enum image_compression how, const char *to)
{
    struct image image;
    assert_int_equal(image_map(&image, from), 0);
    assert_int_equal(faults_of(&image), 0);
    assert_int_equal(image_recode(&image, from, how, to), 0);
    image_close(&image);
    assert_int_equal(image_map(&image, to), 0);
    assert_int_equal(faults_of(&image), 0);
    image_close(&image);
}

TEST(an_image_is_the_same_whichever_way_it_was_stored_before)
{
    struct tiny_image tiny;
    struct image raw, packed;
    make_tiny(&tiny);
    assert_int_equal(support_run("mkdir -p %s/tmp", support_build_dir()), 0);
    assert_int_equal(tiny_image_write(&tiny, path_of("tiny")), 0);
    recode(path_of("tiny"), IMAGE_COMPRESSION_NONE, path_of("raw"));
    recode(path_of("tiny"), IMAGE_COMPRESSION_LZ4, path_of("packed"));
    recode(path_of("packed"), IMAGE_COMPRESSION_NONE, path_of("raw_again"));
    recode(path_of("raw"), IMAGE_COMPRESSION_LZ4, path_of("packed_again"));
    assert_int_equal(support_run("cmp %s %s", path_of("raw"), path_of("raw_again")), 0);
    assert_int_equal(support_run("cmp %s %s", path_of("packed"), path_of("packed_again")), 0);
    assert_int_equal(image_open(&raw, path_of("raw")), 0);
    assert_int_equal(image_open(&packed, path_of("packed")), 0);
    assert_true(packed.size_bytes * 2 < raw.size_bytes);
    for (uint32_t i = 0; i < raw.header.entry_count; i++) {
        const struct lm_tile *a = image_entry_tile(&raw, i), *b = image_entry_tile(&packed, i);
        assert_int_equal(a == NULL, b == NULL);
        assert_true(!a || memcmp(a, b, sizeof *a) == 0);
    }
    image_close(&raw);
    image_close(&packed);
    tiny_image_free(&tiny);
}

/* Put right what stands above a record: the checksums of the section and of the header. */
static void seal_above(uint8_t *bytes)
{
    struct lm_image_header h;
    memcpy(&h, bytes, sizeof h);
    for (uint32_t i = 0; i < h.section_count; i++) {
        h.sections[i].crc = fx_crc32c(0, bytes + h.sections[i].offset, h.sections[i].bytes);
    }
    h.crc = fx_crc32c(0, &h, sizeof h - sizeof h.crc);
    memcpy(bytes, &h, sizeof h);
}

/* Of the image that the test before has left. A bit that says nothing, as in the last token of a
 * block, may be either. */
TEST(a_flipped_bit_of_a_record_is_a_fault_or_changes_no_tile)
{
    struct image image;
    struct hs_rng rng;
    int faults = 0;
    hs_rng_seed(&rng, 3);
    assert_int_equal(image_open(&image, path_of("packed")), 0);
    const struct lm_image_section *tiles = image.sections[LM_IMAGE_TILES];
    uint8_t *bytes = aligned_alloc(64, (image.size_bytes + 63) / 64 * 64);
    assert_non_null(bytes);
    memcpy(bytes, image.bytes, image.size_bytes);
    for (int i = 0; i < 400; i++) {
        struct image damaged;
        const uint64_t at = tiles->offset + hs_rng_below(&rng, (uint32_t)tiles->bytes);
        const uint8_t bit = (uint8_t)(1u << hs_rng_below(&rng, 8));
        bytes[at] ^= bit;
        image_lend(&damaged, bytes, image.size_bytes);
        assert_true(faults_of(&damaged) > 0); /* the section's checksum, at least */
        image_close(&damaged);
        seal_above(bytes);
        image_lend(&damaged, bytes, image.size_bytes);
        const bool is_fault = faults_of(&damaged) > 0;
        for (uint32_t k = 0; !is_fault && k < image.header.entry_count; k++) {
            const struct lm_tile *a = image_entry_tile(&image, k);
            assert_true(!a || memcmp(a, image_entry_tile(&damaged, k), sizeof *a) == 0);
        }
        faults += is_fault;
        image_close(&damaged);
        bytes[at] ^= bit;
        seal_above(bytes);
    }
    assert_true(faults > 380);
    free(bytes);
    image_close(&image);
}

/* More tiles than the reader keeps are right each time, and the last ones asked for stay. */
TEST(a_reader_unpacks_again_what_it_has_dropped)
{
    enum { COUNT = IMAGE_UNPACKED_TILES + 100 };
    uint8_t record[LM_TILE_BYTES];
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    struct image_unpacked *u = image_unpacked_new(COUNT, IMAGE_UNPACKED_TILES);
    assert_non_null(u);
    struct lm_tile t = tile_of(3, &rng);
    for (uint32_t i = 0; i < 2 * COUNT; i++) {
        const uint32_t entry = i % COUNT;
        t.column = entry;
        const uint16_t size = packed_tile(&t, record);
        const struct lm_tile *got = image_unpacked_tile(u, entry, record, size);
        assert_memory_equal(got, &t, sizeof t);
        if (entry > 0) { /* kept: its record is not looked at */
            assert_int_equal(image_unpacked_tile(u, entry - 1, NULL, 1)->column, entry - 1);
        }
    }
    image_unpacked_free(u);
}
