/* Laws of reflection against the textbooks. */
#include "check.h"
#include "tracer/reflect.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static double rad(double deg)
{
    return deg * pi / 180;
}

/* Air to glass of index 1.5: 4 % straight on; at 45 degrees 9.20 % across the plane of incidence
 * and 0.85 % in it; none of the latter at Brewster's 56.31 degrees; all of both at 90 (Hecht,
 * Optics, 4.6). */
TEST(fresnel_is_that_of_glass)
{
    const double e = 1.5 * 1.5;
    assert_true(fabs(cabs(reflect_fresnel_hh(e, 0)) - 0.2) < 1e-12);
    assert_true(fabs(cabs(reflect_fresnel_vv(e, 0)) - 0.2) < 1e-12);
    assert_true(fabs(pow(cabs(reflect_fresnel_hh(e, rad(45))), 2) - 0.0920) < 5e-5);
    assert_true(fabs(pow(cabs(reflect_fresnel_vv(e, rad(45))), 2) - 0.0085) < 5e-5);
    assert_true(cabs(reflect_fresnel_vv(e, atan(1.5))) < 1e-12);
    assert_true(fabs(cabs(reflect_fresnel_hh(e, rad(90))) - 1) < 1e-12);
    assert_true(fabs(cabs(reflect_fresnel_vv(e, rad(90))) - 1) < 1e-12);
}

/* A good conductor: -1 for hh and +1 for vv at any angle but the very flattest. */
TEST(fresnel_of_metal_reflects_all)
{
    const double complex metal = 1 - 1e9 * I;
    for (double t = 0; t < 85; t += 5) {
        assert_true(cabs(reflect_fresnel_hh(metal, rad(t)) + 1) < 1e-4);
        assert_true(cabs(reflect_fresnel_vv(metal, rad(t)) - 1) < 1e-3);
    }
}

/* Ulaby, Moore, Fung, volume II, eq. 12.90: Bragg's coefficients of backscatter. The product that
 * [Niu] prints as eq. (9) fails here. */
TEST(backscatter_has_braggs_coefficients)
{
    const double complex e = 6 - 1 * I;
    for (double t = 0; t < 90; t += 5) {
        const double s2 = pow(sin(rad(t)), 2), c = cos(rad(t));
        const double complex q = csqrt(e - s2);
        const double complex hh = (e - 1) / cpow(c + q, 2);
        const double complex vv = (e - 1) * (s2 - e * (1 + s2)) / cpow(e * c + q, 2);
        assert_true(cabs(reflect_beta_hh(e, rad(t), rad(t), -1) + hh) < 1e-12);
        assert_true(cabs(reflect_beta_vv(e, rad(t), rad(t), -1) - vv) < 1e-9 * cabs(vv));
    }
    assert_true(fabs(cabs(reflect_beta_vv(e, 0, 0, -1)) - cabs(reflect_beta_hh(e, 0, 0, -1))) <
                1e-12);
}

TEST(way_out_and_way_back_may_be_exchanged)
{
    const double complex e = 4 - 0.5 * I;
    for (double t = 5; t < 90; t += 10) {
        assert_true(cabs(reflect_beta_vv(e, rad(t), rad(30), 0.3) -
                         reflect_beta_vv(e, rad(30), rad(t), 0.3)) < 1e-12);
        assert_true(cabs(reflect_beta_hh(e, rad(t), rad(30), 0.3) -
                         reflect_beta_hh(e, rad(30), rad(t), 0.3)) < 1e-12);
    }
}

static const struct reflect_material soil = {"soil",           6, 1, 0.001, 0.01, 0.4, 0.02, 0.3, 1,
                                             REFLECT_GAUSSIAN, 0};

/* Ulaby's sigma0 of a Gaussian surface, 4 k^4 s^2 l^2 cos^4 t |alpha|^2 exp(-(k l sin t)^2). */
TEST(small_perturbation_is_the_textbooks_in_backscatter)
{
    const double wavelength = 0.03, k = 2 * pi / wavelength;
    const double complex e = 6 - 1 * I;
    for (double t = 0; t < 85; t += 5) {
        const double s = sin(rad(t)), c = cos(rad(t));
        const double complex q = csqrt(e - s * s);
        const double complex alpha = (e - 1) * (s * s - e * (1 + s * s)) / cpow(e * c + q, 2);
        const double expected = 4 * pow(k, 4) * 1e-6 * 1e-4 * pow(c, 4) * pow(cabs(alpha), 2) *
                                exp(-pow(k * 0.01 * s, 2));
        const double found = reflect_spm_sigma0(&soil, wavelength, true, rad(t), rad(t), 0);
        assert_true(fabs(found - expected) < 1e-9 * expected);
    }
}

