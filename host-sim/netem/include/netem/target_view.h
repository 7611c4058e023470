/* Target views: a target traced from one aspect, made into paths, and drawn by a written law of
 * reflection. */
#ifndef NETEM_TARGET_VIEW_H
#define NETEM_TARGET_VIEW_H

#include "netem/paths.h"
#include "tracer/setup.h"

struct nm_target_view {
    struct setup setup; /* borrows what the command line lent it */
    struct scene scene; /* owned */
    const struct nm_materials
        *known;                    /* borrowed: those of a training; NULL: as the scene has them */
    enum nm_connection connection; /* of the networks that the paths are for */
};

/* The model on its ground; `lowest_depression_deg` is the flattest look that will be asked for.
 * Returns 0, or -1 with the error reported, also for cells that no chip can be made of. */
int nm_target_view_open(struct nm_target_view *v, const struct setup *setup,
                        double lowest_depression_deg);
void nm_target_view_close(struct nm_target_view *v);

/* Trace from an aspect. `law`, if not NULL, receives the law of the set-up for these materials, by
 * the numbers of v->known. Returns 0, or -1 with the error reported and nothing to free: also when
 * a material is not known. */
int nm_target_view_paths(const struct nm_target_view *v, double azimuth_deg, double depression_deg,
                         struct nm_paths *paths, struct reflect_law *law);

/* Step 4 by a law: `picture` has the cells of the paths. Returns 0, or -1 out of memory, reported.
 */
int nm_draw_by_law(const struct nm_paths *paths, const struct reflect_law *law, double *picture);

/* From step 4 by a law to the amplitudes that `landmass-target render --csv` writes: power is
 * spread by the squared response, averaged over each pixel, and its root taken. `picture` has
 * cells^2 numbers, `amplitudes` a number for each pixel. Returns 0, or -1 out of memory, reported.
 */
int nm_law_amplitudes(const struct setup *setup, const double *picture, double *amplitudes);

/* The law's coefficient for one reflection. */
double nm_law_ask(const struct reflect_law *law, const struct nm_reflection *reflection,
                  enum nm_direction direction);

/* The fixed kernel of step 5 (Fig. 14), NM_LARGE wide, `gain` in the middle: the magnitude of the
 * Taylor-weighted response of pix.h, `resolution_m` wide between its -3 dB points. */
void nm_kernel_make(double resolution_m, double cell_m, double gain, double *kernel);

/* The gain that makes a cell-wide mirror square to the line of sight an amplitude of the root of
 * its radar cross section in m^2: sqrt(4 pi) cell^2 / wavelength (flat plate, physical optics). */
double nm_kernel_gain(double cell_m, double wavelength_m);

#endif
