/* Canvas: what a visual database shows from straight above, cell by cell. */
#ifndef VISUAL_CANVAS_H
#define VISUAL_CANVAS_H

#include <stdint.h>

enum {
    VISUAL_PATCHES_MAX = 65535, /* numbered from 1; 0 is no patch */
    VISUAL_PATCH_NAME_SIZE = 96,
};
#define VISUAL_CELLS_MAX ((uint64_t)1 << 27) /* 1.9 GB of canvas */

/* Names of the pictures that the colours come from. */
struct visual_patches {
    char (*names)[VISUAL_PATCH_NAME_SIZE]; /* owned: name of patch i + 1 */
    uint32_t count, room;
};

/* The number of a name, which is added when it is new; 0 when there is no room or no memory. */
uint32_t visual_patch(struct visual_patches *p, const char *name);
void visual_patches_free(struct visual_patches *p);

struct visual_canvas {
    int width, height;
    uint8_t *rgb[3];  /* owned planes; from the north-west */
    uint16_t *patch;  /* owned: 0 where nothing is seen */
    uint8_t *classes; /* owned: DB_CLASS_NODATA where the material has none */
    float *top;       /* owned: metres of the highest surface; NAN: none */
    float *ground;    /* owned: of the highest surface of ground or water; NAN: none */
};

/* Empty cells. Returns 0, or -1 with the error reported: more than VISUAL_CELLS_MAX, or no memory.
 */
int visual_canvas_open(struct visual_canvas *c, double width, double height, const char *place);
/* Harmless on a zeroed struct. */
void visual_canvas_close(struct visual_canvas *c);

/* Give ground to the cells without it, from the nearest around them, weighted by distance (GDAL's
 * fill). Returns how many were filled; -1 with the error reported when there is no ground at all or
 * no memory. */
int64_t visual_canvas_fill_ground(struct visual_canvas *c, const char *place);

#endif
