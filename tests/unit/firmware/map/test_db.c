/* Nothing in the image is believed before it was checked. */
#include "lm/db.h"
#include "lm/image.h"
#include "lm/sensor.h"

#include "check.h"
#include "fx/crc32c.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "memory_flash.h"
#include "tiny_image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POLLS = 10 };

static struct tiny_cell soil(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

static void build(struct tiny_image *image)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = soil;
    spec.rows = spec.columns = 3;
    assert_int_equal(tiny_image_build(image, &spec), 0);
}

static int open_bytes(struct lm_db *db, const uint8_t *bytes, size_t size)
{
    struct memory_flash flash;
    memory_flash_open(&flash, bytes, size);
    return lm_db_open(db, &flash.port, POLLS);
}

TEST(a_sound_image_opens)
{
    struct tiny_image image;
    struct lm_db db;
    build(&image);
    assert_int_equal(open_bytes(&db, image.bytes, image.size), LM_OK);
    assert_int_equal(db.shift0, 9);
    assert_string_equal(db.classes.entry[TINY_WATER].name, tiny_classes()->entry[TINY_WATER].name);
    tiny_image_free(&image);
}

TEST(every_flipped_bit_of_header_and_tables_is_refused)
{
    struct tiny_image image;
    struct lm_db db;
    build(&image);
    const size_t spans[][2] = {
        {0, LM_DB_HEADER_BYTES},
        {image.classes_offset, sizeof(struct lm_classes)},
        {image.bands_offset, image.band_count * sizeof(struct lm_band)},
    };
    for (size_t s = 0; s < 3; s++) {
        for (size_t bit = 0; bit < spans[s][1] * 8; bit++) {
            uint8_t *byte = image.bytes + spans[s][0] + bit / 8;
            *byte = (uint8_t)(*byte ^ 1u << bit % 8);
            assert_true(open_bytes(&db, image.bytes, image.size) < 0);
            *byte = (uint8_t)(*byte ^ 1u << bit % 8);
        }
    }
    tiny_image_free(&image);
}

TEST(a_truncated_image_is_refused_at_every_length)
{
    struct tiny_image image;
    struct lm_db db;
    build(&image);
    for (size_t size = 0; size < image.size; size += size < 4096 ? 1 : 997) {
        assert_true(open_bytes(&db, image.bytes, size) < 0);
    }
    tiny_image_free(&image);
}

/* Whatever a header with a right checksum says, what is accepted lies inside the flash. */
TEST(hostile_headers_never_lead_outside_the_flash)
{
    struct tiny_image image;
    build(&image);
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    uint8_t *copy = malloc(image.size);
    int accepted = 0;
    for (int round = 0; round < 20000; round++) {
        memcpy(copy, image.bytes, image.size);
        for (int n = 0; n < 3; n++) {
            const uint32_t at = hs_rng_below(&rng, 3)
                                    ? hs_rng_below(&rng, LM_DB_HEADER_BYTES - 4)
                                    : (uint32_t)image.bands_offset + hs_rng_below(&rng, 24);
            const uint64_t value = hs_rng_u64(&rng) >> hs_rng_below(&rng, 64);
            memcpy(copy + at, &value, 1u << hs_rng_below(&rng, 3));
        }
        /* Put the checksums of what the firmware checks right again, so that only its judgement
         * stands in the way. */
        for (uint32_t s = 0; s < 5; s++) {
            uint64_t offset, bytes;
            memcpy(&offset, copy + 64 + 24 * s + 8, 8);
            memcpy(&bytes, copy + 64 + 24 * s + 16, 8);
            if (offset <= image.size && bytes <= image.size - offset) {
                const uint32_t crc = fx_crc32c(0, copy + offset, bytes);
                memcpy(copy + 64 + 24 * s + 4, &crc, 4);
            }
        }
        const uint32_t crc = fx_crc32c(0, copy, LM_DB_HEADER_BYTES - 4);
        memcpy(copy + LM_DB_HEADER_BYTES - 4, &crc, 4);
        struct lm_db db;
        if (open_bytes(&db, copy, image.size) != LM_OK) {
            continue;
        }
        accepted++;
        assert_true(lm_db_entry_offset(&db, db.entry_count) <= image.size);
        assert_true(db.records_offset + (uint64_t)db.tiles_size * LM_DB_PLACE_BYTES <= image.size);
        assert_true(db.detail_offset + (uint64_t)db.detail_size * LM_DB_PLACE_BYTES <= image.size);
        assert_in_range(db.shift0 + db.lod_count, 1, LM_DB_SHIFT_MAX + 1);
        for (uint32_t i = 0; i < db.band_count; i++) {
            const struct lm_band *b = &db.bands[i];
            const int64_t entry = lm_db_entry(&db, b->lod, b->row0 + b->rows - 1, b->column0);
            assert_true(entry < (int64_t)db.entry_count);
        }
    }
    assert_true(accepted > 100);
    free(copy);
    tiny_image_free(&image);
}

