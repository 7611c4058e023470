/* landmass-reference: the picture of the firmware, computed in double precision. */
#include "dump.h"

#include "hs/angle.h"
#include "hs/error.h"
#include "hs/menu.h"
#include "hs/options.h"
#include "hs/png.h"
#include "lm/grain.h"
#include "reference/reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of the firmware's table. */
#define WAVELENGTH_M       0.031228
#define AZIMUTH_BEAM_DEG   3.3
#define ELEVATION_BEAM_DEG 4.6

enum { FOR_SAR = 1, FOR_GM = 2, FOR_SECTOR = 4, FOR_FANS = FOR_GM | FOR_SECTOR, FOR_ALL = 7 };

/* What the command line says; NAN stands for "from the image". */
struct request {
    const char *image, *out, *dump;
    bool has_exact_weights;
    double latitude_deg, longitude_deg, antenna_m, azimuth_deg, range_m, cell_m, cells;
    double half_angle_deg, lines, size_px, scale, epoch, looks, plan;
    double beam_deg, tilt_deg, pulse_us, noise_db, code_gain_db, air_db_km, noise_looks, stc_m;
    double sharpening, beam_step_deg, rate_deg_s, speed_m_s, track_deg;
    double rain_mm_h, rain_radius_m, rain_distance_m, rain_bearing_deg;
    double jam_db, jam_distance_m, jam_bearing_deg;
    struct ref_params params;
};

struct number {
    const char *name, *help;
    size_t offset; /* of the double in struct request */
    int modes;
    double low, high, usual;
    bool is_whole;
};

#define AT(field) offsetof(struct request, field)

