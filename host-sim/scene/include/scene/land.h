/* Land of the scene: coast, hills, river, lake, and the level ground of town, port and airfield.
 *
 * The scene is designed in its own axes, in metres from its centre: u away from the sea, v along
 * the coast to the left of u. The image looks at it turned by 17 degrees, so that nothing people
 * built lines up with the pixels. The design covers 12.8 km; a larger scene shows more of the same
 * country. */
#ifndef SCENE_LAND_H
#define SCENE_LAND_H

#include "scene/shape.h"

#include <stddef.h>
#include <stdint.h>

#define LAND_TURN_COS  0.95630475596303548 /* of 17 degrees */
#define LAND_TURN_SIN  0.29237170472273677
#define LAND_DESIGN_M  12800.0 /* side of the designed square */
#define LAND_SPACING_M 25.0    /* of the posts of terrain.tif */
#define LAND_PORT_M    3.0     /* height of the quays */

enum { LAND_RIVER_MAX = 512, LAND_STREAM_MAX = 64, LAND_STREAM_POINTS = 400 };

/* A stream that the hills drain through. */
struct land_stream {
    struct point p[LAND_STREAM_POINTS]; /* downstream */
    int count;
    double width_m;
};

/* Posts on a square grid in the axes of the image: column east, row south. */
struct land {
    uint64_t seed;
    int posts; /* a side */
    double spacing_m;
    double edge_m; /* east of the first post, and north of it (the grid is centred): -edge, +edge */
    float *height_m; /* above the sea */
    float *shore_m;  /* about the distance to the coast, positive on land */
    float *lake_m;   /* about the distance to the lake's shore, positive in its water */
    float *slope;    /* rise over run of the ground */
    float *light;    /* of the sun on the ground, 1 where it is level */
    float *wood;     /* how much the place is woodland: above 0 it is */
    struct point river[LAND_RIVER_MAX]; /* from the mouth up */
    double river_m[LAND_RIVER_MAX];     /* distance from the mouth */
    int river_count;
    struct land_stream *stream; /* LAND_STREAM_MAX of them */
    int stream_count;
    double lake_level_m, airfield_level_m;
};

/* Places of the design. */
struct point land_town(void);
struct point land_lake(void);
struct point land_port(void);
struct frame land_airfield(void); /* x along the runway, origin at its centre */

/* Make the land for an image `extent_m` on a side. Returns 0, or -1 when memory is short
 * (reported). Cost: about a second. */
int land_make(struct land *l, uint64_t seed, double extent_m);
void land_free(struct land *l);

/* From the image's axes (metres east and north of the centre) to those of the design, and back. */
struct point land_to_design(double east_m, double north_m);
void land_from_design(struct point p, double *east_m, double *north_m);

/* Bilinear reading of the fields of the grid at one place. */
struct land_reader {
    size_t post;   /* the post north-west of the place */
    size_t posts;  /* in a row */
    double tx, ty; /* how far east and south of it, 0..1 */
};

/* A place in the image's axes; what lies off the grid is read at its edge. */
struct land_reader land_reader_at(const struct land *l, double east_m, double north_m);
double land_read(const struct land_reader *r, const float *field);

/* The same for a single place of the design. */
double land_at(const struct land *l, const float *field, struct point p);

/* The direction to the sun in a late morning: east, north, up. */
#define LAND_SUN_EAST  0.473
#define LAND_SUN_NORTH (-0.473)
#define LAND_SUN_UP    0.743

/* The river's surface and width at `along_m` from its mouth. Both only ever grow upstream and
 * shrink upstream, respectively. */
double land_river_level(double along_m);
double land_river_width(double along_m);

#endif
