/* The antenna of a real-beam line: smear across lines, elevation pattern, tilt. EQUATIONS.md, "Real
 * beam". */
#include "reference/reference.h"

#include <math.h>

static const double rad = 3.14159265358979323846 / 180;

double ref_beam_fineness(const struct ref_beam *b)
{
    return pow(2, floor(log2(b->ratio) + 0.5));
}

double ref_beam_spacing_deg(const struct ref_beam *b)
{
    return b->line_deg / ref_beam_fineness(b);
}

double ref_beam_azimuth_deg(const struct ref_beam *b, long sample)
{
    return ((double)sample + 0.5) * ref_beam_spacing_deg(b);
}

double ref_beam_pattern(const struct ref_beam *b, double off_deg)
{
    const double x = b->ratio * off_deg / b->beam_deg;
    return pow(2, -8 * x * x);
}

struct ref_beam_look ref_beam_look(const struct ref_beam *b, double azimuth_deg)
{
    struct ref_beam_look look;
    double sum = 0;
    look.first = (long)floor(azimuth_deg / ref_beam_spacing_deg(b) + 0.5) - REF_BEAM_SAMPLES / 2;
    for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
        const double off_deg = azimuth_deg - ref_beam_azimuth_deg(b, look.first + j);
        look.weight[j] = ref_beam_pattern(b, off_deg);
        sum += look.weight[j];
    }
    for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
        look.weight[j] /= sum;
    }
    return look;
}

void ref_beam_sum(const struct ref_beam_look *look, const double *const power[REF_BEAM_SAMPLES],
                  double *sum, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        sum[i] = 0;
        for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
            sum[i] += look->weight[j] * power[j][i];
        }
    }
}

double ref_elevation_db(const struct ref_antenna *a, double tilt_deg, double tangent)
{
    const double above = tangent - tan(tilt_deg * rad);
    const double below = tan((tilt_deg - a->fan_deg) * rad) - tangent;
    const double off = fmax(above, below);
    if (off <= 0) {
        return 0;
    }
    const double step = (fmin(floor(off * 2048), 255) + 0.5) / 2048;
    return -80 * log10(2) * pow(step / (a->elevation_beam_deg * rad), 2);
}

double ref_unlit_m(const struct ref_antenna *a, double tilt_deg, double height_m)
{
    const double down_deg = a->fan_deg + a->elevation_beam_deg / 2 - tilt_deg;
    return fmax(height_m, 0) / sin(fmin(fmax(down_deg, 0.5), 90) * rad);
}

double ref_auto_tilt_deg(double height_m, double range_m)
{
    return atan(-height_m / range_m - range_m / (2 * REF_EFFECTIVE_EARTH_M)) / rad;
}

double ref_bar_tilt_deg(const struct ref_antenna *a, double tilt_deg, int bar, int bars)
{
    return tilt_deg + (bar - (bars - 1) / 2.0) * a->bar_spacing_deg;
}

void ref_sample_power(const struct ref_bin *cells, size_t count, const struct ref_antenna *a,
                      double tilt_deg, double *power)
{
    for (size_t i = 0; i < count; i++) {
        const double gain_db = ref_elevation_db(a, tilt_deg, cells[i].tangent);
        power[i] = cells[i].is_lit ? pow(10, (cells[i].echo_db + gain_db) / 10) : 0;
    }
}

void ref_slant_power(const struct ref_bins *bins, double height_m, double near_edge_m,
                     double cell_m, const double *ground, size_t cells, double *power)
{
    for (size_t i = 0; i < bins->count; i++) {
        const double slant_m = bins->first_m + (double)i * bins->step_m;
        const size_t cell = ref_slant_cell(slant_m, height_m, near_edge_m, cell_m, cells);
        const size_t next = i + 1 < bins->count ? ref_slant_cell(slant_m + bins->step_m, height_m,
                                                                 near_edge_m, cell_m, cells)
                                                : cells;
        power[i] = cell < cells ? ground[cell] : 0;
        if (next < cells && next > cell + 1) {
            power[i] = fmax(power[i], ground[next - 1]);
        }
    }
}
