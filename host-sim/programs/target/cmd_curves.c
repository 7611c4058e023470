#include "commands.h"

#include "hs/chart.h"
#include "hs/error.h"
#include "hs/options.h"
#include "tracer/reflect.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct hs_usage usage = {
    "curves", "draw the reflection laws: Niu and others, Figures 3 to 6",
    "FIGURE is 3 (Fresnel), 4 (small perturbation), 5 (RaySAR, specular) or 6 (RaySAR, diffuse).\n"
    "3 is drawn over the angle of incidence, for several permittivities. The others are drawn\n"
    "over the angle of the echo in the plane of incidence, -90 degrees being on the side that\n"
    "the ray comes from, for incidences of 0, 15, 30, 45, 60 and 75 degrees."};

static const double pi = 3.14159265358979323846;

static const uint32_t inks[] = {0x1040c0, 0xc02020, 0x208030, 0xb06000, 0x7030a0, 0x107080};
enum { CURVES = sizeof inks / sizeof inks[0], SAMPLES = 721 };
static const double permittivities[CURVES] = {2, 4, 8, 16, 32, 80};

/* One curve of a figure. */
struct curve {
    int figure;
    bool is_vv;
    double parameter; /* permittivity, or incidence in degrees */
    double scale;     /* figure 4: the largest value of the panel becomes 1 */
    struct reflect_material material;
};

/* A slightly rough surface of X band, within the method's bounds: k s = 0.2, k l = 2. */
static struct reflect_material sample_material(void)
{
    const double k = 2 * pi / 0.03123;
    return (struct reflect_material){"sample", 6,   0, 0.2 / k,          2 / k, 0.8,
                                     0.02,     0.6, 1, REFLECT_GAUSSIAN, 0};
}

/* The turn between source at theta1 and echo at theta2, which is negative on the source's side. */
static double turn_between(double theta1, double theta2)
{
    return fabs(theta1 + theta2);
}

static double value_at(void *ctx, double x_deg)
{
    const struct curve *c = ctx;
    const double x = x_deg * pi / 180, t1 = c->parameter * pi / 180;
    switch (c->figure) {
    case 3:
        return cabs(c->is_vv ? reflect_fresnel_vv(c->parameter, x)
                             : reflect_fresnel_hh(c->parameter, x));
    case 4:
        return c->scale * reflect_spm_sigma0(&c->material, 0.03123, c->is_vv, t1, fabs(x),
                                             turn_between(t1, x));
    case 5:
        return reflect_raysar_specular(&c->material, t1, fabs(x), turn_between(t1, x));
    default: /* the light, and with it the radar, stands at t1; alike to all sides */
        return reflect_raysar_diffuse(&c->material, t1);
    }
}

static double panel_peak(struct curve c)
{
    double peak = 0;
    c.scale = 1;
    for (int i = 0; i < CURVES; i++) {
        c.parameter = 15 * i;
        for (double x = -89; x <= 89; x += 1) {
            peak = fmax(peak, value_at(&c, x));
        }
    }
    return peak;
}

static void draw_panel(struct sheet *sheet, int left, int figure, bool is_vv, const char *title)
{
    const struct chart chart = {.sheet = sheet,
                                .left = left,
                                .top = 50,
                                .width = 420,
                                .height = 320,
                                .x_low = figure == 3 ? 0 : -90,
                                .x_high = 90,
                                .x_step = figure == 3 ? 15 : 30,
                                .y_low = 0,
                                .y_high = 1,
                                .y_step = 0.2,
                                .title = title,
                                .x_name = figure == 3 ? "incidence, deg" : "echo, deg"};
    struct curve c = {figure, is_vv, 0, 1, sample_material()};
    if (figure == 4) {
        c.scale = 1 / panel_peak(c);
    }
    chart_axes(&chart);
    for (int i = 0; i < CURVES; i++) {
        char text[32];
        c.parameter = figure == 3 ? permittivities[i] : 15 * i;
        chart_curve(&chart, value_at, &c, SAMPLES, inks[i]);
        snprintf(text, sizeof text, figure == 3 ? "e %g" : "%g", c.parameter);
        sheet_text(sheet, left + 60 * i, 430, text, inks[i]);
    }
}

static int draw(int figure, const char *path)
{
    const bool has_two = figure <= 4;
    struct sheet sheet;
    if (sheet_open(&sheet, has_two ? 1040 : 520, 460) != 0) {
        return -1;
    }
    static const char *const titles[4][2] = {
        {"Fresnel HH, magnitude of R", "Fresnel VV, magnitude of R"},
        {"SPM HH, relative", "SPM VV, relative"},
        {"RaySAR specular, Fs 0.8, Fr 0.02", NULL},
        {"RaySAR diffuse, Fd 0.6, Fb 1", NULL}};
    draw_panel(&sheet, 70, figure, false, titles[figure - 3][0]);
    if (has_two) {
        draw_panel(&sheet, 590, figure, true, titles[figure - 3][1]);
    }
    return sheet_close(&sheet, path);
}

int target_cmd_curves(int argc, char **argv)
{
    const char *out = NULL;
    long figure = 3;
    const struct hs_option options[] = {
        {"figure", HS_INTEGER, &figure, 3, 6, "FIGURE", "which", false},
        {"out", HS_OUTPUT, &out, 0, 0, "FILE.png", "the picture", true},
    };
    int exit_code;
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return draw((int)figure, out) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
