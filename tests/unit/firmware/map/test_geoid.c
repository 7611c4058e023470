/* The grid of the geoid: judged, and read at every place, by the firmware and by the reference. */
#include "check.h"
#include "fx/crc32c.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/db.h"
#include "lm/geoid_reader.h"
#include "lm/image.h"
#include "memory_flash.h"
#include "reference/reference.h"
#include "tiny_image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A plane of 10 m at the south-west, rising by 1 m a row and 2 m a column. */
static struct lm_geoid plane(double south_deg, double west_deg, uint8_t shift, uint8_t rows,
                             uint8_t columns)
{
    struct lm_geoid g = {.south = hs_bam(south_deg),
                         .west = hs_bam(west_deg),
                         .latitude_shift = shift,
                         .longitude_shift = shift,
                         .rows = rows,
                         .columns = columns};
    for (int r = 0; r < rows; r++) {
        for (int c = 0; c < columns; c++) {
            g.height_m_q6[r][c] = (int16_t)(64 * (10 + r + 2 * c));
        }
    }
    return g;
}

static double height_at(const struct lm_geoid *g, uint32_t latitude, uint32_t longitude)
{
    return lm_geoid_height_m_q6(g, (struct lm_position){latitude, longitude}) / 64.0;
}

TEST(a_plane_is_read_as_the_plane_it_is)
{
    const struct lm_geoid g = plane(40, 170, 22, 20, 33);
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    assert_true(lm_geoid_is_sound(&g));
    for (int i = 0; i < 10000; i++) {
        const uint32_t north = hs_rng_below(&rng, (19u << 22) + 1);
        const uint32_t east = hs_rng_below(&rng, (32u << 22) + 1);
        const double wanted = 10 + ldexp(north, -22) + 2 * ldexp(east, -22);
        /* Two divisions rounded down, after steps cut to 2^-15. */
        assert_true(fabs(height_at(&g, g.south + north, g.west + east) - wanted) <= 2.1 / 64);
    }
    assert_true(height_at(&g, g.south + (19u << 22), g.west + (32u << 22)) == 10 + 19 + 64);
}

TEST(beyond_the_grid_the_nearest_edge_counts_round_the_earth_too)
{
    const struct lm_geoid g = plane(40, 170, 22, 20, 33); /* to 46.7 north, 178.75 west */
    assert_true(height_at(&g, hs_bam(-90), g.west) == 10);
    assert_true(height_at(&g, hs_bam(90), g.west) == 10 + 19);
    assert_true(height_at(&g, g.south, hs_bam(169.9)) == 10);
    assert_true(height_at(&g, g.south, hs_bam(-178)) == 10 + 64);
    assert_true(height_at(&g, g.south, hs_bam(-10)) == 10 + 64);
    assert_true(height_at(&g, g.south, hs_bam(0)) == 10);
}

TEST(numbers_out_of_their_range_are_refused)
{
    const struct lm_geoid good = plane(40, 7, 20, 5, 5);
    assert_true(lm_geoid_is_sound(&good));
    for (int field = 8; field <= 11; field++) { /* shifts, rows, columns */
        int sound = 0;
        for (int value = 0; value < 256; value++) {
            struct lm_geoid g = good;
            ((uint8_t *)&g)[field] = (uint8_t)value;
            sound += lm_geoid_is_sound(&g);
        }
        assert_int_equal(sound, field < 10 ? 12 : 32);
    }
    struct lm_geoid g = good;
    g.south = hs_bam(91);
    assert_false(lm_geoid_is_sound(&g));
    g.south = hs_bam(-91);
    assert_false(lm_geoid_is_sound(&g));
    g = plane(-90, 0, 27, 33, 2); /* once round the Earth */
    assert_false(lm_geoid_is_sound(&g));
    g = plane(-90, 0, 27, 2, 33);
    assert_false(lm_geoid_is_sound(&g));
    g = plane(-90, 0, 27, 2, 32);
    assert_true(lm_geoid_is_sound(&g));
}

static void build(struct tiny_image *image)
{
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    assert_int_equal(tiny_image_build(image, &spec), 0);
}

