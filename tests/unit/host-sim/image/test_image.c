/* The flash image as the database builder writes and checks it: numbers packed into cells and
 * posts, tiles on the Earth, and that no damage passes `landmass-db verify`. The sound images are
 * tests/support/tiny_image's, which was written from docs/FORMATS.md without a look at the builder.
 */
#include "image/codes.h"
#include "image/grid.h"
#include "image/picture.h"
#include "image/reader.h"
#include "image/sha256.h"
#include "image/verify.h"
#include "image/writer.h"

#include "fx/crc32c.h"

#include "check.h"
#include "memory_flash.h"
#include "support.h"
#include "tiny_image.h"

#include "hs/rng.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- SHA-256 ---- */

static void assert_digest(const char *text, size_t repeat, const char *expected)
{
    struct image_sha256 s;
    char digest[IMAGE_SHA256_TEXT];
    image_sha256_begin(&s);
    for (size_t i = 0; i < repeat; i++) {
        image_sha256_add(&s, text, strlen(text));
    }
    image_sha256_end(&s, digest);
    assert_string_equal(digest, expected);
}

TEST(sha256_gives_the_digests_of_fips_180_4)
{
    assert_digest("", 1, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    assert_digest("abc", 1, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    assert_digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", 1,
                  "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    assert_digest("a", 1000000, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

/* ---- cells and posts ---- */

/* Heights of the codes that images had before version 3. */
static const uint16_t heights_dm[16] = {0,   20,  30,  40,  50,  60,  80,  100,
                                        120, 150, 180, 220, 270, 350, 500, 800};

TEST(every_reflectivity_within_the_scale_is_a_quarter_of_a_decibel_off_at_most)
{
    for (int i = -8025; i <= 4775; i++) {
        const double db = i / 100.0;
        assert_true(fabs(image_gamma_db(image_gamma_code(db)) - db) <= 0.25 + 1e-9);
    }
    assert_int_equal(image_gamma_code(-200.0), 0);
    assert_int_equal(image_gamma_code(90.0), 255);
}

TEST(a_height_gets_the_nearest_code)
{
    for (int dm = 0; dm <= 1000; dm++) {
        const uint16_t chosen = heights_dm[image_height_code(heights_dm, dm)];
        for (int i = 0; i < 16; i++) {
            assert_true(abs(chosen - dm) <= abs(heights_dm[i] - dm));
        }
    }
}

/* Field, street, and houses in three facings. */
static struct lm_classes town_classes(void)
{
    struct lm_classes classes = {.entry = {{.name = "field", .kind = LM_KIND_GROUND},
                                           {.name = "house", .kind = LM_KIND_STRUCTURE},
                                           {.name = "street", .kind = LM_KIND_GROUND},
                                           {.name = "house", .kind = LM_KIND_STRUCTURE},
                                           {.name = "house", .kind = LM_KIND_STRUCTURE}}};
    classes.entry[3].facing = 1;
    classes.entry[4].facing = 3;
    memcpy(classes.height_dm, heights_dm, sizeof heights_dm);
    return classes;
}

static double power_of(uint16_t cell)
{
    return pow(10.0, ((cell >> 8) / 2.0 - 80.0) / 10.0);
}

static bool is_house(int k)
{
    return k == 1 || k == 3 || k == 4;
}

/* Votes for a class: of four cells, those of houses count together. */
static int votes_of(const uint16_t four[4], int k)
{
    int votes = 0;
    for (int i = 0; i < 4; i++) {
        const int other = four[i] >> 4 & 15;
        votes += other == k || (is_house(other) && is_house(k));
    }
    return votes;
}

static int own_votes_of(const uint16_t four[4], int k)
{
    int votes = 0;
    for (int i = 0; i < 4; i++) {
        votes += (four[i] >> 4 & 15) == k;
    }
    return votes;
}

/* The rule of FORMATS.md 1.6 again, the plain way. */
static uint16_t mean_of_four(const uint16_t four[4])
{
    int data = 0, houses = 0;
    double power = 0, built = 0, height = 0;
    for (int i = 0; i < 4; i++) {
        const int k = four[i] >> 4 & 15;
        data += k != LM_DB_CLASS_NONE;
        power += k != LM_DB_CLASS_NONE ? power_of(four[i]) : 0;
        built += is_house(k) ? power_of(four[i]) : 0;
        houses += is_house(k);
        height += is_house(k) ? heights_dm[four[i] & 15] : 0;
    }
    if (data == 0) {
        return LM_DB_CLASS_NONE << 4;
    }
    int best = 0;
    for (int k = 1; k < 5; k++) {
        best = votes_of(four, k) > votes_of(four, best) ? k : best;
    }
    if (4 * built > power || is_house(best)) {
        best = 1;
        best = own_votes_of(four, 3) > own_votes_of(four, best) ? 3 : best;
        best = own_votes_of(four, 4) > own_votes_of(four, best) ? 4 : best;
        height /= houses;
    } else {
        height = 0;
        for (int i = 0; i < 4; i++) {
            const bool is_one = (four[i] >> 4 & 15) == best;
            height += is_one ? heights_dm[four[i] & 15] : 0;
        }
        height /= own_votes_of(four, best);
    }
    const double code = floor(2.0 * (10.0 * log10(power / data) + 80.0) + 0.5);
    int nearest = 0;
    for (int i = 0; i < 16; i++) {
        if (fabs(heights_dm[i] - height) < fabs(heights_dm[nearest] - height)) {
            nearest = i;
        }
    }
    return (uint16_t)((int)code << 8 | best << 4 | nearest);
}

TEST(a_coarser_cell_is_the_mean_of_four)
{
    const struct lm_classes classes = town_classes();
    const struct image_reduction halved = {&classes, 2, 8, IMAGE_VOTE_POWER};
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (int trial = 0; trial < 200; trial++) {
        uint16_t fine[16][16], coarse[8][8];
        const uint32_t span = trial % 2 ? 256 : 24; /* of the reflectivities */
        for (int i = 0; i < 256; i++) {
            const uint32_t kind = hs_rng_below(&rng, 5);
            const uint16_t data = (uint16_t)(hs_rng_below(&rng, span) << 8 |
                                             hs_rng_below(&rng, 5) << 4 | hs_rng_below(&rng, 16));
            fine[i / 16][i % 16] = kind == 0 ? IMAGE_CELL_NONE : data;
        }
        image_reduce(&halved, &fine[0][0], 16, &coarse[0][0], 8);
        for (int r = 0; r < 8; r++) {
            for (int c = 0; c < 8; c++) {
                const uint16_t four[4] = {fine[2 * r][2 * c], fine[2 * r][2 * c + 1],
                                          fine[2 * r + 1][2 * c], fine[2 * r + 1][2 * c + 1]};
                assert_int_equal(coarse[r][c], mean_of_four(four));
            }
        }
    }
}

/* Cells that differ in reflectivity alone take a way of their own, without a logarithm. */
TEST(a_mean_of_any_two_reflectivities_has_the_code_of_its_logarithm)
{
    const struct lm_classes classes = town_classes();
    const struct image_reduction halved = {&classes, 2, 1, IMAGE_VOTE_POWER};
    for (int i = 0; i < 3 * 256 * 256; i++) {
        const uint16_t a = image_cell((uint8_t)i, 2, 3), b = image_cell((uint8_t)(i >> 8), 2, 3);
        const int others = i >> 16; /* of `a` besides the first */
        const uint16_t four[4] = {a, others > 0 ? a : b, others > 1 ? a : b, b};
        uint16_t coarse;
        image_reduce(&halved, four, 2, &coarse, 1);
        if (coarse != mean_of_four(four)) {
            fail_msg("%04x %04x", a, b);
        }
    }
}

TEST(a_house_among_streets_wins_its_cell_by_its_power_and_not_by_count)
{
    const struct lm_classes classes = town_classes();
    const uint16_t street = image_cell(image_gamma_code(-30), 2, 0);
    const uint16_t fine[2][2] = {{street, image_cell(image_gamma_code(0), 4, 5)}, {street, street}};
    const enum image_vote votes[] = {IMAGE_VOTE_COUNT, IMAGE_VOTE_POWER};
    const uint16_t expected[] = {image_cell(image_gamma_code(-6), 2, 0),
                                 image_cell(image_gamma_code(-6), 4, 5)};
    for (int i = 0; i < 2; i++) {
        uint16_t coarse;
        const struct image_reduction halved = {&classes, 2, 1, votes[i]};
        image_reduce(&halved, &fine[0][0], 2, &coarse, 1);
        assert_int_equal(coarse, expected[i]);
    }
}

TEST(posts_come_back_within_half_a_step_and_sea_level_exactly)
{
    static int32_t posts[LM_TILE_POSTS][LM_TILE_POSTS];
    static struct lm_tile tile;
    static const int32_t reliefs_m[] = {0, 1, 900, 1023, 1024, 1025, 2500, 9000, 15400};
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (size_t k = 0; k < sizeof reliefs_m / sizeof reliefs_m[0]; k++) {
        const int32_t low = -(int32_t)hs_rng_below(&rng, 400 * 64);
        for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
            posts[i / LM_TILE_POSTS][i % LM_TILE_POSTS] =
                low + (int32_t)hs_rng_below(&rng, (uint32_t)reliefs_m[k] * 64 + 1);
        }
        posts[3][5] = 0;
        posts[64][64] = low + reliefs_m[k] * 64;
        image_posts_encode((const int32_t(*)[LM_TILE_POSTS])posts, &tile);
        assert_in_range(tile.post_shift, 0, LM_TILE_POST_SHIFT_MAX);
        for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
            const int r = i / LM_TILE_POSTS, c = i % LM_TILE_POSTS;
            const int64_t apart = llabs(image_post_q6(&tile, r, c) - posts[r][c]);
            assert_true(2 * apart <= 1 << tile.post_shift);
        }
        assert_true(image_post_q6(&tile, 3, 5) == 0);
    }
}

/* ---- areas ---- */

static struct image_area area_of(double south, double west, double north, double east)
{
    return (struct image_area){image_bam(south), image_bam(north), (uint32_t)image_bam(west),
                               (int64_t)(uint32_t)(image_bam(east) - image_bam(west))};
}

TEST(two_areas_join_the_short_way_round_the_earth)
{
    const struct {
        double west[2], east[2], joined_west, joined_east;
    } cases[] = {
        {{179, -180}, {180, -179}, 179, -179}, /* the antimeridian */
        {{-1, 0}, {0, 1}, -1, 1},              /* Greenwich, where BAM wrap */
        {{-1, -3}, {1, 2}, -3, 2},             /* one inside the other */
        {{170, -20}, {175, -10}, 170, -10},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int order = 0; order < 2; order++) {
            struct image_area a = area_of(10, cases[i].west[order], 11, cases[i].east[order]);
            const struct image_area b =
                area_of(12, cases[i].west[!order], 13, cases[i].east[!order]);
            image_area_add(&a, &b);
            const struct image_area joined =
                area_of(10, cases[i].joined_west, 13, cases[i].joined_east);
            assert_true(a.south == joined.south && a.north == joined.north);
            assert_true(a.west == joined.west && a.width == joined.width);
        }
    }
}

