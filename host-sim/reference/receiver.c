/* Slant range, pulse, noise and time gain: EQUATIONS.md, "Real beam". */
#include "reference/reference.h"

#include <math.h>
#include <string.h>

static const double light_m_s = 299792458;

double ref_ground_of_slant(double slant_m, double height_m)
{
    const double square = slant_m * slant_m - height_m * height_m;
    return square > 0 ? sqrt(square) : 0;
}

size_t ref_slant_cell(double slant_m, double height_m, double near_edge_m, double cell_m,
                      size_t cells)
{
    const double ground_m = ref_ground_of_slant(slant_m, height_m);
    const double index = floor((ground_m - near_edge_m) / cell_m);
    return ground_m > 0 && index >= 0 && index < (double)cells ? (size_t)index : cells;
}

double ref_slant_grazing(double slant_m, double height_m)
{
    const double ground_m = ref_ground_of_slant(slant_m, height_m);
    const double flat = height_m / ground_m - ground_m / (2 * REF_EFFECTIVE_EARTH_M);
    const double open = height_m > 0 ? INFINITY : -INFINITY;
    return fmin(fmax(ground_m > 0 ? flat : open, 1.0 / 256), 2);
}

double ref_noise_db(const struct ref_receiver *r, double slant_m)
{
    const struct ref_noise_anchor *a = &r->noise;
    return a->gamma_db + 30 * log10(slant_m / a->range_m) -
           10 * log10(ref_slant_grazing(slant_m, r->height_m) /
                      ref_slant_grazing(a->range_m, a->height_m)) -
           20 * log10(r->pulse_s / a->pulse_s) - r->code_gain_db;
}

double ref_stc_fall_db(const struct ref_receiver *r, double slant_m)
{
    return fmax(0, 30 * log10(slant_m / r->stc_m));
}

double ref_pulse_m(double pulse_s)
{
    return light_m_s * pulse_s / 2;
}

double ref_pulse_share(double bins, int m)
{
    if (bins <= 1) {
        return m == 0;
    }
    const double length = fmin(bins, 2 * REF_PULSE_REACH + 1);
    const double from = fmax(m - 0.5, -length / 2), to = fmin(m + 0.5, length / 2);
    return fmax(to - from, 0) / length;
}

void ref_pulse(double *power, size_t count, double bins)
{
    double before[REF_CELLS_MAX];
    memcpy(before, power, count * sizeof *before);
    for (size_t i = 0; i < count; i++) {
        power[i] = 0;
        for (int m = -REF_PULSE_REACH; m <= REF_PULSE_REACH; m++) {
            const ptrdiff_t k = (ptrdiff_t)i + m;
            if (k >= 0 && k < (ptrdiff_t)count) {
                power[i] += ref_pulse_share(bins, m) * before[k];
            }
        }
    }
}

/* Bins before the nearest ground that the beam lights: those of the altitude hole, and more. */
static size_t unlit_of(const struct ref_receiver *r)
{
    size_t i = 0;
    for (; i < r->bins.count; i++) {
        const double slant_m = r->bins.first_m + (double)i * r->bins.step_m;
        if (slant_m >= r->unlit_m && ref_ground_of_slant(slant_m, r->height_m) > 0) {
            break;
        }
    }
    return i;
}

/* Add what the ground leaves in the bins that have any that is lit. */
static void add_leak(const struct ref_receiver *r, uint32_t line, double *power)
{
    const size_t unlit = unlit_of(r);
    double mean[REF_CELLS_MAX];
    ref_leak_sector(r->leak, ref_leak_bins(r->bins.step_m), r->leak_most_db, r->leak_lines, line,
                    power + unlit, r->bins.count - unlit, mean);
    for (size_t i = unlit; i < r->bins.count; i++) {
        power[i] += mean[i - unlit] * pow(10, r->leak_db / 10);
    }
}

void ref_receive(const struct ref_receiver *r, const struct ref_weather_line *weather,
                 uint32_t line, uint32_t sweep, double *power, double *level_db)
{
    ref_pulse(power, r->bins.count, ref_pulse_m(r->pulse_s) / r->bins.step_m);
    if (r->leak != NULL) {
        add_leak(r, line, power);
    }
    for (size_t i = 0; i < r->bins.count; i++) {
        const double slant_m = r->bins.first_m + (double)i * r->bins.step_m;
        const double air = pow(10, -r->air_loss_db_km * slant_m / 1000 / 10);
        const double faded = r->speckle != NULL ? power[i] * r->speckle[i] : power[i];
        const double signal = air * (weather != NULL ? faded * weather->pass[i] : faded);
        const double rain = weather != NULL ? air * weather->rain[i] : 0;
        const unsigned slice = ref_draw(LM_NOISE_RECEIVER, line, (uint32_t)i, sweep);
        const double fluctuation = pow(10, r->noise_table_db[slice] / 10);
        const double noise =
            pow(10, ref_noise_db(r, slant_m) / 10) * (1 + (weather != NULL ? weather->jam : 0));
        level_db[i] =
            10 * log10(signal + (noise + rain) * fluctuation) - ref_stc_fall_db(r, slant_m);
    }
}