/* Found by tests/fuzz: either one overflowed the heights computed from it. */
TEST(heights_beyond_16_km_in_the_header_are_refused)
{
    static const int32_t heights_q6[] = {INT32_MIN, INT32_MAX, -(1 << 20) - 1, (1 << 20) + 1};
    for (size_t field = 40; field <= 44; field += 4) { /* mean elevation, geoid */
        for (size_t i = 0; i < sizeof heights_q6 / sizeof *heights_q6; i++) {
            struct tiny_image image;
            struct lm_db db;
            build(&image);
            memcpy(image.bytes + field, &heights_q6[i], 4);
            tiny_image_seal(&image);
            assert_int_equal(open_bytes(&db, image.bytes, image.size), LM_ERR_CORRUPT);
            tiny_image_free(&image);
        }
    }
}

TEST(another_version_is_told_from_damage)
{
    struct tiny_image image;
    struct lm_db db;
    build(&image);
    for (int other = -1; other <= 1; other += 2) {
        image.bytes[8] = (uint8_t)(LM_DB_VERSION + other); /* whatever its checksum says */
        assert_int_equal(open_bytes(&db, image.bytes, image.size), LM_ERR_VERSION);
    }
    tiny_image_free(&image);
}

TEST(a_top_that_is_not_resident_whole_is_refused_as_another_version)
{
    struct tiny_image image;
    struct lm_db db;
    build(&image);
    image.bytes[offsetof(struct lm_image_header, top)] = 1;
    assert_int_equal(open_bytes(&db, image.bytes, image.size), LM_ERR_CORRUPT);
    tiny_image_seal(&image);
    assert_int_equal(open_bytes(&db, image.bytes, image.size), LM_ERR_VERSION);
    tiny_image_free(&image);
}

static uint32_t entry_crc(uint32_t number, const struct lm_tile_entry *e)
{
    return fx_crc32c(fx_crc32c(0, &number, sizeof number), e, 12);
}