/* The tiny image with a section more: behind the others, in the next free entry of the header. */
static uint8_t *with_section_of(uint32_t type, const struct tiny_image *tiny, const void *bytes,
                                uint64_t length, size_t *size)
{
    const uint64_t at = (tiny->size + 63) / 64 * 64;
    uint8_t *image = calloc(1, at + length);
    assert_non_null(image);
    memcpy(image, tiny->bytes, tiny->size);
    memcpy(image + at, bytes, length);
    struct lm_image_header h;
    memcpy(&h, image, sizeof h);
    h.sections[h.section_count++] =
        (struct lm_image_section){type, fx_crc32c(0, bytes, length), at, length};
    h.image_bytes = at + length;
    h.crc = fx_crc32c(0, &h, sizeof h - sizeof h.crc);
    memcpy(image, &h, sizeof h);
    *size = at + length;
    return image;
}

static uint8_t *with_section(const struct tiny_image *tiny, const void *bytes, uint64_t length,
                             size_t *size)
{
    return with_section_of(LM_IMAGE_GEOID, tiny, bytes, length, size);
}

static int open_with(struct lm_db *db, struct memory_flash *flash, const struct tiny_image *tiny,
                     const void *bytes, uint64_t length)
{
    size_t size;
    uint8_t *image = with_section(tiny, bytes, length, &size);
    memory_flash_open(flash, image, size);
    const int status = lm_db_open(db, &flash->port, 100);
    free(image);
    return status;
}

TEST(an_image_with_a_grid_is_opened_and_a_bad_grid_refused)
{
    struct tiny_image tiny;
    struct lm_db db;
    struct memory_flash flash;
    build(&tiny);
    struct lm_geoid g = plane(40, 7, 20, 5, 5);
    assert_int_equal(open_with(&db, &flash, &tiny, &g, sizeof g), LM_OK);
    assert_int_equal(db.geoid.rows, 5);
    assert_int_equal(open_with(&db, &flash, &tiny, &g, sizeof g - 64), LM_ERR_CORRUPT);
    g.rows = 34;
    assert_int_equal(open_with(&db, &flash, &tiny, &g, sizeof g), LM_ERR_CORRUPT);
    tiny_image_free(&tiny);
}

TEST(the_reference_reads_the_same_grid)
{
    struct tiny_image tiny;
    struct ref_db ref;
    struct hs_rng rng;
    size_t size;
    build(&tiny);
    hs_rng_seed(&rng, 9);
    struct lm_geoid g = plane(-20, 175, 24, 17, 9);
    for (int i = 0; i < 17 * 9; i++) {
        g.height_m_q6[i / 9][i % 9] = (int16_t)((int)hs_rng_below(&rng, 12000) - 6000);
    }
    uint8_t *image = with_section(&tiny, &g, sizeof g, &size);
    assert_int_equal(ref_db_open_memory(&ref, image, size, "image"), 0);
    for (int i = 0; i < 20000; i++) {
        const uint32_t latitude = hs_rng_below(&rng, 1u << 31) - (1u << 30);
        const uint32_t longitude = (uint32_t)hs_rng_u64(&rng);
        const struct ref_place place = {hs_degrees(latitude), hs_degrees(longitude)};
        assert_true(fabs(height_at(&g, latitude, longitude) - ref_db_geoid_m(&ref, place)) < 0.05);
    }
    ref_db_close(&ref);
    free(image);
    tiny_image_free(&tiny);
}

/* ---- pages ---- */

enum { PAGE_SHIFT = 20, SIDE_LOG2 = 25, ROWS = 3, COLUMNS = 4, SLOTS = 24, POLLS = 100 };

/* Three rows of four pages about 46 N and the antimeridian. */
struct pages {
    struct lm_geoid_pages_head head;
    struct lm_geoid page[ROWS * COLUMNS];
};

/* A surface that is continuous across pages and round the Earth. */
static double waves_m(double latitude_deg, double longitude_deg)
{
    const double radian = 3.14159265358979 / 180;
    return 60 * sin(9 * latitude_deg * radian) * cos(8 * longitude_deg * radian);
}

static void seal_page(struct lm_geoid *page)
{
    page->crc = fx_crc32c(0, page, offsetof(struct lm_geoid, crc));
}

