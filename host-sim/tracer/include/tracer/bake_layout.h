/* Layout of a baked signature: the size of its pixels, and the cells in which it is traced. */
#ifndef TRACER_BAKE_LAYOUT_H
#define TRACER_BAKE_LAYOUT_H

#include "lm/signature.h"
#include "tracer/mesh.h"
#include "tracer/records.h"

/* From where a signature is seen. */
struct bake_looks {
    long aspects;                                        /* 1..LM_SIGNATURE_ASPECTS_MAX */
    int depressions;                                     /* 1..LM_SIGNATURE_DEPRESSIONS_MAX */
    double depression_deg[LM_SIGNATURE_DEPRESSIONS_MAX]; /* rising, 1..89 */
};

/* Azimuth of aspect 0..aspects - 1: evenly around, the first at 0. */
double bake_azimuth_deg(const struct bake_looks *looks, long aspect);

struct bake_layout {
    uint32_t pixel_mm;
    uint32_t origin_row;       /* as in struct lm_signature */
    double height_m, radius_m; /* of the model above and around its origin */
};

/* A whole shadow makes pixels no larger than this: half a metre is the finest cell of the SAR. */
#define BAKE_PIXEL_ENOUGH_M 0.5
/* A longer shadow than that at this depression is otherwise cut at the edge of the chip. */
#define BAKE_SHADOW_DEG 15.0

/* The smallest pixels that hold, from all sides, the model, what of it leans towards the radar at
 * the steepest look, and its shadow: the whole of it where pixels of BAKE_PIXEL_ENOUGH_M do, or
 * else as much as it throws at BAKE_SHADOW_DEG. With pixel_m > 0, pixels of that size: they must
 * hold the model and its lean. Returns 0, or -1 with the error reported with `place`. Cost: aspects
 * x vertices. */
int bake_layout(struct bake_layout *l, const struct mesh *m, const struct bake_looks *looks,
                double pixel_m, const char *place);

/* Cells for a look: `cell_m` large, a chip wide, and so deep that all rays are sent that meet the
 * chip, or go by the ground to a part of the model. */
struct trace_grid bake_grid(const struct bake_layout *l, double cell_m, double depression_deg);

#endif
