#include "reflectivity/reflect.h"

#include <math.h>
#include <stdbool.h>

/* dB of a natural logarithm of power. */
static const double db_per_neper = 4.342944819032518;

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

/* Lattices of the patterns in metres, and how much of the cell's there may be. UNSOURCED: chosen so
 * that soil and towns are correlated over 10 to 80 m as in a Sentinel-1 scene (docs/database.md).
 */
static const double parcel_m = 110, smooth_m = 75, tens_m = 34, cell_m = 4;
static const double object_share = 0.57; /* of the variance that the cell's leaves */
static const double cell_spread_db = 1, cell_share_max = 0.15;

/* Spots of structures. UNSOURCED, after the same scene: share of the ground, and in spreads the
 * mean of their exponential distribution and its end. Maps of shorter pixels than a house show it
 * by itself. */
static const double spot_share = 0.04, spot_mean_spreads = 2.4, spot_end_spreads = 7.5;
static const double house_m = 8;

/* Density of the unscaled texture at x dB, but for a factor. */
static double density(const struct db_class *c, double x)
{
    if (c->texture == DB_TEXTURE_GAUSSIAN) {
        return exp(-0.5 * x * x);
    }
    const double order = c->texture == DB_TEXTURE_K ? c->texture_shape : 1;
    const double neper = x / db_per_neper;
    return exp(order * (neper - exp(neper) + 1));
}

/* Mean and deviation of the unscaled texture, dB. */
static void texture_moments(const struct db_class *c, double *mean, double *deviation)
{
    *mean = 0;
    *deviation = 1;
    if (c->texture != DB_TEXTURE_GAUSSIAN) {
        const double order = c->texture == DB_TEXTURE_K ? c->texture_shape : 1;
        *mean = db_per_neper * (digamma(order) - log(order));
        *deviation = db_per_neper * sqrt(trigamma(order));
    }
}

/* Share of the standard normal distribution below a rank. */
static double below(double rank)
{
    return 0.5 * erfc(-rank * 0.70710678118654752);
}

static double rank_of_step(int step)
{
    return DB_REFLECT_RANK_MAX * (2.0 * step / DB_REFLECT_STEPS - 1);
}

enum { BINS = 1 << 14 };

/* Fill value_db: the value below which there is as much of the texture, cut at the limits, as there
 * is of a normal variable below the rank. */
static void fill_values(struct db_reflect_law *law, double low_db, double high_db)
{
    static const double reach = 14; /* deviations; the tail of the exponential ends at 1e-6 */
    const struct db_class *c = law->c;
    double mean, deviation;
    texture_moments(c, &mean, &deviation);
    const double scale = deviation / c->spread_db;
    const double from = fmax(low_db, c->gamma_db - reach * c->spread_db);
    const double to = fmin(high_db, c->gamma_db + reach * c->spread_db);
    const double width = (to - from) / BINS;
    double whole = 0;
    for (int i = 0; i < BINS; i++) {
        whole += density(c, mean + (from + (i + 0.5) * width - c->gamma_db) * scale);
    }
    double sum = 0;
    int bin = 0;
    for (int step = 0; step <= DB_REFLECT_STEPS; step++) {
        const double wanted = whole * below(rank_of_step(step));
        double part = 0;
        while (bin < BINS) {
            part = density(c, mean + (from + (bin + 0.5) * width - c->gamma_db) * scale);
            if (sum + part > wanted) {
                break;
            }
            sum += part;
            bin++;
        }
        const double into = bin < BINS && part > 0 ? (wanted - sum) / part : 0;
        law->value_db[step] = (float)(from + (bin + into) * width);
    }
}

/* A spot of number u in [0, 1) stands out by this many dB. */
static double spot_db(const struct db_reflect_law *law, double u)
{
    const double end = 1 - exp(-spot_end_spreads / spot_mean_spreads);
    return -law->spot_db * log(1 - u * end);
}