static void seal_head(struct lm_geoid_pages_head *h)
{
    h->crc = fx_crc32c(0, h, offsetof(struct lm_geoid_pages_head, crc));
}

static struct pages *make_pages(void)
{
    struct pages *p = calloc(1, sizeof *p);
    const uint32_t row0 = (hs_bam(46) + (1u << 30)) >> SIDE_LOG2, round = 1u << (32 - SIDE_LOG2);
    p->head = (struct lm_geoid_pages_head){.shift = PAGE_SHIFT,
                                           .row0 = row0,
                                           .rows = ROWS,
                                           .column0 = round / 2 - 2,
                                           .columns = COLUMNS};
    seal_head(&p->head);
    for (uint32_t i = 0; i < ROWS * COLUMNS; i++) {
        struct lm_geoid *g = &p->page[i];
        *g = (struct lm_geoid){.south = ((row0 + i / COLUMNS) << SIDE_LOG2) - (1u << 30),
                               .west = (p->head.column0 + i % COLUMNS) << SIDE_LOG2,
                               .latitude_shift = PAGE_SHIFT,
                               .longitude_shift = PAGE_SHIFT,
                               .rows = 33,
                               .columns = 33};
        for (uint32_t k = 0; k < 33 * 33; k++) {
            const uint32_t latitude = g->south + ((k / 33) << PAGE_SHIFT);
            const uint32_t longitude = g->west + ((k % 33) << PAGE_SHIFT);
            g->height_m_q6[k / 33][k % 33] =
                (int16_t)lround(64 * waves_m(hs_degrees(latitude), hs_degrees(longitude)));
        }
        seal_page(g);
    }
    return p;
}

struct paged {
    struct tiny_image tiny;
    struct pages *pages;
    uint8_t *image;
    size_t size;
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_geoid_reader reader;
    struct lm_tile pool[SLOTS];
};

static struct paged *open_paged(void (*spoil)(struct pages *))
{
    struct paged *p = calloc(1, sizeof *p);
    build(&p->tiny);
    p->pages = make_pages();
    if (spoil) {
        spoil(p->pages);
    }
    p->image =
        with_section_of(LM_IMAGE_GEOID_PAGES, &p->tiny, p->pages, sizeof *p->pages, &p->size);
    memory_flash_open(&p->flash, p->image, p->size);
    assert_int_equal(lm_db_open(&p->db, &p->flash.port, POLLS), LM_OK);
    assert_int_equal(lm_tile_cache_init(&p->tiles, &p->db, p->pool, sizeof p->pool, POLLS), LM_OK);
    return p;
}

static void close_paged(struct paged *p)
{
    tiny_image_free(&p->tiny);
    free(p->pages);
    free(p->image);
    free(p);
}

static double fly_to(struct paged *p, struct lm_position place)
{
    for (int i = 0; i < 10; i++) {
        lm_geoid_reader_service(&p->reader, &p->tiles, &p->db, place);
        lm_tile_cache_service(&p->tiles, 0, 4);
    }
    return lm_geoid_reader_height_m_q6(&p->reader, &p->db, place) / 64.0;
}

TEST(a_page_is_read_where_the_aircraft_is_on_both_sides_of_the_antimeridian)
{
    struct paged *p = open_paged(NULL);
    struct ref_db ref;
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    assert_int_equal(ref_db_open_memory(&ref, p->image, p->size, "image"), 0);
    for (int i = 0; i < 3000; i++) {
        const struct lm_geoid *south_west = &p->pages->page[0];
        const struct lm_position place = {south_west->south + hs_rng_below(&rng, ROWS << SIDE_LOG2),
                                          south_west->west +
                                              hs_rng_below(&rng, COLUMNS << SIDE_LOG2)};
        const struct ref_place there = {hs_degrees(place.latitude), hs_degrees(place.longitude)};
        const double height_m = fly_to(p, place);
        assert_true(fabs(height_m - waves_m(there.latitude_deg, there.longitude_deg)) < 0.1);
        assert_true(fabs(height_m - ref_db_geoid_m(&ref, there)) < 0.05);
    }
    assert_int_equal(p->reader.corrupt, 0);
    ref_db_close(&ref);
    close_paged(p);
}

