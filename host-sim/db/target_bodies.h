/* The kinds of bodies of a target, as text has them. */
#ifndef TARGET_BODIES_H
#define TARGET_BODIES_H

#include "lm/rcs.h"

#include <stdbool.h>

struct target_body {
    const char *name;
    int sizes; /* of LM_SHAPE_...: how many it has */
    bool has_direction;
};

extern const struct target_body target_bodies[LM_SHAPE_KINDS]; /* [0] is none */

#endif