/* By definition: the transform over the plane of the heights' autocorrelation, here as the integral
 * of 2 pi r J0(kappa r) exp(-(r / l)^2) or exp(-r / l), by Simpson's rule. */
TEST(a_spectrum_is_the_transform_of_its_autocorrelation)
{
    enum { STEPS = 200000 };
    struct reflect_material m = soil;
    for (int i = 0; i < REFLECT_SPECTRA; i++) {
        m.spectrum = (enum reflect_spectrum)i;
        for (double kappa = 0; kappa < 500; kappa += 60) {
            const double step = 40 * m.correlation_m / STEPS;
            double sum = 0;
            for (int k = 0; k <= STEPS; k++) {
                const double r = k * step, x = r / m.correlation_m;
                const double weight = k == 0 || k == STEPS ? 1 : k % 2 ? 4 : 2;
                sum += weight * r * j0(kappa * r) * exp(i == REFLECT_GAUSSIAN ? -x * x : -x);
            }
            const double expected = 2 * pi * m.rms_height_m * m.rms_height_m * sum * step / 3;
            const double found = reflect_spectrum_at(&m, kappa * kappa);
            assert_true(fabs(found - expected) < 1e-6 * reflect_spectrum_at(&m, 0));
        }
    }
}

/* By hand: the built-in ground at 75 degrees from the vertical. */
TEST(exponential_ground_returns_something_at_flat_angles)
{
    struct reflect_material ground = {
        "ground", 6, 1, 0.0015, 0.02, 0.3, 0.02, 0.03, 1, REFLECT_EXPONENTIAL, 0};
    const double t = rad(75);
    const double flat_db = 10 * log10(reflect_spm_sigma0(&ground, 0.03123, true, t, t, 0));
    ground.spectrum = REFLECT_GAUSSIAN;
    const double gaussian_db = 10 * log10(reflect_spm_sigma0(&ground, 0.03123, true, t, t, 0));
    print_message("# %.1f and %.1f dB\n", flat_db, gaussian_db);
    assert_true(fabs(flat_db + 28.1) < 0.1 && fabs(gaussian_db + 69.9) < 0.1);
}

/* The mean of exp(-2 i k z cos t) over heights z of a normal distribution, by Simpson's rule: what
 * a rough mirror sends on in phase, as each place's way is 2 z cos t shorter. */
static double complex mean_phasor(double height_m, double wavelength_m, double theta)
{
    enum { STEPS = 4000 };
    const double reach_m = 8 * height_m, step_m = 2 * reach_m / STEPS;
    double complex sum = 0;
    double weights = 0;
    for (int i = 0; i <= STEPS; i++) {
        const double z = i * step_m - reach_m, x = z / height_m;
        const double weight = (i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2) * exp(-x * x / 2);
        sum += weight * cexp(-4 * pi * I * z * cos(theta) / wavelength_m);
        weights += weight;
    }
    return sum / weights;
}

/* In shares of power, as a field, and as a pair of fields. */
TEST(roughness_takes_from_a_mirror_what_its_heights_take_from_the_phase)
{
    struct reflect_law rough = {.kind = REFLECT_SPM_HH, .wavelength_m = 0.03125};
    for (double height_m = 0.0005; height_m < 0.03; height_m *= 2) {
        rough.materials[0] = soil;
        rough.materials[0].rms_height_m = height_m;
        for (double t = 0; t < 90; t += 5) {
            const struct trace_record r = {.incidence_rad = (float)rad(t),
                                           .echo_rad = (float)rad(t),
                                           .turn_rad = (float)rad(2 * t)};
            const double left = creal(mean_phasor(height_m, 0.03125, rad(t)));
            const double complex smooth = reflect_fresnel_hh(6 - 1 * I, rad(t));
            const double power = pow(cabs(smooth) * left, 2);
            assert_true(fabs((double)reflect_record(&rough, &r).specular - power) < 1e-6);
            assert_true(cabs(reflect_field_of(&rough, &r).specular - smooth * left) < 1e-6);
            assert_true(cabs(reflect_pair_of(&rough, &r).hh - smooth * left) < 1e-6);
        }
    }
}

