/* Detail of the scene: the footprints of what is built, and the lines that a raster is too coarse
 * for. The painters add to it while they paint; detail_write makes the text file that
 * `landmass-db build --detail` reads (docs/database.md, "Detail"). */
#ifndef SCENE_DETAIL_H
#define SCENE_DETAIL_H

#include "scene/material.h"
#include "scene/shape.h"

#include <stdbool.h>
#include <stdint.h>

/* A box on the ground: of a building, a ship, a stack of containers. */
struct detail_block {
    struct frame middle; /* origin, and the direction of the length */
    double length_m, width_m, height_m;
    enum material material;
    uint8_t variant; /* of the material: with it what the canvas shows of this block alone */
};

/* Something long and thin. */
enum detail_line_kind { DETAIL_FENCE, DETAIL_RAIL, DETAIL_WIRE, DETAIL_RAILING, DETAIL_LINE_KINDS };

struct detail_line {
    struct point from, to;
    enum detail_line_kind kind;
};

struct detail_mast {
    struct point at;
    double height_m;
};

/* Paving as a straight strip, or the verge that lies under it and covers what paving the raster has
 * beside it. */
struct detail_strip {
    struct point from, to; /* of its middle line */
    double width_m;
    enum material_class ground;
    bool is_verge;
};

/* Owned by the scene; free with detail_free. */
struct detail {
    struct detail_block *blocks;
    struct detail_line *lines;
    struct detail_mast *masts;
    struct detail_strip *strips;
    int block_count, line_count, mast_count, strip_count;
    bool is_short; /* memory ran out: something is missing */
};

/* Add a polygon as a box as large, along its longest edge; a disc, which has more corners than any
 * building, as two boxes across each other. Height and material are those of `what`. */
void detail_add_footprint(struct detail *d, const struct point *p, int count,
                          const struct detail_block *what);
void detail_add_line(struct detail *d, struct point from, struct point to,
                     enum detail_line_kind kind);
void detail_add_strip(struct detail *d, const struct detail_strip *strip);
/* Fence along all edges of a closed outline. */
void detail_add_fence(struct detail *d, const struct point *p, int count);
/* Wires between masts about `span_m` apart, which stand at both ends, too. */
void detail_add_power_line(struct detail *d, struct point from, struct point to, double span_m,
                           double height_m);
void detail_free(struct detail *d);

#endif
