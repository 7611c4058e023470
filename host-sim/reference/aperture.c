/* Synthetic aperture: dwell, point response, unsteady flight, layover. EQUATIONS.md, "Synthetic
 * aperture". */
#include "reference/reference.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846, rad = 3.14159265358979323846 / 180;

double ref_sar_dwell_s(double wavelength_m, double slant_m, double speed_m_s, double cell_m,
                       double squint_deg)
{
    return wavelength_m * slant_m / (2 * speed_m_s * cell_m * fabs(sin(squint_deg * rad)));
}

double ref_mocomp_cells(double wavelength_m, double residual_m_s2, double dwell_s)
{
    const double phase = pi * residual_m_s2 * dwell_s * dwell_s / (2 * wavelength_m);
    return hypot(1, 0.42 * phase);
}

void ref_mocomp(const double *const power[], size_t lines, size_t line, double width, double *mean,
                size_t count)
{
    for (size_t i = 0; i < count; i++) {
        mean[i] = 0;
    }
    for (int m = -REF_PULSE_REACH; m <= REF_PULSE_REACH; m++) {
        const ptrdiff_t k = (ptrdiff_t)line + m, last = (ptrdiff_t)lines - 1;
        const double *from = power[k < 0 ? 0 : k > last ? last : k];
        for (size_t i = 0; i < count; i++) {
            mean[i] += ref_pulse_share(width, m) * from[i];
        }
    }
}

void ref_layover(const double *power, const double *nearer_cells, size_t count, double *laid)
{
    for (size_t i = 0; i < count; i++) {
        laid[i] = 0;
    }
    for (size_t i = 0; i < count; i++) {
        const double place = (double)i - nearer_cells[i], below = floor(place);
        if (below >= 0 && below < (double)count) {
            laid[(size_t)below] += power[i] * (1 - (place - below));
        }
        if (below + 1 >= 0 && below + 1 < (double)count) {
            laid[(size_t)(below + 1)] += power[i] * (place - below);
        }
    }
}

/* F_m of T. T. Taylor, "Design of line-source antennas for narrow beamwidth and low side lobes"
 * (IRE Trans. AP-3, 1955): the weighting is 1 + 2 sum of F_m cos(2 pi m u) over an aperture u of
 * -1/2..1/2. */
static double taylor_coefficient(const struct ref_taylor *t, int m)
{
    const double a = acosh(pow(10, t->side_lobe_db / 20)) / pi;
    const double stretch = t->nbar * t->nbar / (a * a + pow(t->nbar - 0.5, 2));
    double numerator = 1, denominator = 1;
    for (int n = 1; n < t->nbar; n++) {
        numerator *= 1 - m * m / (stretch * (a * a + pow(n - 0.5, 2)));
        denominator *= n == m ? 1 : 1 - (double)m * m / (n * n);
    }
    return (m % 2 ? 0.5 : -0.5) * numerator / denominator;
}

static double sinc(double x)
{
    return x == 0 ? 1 : sin(pi * x) / (pi * x);
}

double ref_taylor_amplitude(const struct ref_taylor *t, double x)
{
    double sum = sinc(x);
    for (int m = 1; m < t->nbar; m++) {
        sum += taylor_coefficient(t, m) * (sinc(x - m) + sinc(x + m));
    }
    return sum;
}

double ref_taylor_weight(const struct ref_taylor *t, double u)
{
    double sum = 1;
    for (int m = 1; m < t->nbar; m++) {
        sum += 2 * taylor_coefficient(t, m) * cos(2 * pi * m * u);
    }
    return sum;
}

static const struct ref_taylor patch_taylor = {35, 4};

/* Of the response over all cells, the peak being 1. */
static double patch_energy(void)
{
    double energy = 1;
    for (int m = 1; m < patch_taylor.nbar; m++) {
        energy += 2 * pow(taylor_coefficient(&patch_taylor, m), 2);
    }
    return energy;
}

double ref_point_response(double x)
{
    return ref_taylor_amplitude(&patch_taylor, x) / sqrt(patch_energy());
}

enum { PULSES = 400 };

/* The echo of each pulse in a cell: the point's range response, as far as it has gone by then. */
static void echoes(const struct ref_mover *m, double cell, double echo[PULSES])
{
    for (int n = 0; n < PULSES; n++) {
        const double u = (n + 0.5) / PULSES - 0.5;
        echo[n] = ref_taylor_weight(&patch_taylor, u) *
                  ref_point_response(cell - m->cell - m->along * u) / PULSES;
    }
}

/* What the sum for a line turns each pulse by, as the point's displacement drifts. */
static void turns(const struct ref_mover *m, double line, double complex turn[PULSES])
{
    for (int n = 0; n < PULSES; n++) {
        const double u = (n + 0.5) / PULSES - 0.5;
        turn[n] = cexp(2 * pi * I * (m->across * u * u / 2 - (line - m->line) * u));
    }
}

int ref_add_mover(const struct ref_mover *m, size_t lines, size_t cells, double *power)
{
    double(*echo)[PULSES] = malloc(cells * sizeof *echo);
    double complex turn[PULSES];
    const double energy = patch_energy();
    if (!echo) {
        return -1;
    }
    for (size_t i = 0; i < cells; i++) {
        echoes(m, (double)i, echo[i]);
    }
    for (size_t k = 0; k < lines; k++) {
        turns(m, (double)k, turn);
        for (size_t i = 0; i < cells; i++) {
            double complex sum = 0;
            for (int n = 0; n < PULSES; n++) {
                sum += echo[i][n] * turn[n];
            }
            power[k * cells + i] += m->power * creal(sum * conj(sum)) / energy;
        }
    }
    free(echo);
    return 0;
}
