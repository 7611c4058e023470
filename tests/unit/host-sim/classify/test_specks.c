/* What a sieve took out of its class takes the one beside it that it looks like: against classes
 * that are known, against a search written another way, and cut into blocks. */
#include "check.h"
#include "classify/specks.h"
#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30, BANDS = 3, PIXELS = WIDTH * HEIGHT };
enum { ROAD, FIELD, ROOF, WOOD, CLASSES };

static const float spectra[CLASSES][BANDS] = {
    {200, 210, 190}, {100, 400, 120}, {600, 500, 450}, {60, 250, 70}};
static float scale[BANDS] = {200, 100, 200};
static const struct db_net net = {.band_count = BANDS, .scale = scale};
static const bool none_spared[DB_CLASS_MAX] = {false};

struct scene {
    float planes[BANDS * PIXELS];
    uint8_t before[PIXELS], after[PIXELS], out[PIXELS];
};

static void put(struct scene *s, int x, int y, int c, int look, double share)
{
    for (int i = 0; i < BANDS; i++) {
        s->planes[i * PIXELS + y * WIDTH + x] =
            (float)(share * (double)spectra[look][i] + (1 - share) * (double)spectra[FIELD][i]);
    }
    s->before[y * WIDTH + x] = s->after[y * WIDTH + x] = (uint8_t)c;
}

static uint64_t settle(struct scene *s, const bool *is_spared)
{
    const struct db_specks_block b = {s->planes, s->before, s->after, WIDTH, HEIGHT, 0, HEIGHT};
    return db_specks_settle(&net, is_spared, &b, s->out);
}

/* A road of one pixel through fields. Every fifth of its pixels is taken for a roof, and half of
 * those hold a tenth of road only. GDAL gives all of them to the field, the largest neighbour. */
static void draw_road(struct scene *s)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const bool is_road = y == 12 + x / 8, is_wrong = is_road && x % 5 == 2;
            put(s, x, y, is_road ? ROAD : FIELD, ROAD, !is_road ? 0 : x % 10 == 2 ? 0.1 : 0.8);
            if (is_wrong) {
                s->before[y * WIDTH + x] = ROOF;
                s->after[y * WIDTH + x] = FIELD;
            }
        }
    }
}

TEST(a_wrong_pixel_of_a_road_becomes_road_and_one_that_is_field_becomes_field)
{
    static struct scene s;
    draw_road(&s);
    assert_int_equal(settle(&s, none_spared), WIDTH / 5);
    for (int at = 0; at < PIXELS; at++) {
        const int x = at % WIDTH;
        assert_int_equal(s.out[at], s.before[at] != ROOF ? s.before[at]
                                    : x % 10 == 2        ? FIELD
                                                         : ROAD);
    }
}

TEST(specks_that_are_spared_stay_and_count_as_what_they_are)
{
    static struct scene s;
    const bool is_spared[DB_CLASS_MAX] = {[ROOF] = true};
    draw_road(&s);
    assert_int_equal(settle(&s, is_spared), 0);
    assert_memory_equal(s.out, s.before, PIXELS);
    /* A speck beside a spared roof, and like it, becomes roof. */
    put(&s, 3, 12, WOOD, ROOF, 1);
    put(&s, 2, 12, ROOF, ROOF, 1);
    s.after[12 * WIDTH + 2] = s.after[12 * WIDTH + 3] = FIELD;
    assert_int_equal(settle(&s, is_spared), 1);
    assert_int_equal(s.out[12 * WIDTH + 3], ROOF);
}

TEST(a_speck_among_specks_and_holes_has_what_the_sieve_gave_it)
{
    static struct scene s;
    draw_road(&s);
    for (int k = 0; k < 9; k++) {
        const int at = (20 + k / 3) * WIDTH + 20 + k % 3;
        s.before[at] = k == 4 ? WOOD : k == 0 ? DB_CLASS_NODATA : ROOF;
        s.after[at] = k == 0 ? DB_CLASS_NODATA : k == 4 ? ROAD : FIELD;
    }
    settle(&s, none_spared);
    assert_int_equal(s.out[21 * WIDTH + 21], ROAD);
    assert_int_equal(s.out[20 * WIDTH + 20], DB_CLASS_NODATA);
    assert_int_equal(s.out[20 * WIDTH + 21], FIELD);
}

