/* Pixels across a border between two classes: against shares that are known, and cut into blocks.
 */
#include "check.h"
#include "classify/mixtures.h"
#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 40, HEIGHT = 30, BANDS = 3, PIXELS = WIDTH * HEIGHT };

/* Water, grass, and asphalt that looks nearly like the half of each: it lies 0.05 of their distance
 * off the line between them. The last lies far off. */
enum { WATER, GRASS, ASPHALT, ROOF, CLASSES };

static const float spectra[CLASSES][BANDS] = {
    {100, 50, 20}, {300, 2050, 820}, {200, 1050, 530}, {2000, 2000, 1800}};

struct scene {
    float planes[BANDS * PIXELS];
    uint8_t classes[PIXELS], sure[PIXELS], out[PIXELS];
};

static struct db_mixtures rule(double tolerance)
{
    static float scale[BANDS] = {500, 500, 500};
    const struct db_net net = {.band_count = BANDS, .scale = scale};
    struct db_mixtures m;
    assert_int_equal(db_mixtures_init(&m, &net, tolerance), 0);
    return m;
}

static void put(struct scene *s, int x, int y, int a, int b, double share)
{
    for (int i = 0; i < BANDS; i++) {
        s->planes[i * PIXELS + y * WIDTH + x] =
            (float)(share * (double)spectra[a][i] + (1 - share) * (double)spectra[b][i]);
    }
}

/* What a network would say that has learnt the spectra. */
static void classify(struct scene *s)
{
    for (int at = 0; at < PIXELS; at++) {
        double least = INFINITY;
        for (int c = 0; c < CLASSES; c++) {
            double sum = 0;
            for (int i = 0; i < BANDS; i++) {
                const double d = (double)(s->planes[i * PIXELS + at] - spectra[c][i]);
                sum += d * d;
            }
            if (sum < least) {
                least = sum;
                s->classes[at] = (uint8_t)c;
            }
        }
    }
}

static uint64_t resolve(struct scene *s, double tolerance)
{
    struct db_mixtures m = rule(tolerance);
    const struct db_mixtures_block b = {s->planes, s->classes, s->sure, WIDTH, HEIGHT, 0, HEIGHT};
    const uint64_t changed = db_mixtures_resolve(&m, &b, s->out);
    db_mixtures_free(&m);
    return changed;
}

static double share_of_water(int y)
{
    return 0.05 + 0.9 * y / (HEIGHT - 1);
}

/* Water at the left, grass at the right, and between them a column of every share of both. */
static void draw_bank(struct scene *s)
{
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            put(s, x, y, WATER, GRASS, x < 20 ? 1 : x > 20 ? 0 : share_of_water(y));
        }
    }
    classify(s);
}

TEST(a_pixel_across_a_border_takes_the_class_of_the_larger_share)
{
    static struct scene s;
    draw_bank(&s);
    int asphalt = 0;
    for (int y = 0; y < HEIGHT; y++) {
        asphalt += s.classes[y * WIDTH + 20] == ASPHALT;
    }
    assert_in_range(asphalt, HEIGHT / 3, HEIGHT);
    assert_true(resolve(&s, 0.3) > 0);
    for (int at = 0; at < PIXELS; at++) {
        const int x = at % WIDTH, y = at / WIDTH;
        const int larger = x < 20 || (x == 20 && share_of_water(y) > 0.5) ? WATER : GRASS;
        assert_int_equal(s.out[at], larger);
    }
}

TEST(what_the_network_says_of_two_nearly_equal_shares_stands)
{
    static struct scene s;
    for (int said = WATER; said <= GRASS; said++) {
        draw_bank(&s);
        for (int y = 0; y < HEIGHT; y++) {
            s.classes[y * WIDTH + 20] = y % 2 ? (uint8_t)said : ASPHALT;
        }
        resolve(&s, 0.3);
        for (int y = 1; y < HEIGHT; y += 2) {
            const double needed = said == WATER ? 0.4 : 0.6;
            const int found = s.out[y * WIDTH + 20];
            assert_int_equal(found, share_of_water(y) > needed ? WATER : GRASS);
        }
    }
}

TEST(a_third_class_off_the_line_stays)
{
    static struct scene s;
    draw_bank(&s);
    for (int y = 0; y < HEIGHT; y++) {
        put(&s, 20, y, ROOF, ROOF, 1);
    }
    classify(&s);
    resolve(&s, 0.3);
    for (int y = 0; y < HEIGHT; y++) {
        assert_int_equal(s.out[y * WIDTH + 20], ROOF);
    }
    /* With a tolerance below what asphalt is off the line, even that stays. */
    draw_bank(&s);
    for (int y = 0; y < HEIGHT; y++) {
        put(&s, 20, y, ASPHALT, ASPHALT, 1);
    }
    classify(&s);
    assert_int_equal(resolve(&s, 0.02), 0);
}

TEST(a_line_of_one_pixel_between_two_sides_of_one_class_stays)
{
    static struct scene s;
    draw_bank(&s);
    for (int y = 0; y < HEIGHT; y++) {
        put(&s, 30, y, ASPHALT, ASPHALT, 1);
        put(&s, 10, y, GRASS, GRASS, 1);
    }
    classify(&s);
    resolve(&s, 0.3);
    for (int y = 0; y < HEIGHT; y++) {
        assert_int_equal(s.out[y * WIDTH + 30], ASPHALT);
        assert_int_equal(s.out[y * WIDTH + 10], GRASS);
    }
}

