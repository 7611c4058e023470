#include "tracer/reflect.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

const char *const reflect_kind_names[REFLECT_KINDS] = {"raysar", "fresnel-hh", "fresnel-vv",
                                                       "spm-hh", "spm-vv"};

const char *const reflect_spectrum_names[REFLECT_SPECTRA] = {"gaussian", "exponential"};

static double square(double x)
{
    return x * x;
}

static double complex root_term(double complex permittivity, double theta)
{
    return csqrt(permittivity - square(sin(theta)));
}

double complex reflect_fresnel_hh(double complex permittivity, double theta1)
{
    const double complex q = root_term(permittivity, theta1);
    return (cos(theta1) - q) / (cos(theta1) + q);
}

double complex reflect_fresnel_vv(double complex permittivity, double theta1)
{
    const double complex q = root_term(permittivity, theta1), p = permittivity * cos(theta1);
    return (p - q) / (p + q);
}

/* Phase and loss on the way through the coat, down and up. */
static double complex through_coat(double complex permittivity, double coat_m, double wavelength_m,
                                   double theta1)
{
    return cexp(-4 * pi * I * coat_m / wavelength_m * root_term(permittivity, theta1));
}

double complex reflect_coat_hh(double complex permittivity, double coat_m, double wavelength_m,
                               double theta1)
{
    const double complex first = reflect_fresnel_hh(permittivity, theta1);
    const double complex metal = -through_coat(permittivity, coat_m, wavelength_m, theta1);
    return (first + metal) / (1 + first * metal);
}

double complex reflect_coat_vv(double complex permittivity, double coat_m, double wavelength_m,
                               double theta1)
{
    const double complex first = reflect_fresnel_vv(permittivity, theta1);
    const double complex metal = through_coat(permittivity, coat_m, wavelength_m, theta1);
    return (first + metal) / (1 + first * metal);
}

double complex reflect_beta_hh(double complex permittivity, double theta1, double theta2,
                               double cos_theta3)
{
    return (permittivity - 1) * cos_theta3 /
           ((cos(theta2) + root_term(permittivity, theta2)) *
            (cos(theta1) + root_term(permittivity, theta1)));
}

double complex reflect_beta_vv(double complex permittivity, double theta1, double theta2,
                               double cos_theta3)
{
    const double complex q1 = root_term(permittivity, theta1);
    const double complex q2 = root_term(permittivity, theta2);
    return (permittivity - 1) *
           (q1 * q2 * cos_theta3 - permittivity * (sin(theta1) * sin(theta2))) /
           ((permittivity * cos(theta2) + q2) * (permittivity * cos(theta1) + q1));
}

/* sin t1 sin t2 cos t3, by the law of cosines on the sphere of directions. */
static double sines_cos_theta3(double theta1, double theta2, double theta4)
{
    return cos(theta1) * cos(theta2) - cos(theta4);
}

double reflect_cos_theta3(double theta1, double theta2, double theta4)
{
    const double sines = sin(theta1) * sin(theta2);
    if (sines < 1e-6) {
        return -1;
    }
    return fmin(fmax(sines_cos_theta3(theta1, theta2, theta4) / sines, -1), 1);
}

double reflect_spectrum_at(const struct reflect_material *m, double kappa_squared)
{
    const double area = pi * square(m->rms_height_m * m->correlation_m);
    const double turn = kappa_squared * square(m->correlation_m);
    return m->spectrum == REFLECT_GAUSSIAN ? area * exp(-turn / 4) : 2 * area / pow(1 + turn, 1.5);
}

/* A coat follows the heights of the metal below it, which scatters. */
static double complex half_space_of(const struct reflect_material *m)
{
    return m->coat_m > 0 ? -1e7 * I : m->permittivity - m->loss * I;
}

double reflect_spm_sigma0(const struct reflect_material *m, double wavelength_m, bool is_vv,
                          double theta1, double theta2, double theta4)
{
    const double k = 2 * pi / wavelength_m;
    const double complex permittivity = half_space_of(m);
    const double cos_theta3 = reflect_cos_theta3(theta1, theta2, theta4);
    const double complex beta = is_vv ? reflect_beta_vv(permittivity, theta1, theta2, cos_theta3)
                                      : reflect_beta_hh(permittivity, theta1, theta2, cos_theta3);
    /* What the surface must add to the wave's tangential number to send it to the radar. */
    const double kappa_squared =
        k * k *
        (square(sin(theta1)) + square(sin(theta2)) - 2 * sines_cos_theta3(theta1, theta2, theta4));
    const double spectrum = reflect_spectrum_at(m, fmax(kappa_squared, 0));
    return 4 / pi * square(square(k) * cos(theta1) * cos(theta2) * cabs(beta)) * spectrum;
}