TEST(areas_meet_across_greenwich_and_the_antimeridian)
{
    const struct image_area greenwich = area_of(50, -1, 52, 1),
                            pacific = area_of(50, 179, 52, -179);
    const struct image_area east = area_of(51, 0.5, 53, 3), west = area_of(51, -180, 53, -178);
    assert_true(image_areas_meet(&greenwich, &east) && image_areas_meet(&east, &greenwich));
    assert_true(image_areas_meet(&pacific, &west) && image_areas_meet(&west, &pacific));
    assert_false(image_areas_meet(&greenwich, &west) || image_areas_meet(&pacific, &east));
    const struct image_area north = area_of(60, 0, 61, 1);
    assert_false(image_areas_meet(&greenwich, &north));
}

/* ---- verify ---- */

static double hills_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300.0 + 250.0 * sin(p->east_m / 200.0) * cos(p->north_m / 300.0);
}

static struct tiny_cell patches(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const int k = ((int)floor(p->east_m / 37.0) * 3 + (int)floor(p->north_m / 53.0) * 5) % 6;
    const uint8_t class_index = (uint8_t)(k < 0 ? -k : k);
    const uint8_t height = class_index == TINY_STRUCTURE || class_index == TINY_TREES ? 5 : 0;
    return (struct tiny_cell){-30.0 + 3.0 * class_index, class_index, height};
}