/* What spots add to the variance the rest must do without. */
static void add_spots(struct db_reflect_law *law)
{
    enum { PARTS = 4096 };
    const struct db_class *c = law->c;
    law->spot_share = spot_share;
    law->spot_db = spot_mean_spreads * c->spread_db;
    double mean = 0, square = 0, power = 0;
    for (int i = 0; i < PARTS; i++) {
        const double db = spot_db(law, (i + 0.5) / PARTS);
        mean += spot_share * db / PARTS;
        square += spot_share * db * db / PARTS;
        power += pow(10, db / 10) / PARTS;
    }
    const double kept = sqrt(1 - (square - mean * mean) / (c->spread_db * c->spread_db));
    for (int i = 0; i <= DB_REFLECT_STEPS; i++) {
        law->value_db[i] =
            (float)(c->gamma_db - mean + kept * ((double)law->value_db[i] - c->gamma_db));
    }
    law->mean_db = 10 * log10(1 + spot_share * (power - 1));
}

static double value_of_rank(const struct db_reflect_law *law, double rank)
{
    const double step = (rank / DB_REFLECT_RANK_MAX + 1) * (DB_REFLECT_STEPS / 2.0);
    const double within = fmin(fmax(step, 0), DB_REFLECT_STEPS - 1e-6);
    const int i = (int)within;
    const double low = (double)law->value_db[i], high = (double)law->value_db[i + 1];
    return low + (high - low) * (within - i);
}

static uint64_t seed_of_name(const char *name)
{
    uint64_t h = 0xcbf29ce484222325u; /* FNV-1a */
    for (; *name; name++) {
        h = (h ^ (uint8_t)*name) * 0x100000001b3u;
    }
    return h;
}

void db_reflect_law_init(struct db_reflect_law *law, const struct db_class *c, double pixel_m)
{
    *law = (struct db_reflect_law){.c = c, .seed = seed_of_name(c->name), .mean_db = c->gamma_db};
    const double cell =
        c->spread_db > 0 ? fmin(cell_share_max, pow(cell_spread_db / c->spread_db, 2)) : 0;
    law->weight[0] = sqrt((1 - cell) * object_share);
    law->weight[1] = sqrt((1 - cell) * (1 - object_share));
    law->weight[2] = sqrt(cell);
    if (c->spread_db <= 0) {
        return;
    }
    fill_values(law, c->low_db, c->high_db);
    law->mean_db = 0;
    if (c->kind == DB_KIND_STRUCTURE && pixel_m >= house_m) {
        add_spots(law);
    }
    double power = 0;
    for (int i = 0; i < DB_REFLECT_STEPS; i++) {
        const double share = below(rank_of_step(i + 1)) - below(rank_of_step(i));
        const double middle = 0.5 * (rank_of_step(i) + rank_of_step(i + 1));
        power += share * pow(10, value_of_rank(law, middle) / 10);
    }
    law->mean_db += 10 * log10(power);
}

/* What is alike within a field or a building. `own` is the seed of the class. */
static double object_at(const struct db_reflect_law *law, uint64_t own, struct reflect_place p)
{
    const bool grows = law->c->kind == DB_KIND_WATER || law->c->kind == DB_KIND_TREES;
    return grows ? reflect_pattern_smooth(own, p, smooth_m)
                 : reflect_pattern_parcels(own, p, parcel_m);
}

/* Without the pattern of the cell where that averages out. */
static double rank_at(const struct db_reflect_law *law, uint64_t own, struct reflect_place p,
                      double object, bool has_cell)
{
    return law->weight[0] * object + law->weight[1] * reflect_pattern_smooth(own + 1, p, tens_m) +
           (has_cell ? law->weight[2] * reflect_pattern_smooth(own + 2, p, cell_m) : 0);
}

static uint64_t own_seed(const struct db_reflect_law *law, uint64_t seed)
{
    return seed * 0x9fb21c651e98df25u + law->seed;
}

double db_reflect_rank(const struct db_reflect_law *law, uint64_t seed, struct reflect_place p)
{
    const uint64_t own = own_seed(law, seed);
    return rank_at(law, own, p, object_at(law, own, p), true);
}

