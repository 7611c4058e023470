#include "tracer/surfaces.h"

#include "hs/error.h"
#include "hs/report.h"
#include "tracer/substances.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const double pi = 3.14159265358979323846, light_m_ns = 0.299792458;

/* ---- what they are made of ---- */

static double complex building(const char *name, double ghz)
{
    return substance_building(substance_building_find(name), ghz);
}

static double complex metal(double ghz)
{
    return building("metal", ghz);
}

static double complex concrete(double ghz)
{
    return building("concrete", ghz);
}

static double complex brick(double ghz)
{
    return building("brick", ghz);
}

static double complex wood(double ghz)
{
    return building("wood", ghz);
}

static double complex glass(double ghz)
{
    return building("glass", ghz);
}

/* Usual handbook values, for paint on the metal below. */
static double complex paint(double ghz)
{
    (void)ghz;
    return 4 - 0.1 * I;
}

static double complex rubber(double ghz)
{
    (void)ghz;
    return 3 - 0.1 * I;
}

/* Moist soil: what the ground was before soils had names. */
static double complex plain_ground(double ghz)
{
    (void)ghz;
    return 6 - I;
}

/* The sandy loam of [P.527], figure 11, with that share of water, at 15 degrees. */
static double complex loam(double water_share, double ghz)
{
    const struct substance_soil soil = {51.52, 13.42, 2.66, 1.6006, water_share, 15};
    return substance_soil(&soil, ghz);
}

static double complex soil(double ghz)
{
    return loam(0.15, ghz);
}

static double complex dry_soil(double ghz)
{
    return loam(0.03, ghz);
}

static double complex wet_soil(double ghz)
{
    return loam(0.35, ghz);
}

static double complex grass(double ghz)
{
    return substance_canopy(0.02, 0.6, 15, ghz);
}

static double complex snow(double ghz)
{
    return substance_dry_snow(0.3, -5, ghz);
}

static double complex wet_snow(double ghz)
{
    return substance_wet_snow(0.3, 0.03, ghz);
}

/* ---- the table ---- */

#define P2040     "ITU-R P.2040-3, table 3"
#define P527_SOIL "ITU-R P.527-6 (58): sandy loam, 15 C"
#define OH        "Oh, Sarabandi, Ulaby, TGRS 30, 1992: surface 2"
#define NONE      "UNSOURCED"

/* The four numbers of RaySAR are to look at, all of them. `metal`, `ground` and `rubber` keep those
 * and the heights that they always had: 1.5 mm are as much as small perturbation holds in X band.
 */