TEST(until_a_page_is_there_and_where_there_is_none_the_image_s_height_counts)
{
    struct paged *p = open_paged(NULL);
    const struct lm_position on = {p->pages->page[5].south + 7, p->pages->page[5].west + 9};
    p->db.geoid_m_q6 = 48 * 64;
    assert_int_equal(lm_geoid_reader_height_m_q6(&p->reader, &p->db, on), 48 * 64);
    lm_geoid_reader_service(&p->reader, &p->tiles, &p->db, on);
    assert_int_equal(lm_geoid_reader_height_m_q6(&p->reader, &p->db, on), 48 * 64);
    assert_true(fly_to(p, on) != 48);
    assert_true(fly_to(p, (struct lm_position){on.latitude, 0}) == 48);
    assert_true(fly_to(p, (struct lm_position){0, on.longitude}) == 48);
    assert_true(fly_to(p, (struct lm_position){FX_BAM_90, on.longitude}) == 48);
    const uint32_t reads = p->flash.reads;
    assert_true(fly_to(p, on) != 48); /* it is still in memory */
    assert_int_equal(p->flash.reads, reads);
    close_paged(p);
}

static void exchange_two(struct pages *p)
{
    const struct lm_geoid first = p->page[5];
    p->page[5] = p->page[6];
    p->page[6] = first;
}

static void flip_a_bit(struct pages *p)
{
    p->page[5].height_m_q6[3][4] ^= 1;
}

static void shorten(struct pages *p)
{
    p->page[5].rows = 20;
    seal_page(&p->page[5]);
}

static void lengthen(struct pages *p)
{
    p->page[5].rows = LM_GEOID_NODES_MAX + 1;
    seal_page(&p->page[5]);
}

static void narrow(struct pages *p)
{
    p->page[5].columns = 20;
    seal_page(&p->page[5]);
}

static void flatten(struct pages *p)
{
    p->page[5].latitude_shift--;
    seal_page(&p->page[5]);
}

static void squeeze(struct pages *p)
{
    p->page[5].longitude_shift--;
    seal_page(&p->page[5]);
}

static void move_north(struct pages *p)
{
    p->page[5].south++;
    seal_page(&p->page[5]);
}

static void move_east(struct pages *p)
{
    p->page[5].west++;
    seal_page(&p->page[5]);
}

TEST(a_page_that_is_damaged_or_another_is_counted_once_and_not_used)
{
    void (*const spoils[])(struct pages *) = {exchange_two, flip_a_bit, shorten,
                                              lengthen,     narrow,     flatten,
                                              squeeze,      move_north, move_east};
    for (size_t i = 0; i < sizeof spoils / sizeof *spoils; i++) {
        struct paged *p = open_paged(spoils[i]);
        const struct lm_position on = {p->pages->page[4].south + 7,
                                       p->pages->page[4].west + (1u << SIDE_LOG2) + 9};
        p->db.geoid_m_q6 = 48 * 64;
        assert_true(fly_to(p, on) == 48);
        assert_true(fly_to(p, on) == 48);
        assert_int_equal(p->reader.corrupt, 1);
        close_paged(p);
    }
}

TEST(after_a_damaged_page_each_other_one_is_read)
{
    struct paged *p = open_paged(flip_a_bit);
    p->db.geoid_m_q6 = 48 * 64;
    for (uint32_t i = 0; i < ROWS * COLUMNS; i++) {
        const struct lm_geoid *page = &p->pages->page[i];
        const struct lm_position place = {page->south + 7, page->west + 9};
        const double wanted_m = waves_m(hs_degrees(place.latitude), hs_degrees(place.longitude));
        const struct lm_position damaged = {p->pages->page[5].south + 7,
                                            p->pages->page[5].west + 9};
        assert_true(fly_to(p, damaged) == 48);
        assert_true(i == 5 || fabs(fly_to(p, place) - wanted_m) < 0.1);
    }
    close_paged(p);
}

static struct lm_position in_page_5(const struct paged *p)
{
    return (struct lm_position){p->pages->page[5].south + 7, p->pages->page[5].west + 9};
}

