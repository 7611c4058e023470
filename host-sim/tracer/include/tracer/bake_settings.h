/* Bake settings: the options that `landmass-target bake` and `landmass-netem bake` share, and the
 * baking itself. */
#ifndef TRACER_BAKE_SETTINGS_H
#define TRACER_BAKE_SETTINGS_H

#include "hs/options.h"
#include "tracer/bake.h"
#include "tracer/setup.h"

struct bake_settings {
    const char *out, *name, *sheet;
    long aspects;
    struct hs_list depressions; /* degrees; none: bake_depressions */
    double pixel_m;             /* 0: worked out */
    double gain_db, mean_dbsm;  /* mean: NAN for the gain */
};

enum { BAKE_OPTIONS = 8 };

/* 72 aspects; depressions 5, 10, 15, 20, 30 and 45 degrees; that gain. */
struct bake_settings bake_settings_default(double gain_db);
void bake_settings_free(struct bake_settings *s);

/* `o` has room for BAKE_OPTIONS. */
void bake_options(struct bake_settings *s, struct hs_option *o);

/* The order that settings and set-up make for a mesh; its maker is still missing. It borrows from
 * both. Returns 0, or -1 with the error reported. */
int bake_plan(const struct bake_settings *s, const struct setup *setup, const struct mesh *m,
              struct bake_order *o);

/* Bake, write the file and the sheet, and print what came of it. Returns 0, or -1 with the error
 * reported. */
int bake_run(const struct bake_settings *s, const struct bake_order *o, const struct mesh *m);

#endif