const struct surface surfaces[] = {
    {{"metal", 0, 0, 0.0002, 0.02, 0.9, 0.005, 0.03, 1, REFLECT_GAUSSIAN, 0},
     metal,
     1,
     100,
     "bare metal",
     P2040,
     NONE},
    {{"painted-metal", 0, 0, 0.0002, 0.02, 0.9, 0.005, 0.03, 1, REFLECT_GAUSSIAN, 0.0001},
     paint,
     1,
     100,
     "metal under 0.1 mm of paint",
     NONE,
     NONE},
    {{"rubber", 0, 0, 0.001, 0.02, 0.2, 0.02, 0.03, 1, REFLECT_GAUSSIAN, 0},
     rubber,
     1,
     100,
     "tyres",
     NONE,
     NONE},
    {{"glass", 0, 0, 0.000001, 0.02, 0.4, 0.005, 0, 1, REFLECT_GAUSSIAN, 0},
     glass,
     0.1,
     100,
     "thick glass",
     P2040,
     NONE},
    {{"concrete", 0, 0, 0.0003, 0.01, 0.3, 0.01, 0.02, 1, REFLECT_EXPONENTIAL, 0},
     concrete,
     1,
     100,
     "walls, aprons",
     P2040,
     NONE},
    {{"brick", 0, 0, 0.001, 0.02, 0.25, 0.02, 0.03, 1, REFLECT_EXPONENTIAL, 0},
     brick,
     1,
     40,
     "walls",
     P2040,
     NONE},
    {{"wood", 0, 0, 0.0005, 0.02, 0.1, 0.02, 0.03, 1, REFLECT_GAUSSIAN, 0},
     wood,
     0.001,
     100,
     "boards",
     P2040,
     NONE},
    {{"ground", 0, 0, 0.0015, 0.02, 0.3, 0.02, 0.03, 1, REFLECT_EXPONENTIAL, 0},
     plain_ground,
     1,
     100,
     "level ground, unless --ground names it",
     NONE,
     NONE},
    {{"soil", 0, 0, 0.0032, 0.099, 0.3, 0.02, 0.03, 1, REFLECT_EXPONENTIAL, 0},
     soil,
     1,
     40,
     "bare soil, 15 % of water",
     P527_SOIL,
     OH},
    {{"dry-soil", 0, 0, 0.0032, 0.099, 0.2, 0.02, 0.02, 1, REFLECT_EXPONENTIAL, 0},
     dry_soil,
     1,
     40,
     "bare soil, 3 % of water",
     P527_SOIL,
     OH},
    {{"wet-soil", 0, 0, 0.0032, 0.099, 0.4, 0.02, 0.03, 1, REFLECT_EXPONENTIAL, 0},
     wet_soil,
     1,
     40,
     "bare soil, 35 % of water",
     P527_SOIL,
     OH},
    {{"grass", 0, 0, 0.01, 0.02, 0.05, 0.02, 0.05, 0.5, REFLECT_EXPONENTIAL, 0},
     grass,
     1,
     40,
     "turf, 2 % of it leaves",
     "ITU-R P.527-6 (72): leaves; thinned",
     NONE},
    {{"snow", 0, 0, 0.003, 0.05, 0.05, 0.02, 0.03, 1, REFLECT_EXPONENTIAL, 0},
     snow,
     1,
     100,
     "dry snow, 0.3 g/cm3, -5 C",
     "ITU-R P.527-6 (51)",
     NONE},
    {{"wet-snow", 0, 0, 0.003, 0.05, 0.1, 0.02, 0.01, 1, REFLECT_EXPONENTIAL, 0},
     wet_snow,
     3,
     37,
     "snow, 3 % of water",
     "Hallikainen and others, AP-34, 1986",
     NONE},
};
const int surface_count = sizeof surfaces / sizeof surfaces[0];

static const char *const others[][2] = {
    {"steel", "metal"},  {"iron", "metal"},    {"aluminium", "metal"},     {"aluminum", "metal"},
    {"tyre", "rubber"},  {"tire", "rubber"},   {"tyres", "rubber"},        {"tires", "rubber"},
    {"window", "glass"}, {"windows", "glass"}, {"paint", "painted-metal"}, {"dirt", "soil"},
    {"earth", "soil"},   {"timber", "wood"},   {"turf", "grass"},
};

/* ---- by name ---- */

static const struct surface *row_called(const char *name)
{
    for (int i = 0; i < surface_count; i++) {
        if (strcasecmp(surfaces[i].plain.name, name) == 0) {
            return &surfaces[i];
        }
    }
    return NULL;
}

const struct surface *surface_find(const char *name)
{
    name += strncmp(name, "M_", 2) == 0 ? 2 : 0;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        if (strcasecmp(others[i][0], name) == 0) {
            return row_called(others[i][1]);
        }
    }
    return row_called(name);
}

static double ghz_of(double wavelength_m)
{
    return light_m_ns / wavelength_m;
}

struct reflect_material surface_at(const struct surface *s, double wavelength_m)
{
    const double complex permittivity = s->permittivity(ghz_of(wavelength_m));
    struct reflect_material m = s->plain;
    m.permittivity = creal(permittivity);
    m.loss = -cimag(permittivity);
    return m;
}

void surface_doubt(const struct surface *s, double wavelength_m)
{
    const double ghz = ghz_of(wavelength_m);
    if (ghz < s->low_ghz || ghz > s->high_ghz) {
        hs_warn(s->plain.name, "give it in the file of --materials",
                "its permittivity holds from %g to %g GHz, and %.3g are asked for", s->low_ghz,
                s->high_ghz, ghz);
    }
}

