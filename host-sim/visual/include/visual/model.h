/* Model of a visual database: its triangles as one list, with materials. OpenFlight is converted by
 * OpenSceneGraph's osgconv, everything else is read by Assimp. Both run in processes of their own
 * under limits, so that a hostile file costs an error and no more. */
#ifndef VISUAL_MODEL_H
#define VISUAL_MODEL_H

#include <stdbool.h>
#include <stdint.h>

enum {
    VISUAL_TRIANGLES_MAX = 1 << 24,
    VISUAL_MATERIALS_MAX = 60000,
    VISUAL_NAME_SIZE = 64,
    VISUAL_PATH_SIZE = 1024,
    VISUAL_READER_MIB = 4096,   /* address space of a reader */
    VISUAL_READER_SECONDS = 600 /* processor time of a reader */
};

enum visual_up { VISUAL_UP_UNKNOWN, VISUAL_UP_Y, VISUAL_UP_Z };
enum visual_wrap { VISUAL_WRAP_REPEAT, VISUAL_WRAP_CLAMP, VISUAL_WRAP_MIRROR };

/* What the user says of a file that does not say it itself, and wants of it. */
struct visual_axes {
    double metres_per_unit; /* 0: not given */
    enum visual_up up;
    bool keeps_walls; /* keep triangles of which nothing is seen from above */
};

struct visual_triangle {
    float x[3], y[3], z[3]; /* metres east, north and up of the model's origin */
    float u[3], v[3];       /* place in the texture; v from below */
    uint32_t material;
    uint8_t rgb[3]; /* where the material has no texture */
    uint8_t unused;
};

struct visual_material {
    char name[VISUAL_NAME_SIZE];
    char texture[VISUAL_PATH_SIZE]; /* a path that GDAL opens; empty: none */
    uint8_t wrap[2];                /* enum visual_wrap along u and v */
    bool is_used;                   /* by a triangle */
};

struct visual_model {
    struct visual_triangle *triangles; /* owned */
    struct visual_material *materials; /* owned */
    uint32_t triangle_count, material_count;
    uint32_t upright;            /* triangles left out: nothing of them is seen from above */
    uint32_t crossed;            /* faces that their triangles do not fill: their outline crosses
                                    itself or folds back */
    uint32_t not_finite;         /* left out: a corner is no number, or farther than 1e7 m */
    uint32_t lost_textures;      /* that the reader looked for in vain */
    char lost[VISUAL_PATH_SIZE]; /* the first of them */
    void *embedded;              /* owned: textures of the file itself, behind /vsimem names */
    char (*embedded_names)[VISUAL_NAME_SIZE]; /* owned */
    uint32_t embedded_count;
};

/* Does this kind of file say how long its unit is and what is up? */
bool visual_model_says_axes(const char *path);

/* Read a file. `search` is a folder where textures of OpenFlight are looked for besides the file's
 * own; NULL: none. Corners come in metres, z up. glTF and OpenFlight have units and axes by their
 * standards, Collada says them in the file, and `axes` says those of all others. Returns 0, or -1
 * with the error reported and nothing to free:
 * - it is no ordinary file, or larger than 1 GiB,
 * - the kind of file is unknown, or needs osgconv, which is not installed,
 * - units or axes are not known, or are given although the file has its own,
 * - the reader fails, crashes, or exceeds its limits of memory and time,
 * - the model has no triangle, or more than VISUAL_TRIANGLES_MAX, or too many materials. */
int visual_model_read(struct visual_model *m, const char *path, const char *search,
                      const struct visual_axes *axes);

/* Harmless on a zeroed struct. */
void visual_model_free(struct visual_model *m);

#endif
