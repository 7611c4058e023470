/* The grain of speckle, and what the ground leaves in the dark of a patch: EQUATIONS.md, "Speckle"
 * and "Noise". */
#include "lm/grain.h"
#include "reference/reference.h"

#include <math.h>

static double gaussian_below(double z)
{
    return erfc(-z / sqrt(2)) / 2;
}

/* The lower and the upper incomplete gamma function of any shape, regularised: by the series (DLMF
 * 8.11.4) where it is the smaller one, by the continued fraction (DLMF 8.9.2, forwards by Lentz)
 * where the other is. */
static double lower_share(double shape, double x)
{
    double term = exp(shape * log(x) - x - lgamma(shape + 1)), sum = term;
    for (int n = 1; n < 1000 && term > 1e-17 * sum; n++) {
        term *= x / (shape + n);
        sum += term;
    }
    return sum;
}

static double upper_share(double shape, double x)
{
    double b = x + 1 - shape, c = 1e300, d = 1 / b, product = d;
    for (int n = 1; n < 1000; n++) {
        const double a = -n * (n - shape);
        b += 2;
        d = 1 / (a * d + b);
        c = b + a / c;
        product *= c * d;
        if (fabs(c * d - 1) < 1e-16) {
            break;
        }
    }
    return product * exp(shape * log(x) - x - lgamma(shape));
}

double ref_grain_db(double looks, double z)
{
    const double below = gaussian_below(z), above = gaussian_below(-z);
    double low = 0, high = 4 * looks + 64;
    for (int i = 0; i < 100; i++) {
        const double x = (low + high) / 2;
        const bool is_below =
            x < looks ? lower_share(looks, x) < below : upper_share(looks, x) > above;
        *(is_below ? &low : &high) = x;
    }
    return 10 * log10((low + high) / 2 / looks);
}

void ref_grain_table(double looks, double table_db[REF_GRAIN_VALUES])
{
    for (int i = 0; i < REF_GRAIN_VALUES; i++) {
        table_db[i] = ref_grain_db(looks, (i - 128) / 32.0);
    }
}

int ref_grain(uint32_t row, uint32_t column)
{
    const uint32_t turns = row / LM_GRAIN_ROWS;
    return lm_grain_q5[row % LM_GRAIN_ROWS][(column + turns * LM_GRAIN_TWIST) % LM_GRAIN_COLUMNS];
}

/* Weight of a number that is a part `q` of the way from its neighbour, in whole parts of 128. */
static double weight(double q)
{
    const double p = 1 - q;
    return round(128 * q / sqrt(p * p + q * q + 0.62 * p * q)) / 128;
}

/* Between two numbers, in steps of 1/64 of the way: their weights are such that the deviation of
 * the sum is 1 again. The sum is a number of the field's own steps. */
static double between(double first, double second, double way)
{
    const double q = floor(way * 64) / 64;
    const double sum = floor(weight(1 - q) * first + weight(q) * second + 0.5);
    return fmax(fmin(sum, 127), -128);
}

void ref_grain_halves(double looks, double half_db[REF_GRAIN_HALVES])
{
    for (int i = 0; i < REF_GRAIN_HALVES; i++) {
        half_db[i] = ref_grain_db(looks, (i - 8) / 2.0);
    }
}

double ref_grain_power(const double half_db[REF_GRAIN_HALVES], uint32_t start_row,
                       uint32_t start_column, double row, double column)
{
    const uint32_t r = start_row + (uint32_t)row, c = start_column + (uint32_t)column;
    const double down = row - floor(row), along = column - floor(column);
    const double left = between(ref_grain(r, c), ref_grain(r + 1, c), down);
    const double right = between(ref_grain(r, c + 1), ref_grain(r + 1, c + 1), down);
    const double halves = between(left, right, along) / 16, low = floor(halves);
    const double *db = half_db + (int)low + 8;
    return pow(10, (db[0] + (db[1] - db[0]) * (halves - low)) / 10);
}

