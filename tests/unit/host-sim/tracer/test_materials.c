/* What things are made of, against printed values and the models of others. */
#include "check.h"
#include "tracer/materials.h"
#include "tracer/substances.h"
#include "tracer/surfaces.h"
#include "tracer/trace.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static void assert_near(double found, double expected, double share)
{
    if (!(fabs(found - expected) <= share * fabs(expected))) {
        print_error("%.8g is not within %g of %.8g\n", found, share, expected);
        fail();
    }
}

/* The table that the documentation of MathWorks' buildingMaterialPermittivity prints for
 * ITU-R P.2040-3 at 9 GHz: permittivity, and conductivity in S/m. */
TEST(building_materials_are_those_of_the_recommendation)
{
    static const struct {
        const char *name;
        double permittivity, conductivity;
    } printed[] = {{"concrete", 5.24, 0.25766},
                   {"brick", 3.91, 0.033826},
                   {"wood", 1.99, 0.049528},
                   {"glass", 6.31, 0.068299},
                   {"plywood", 2.71, 0.33},
                   {"marble", 7.074, 0.04209},
                   {"metal", 1, 1e7}};
    for (size_t i = 0; i < sizeof printed / sizeof printed[0]; i++) {
        const struct substance_building *s = substance_building_find(printed[i].name);
        assert_non_null(s);
        assert_near(substance_conductivity(s, 9), printed[i].conductivity, 2e-5);
        assert_near(creal(substance_building(s, 9)), printed[i].permittivity, 1e-9);
        /* Conductivity over 2 pi f times the constant of free space. */
        assert_near(-cimag(substance_building(s, 9)),
                    printed[i].conductivity / (2 * pi * 9e9 * 8.854187817e-12), 4e-4);
    }
    assert_null(substance_building_find("cheese"));
}

/* Kaatze, J. Chem. Eng. Data 34, 1989: one relaxation fitted to measured water, 1 to 60 GHz. */
TEST(water_is_as_measured)
{
    static const double rows[][4] = {{20, 80.21, 5.6, 9.36e-3}, {25, 78.36, 5.2, 8.27e-3}};
    for (int i = 0; i < 2; i++) {
        for (double ghz = 8; ghz <= 40; ghz += 4) {
            const double complex expected =
                rows[i][2] + (rows[i][1] - rows[i][2]) / (1 + 2 * pi * ghz * rows[i][3] * I);
            const double complex found = substance_water(rows[i][0], ghz);
            assert_near(creal(found), creal(expected), 0.02);
            assert_near(cimag(found), cimag(expected), 0.01);
        }
    }
}

static const struct substance_soil textures[] = {{51.52, 13.42, 2.66, 1.6006, 0.5, 23},
                                                 {41.96, 8.53, 2.70, 1.5781, 0.5, 23},
                                                 {30.63, 13.48, 2.59, 1.5750, 0.5, 23}};

/* Permittivity that the documentation of MathWorks' earthSurfacePermittivity prints for the soils
 * of ITU-R P.527, half water, at 23 degrees and 28 GHz. */
TEST(soils_are_those_of_the_recommendation)
{
    static const double printed[] = {15.281, 14.563, 13.965};
    for (int i = 0; i < 3; i++) {
        assert_near(creal(substance_soil(&textures[i], 28)), printed[i], 5e-5);
    }
}

/* Hallikainen and others, IEEE Trans. GE-23, 1985: polynomials fitted to measured soils, 10 GHz. */
TEST(soils_are_near_to_measured_ones)
{
    for (int i = 0; i < 3; i++) {
        struct substance_soil soil = textures[i];
        const double sand = soil.sand_percent, clay = soil.clay_percent;
        for (double water = 0.2; water < 0.45; water += 0.1) {
            const double real = 2.502 - 0.003 * sand - 0.003 * clay +
                                (10.101 + 0.221 * sand - 0.004 * clay) * water +
                                (77.482 - 0.061 * sand - 0.135 * clay) * water * water;
            const double loss = -0.070 + 0.001 * clay +
                                (6.620 + 0.015 * sand - 0.081 * clay) * water +
                                (21.578 + 0.293 * sand + 0.332 * clay) * water * water;
            soil.water_share = water;
            const double complex found = substance_soil(&soil, 10);
            assert_near(creal(found), real, 0.2);
            assert_near(-cimag(found), loss, 0.2);
        }
    }
}

