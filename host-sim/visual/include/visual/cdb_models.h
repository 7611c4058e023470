/* Models of a CDB tree: buildings and the like, placed by the points of the feature datasets. */
#ifndef VISUAL_CDB_MODELS_H
#define VISUAL_CDB_MODELS_H

#include "visual/cdb.h"
#include "visual/scene.h"

struct cdb_models {
    const struct visual_cdb *cdb; /* borrowed, as all here */
    const struct cdb_grid *cells; /* of the canvas */
    const struct cdb_grid *post_grid;
    const float *posts;     /* elevation; NULL: none, the ground is at 0 m */
    cdb_class_fn *class_of; /* of a material, or else of a feature code such as AL015 */
    void *class_context;
    bool boxes; /* a feature without its model becomes a box of the size its table says */
};

struct cdb_models_count {
    uint64_t features, placed, boxed;
    uint64_t missing;    /* features left out: their model is not in the tree, or not named */
    uint64_t unreadable; /* features left out: their model cannot be read (reported) */
    uint64_t unclassed;  /* features none of whose names stands for a class */
    uint32_t lost_textures;
    char first_missing[VISUAL_PATH_SIZE], lost[VISUAL_PATH_SIZE];
};

/* Place all point features with models of datasets 100 and 101 into the scene; heights are above
 * the ground. Draws a progress bar. Returns 0, or -1 with the error reported: a table cannot be
 * read, or there are too many triangles. */
int visual_cdb_place_models(const struct cdb_models *m, struct visual_cdb *cdb,
                            struct visual_scene *scene, struct cdb_models_count *count);

#endif