/* (N.H)^(1 / F_r), H halfway between source and radar. */
static double lobe(const struct reflect_material *m, double theta1, double theta2, double theta4)
{
    const double half = cos(theta4 / 2);
    if (half < 1e-9) {
        return 0; /* straight on: no half way, and nothing comes back from behind a surface */
    }
    const double n_h = fmin((cos(theta1) + cos(theta2)) / (2 * half), 1);
    return n_h > 0 ? pow(n_h, 1 / m->roughness) : 0;
}

double reflect_raysar_specular(const struct reflect_material *m, double theta1, double theta2,
                               double theta4)
{
    return m->specular * lobe(m, theta1, theta2, theta4);
}

double reflect_raysar_diffuse(const struct reflect_material *m, double theta2)
{
    return m->diffuse * pow(fmax(cos(theta2), 0), m->brilliance);
}

static double complex fresnel(const struct reflect_law *law, const struct reflect_material *m,
                              double theta1, bool is_vv)
{
    const double complex permittivity = m->permittivity - m->loss * I;
    if (m->coat_m > 0) {
        return (is_vv ? reflect_coat_vv : reflect_coat_hh)(permittivity, m->coat_m,
                                                           law->wavelength_m, theta1);
    }
    return is_vv ? reflect_fresnel_vv(permittivity, theta1)
                 : reflect_fresnel_hh(permittivity, theta1);
}

/* Share of the specular power that roughness leaves: exp(-(2 k s cos t)^2). */
static double smooth_share(const struct reflect_material *m, double wavelength_m, double theta1)
{
    return exp(-square(4 * pi / wavelength_m * m->rms_height_m * cos(theta1)));
}

/* What small perturbation sends back, in shares of a white matt surface. */
static double rough_share(const struct reflect_law *law, const struct reflect_material *m,
                          const struct trace_record *t)
{
    const double t1 = (double)t->incidence_rad;
    return reflect_spm_sigma0(m, law->wavelength_m, reflect_is_vv(law), t1, (double)t->echo_rad,
                              (double)t->turn_rad) /
           (4 * fmax(cos(t1), 1e-6));
}

bool reflect_is_vv(const struct reflect_law *law)
{
    return law->kind == REFLECT_FRESNEL_VV || law->kind == REFLECT_SPM_VV;
}

static struct reflect_shares shares(double specular, double back)
{
    return (struct reflect_shares){(float)fmin(specular, 1), (float)fmin(fmax(back, 0), 1)};
}

struct reflect_shares reflect_record(const struct reflect_law *law, const struct trace_record *t)
{
    const struct reflect_material *m = &law->materials[t->material];
    const double t1 = (double)t->incidence_rad, t2 = (double)t->echo_rad, t4 = (double)t->turn_rad;
    if (law->kind == REFLECT_RAYSAR) {
        return shares(m->specular,
                      reflect_raysar_specular(m, t1, t2, t4) + reflect_raysar_diffuse(m, t2));
    }
    double specular = square(cabs(fresnel(law, m, t1, reflect_is_vv(law))));
    if (law->kind == REFLECT_FRESNEL_HH || law->kind == REFLECT_FRESNEL_VV) {
        return shares(specular, specular * lobe(m, t1, t2, t4) + reflect_raysar_diffuse(m, t2));
    }
    specular *= smooth_share(m, law->wavelength_m, t1);
    return shares(specular, specular * lobe(m, t1, t2, t4) + rough_share(law, m, t));
}