TEST(an_entry_leads_to_a_whole_record_and_to_detail_inside_its_section)
{
    enum { RAW = LM_TILE_BYTES / LM_DB_PLACE_BYTES, NONE = -1 };
    static const struct {
        struct lm_tile_entry entry;
        int status;
    } cases[] = {
        {{0, RAW, 0, 0, LM_TILE_ABSENT, 0}, LM_OK},
        {{2 * RAW, RAW, 0, 0, LM_TILE_ABSENT, 0}, LM_OK},
        {{5, RAW, 0, 0, LM_TILE_ABSENT, 0}, LM_OK}, /* anywhere in TILES */
        {{2 * RAW + 1, RAW, 0, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{UINT32_MAX - 1, RAW, 0, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{0, RAW - 1, 0, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{0, RAW + 1, 0, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{0, 0, 0, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{0, RAW, LM_TILE_LZ4, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT}, /* no shorter than raw */
        {{0, RAW - 1, LM_TILE_LZ4, 0, LM_TILE_ABSENT, 0}, LM_OK},
        {{3 * RAW - 1, 1, LM_TILE_LZ4, 0, LM_TILE_ABSENT, 0}, LM_OK},
        {{3 * RAW - 1, 2, LM_TILE_LZ4, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{0, 0, LM_TILE_LZ4, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{0, UINT16_MAX, LM_TILE_LZ4, 0, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
        {{0, RAW, 2, 0, LM_TILE_ABSENT, 0}, LM_ERR_VERSION},
        {{0, 7, 255, 0, LM_TILE_ABSENT, 0}, LM_ERR_VERSION},
        {{LM_TILE_ABSENT, 0, 0, 0, LM_TILE_ABSENT, 0}, LM_OK},
        {{0, RAW, 0, 4, 6, 0}, LM_OK},
        {{0, RAW, 0, 4, 7, 0}, LM_ERR_CORRUPT},
        {{0, RAW, 0, 4, UINT32_MAX - 1, 0}, LM_ERR_CORRUPT},
        {{0, RAW, 0, 0, 3, 0}, LM_ERR_CORRUPT},
        {{0, RAW, 0, 1, LM_TILE_ABSENT, 0}, LM_ERR_CORRUPT},
    };
    const struct lm_db db = {.tiles_size = 3 * RAW, .detail_size = 10};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lm_tile_entry e = cases[i].entry;
        e.crc = entry_crc(7, &e);
        assert_int_equal(lm_db_entry_check(&db, 7, &e), cases[i].status);
        assert_int_equal(lm_db_entry_check(&db, 8, &e), LM_ERR_CORRUPT); /* not this entry's */
    }
}

/* ---- optional sections, whose heads are judged one word at a time ---- */

/* What opening says of an image with this section, its last word the CRC of those before it. */
static int open_with(uint32_t type, const void *head, uint32_t bytes)
{
    uint8_t section[4096] = {0};
    struct tiny_image image;
    struct lm_db db;
    memcpy(section, head, bytes);
    const uint32_t crc = fx_crc32c(0, section, bytes - 4);
    memcpy(section + bytes - 4, &crc, 4);
    build(&image);
    assert_int_equal(tiny_image_add_section(&image, type, section, bytes), 0);
    const int status = open_bytes(&db, image.bytes, image.size);
    tiny_image_free(&image);
    return status;
}

TEST(a_head_of_targets_must_agree_with_its_section)
{
    const struct lm_targets_head sound = {.count = 0, .record_bytes = LM_TARGET_BYTES};
    struct lm_targets_head h = sound;
    assert_int_equal(open_with(LM_IMAGE_TARGETS, &h, sizeof h), LM_OK);
    assert_int_equal(open_with(LM_IMAGE_TARGETS, &h, sizeof h - 4), LM_ERR_CORRUPT);
    h.count = 1; /* one record, and no room for it */
    assert_int_equal(open_with(LM_IMAGE_TARGETS, &h, sizeof h), LM_ERR_CORRUPT);
    h.count = LM_DB_TARGETS_MAX + 1;
    assert_int_equal(open_with(LM_IMAGE_TARGETS, &h, sizeof h), LM_ERR_CORRUPT);
    h = sound, h.record_bytes--;
    assert_int_equal(open_with(LM_IMAGE_TARGETS, &h, sizeof h), LM_ERR_CORRUPT);
}

TEST(a_head_of_signatures_must_agree_with_its_section)
{
    const struct lm_signatures_head sound = {.record_bytes = LM_SIGNATURE_BYTES,
                                             .chip_bytes = LM_CHIP_BYTES};
    struct lm_signatures_head h = sound;
    assert_int_equal(open_with(LM_IMAGE_SIGNATURES, &h, sizeof h), LM_OK);
    h.record_bytes++;
    assert_int_equal(open_with(LM_IMAGE_SIGNATURES, &h, sizeof h), LM_ERR_CORRUPT);
    h = sound, h.chip_bytes++;
    assert_int_equal(open_with(LM_IMAGE_SIGNATURES, &h, sizeof h), LM_ERR_CORRUPT);
    h = sound, h.count = LM_DB_SIGNATURES_MAX + 1;
    assert_int_equal(open_with(LM_IMAGE_SIGNATURES, &h, sizeof h), LM_ERR_CORRUPT);
    h = sound, h.chip_count = LM_DB_CHIPS_MAX + 1;
    assert_int_equal(open_with(LM_IMAGE_SIGNATURES, &h, sizeof h), LM_ERR_CORRUPT);
    h = sound, h.count = 1;
    assert_int_equal(open_with(LM_IMAGE_SIGNATURES, &h, sizeof h), LM_ERR_CORRUPT);
    h = sound, h.chip_count = 1;
    assert_int_equal(open_with(LM_IMAGE_SIGNATURES, &h, sizeof h), LM_ERR_CORRUPT);
}

TEST(a_section_that_leaves_the_image_or_its_grid_is_refused)
{
    static const uint32_t types[] = {LM_IMAGE_TARGETS, LM_IMAGE_SIGNATURES, LM_IMAGE_GEOID,
                                     LM_IMAGE_DETAIL,  LM_IMAGE_RADAR,      LM_IMAGE_BUS};
    const uint8_t content[64] = {0};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        for (int what = 0; what < 5; what++) {
            struct tiny_image image;
            struct lm_db db;
            build(&image);
            assert_int_equal(tiny_image_add_section(&image, types[i], content, sizeof content), 0);
            struct lm_image_header h;
            memcpy(&h, image.bytes, sizeof h);
            struct lm_image_section *s = &h.sections[h.section_count - 1];
            assert_int_equal(s->type, types[i]);
            s->offset += what == 0 ? h.image_bytes : what == 1 ? 1 : 0;
            s->bytes += what == 2 ? h.image_bytes : what == 3 ? (uint64_t)1 << 40 : 0;
            s->bytes = what == 4 ? 0 : s->bytes;
            h.crc = fx_crc32c(0, &h, sizeof h - sizeof h.crc);
            memcpy(image.bytes, &h, sizeof h);
            const bool may_be_empty = what == 4 && types[i] == LM_IMAGE_DETAIL;
            assert_int_equal(open_bytes(&db, image.bytes, image.size),
                             may_be_empty ? LM_OK : LM_ERR_CORRUPT);
            tiny_image_free(&image);
        }
    }
}

TEST(a_class_of_an_unknown_kind_or_facing_or_heights_that_fall_are_refused)
{
    for (int what = 0; what < 5; what++) {
        struct tiny_image image;
        struct lm_db db;
        build(&image);
        struct lm_classes *c = (struct lm_classes *)(void *)(image.bytes + image.classes_offset);
        if (what == 1) {
            c->entry[7].kind = LM_KIND_TREES + 1;
        } else if (what == 2) {
            c->entry[15].facing = LM_FACINGS + 1;
        } else if (what == 3) {
            c->height_dm[15] = (uint16_t)(c->height_dm[14] - 1);
        } else if (what == 4) {
            c->height_dm[0] = 1;
        }
        tiny_image_seal(&image);
        assert_int_equal(open_bytes(&db, image.bytes, image.size),
                         what == 0 ? LM_OK : LM_ERR_CORRUPT);
        tiny_image_free(&image);
    }
}

/* A header whose numbers are all sound, with one that is not. */
TEST(a_number_of_the_header_that_cannot_be_is_refused)
{
    for (int what = 0; what < 12; what++) {
        struct tiny_image image;
        struct lm_db db;
        build(&image);
        struct lm_image_header h;
        memcpy(&h, image.bytes, sizeof h);
        h.header_bytes += what == 1;
        h.image_bytes += what == 2;
        h.shift0 = what == 3 ? LM_DB_SHIFT_MIN - 1 : h.shift0;
        h.lod_count = what == 4   ? 0
                      : what == 5 ? LM_DB_LODS_MAX + 1
                      : what == 6 ? (uint8_t)(LM_DB_SHIFT_MAX - h.shift0 + 2)
                                  : h.lod_count;
        h.shift0 = what == 5 ? LM_DB_SHIFT_MIN : h.shift0;
        h.band_count = what == 7 ? 0 : what == 8 ? LM_DB_BANDS_MAX + 1 : h.band_count;
        h.record_bytes += what == 9;
        h.section_count = what == 10 ? LM_IMAGE_SECTIONS_MAX + 1 : h.section_count;
        h.sensor = what == 11 ? LM_SENSORS : h.sensor;
        h.crc = fx_crc32c(0, &h, sizeof h - sizeof h.crc);
        memcpy(image.bytes, &h, sizeof h);
        assert_int_equal(open_bytes(&db, image.bytes, image.size), what == 0    ? LM_OK
                                                                   : what == 11 ? LM_ERR_VERSION
                                                                                : LM_ERR_CORRUPT);
        tiny_image_free(&image);
    }
}

/* What the image says of a section of so many bytes, in a flash of 2^40. */
static int open_long(uint32_t type, uint64_t bytes)
{
    const uint8_t content[64] = {0};
    struct tiny_image image;
    struct memory_flash flash;
    struct lm_db db;
    build(&image);
    assert_int_equal(tiny_image_add_section(&image, type, content, sizeof content), 0);
    struct lm_image_header h;
    memcpy(&h, image.bytes, sizeof h);
    h.sections[h.section_count - 1].bytes = bytes;
    h.image_bytes = (uint64_t)1 << 40;
    h.crc = fx_crc32c(0, &h, sizeof h - sizeof h.crc);
    memcpy(image.bytes, &h, sizeof h);
    memory_flash_open(&flash, image.bytes, (size_t)h.image_bytes);
    const int status = lm_db_open(&db, &flash.port, POLLS);
    tiny_image_free(&image);
    return status;
}

TEST(a_section_longer_than_its_units_can_count_is_refused)
{
    const uint64_t units = UINT32_MAX;
    assert_int_equal(open_long(LM_IMAGE_DETAIL, (units - 1) * LM_DB_PLACE_BYTES), LM_OK);
    assert_int_equal(open_long(LM_IMAGE_DETAIL, units * LM_DB_PLACE_BYTES), LM_ERR_CORRUPT);
    assert_int_equal(open_long(LM_IMAGE_RADAR, UINT32_MAX), LM_OK);
    assert_int_equal(open_long(LM_IMAGE_RADAR, (uint64_t)UINT32_MAX + 1), LM_ERR_CORRUPT);
}

TEST(a_column_beyond_the_way_round_the_earth_has_no_entry)
{
    struct tiny_image image;
    struct lm_db db;
    build(&image);
    assert_int_equal(open_bytes(&db, image.bytes, image.size), LM_OK);
    const struct lm_band *b = &db.bands[0];
    const uint32_t round = 1u << (32 - LM_TILE_CELLS_LOG2 - db.shift0);
    assert_int_equal(lm_db_entry(&db, b->lod, b->row0, b->column0), b->entry0);
    assert_int_equal(lm_db_entry(&db, b->lod, b->row0, b->column0 + round), -1);
    tiny_image_free(&image);
}

TEST(a_flash_that_fails_at_the_head_of_an_optional_section_is_an_io_error)
{
    static const uint32_t types[] = {LM_IMAGE_TARGETS, LM_IMAGE_SIGNATURES, LM_IMAGE_GEOID,
                                     LM_IMAGE_GEOID_PAGES};
    const uint8_t content[sizeof(struct lm_geoid)] = {0};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        struct tiny_image image;
        struct memory_flash flash;
        struct lm_db db;
        build(&image);
        assert_int_equal(tiny_image_add_section(&image, types[i], content, sizeof content), 0);
        memory_flash_open(&flash, image.bytes, image.size);
        flash.fail_read = 4; /* after header, classes and bands */
        assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_ERR_IO);
        tiny_image_free(&image);
    }
}

TEST(failing_and_hanging_flash_is_an_io_error)
{
    struct tiny_image image;
    struct lm_db db;
    build(&image);
    for (uint32_t read = 1; read <= 3; read++) {
        struct memory_flash flash;
        memory_flash_open(&flash, image.bytes, image.size);
        flash.fail_read = read;
        assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_ERR_IO);
    }
    struct memory_flash flash;
    memory_flash_open(&flash, image.bytes, image.size);
    flash.busy_polls = POLLS + 1;
    assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_ERR_IO);
    tiny_image_free(&image);
}

TEST(zones_change_where_the_format_says)
{
    static const struct {
        double degrees;
        int below, above;
    } border[] = {{61.875, 0, 1}, {73.125, 1, 2}, {84.375, 2, 3}};
    for (size_t i = 0; i < 3; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            assert_int_equal(lm_db_zone(hs_bam(sign * (border[i].degrees - 1e-5))),
                             border[i].below);
            assert_int_equal(lm_db_zone(hs_bam(sign * (border[i].degrees + 1e-5))),
                             border[i].above);
        }
    }
    assert_int_equal(lm_db_zone(hs_bam(90)), 3);
    assert_int_equal(lm_db_zone(hs_bam(-90)), 3);
    assert_int_equal(lm_db_zone(0), 0);
}

TEST(a_level_0_cell_of_shift_9_is_4769_mm)
{
    struct lm_db db = {.shift0 = 9};
    /* 512 / 2^32 of the meridian, 40,007,862.9 m. */
    assert_int_equal(lm_db_cell_mm(&db, 0), 4769);
    assert_int_equal(lm_db_cell_mm(&db, 3), 38154);
}
