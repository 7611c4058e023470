#include "target_bodies.h"

const struct target_body target_bodies[LM_SHAPE_KINDS] = {
    [LM_SHAPE_SPHERE] = {"sphere", 1, false},
    [LM_SHAPE_PLATE] = {"plate", 2, true},
    [LM_SHAPE_DIHEDRAL] = {"dihedral", 2, true},
    [LM_SHAPE_TRIHEDRAL] = {"trihedral", 1, true},
};
