/* The grid of the geoid: judged, and read at every place, by the firmware and by the reference. */
#include "check.h"
#include "fx/crc32c.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/db.h"
#include "lm/geoid.h"
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
    g = plane(-90, 0, 27, 33, 33); /* once round the Earth */
    assert_false(lm_geoid_is_sound(&g));
}

static void build(struct tiny_image *image)
{
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    assert_int_equal(tiny_image_build(image, &spec), 0);
}

/* The tiny image with a section more: behind the others, in the next free entry of the header. */
static uint8_t *with_section(const struct tiny_image *tiny, const void *bytes, uint64_t length,
                             size_t *size)
{
    const uint64_t at = (tiny->size + 63) / 64 * 64;
    uint8_t *image = calloc(1, at + length);
    assert_non_null(image);
    memcpy(image, tiny->bytes, tiny->size);
    memcpy(image + at, bytes, length);
    struct lm_image_header h;
    memcpy(&h, image, sizeof h);
    h.sections[h.section_count++] =
        (struct lm_image_section){LM_IMAGE_GEOID, fx_crc32c(0, bytes, length), at, length};
    h.image_bytes = at + length;
    h.crc = fx_crc32c(0, &h, sizeof h - sizeof h.crc);
    memcpy(image, &h, sizeof h);
    *size = at + length;
    return image;
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
