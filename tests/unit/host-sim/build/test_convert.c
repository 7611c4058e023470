/* An image of version 2, written here byte by byte as that version was, and what `landmass-db
 * convert` makes of it. Its content is tiny_image's, which was written from docs/FORMATS.md alone:
 * the converted tiles must be those of tiny_image's own version 3. */
#include "image/codes.h"
#include "image/reader.h"
#include "image/verify.h"

#include "check.h"
#include "fx/crc32c.h"
#include "scene.h"
#include "support.h"
#include "target_support.h"
#include "tiny_image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    HEADER = 512,
    TITLE_AT = 448,
    CRC_AT = 508,
    RECORD = 16960,
    SIDE = 65,
    SECTION_COUNT = 6,
    ENTRY = 8
};

/* ---- the writer of version 2 ---- */

struct old_image {
    uint8_t *bytes;
    size_t size, at[SECTION_COUNT], length[SECTION_COUNT];
};

static void put(uint8_t *at, uint64_t value, size_t bytes)
{
    memcpy(at, &value, bytes);
}

/* The cells of a tile as version 2 had them: those of a coarser level without crests. */
static void old_cells(const struct image *image, const struct lm_tile *t,
                      uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS])
{
    enum { HALF = LM_TILE_CELLS / 2 };
    image_cells_decode(t, cells);
    for (int i = 0; i < 4 && t->lod > 0; i++) {
        const struct lm_tile *below =
            image_find_tile(image, (uint8_t)(t->lod - 1), 2 * t->row + (uint32_t)(i / 2),
                            2 * t->column + (uint32_t)(i % 2));
        if (below) {
            uint16_t fine[LM_TILE_CELLS][LM_TILE_CELLS];
            old_cells(image, below, fine);
            const struct image_reduction halved = {&image->db.classes, 2, HALF, IMAGE_VOTE_POWER};
            image_reduce(&halved, &fine[0][0], LM_TILE_CELLS, &cells[i / 2 * HALF][i % 2 * HALF],
                         LM_TILE_CELLS);
        }
    }
}

/* The posts of a tile as version 2 had them: every second one of the level below. */
static void old_posts(const struct image *image, const struct lm_tile *t,
                      int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS])
{
    enum { HALF = LM_TILE_CELLS / 2 };
    image_posts_decode(t, posts_q6);
    for (int i = 0; i < 4 && t->lod > 0; i++) {
        const struct lm_tile *below =
            image_find_tile(image, (uint8_t)(t->lod - 1), 2 * t->row + (uint32_t)(i / 2),
                            2 * t->column + (uint32_t)(i % 2));
        int32_t fine_q6[LM_TILE_POSTS][LM_TILE_POSTS];
        if (!below) {
            continue;
        }
        old_posts(image, below, fine_q6);
        for (int k = 0; k < (HALF + 1) * (HALF + 1); k++) {
            const int r = k / (HALF + 1), c = k % (HALF + 1);
            posts_q6[i / 2 * HALF + r][i % 2 * HALF + c] = fine_q6[2 * r][2 * c];
        }
    }
}

static void put_record(uint8_t *at, const struct image *image, const struct lm_tile *now)
{
    uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS];
    int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS];
    struct lm_tile then = *now, *t = &then;
    old_cells(image, now, cells);
    old_posts(image, now, posts_q6);
    image_posts_encode((const int32_t(*)[LM_TILE_POSTS])posts_q6, t);
    memcpy(at + 4, &t->lod, 17); /* lod to post_shift: as it is today */
    for (int r = 0; r < SIDE; r++) {
        for (int c = 0; c < SIDE; c++) {
            uint8_t *point = at + 32 + 4 * ((size_t)r * SIDE + (size_t)c);
            const bool is_cell = r < LM_TILE_CELLS && c < LM_TILE_CELLS;
            put(point, is_cell ? cells[r][c] : 0, 2);
            put(point + 2, t->points[r + 1][c + 1].post, 2);
        }
    }
    put(at, fx_crc32c(0, at + 4, RECORD - 4), 4);
}

static void put_directory(const struct old_image *o, const struct image *image)
{
    uint32_t record = 0;
    for (uint32_t i = 0; i < image->header.entry_count; i++) {
        uint8_t *entry = o->bytes + o->at[2] + (size_t)i * ENTRY;
        const struct lm_tile *t = image_entry_tile(image, i);
        uint32_t covered[2] = {i, t ? record : UINT32_MAX};
        put(entry, covered[1], 4);
        put(entry + 4, fx_crc32c(0, covered, sizeof covered), 4);
        if (t) {
            put_record(o->bytes + o->at[3] + (size_t)record++ * RECORD, image, t);
        }
    }
}

static void seal(const struct old_image *o)
{
    for (int i = 0; i < SECTION_COUNT; i++) {
        uint8_t *entry = o->bytes + 64 + (size_t)24 * (size_t)i;
        put(entry, (uint64_t)i + 1, 4);
        put(entry + 4, fx_crc32c(0, o->bytes + o->at[i], o->length[i]), 4);
        put(entry + 8, o->at[i], 8);
        put(entry + 16, o->length[i], 8);
    }
    put(o->bytes + CRC_AT, fx_crc32c(0, o->bytes, CRC_AT), 4);
}