TEST(a_page_that_the_flash_does_not_give_is_not_damaged_and_not_used)
{
    struct paged *p = open_paged(NULL);
    p->db.geoid_m_q6 = 48 * 64;
    p->flash.fail_read = p->flash.reads + 1;
    assert_true(fly_to(p, in_page_5(p)) == 48);
    assert_int_equal(p->reader.corrupt, 0);
    assert_int_equal(p->tiles.count.io_errors, 1);
    close_paged(p);
}

TEST(a_page_waits_while_another_part_reads_the_flash)
{
    struct paged *p = open_paged(NULL);
    uint8_t header[64];
    struct lm_flash_request other = {.destination = header, .length = sizeof header};
    p->db.geoid_m_q6 = 48 * 64;
    assert_true(lm_tile_cache_read(&p->tiles, &other));
    lm_geoid_reader_service(&p->reader, &p->tiles, &p->db, in_page_5(p));
    assert_int_equal(p->reader.reading, 0);
    assert_true(fly_to(p, in_page_5(p)) != 48);
    assert_int_equal(other.status, LM_OK);
    close_paged(p);
}

TEST(a_page_of_another_image_is_not_used)
{
    struct paged *p = open_paged(NULL);
    p->db.geoid_m_q6 = 48 * 64;
    assert_true(fly_to(p, in_page_5(p)) != 48);
    const struct lm_db other = p->db;
    assert_int_equal(lm_geoid_reader_height_m_q6(&p->reader, &other, in_page_5(p)), 48 * 64);
    close_paged(p);
}

TEST(an_image_with_a_head_of_pages_that_cannot_be_is_refused)
{
    struct tiny_image tiny;
    struct memory_flash flash;
    struct lm_db db;
    struct pages *pages = make_pages();
    pages->head.rows++;
    seal_head(&pages->head);
    size_t size;
    build(&tiny);
    uint8_t *image = with_section_of(LM_IMAGE_GEOID_PAGES, &tiny, pages, sizeof *pages, &size);
    memory_flash_open(&flash, image, size);
    assert_int_equal(lm_db_open(&db, &flash.port, POLLS), LM_ERR_CORRUPT);
    free(image);
    free(pages);
    tiny_image_free(&tiny);
}

TEST(a_head_of_pages_that_cannot_be_is_refused)
{
    const struct lm_geoid_pages_head good = {
        .shift = 23, .row0 = 1, .rows = 7, .column0 = 15, .columns = 16};
    const uint64_t bytes = 64 + 7 * 16 * 2240;
    assert_true(lm_geoid_pages_are_sound(&good, bytes));
    assert_false(lm_geoid_pages_are_sound(&good, bytes - 2240));
    for (int field = 0; field < 5; field++) {
        static const uint32_t bad[5][4] = {{0, 15, 27, UINT32_MAX},
                                           {2, 8, UINT32_MAX, 1u << 31},
                                           {0, 8, 9, UINT32_MAX},
                                           {16, 17, 99, UINT32_MAX},
                                           {0, 17, 32, UINT32_MAX}};
        for (int i = 0; i < 4; i++) {
            struct lm_geoid_pages_head h = good;
            memcpy((uint8_t *)&h + 4 * field, &bad[field][i], 4);
            assert_false(lm_geoid_pages_are_sound(&h, 64 + (uint64_t)h.rows * h.columns * 2240));
        }
    }
}

static void raise_all(struct pages *p)
{
    for (uint32_t i = 0; i < ROWS * COLUMNS; i++) {
        for (uint32_t k = 0; k < 33 * 33; k++) {
            p->page[i].height_m_q6[k / 33][k % 33] =
                (int16_t)(p->page[i].height_m_q6[k / 33][k % 33] + 10 * 64);
        }
        seal_page(&p->page[i]);
    }
}

TEST(a_page_of_the_image_before_is_not_taken_for_one_of_the_new_image)
{
    struct paged *before = open_paged(NULL), *now = open_paged(raise_all);
    const struct lm_position on = {before->pages->page[5].south + 7,
                                   before->pages->page[5].west + 9};
    const double height_m = fly_to(before, on);
    now->reader = before->reader;
    assert_true(fabs(fly_to(now, on) - height_m - 10) < 0.1);
    close_paged(before);
    close_paged(now);
}
