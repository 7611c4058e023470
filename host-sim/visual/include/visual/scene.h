/* Scene of a visual database: models placed over the cells of a canvas, looked at from straight
 * above. Embree finds the surface at the middle of each cell. */
#ifndef VISUAL_SCENE_H
#define VISUAL_SCENE_H

#include "visual/canvas.h"
#include "visual/model.h"
#include "visual/texture.h"

#include <stddef.h>

/* Triangle over the canvas: x in cells from its west edge, y in cells from its north edge. */
struct visual_facet {
    float x[3], y[3], z[3], u[3], v[3];
    uint32_t material; /* of the scene */
    uint8_t rgb[3];
    uint8_t class_index;
};

struct visual_skin {
    struct visual_texture texture; /* owned; width 0: none */
    uint16_t patch;
    uint8_t wrap[2];
};

struct visual_scene {
    struct visual_facet *facets; /* owned */
    struct visual_skin *skins;   /* owned: one a material of each model */
    size_t facet_count, facet_room;
    uint32_t skin_count, skin_room;
    struct visual_patches *patches; /* borrowed */
    uint32_t lost_textures;         /* that cannot be read */
    char lost[VISUAL_PATH_SIZE];    /* the first of them */
    uint64_t texture_bytes;
};

enum { VISUAL_TEXTURE_MIB = 2048 /* of all textures; what is beyond counts as lost */ };

/* Where a model goes: cells = at + by * (east, north), metres = up + up_by * z. */
struct visual_place {
    double at[2], by[2][2], up, up_by;
};

/* Take the textures of a model. Returns the number of its first skin, or -1 with the error
 * reported. `label` stands before the names of patches without a texture; may be empty. */
int64_t visual_scene_skins(struct visual_scene *s, const struct visual_model *m, const char *label);

/* Place a model whose skins begin at first_skin. class_of[material] is the class of each material.
 * Returns 0, or -1 with the error reported: there are too many triangles, or no memory. */
int visual_scene_place(struct visual_scene *s, const struct visual_model *m, uint32_t first_skin,
                       const struct visual_place *place, const uint8_t *class_of);

/* Look down on the middles of all cells. The topmost surface gives colour, patch, class and `top`;
 * what is more than half transparent is looked through. `is_ground[class]` says which surfaces make
 * `ground`. Cells that nothing covers stay as they were, and so do those whose `top` is as high.
 * Draws a progress bar. Returns 0, or -1 with the error reported. */
int visual_scene_look(const struct visual_scene *s, struct visual_canvas *c,
                      const bool is_ground[256], const char *place);

/* Harmless on a zeroed struct. */
void visual_scene_free(struct visual_scene *s);

#endif