static void put_target(uint8_t *head)
{
    struct lm_target t = point_at(46.0, 11.0, 0, 10);
    t.id = 7;
    seal_target(&t);
    put(head, 1, 4);
    put(head + 4, LM_TARGET_BYTES, 4);
    put(head + 60, fx_crc32c(0, head, 60), 4);
    memcpy(head + 64, &t, sizeof t);
}

/* Sections CLASSES, BANDS, DIRECTORY, TILES, MANIFEST and TARGETS; the bytes are the caller's. */
static struct old_image old_image_of(const struct image *image)
{
    static const char manifest[] = "builder: test_convert\nsection-sha256: TILES 0123\n";
    const struct lm_image_header *h = &image->header;
    struct old_image o = {
        .length = {sizeof(struct lm_classes), h->band_count * sizeof(struct lm_band),
                   (size_t)h->entry_count * ENTRY, (size_t)h->record_count * RECORD,
                   sizeof manifest - 1, 64 + LM_TARGET_BYTES}};
    o.size = HEADER;
    for (int i = 0; i < SECTION_COUNT; i++) {
        o.at[i] = (o.size + 63) / 64 * 64;
        o.size = o.at[i] + o.length[i];
    }
    o.bytes = calloc(1, o.size);
    assert_non_null(o.bytes);
    memcpy(o.bytes, h, 56); /* to the centre: as it is today, but for what follows */
    put(o.bytes + 8, 2, 4);
    put(o.bytes + 12, HEADER, 4);
    put(o.bytes + 16, o.size, 8);
    put(o.bytes + 36, RECORD, 4);
    put(o.bytes + 56, SECTION_COUNT, 4);
    memcpy(o.bytes + TITLE_AT, "of version two", 14);
    memcpy(o.bytes + o.at[0], &image->db.classes, o.length[0]);
    memcpy(o.bytes + o.at[1], image->db.bands, o.length[1]);
    put_directory(&o, image);
    memcpy(o.bytes + o.at[4], manifest, o.length[4]);
    put_target(o.bytes + o.at[5]);
    seal(&o);
    return o;
}

static void write_bytes(const char *name, const uint8_t *bytes, size_t size)
{
    FILE *file = fopen(scene_path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* ---- what it is made of ---- */

static double ridges_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 400 + 120 * sin(p->east_m / 45) * cos(p->north_m / 60) + p->north_m / 20;
}

static struct tiny_cell village(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const int k = ((int)floor(p->east_m / 37) * 3 + (int)floor(p->north_m / 53) * 5) & 7;
    const uint8_t class_index = k < 6 ? (uint8_t)k : TINY_SOIL;
    const bool stands = class_index == TINY_STRUCTURE || class_index == TINY_TREES;
    return (struct tiny_cell){-30.0 + 3 * class_index, class_index, stands ? 5 : 0};
}

static void open_tiny(struct tiny_image *tiny, struct image *image, double latitude,
                      double longitude)
{
    struct image_findings findings = {stdout, 0, 10, false, NULL};
    struct tiny_spec spec = tiny_spec_at(latitude, longitude);
    spec.rows = 3;
    spec.columns = 4;
    spec.cell = village;
    spec.elevation_m = ridges_m;
    assert_int_equal(tiny_image_build(tiny, &spec), 0);
    image_lend(image, tiny->bytes, tiny->size);
    assert_int_equal(image_read_tables(image, &findings), 0);
}

/* Every own cell, and every post at a corner of one. */
static void assert_same_tile(const struct lm_tile *a, const struct lm_tile *b)
{
    for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
        const int r = i / LM_TILE_POSTS, c = i % LM_TILE_POSTS;
        assert_true(image_post_q6(a, r, c) == image_post_q6(b, r, c));
        assert_int_equal(image_tile_cell(a, r, c), image_tile_cell(b, r, c));
    }
}

static void assert_report_says(uint64_t bytes, uint64_t tiles)
{
    assert_int_equal(
        support_run("python3 -c 'import json; r = json.load(open(\"%s\"))[\"report\"]; "
                    "assert r == {\"bytes\": %llu, \"tiles\": %llu, "
                    "\"fault_count\": 0}, r'",
                    scene_path("report"), (unsigned long long)bytes, (unsigned long long)tiles),
        0);
}