struct reflect_field reflect_field_of(const struct reflect_law *law, const struct trace_record *t)
{
    const struct reflect_material *m = &law->materials[t->material];
    const double t1 = (double)t->incidence_rad, t2 = (double)t->echo_rad;
    const double diffuse = reflect_raysar_diffuse(m, t2);
    if (law->kind == REFLECT_RAYSAR) {
        return (struct reflect_field){-sqrt(m->specular), diffuse};
    }
    const double complex coefficient = fresnel(law, m, t1, reflect_is_vv(law));
    if (law->kind == REFLECT_FRESNEL_HH || law->kind == REFLECT_FRESNEL_VV) {
        return (struct reflect_field){coefficient, diffuse};
    }
    const double rough = fmin(rough_share(law, m, t), 1);
    return (struct reflect_field){coefficient * sqrt(smooth_share(m, law->wavelength_m, t1)),
                                  rough};
}

/* ---- both polarisations ---- */

static bool is_spm(const struct reflect_law *law)
{
    return law->kind == REFLECT_SPM_HH || law->kind == REFLECT_SPM_VV;
}

struct reflect_pair reflect_pair_of(const struct reflect_law *law, const struct trace_record *t)
{
    const struct reflect_material *m = &law->materials[t->material];
    const double t1 = (double)t->incidence_rad;
    if (law->kind == REFLECT_RAYSAR) {
        return (struct reflect_pair){-sqrt(m->specular), sqrt(m->specular)};
    }
    const double left = is_spm(law) ? sqrt(smooth_share(m, law->wavelength_m, t1)) : 1;
    return (struct reflect_pair){left * fresnel(law, m, t1, false),
                                 left * fresnel(law, m, t1, true)};
}

double reflect_crossed_share(const struct reflect_law *law, const struct reflect_material *m)
{
    const double ks = 2 * pi / law->wavelength_m * m->rms_height_m;
    const double straight_on =
        law->kind == REFLECT_RAYSAR ? sqrt(m->specular) : cabs(fresnel(law, m, 0, false));
    return 0.23 * straight_on * (1 - exp(-ks));
}

/* In the order of reflect_beta_hh(): what the theory has of a surface, without its spectrum. */
static struct reflect_rough perturbed(double complex permittivity, double t1, double t2,
                                      double cosine, double sine)
{
    const double complex q1 = root_term(permittivity, t1), q2 = root_term(permittivity, t2);
    const double complex crossing = (permittivity - 1) * sine;
    return (struct reflect_rough){
        .hh = reflect_beta_hh(permittivity, t1, t2, cosine),
        .hv = crossing * q1 / ((permittivity * cos(t1) + q1) * (cos(t2) + q2)),
        .vh = crossing * q2 / ((permittivity * cos(t2) + q2) * (cos(t1) + q1)),
        .vv = -reflect_beta_vv(permittivity, t1, t2, cosine),
    };
}

/* sqrt(sigma0 / (4 cos t1)) over |beta|: see reflect_spm_sigma0(). */
static double perturbed_root(const struct reflect_law *law, const struct reflect_material *m,
                             double t1, double t2, double cosine)
{
    const double k = 2 * pi / law->wavelength_m;
    const double s1 = sin(t1), s2 = sin(t2);
    const double kappa_squared = k * k * (s1 * s1 + s2 * s2 - 2 * s1 * s2 * cosine);
    return k * k * cos(t2) *
           sqrt(fmax(cos(t1), 0) * reflect_spectrum_at(m, fmax(kappa_squared, 0)) / pi);
}

/* No more than all of it comes back. */
static struct reflect_rough scaled(struct reflect_rough r, double root)
{
    const double most = root * fmax(cabs(r.hh), cabs(r.vv));
    const double k = most > 1 ? root / most : root;
    return (struct reflect_rough){r.hh * k, r.hv * k, r.vh * k, r.vv * k, 0};
}

struct reflect_rough reflect_rough_of(const struct reflect_law *law, const struct trace_record *t,
                                      double cosine, double sine)
{
    const struct reflect_material *m = &law->materials[t->material];
    const double t1 = (double)t->incidence_rad, t2 = (double)t->echo_rad;
    struct reflect_rough rough;
    if (is_spm(law)) {
        rough = scaled(perturbed(half_space_of(m), t1, t2, cosine, sine),
                       perturbed_root(law, m, t1, t2, cosine));
    } else {
        const double root = sqrt(reflect_raysar_diffuse(m, t2));
        rough = (struct reflect_rough){.hh = -root, .vv = root};
    }
    rough.crossed = sqrt(reflect_crossed_share(law, m)) * cabs(rough.vv);
    return rough;
}