/* Ulaby and El-Rayes, IEEE Trans. GE-25, 1987, at 22 degrees, where they measured: the formula of
 * the recommendation is theirs, made to hold at all temperatures. */
TEST(leaves_are_those_of_ulaby_and_el_rayes)
{
    for (double m = 0.3; m < 0.75; m += 0.1) {
        for (double ghz = 8; ghz <= 20; ghz += 3) {
            const double dry = 1.7 - 0.74 * m + 6.16 * m * m;
            const double bound = 4.64 * m * m / (1 + 7.36 * m * m);
            const double complex expected =
                dry + m * (0.55 * m - 0.076) * (4.9 + 75 / (1 + ghz / 18 * I) - 22.86 / ghz * I) +
                bound * (2.9 + 55 / (1 + csqrt(ghz / 0.18 * I)));
            assert_true(cabs(substance_leaf(m, 22, ghz) - expected) < 0.01 * cabs(expected));
        }
    }
    /* Few leaves are nearly air, and all leaf is leaf. */
    assert_true(cabs(substance_canopy(0, 0.6, 22, 10) - 1) < 1e-12);
    assert_true(cabs(substance_canopy(1, 0.6, 22, 10) - substance_leaf(0.6, 22, 10)) < 1e-9);
}

/* Maetzler's dry snow, as Ulaby and Long give it: 1 + 1.4667 v + 1.435 v^3, v the share of ice. Wet
 * snow without its water is dry snow, within what the fits leave; water makes it lose much more. */
TEST(snow_is_between_air_and_ice)
{
    for (double density = 0.1; density < 0.45; density += 0.1) {
        const double v = density / 0.9167;
        const double complex snow = substance_dry_snow(density, -5, 10);
        assert_near(creal(snow), 1 + 1.4667 * v + 1.435 * v * v * v, 0.04);
        assert_true(cimag(snow) < 0 && cimag(snow) > -3e-4);
        assert_near(creal(substance_wet_snow(density, 1e-4, 10)), creal(snow), 0.08);
    }
    assert_true(-cimag(substance_wet_snow(0.3, 0.03, 10)) > 0.1);
    assert_near(creal(substance_ice(-5, 10)), 3.184, 1e-3);
}

/* A coat by the other way: the impedance that a line of its length, shorted at its end, has. */
static double complex coat_by_impedance(double complex e, double coat_m, double wavelength_m,
                                        bool is_vv, double theta)
{
    const double complex q = csqrt(e - pow(sin(theta), 2));
    const double complex line = I * ctan(2 * pi / wavelength_m * coat_m * q);
    const double complex seen = line * (is_vv ? q / e : 1 / q),
                         air = is_vv ? cos(theta) : 1 / cos(theta);
    return (is_vv ? -1 : 1) * (seen - air) / (seen + air);
}

TEST(a_coat_reflects_as_a_shorted_line_does)
{
    const double complex e = 4 - 0.3 * I;
    for (double t = 0; t < 1.5; t += 0.1) {
        for (double coat_m = 0; coat_m < 0.02; coat_m += 0.0013) {
            assert_true(cabs(reflect_coat_hh(e, coat_m, 0.03, t) -
                             coat_by_impedance(e, coat_m, 0.03, false, t)) < 1e-9);
            assert_true(cabs(reflect_coat_vv(e, coat_m, 0.03, t) -
                             coat_by_impedance(e, coat_m, 0.03, true, t)) < 1e-9);
        }
        assert_true(fabs(cabs(reflect_coat_vv(4, 0.004, 0.03, t)) - 1) < 1e-9); /* no loss */
    }
}

/* ---- by name ---- */

static struct trace_records records_of(const char *first, const char *second, double wavelength_m)
{
    struct trace_records r = {.look = {0, 15, wavelength_m}, .material_count = 2};
    strcpy(r.materials[0], first);
    strcpy(r.materials[1], second);
    return r;
}

TEST(names_of_a_model_find_their_surface)
{
    assert_ptr_equal(surface_find("Steel"), surface_find("metal"));
    assert_ptr_equal(surface_find("M_Tire"), surface_find("rubber"));
    assert_ptr_equal(surface_find("CONCRETE"), surface_find("concrete"));
    assert_string_equal(surface_find("wet-soil")->plain.name, "wet-soil");
    assert_null(surface_find("steel2"));
    assert_null(surface_find(""));
    struct reflect_law law = {.kind = REFLECT_FRESNEL_HH, .wavelength_m = TRACE_WAVELENGTH_M};
    const struct trace_records r = records_of("aluminium", "cheese", TRACE_WAVELENGTH_M);
    assert_int_equal(materials_for(&r, NULL, NULL, &law), -1);
}