/* Several tiles of two levels, across a zone border. */
static void build_tiny(struct tiny_image *image, double latitude, double longitude, uint8_t rows,
                       uint8_t columns)
{
    struct tiny_spec spec = tiny_spec_at(latitude, longitude);
    spec.rows = rows;
    spec.columns = columns;
    spec.cell = patches;
    spec.elevation_m = hills_m;
    assert_int_equal(tiny_image_build(image, &spec), 0);
}

static uint64_t faults_of(const void *bytes, size_t size)
{
    struct image image;
    struct image_findings findings = {NULL, 0, 0, false, NULL};
    struct image_verify_counts counts;
    image_lend(&image, bytes, size);
    image_verify(&image, &findings, &counts);
    return findings.count;
}

static void print_faults(const void *bytes, size_t size)
{
    struct image image;
    struct image_findings findings = {stdout, 0, 10, false, NULL};
    struct image_verify_counts counts;
    image_lend(&image, bytes, size);
    image_verify(&image, &findings, &counts);
}

TEST(an_image_made_from_formats_md_alone_has_no_faults)
{
    static const double places[][2] = {{46, 11},     {-46, -70},     {0, 0},
                                       {61.875, 20}, {-73.125, 180}, {84.375, 0}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        struct tiny_image tiny;
        build_tiny(&tiny, places[i][0], places[i][1], 3, 4);
        if (faults_of(tiny.bytes, tiny.size) != 0) {
            print_faults(tiny.bytes, tiny.size);
            fail();
        }
        tiny_image_free(&tiny);
    }
}

