/* Setup of a trace: the options that most sub-commands share, for the model, the aspect from which
 * it is seen, the cells, and the law of reflection. */
#ifndef TRACER_SETUP_H
#define TRACER_SETUP_H

#include "hs/options.h"
#include "tracer/edges.h"
#include "tracer/focus.h"
#include "tracer/mesh_zones.h"
#include "tracer/pix.h"
#include "tracer/reflect.h"
#include "tracer/trace.h"

struct setup {
    /* the model */
    const char *model, *up;
    bool is_as_is;
    bool has_sides; /* zones left and right are of different materials */
    long zones;     /* cut into so many along, SETUP_ZONES_ASIDE and SETUP_ZONES_HIGH; 0: not */
    double scale, turn_deg;
    /* the look */
    double azimuth_deg, depression_deg, wavelength_m;
    double distance_m;                                                         /* 0: plane waves */
    double receiver_azimuth_deg, receiver_depression_deg, receiver_distance_m; /* NAN: not given */
    double cell_m;
    long cells, rays_per_cell, bounces, threads;
    bool has_no_ground;
    /* the law */
    const char *law, *materials, *ground;
    int channel; /* enum reflect_channel; with one, `law` may be fresnel or spm */
    /* the chip */
    double resolution_m, range_db;
    long ratio, looks, seed;
};

enum { SETUP_ZONES_ASIDE = 2, SETUP_ZONES_HIGH = 3 };

enum {
    SETUP_MODEL_OPTIONS = 5,
    SETUP_RAY_OPTIONS = 4,
    SETUP_TRACE_OPTIONS = SETUP_RAY_OPTIONS + 4,
    SETUP_ENDS_OPTIONS = 4,
    SETUP_LAW_OPTIONS = 3,
    SETUP_CHIP_OPTIONS = SETUP_LAW_OPTIONS + 5,
    SETUP_OPTIONS = SETUP_MODEL_OPTIONS + SETUP_TRACE_OPTIONS + SETUP_CHIP_OPTIONS
};

/* The defaults: [Niu]'s chip of 54 x 54 pixels of 0.2 m, 0.3 m resolution, X band. */
struct setup setup_default(void);

/* Fill in the options of each group. `o` has room for as many as the enum says. */
void setup_model_options(struct setup *s, struct hs_option *o);
void setup_ray_options(struct setup *s, struct hs_option *o);
void setup_trace_options(struct setup *s, struct hs_option *o); /* without the azimuth */
void setup_ends_options(struct setup *s, struct hs_option *o);  /* in no other group */
void setup_law_options(struct setup *s, struct hs_option *o);
void setup_chip_options(struct setup *s, struct hs_option *o); /* law and chip */
void setup_options(struct setup *s, struct hs_option *o);      /* all three, the model first */

/* The built-in or read model, checked and placed. Returns 0, or -1 reported. */
int setup_load(const struct setup *s, struct mesh *m);

/* The model on its ground, and how to trace it. Returns 0, or -1 reported. */
int setup_scene(const struct setup *s, struct scene *scene);
int setup_scene_of(const struct setup *s, const struct mesh *m, struct scene *scene); /* loaded */
struct trace_order setup_order(const struct setup *s, double azimuth_deg);

/* The law that `s` names, for the materials of `r`. Returns 0, or -1 reported: there is no such
 * law, or it names a polarisation and s->channel another, or neither does. */
int setup_law(const struct setup *s, const struct trace_records *r, struct reflect_law *law);

/* The chip of traced records: power per pixel, near row first; *width and *height pixels. The
 * caller frees it. NULL with the error reported. */
float *setup_chip(const struct setup *s, const struct trace_records *r, int *width, int *height);

/* The same before its last step: the power in each cell. */
float *setup_cells(const struct setup *s, const struct trace_records *r, int *width, int *height);

/* The same as complex numbers (tracer/focus.h): fields with their phase, under that weighting;
 * with those of edges, unless `edges` is NULL. */
float complex *setup_complex_chip(const struct setup *s, const struct trace_records *r,
                                  enum focus_weighting weighting, const struct edge_echoes *edges,
                                  int *width, int *height);

#endif
