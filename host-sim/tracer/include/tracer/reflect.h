/* Laws of reflection, [Niu], step 3: what share of a ray's intensity goes on specularly (SP) and
 * what share returns to the radar (BK). Both are 0..1; a BK of 1 is what a white matt surface
 * returns straight back (RaySAR's F_d = 1 with N.L = 1).
 *
 * Angles as in records.h, radians: theta1 of the incidence, theta2 of the echo, theta4 the turn
 * from the one to the other. */
#ifndef TRACER_REFLECT_H
#define TRACER_REFLECT_H

#include "tracer/records.h"

#include <complex.h>
#include <stdbool.h>
#include <stdint.h>

/* Shape of the autocorrelation of heights: exp(-(r / l)^2) or exp(-r / l). At flat angles a
 * Gaussian surface returns next to nothing; natural ground is nearer to exponential. */
enum reflect_spectrum { REFLECT_GAUSSIAN, REFLECT_EXPONENTIAL, REFLECT_SPECTRA };
extern const char *const reflect_spectrum_names[REFLECT_SPECTRA];

/* A surface. The names of the last four are RaySAR's. */
struct reflect_material {
    char name[TRACE_NAME_SIZE];
    double permittivity, loss;  /* relative permittivity: permittivity - i loss */
    double rms_height_m;        /* roughness: standard deviation of height */
    double correlation_m;       /* and its correlation length */
    double specular, roughness; /* F_s 0..1, F_r > 0 */
    double diffuse, brilliance; /* F_d 0..1, F_b 0..1 */
    enum reflect_spectrum spectrum;
    double coat_m; /* 0: nothing below it. Else thickness of a coat on metal, such as paint */
};

/* ---- the formulas ---- */

/* Fresnel's coefficients, eq. (5) and (6). */
double complex reflect_fresnel_hh(double complex permittivity, double theta1);
double complex reflect_fresnel_vv(double complex permittivity, double theta1);

/* The same of a coat on metal: what its two faces send back together, with all that goes to and fro
 * between them. */
double complex reflect_coat_hh(double complex permittivity, double coat_m, double wavelength_m,
                               double theta1);
double complex reflect_coat_vv(double complex permittivity, double coat_m, double wavelength_m,
                               double theta1);

/* Polarisation factors of the small perturbation method. eq. (8), and eq. (9) as the theory has it:
 * the paper prints a product of two fractions where there is one fraction with a difference above,
 *     beta_vv = (e - 1) (q1 q2 cos t3 - e sin t1 sin t2) / ((e cos t2 + q2) (e cos t1 + q1)),
 * q = sqrt(e - sin^2 t); for backscatter, t1 = t2 and t3 = pi, it is Bragg's coefficient (Ulaby,
 * Moore, Fung, Microwave Remote Sensing II, eq. 12.90). cos_theta3: azimuth of the echo, 1 ahead.
 */
double complex reflect_beta_hh(double complex permittivity, double theta1, double theta2,
                               double cos_theta3);
double complex reflect_beta_vv(double complex permittivity, double theta1, double theta2,
                               double cos_theta3);

/* cos of theta3 from the angles of a record; -1, straight back, where the azimuth means nothing. */
double reflect_cos_theta3(double theta1, double theta2, double theta4);

/* Eq. (7) as cross section of a unit area: sigma0 = 4 pi R^2 |E|^2 / a = 4/pi k^4 cos^2 t1 cos^2 t2
 * |beta|^2 W, with W the transform of the autocorrelation over the plane: pi s^2 l^2
 * exp(-(kappa l)^2 / 4) of a Gaussian one, 2 pi s^2 l^2 / (1 + (kappa l)^2)^(3/2) of an
 * exponential. For backscatter the Gaussian is Ulaby's 4 k^4 s^2 l^2 cos^4 t |alpha|^2 exp(-(k l
 * sin t)^2). */
double reflect_spectrum_at(const struct reflect_material *m, double kappa_squared);
double reflect_spm_sigma0(const struct reflect_material *m, double wavelength_m, bool is_vv,
                          double theta1, double theta2, double theta4);