TEST(a_flipped_bit_anywhere_is_found)
{
    struct tiny_image tiny;
    build_tiny(&tiny, 46, 11, 1, 1);
    const size_t bits = tiny.size * 8;
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    /* Each bit outside the tiles; in them one of about a hundred. */
    const size_t first = tiny.tiles_offset * 8;
    const size_t end = first + (size_t)tiny.record_count * LM_TILE_BYTES * 8;
    size_t flipped = 0;
    for (size_t bit = 0; bit < bits;
         bit += bit >= first && bit < end ? 1 + hs_rng_below(&rng, 200) : 1) {
        tiny.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        if (faults_of(tiny.bytes, tiny.size) == 0) {
            print_message("# byte %zu bit %zu\n", bit / 8, bit % 8);
            fail();
        }
        tiny.bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        flipped++;
    }
    print_message("# %zu of %zu bits flipped\n", flipped, bits);
    assert_int_equal(faults_of(tiny.bytes, tiny.size), 0);
    tiny_image_free(&tiny);
}

TEST(a_cut_or_lengthened_image_is_found)
{
    struct tiny_image tiny;
    build_tiny(&tiny, 46, 11, 1, 1);
    /* A buffer of just the length: a sanitizer sees any step beyond it. */
    for (size_t size = 0; size < tiny.size; size += size < 2048 ? 7 : 1501) {
        uint8_t *cut = malloc(size ? size : 1);
        memcpy(cut, tiny.bytes, size);
        assert_true(faults_of(cut, size) > 0);
        free(cut);
    }
    uint8_t *longer = calloc(1, tiny.size + 64);
    memcpy(longer, tiny.bytes, tiny.size);
    assert_true(faults_of(longer, tiny.size + 64) > 0);
    /* Longer by its own account: sound while what follows the last section is zero. */
    struct lm_image_header *header = (struct lm_image_header *)(void *)longer;
    header->image_bytes += 64;
    header->crc = fx_crc32c(0, header, sizeof *header - sizeof header->crc);
    assert_int_equal(faults_of(longer, tiny.size + 64), 0);
    longer[tiny.size + 63] = 1;
    assert_int_equal(faults_of(longer, tiny.size + 64), 1);
    free(longer);
    tiny_image_free(&tiny);
}