static const struct number numbers[] = {
    {"latitude", "degrees, of the patch's centre or the antenna; the image's centre by default",
     AT(latitude_deg), FOR_ALL, -90, 90, NAN, false},
    {"longitude", "degrees, likewise", AT(longitude_deg), FOR_ALL, -360, 360, NAN, false},
    {"azimuth", "degrees from north: line of sight at the patch, or middle of the sector",
     AT(azimuth_deg), FOR_ALL, -720, 720, 0, false},
    {"height", "metres of the antenna above mean sea level", AT(antenna_m), FOR_ALL, 1, 30000, 6000,
     false},
    {"range", "metres along the ground: antenna to patch, or to the last cell's end", AT(range_m),
     FOR_ALL, 100, 300000, 37040, false},
    {"cells", "range cells of a line (and lines of a patch)", AT(cells), FOR_ALL, 8, 4096, 256,
     true},
    {"cell", "metres of a patch's cell", AT(cell_m), FOR_SAR, 0.1, 1000, 10, false},
    {"half-angle", "degrees to either side of the sector's middle", AT(half_angle_deg), FOR_FANS, 1,
     90, 60, false},
    {"lines", "azimuth lines of the sector", AT(lines), FOR_FANS, 1, 8192, 256, true},
    {"size", "pixels of the picture's height", AT(size_px), FOR_FANS, 16, 4096, 512, true},
    {"scale", "pixels along a cell's side", AT(scale), FOR_SAR, 1, 16, 2, true},
    {"epoch", "number of the look: another one, another speckle", AT(epoch), FOR_ALL, 0,
     4294967295.0, 0, true},
    {"looks", "independent looks averaged", AT(looks), FOR_SAR | FOR_GM, 1, 64, 4, true},
    {"beam", "degrees of the one-way half-power beam in azimuth", AT(beam_deg), FOR_SECTOR, 0.1, 20,
     AZIMUTH_BEAM_DEG, false},
    {"tilt", "degrees of the antenna upwards; AUTO by default", AT(tilt_deg), FOR_SECTOR, -60, 60,
     NAN, false},
    {"pulse", "microseconds of the pulse", AT(pulse_us), FOR_SECTOR, 0.01, 100, 1, false},
    {"noise", "dB of gamma that it is worth 18,520 m away, from 3,000 m, with a pulse of 0.4 us",
     AT(noise_db), FOR_SECTOR, -200, 60, -40, false},
    {"code-gain", "dB of a coded pulse over a simple one", AT(code_gain_db), FOR_SECTOR, 0, 60, 0,
     false},
    {"air", "dB of loss in clear air for a kilometre, there and back", AT(air_db_km), FOR_SECTOR, 0,
     1, 0.0243, false},
    {"noise-looks", "independent looks of the noise", AT(noise_looks), FOR_SECTOR, 1, 64, 16, true},
    {"stc", "metres of slant range where the time gain ends", AT(stc_m), FOR_SECTOR, 1, 1e6, 27780,
     false},
    {"sharpening", "cells in a beam width; 1: real beam", AT(sharpening), FOR_SECTOR, 1, 256, 1,
     false},
    {"beam-step", "degrees between beam positions, for sharpening; 0: none", AT(beam_step_deg),
     FOR_SECTOR, 0, 20, 1.32, false},
    {"rate", "degrees a second of the antenna, for sharpening", AT(rate_deg_s), FOR_SECTOR, 0.1,
     360, 15, false},
    {"speed", "metres a second, for sharpening", AT(speed_m_s), FOR_SECTOR, 1, 2000, 250, false},
    {"track", "degrees from north of the velocity, for sharpening", AT(track_deg), FOR_SECTOR, -720,
     720, 0, false},
    {"plan", "1: a plan, without layover", AT(plan), FOR_SAR, 0, 1, 0, true},
    {"rain", "millimetres an hour in a circle; 0: no rain", AT(rain_mm_h), FOR_SAR | FOR_SECTOR, 0,
     150, 0, false},
    {"rain-radius", "metres of the circle", AT(rain_radius_m), FOR_SAR | FOR_SECTOR, 100, 100000,
     5000, false},
    {"rain-distance", "metres from the antenna to its centre", AT(rain_distance_m),
     FOR_SAR | FOR_SECTOR, 0, 300000, 15000, false},
    {"rain-bearing", "degrees from north, likewise", AT(rain_bearing_deg), FOR_SAR | FOR_SECTOR,
     -720, 720, 0, false},
    {"jam", "dB of a jammer above the noise at ten nautical miles; -200: none", AT(jam_db),
     FOR_SECTOR, -200, 80, -200, false},
    {"jam-distance", "metres to the jammer", AT(jam_distance_m), FOR_SECTOR, 100, 300000, 18520,
     false},
    {"jam-bearing", "degrees from north, likewise", AT(jam_bearing_deg), FOR_SECTOR, -720, 720, 0,
     false},
    {"edge-structure", "dB at the leading edge of structures", AT(params.edge_structure_db),
     FOR_ALL, 0, 40, NAN, false},
    {"edge-trees", "dB at the leading edge of trees", AT(params.edge_trees_db), FOR_ALL, 0, 40, NAN,
     false},
    {"shore", "dB at the far shore", AT(params.shore_db), FOR_ALL, 0, 40, NAN, false},
    {"shore-width", "metres in which that falls to nothing", AT(params.shore_width_m), FOR_ALL, 0,
     10000, NAN, false},
    {"sea", "dB that the sea is above that of state 3, 5 a state", AT(params.sea_db), FOR_ALL, -15,
     25, NAN, false},
    {"lobe-half", "degrees from the middle of the lobe of walls to half its power",
     AT(params.lobe_half_deg), FOR_ALL, 4, 45, NAN, false},
    {"wall-floor", "power of walls from whatever side, of their mean", AT(params.wall_floor),
     FOR_ALL, 0.01, 1, NAN, false},
    {"floor", "dB of the noise floor", AT(params.noise_floor_db), FOR_SAR | FOR_GM, -120, 60, NAN,
     false},
    {"leak", "dB that the mean of the ground leaves in the dark", AT(params.leak_db),
     FOR_SAR | FOR_SECTOR, -120, 0, NAN, false},
    {"leak-most", "dB that a cell counts for at most in that mean", AT(params.leak_most_db),
     FOR_SAR | FOR_SECTOR, -120, 60, NAN, false},
    {"side-lobes", "cells of a line that have side lobes", AT(params.side_lobes.a_line), FOR_SAR, 0,
     16, NAN, true},
    {"over-shadow", "dB that such a cell stands over a shadow",
     AT(params.side_lobes.over_shadow_db), FOR_SAR, 0, 100, NAN, false},
    {"above", "dB that it stands over the cells four before and behind it",
     AT(params.side_lobes.above_db), FOR_SAR, 0, 100, NAN, false},
    {"black", "dB shown black", AT(params.black_db), FOR_ALL, -120, 60, NAN, false},
    {"white", "dB shown white", AT(params.white_db), FOR_ALL, -120, 60, NAN, false},
    {"gamma", "exponent of the tone curve", AT(params.gamma_exponent), FOR_ALL, 0.1, 10, NAN,
     false},
};
enum { NUMBERS = sizeof numbers / sizeof numbers[0] };

