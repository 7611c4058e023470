/* Temperature of a surface over a day: its heat balance, and the ground below it.
 *
 * Sunlight that is absorbed, and the radiation of the sky, leave as radiation, as heat of the air,
 * as vapour, or into the ground. Ground and weather are those of one and the same day over and
 * over, until a day is like the one before. Laws and sources: docs/infrared.md. */
#ifndef INFRARED_SURFACE_H
#define INFRARED_SURFACE_H

#include "infrared/weather.h"

#include <stdbool.h>

struct ir_surface {
    double emissivity, albedo;
    double conductivity;  /* W/(m K) */
    double heat_capacity; /* J/(m3 K) */
    double wetness;       /* 0..1 of what free water evaporates */
    double roughness_m;
    double rise_east, rise_north; /* of a slope, metres per metre */
    bool is_shaded;               /* the beam of the sun never reaches it */
};

/* Heat that leaves the surface through the air, per kelvin and per hPa; W/m2. */
struct ir_exchange {
    double sensible, latent;
};

/* By the bulk formula with the wind 10 m above the ground; less where the surface is colder than
 * the air, more where it is warmer (Louis 1979). */
struct ir_exchange ir_air_exchange(const struct ir_surface *s, const struct ir_air *air,
                                   double surface_kelvin);

/* Heat that enters the ground at a surface temperature, W/m2. */
double ir_surface_inflow_w_m2(const struct ir_surface *s, const struct ir_air *air, double kelvin);

/* What drives a surface: the air at a time of the period, 0..1. */
struct ir_forcing {
    struct ir_air (*at)(const void *context, double part);
    const void *context; /* borrowed */
    double period_s;
};

enum { IR_STEPS = 720 }; /* of a period; two minutes of a day */

/* Fill `kelvin` with the surface's temperature at the end of each step of a period, the last one
 * its beginning. Returns the number of periods that it took until no value differed by more than
 * 0.01 K from the one before, or IR_PERIODS_MAX. */
enum { IR_PERIODS_MAX = 60 };
int ir_surface_cycle(const struct ir_surface *s, const struct ir_forcing *forcing,
                     double kelvin[IR_STEPS]);

/* The same for a day of weather. */
int ir_surface_day(const struct ir_surface *s, const struct ir_weather *w, double kelvin[IR_STEPS]);

/* The value at an hour of such a day, 0..24. */
double ir_day_value(const double kelvin[IR_STEPS], double hour);

#endif