/* Draw everything there is of a damaged image. */
static void look_at(const uint8_t *bytes, size_t size)
{
    struct image image;
    struct image_findings findings = {NULL, 0, 0, false, NULL};
    image_lend(&image, bytes, size);
    if (image_read_tables(&image, &findings) != 0) {
        return;
    }
    for (int plane = 0; plane < IMAGE_PLANES; plane++) {
        struct image_view view = {.plane = (enum image_plane)plane};
        if (image_view_fit(&image, &view, -1, 24) == 0) {
            uint8_t pixels[3 * 24 * 24];
            assert_int_equal(image_view_draw(&image, &view, pixels), 0);
        }
    }
}

/* Damage with its checksums put right again, so that it gets as far as it can. Half of it falls on
 * the tables, where a wrong number does the most. */
TEST(no_damage_makes_the_reader_step_outside_the_image)
{
    struct tiny_image tiny;
    build_tiny(&tiny, 61.875, 179.999, 2, 2);
    uint8_t *sound = malloc(tiny.size);
    memcpy(sound, tiny.bytes, tiny.size);
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    int noticed = 0;
    enum { TRIALS = 3000 };
    for (int trial = 0; trial < TRIALS; trial++) {
        const uint32_t changes = 1 + hs_rng_below(&rng, 4);
        for (uint32_t i = 0; i < changes; i++) {
            const uint32_t span =
                hs_rng_below(&rng, 2) ? (uint32_t)tiny.tiles_offset : (uint32_t)tiny.size;
            const uint32_t at = hs_rng_below(&rng, span);
            static const uint8_t extremes[] = {0, 1, 0x7f, 0x80, 0xff};
            tiny.bytes[at] = hs_rng_below(&rng, 2) ? extremes[hs_rng_below(&rng, 5)]
                                                   : (uint8_t)hs_rng_below(&rng, 256);
        }
        if (trial % 4 != 0) {
            /* Only where the sections still lie: the others keep their wrong checksums. */
            const uint8_t *h = tiny.bytes;
            if (memcmp(h, sound, 64) == 0 && memcmp(h + 64, sound + 64, 768) == 0) {
                tiny_image_seal(&tiny);
            }
        }
        noticed += faults_of(tiny.bytes, tiny.size) > 0;
        look_at(tiny.bytes, tiny.size);
        memcpy(tiny.bytes, sound, tiny.size);
    }
    print_message("# %d of %d damages noticed\n", noticed, TRIALS);
    free(sound);
    tiny_image_free(&tiny);
}

/* Lies that every checksum vouches for. */
struct lie {
    const char *what;
    void (*tell)(struct tiny_image *image);
};

static struct lm_tile *record_of(struct tiny_image *image, uint32_t number)
{
    return (struct lm_tile *)(void *)(image->bytes + image->tiles_offset +
                                      (size_t)number * LM_TILE_BYTES);
}

static struct lm_tile_entry *entry_of(struct tiny_image *image, uint32_t number)
{
    return (struct lm_tile_entry *)(void *)(image->bytes + image->directory_offset) + number;
}

