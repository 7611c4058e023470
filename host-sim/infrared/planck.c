#include "infrared/planck.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* CODATA 2018: the constant of Stefan and Boltzmann in W/(m2 K4), hc/k in um K. */
static const double sigma = 5.670374419e-8, second_um_kelvin = 14387.76877;

double ir_radiation_w_m2(double kelvin)
{
    const double square = kelvin * kelvin;
    return sigma * square * square;
}

double ir_fraction_below(double um_kelvin)
{
    enum { TERMS = 24 };
    const double x = second_um_kelvin / um_kelvin;
    double sum = 0;
    for (int n = TERMS; n > 0; n--) {
        const double r = 1.0 / n;
        sum += exp(-n * x) * r * (x * x * x + r * (3 * x * x + r * (6 * x + r * 6)));
    }
    return 15 / (pi * pi * pi * pi) * sum;
}

double ir_band_radiance(double low_um, double high_um, double kelvin)
{
    return ir_radiation_w_m2(kelvin) / pi *
           (ir_fraction_below(high_um * kelvin) - ir_fraction_below(low_um * kelvin));
}
