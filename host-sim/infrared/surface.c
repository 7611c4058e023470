#include "infrared/surface.h"

#include "infrared/ground.h"
#include "infrared/planck.h"

#include <math.h>

static const double air_heat = 1005, vapour_heat = 2.45e6; /* J/(kg K); J/kg at 20 degrees */
static const double pressure_hpa = 1013, vapour_weight = 0.622, gravity = 9.81, karman = 0.4;
static const double wind_height_m = 10;
static const double wind_least_m_s = 0.5; /* UNSOURCED: calm air moves */
static const double close_kelvin = 0.01;

/* Louis (1979) in the form of Liston and others (1999): neutral exchange times a function of the
 * bulk Richardson number. */
struct ir_exchange ir_air_exchange(const struct ir_surface *s, const struct ir_air *air,
                                   double surface_kelvin)
{
    const double wind = fmax(air->wind_m_s, wind_least_m_s);
    const double height = wind_height_m / s->roughness_m;
    const double drag = pow(karman / log(height), 2);
    const double richardson =
        gravity * wind_height_m * (air->kelvin - surface_kelvin) / (air->kelvin * wind * wind);
    const double c = 5.3 * 9.4 * drag * sqrt(height);
    const double factor = richardson > 0 ? pow(1 + 4.7 * richardson, -2)
                                         : 1 - 9.4 * richardson / (1 + c * sqrt(-richardson));
    const double mass = air->density_kg_m3 * drag * wind * factor; /* kg/(m2 s) */
    return (struct ir_exchange){mass * air_heat,
                                mass * s->wetness * vapour_heat * vapour_weight / pressure_hpa};
}

/* Sunlight on the slope. What hills around it hide or send is left out. */
static double sun_w_m2(const struct ir_surface *s, const struct ir_air *air)
{
    const double up = 1 / sqrt(1 + s->rise_east * s->rise_east + s->rise_north * s->rise_north);
    const double facing =
        up * (air->sun[2] - s->rise_east * air->sun[0] - s->rise_north * air->sun[1]);
    const double beam = s->is_shaded ? 0 : air->beam_w_m2;
    return beam * fmax(0, facing) + air->diffuse_w_m2 * (1 + up) / 2;
}

double ir_surface_inflow_w_m2(const struct ir_surface *s, const struct ir_air *air, double kelvin)
{
    const struct ir_exchange e = ir_air_exchange(s, air, kelvin);
    const double vapour =
        e.latent > 0 ? e.latent * (ir_saturation_hpa(kelvin) - air->vapour_hpa) : 0;
    return (1 - s->albedo) * sun_w_m2(s, air) +
           s->emissivity * (air->sky_w_m2 - ir_radiation_w_m2(kelvin)) -
           e.sensible * (kelvin - air->kelvin) - vapour;
}

/* The temperature at which the ground takes up what enters, by Newton's steps from that of the
 * step before. Below a cold still night the exchange with the air falls faster than the air is
 * warmer: there the slope of the ground stands for the whole. */
static double balanced(const struct ir_surface *s, const struct ir_air *air,
                       const struct ir_uptake *uptake, double kelvin)
{
    enum { NEWTON = 20 };
    static const double small_kelvin = 1e-3, close = 1e-5, stride_kelvin = 20;
    double step = stride_kelvin;
    for (int i = 0; i < NEWTON && fabs(step) > close; i++) {
        const double in = ir_surface_inflow_w_m2(s, air, kelvin);
        const double slope =
            (ir_surface_inflow_w_m2(s, air, kelvin + small_kelvin) - in) / small_kelvin;
        const double surplus = in - (uptake->slope * kelvin - uptake->offset);
        step = surplus / (uptake->slope - fmin(slope, 0));
        step = fmin(fmax(step, -stride_kelvin), stride_kelvin);
        kelvin += step;
    }
    return kelvin;
}

/* The means over a period of what enters the ground and of how that falls with the temperature. */
struct gain {
    double w_m2, per_kelvin;
};

/* One period; `*change` is how much it differs from the one before. */
static struct gain run_period(const struct ir_surface *s, const struct ir_forcing *forcing,
                              struct ir_ground *ground, double *kelvin, double *change)
{
    struct gain mean = {0, 0};
    *change = 0;
    for (int i = 0; i < IR_STEPS; i++) {
        const struct ir_air air = forcing->at(forcing->context, (i + 1.0) / IR_STEPS);
        const struct ir_uptake uptake = ir_ground_uptake(ground, forcing->period_s / IR_STEPS);
        const double now = balanced(s, &air, &uptake, ground->kelvin[0]);
        const double in = ir_surface_inflow_w_m2(s, &air, now);
        ir_ground_step(ground, now);
        mean.w_m2 += in / IR_STEPS;
        mean.per_kelvin += (in - ir_surface_inflow_w_m2(s, &air, now + 1)) / IR_STEPS;
        *change = fmax(*change, fabs(now - kelvin[i]));
        kelvin[i] = now;
    }
    return mean;
}

/* Ground that takes up heat from one period to the next grows warmer for long. It is made warmer at
 * once, by as much as ends the uptake. */
static void settle(struct ir_ground *ground, const struct gain *mean)
{
    for (int i = 0; i < IR_NODES && mean->per_kelvin > 0; i++) {
        ground->kelvin[i] += mean->w_m2 / mean->per_kelvin;
    }
}

int ir_surface_cycle(const struct ir_surface *s, const struct ir_forcing *forcing,
                     double kelvin[IR_STEPS])
{
    struct ir_ground ground;
    ir_ground_init(&ground, s->conductivity, s->heat_capacity, forcing->period_s,
                   forcing->at(forcing->context, 0).kelvin);
    for (int i = 0; i < IR_STEPS; i++) {
        kelvin[i] = 0;
    }
    double change = 1;
    int periods = 0;
    while (change > close_kelvin && periods < IR_PERIODS_MAX) {
        const struct gain mean = run_period(s, forcing, &ground, kelvin, &change);
        settle(&ground, &mean);
        periods++;
    }
    return periods;
}

static struct ir_air at_part(const void *weather, double part)
{
    return ir_weather_at(weather, 24 * part);
}

int ir_surface_day(const struct ir_surface *s, const struct ir_weather *w, double kelvin[IR_STEPS])
{
    const struct ir_forcing forcing = {at_part, w, 86400};
    return ir_surface_cycle(s, &forcing, kelvin);
}

double ir_day_value(const double kelvin[IR_STEPS], double hour)
{
    const double step = hour / 24 * IR_STEPS - 1; /* kelvin[0] is the end of the first step */
    const int before = (int)floor(step);
    const double within = step - before;
    const int i = (before + IR_STEPS) % IR_STEPS;
    return kelvin[i] + (kelvin[(i + 1) % IR_STEPS] - kelvin[i]) * within;
}
