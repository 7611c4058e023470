#include "infrared/class_days.h"

#include <math.h>
#include <string.h>

enum { MIDDLE = IR_KNOTS / 2 };

static const double rise_step = 0.4;
static const double albedo_max = 0.98, conductivity_share_min = 0.1;

struct ir_surface ir_surface_of_class(const struct db_thermal *t)
{
    return (struct ir_surface){.emissivity = t->emissivity,
                               .albedo = t->albedo,
                               .conductivity = t->conductivity,
                               .heat_capacity = 1e6 * t->heat_capacity,
                               .wetness = t->wetness,
                               .roughness_m = t->roughness_m};
}

/* Albedo and conductivity `a` and `b` spreads from the means. */
static struct ir_surface of_ranks(const struct db_thermal *t, int a, int b)
{
    struct ir_surface s = ir_surface_of_class(t);
    s.albedo = fmin(fmax(t->albedo + a * t->albedo_spread, 0), albedo_max);
    s.conductivity = fmax(t->conductivity + b * t->conductivity_spread,
                          conductivity_share_min * t->conductivity);
    return s;
}

static struct ir_surface of_slope(const struct db_thermal *t, int a, int b)
{
    struct ir_surface s = ir_surface_of_class(t);
    s.rise_east = a * rise_step;
    s.rise_north = b * rise_step;
    return s;
}

void ir_class_days_make(struct ir_class_days *days, const struct db_thermal *t,
                        const struct ir_weather *w, bool has_slopes)
{
    struct ir_surface shaded = ir_surface_of_class(t);
    shaded.is_shaded = true;
    ir_surface_day(&shaded, w, days->shade);
    for (int i = 0; i < IR_KNOTS; i++) {
        for (int k = 0; k < IR_KNOTS; k++) {
            const int a = i - MIDDLE, b = k - MIDDLE;
            const struct ir_surface s = of_ranks(t, a, b);
            ir_surface_day(&s, w, days->property[i][k]);
            const struct ir_surface sloping = of_slope(t, a, b);
            if (has_slopes) {
                ir_surface_day(&sloping, w, days->slope[i][k]);
            } else {
                memset(days->slope[i][k], 0, sizeof days->slope[i][k]);
            }
        }
    }
}

void ir_class_days_set_mean(struct ir_class_days *days, double kelvin)
{
    double shift = kelvin;
    for (int i = 0; i < IR_STEPS; i++) {
        shift -= days->property[MIDDLE][MIDDLE][i] / IR_STEPS;
    }
    double *value = &days->property[0][0][0];
    for (int i = 0; i < IR_KNOTS * IR_KNOTS * IR_STEPS; i++) {
        value[i] += shift;
    }
    for (int i = 0; i < IR_STEPS; i++) { /* Water mixes: its shade is as warm. */
        days->shade[i] = days->property[MIDDLE][MIDDLE][i];
    }
}

void ir_class_hour_of(struct ir_class_hour *hour, const struct ir_class_days *days, double hour_h)
{
    for (int i = 0; i < IR_KNOTS; i++) {
        for (int k = 0; k < IR_KNOTS; k++) {
            hour->property[i][k] = ir_day_value(days->property[i][k], hour_h);
            hour->slope[i][k] = ir_day_value(days->slope[i][k], hour_h);
        }
    }
    hour->shade = ir_day_value(days->shade, hour_h);
}

/* Bilinear between the knots, `x` and `y` in steps from the middle one. */
static double between(const double knots[IR_KNOTS][IR_KNOTS], double x, double y)
{
    const double u = fmin(fmax(x + MIDDLE, 0), IR_KNOTS - 1);
    const double v = fmin(fmax(y + MIDDLE, 0), IR_KNOTS - 1);
    const int i = (int)fmin(u, IR_KNOTS - 2), k = (int)fmin(v, IR_KNOTS - 2);
    const double a = u - i, b = v - k;
    return (1 - a) * ((1 - b) * knots[i][k] + b * knots[i][k + 1]) +
           a * ((1 - b) * knots[i + 1][k] + b * knots[i + 1][k + 1]);
}

double ir_class_hour_at(const struct ir_class_hour *hour, const struct ir_place *place)
{
    const double by_slope =
        between(hour->slope, place->rise_east / rise_step, place->rise_north / rise_step) -
        hour->slope[MIDDLE][MIDDLE];
    /* A slope that the sun does not reach has no more to lose to a shadow. */
    const double by_beam = fmax(0, hour->property[MIDDLE][MIDDLE] + by_slope - hour->shade);
    return between(hour->property, place->albedo_rank, place->conductivity_rank) + by_slope -
           place->hidden * by_beam;
}