static void say_another_row(struct tiny_image *i)
{
    record_of(i, 0)->row++;
}
static void say_another_zone(struct tiny_image *i)
{
    record_of(i, 0)->zone++;
}
static void swap_two_entries(struct tiny_image *i)
{
    const struct lm_tile_entry first = *entry_of(i, 0);
    *entry_of(i, 0) = *entry_of(i, 1);
    *entry_of(i, 1) = first;
}
static void point_twice(struct tiny_image *i)
{
    *entry_of(i, 0) = *entry_of(i, 1);
}
static void point_beyond(struct tiny_image *i)
{
    entry_of(i, 0)->place = i->record_count * (LM_TILE_BYTES / LM_DB_PLACE_BYTES) - 1;
}
static void lose_a_parent(struct tiny_image *i)
{
    *entry_of(i, i->entry_count - 1) =
        (struct lm_tile_entry){.place = LM_TILE_ABSENT, .detail_place = LM_TILE_ABSENT};
}
static void keep_the_size_of_an_absent_tile(struct tiny_image *i)
{
    entry_of(i, 0)->place = LM_TILE_ABSENT;
}
static void use_an_unknown_encoding(struct tiny_image *i)
{
    entry_of(i, 0)->encoding = 1;
}
static void shorten_a_record(struct tiny_image *i)
{
    entry_of(i, 0)->size--;
}
static void point_to_detail_that_is_not_there(struct tiny_image *i)
{
    entry_of(i, 0)->detail_place = 0;
    entry_of(i, 0)->detail_size = 1;
}
static void miscount_the_records(struct tiny_image *i)
{
    ((struct lm_image_header *)(void *)i->bytes)->record_count--;
}
static void paint_the_border(struct tiny_image *i)
{
    record_of(i, 0)->points[0][7].cell ^= 0x0100;
}
static void lower_the_border(struct tiny_image *i)
{
    /* Of the north-eastern tile: its neighbours to the south and the west are there. */
    for (uint32_t k = 0; k < i->record_count; k++) {
        struct lm_tile *t = record_of(i, k);
        if (t->lod == 0 && t->row > record_of(i, 0)->row && t->column > record_of(i, 0)->column) {
            t->points[0][7].post ^= 0x0100;
        }
    }
}
static void raise_what_is_under(struct tiny_image *i)
{
    record_of(i, 0)->under = 0x5001;
}
static void face_nowhere(struct tiny_image *i)
{
    ((struct lm_classes *)(void *)(i->bytes + i->classes_offset))->entry[0].facing = 9;
}
static void leave_the_top_behind(struct tiny_image *i)
{
    ((struct lm_image_header *)(void *)i->bytes)->top = 1;
}
static void lift_a_corner(struct tiny_image *i)
{
    record_of(i, 0)->points[LM_TILE_POSTS][LM_TILE_POSTS].post ^= 0x0040;
}
static void raise_the_base(struct tiny_image *i)
{
    record_of(i, 0)->base_m_q6 = (1 << 20) + 1;
}
static void widen_the_step(struct tiny_image *i)
{
    record_of(i, 0)->post_shift = LM_TILE_POST_SHIFT_MAX + 1;
}
static void use_an_unknown_class(struct tiny_image *i)
{
    record_of(i, 0)->points[9][9].cell = 0x5090;
}
static void brighten_a_cell(struct tiny_image *i)
{
    record_of(i, 0)->points[9][9].cell += 0x4000;
}
static void fill_a_gap(struct tiny_image *i)
{
    record_of(i, 0)->reserved2[4] = 1;
}
static void overlap_bands(struct tiny_image *i)
{
    struct lm_band *bands = (struct lm_band *)(void *)(i->bytes + i->bands_offset);
    bands[0].entry0 = bands[1].entry0;
}
static void fall_in_the_heights(struct tiny_image *i)
{
    struct lm_classes *c = (struct lm_classes *)(void *)(i->bytes + i->classes_offset);
    c->height_dm[5] = 0;
}
TEST(a_lie_with_right_checksums_is_found)
{
    static const struct lie lies[] = {
        {"a record of another row", say_another_row},
        {"a record of another zone", say_another_zone},
        {"exchanged directory entries", swap_two_entries},
        {"two entries of one record", point_twice},
        {"an entry beyond the records", point_beyond},
        {"a tile without parent", lose_a_parent},
        {"an edge that differs from the neighbour's", lift_a_corner},
        {"a base out of range", raise_the_base},
        {"a step out of range", widen_the_step},
        {"an undescribed class", use_an_unknown_class},
        {"a cell that the level above does not know", brighten_a_cell},
        {"unused bytes", fill_a_gap},
        {"overlapping bands", overlap_bands},
        {"falling heights", fall_in_the_heights},
        {"an absent tile with a size", keep_the_size_of_an_absent_tile},
        {"an unknown encoding", use_an_unknown_encoding},
        {"a short record", shorten_a_record},
        {"detail outside its section", point_to_detail_that_is_not_there},
        {"a wrong number of records", miscount_the_records},
        {"a border cell that is not the neighbour's", paint_the_border},
        {"a border post that is not the neighbour's", lower_the_border},
        {"a cell under structures that has a height", raise_what_is_under},
        {"a facing out of range", face_nowhere},
        {"a top that is not resident whole", leave_the_top_behind},
    };
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        struct tiny_image tiny;
        build_tiny(&tiny, 46, 11, 2, 3);
        lies[i].tell(&tiny);
        tiny_image_seal(&tiny);
        if (faults_of(tiny.bytes, tiny.size) == 0) {
            print_message("# not found: %s\n", lies[i].what);
            fail();
        }
        tiny_image_free(&tiny);
    }
}