static double *number_value(struct request *request, const struct number *number)
{
    return (double *)(void *)((char *)request + number->offset);
}

static const struct hs_usage usages[] = {
    {"sar", "a patch, the line of sight upwards", ""},
    {"gm", "a sector as it is sampled, seen from above",
     "The antenna is in the middle of the lower edge."},
    {"sector", "a sector behind antenna and receiver",
     "Beam, slant range, pulse, noise, rain, jamming."},
};
enum { MODES = sizeof usages / sizeof usages[0] };

/* Which of `usages` has this name; the last for any other. */
static int mode_index(const char *name)
{
    int i = 0;
    while (i < MODES - 1 && strcmp(usages[i].command, name) != 0) {
        i++;
    }
    return i;
}

/* The options of a mode; returns how many. A number's value is its default before. */
static size_t fill_options(struct hs_option *options, struct request *request, int mode)
{
    size_t count = 0;
    options[count++] = (struct hs_option){
        "IMAGE", HS_INPUT_ARGUMENT, &request->image, 0, 0, NULL, "the database image", true};
    for (int i = 0; i < NUMBERS; i++) {
        const struct number *n = &numbers[i];
        if (n->modes & mode) {
            options[count++] = (struct hs_option){
                n->name, HS_REAL, number_value(request, n), n->low, n->high, "X", n->help, false};
        }
    }
    options[count++] = (struct hs_option){"exact-weights",
                                          HS_FLAG,
                                          &request->has_exact_weights,
                                          0,
                                          0,
                                          NULL,
                                          "do not cut the weights between posts to 8 bits",
                                          false};
    options[count++] = (struct hs_option){
        "out", HS_OUTPUT, &request->out, 0, 0, "FILE", "the picture, a grey PNG (reference.png)",
        false};
    options[count++] =
        (struct hs_option){"dump",
                           HS_TEXT,
                           &request->dump,
                           0,
                           0,
                           "FILE",
                           "every stage of every cell: CSV, or raw doubles if FILE ends in .f64",
                           false};
    options[count++] = (struct hs_option){"Columns of the dump", HS_HEADING, NULL, 0, 0, NULL,
                                          ref_dump_columns,      false};
    return count;
}

/* Whether the numbers that must be whole are, and white lies above black. */
static bool check_numbers(struct request *request, const struct hs_usage *usage, int mode,
                          int *exit_code)
{
    for (int i = 0; i < NUMBERS; i++) {
        const struct number *n = &numbers[i];
        if (n->is_whole && (n->modes & mode) && fmod(*number_value(request, n), 1) != 0) {
            char name[64];
            snprintf(name, sizeof name, "--%s", n->name);
            *exit_code = hs_options_wrong(usage, name, "needs a whole number");
            return false;
        }
    }
    if (request->params.white_db <= request->params.black_db) {
        *exit_code = hs_options_wrong(usage, "--white", "must lie above --black");
        return false;
    }
    return true;
}

static bool parse(struct request *request, int mode, int argc, char **argv, int *exit_code)
{
    *request = (struct request){.out = "reference.png", .params = ref_params_default()};
    for (int i = 0; i < NUMBERS; i++) {
        double *value = number_value(request, &numbers[i]);
        *value = numbers[i].offset >= AT(params) ? *value : numbers[i].usual;
    }
    const struct hs_usage *usage = &usages[mode_index(argv[0])];
    struct hs_option options[NUMBERS + 5];
    const size_t count = fill_options(options, request, mode);
    if (!hs_options_read(usage, options, count, argc, argv, exit_code) ||
        !check_numbers(request, usage, mode, exit_code)) {
        return false;
    }
    request->params.looks = (unsigned)request->looks;
    request->params.has_exact_weights = request->has_exact_weights;
    return true;
}