TEST(a_converted_image_is_the_one_that_version_3_would_have_been)
{
    static const double places[][2] = {{46, 11}, {-46, -70}, {61.875, 20}, {-73.125, 180}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        struct tiny_image tiny;
        struct image before, after;
        struct image_findings findings = {stdout, 0, 10, false, NULL};
        struct image_verify_counts counts;
        open_tiny(&tiny, &before, places[i][0], places[i][1]);
        const struct old_image old = old_image_of(&before);
        write_bytes("old.lmdb", old.bytes, old.size);
        const int exit_code = scene_run("convert %s %s --json %s", scene_path("old.lmdb"),
                                        scene_path("new.lmdb"), scene_path("report"));
        if (exit_code != 0) {
            scene_log_holds("(what it said)");
        }
        assert_int_equal(exit_code, 0);
        assert_true(scene_log_holds("no faults"));
        assert_true(scene_log_holds("build it again from its sources"));
        assert_int_equal(image_map(&after, scene_path("new.lmdb")), 0);
        assert_int_equal(image_verify(&after, &findings, &counts), 0);
        assert_int_equal(findings.count, 0);
        assert_report_says(after.size_bytes, counts.tiles);
        assert_int_equal(after.header.record_count, before.header.record_count);
        assert_int_equal(after.db.target_count, 1);
        assert_int_equal(after.targets[0].id, 7);
        assert_string_equal(after.header.title, "of version two");
        assert_int_equal(after.header.centre_latitude, before.header.centre_latitude);
        assert_int_equal(after.header.mean_elevation_m_q6, before.header.mean_elevation_m_q6);
        for (uint32_t k = 0; k < before.header.entry_count; k++) {
            const struct lm_tile *a = image_entry_tile(&before, k);
            const struct lm_tile *b = image_entry_tile(&after, k);
            assert_int_equal(a == NULL, b == NULL);
            if (a) {
                assert_same_tile(a, b);
            }
        }
        image_close(&after);
        free(old.bytes);
        tiny_image_free(&tiny);
    }
}

TEST(its_manifest_tells_the_old_checksums_from_the_new)
{
    /* Of the image that the test before has left. */
    assert_int_equal(scene_run("inspect %s", scene_path("new.lmdb")), 0);
    assert_true(scene_log_holds("builder: test_convert"));
    assert_true(scene_log_holds("version-2-section-sha256: TILES 0123"));
    assert_true(scene_log_holds("converted: from version 2 by landmass-db convert"));
}

static void expect_refusal(const char *name, int exit_code, const char *message)
{
    assert_int_equal(scene_run("convert %s %s", scene_path(name), scene_path("out.lmdb")),
                     exit_code);
    assert_true(scene_log_holds(message));
    assert_int_equal(support_run("ls -A %s | grep -q -e out.lmdb -e unfinished", scene_folder()),
                     1);
}

static void expect_flip_refused(const struct old_image *old, size_t at)
{
    old->bytes[at] ^= 4;
    write_bytes("bad.lmdb", old->bytes, old->size);
    old->bytes[at] ^= 4;
    assert_int_equal(scene_run("convert %s %s", scene_path("bad.lmdb"), scene_path("out.lmdb")), 1);
    assert_int_equal(access(scene_path("out.lmdb"), F_OK), -1);
}

TEST(every_program_names_the_remedy_and_a_bad_image_is_refused)
{
    struct tiny_image tiny;
    struct image image;
    open_tiny(&tiny, &image, 46, 11);
    const struct old_image old = old_image_of(&image);
    write_bytes("old.lmdb", old.bytes, old.size);
    static const char *const commands[] = {
        "inspect %s", "verify %s", "picture %s --plane class --out /tmp/landmass-never.png"};
    for (int i = 0; i < 3; i++) {
        char line[600];
        snprintf(line, sizeof line, commands[i], scene_path("old.lmdb"));
        assert_int_equal(scene_run("%s", line), 1);
        assert_true(scene_log_holds("`landmass-db convert OLD NEW`"));
    }
    write_bytes("tiny.lmdb", tiny.bytes, tiny.size);
    expect_refusal("tiny.lmdb", 1, "is an image of version 3 already");
    for (size_t at = 9; at < HEADER; at += 31) {
        expect_flip_refused(&old, at);
    }
    for (int i = 0; i < SECTION_COUNT; i++) {
        expect_flip_refused(&old, old.at[i]);
        expect_flip_refused(&old, old.at[i] + old.length[i] / 2);
        expect_flip_refused(&old, old.at[i] + old.length[i] - 1);
    }
    write_bytes("bad.lmdb", old.bytes, old.size - 64);
    expect_refusal("bad.lmdb", 1, "out of its range");
    put(old.bytes + 64 + 24 * 3 + 8, old.size, 8); /* TILES behind the end */
    put(old.bytes + CRC_AT, fx_crc32c(0, old.bytes, CRC_AT), 4);
    write_bytes("bad.lmdb", old.bytes, old.size);
    expect_refusal("bad.lmdb", 1, "does not lie inside it");
    assert_int_equal(scene_run("convert %s", scene_path("old.lmdb")), 2);
    assert_int_equal(scene_run("convert %s %s", scene_path("old.lmdb"), scene_path("old.lmdb")), 1);
    assert_int_equal(scene_run("convert --help"), 0);
    assert_true(scene_log_holds("built again from the sources"));
    free(old.bytes);
    tiny_image_free(&tiny);
}

static int tidy(void **state)
{
    (void)state;
    return support_run("rm -rf %s", scene_folder());
}

TEST_GROUP(NULL, tidy);
