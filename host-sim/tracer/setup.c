#include "tracer/setup.h"

#include "hs/error.h"
#include "tracer/accumulate.h"
#include "tracer/ends.h"
#include "tracer/materials.h"
#include "tracer/mesh_audit.h"
#include "tracer/model_file.h"
#include "tracer/models.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct setup setup_default(void)
{
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    return (struct setup){
        .scale = 1,
        .depression_deg = 15,
        .wavelength_m = TRACE_WAVELENGTH_M,
        .receiver_azimuth_deg = NAN,
        .receiver_depression_deg = NAN,
        .receiver_distance_m = NAN,
        .cell_m = TRACE_CHIP_CELL_M,
        .cells = TRACE_CHIP_CELLS,
        .rays_per_cell = 2,
        .bounces = TRACE_BOUNCES_MAX,
        .threads = processors >= 1 && processors <= 64 ? processors : 1,
        .law = reflect_kind_names[REFLECT_RAYSAR],
        .resolution_m = 0.3,
        .range_db = 50,
        .ratio = 2,
        .looks = 0,
        .seed = 1,
    };
}

void setup_model_options(struct setup *s, struct hs_option *o)
{
    const struct hs_option options[SETUP_MODEL_OPTIONS] = {
        {"model", HS_INPUT, &s->model, 0, 0, "NAME|FILE",
         "a built-in model (see `landmass-target model --help`) or a file: OBJ, glTF, STL, PLY, "
         "Collada, OpenFlight",
         true},
        {"up", HS_WORD, &s->up, 0, 0, "y|z",
         "which axis of FILE points up, where its format does not say it; default y, and x ahead "
         "in either case",
         false},
        {"scale", HS_REAL, &s->scale, 1e-4, 1e4, "K", "metres for a unit of FILE", false},
        {"turn", HS_REAL, &s->turn_deg, -360, 360, "DEG",
         "turn FILE to the left, so that its nose points along x", false},
        {"as-is", HS_FLAG, &s->is_as_is, 0, 0, NULL,
         "take a model that is open, turned or degenerate: triangles without area are\n"
         "dropped, and both sides of all others reflect",
         false},
    };
    memcpy(o, options, sizeof options);
}

void setup_ray_options(struct setup *s, struct hs_option *o)
{
    const struct hs_option options[SETUP_RAY_OPTIONS] = {
        {"wavelength", HS_REAL, &s->wavelength_m, 0.001, 10, "M", "of the radar", false},
        {"rays", HS_INTEGER, &s->rays_per_cell, 1, 16, "N",
         "N x N of them meet a cell of level "
         "ground",
         false},
        {"bounces", HS_INTEGER, &s->bounces, 1, TRACE_BOUNCES_MAX, "N", "reflections followed",
         false},
        {"threads", HS_INTEGER, &s->threads, 1, 64, "N", "the result does not depend on it", false},
    };
    memcpy(o, options, sizeof options);
}

void setup_trace_options(struct setup *s, struct hs_option *o)
{
    const struct hs_option options[SETUP_TRACE_OPTIONS - SETUP_RAY_OPTIONS] = {
        {"depression", HS_REAL, &s->depression_deg, 1, 89, "DEG",
         "of the line of sight below the horizon", false},
        {"cell", HS_REAL, &s->cell_m, 0.001, 1000, "M",
         "side of the cells, slant range and across, in which echoes are added up", false},
        {"cells", HS_INTEGER, &s->cells, 2, TRACE_CELLS_MAX, "N", "of the picture, either way",
         false},
        {"no-ground", HS_FLAG, &s->has_no_ground, 0, 0, NULL, "the model floats in empty space",
         false},
    };
    memcpy(o, options, sizeof options);
    setup_ray_options(s, o + SETUP_TRACE_OPTIONS - SETUP_RAY_OPTIONS);
}