static struct ref_place place_of(const struct request *request, const struct ref_db *db)
{
    return (struct ref_place){
        isnan(request->latitude_deg) ? db->centre.latitude_deg : request->latitude_deg,
        isnan(request->longitude_deg) ? db->centre.longitude_deg : request->longitude_deg};
}

/* Write the dump and the picture; `pixels` is freed. */
static int write_out(const struct request *request, const struct ref_picture *picture,
                     uint8_t *pixels, unsigned width, unsigned height)
{
    int status = request->dump ? ref_dump(picture, request->dump) : 0;
    if (status == 0) {
        status = hs_png_write_grey(request->out, pixels, (int)width, (int)height, (size_t)width);
    }
    free(pixels);
    return status;
}

/* The one circle that the command line asks for. */
static size_t set_rain(const struct request *request, struct ref_place antenna,
                       struct ref_rain *rain, struct ref_place *centre)
{
    *rain = (struct ref_rain){.radius_m = request->rain_radius_m, .mm_per_h = request->rain_mm_h};
    *centre = ref_geo_direct(antenna, request->rain_bearing_deg, request->rain_distance_m);
    return request->rain_mm_h > 0;
}

/* Beam and wavelength are those of the firmware's table. */
static int render_sar(const struct request *request, const struct ref_db *db)
{
    const struct lm_grain_place start = lm_grain_start(LM_GRAIN_SPECKLE, (uint32_t)request->epoch);
    struct ref_sar sar = {.centre = place_of(request, db),
                          .azimuth_deg = request->azimuth_deg,
                          .range_m = request->range_m,
                          .antenna_m = request->antenna_m,
                          .cell_m = request->cell_m,
                          .cell_count = (unsigned)request->cells,
                          .is_plan = request->plan != 0,
                          .grain_row = start.row,
                          .grain_column = start.column,
                          .side_lobe_seed = hs_bam(place_of(request, db).longitude_deg),
                          .rain = {.wavelength_m = WAVELENGTH_M,
                                   .azimuth_beam_deg = AZIMUTH_BEAM_DEG,
                                   .elevation_beam_deg = ELEVATION_BEAM_DEG}};
    sar.rain.environment.rain_count =
        set_rain(request, ref_patch_offset(sar.centre, sar.azimuth_deg, 0, -sar.range_m),
                 &sar.rain.environment.rain[0], &sar.rain_centre[0]);
    const double near_m = sar.range_m - (sar.cell_count / 2.0) * sar.cell_m;
    if (near_m <= 0) {
        return hs_error("--range", "give a longer range or a smaller patch",
                        "the patch would begin behind the antenna, at %g m", near_m);
    }
    struct ref_picture picture;
    if (ref_sar_patch(&picture, db, &sar, &request->params) != 0) {
        return -1;
    }
    const unsigned side = sar.cell_count * (unsigned)request->scale;
    uint8_t *pixels = malloc((size_t)side * side);
    int status = -1;
    if (pixels == NULL) {
        hs_error("picture", "lower --scale", "not enough memory for %u x %u pixels", side, side);
    } else {
        ref_glass_sar(&picture, sar.range_m, side, pixels);
        status = write_out(request, &picture, pixels, side, side);
    }
    ref_picture_free(&picture);
    return status;
}

/* Width of a sector's picture whose radius is its height. */
static unsigned sector_width(double half_angle_deg, double height_px)
{
    return (unsigned)(2 * ceil(height_px * sin(half_angle_deg * acos(-1.0) / 180)));
}

static struct ref_gm sector_of(const struct request *request, const struct ref_db *db)
{
    return (struct ref_gm){.antenna = place_of(request, db),
                           .antenna_m = request->antenna_m,
                           .cell_m = request->range_m / floor(request->cells),
                           .centre_azimuth_deg = request->azimuth_deg,
                           .half_angle_deg = request->half_angle_deg,
                           .cell_count = (unsigned)request->cells,
                           .line_count = (unsigned)request->lines,
                           .epoch = (uint32_t)request->epoch};
}