/* ---- printed ---- */

static void report_material(const struct reflect_material *m, const struct surface *s)
{
    hs_report_object(NULL);
    hs_report_text("name", m->name);
    hs_report_real("permittivity", m->permittivity);
    hs_report_real("loss", m->loss);
    hs_report_real("rms_height_m", m->rms_height_m);
    hs_report_real("correlation_m", m->correlation_m);
    hs_report_real("specular", m->specular);
    hs_report_real("roughness", m->roughness);
    hs_report_real("diffuse", m->diffuse);
    hs_report_real("brilliance", m->brilliance);
    hs_report_text("spectrum", reflect_spectrum_names[m->spectrum]);
    hs_report_real("coat_m", m->coat_m);
    hs_report_text("what", s->what);
    hs_report_text("source", s->source);
    hs_report_text("roughness_source", s->roughness);
    hs_report_close();
}

void surfaces_print(double wavelength_m)
{
    printf(
        "# at %.4g GHz\n# NAME PERMITTIVITY LOSS RMS_HEIGHT_M CORRELATION_M F_S F_R F_D F_B "
        "SPECTRUM COAT_M\n",
        ghz_of(wavelength_m));
    hs_report_array("materials");
    for (int i = 0; i < surface_count; i++) {
        const struct surface *s = &surfaces[i];
        const struct reflect_material m = surface_at(s, wavelength_m);
        report_material(&m, s);
        printf("%s %.12g %.12g %g %g %g %g %g %g %s %g # %s\n", m.name, m.permittivity, m.loss,
               m.rms_height_m, m.correlation_m, m.specular, m.roughness, m.diffuse, m.brilliance,
               reflect_spectrum_names[m.spectrum], m.coat_m, s->what);
    }
    hs_report_close();
}

static void print_band(const struct surface *s, double ghz)
{
    const double wavelength_m = light_m_ns / ghz;
    const struct reflect_material m = surface_at(s, wavelength_m);
    const double complex permittivity = m.permittivity - m.loss * I;
    const double complex straight_on =
        m.coat_m > 0 ? reflect_coat_hh(permittivity, m.coat_m, wavelength_m, 0)
                     : reflect_fresnel_hh(permittivity, 0);
    const double reflection_db = 20 * log10(cabs(straight_on));
    const double ks = 2 * pi / wavelength_m * m.rms_height_m;
    char text[32];
    snprintf(text, sizeof text, "%.3g-%.2gi", m.permittivity, m.loss);
    printf(" %13s %6.2f", text, reflection_db);
    hs_report_object(NULL);
    hs_report_real("frequency_ghz", ghz);
    hs_report_real("permittivity", m.permittivity);
    hs_report_real("loss", m.loss);
    hs_report_real("reflection_db", reflection_db);
    hs_report_real("ks", ks);
    hs_report_close();
}

void surfaces_print_bands(void)
{
    static const double ghz[] = {10, 15, 22, 35};
    printf("Permittivity, and power reflected straight on in dB\n\n%-14s%21s%21s%21s%21s\n", "",
           "X: 10 GHz", "Ku: 15 GHz", "K: 22 GHz", "Ka: 35 GHz");
    hs_report_array("materials");
    for (int i = 0; i < surface_count; i++) {
        const struct surface *s = &surfaces[i];
        hs_report_object(NULL);
        hs_report_text("name", s->plain.name);
        hs_report_array("bands");
        printf("%-14s", s->plain.name);
        for (size_t k = 0; k < sizeof ghz / sizeof ghz[0]; k++) {
            print_band(s, ghz[k]);
        }
        putchar('\n');
        hs_report_close();
        hs_report_close();
    }
    hs_report_close();
    puts("\nSources of permittivity; of heights, and those in mm:");
    for (int i = 0; i < surface_count; i++) {
        const struct surface *s = &surfaces[i];
        printf("%-14s %s; %s, %g\n", s->plain.name, s->source, s->roughness,
               s->plain.rms_height_m * 1000);
    }
}
