/* landmass-realradar focus */
#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/output_path.h"
#include "hs/report.h"
#include "realradar/point_response.h"
#include "realradar/speckle_statistics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "focus", "make a picture of a real phase history; score speckle and points",
    "Make a picture of a phase history by back-projection, and print how its speckle and its "
    "points compare with theory and with the firmware's speckle.\n"
    "\n"
    "Even ground is found by the texture of block means; points are those with nothing near them. "
    "Noise is Gaussian noise in place of the echo, through the same band, aperture and choice of "
    "windows: what a perfect scene would score."};

enum { REFLECTORS_MOST = 5, FIRMWARE_SIDE = 512 };

static const double taylor_db = 35, picture_span_db = 60;

struct focus {
    struct rr_phase_history history;
    struct rr_resolution resolution;
    struct rr_profiles profiles;
    struct rr_image image;
    double side_m, pixel_m;
    double taylor_db; /* of the picture, and so of its speckle; 0: no weighting */
};

static void put_statistics(const struct rr_statistics *s)
{
    hs_report_put("cv_power", s->cv_intensity);
    hs_report_put("cv_amplitude", s->cv_amplitude);
    hs_report_put("std_db", s->db_std);
    hs_report_put("ks", s->ks);
    hs_report_put("enl", s->enl);
}

static void report_statistics(const char *key, const struct rr_statistics *s, double cells)
{
    hs_report_object(key);
    hs_report_put("cells", cells);
    put_statistics(s);
    hs_report_close();
}

static void print_row(const char *name, const struct rr_statistics *s, double cells)
{
    printf("| %-32s | %7.0f | %.3f | %.3f | %.2f | %.4f | %.3f |\n", name, cells, s->cv_intensity,
           s->cv_amplitude, s->db_std, s->ks, s->enl);
}

static void print_header(const char *what, const char *count)
{
    printf(
        "\n| %s | %s | CV power | CV amplitude | dB std | KS | ENL |\n"
        "|---|---|---|---|---|---|---|\n",
        what, count);
}

static int print_firmware(void)
{
    const size_t cells = (size_t)FIRMWARE_SIDE * FIRMWARE_SIDE;
    double *power = malloc(cells * sizeof *power);
    if (!power) {
        return hs_error("speckle", NULL, "out of memory");
    }
    struct rr_statistics s;
    rr_firmware_speckle(power, FIRMWARE_SIDE, 0, 1);
    rr_statistics_of(&s, power, cells);
    print_row("simulated: the firmware, 1 look", &s, (double)cells);
    report_statistics("firmware", &s, (double)cells);
    free(power);
    return 0;
}

static void report_window(const struct rr_window *w, struct rr_place place, bool is_bright,
                          const struct rr_statistics *s)
{
    hs_report_object(NULL);
    hs_report_put("x_m", place.x);
    hs_report_put("y_m", place.y);
    hs_report_put("mean", w->mean);
    hs_report_put("texture", w->texture);
    hs_report_flag("is_bright", is_bright);
    put_statistics(s);
    hs_report_close();
}

static void print_windows(const struct rr_ground *ground, const struct rr_image *image)
{
    print_header("even window, centre x, y in m; level; texture", "kind");
    hs_report_array("windows");
    for (int i = 0; i < ground->count; i++) {
        const struct rr_window *w = &ground->windows[i];
        const struct rr_statistics *s = &ground->each[i];
        const struct rr_place place =
            rr_image_place(image, w->column + RR_WINDOW_PX / 2, w->row + RR_WINDOW_PX / 2);
        report_window(w, place, i < ground->bright, s);
        printf("| %6.1f, %6.1f; %5.1f dB; %.2f | %s | %.3f | %.3f | %.2f | %.4f | %.3f |\n",
               place.x, place.y, 10 * log10(w->mean / ground->windows[0].mean), w->texture,
               i < ground->bright ? "bright" : "dark", s->cv_intensity, s->cv_amplitude, s->db_std,
               s->ks, s->enl);
    }
    hs_report_close();
}

