#include "netem/settings.h"

#include "hs/error.h"

#include <math.h>
#include <string.h>

struct nm_settings nm_settings_default(void)
{
    return (struct nm_settings){
        .setup = setup_default(),
        .calibration = {.gain = NAN, .clutter = 0.05},
        .share = 0.8,
        .architecture = "EP8",
        .connection = "coefficient",
        .loss = "mse",
        .method = "adam",
        .rate = 1e-3,
        .pix_rate = 3e-5,
        .momentum = 0.9,
        .batch = 4,
        .pretrain = 5,
        .epochs = 40,
        .pix_epochs = 10,
        .reach_px = 3,
        .seed = 1,
    };
}

void nm_view_options(struct nm_settings *s, struct hs_option *o)
{
    struct setup *t = &s->setup;
    const struct hs_option options[NM_VIEW_OPTIONS - SETUP_MODEL_OPTIONS] = {
        {"depression", HS_REAL, &t->depression_deg, 1, 89, "DEG",
         "of the line of sight below the horizon, where chips do not tell", false},
        {"cells", HS_INTEGER, &t->cells, 64, 1024, "N",
         "of 0.1 m, the side of the simulated picture; chips have half as many pixels", false},
        {"rays", HS_INTEGER, &t->rays_per_cell, 1, 16, "N",
         "N x N of them meet a cell of level ground", false},
        {"bounces", HS_INTEGER, &t->bounces, 1, TRACE_BOUNCES_MAX, "N", "reflections followed",
         false},
        {"zones", HS_INTEGER, &t->zones, 0, MESH_ZONES_MAX, "N",
         "cut the model into N pieces along, 2 aside and 3 upwards, each of a material of its "
         "own;\n"
         "0: as it is",
         false},
        {"sides", HS_FLAG, &t->has_sides, 0, 0, NULL,
         "zones left and right are of materials of their own, too; for EP11", false},
    };
    setup_model_options(t, o);
    memcpy(o + SETUP_MODEL_OPTIONS, options, sizeof options);
}

void nm_law_options(struct nm_settings *s, struct hs_option *o)
{
    struct setup *t = &s->setup;
    const struct hs_option options[NM_LAW_OPTIONS] = {
        {"wavelength", HS_REAL, &t->wavelength_m, 0.001, 10, "M", "of the radar", false},
        {"resolution", HS_REAL, &t->resolution_m, 0.1, 10, "M",
         "of the radar, between -3 dB points", false},
        {"law", HS_WORD, &t->law, 0, 0, REFLECT_KIND_WORDS, "of the simulator before training",
         false},
        {"materials", HS_INPUT, &t->materials, 0, 0, "FILE",
         "surfaces by name, in the form that `landmass-target materials` prints", false},
    };
    memcpy(o, options, sizeof options);
}

void nm_target_options(struct nm_settings *s, struct hs_option *o)
{
    const struct hs_option gain = {
        "kernel-gain",
        HS_REAL,
        &s->kernel_gain,
        0,
        1e9,
        "K",
        "amplitude of a cell that returns everything; 0: the root of its radar cross section in\n"
        "m^2, as calibrated MSTAR chips have it",
        false};
    nm_view_options(s, o);
    nm_law_options(s, o + NM_VIEW_OPTIONS);
    o[NM_VIEW_OPTIONS + NM_LAW_OPTIONS] = gain;
}

void nm_chip_options(struct nm_settings *s, struct hs_option *o)
{
    const struct hs_option options[NM_CHIP_OPTIONS] = {
        {"chips", HS_INPUT, &s->chips, 0, 0, "FOLDER|LIST",
         "raw MSTAR, CSV, PNG, JPEG or TIFF files: a folder of them, or a list of lines\n"
         "FILE [AZIMUTH DEPRESSION [SHIFT_X SHIFT_Y [GAIN [training|validation]]]]",
         true},
        {"gain", HS_REAL, &s->gain, 0, 1e12, "K",
         "calibrates amplitudes, where a list does not; 0: each chip by its clutter", false},
        {"clutter", HS_REAL, &s->calibration.clutter, 1e-6, 1, "A",
         "mean amplitude of the ground about the target in a calibrated chip", false},
        {"normalised", HS_FLAG, &s->calibration.is_normalised, 0, 0, NULL,
         "the chips have been through tanh already, (12)", false},
        {"near-on-top", HS_FLAG, &s->calibration.is_near_on_top, 0, 0, NULL,
         "the uppermost row is nearest to the radar; in MSTAR the lowest is", false},
        {"azimuth-left", HS_FLAG, &s->calibration.is_counted_left, 0, 0, NULL,
         "the collection counts azimuths to the left; here the radar goes round to the right",
         false},
        {"azimuth-turn", HS_REAL, &s->calibration.turn_deg, -360, 360, "DEG",
         "is added to the collection's azimuths; here 0 is before the nose", false},
        {"share", HS_REAL, &s->share, 0, 1, "P",
         "of the chips for training, where a list does not say; the others validate", false},
    };
    memcpy(o, options, sizeof options);
}

