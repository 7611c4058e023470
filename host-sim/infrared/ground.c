#include "infrared/ground.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Depth of the ground in damping depths, and how much longer each gap is than the one above. A heat
 * flux of the period that meets the end is reflected and comes back e^-8 of what it was. */
static const double reach = 4, growth = 1.1;

double ir_damping_depth_m(double conductivity, double heat_capacity, double period_s)
{
    return sqrt(conductivity * period_s / (pi * heat_capacity));
}

void ir_ground_init(struct ir_ground *g, double conductivity, double heat_capacity, double period_s,
                    double kelvin)
{
    const double deepest_m = reach * ir_damping_depth_m(conductivity, heat_capacity, period_s);
    double gap_m = deepest_m * (growth - 1) / (pow(growth, IR_NODES - 1) - 1);
    double depth_m = 0, above_m = 0;
    for (int i = 0; i < IR_NODES; i++) {
        const double below_m = i < IR_NODES - 1 ? gap_m : 0;
        g->depth_m[i] = depth_m;
        g->kelvin[i] = kelvin;
        g->capacity[i] = heat_capacity * (above_m + below_m) / 2;
        g->conductance[i] = below_m > 0 ? conductivity / below_m : 0;
        depth_m += below_m;
        above_m = below_m;
        gap_m *= growth;
    }
}

/* Heat balance of node i at the end of the step, from the deepest upwards:
 * C (T - T before) / t = g above (T above - T) - g below (T - T below),
 * where T below = rest + from_above T is known already. */
struct ir_uptake ir_ground_uptake(struct ir_ground *g, double seconds)
{
    double below = 0, rest_below = 0; /* what node i gives downwards: below T - rest_below */
    for (int i = IR_NODES - 1; i > 0; i--) {
        const double store = g->capacity[i] / seconds, above = g->conductance[i - 1];
        const double whole = store + above + below;
        g->from_above[i] = above / whole;
        g->rest[i] = (store * g->kelvin[i] + rest_below) / whole;
        below = above * (1 - g->from_above[i]);
        rest_below = above * g->rest[i];
    }
    const double store = g->capacity[0] / seconds;
    return (struct ir_uptake){store + below, store * g->kelvin[0] + rest_below};
}

void ir_ground_step(struct ir_ground *g, double surface_kelvin)
{
    g->kelvin[0] = surface_kelvin;
    for (int i = 1; i < IR_NODES; i++) {
        g->kelvin[i] = g->rest[i] + g->from_above[i] * g->kelvin[i - 1];
    }
}
