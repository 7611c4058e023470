/* Heat in the ground: conduction in one dimension below a surface.
 *
 * Nodes lie on the surface and below it, ever farther apart, down to where a wave of the period is
 * damped to 2 %; no heat passes there. Steps are implicit (backward Euler): stable for any length,
 * with an error that is proportional to it. */
#ifndef INFRARED_GROUND_H
#define INFRARED_GROUND_H

enum { IR_NODES = 40 };

struct ir_ground {
    double conductance[IR_NODES]; /* from a node to the next, W/(m2 K); of the last 0 */
    double capacity[IR_NODES];    /* of the ground around a node, J/(m2 K) */
    double depth_m[IR_NODES];
    double kelvin[IR_NODES];
    double from_above[IR_NODES], rest[IR_NODES]; /* scratch: kelvin = rest + from_above * above */
};

/* How the heat that enters the surface depends on the surface's temperature at the end of a step:
 * slope * kelvin - offset, W/m2. */
struct ir_uptake {
    double slope, offset;
};

/* The depth at which a wave of the period has 1/e of its amplitude: sqrt(2 k / (C w)). Conductivity
 * in W/(m K), heat capacity in J/(m3 K), both above 0. */
double ir_damping_depth_m(double conductivity, double heat_capacity, double period_s);

/* All at one temperature. */
void ir_ground_init(struct ir_ground *g, double conductivity, double heat_capacity, double period_s,
                    double kelvin);

/* The two halves of a step of `seconds`: what the ground takes up, and all temperatures once the
 * surface's is known. */
struct ir_uptake ir_ground_uptake(struct ir_ground *g, double seconds);
void ir_ground_step(struct ir_ground *g, double surface_kelvin);

#endif