/* The same geometry with noise for an echo, at the same places of the same picture. */
static int measure_noise(const struct focus *f, struct rr_ground *ground)
{
    struct rr_phase_history noise;
    struct rr_profiles profiles = {0};
    struct rr_image image = {0};
    int status = rr_phase_history_alike(&noise, &f->history);
    if (status != 0) {
        return status;
    }
    rr_phase_history_fill_noise(&noise, 1);
    status = rr_compress(&profiles, &noise, f->taylor_db);
    if (status == 0) {
        status = rr_image_make(&image, &profiles, f->side_m, f->pixel_m);
    }
    if (status == 0) {
        status = rr_ground_measure(ground, &image, &f->resolution);
    }
    rr_image_free(&image);
    rr_profiles_free(&profiles);
    rr_phase_history_free(&noise);
    return status;
}

static int print_speckle(const struct focus *f)
{
    struct rr_ground *ground = malloc(2 * sizeof *ground);
    int status = ground ? 0 : hs_error("speckle", NULL, "out of memory");
    if (status == 0) {
        status = rr_ground_measure(&ground[0], &f->image, &f->resolution);
    }
    if (status == 0) {
        status = measure_noise(f, &ground[1]);
    }
    if (status == 0) {
        print_header("speckle of one look", "cells");
        printf("| %-32s |         | 1.000 | 0.523 | 5.57 | 0      | 1.000 |\n", "theory");
        status = print_firmware();
    }
    if (status == 0) {
        print_row("noise through the same processing", &ground[1].pooled,
                  ground[1].cells * ground[1].bright);
        print_row("real: bright even ground", &ground[0].pooled,
                  ground[0].cells * ground[0].bright);
        report_statistics("noise", &ground[1].pooled, ground[1].cells * ground[1].bright);
        report_statistics("real", &ground[0].pooled, ground[0].cells * ground[0].bright);
        printf("\nsampling: CV power 1 / sqrt(cells) = %.3f; KS at 5 %% (Stephens 1974) %.3f\n",
               1 / sqrt(ground[0].cells * ground[0].bright),
               1.094 / sqrt(ground[0].cells * ground[0].bright));
        print_windows(&ground[0], &f->image);
    }
    free(ground);
    return status;
}

static void print_cut(const char *name, const char *direction, const struct rr_cut *cut,
                      double cell_m)
{
    printf("| %-28s | %-5s | %.3f m | %.3f | %.2f | %.2f |\n", name, direction,
           cut->irw_cells * cell_m, cut->irw_cells, cut->pslr_db, cut->islr_db);
}

static void report_cut(const char *key, const struct rr_cut *cut, double cell_m)
{
    hs_report_object(key);
    hs_report_put("irw_m", cut->irw_cells * cell_m);
    hs_report_put("irw_cells", cut->irw_cells);
    hs_report_put("pslr_db", cut->pslr_db);
    hs_report_put("islr_db", cut->islr_db);
    hs_report_close();
}

static void print_response(const char *name, const struct rr_response *r,
                           const struct rr_resolution *resolution)
{
    print_cut(name, "range", &r->range, resolution->range_m);
    print_cut(name, "cross", &r->cross, resolution->cross_m);
    hs_report_object(NULL);
    hs_report_put("name", name);
    hs_report_put("x_m", r->place.x);
    hs_report_put("y_m", r->place.y);
    report_cut("range", &r->range, resolution->range_m);
    report_cut("cross", &r->cross, resolution->cross_m);
    hs_report_close();
}

/* A perfect point at the scene's centre, in the same geometry. */
static int print_perfect(const struct focus *f, double weighting_db)
{
    struct rr_phase_history alone;
    struct rr_profiles profiles;
    if (rr_phase_history_alike(&alone, &f->history) != 0) {
        return -1;
    }
    const struct rr_place origin = {0, 0, 0};
    struct rr_response response;
    rr_phase_history_add_point(&alone, origin, 1);
    const int status = rr_compress(&profiles, &alone, weighting_db);
    rr_phase_history_free(&alone);
    if (status == 0) {
        rr_response_measure(&response, &profiles, &f->resolution, origin);
        print_response("perfect point, simulated", &response, &f->resolution);
        rr_profiles_free(&profiles);
    }
    return status;
}