TEST(ground_is_what_the_user_names)
{
    struct reflect_law law = {.kind = REFLECT_FRESNEL_HH, .wavelength_m = TRACE_WAVELENGTH_M};
    const struct trace_records r = records_of("ground", "glass", TRACE_WAVELENGTH_M);
    assert_int_equal(materials_for(&r, NULL, "snow", &law), 0);
    assert_near(law.materials[0].permittivity, 1.57, 1e-9);
    assert_near(law.materials[1].permittivity, 6.31, 1e-9);
    assert_int_equal(materials_for(&r, NULL, NULL, &law), 0);
    assert_near(law.materials[0].permittivity, 6, 1e-9);
    assert_int_equal(materials_for(&r, NULL, "cheese", &law), -1);
}

/* The same model in another band: wet soil reflects less of Ka band, and a glass pane looks smooth.
 */
TEST(materials_go_by_the_frequency)
{
    double reflected[2];
    for (int i = 0; i < 2; i++) {
        const double wavelength_m = 0.299792458 / (i ? 35 : 10);
        const struct trace_records r = records_of("wet-soil", "metal", wavelength_m);
        struct reflect_law law = {.kind = REFLECT_FRESNEL_HH, .wavelength_m = wavelength_m};
        assert_int_equal(materials_for(&r, NULL, NULL, &law), 0);
        const struct trace_record t = {.material = 0};
        reflected[i] = (double)reflect_record(&law, &t).specular;
        const struct trace_record on_metal = {.material = 1};
        assert_true(reflect_record(&law, &on_metal).specular > 0.998F);
    }
    assert_true(reflected[0] > 1.3 * reflected[1]);
}

/* Paint of 0.1 mm hides nothing of metal; 3 mm of a lossy coat do. */
TEST(paint_on_metal_is_nearly_metal)
{
    const struct trace_records r = records_of("painted-metal", "metal", TRACE_WAVELENGTH_M);
    struct reflect_law law = {.kind = REFLECT_SPM_VV, .wavelength_m = TRACE_WAVELENGTH_M};
    assert_int_equal(materials_for(&r, NULL, NULL, &law), 0);
    for (float t = 0; t < 1; t += 0.1F) {
        const struct trace_record painted = {.material = 0, .incidence_rad = t, .echo_rad = t};
        const struct trace_record bare = {.material = 1, .incidence_rad = t, .echo_rad = t};
        const struct reflect_shares p = reflect_record(&law, &painted);
        const struct reflect_shares b = reflect_record(&law, &bare);
        assert_near((double)p.specular, (double)b.specular, 0.005);
        assert_near((double)p.back, (double)b.back, 0.01);
    }
    law.materials[0].coat_m = 0.003;
    law.materials[0].loss = 2;
    const struct trace_record thick = {.material = 0};
    assert_true(reflect_record(&law, &thick).specular < 0.5F);
}

/* `metal.213` of a zone, `metal.001` of a modelling program: the law of metal. */
TEST(a_name_with_a_point_has_the_law_of_what_stands_before_it)
{
    const struct trace_records r = records_of("concrete.213", "concrete", TRACE_WAVELENGTH_M);
    struct reflect_law law = {.kind = REFLECT_FRESNEL_HH, .wavelength_m = TRACE_WAVELENGTH_M};
    assert_int_equal(materials_for(&r, NULL, NULL, &law), 0);
    const struct trace_record a = {.material = 0, .incidence_rad = 0.7F};
    const struct trace_record b = {.material = 1, .incidence_rad = 0.7F};
    assert_true(reflect_record(&law, &a).specular == reflect_record(&law, &b).specular);
    const struct trace_records none = records_of("cheese.1", "metal", TRACE_WAVELENGTH_M);
    assert_int_equal(materials_for(&none, NULL, NULL, &law), -1);
    const struct trace_records empty = records_of(".1", "metal", TRACE_WAVELENGTH_M);
    assert_int_equal(materials_for(&empty, NULL, NULL, &law), -1);
}
