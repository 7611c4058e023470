#include "reflectivity/reflect.h"

#include "hs/rng.h"

#include <math.h>

/* dB of a natural logarithm of power. */
static const double db_per_neper = 4.342944819032518;
/* Digamma and trigamma of 1: the mean and variance of the logarithm of an exponential variate. */
static const double digamma_1 = -0.5772156649015329;
static const double trigamma_1 = 1.6449340668482264;

/* Both by the recurrence up to 10, then the asymptotic series (Abramowitz and Stegun, 6.3.18
 * and 6.4.12). */
static double digamma(double x)
{
    double sum = 0;
    for (; x < 10; x++) {
        sum -= 1 / x;
    }
    const double r = 1 / (x * x);
    return sum + log(x) - 0.5 / x - r * (1.0 / 12 - r * (1.0 / 120 - r / 252));
}

static double trigamma(double x)
{
    double sum = 0;
    for (; x < 10; x++) {
        sum += 1 / (x * x);
    }
    const double r = 1 / (x * x);
    return sum + 1 / x + r / 2 + r / x * (1.0 / 6 - r * (1.0 / 30 - r / 42));
}

/* A Gamma variate of the given order and mean 1 (Marsaglia and Tsang, ACM TOMS 26, 2000, p. 363;
 * orders below 1 through their remark on p. 371), as its natural logarithm. */
static double draw_log_gamma(struct hs_rng *rng, double order)
{
    const double raised = order < 1 ? order + 1 : order;
    const double d = raised - 1.0 / 3, c = 1 / sqrt(9 * d);
    double v, x, u;
    do {
        x = hs_rng_normal(rng);
        v = 1 + c * x;
        v = v * v * v;
        u = 1 - hs_rng_uniform(rng);
    } while (v <= 0 || log(u) >= 0.5 * x * x + d - d * v + d * log(v));
    double result = log(d * v);
    if (order < 1) {
        result += log(1 - hs_rng_uniform(rng)) / order;
    }
    return result - log(order);
}

static double draw_shape_db(const struct db_reflect_law *law, struct hs_rng *rng)
{
    if (law->c->texture == DB_TEXTURE_GAUSSIAN) {
        return hs_rng_normal(rng);
    }
    if (law->c->texture == DB_TEXTURE_RAYLEIGH) {
        const double i = hs_rng_normal(rng), q = hs_rng_normal(rng);
        return db_per_neper * log(fmax(0.5 * (i * i + q * q), 1e-30));
    }
    return db_per_neper * draw_log_gamma(rng, law->c->texture_shape);
}

double db_reflect_assign(const struct db_reflect_law *law, uint64_t seed, int x, int y)
{
    enum { DRAWS = 64 };
    const struct db_class *c = law->c;
    struct hs_rng rng;
    const uint64_t place = (uint64_t)(uint32_t)y << 32 | (uint32_t)x;
    /* Two odd factors, neither of them that of the generator's own seeding. */
    hs_rng_seed(&rng, place * 0xd1342543de82ef95u + seed * 0xaef17502108ef2d9u);
    double value = c->gamma_db;
    for (int i = 0; i < DRAWS; i++) {
        const double shape = (draw_shape_db(law, &rng) - law->shape_mean) / law->shape_dev;
        value = c->gamma_db + c->spread_db * shape;
        if (value >= c->low_db && value <= c->high_db) {
            return value;
        }
    }
    return fmin(c->high_db, fmax(c->low_db, value));
}

/* Of a sample: limits leave no closed form. */
static double mean_power_db(const struct db_reflect_law *law)
{
    enum { SAMPLE = 4096 };
    double sum = 0;
    for (int i = 0; i < SAMPLE; i++) {
        sum += pow(10, db_reflect_assign(law, 1, i, 0) / 10);
    }
    return 10 * log10(sum / SAMPLE);
}

void db_reflect_law_init(struct db_reflect_law *law, const struct db_class *c)
{
    *law = (struct db_reflect_law){.c = c, .shape_mean = 0, .shape_dev = 1};
    if (c->texture == DB_TEXTURE_RAYLEIGH) {
        law->shape_mean = db_per_neper * digamma_1;
        law->shape_dev = db_per_neper * sqrt(trigamma_1);
    } else if (c->texture == DB_TEXTURE_K) {
        law->shape_mean = db_per_neper * (digamma(c->texture_shape) - log(c->texture_shape));
        law->shape_dev = db_per_neper * sqrt(trigamma(c->texture_shape));
    }
    law->mean_db = mean_power_db(law);
}

double db_reflect_assign_coarse(const struct db_reflect_law *law, uint64_t seed, int x, int y,
                                int halvings)
{
    const double pixel_db = db_reflect_assign(law, seed, x, y);
    return halvings == 0 ? pixel_db : law->mean_db + ldexp(pixel_db - law->c->gamma_db, -halvings);
}

void db_brightness_add(struct db_brightness *b, int class_index, double brightness)
{
    b->sum[class_index] += brightness;
    b->square[class_index] += brightness * brightness;
    b->count[class_index]++;
}

double db_reflect_adjust(const struct db_class *c, const struct db_brightness *b, int class_index,
                         double brightness)
{
    if (c->kind == DB_KIND_WATER || b->count[class_index] < 2) {
        return c->gamma_db;
    }
    const double mean = b->sum[class_index] / b->count[class_index];
    const double variance = b->square[class_index] / b->count[class_index] - mean * mean;
    if (variance <= 1e-12 * mean * mean) {
        return c->gamma_db;
    }
    const double value = c->gamma_db + c->spread_db * (brightness - mean) / sqrt(variance);
    return fmin(c->high_db, fmax(c->low_db, value));
}