void setup_ends_options(struct setup *s, struct hs_option *o)
{
    const struct hs_option options[SETUP_ENDS_OPTIONS] = {
        {"distance", HS_REAL, &s->distance_m, 0, 1e7, "M",
         "of the radar, or of the transmitter, from the scene's centre; 0: so far away that its\n"
         "waves are plane",
         false},
        {"receiver-azimuth", HS_REAL, &s->receiver_azimuth_deg, -360, 360, "DEG",
         "of a receiver apart from the transmitter, which then has --azimuth", false},
        {"receiver-depression", HS_REAL, &s->receiver_depression_deg, 1, 89, "DEG",
         "likewise; default: the transmitter's", false},
        {"receiver-distance", HS_REAL, &s->receiver_distance_m, 0, 1e7, "M", "likewise", false},
    };
    memcpy(o, options, sizeof options);
}

void setup_law_options(struct setup *s, struct hs_option *o)
{
    const struct hs_option options[SETUP_LAW_OPTIONS] = {
        {"law", HS_WORD, &s->law, 0, 0, REFLECT_KIND_WORDS, "of reflection", false},
        {"materials", HS_INPUT, &s->materials, 0, 0, "FILE",
         "surfaces by name, in the form that `landmass-target materials` prints", false},
        {"ground", HS_TEXT, &s->ground, 0, 0, "MATERIAL",
         "what the level ground is: soil, grass, snow, concrete ... ; default `ground`", false},
    };
    memcpy(o, options, sizeof options);
}

void setup_chip_options(struct setup *s, struct hs_option *o)
{
    const struct hs_option options[SETUP_CHIP_OPTIONS - SETUP_LAW_OPTIONS] = {
        {"resolution", HS_REAL, &s->resolution_m, 0.001, 1000, "M",
         "of the radar, between -3 dB points", false},
        {"pixel", HS_INTEGER, &s->ratio, 1, 16, "N", "cells a pixel, either way", false},
        {"looks", HS_INTEGER, &s->looks, 0, PIX_LOOKS_MAX, "N", "of the speckle; 0: none", false},
        {"seed", HS_INTEGER, &s->seed, 0, 1e15, "N", "of the speckle", false},
        {"range-db", HS_REAL, &s->range_db, 1, 200, "DB", "from the brightest pixel to black",
         false},
    };
    setup_law_options(s, o);
    memcpy(o + SETUP_LAW_OPTIONS, options, sizeof options);
}

void setup_options(struct setup *s, struct hs_option *o)
{
    setup_model_options(s, o);
    setup_trace_options(s, o + SETUP_MODEL_OPTIONS);
    setup_chip_options(s, o + SETUP_MODEL_OPTIONS + SETUP_TRACE_OPTIONS);
}

/* Closed bodies only, unless the user or the built-in model says otherwise. */
static int check_model(const struct setup *s, const struct model_kind *kind, struct mesh *m)
{
    struct mesh_audit audit;
    if (kind) {
        return m->is_full ? hs_error(s->model, NULL, "out of memory") : 0;
    }
    if (s->is_as_is) {
        mesh_drop_degenerate(m);
        return m->triangle_count > 0
                   ? 0
                   : hs_error(s->model, "export the model again", "no triangle has any area");
    }
    return mesh_audit(m, s->model, &audit) == 0 ? mesh_require_closed(&audit, s->model) : -1;
}

int setup_load(const struct setup *s, struct mesh *m)
{
    const struct model_kind *kind = model_find(s->model);
    *m = (struct mesh){0};
    if (s->up && strcmp(s->up, "y") != 0 && strcmp(s->up, "z") != 0) {
        return hs_error("--up", NULL, "must be y or z, not %s", s->up);
    }
    if (kind) {
        kind->build(m);
    } else if (model_file_read(m, s->model, s->up) != 0) {
        return -1;
    }
    if (check_model(s, kind, m) != 0) {
        mesh_free(m);
        return -1;
    }
    mesh_place(m, s->scale, s->turn_deg, (struct vec){0, 0, 0});
    if (!kind) {
        model_file_doubt_size(m, s->model);
    }
    const struct mesh_zones zones = {(int)s->zones, SETUP_ZONES_ASIDE, SETUP_ZONES_HIGH,
                                     s->has_sides};
    if (s->zones > 0 && mesh_zone(m, &zones, s->model) != 0) {
        mesh_free(m);
        return -1;
    }
    return 0;
}

