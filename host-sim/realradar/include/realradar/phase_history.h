/* Phase history of a spotlight radar: for each pulse the echo at each frequency and the
 * antenna's position. Read from the MATLAB files of the AFRL Gotcha volumetric data set (readme
 * SN-07-0045). */
#ifndef REALRADAR_PHASE_HISTORY_H
#define REALRADAR_PHASE_HISTORY_H

#include <complex.h>

/* Metres, in a level frame whose origin is the centre of the scene; z is up. */
struct rr_place {
    double x, y, z;
};

struct rr_phase_history {
    int frequencies, pulses;
    double first_hz, step_hz; /* frequency n is first_hz + n * step_hz */
    double complex *echo;     /* owned; pulses rows of `frequencies` values */
    struct rr_place *antenna; /* owned; of each pulse */
    double *reference_m; /* owned; slant range at which the echo's phase is zero, of each pulse */
};

/* The two directions on the ground in which the picture's resolution is described, and the
 * textbook width of a resolution cell in each: c/2B and lambda/(2 theta), both projected on the
 * ground. The half-power width is 0.886 of that without weighting (Carrara, Goodman and Majewski,
 * "Spotlight Synthetic Aperture Radar", 1995, section 2). */
struct rr_resolution {
    struct rr_place range, cross; /* unit vectors; range points away from the radar */
    double range_m, cross_m;
    double bandwidth_hz, wavelength_m, aperture_rad, grazing_rad;
};

/* Allocate room for the sizes given, all zero. Returns 0, or -1 with the error reported. */
int rr_phase_history_alloc(struct rr_phase_history *ph, int frequencies, int pulses);

/* Read the variable `data` of a MATLAB file: fields fp, freq, x, y, z and r0. The frequencies must
 * be evenly spaced to 1/100 step and every number finite. Returns 0, or -1 with the error reported
 * and nothing to free. */
int rr_phase_history_read(struct rr_phase_history *ph, const char *path);

/* The same flight and frequencies with no echo. Returns 0, or -1 with the error reported. */
int rr_phase_history_alike(struct rr_phase_history *ph, const struct rr_phase_history *model);

/* Add the echo of a point of the given amplitude. */
void rr_phase_history_add_point(struct rr_phase_history *ph, struct rr_place place,
                                double amplitude);

/* Replace the echo by complex Gaussian noise: the echo of endless even ground, seen through nothing
 * but the radar's own band and aperture. */
void rr_phase_history_fill_noise(struct rr_phase_history *ph, unsigned seed);

/* Harmless on a zeroed struct. */
void rr_phase_history_free(struct rr_phase_history *ph);

/* Needs two pulses or more. */
struct rr_resolution rr_resolution_of(const struct rr_phase_history *ph);

/* Straight distance between two places, metres. */
double rr_distance_m(struct rr_place a, struct rr_place b);

/* `from` plus `length_m` times the unit vector. */
struct rr_place rr_place_along(struct rr_place from, struct rr_place direction, double length_m);

extern const double rr_light_m_s;

#endif