static double value_at(const struct db_reflect_law *law, uint64_t seed, struct reflect_place p,
                       double object, bool has_cell)
{
    const struct db_class *c = law->c;
    if (c->spread_db <= 0) {
        return c->gamma_db;
    }
    const uint64_t own = own_seed(law, seed);
    const double known = isnan(object) ? object_at(law, own, p) : object;
    const double value = value_of_rank(law, rank_at(law, own, p, known, has_cell));
    if (law->spot_share <= 0) {
        return value;
    }
    const double spot = reflect_pattern_spots(own + 3, p, law->spot_share);
    return spot < 0 ? value : value + spot_db(law, spot);
}

double db_reflect_assign(const struct db_reflect_law *law, uint64_t seed, struct reflect_place p)
{
    return value_at(law, seed, p, NAN, true);
}

static bool mixes(const struct db_class *c)
{
    return c->is_natural && (c->kind == DB_KIND_GROUND || c->kind == DB_KIND_TREES);
}

double db_reflect_assign_among(const struct db_reflect_law *laws, const uint8_t around[9],
                               double object, uint64_t seed, struct reflect_place p)
{
    static const double weight[9] = {1, 2, 1, 2, 4, 2, 1, 2, 1};
    const uint8_t own = around[4];
    bool is_alone = true;
    for (int i = 0; i < 9; i++) {
        is_alone &= around[i] == own;
    }
    const double own_db = value_at(&laws[own], seed, p, object, true);
    if (is_alone) { /* most ground: its shares are not worked out */
        return own_db;
    }
    double share[DB_CLASS_MAX] = {0}, power = 0;
    for (int i = 0; i < 9; i++) {
        const bool is_mixed =
            around[i] != DB_CLASS_NODATA && mixes(laws[around[i]].c) && mixes(laws[own].c);
        share[is_mixed ? around[i] : own] += weight[i] / 16;
    }
    if (share[own] >= 1) {
        return own_db;
    }
    for (int k = 0; k < DB_CLASS_MAX; k++) {
        if (share[k] > 0) {
            const double db = k == own ? own_db : db_reflect_assign(&laws[k], seed, p);
            power += share[k] * exp(db / db_per_neper);
        }
    }
    return db_per_neper * log(power);
}

double db_reflect_assign_cell(const struct db_reflect_law *law, uint64_t seed, double latitude,
                              double longitude, double width_m)
{
    static const double fine_m = 5, apart_m = 40;
    const struct reflect_tangent middle = reflect_tangent_at(latitude, longitude);
    if (width_m <= fine_m || law->c->spread_db <= 0) {
        return db_reflect_assign(law, seed, middle.at);
    }
    const int side = width_m <= apart_m ? 2 : (int)fmin(4, ceil(width_m / apart_m));
    double power = 0;
    for (int i = 0; i < side * side; i++) {
        const double east = ((i % side + 0.5) / side - 0.5) * width_m;
        const double north = ((i / side + 0.5) / side - 0.5) * width_m;
        const struct reflect_place p = reflect_place_beside(&middle, east, north);
        power += exp(value_at(law, seed, p, NAN, width_m <= 4 * cell_m) / db_per_neper);
    }
    /* Where the places are farther apart than what they stand for is wide, their mean varies more
     * than that of all the ground. */
    const double value_db = db_per_neper * log(power / (side * side));
    return law->mean_db + fmin(1, side * apart_m / width_m) * (value_db - law->mean_db);
}

void db_brightness_add(struct db_brightness *b, int class_index, double brightness)
{
    b->sum[class_index] += brightness;
    b->square[class_index] += brightness * brightness;
    b->count[class_index]++;
}

double db_brightness_deviations(const struct db_brightness *b, int class_index, double brightness)
{
    const double count = b->count[class_index];
    const double mean = b->sum[class_index] / fmax(count, 1);
    const double variance = b->square[class_index] / fmax(count, 1) - mean * mean;
    return count < 2 || variance <= 1e-12 * mean * mean ? NAN
                                                        : (brightness - mean) / sqrt(variance);
}

double db_reflect_adjust(const struct db_class *c, const struct db_brightness *b, int class_index,
                         double brightness)
{
    const double deviations = db_brightness_deviations(b, class_index, brightness);
    if (c->kind == DB_KIND_WATER || isnan(deviations)) {
        return c->gamma_db;
    }
    return fmin(c->high_db, fmax(c->low_db, c->gamma_db + c->spread_db * deviations));
}
