#include "image/scatterer_kinds.h"

const struct scatterer_kind scatterer_kinds[LM_SHAPE_KINDS] = {
    [LM_SHAPE_SPHERE] = {"sphere", 1, false},
    [LM_SHAPE_PLATE] = {"plate", 2, true},
    [LM_SHAPE_DIHEDRAL] = {"dihedral", 2, true},
    [LM_SHAPE_TRIHEDRAL] = {"trihedral", 1, true},
};
