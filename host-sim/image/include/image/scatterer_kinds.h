/* Kinds of scatterers of a target: their names in text files and how many sizes each has. */
#ifndef IMAGE_SCATTERER_KINDS_H
#define IMAGE_SCATTERER_KINDS_H

#include "lm/rcs.h"

#include <stdbool.h>

struct scatterer_kind {
    const char *name;
    int sizes; /* of LM_SHAPE_...: how many it has */
    bool has_direction;
};

extern const struct scatterer_kind scatterer_kinds[LM_SHAPE_KINDS]; /* [0] is none */

#endif
