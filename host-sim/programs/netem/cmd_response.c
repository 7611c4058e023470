#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/report.h"
#include "realradar/point_response.h"
#include "realradar/speckle_statistics.h"
#include "tracer/pix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "response", "the simulation's impulse response and speckle beside a real radar's",
    "Focus a real phase history (the AFRL Gotcha set) under a Taylor weighting of -35 dB, cut\n"
    "through its isolated points, and lay the simulation's impulse response over each cut, cell\n"
    "for cell: the root of the mean squared difference of the amplitudes in the main lobe, and\n"
    "the highest side lobe of both. Then the statistics of the simulation's speckle of one look\n"
    "beside those of even ground in the real picture."};

enum { POINTS_MOST = 5, APERTURE = 42, SPECKLE_CELLS = 1 << 18, MIDDLE = PIX_KERNEL_SIDE / 2 };
static const double taylor_db = 35, main_lobe_cells = 1.5;

/* The real amplitude, 1 at the peak, so many cells from it. */
static double real_at(const struct rr_cut *cut, double cells)
{
    const int middle = RR_CUT_SIZE / 2;
    const double at = middle + cells * RR_CUT_STEPS, step = floor(at);
    const int i = (int)step;
    if (i < 0 || i + 1 >= RR_CUT_SIZE) {
        return 0;
    }
    const double power = cut->power[i] + (at - step) * (cut->power[i + 1] - cut->power[i]);
    return sqrt(power / cut->power[middle]);
}

static void print_cut(const char *name, const char *direction, const struct rr_cut *cut)
{
    const double nothing = 1e-9; /* -180 dB */
    double response[PIX_KERNEL_SIDE], square = 0, side = nothing, real_side = nothing;
    int count = 0;
    pix_taylor(APERTURE, response);
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        const double cells = (double)(i - MIDDLE) * APERTURE / PIX_KERNEL_SIDE;
        const double real = real_at(cut, cells), ours = response[i];
        if (fabs(cells) <= main_lobe_cells) {
            square += (real - ours) * (real - ours);
            count++;
        } else if (fabs(cells) < RR_CUT_CELLS - 1) {
            side = fmax(side, ours);
            real_side = fmax(real_side, real);
        }
    }
    printf("%-24s %-6s %20.4f %14.1f dB %14.1f dB\n", name, direction, sqrt(square / count),
           20 * log10(side), 20 * log10(real_side));
    hs_report_object(direction);
    hs_report_put("main_lobe_difference", sqrt(square / count));
    hs_report_put("side_lobe_db", 20 * log10(side));
    hs_report_put("real_side_lobe_db", 20 * log10(real_side));
    hs_report_close();
}

static int print_points(const struct rr_phase_history *history, const struct rr_image *image,
                        const struct rr_resolution *resolution)
{
    struct rr_place places[POINTS_MOST];
    struct rr_profiles weighted;
    const int count = rr_find_reflectors(image, resolution, places, POINTS_MOST);
    if (rr_compress(&weighted, history, taylor_db) != 0) {
        return -1;
    }
    hs_report_array("points");
    printf("point at x, y in m       cut    difference, main lobe   side lobe, ours   real\n");
    for (int i = 0; i < count; i++) {
        struct rr_response r;
        char name[64];
        rr_response_measure(&r, &weighted, resolution, places[i]);
        snprintf(name, sizeof name, "%.2f, %.2f", r.place.x, r.place.y);
        hs_report_object(NULL);
        hs_report_put("x_m", r.place.x);
        hs_report_put("y_m", r.place.y);
        print_cut(name, "range", &r.range);
        print_cut(name, "cross", &r.cross);
        hs_report_close();
    }
    hs_report_close();
    rr_profiles_free(&weighted);
    return 0;
}

static void print_statistics(const char *key, const char *name, const struct rr_statistics *s,
                             double cells)
{
    hs_report_object(key);
    hs_report_put("cells", cells);
    hs_report_put("cv_power", s->cv_intensity);
    hs_report_put("cv_amplitude", s->cv_amplitude);
    hs_report_put("std_db", s->db_std);
    hs_report_put("ks", s->ks);
    hs_report_close();
    printf("%-24s %8.0f %10.3f %10.3f %8.2f %8.4f\n", name, cells, s->cv_intensity, s->cv_amplitude,
           s->db_std, s->ks);
}

static int print_speckle(const struct rr_image *image, const struct rr_resolution *resolution,
                         unsigned long seed)
{
    struct rr_ground *ground = malloc(sizeof *ground);
    float *power = malloc(SPECKLE_CELLS * sizeof *power);
    double *values = malloc(SPECKLE_CELLS * sizeof *values);
    int result = ground && power && values ? 0 : hs_error("speckle", NULL, "out of memory");
    result = result == 0 ? rr_ground_measure(ground, image, resolution) : -1;
    if (result == 0) {
        struct hs_rng rng;
        struct rr_statistics ours;
        hs_rng_seed(&rng, seed);
        for (int i = 0; i < SPECKLE_CELLS; i++) {
            power[i] = 1;
        }
        pix_speckle(power, SPECKLE_CELLS, 1, &rng);
        for (int i = 0; i < SPECKLE_CELLS; i++) {
            values[i] = (double)power[i];
        }
        rr_statistics_of(&ours, values, SPECKLE_CELLS);
        printf("\nspeckle of one look         cells   CV power  CV ampl.   dB std       KS\n");
        printf("%-24s %8s %10.3f %10.3f %8.2f %8.4f\n", "theory", "", 1.0, 0.523, 5.57, 0.0);
        print_statistics("simulated", "simulated", &ours, SPECKLE_CELLS);
        print_statistics("real", "real even ground", &ground->pooled,
                         ground->cells * ground->bright);
    }
    free(ground);
    free(power);
    free(values);
    return result;
}

static int run(const char *file, unsigned long seed)
{
    struct rr_phase_history history;
    struct rr_profiles plain;
    struct rr_image image;
    if (rr_phase_history_read(&history, file) != 0) {
        return -1;
    }
    const struct rr_resolution resolution = rr_resolution_of(&history);
    int result = rr_compress(&plain, &history, 0);
    if (result == 0) {
        result = rr_image_make(&image, &plain, 100, 0.2);
        if (result == 0) {
            result = print_points(&history, &image, &resolution) == 0
                         ? print_speckle(&image, &resolution, seed)
                         : -1;
            rr_image_free(&image);
        }
        rr_profiles_free(&plain);
    }
    rr_phase_history_free(&history);
    return result;
}

int nm_cmd_response(int argc, char **argv)
{
    const char *file = NULL;
    long seed = 1;
    int exit_code;
    const struct hs_option options[] = {
        {"history", HS_INPUT, &file, 0, 0, "FILE", "one degree of the Gotcha set, MATLAB 5", true},
        {"seed", HS_INTEGER, &seed, 0, 1e15, "N", "of the simulated speckle", false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return run(file, (unsigned long)seed) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
