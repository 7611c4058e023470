/* Baking of a signature (lm/signature.h): a model traced from many aspects into the chips that a
 * display unit shows.
 *
 * What is in a chip. Each look is traced with level ground under the model, and its echoes are put
 * where they lie on the ground: row = slant range / cos(depression). The ground's own direct
 * return, the first reflection at the material "ground", is left out: the scene in which the target
 * stands has its own. What reaches the radar by way of the ground stays. The radar's response and
 * speckle are not in it: the display has those. A pixel is shadow when the way from most of its
 * ground to the radar is blocked. */
#ifndef TRACER_BAKE_H
#define TRACER_BAKE_H

#include "hs/signature_file.h"
#include "tracer/bake_layout.h"

/* Who makes power of what was traced: a law of reflection, or networks that were trained. */
struct bake_maker {
    void *ctx;

    /* The cross section, m^2, that each cell of r->grid returns, before the gain; `power` has
     * cells_across * cells_range numbers, near row first. Records that are TRACE_BLOCKED return
     * nothing. 0, or -1 with the error reported. */
    int (*draw)(void *ctx, const struct trace_records *r, float *power);
};

struct bake_order {
    const char *name;  /* of the signature */
    const char *place; /* for messages: the model */
    struct bake_looks looks;
    struct bake_layout layout;
    struct trace_grid grid; /* of every look; cells_across 0: quarter pixels by bake_grid */
    double wavelength_m;
    uint32_t rays_per_cell, bounces, threads; /* as in struct trace_order */
    double gain_db;                           /* of cross sections over the maker's power */
    double mean_dbsm; /* unless NAN, in place of the gain: the mean of all looks' cross sections */
    struct bake_maker maker;
};

struct bake_report {
    double gain_db;                          /* that was applied */
    double mean_dbsm, least_dbsm, most_dbsm; /* of the looks' cross sections */
    double lost_share;                       /* of all power: it fell outside the chips */
    uint32_t saturated;                      /* pixels brighter than the brightest code */
};

/* Bake the mesh. `s` is filled, not yet sealed, and the caller frees it. Returns 0, or -1 with the
 * error reported and nothing to free. Shows progress. Cost: one trace a look, and 65,536 rays for
 * its shadow. */
int bake(const struct bake_order *o, const struct mesh *m, struct db_signature *s,
         struct bake_report *report);

/* The code of a cross section, to the nearest half decibel; 0 for none, and what is less than the
 * least code's by more than a quarter decibel; never more than 255. */
uint8_t bake_code(double rcs_m2);

#endif