static int print_points_weighted(const struct focus *f, const struct rr_place *places, int count,
                                 double weighting_db)
{
    struct rr_profiles profiles;
    if (rr_compress(&profiles, &f->history, weighting_db) != 0) {
        return -1;
    }
    printf(
        "\n%s:\n\n| point | cut | IRW | IRW in cells | PSLR dB | ISLR dB |\n"
        "|---|---|---|---|---|---|\n",
        weighting_db > 0 ? "Taylor -35 dB, n-bar 5, in both directions" : "No weighting");
    printf(weighting_db > 0
               ? "| theory                       | both  | | 1.187 | -35.2 | -27.4 |\n"
               : "| theory                       | both  | | 0.886 | -13.26 | -9.7 |\n");
    hs_report_array(weighting_db > 0 ? "points_taylor" : "points_unweighted");
    const int status = print_perfect(f, weighting_db);
    for (int i = 0; i < count; i++) {
        struct rr_response response;
        char name[64];
        rr_response_measure(&response, &profiles, &f->resolution, places[i]);
        snprintf(name, sizeof name, "real, at %.2f, %.2f m", response.place.x, response.place.y);
        print_response(name, &response, &f->resolution);
    }
    hs_report_close();
    rr_profiles_free(&profiles);
    return status;
}

static int print_points(const struct focus *f)
{
    struct rr_place places[REFLECTORS_MOST];
    const int count = rr_find_reflectors(&f->image, &f->resolution, places, REFLECTORS_MOST);
    if (print_points_weighted(f, places, count, 0) != 0) {
        return -1;
    }
    return print_points_weighted(f, places, count, taylor_db);
}

static void print_geometry(const struct focus *f)
{
    const struct rr_resolution *r = &f->resolution;
    const double degrees = 57.29577951308232;
    printf(
        "%d frequencies, %.2f MHz about %.3f GHz; %d pulses over %.3f degrees; grazing %.2f "
        "degrees\n",
        f->history.frequencies, r->bandwidth_hz / 1e6, rr_light_m_s / r->wavelength_m / 1e9,
        f->history.pulses, r->aperture_rad * degrees, r->grazing_rad * degrees);
    hs_report_put("frequencies", f->history.frequencies);
    hs_report_put("bandwidth_hz", r->bandwidth_hz);
    hs_report_put("wavelength_m", r->wavelength_m);
    hs_report_put("pulses", f->history.pulses);
    hs_report_put("aperture_deg", r->aperture_rad * degrees);
    hs_report_put("grazing_deg", r->grazing_rad * degrees);
    hs_report_put("range_cell_m", r->range_m);
    hs_report_put("cross_cell_m", r->cross_m);
    printf("resolution cell on the ground: %.3f m in range (c/2B cos), %.3f m across\n", r->range_m,
           r->cross_m);
}

static int focus(struct focus *f, const char *path, const char *folder)
{
    char picture[4096];
    if (rr_phase_history_read(&f->history, path) != 0) {
        return -1;
    }
    f->resolution = rr_resolution_of(&f->history);
    if (rr_compress(&f->profiles, &f->history, f->taylor_db) != 0 ||
        rr_image_make(&f->image, &f->profiles, f->side_m, f->pixel_m) != 0) {
        return -1;
    }
    print_geometry(f);
    if (print_speckle(f) != 0 || print_points(f) != 0) {
        return -1;
    }
    return !folder ? 0
           : hs_output_path(picture, sizeof picture, folder, "picture.png") != 0
               ? -1
               : rr_image_write(&f->image, picture, picture_span_db);
}

int rr_cmd_focus(int argc, char **argv)
{
    struct focus f = {.side_m = 100, .pixel_m = 0.2};
    const char *path = NULL, *folder = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &path, 0, 0, NULL,
         "one degree of the AFRL Gotcha set (MATLAB 5: data.fp, freq, x, y, z, r0)", true},
        {"size", HS_REAL, &f.side_m, 20, 200, "M",
         "side of the ground patch round the scene's centre", false},
        {"pixel", HS_REAL, &f.pixel_m, 0.05, 1, "M", "of the picture", false},
        {"side-lobes", HS_REAL, &f.taylor_db, 0, 60, "DB",
         "how far a Taylor weighting of the picture holds them below a point, so that what is\n"
         "bright lays less of itself over the ground; 0: no weighting",
         false},
        {"out", HS_FOLDER, &folder, 0, 0, "DIR",
         "leave picture.png there, 60 dB from black to white", false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    const int status = focus(&f, path, folder);
    rr_image_free(&f.image);
    rr_profiles_free(&f.profiles);
    rr_phase_history_free(&f.history);
    return status == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