/* Everything at random, and holes. */
static void draw_noise(struct scene *s)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 9);
    for (int at = 0; at < PIXELS; at++) {
        put(s, at % WIDTH, at / WIDTH, (int)hs_rng_below(&rng, CLASSES),
            (int)hs_rng_below(&rng, CLASSES), hs_rng_uniform(&rng));
        if (hs_rng_below(&rng, 3) == 0) {
            s->after[at] = (uint8_t)hs_rng_below(&rng, CLASSES);
        }
        if (hs_rng_below(&rng, 40) == 0) {
            s->before[at] = s->after[at] = DB_CLASS_NODATA;
            s->planes[at] = NAN;
        }
    }
}

/* True if a pixel of the class is there, and no speck. */
static bool is_of(const struct scene *s, int x, int y, int c)
{
    const int at = y * WIDTH + x;
    return x >= 0 && y >= 0 && x < WIDTH && y < HEIGHT && s->before[at] == c && s->after[at] == c;
}

/* Squared distance of the pixel from the mean of a class that is beside it; infinite if none is. */
static double distance(const struct scene *s, int x, int y, int c)
{
    double sums[BANDS] = {0}, squared = 0;
    int count = 0, beside = 0;
    for (int k = 0; k < 25; k++) {
        const int u = x + k % 5 - 2, v = y + k / 5 - 2;
        const bool is_one = is_of(s, u, v, c);
        count += is_one;
        beside += is_one && abs(u - x) < 2 && abs(v - y) < 2;
        for (int i = 0; is_one && i < BANDS; i++) {
            sums[i] += (double)s->planes[i * PIXELS + v * WIDTH + u];
        }
    }
    for (int i = 0; beside && i < BANDS; i++) {
        squared += pow(((double)s->planes[i * PIXELS + y * WIDTH + x] - sums[i] / count) /
                           (double)scale[i],
                       2);
    }
    return beside ? squared : INFINITY;
}

TEST(the_answer_is_the_nearest_class_of_those_beside)
{
    static struct scene s;
    draw_noise(&s);
    const uint64_t changed = settle(&s, none_spared);
    uint64_t differ = 0;
    for (int at = 0; at < PIXELS; at++) {
        const int x = at % WIDTH, y = at / WIDTH;
        int nearest = s.before[at] == s.after[at] ? s.before[at] : -1;
        for (int c = 0; s.before[at] != s.after[at] && c < CLASSES; c++) {
            const double d = distance(&s, x, y, c);
            if (d < INFINITY && (nearest < 0 || d < distance(&s, x, y, nearest))) {
                nearest = c;
            }
        }
        assert_int_equal(s.out[at], nearest < 0 ? s.after[at] : nearest);
        differ += s.out[at] != s.before[at];
    }
    assert_int_equal(changed, differ);
    assert_in_range(differ, PIXELS / 8, PIXELS / 3);
}

/* Some rows of the scene by themselves. */
static void settle_part(const struct scene *s, int y, int count, uint8_t *out)
{
    static float planes[BANDS * PIXELS];
    const int top = y > DB_SPECKS_HALO ? y - DB_SPECKS_HALO : 0;
    const int end = y + count + DB_SPECKS_HALO;
    const int rows = (end < HEIGHT ? end : HEIGHT) - top;
    for (size_t i = 0; i < BANDS; i++) {
        memcpy(planes + i * (size_t)(rows * WIDTH), s->planes + i * PIXELS + top * WIDTH,
               (size_t)(rows * WIDTH) * sizeof *planes);
    }
    const struct db_specks_block b = {
        planes, s->before + top * WIDTH, s->after + top * WIDTH, WIDTH, rows, y - top, count};
    db_specks_settle(&net, none_spared, &b, out);
}

TEST(however_the_image_is_cut_the_bytes_are_the_same)
{
    static struct scene s;
    static uint8_t parts[PIXELS];
    draw_noise(&s);
    settle(&s, none_spared);
    for (int rows = 1; rows <= HEIGHT; rows++) {
        memset(parts, 99, sizeof parts);
        for (int y = 0; y < HEIGHT; y += rows) {
            settle_part(&s, y, y + rows < HEIGHT ? rows : HEIGHT - y, parts + y * WIDTH);
        }
        assert_memory_equal(parts, s.out, PIXELS);
    }
}