/* Everything at random, and holes. */
static void draw_noise(struct scene *s)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 7);
    for (int at = 0; at < PIXELS; at++) {
        const int a = (int)hs_rng_below(&rng, CLASSES), x = at % WIDTH, y = at / WIDTH;
        const int ground = (x / 9 + y / 8) % CLASSES;
        put(s, x, y, hs_rng_uniform(&rng) < 0.3 ? a : ground, ground, hs_rng_uniform(&rng));
    }
    classify(s);
    for (int i = 0; i < 20; i++) {
        const uint32_t at = hs_rng_below(&rng, PIXELS);
        s->classes[at] = DB_CLASS_NODATA;
        s->planes[at] = NAN;
    }
}

TEST(pixels_without_data_stay_so_and_nothing_is_made_of_them)
{
    static struct scene s;
    draw_noise(&s);
    assert_in_range(resolve(&s, 0.3), PIXELS / 50, PIXELS / 2);
    for (int at = 0; at < PIXELS; at++) {
        assert_int_equal(s.out[at] == DB_CLASS_NODATA, s.classes[at] == DB_CLASS_NODATA);
        assert_true(s.out[at] < CLASSES || s.out[at] == DB_CLASS_NODATA);
    }
}

/* The rows top .. bottom - 1 of the scene by themselves. */
static void resolve_part(const struct scene *s, int y, int count, uint8_t *out)
{
    static float planes[BANDS * PIXELS];
    static uint8_t sure[PIXELS];
    const int top = y > DB_MIXTURES_HALO ? y - DB_MIXTURES_HALO : 0;
    const int end = y + count + DB_MIXTURES_HALO;
    const int rows = (end < HEIGHT ? end : HEIGHT) - top;
    for (size_t i = 0; i < BANDS; i++) {
        memcpy(planes + i * (size_t)(rows * WIDTH), s->planes + i * PIXELS + top * WIDTH,
               (size_t)(rows * WIDTH) * sizeof *planes);
    }
    struct db_mixtures m = rule(0.3);
    const struct db_mixtures_block b = {
        planes, s->classes + top * WIDTH, sure, WIDTH, rows, y - top, count};
    db_mixtures_resolve(&m, &b, out);
    db_mixtures_free(&m);
}

TEST(however_the_image_is_cut_the_bytes_are_the_same)
{
    static struct scene s;
    static uint8_t parts[PIXELS];
    draw_noise(&s);
    resolve(&s, 0.3);
    for (int rows = 1; rows <= HEIGHT; rows++) {
        memset(parts, 99, sizeof parts);
        for (int y = 0; y < HEIGHT; y += rows) {
            resolve_part(&s, y, y + rows < HEIGHT ? rows : HEIGHT - y, parts + y * WIDTH);
        }
        assert_memory_equal(parts, s.out, PIXELS);
    }
}

/* The nearest mixture found by trying all shares of all pairs: no projection, no algebra. */
static int search(const double means[CLASSES][BANDS], const int *counts, const float *pixel,
                  int own, double tolerance)
{
    double least = INFINITY;
    int winner = -1;
    for (int a = 0; a < CLASSES; a++) {
        for (int c = a + 1; counts[a] && c < CLASSES; c++) {
            for (int step = 0; counts[c] && step <= 4000; step++) {
                double away = 0, apart = 0;
                for (int i = 0; i < BANDS; i++) {
                    const double share = step / 4000.0;
                    const double d =
                        (double)pixel[i * PIXELS] - share * means[a][i] - (1 - share) * means[c][i];
                    away += d * d;
                    apart += (means[a][i] - means[c][i]) * (means[a][i] - means[c][i]);
                }
                if (away < least && away <= tolerance * tolerance * apart) {
                    least = away;
                    winner = step > (own == a ? 1600 : own == c ? 2400 : 2000) ? a : c;
                }
            }
        }
    }
    return winner;
}

static bool is_sure(const struct scene *s, int x, int y)
{
    int same = 0;
    for (int k = 0; k < 9; k++) {
        const int u = x + k % 3 - 1, v = y + k / 3 - 1;
        same += u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT &&
                s->classes[v * WIDTH + u] == s->classes[y * WIDTH + x];
    }
    return s->classes[y * WIDTH + x] < CLASSES && same >= 6;
}

TEST(the_answer_is_that_of_a_search_through_all_shares)
{
    static struct scene s;
    draw_noise(&s);
    resolve(&s, 0.3);
    int judged = 0, differ = 0;
    for (int at = 0; at < PIXELS; at++) {
        double means[CLASSES][BANDS] = {{0}};
        int counts[CLASSES] = {0};
        const int x = at % WIDTH, y = at / WIDTH;
        if (is_sure(&s, x, y) || s.classes[at] == DB_CLASS_NODATA) {
            assert_int_equal(s.out[at], s.classes[at]);
            continue;
        }
        for (int k = 0; k < 25; k++) {
            const int u = x + k % 5 - 2, v = y + k / 5 - 2;
            if (u >= 0 && v >= 0 && u < WIDTH && v < HEIGHT && is_sure(&s, u, v)) {
                const int c = s.classes[v * WIDTH + u];
                counts[c]++;
                for (int i = 0; i < BANDS; i++) {
                    means[c][i] += (double)s.planes[i * PIXELS + v * WIDTH + u];
                }
            }
        }
        for (int c = 0; c < CLASSES; c++) {
            for (int i = 0; i < BANDS; i++) {
                means[c][i] /= counts[c] ? counts[c] : 1;
            }
        }
        const int found = search(means, counts, s.planes + at, s.classes[at], 0.3);
        judged += found >= 0;
        differ += s.out[at] != (found >= 0 ? found : s.classes[at]);
    }
    assert_in_range(judged, 100, PIXELS);
    assert_in_range(differ, 0, judged / 100); /* steps of the search */
}
