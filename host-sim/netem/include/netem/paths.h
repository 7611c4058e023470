/* Ray paths: traced records (tracer/records.h) in the form that the networks need. A table holds
 * the different reflections that occur; the paths lead each ray through that table into the cells
 * of the picture (Niu, Figs. 8 to 11).
 *
 * Rays fall parallel on flat facets, so thousands of reflections have the same angles. Each network
 * sees every different reflection once, and the gradients of equal ones are added: the result is
 * that of one evaluation a ray, some hundred times faster. Where intensities are handed on (Fig.
 * 10), what arrives differs with the way before: two reflections are equal if that is equal, too.
 */
#ifndef NETEM_PATHS_H
#define NETEM_PATHS_H

#include "netem/architecture.h"
#include "tracer/records.h"

#include <stddef.h>
#include <stdint.h>

/* Directions of a reflection: back to the radar, and specular. */
enum nm_direction { NM_BK, NM_SP, NM_DIRECTIONS };

/* Angles closer than this count as the same reflection; 1e-3 rad is a seventeenth of the step
 * between two chips of a collection. */
#define NM_ANGLE_STEP_RAD 1e-3

/* What a material is made of, as tracer/reflect.h has it; all 0 where nobody asks. */
struct nm_surface {
    double permittivity, loss; /* relative: permittivity - i loss */
    double rms_height_m, correlation_m;
};

/* The geometry of one reflection in one direction. */
struct nm_reflection {
    double incidence_rad; /* 0..pi/2 */
    double leaving_rad;   /* way out to the normal: 0..pi/2 (BK: up to pi, if blocked) */
    double turn_rad;      /* between the ways in and out, 0..pi */
    int material;
    struct nm_surface surface; /* of that material */
    double side_rad;           /* azimuth from which the radar looks at the target */
};

/* One reflection of one ray. */
struct nm_step {
    int32_t row[NM_DIRECTIONS]; /* of the tables; row[NM_SP] is -1 when the ray does not go on */
    int32_t cell;               /* of the echo; -1 when blocked or outside the picture */
};

/* The reflection before, whose specular intensity arrives; -1: the radar's own, which is 1. */
struct nm_from {
    int32_t row[NM_DIRECTIONS]; /* of the tables */
};

struct nm_paths {
    enum nm_connection connection; /* NM_BY_INTENSITY serves both */
    int cells_across, cells_range;
    double ray_weight;                           /* power of a ray: cell areas it stands for */
    int rows[NM_DIRECTIONS];                     /* different reflections */
    struct nm_reflection *table[NM_DIRECTIONS];  /* owned */
    struct nm_from *from[NM_DIRECTIONS];         /* owned, by row; NULL with NM_BY_COEFFICIENT */
    int until[NM_DIRECTIONS][TRACE_BOUNCES_MAX]; /* with from: rows up to that bounce's end */
    int ray_count;
    int32_t *first;        /* owned: ray_count + 1; steps of ray i */
    struct nm_step *steps; /* owned: those of a ray follow one another */
};

/* Names of materials, in the order in which the networks know them as numbers. */
struct nm_materials {
    uint32_t count;
    char names[TRACE_MATERIALS_MAX][TRACE_NAME_SIZE];
    struct nm_surface surfaces[TRACE_MATERIALS_MAX]; /* all 0, unless networks are told of them */
};

/* The number in `known` of each material of the records, by name. Returns 0, or -1 with the error
 * reported when `known` lacks one. NULL for `known` keeps the records'
 * own numbers. */
int nm_materials_match(const struct nm_materials *known, const struct trace_records *records,
                       uint8_t number[TRACE_MATERIALS_MAX]);

/* Builds the paths of checked records for networks of that connection. Materials get their numbers
 * from `known`, or keep their own if that is NULL. Rays that leave no echo in the picture are left
 * out. Returns 0, or -1 with the error reported: a material that `known` lacks, or out of memory.
 */
int nm_paths_build(struct nm_paths *paths, const struct trace_records *records,
                   const struct nm_materials *known, enum nm_connection connection);
void nm_paths_free(struct nm_paths *paths);

/* The inputs of a network of the architecture for one reflection, which so much intensity meets,
 * 0..1. The paper's are within -1..1 for materials 0..2. */
void nm_features_of(const struct nm_architecture *a, const struct nm_reflection *reflection,
                    double intensity, double features[NM_INPUTS_MAX]);

/* Slope of the input that is the intensity. */
#define NM_INTENSITY_SLOPE 2.0

/* Reflection coefficients for every row of the tables, or the intensities themselves. Where one
 * network gives both directions at once, `sp` goes by the rows of the BK table: sp_by says which
 * table's. */
struct nm_coefficients {
    const double *bk, *sp;
    enum nm_direction sp_by;
    enum nm_connection connection;
};

/* Step 4: adds the echoes up. `image`, cells_range rows of cells_across, is overwritten. */
void nm_paths_render(const struct nm_paths *paths, const struct nm_coefficients *c, double *image);

/* Its derivative: adds to `bk` and `sp`, by the rows of `c`, what d_image does to them. */
void nm_paths_backward(const struct nm_paths *paths, const struct nm_coefficients *c,
                       const double *d_image, double *bk, double *sp);

#endif