void ref_leak_line(struct ref_leak *leak, double most_db, unsigned lines_max, unsigned line,
                   const double *power, size_t count)
{
    double sum = 0;
    unsigned cells = 0;
    for (size_t i = line % 4; i < count; i += 4, cells++) {
        sum += fmin(power[i], pow(10, most_db / 10));
    }
    leak->lines = leak->lines < lines_max ? leak->lines + 1 : lines_max;
    leak->mean += ((cells > 0 ? sum / cells : 0) - leak->mean) / leak->lines;
}

size_t ref_leak_bins(double step_m)
{
    return (size_t)pow(2, fmax(5, ceil(log2(1500 / step_m))));
}

void ref_leak_sector(struct ref_leak stretches[REF_LEAK_STRETCHES], size_t length, double most_db,
                     unsigned lines_max, unsigned line, const double *power, size_t count,
                     double *mean)
{
    const size_t last = count < 2 * length ? 0 : count / length - 1;
    for (size_t n = 0; n <= last; n++) {
        const size_t first = n * length;
        ref_leak_line(&stretches[n], most_db, lines_max, line, power + first,
                      n < last ? length : count - first);
    }
    for (size_t i = 0; i < count; i++) {
        const double at = (double)i / (double)length - 0.5;
        const double held = fmin(fmax(at, 0), (double)last), low = floor(held);
        const double nearer = stretches[(size_t)low].mean;
        const double farther = stretches[(size_t)fmin(low + 1, (double)last)].mean;
        mean[i] = nearer + (held - low) * (farther - nearer);
    }
}

double ref_leak(struct ref_leak *leak, const struct ref_params *params, unsigned line,
                const struct ref_bin *shown, size_t count)
{
    double power[REF_LINE_MAX];
    for (size_t i = 0; i < count; i++) {
        power[i] = shown[i].ground + shown[i].veil;
    }
    ref_leak_line(leak, params->leak_most_db, 32, line, power, count);
    return leak->mean * pow(10, params->leak_db / 10);
}

/* Powers of the ground where they are displayed. Terrain and height are each rounded to sixteenths
 * of a cell. */
static void lay_over(struct ref_bin *bins, size_t count, const struct ref_lean *lean)
{
    double power[REF_LINE_MAX] = {0}, nearer_cells[REF_LINE_MAX] = {0}, laid[REF_LINE_MAX];
    for (size_t i = 0; i < count; i++) {
        const double above_m = bins[i].elevation_m - lean->reference_m;
        power[i] = bins[i].ground;
        nearer_cells[i] =
            (round(16 * above_m * lean->cells_m) + round(16 * bins[i].height_m * lean->cells_m)) /
            16;
    }
    ref_layover(power, nearer_cells, count, laid);
    for (size_t i = 0; i < count; i++) {
        bins[i].ground = laid[i];
    }
}

void ref_patch_echo(struct ref_bin *bins, const struct ref_patch_line *cells,
                    const double table_db[REF_GRAIN_VALUES], const struct ref_params *params,
                    struct ref_leak *leak, unsigned line)
{
    const size_t count = cells->count;
    for (size_t i = 0; i < count; i++) {
        const double level_db = bins[i].level_db + bins[i].class_gain_db;
        bins[i].ground = bins[i].is_lit ? pow(10, level_db / 10) : 0;
    }
    lay_over(bins, count, &params->lean);
    for (size_t i = 0; i < count; i++) {
        bins[i].ground *= pow(10, -bins[i].loss_db / 10);
    }
    const double left = ref_leak(leak, params, line, bins + cells->first, cells->shown);
    const double floor = pow(10, params->noise_floor_db / 10) + left;
    leak->shadow_db = 10 * log10(floor);
    for (size_t i = 0; i < count; i++) {
        bins[i].speckle_db = table_db[bins[i].grain + 128];
        bins[i].echo_db = 10 * log10(bins[i].ground + floor + bins[i].veil) + bins[i].speckle_db;
    }
}
