/* Built-in models, made from their dimensions. */
#ifndef TRACER_MODELS_H
#define TRACER_MODELS_H

#include "tracer/mesh.h"

struct model_kind {
    const char *name, *help;
    bool is_open; /* has plates or tubes, whose both sides are seen */
    void (*build)(struct mesh *m);
};

extern const struct model_kind model_kinds[];
extern const int model_kind_count;

/* NULL when there is none of that name. */
const struct model_kind *model_find(const char *name);

/* Add the Sandia Laboratory Implementation of Cylinders, x towards its step. Dimensions: base box
 * 2.445 x 2.75 x 0.46 m, upper box 2.131 x 2.75 x 0.314 m, a quarter round on the step, a closed
 * and an open cylinder of 0.66 m diameter, 0.915 and 0.458 m high, a trihedral of plates 0.207 m
 * aside; 1.689 m in all. Places measured on a published mesh. */
void model_slicy(struct mesh *m);

/* Add a tank of a T-72's outer dimensions: hull 6.95 m, 9.53 m with the gun, 3.59 m wide, 2.23 m
 * high, 0.49 m ground clearance, six road wheels aside ("T-72", Wikipedia). All within that is
 * estimated from photographs: it has the right parts at about the right places. */
void model_tank(struct mesh *m);

/* Add a fighter of an F-16's overall dimensions: 49 ft 5 in long, 32 ft 8 in wide with missiles at
 * its wing tips, 16 ft high (armedforces.co.uk, "F-16"); two tanks below the wings, wheels down. */
void model_aircraft(struct mesh *m);

/* Add a lorry of three axles with a box body, 7.3 x 2.5 x 3.1 m. */
void model_lorry(struct mesh *m);

/* Add an arched shelter for an aircraft, shut: 30 m long, 24 m wide, 8 m high. */
void model_shelter(struct mesh *m);

#endif
