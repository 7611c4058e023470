/* Class gain, speckle and noise: EQUATIONS.md, "Class gain" and "Speckle". */
#include "fx/hash.h"
#include "reference/reference.h"

#include <math.h>

/* Regularised incomplete gamma functions of whole shape: P by its series (DLMF 8.11.4), which has
 * no cancellation for x small, and Q = 1 - P by its finite sum (DLMF 8.4.10), which has none
 * anywhere. */
static double lower_p(unsigned shape, double x)
{
    double term = exp(-x);
    for (unsigned k = 1; k <= shape; k++) {
        term *= x / k;
    }
    double sum = 0;
    for (unsigned k = shape + 1; term > 1e-18 * sum && term > 0; k++) {
        sum += term;
        term *= x / k;
    }
    return sum;
}

static double upper_q(unsigned shape, double x)
{
    double term = exp(-x), sum = 0;
    for (unsigned k = 1; k <= shape; k++) {
        sum += term;
        term *= x / k;
    }
    return sum;
}

/* x with P(shape, x) = p, by bisection: exact to the last bit and in no hurry. The smaller of P and
 * Q is compared, so that neither tail loses digits. */
static double quantile(unsigned shape, double p)
{
    double low = 0, high = 4.0 * shape + 64;
    for (int i = 0; i < 100; i++) {
        const double x = (low + high) / 2;
        const bool is_below = p < 0.5 ? lower_p(shape, x) < p : upper_q(shape, x) > 1 - p;
        *(is_below ? &low : &high) = x;
    }
    return (low + high) / 2;
}

/* The share of the mean that lies below x is P(shape + 1, x), so a slice's mean is a difference. */
static double slice_mean(unsigned shape, double from, double to)
{
    const double share = from < shape ? lower_p(shape + 1, to) - lower_p(shape + 1, from)
                                      : upper_q(shape + 1, from) - upper_q(shape + 1, to);
    return share * REF_SPECKLE_SLICES;
}

void ref_speckle_table(unsigned looks, double table_db[REF_SPECKLE_SLICES])
{
    double from = 0;
    for (int i = 0; i < REF_SPECKLE_SLICES; i++) {
        const bool is_last = i + 1 == REF_SPECKLE_SLICES;
        const double to = is_last ? 800.0 : quantile(looks, (i + 1.0) / REF_SPECKLE_SLICES);
        table_db[i] = 10 * log10(slice_mean(looks, from, to));
        from = to;
    }
}

unsigned ref_draw(enum lm_noise_kind kind, uint32_t column, uint32_t cell, uint32_t epoch)
{
    const uint32_t first =
        fx_hash3(column, cell / LM_NOISE_BLOCK, epoch * LM_NOISE_KINDS + kind) >> 22;
    return lm_noise_slice((first + cell % LM_NOISE_BLOCK) % REF_SPECKLE_SLICES);
}

double ref_sea_db(int state)
{
    return 5 * (state - 3);
}

/* [GIT]: the height of the waves by the state's wind. State 0 counts as a half. */
double ref_sea_critical(int state, double wavelength_m)
{
    const double wind_m_s = 2.15 * pow(state > 0 ? state : 0.5, 1.04);
    const double wave_m = 4.52e-3 * pow(wind_m_s, 2.5);
    return (wavelength_m + 0.015) / ((14.4 * wavelength_m + 5.5) * wave_m);
}

double ref_sea_grazing_db(double over)
{
    return fmax(-10 * log10(1 + pow(over, -4)), -24);
}

/* The harmonics through three looks, before the mean is taken off. */
static double wind_shape_db(double off_deg, const struct ref_sea *sea)
{
    const double off = off_deg * acos(-1.0) / 180;
    const double up = sea->upwind_db, cross = sea->crosswind_db, down = sea->downwind_db;
    return (up + 2 * cross + down) / 4 + (up - down) / 2 * cos(off) +
           (up - 2 * cross + down) / 4 * cos(2 * off);
}

double ref_sea_wind_db(double off_deg, const struct ref_sea *sea)
{
    enum { LOOKS = 3600 };
    double sum = 0;
    for (int n = 0; n < LOOKS; n++) {
        sum += pow(10, wind_shape_db(n * 360.0 / LOOKS, sea) / 10);
    }
    return wind_shape_db(off_deg, sea) - 10 * log10(sum / LOOKS);
}

void ref_sea(struct ref_bin *bins, size_t count, const struct ref_view *view,
             const struct ref_params *params, double look_deg)
{
    const struct ref_sea *sea = &params->sea;
    const double wind_db = sea->has_wind ? ref_sea_wind_db(look_deg - sea->wind_from_deg, sea) : 0;
    for (size_t i = 0; i < count; i++) {
        const double grazing = ref_grazing(view, bins[i].range_m, bins[i].range_m);
        if (bins[i].kind == LM_KIND_WATER) {
            bins[i].class_gain_db +=
                wind_db + (sea->critical > 0 ? ref_sea_grazing_db(grazing / sea->critical) : 0);
        }
    }
}

double ref_facing_db(double off_deg, const struct ref_params *params)
{
    const double off = fabs(remainder(off_deg, 90)), half = params->lobe_half_deg;
    /* The mean of the lobe over -45..45 degrees: an error function. */
    const double root = sqrt(log(2));
    const double mean =
        half / 45 * sqrt(3.14159265358979323846) / (2 * root) * erf(root * 45 / half);
    const double lobe = exp2(-off * off / (half * half)) / mean;
    return 10 * log10(params->wall_floor + (1 - params->wall_floor) * lobe);
}

void ref_class_gain(struct ref_bin *bins, size_t count, const struct ref_params *params,
                    double look_deg)
{
    for (size_t i = 0; i < count; i++) {
        bins[i].class_gain_db = bins[i].kind == LM_KIND_WATER ? params->sea_db : 0;
        if (bins[i].facing > 0) {
            bins[i].class_gain_db += ref_facing_db(look_deg - 11.25 * (bins[i].facing - 1), params);
        }
    }
}

void ref_speckle(struct ref_bin *bins, size_t count, const double table_db[REF_GRAIN_VALUES],
                 double noise_floor_db)
{
    for (size_t i = 0; i < count; i++) {
        bins[i].speckle_db = table_db[bins[i].grain + 128];
        const double level_db = bins[i].level_db + bins[i].class_gain_db - bins[i].loss_db;
        const double ground = bins[i].is_lit ? pow(10, level_db / 10) : 0;
        const double floor = pow(10, noise_floor_db / 10) + bins[i].veil;
        bins[i].echo_db = 10 * log10(ground + floor) + bins[i].speckle_db;
    }
}