/* ---- threads ---- */

/* What verification says of an image, with so many threads. Returns text that the caller frees. */
static char *said_of(const struct tiny_image *tiny, uint32_t threads)
{
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    struct image image;
    struct image_findings findings = {out, 0, 40, false, NULL};
    struct image_verify_counts n;
    image_lend(&image, tiny->bytes, tiny->size);
    const int status = image_verify_with(&image, &findings, &n, threads);
    fprintf(out, "%d: %d faults, %d entries, %d tiles, %d edges, %d children\n", status,
            (int)findings.count, (int)n.entries, (int)n.tiles, (int)n.edges, (int)n.children);
    fclose(out);
    image_close(&image);
    return text;
}

/* Parts have 256 tiles: three parts, levels of 600, 150 and 40 tiles, faults in all of them, and
 * more than are shown. */
TEST(what_is_found_does_not_depend_on_how_many_threads_look)
{
    struct tiny_image tiny;
    struct hs_rng rng;
    build_tiny(&tiny, 46, 11, 20, 30);
    assert_true(tiny.record_count > 2 * 256);
    hs_rng_seed(&rng, 12);
    for (int faults = 0; faults <= 120; faults += 30) {
        for (int i = 0; i < faults && faults > 0; i++) {
            const uint32_t number = (uint32_t)(hs_rng_u64(&rng) % tiny.record_count);
            struct lm_tile *t = record_of(&tiny, number);
            t->points[10 + i % 30][20].cell ^= 0x0100;
            t->points[0][i % 60].post ^= i % 3 == 0 ? 0x40 : 0;
            t->reserved0 = i % 5 == 0;
        }
        tiny_image_seal(&tiny);
        char *alone = said_of(&tiny, 1);
        for (uint32_t threads = 2; threads <= 5; threads++) {
            char *together = said_of(&tiny, threads);
            assert_string_equal(together, alone);
            free(together);
        }
        assert_int_equal(strncmp(alone, "0: 0 faults", 11) == 0, faults == 0);
        free(alone);
    }
    tiny_image_free(&tiny);
}

/* ---- writer ---- */

TEST(a_tile_written_is_a_tile_the_firmware_reads)
{
    char path[512];
    snprintf(path, sizeof path, "%s/tmp/test_image.lmdb", support_build_dir());
    assert_int_equal(support_run("mkdir -p %s/tmp", support_build_dir()), 0);
    static struct lm_tile tile, read_back;
    tile = (struct lm_tile){
        .lod = 0, .zone = 1, .row = image_row_of(12, image_bam(65.0)), .column = 5};
    const struct lm_band band = {
        .lod = 0, .zone = 1, .row0 = tile.row, .rows = 1, .column0 = 4, .columns = 3};
    const struct lm_image_header header = {
        .shift0 = 12, .lod_count = 1, .band_count = 1, .entry_count = 3};
    struct image_writer w;
    unlink(path);
    assert_int_equal(image_writer_begin(&w, path, &header, tiny_classes(), &band), 0);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(image_writer_tile(&w, 1, &tile), 0);
    assert_int_equal(image_writer_end(&w, "key: value\n"), 0);

    struct image image;
    assert_int_equal(image_open(&image, path), 0);
    struct memory_flash flash;
    struct lm_db db;
    memory_flash_open(&flash, image.bytes, image.size_bytes);
    assert_int_equal(lm_db_open(&db, &flash.port, 4), LM_OK);
    assert_int_equal(lm_db_entry(&db, 0, tile.row, 5), 1);
    assert_int_equal(lm_db_entry_check(&db, 1, &image.entries[1]), LM_OK);
    assert_int_equal(image.entries[1].place, 0);
    memcpy(&read_back, image_entry_tile(&image, 1), sizeof read_back);
    assert_int_equal(lm_tile_check(&read_back, 0, tile.row, 5), LM_OK);
    assert_int_equal(lm_db_entry_check(&db, 2, &image.entries[2]), LM_OK);
    assert_true(image.entries[2].place == LM_TILE_ABSENT);
    image_close(&image);
    unlink(path);
}