/* Write a sector's picture, which is freed. */
static int write_sector(const struct request *request, struct ref_picture *picture,
                        const struct ref_gm *gm)
{
    const unsigned height = (unsigned)request->size_px;
    const unsigned width = sector_width(gm->half_angle_deg, height);
    uint8_t *pixels = malloc((size_t)width * height);
    int status = -1;
    if (pixels == NULL) {
        hs_error("picture", "lower --size", "not enough memory for %u x %u pixels", width, height);
    } else {
        ref_glass_gm(picture, gm, width, height, pixels);
        status = write_out(request, picture, pixels, width, height);
    }
    ref_picture_free(picture);
    return status;
}

static int render_gm(const struct request *request, const struct ref_db *db)
{
    const struct ref_gm gm = sector_of(request, db);
    struct ref_picture picture;
    return ref_gm_sweep(&picture, db, &gm, &request->params) == 0
               ? write_sector(request, &picture, &gm)
               : -1;
}

static void set_weather(const struct request *request, struct ref_sector *s)
{
    s->environment.rain_count =
        set_rain(request, s->ground.antenna, &s->environment.rain[0], &s->rain_centre[0]);
    if (request->jam_db > -200) {
        s->environment.jammer_count = 1;
        s->environment.jammer[0].ratio_db = request->jam_db;
        s->jammer_place[0] =
            ref_geo_direct(s->ground.antenna, request->jam_bearing_deg, request->jam_distance_m);
    }
}

/* Everything else of the antenna is that of the firmware's table: a fan of 30 degrees, 4.6 degrees
 * tall, samples 120/128 degrees apart of two azimuths each; and the wavelength of 9.6 GHz. */
static int render_sector(const struct request *request, const struct ref_db *db)
{
    double noise_table_db[REF_SPECKLE_SLICES];
    ref_speckle_table((unsigned)request->noise_looks, noise_table_db);
    struct ref_sector s = {
        .ground = sector_of(request, db),
        .beam_deg = request->beam_deg,
        .sample_deg = 120.0 / 128,
        .azimuths = 2,
        .sharpening = request->sharpening,
        .beam_step_deg = request->sharpening > 1 ? request->beam_step_deg : 0,
        .dbs = {request->speed_m_s, request->beam_deg, WAVELENGTH_M, request->rate_deg_s},
        .track_deg = request->track_deg,
        .antenna = {ELEVATION_BEAM_DEG, 30, 2.2},
        .receiver = {.noise = {request->noise_db, 18520, 3000, 400e-9},
                     .code_gain_db = request->code_gain_db,
                     .air_loss_db_km = request->air_db_km,
                     .noise_table_db = noise_table_db,
                     .stc_m = request->stc_m,
                     .pulse_s = request->pulse_us * 1e-6}};
    if (s.ground.cell_count > REF_CELLS_MAX) {
        return hs_error("--cells", NULL, "a sector has %d cells at the most", REF_CELLS_MAX);
    }
    const struct ref_view view = ref_gm_view(db, &s.ground, &request->params);
    s.tilt_deg = isnan(request->tilt_deg)
                     ? ref_auto_tilt_deg(view.antenna_m - view.reference_m, request->range_m)
                     : request->tilt_deg;
    set_weather(request, &s);
    struct ref_picture picture;
    return ref_sector_sweep(&picture, db, &s, &request->params) == 0
               ? write_sector(request, &picture, &s.ground)
               : -1;
}

/* argv[0] names the mode. */
static int run(int argc, char **argv)
{
    const int mode = 1 << mode_index(argv[0]);
    struct request request;
    int exit_code;
    if (!parse(&request, mode, argc, argv, &exit_code)) {
        return exit_code;
    }
    struct ref_db db;
    if (ref_db_open(&db, request.image) != 0) {
        return HS_EXIT_FAILED;
    }
    const int status = mode == FOR_SAR  ? render_sar(&request, &db)
                       : mode == FOR_GM ? render_gm(&request, &db)
                                        : render_sector(&request, &db);
    ref_db_close(&db);
    return status == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int main(int argc, char **argv)
{
    struct hs_command commands[MODES];
    for (int i = 0; i < MODES; i++) {
        commands[i] = (struct hs_command){usages[i].command, usages[i].summary, run};
    }
    const struct hs_menu menu = {
        .program = "landmass-reference",
        .purpose = "a picture in double precision, by the equations of docs/EQUATIONS.md",
        .commands = commands,
        .count = MODES,
        .closing = "It is what the firmware's picture is judged by.\n"};
    return hs_menu_main(&menu, argc, argv);
}