static double whole_turn_deg(double azimuth_deg)
{
    const double turn_deg = fmod(azimuth_deg, 360);
    return turn_deg < 0 ? turn_deg + 360 : turn_deg;
}

static double given_or(double given, double otherwise)
{
    return isnan(given) ? otherwise : given;
}

/* What is not said of a receiver is as of the transmitter. */
static struct trace_ends ends_of_setup(const struct setup *s, double azimuth_deg)
{
    if (isnan(s->receiver_azimuth_deg) && isnan(s->receiver_depression_deg) &&
        isnan(s->receiver_distance_m)) {
        return (struct trace_ends){.distance_m = s->distance_m};
    }
    return (struct trace_ends){
        .distance_m = s->distance_m,
        .is_apart = true,
        .receiver_azimuth_deg = whole_turn_deg(given_or(s->receiver_azimuth_deg, azimuth_deg)),
        .receiver_depression_deg = given_or(s->receiver_depression_deg, s->depression_deg),
        .receiver_distance_m = given_or(s->receiver_distance_m, s->distance_m),
    };
}

struct trace_order setup_order(const struct setup *s, double azimuth_deg)
{
    return (struct trace_order){
        .look = {whole_turn_deg(azimuth_deg), s->depression_deg, s->wavelength_m},
        .grid = {(uint32_t)s->cells, (uint32_t)s->cells, s->cell_m},
        .rays_per_cell = (uint32_t)s->rays_per_cell,
        .bounces = (uint32_t)s->bounces,
        .threads = (uint32_t)s->threads,
        .ends = ends_of_setup(s, azimuth_deg),
    };
}

/* How far the model goes from where it stands, level. */
static double reach_m(const struct mesh *m)
{
    double reach = 0;
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        reach = fmax(reach, hypot(m->vertices[i].x, m->vertices[i].y));
    }
    return reach;
}

/* What the picture would not show, or only in part, is said with its sizes. */
static void doubt_place(const struct setup *s, const struct mesh *m)
{
    const double half_m = (double)s->cells * s->cell_m / 2;
    struct vec low, high;
    mesh_bounds(m, &low, &high);
    if (!s->has_no_ground && low.z < -0.01) {
        hs_warn(s->model, "move it up, or give --no-ground",
                "reaches %.3g m below the ground, which hides that part of its %.3g m", -low.z,
                high.z - low.z);
    }
    if (reach_m(m) > half_m) {
        hs_warn(s->model, "give more --cells",
                "reaches %.3g m from its origin, and the picture %.3g m: parts may be cut off",
                reach_m(m), half_m);
    }
}

int setup_scene_of(const struct setup *s, const struct mesh *m, struct scene *scene)
{
    doubt_place(s, m);
    const struct trace_order order = setup_order(s, s->azimuth_deg);
    const double ground_half_m = s->has_no_ground ? 0 : ends_ground_half_m(&order);
    return scene_open(scene, m, ground_half_m, s->model);
}

int setup_scene(const struct setup *s, struct scene *scene)
{
    struct mesh m;
    if (setup_load(s, &m) != 0) {
        return -1;
    }
    const int result = setup_scene_of(s, &m, scene);
    mesh_free(&m);
    return result;
}

/* Laws that do not say of themselves which polarisation they are of. */
static const struct {
    const char *name;
    enum reflect_kind kind;
} followed_laws[] = {
    {"raysar", REFLECT_RAYSAR}, {"fresnel", REFLECT_FRESNEL_HH}, {"spm", REFLECT_SPM_HH}};

static int followed_law(const struct setup *s, struct reflect_law *law)
{
    for (size_t i = 0; i < sizeof followed_laws / sizeof followed_laws[0]; i++) {
        if (strcmp(s->law, followed_laws[i].name) == 0) {
            law->kind = followed_laws[i].kind;
            return 0;
        }
    }
    return hs_error("--law", "give raysar, fresnel or spm",
                    "with --polarisation there is no law %s", s->law);
}