/* RaySAR's specular lobe F_s (N.H)^(1 / F_r), eq. (10), and diffuse part F_d (N.L)^F_b, eq. (11).
 * L points to the radar: the angle is that of the echo. POV-Ray, RaySAR's engine, has the light at
 * the radar and follows the signal backwards, so the "incident angle" of the paper's remark on
 * Fig. 6 is the light's, the same angle. */
double reflect_raysar_specular(const struct reflect_material *m, double theta1, double theta2,
                               double theta4);
double reflect_raysar_diffuse(const struct reflect_material *m, double theta2);

/* ---- laws to choose from ---- */

enum reflect_kind {
    REFLECT_RAYSAR,     /* SP: F_s. BK: specular lobe plus diffuse part */
    REFLECT_FRESNEL_HH, /* SP: |R|^2. BK: |R|^2 (N.H)^(1 / F_r) plus RaySAR's diffuse part */
    REFLECT_FRESNEL_VV,
    REFLECT_SPM_HH, /* SP: |R|^2 less the share that roughness scatters. BK: the lobe of that, plus
                       small perturbation: sigma0 / (4 cos t1) */
    REFLECT_SPM_VV,
    REFLECT_KINDS
};
extern const char *const reflect_kind_names[REFLECT_KINDS];

/* The same words for a table of options. */
#define REFLECT_KIND_WORDS "raysar|fresnel-hh|fresnel-vv|spm-hh|spm-vv"

/* Received and sent polarisation, in this order: HV receives H of what was sent in V. */
enum reflect_channel {
    REFLECT_AS_LAW, /* each reflection by itself is in HH or VV, as the kind says */
    REFLECT_HH, /* else the electric vector is followed, and the kind's own end does not count */
    REFLECT_HV,
    REFLECT_VH,
    REFLECT_VV,
    REFLECT_CHANNELS
};

/* The same words for a table of options. */
#define REFLECT_CHANNEL_WORDS "law|hh|hv|vh|vv"

struct reflect_law {
    enum reflect_kind kind;
    enum reflect_channel channel; /* of fields (coherent.h); shares of intensity know none */
    double wavelength_m;
    struct reflect_material materials[TRACE_MATERIALS_MAX]; /* by a record's material */
};

struct reflect_shares {
    float specular, back;
};

/* The shares of one record by the law, each 0..1. */
struct reflect_shares reflect_record(const struct reflect_law *law, const struct trace_record *t);

/* The same with phase: the field that a smooth facet reflects, and the share of intensity that its
 * roughness sends back to the radar without any. A lobe is not in it: what a facet sends beside the
 * specular direction comes from the sum over its rays. */
struct reflect_field {
    double complex
        specular;     /* Fresnel's coefficient, less what roughness takes; RaySAR: -sqrt F_s */
    double scattered; /* 0..1: F_d (N.L)^F_b, or small perturbation */
};
struct reflect_field reflect_field_of(const struct reflect_law *law, const struct trace_record *t);

/* Does the law have the electric vector in the plane of incidence? */
bool reflect_is_vv(const struct reflect_law *law);

/* ---- both polarisations, of the place: H is square to the plane of incidence ---- */

/* What a smooth place reflects, less what roughness takes; RaySAR: -+ sqrt F_s, as metal. */
struct reflect_pair {
    double complex hh, vv;
};
struct reflect_pair reflect_pair_of(const struct reflect_law *law, const struct trace_record *t);

/* Roots of the shares that roughness sends back: by first index received, by second sent. cosine
 * and sine of the azimuth of the echo, from that of the incidence. Small perturbation has all four
 * of the theory (Ruck and others, Radar Cross Section Handbook, 1970, p. 703); a diffuse share
 * keeps its polarisation. crossed: of a scattering with a phase of its own, which turns H into V
 * and V into H (wave.h). */
struct reflect_rough {
    double complex hh, hv, vh, vv;
    double crossed;
};
struct reflect_rough reflect_rough_of(const struct reflect_law *law, const struct trace_record *t,
                                      double cosine, double sine);

/* q: power of the crossed scattering over that in VV. */
double reflect_crossed_share(const struct reflect_law *law, const struct reflect_material *m);

#endif