void nm_train_options(struct nm_settings *s, struct hs_option *o)
{
    const struct hs_option options[NM_TRAIN_OPTIONS] = {
        {"architecture", HS_WORD, &s->architecture, 0, 0,
         "EP1|EP2|EP3|EP4|EP5|EP6|EP7|EP8|EP9|EP10|EP11|EP12",
         "Tables III and IV; EP8: a network for each direction, 16-32-64-32-32-1; EP9: likewise,\n"
         "fed with an input for each material and with the distance from a mirror's angle; EP10: "
         "the\n"
         "same with the material's permittivity and roughness, for materials between those "
         "learned;\n"
         "EP11: EP9 for up to 128 materials instead of 32; EP12: EP11, told from which side it is "
         "seen",
         false},
        {"connection", HS_WORD, &s->connection, 0, 0, NM_CONNECTION_WORDS,
         "of one reflection's network with the next: coefficient: Fig. 11; intensity: Fig. 10, "
         "what\n"
         "a network gives is one of the next one's inputs",
         false},
        {"loss", HS_WORD, &s->loss, 0, 0, "mse|mae", "mse: (14); mae: (13)", false},
        {"method", HS_WORD, &s->method, 0, 0, "adam|sgd", "of descent", false},
        {"rate", HS_REAL, &s->rate, 1e-9, 1e3, "R", "of the reflection networks", false},
        {"pix-rate", HS_REAL, &s->pix_rate, 1e-9, 1e3, "R", "of the pixels' kernels", false},
        {"momentum", HS_REAL, &s->momentum, 0, 0.999, "M", "of sgd", false},
        {"batch", HS_INTEGER, &s->batch, 1, 4096, "N", "chips between two changes", false},
        {"pretrain", HS_INTEGER, &s->pretrain, 0, 1000, "N",
         "epochs on the simulator's own picture", false},
        {"epochs", HS_INTEGER, &s->epochs, 0, 3000, "N",
         "on real chips, with the fixed impulse response", false},
        {"pix-epochs", HS_INTEGER, &s->pix_epochs, 0, 3000, "N",
         "of the trainable kernels at the end, the reflection networks frozen", false},
        {"average", HS_REAL, &s->average, 0, 1, "P",
         "of the epochs on real chips, the last ones, and of the kernels' epochs: each phase ends "
         "on\n"
         "the mean of the values after each change in them; 0: on the last values",
         false},
        {"reach", HS_INTEGER, &s->reach_px, 0, 64, "PX",
         "how far registration looks from the expected place; 0: no registration", false},
        {"seed", HS_INTEGER, &s->seed, 0, 1e15, "N", "of everything drawn by lot", false},
    };
    memcpy(o, options, sizeof options);
}

static int choose(const char *option, const char *word, const char *first, const char *second,
                  int *choice)
{
    *choice = strcmp(word, second) == 0;
    return *choice || strcmp(word, first) == 0
               ? 0
               : hs_error(option, NULL, "must be %s or %s, not %s", first, second, word);
}

int nm_settings_plan(const struct nm_settings *s, struct nm_plan *plan,
                     const struct nm_architecture **architecture)
{
    int loss, method;
    *architecture = nm_architecture_find(s->architecture, nm_settings_connection(s));
    if (!*architecture) {
        return hs_error("--architecture", "give EP1 to EP12", "there is no %s", s->architecture);
    }
    if (choose("--loss", s->loss, "mse", "mae", &loss) != 0 ||
        choose("--method", s->method, "adam", "sgd", &method) != 0) {
        return -1;
    }
    *plan = (struct nm_plan){
        .loss = (enum nm_loss_kind)loss,
        .method = (enum nm_method)method,
        .rate = s->rate,
        .pix_rate = s->pix_rate,
        .momentum = s->momentum,
        .average = s->average,
        .batch = (int)s->batch,
        .epochs = {(int)s->pretrain, (int)s->epochs, (int)s->pix_epochs},
        .reach_px = (int)s->reach_px,
        .seed = (uint64_t)s->seed,
    };
    return 0;
}

/* The table of options lets no other words pass. */
enum nm_connection nm_settings_connection(const struct nm_settings *s)
{
    return strcmp(s->connection, nm_connection_names[NM_BY_INTENSITY]) == 0 ? NM_BY_INTENSITY
                                                                            : NM_BY_COEFFICIENT;
}

struct nm_calibration nm_settings_calibration(const struct nm_settings *s)
{
    struct nm_calibration c = s->calibration;
    c.gain = s->gain > 0 ? s->gain : NAN;
    return c;
}

void nm_settings_kernel(const struct nm_settings *s, double *kernel)
{
    const double gain = s->kernel_gain > 0 ? s->kernel_gain
                                           : nm_kernel_gain(s->setup.cell_m, s->setup.wavelength_m);
    nm_kernel_make(s->setup.resolution_m, s->setup.cell_m, gain, kernel);
}

double nm_settings_lowest(const struct nm_settings *s, const struct nm_chip_list *list)
{
    double lowest = s->setup.depression_deg;
    for (int i = 0; i < list->count; i++) {
        lowest = fmin(lowest, list->entries[i].depression_deg);
    }
    return lowest;
}