static int plain_law(const struct setup *s, struct reflect_law *law)
{
    for (int kind = 0; kind < REFLECT_KINDS; kind++) {
        if (strcmp(s->law, reflect_kind_names[kind]) == 0) {
            law->kind = (enum reflect_kind)kind;
            return 0;
        }
    }
    return hs_error("--law", "give raysar, fresnel-hh, fresnel-vv, spm-hh or spm-vv",
                    "there is no law %s", s->law);
}

int setup_law(const struct setup *s, const struct trace_records *r, struct reflect_law *law)
{
    *law = (struct reflect_law){.channel = (enum reflect_channel)s->channel,
                                .wavelength_m = r->look.wavelength_m};
    const int found = law->channel == REFLECT_AS_LAW ? plain_law(s, law) : followed_law(s, law);
    return found == 0 ? materials_for(r, s->materials, s->ground, law) : -1;
}

/* Spread, coarsen and speckle the power of the cells in place. */
static int make_chip(const struct setup *s, const struct trace_grid *grid, float *power)
{
    const int width = (int)grid->cells_across, height = (int)grid->cells_range;
    const int ratio = (int)s->ratio;
    if (pix_spread(power, width, height, pix_aperture(s->resolution_m, grid->cell_m)) != 0) {
        return -1;
    }
    pix_coarsen(power, width, height, ratio, power);
    if (s->looks > 0) {
        struct hs_rng rng;
        hs_rng_seed(&rng, (uint64_t)s->seed);
        pix_speckle(power, width / ratio * (height / ratio), (int)s->looks, &rng);
    }
    return 0;
}

static int check_ratio(const struct setup *s, const struct trace_grid *grid)
{
    const uint32_t ratio = (uint32_t)s->ratio;
    return grid->cells_across % ratio == 0 && grid->cells_range % ratio == 0
               ? 0
               : hs_error("--pixel", "give a number that divides the cells",
                          "%u x %u cells make no whole number of pixels", grid->cells_across,
                          grid->cells_range);
}

static void find_size(const struct setup *s, const struct trace_grid *grid, int *width, int *height)
{
    *width = (int)(grid->cells_across / (uint32_t)s->ratio);
    *height = (int)(grid->cells_range / (uint32_t)s->ratio);
}

float *setup_cells(const struct setup *s, const struct trace_records *r, int *width, int *height)
{
    struct reflect_law law;
    const struct trace_grid *grid = &r->grid;
    if (setup_law(s, r, &law) != 0) {
        return NULL;
    }
    float *power = malloc((size_t)grid->cells_across * grid->cells_range * sizeof *power);
    if (!power) {
        hs_error("picture", "give fewer --cells", "out of memory");
        return NULL;
    }
    if (accumulate(r, &law, power) != 0) {
        free(power);
        return NULL;
    }
    *width = (int)grid->cells_across;
    *height = (int)grid->cells_range;
    return power;
}

float *setup_chip(const struct setup *s, const struct trace_records *r, int *width, int *height)
{
    if (pix_resolution_check(s->resolution_m, r->grid.cell_m) != 0 ||
        check_ratio(s, &r->grid) != 0) {
        return NULL;
    }
    float *power = setup_cells(s, r, width, height);
    if (power && make_chip(s, &r->grid, power) != 0) {
        free(power);
        return NULL;
    }
    find_size(s, &r->grid, width, height);
    return power;
}

float complex *setup_complex_chip(const struct setup *s, const struct trace_records *r,
                                  enum focus_weighting weighting, const struct edge_echoes *edges,
                                  int *width, int *height)
{
    struct reflect_law law;
    const struct focus_order order = {weighting, s->resolution_m, (uint32_t)s->ratio,
                                      (uint64_t)s->seed};
    if (check_ratio(s, &r->grid) != 0 || setup_law(s, r, &law) != 0) {
        return NULL;
    }
    find_size(s, &r->grid, width, height);
    return focus_chip_with(r, &law, &order, edges ? edges->echoes : NULL, edges ? edges->count : 0);
}
