#include "tracer/substances.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static const struct substance_building buildings[] = {
    {"concrete", 5.24, 0, 0.0462, 0.7822, 1, 100},
    {"brick", 3.91, 0, 0.0238, 0.16, 1, 40},
    {"wood", 1.99, 0, 0.0047, 1.0718, 0.001, 100},
    {"glass", 6.31, 0, 0.0036, 1.3394, 0.1, 100},
    {"marble", 7.074, 0, 0.0055, 0.9262, 1, 60},
    {"plywood", 2.71, 0, 0.33, 0, 1, 40},
    {"metal", 1, 0, 1e7, 0, 1, 100},
};

static double square(double x)
{
    return x * x;
}

/* ---- building materials ---- */

const struct substance_building *substance_building_find(const char *name)
{
    for (size_t i = 0; i < sizeof buildings / sizeof buildings[0]; i++) {
        if (strcmp(buildings[i].name, name) == 0) {
            return &buildings[i];
        }
    }
    return NULL;
}

double substance_conductivity(const struct substance_building *s, double ghz)
{
    return s->c * pow(ghz, s->d);
}

double complex substance_building(const struct substance_building *s, double ghz)
{
    return s->a * pow(ghz, s->b) - 17.98 * substance_conductivity(s, ghz) / ghz * I;
}

/* ---- water, ice, snow ---- */

/* How much colder than 300 K. */
static double coldness(double celsius)
{
    return 300 / (celsius + 273.15) - 1;
}

static double first_relaxation_ghz(double celsius)
{
    const double cold = coldness(celsius);
    return 20.20 - 146.4 * cold + 316 * square(cold);
}

/* Debye's relaxation: step / (1 + i f / f0). */
static double complex relaxation(double step, double turns)
{
    return step / (1 + turns * I);
}

double complex substance_water(double celsius, double ghz)
{
    const double cold = coldness(celsius), first_ghz = first_relaxation_ghz(celsius);
    const double still = 77.66 + 103.3 * cold, between = 0.0671 * still;
    const double fast = 3.52 - 7.52 * cold;
    return relaxation(still - between, ghz / first_ghz) +
           relaxation(between - fast, ghz / (39.8 * first_ghz)) + fast;
}

double complex substance_ice(double celsius, double ghz)
{
    const double kelvin = celsius + 273.15, cold = coldness(celsius), tau = exp(-335 / kelvin);
    const double below = (0.00504 + 0.0062 * cold) * exp(-22.1 * cold);
    const double above = 0.0207 / kelvin * tau / square(tau - 1) + 1.16e-11 * square(ghz) +
                         exp(-9.963 + 0.0372 * celsius);
    return 3.1884 + 0.00091 * celsius - (below / ghz + above * ghz) * I;
}

double complex substance_dry_snow(double density, double celsius, double ghz)
{
    const double complex ice = substance_ice(celsius, ghz);
    const double snow = density <= 0.5 ? 1 + 1.9 * density : 0.51 + 2.88 * density;
    const double loss = 3 * -cimag(ice) * density / 0.916 * square(snow) * (2 * snow + 1) /
                        ((creal(ice) + 2 * snow) * (creal(ice) + 2 * square(snow)));
    return snow - loss * I;
}

double complex substance_wet_snow(double density, double water_share, double ghz)
{
    const double percent = 100 * water_share, turns = ghz / 9.07;
    const double a1 = 0.78 + 0.03 * ghz - 0.58e-3 * square(ghz);
    const double a2 = 0.97 - 0.39e-2 * ghz + 0.39e-3 * square(ghz);
    const double b1 = 0.31 - 0.05 * ghz + 0.87e-3 * square(ghz);
    const double water = 0.073 * pow(percent, 1.31) / (1 + square(turns));
    const double snow = a1 * (1 + 1.83 * density + 0.02 * pow(percent, 1.015)) + b1;
    return snow + a1 * water - a2 * turns * water * I;
}

/* ---- soil ---- */

/* What the ions in the water add to its permittivity. */
static double complex ions_in(const struct substance_soil *s, double ghz)
{
    const double low =
        0.0467 + 0.2204 * s->bulk_density - 0.004111 * s->sand_percent - 0.006614 * s->clay_percent;
    const double high =
        -1.645 + 1.939 * s->bulk_density - 0.0225622 * s->sand_percent + 0.01594 * s->clay_percent;
    const double turns = ghz / 1.35, step = (low - high) / (1 + square(turns));
    const double pores = (s->grain_density - s->bulk_density) / (s->grain_density * s->water_share);
    return 18 / ghz * pores * (turns * step - (high + step) * I);
}

double complex substance_soil(const struct substance_soil *s, double ghz)
{
    const double alpha = 0.65;
    const double complex water = substance_water(s->celsius, ghz) + ions_in(s, ghz);
    const double grain = square(1.01 + 0.44 * s->grain_density) - 0.062;
    const double beta = 1.2748 - 0.00519 * s->sand_percent - 0.00152 * s->clay_percent;
    const double beta_loss = 1.33797 - 0.00603 * s->sand_percent - 0.00166 * s->clay_percent;
    const double mixed = 1 + s->bulk_density / s->grain_density * (pow(grain, alpha) - 1) +
                         pow(s->water_share, beta) * pow(creal(water), alpha) - s->water_share;
    const double loss = pow(s->water_share, beta_loss / alpha) * fmax(-cimag(water), 0);
    return pow(mixed, 1 / alpha) - loss * I;
}

/* ---- vegetation ---- */

double complex substance_leaf(double moisture, double celsius, double ghz)
{
    const double dry = 1.7 - 0.74 * moisture + 6.16 * square(moisture);
    const double free_share = moisture * (0.55 * moisture - 0.076);
    const double bound_share = 4.64 * square(moisture) / (1 + 7.36 * square(moisture));
    const double complex free_water = substance_water(celsius, ghz) - 22.86 / ghz * I;
    const double complex root = csqrt(ghz / (0.01 * first_relaxation_ghz(celsius)) * I);
    return dry + free_share * free_water + bound_share * (2.9 + 55 / (1 + root));
}

double complex substance_canopy(double leaf_share, double moisture, double celsius, double ghz)
{
    const double complex leaf = csqrt(substance_leaf(moisture, celsius, ghz));
    const double complex index = 1 + leaf_share * (leaf - 1);
    return index * index;
}