/* Rayleigh's criterion: at a height of wavelength / (8 cos t) ways differ by a quarter of a turn,
 * and a spread of heights as large leaves exp(-pi^2 / 4) of the power, -10.7 dB, in any direction.
 * Where 4 pi s cos t / wavelength is 1 the loss is 4.34 dB. */
TEST(a_surface_is_rough_where_rayleigh_says_so)
{
    struct reflect_law rough = {.kind = REFLECT_SPM_VV, .wavelength_m = 0.03125};
    for (double t = 0; t < 85; t += 5) {
        const struct trace_record r = {.incidence_rad = (float)rad(t),
                                       .echo_rad = (float)rad(t),
                                       .turn_rad = (float)rad(2 * t)};
        const double smooth = pow(cabs(reflect_fresnel_vv(6 - 1 * I, rad(t))), 2);
        const double heights_m[2] = {0.03125 / (8 * cos(rad(t))), 0.03125 / (4 * pi * cos(rad(t)))};
        const double lost_db[2] = {10.72, 4.343};
        for (int i = 0; i < 2; i++) {
            rough.materials[0] = soil;
            rough.materials[0].rms_height_m = heights_m[i];
            const double left = (double)reflect_record(&rough, &r).specular / smooth;
            assert_true(fabs(10 * log10(left) + lost_db[i]) < 0.01);
        }
    }
}

/* The azimuth is found again from the three angles of a record. */
TEST(the_turn_gives_back_the_azimuth)
{
    for (double t1 = 5; t1 < 90; t1 += 20) {
        for (double t3 = 0; t3 <= 180; t3 += 20) {
            const double a = rad(t1), b = rad(35), c = rad(t3);
            /* Source at azimuth pi from ahead, echo at t3. */
            const double cos_turn = cos(a) * cos(b) - sin(a) * sin(b) * cos(c);
            assert_true(fabs(reflect_cos_theta3(a, b, acos(cos_turn)) - cos(c)) < 1e-6);
        }
    }
    assert_true(reflect_cos_theta3(0, 0, 0) == -1);
}

/* Figures 5 and 6: F_s in the specular direction at every incidence; diffuse by the angle to the
 * radar alone, wherever the ray came from. */
TEST(raysar_is_as_paper_b_describes_it)
{
    for (double t = 0; t < 90; t += 10) {
        assert_true(fabs(reflect_raysar_specular(&soil, rad(t), rad(t), rad(2 * t)) - 0.4) < 1e-9);
        assert_true(fabs(reflect_raysar_diffuse(&soil, rad(t)) - 0.3 * cos(rad(t))) < 1e-12);
    }
    /* Backscatter at 30 degrees: N.H = cos 30, to the power 1 / 0.02. */
    assert_true(fabs(reflect_raysar_specular(&soil, rad(30), rad(30), 0) -
                     0.4 * pow(cos(rad(30)), 50)) < 1e-9);
}

TEST(every_law_gives_shares_between_none_and_all)
{
    struct reflect_law law = {.wavelength_m = 0.03, .materials = {soil}};
    for (int kind = 0; kind < REFLECT_KINDS; kind++) {
        law.kind = (enum reflect_kind)kind;
        for (double t1 = 0; t1 <= 90; t1 += 7.5) {
            for (double t2 = 0; t2 <= 180; t2 += 7.5) {
                for (double t4 = fabs(t1 - t2); t4 <= fmin(t1 + t2, 180); t4 += 7.5) {
                    const struct trace_record r = {.incidence_rad = (float)fmin(rad(t1), pi / 2),
                                                   .echo_rad = (float)rad(t2),
                                                   .turn_rad = (float)rad(t4)};
                    const struct reflect_shares s = reflect_record(&law, &r);
                    assert_true(s.specular >= 0 && s.specular <= 1);
                    assert_true(s.back >= 0 && s.back <= 1);
                }
            }
        }
    }
}
