#include "chip_picture.h"
#include "commands.h"
#include "complex_file.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/png.h"
#include "hs/report.h"
#include "tracer/ends.h"
#include "tracer/setup.h"
#include "tracer/squint.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "render", "make the radar picture of a model, or of traced records",
    "Give --model, or --records of `landmass-target trace`, and --out or --csv, or both.\n"
    "In the PNG the radar looks from below upwards: near range is the lowest row, and what\n"
    "the radar has to its right is on the right. The CSV has amplitudes, square roots of\n"
    "power, in the same order.\n"
    "With --coherent fields are added with their phase, each with the side lobes of the\n"
    "radar: a pixel is the root of a cross section in m^2. Speckle is then the sum over\n"
    "rough places, one for each ray. --complex writes it, in the order of the PNG."};

/* With these a picture has no place on earth, and no squint of one flight. */
#define ENDS "distance|receiver-azimuth|receiver-depression|receiver-distance"

struct outputs {
    const char *png, *csv, *complex_file;
    int zoom;
    int tone; /* enum chip_tone_kind */
    double cut_db;
    long levels;
    bool is_coherent, is_raw, has_edges;
    int weighting;            /* enum focus_weighting */
    struct complex_site site; /* latitude NAN: none */
    double squint_deg;
    long layer; /* the only reflection whose echoes count, from 1; 0: all do */
};

static int write_csv(const char *path, const float *power, int width, int height)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    for (int row = height - 1; row >= 0; row--) {
        for (int column = 0; column < width; column++) {
            fprintf(file.stream, "%s%.6g", column > 0 ? "," : "",
                    sqrt((double)power[row * width + column]));
        }
        fputc('\n', file.stream);
    }
    return hs_atomic_commit(&file);
}

static int write_png(const struct setup *s, const struct outputs *o, const float *power, int width,
                     int height)
{
    const int wide = width * o->zoom, high = height * o->zoom;
    uint32_t *pixels = malloc((size_t)wide * (size_t)high * sizeof *pixels);
    if (!pixels) {
        return hs_error(o->png, "give a smaller --zoom", "out of memory");
    }
    const enum chip_tone_kind kind = (enum chip_tone_kind)o->tone;
    const struct chip_tone tone = {kind, chip_peak(power, width * height),
                                   kind == CHIP_CUT ? o->cut_db : s->range_db, (int)o->levels};
    chip_draw(power, width, height, &tone, o->zoom, pixels, wide);
    const int result = hs_png_write_xrgb(o->png, pixels, wide, high, (size_t)wide);
    free(pixels);
    return result;
}

/* Power of a complex chip, which is written when that is asked for. */
static float *coherent_power(const struct setup *s, const struct trace_records *r,
                             const struct edge_echoes *edges, const struct outputs *o, int *width,
                             int *height)
{
    const enum focus_weighting weighting = (enum focus_weighting)o->weighting;
    float complex *chip = setup_complex_chip(s, r, weighting, edges, width, height);
    if (!chip) {
        return NULL;
    }
    const int pixels = *width * *height;
    float *power = calloc((size_t)pixels, sizeof *power);
    if (!power) {
        hs_error("picture", "give fewer --cells", "out of memory");
    }
    for (int i = 0; power && i < pixels; i++) {
        power[i] = crealf(chip[i]) * crealf(chip[i]) + cimagf(chip[i]) * cimagf(chip[i]);
    }
    if (power && o->complex_file &&
        complex_file_write(s, r, weighting, isnan(o->site.latitude_deg) ? NULL : &o->site,
                           o->complex_file, chip) != 0) {
        free(power);
        power = NULL;
    }
    free(chip);
    return power;
}

static float *chip_power(const struct setup *s, const struct trace_records *r,
                         const struct edge_echoes *edges, const struct outputs *o, int *width,
                         int *height)
{
    if (o->is_coherent) {
        return coherent_power(s, r, edges, o, width, height);
    }
    return o->is_raw ? setup_cells(s, r, width, height) : setup_chip(s, r, width, height);
}

static int render(const struct setup *s, const struct trace_records *r,
                  const struct edge_echoes *edges, const struct outputs *o)
{
    int width, height;
    float *power = chip_power(s, r, edges, o, &width, &height);
    if (!power) {
        return -1;
    }
    hs_report_integer("width_px", width);
    hs_report_integer("height_px", height);
    if (o->is_coherent) {
        const double peak_dbsm = 10 * log10((double)chip_peak(power, width * height));
        printf("brightest pixel: %.2f dBsm\n", peak_dbsm);
        hs_report_real("peak_dbsm", peak_dbsm);
    }
    int result = o->csv ? write_csv(o->csv, power, width, height) : 0;
    if (result == 0 && o->png) {
        result = write_png(s, o, power, width, height);
    }
    free(power);
    return result;
}

/* Leave the echoes of one reflection; what goes on from the others stays. */
static int keep_layer(struct trace_records *r, long layer)
{
    if (layer > r->bounce_count) {
        return hs_error("--layer", "give at most the number of --bounces",
                        "reflection %ld was not traced", layer);
    }
    for (uint32_t b = 0; layer > 0 && b < r->bounce_count; b++) {
        for (uint32_t i = 0; b + 1 != layer && i < r->bounces[b].count; i++) {
            r->bounces[b].records[i].flags |= TRACE_BLOCKED;
        }
    }
    return 0;
}

/* The echoes of the model's edges, in pieces of half a cell. */
static int find_edges(const struct setup *s, const struct mesh *m, const struct scene *scene,
                      const struct trace_records *r, struct edge_echoes *edges)
{
    struct reflect_law law;
    return setup_law(s, r, &law) == 0 ? edges_make(edges, m, scene, &r->look, &law, s->cell_m / 2)
                                      : -1;
}

static int trace_model(const struct setup *s, const struct outputs *o, struct trace_records *r,
                       struct edge_echoes *edges)
{
    struct mesh m;
    struct scene scene;
    if (setup_load(s, &m) != 0) {
        return -1;
    }
    int result = setup_scene_of(s, &m, &scene);
    if (result == 0) {
        const struct trace_order order = setup_order(s, s->azimuth_deg);
        result = trace_run(&scene, &order, s->model, r, NULL);
        if (result == 0 && o->has_edges && o->layer <= 1 &&
            find_edges(s, &m, &scene, r, edges) != 0) {
            trace_records_free(r);
            result = -1;
        }
        scene_close(&scene);
    }
    mesh_free(&m);
    return result;
}

static int check_ends(const struct setup *s, const struct trace_records *r, const struct outputs *o,
                      const char *records)
{
    const bool needs_plain = o->squint_deg != 0 || !isnan(o->site.latitude_deg) || s->channel != 0;
    return !needs_plain || ends_are_plain(&r->ends)
               ? 0
               : hs_error(
                     records, "trace the target again without them",
                     "was traced with --distance or a receiver apart: --squint, --latitude and "
                     "--polarisation are of one radar far away");
}

static int run(const struct setup *s, const char *records, const struct outputs *o)
{
    struct trace_records r;
    struct edge_echoes edges = {0};
    const int loaded = records ? trace_records_read(&r, records) : trace_model(s, o, &r, &edges);
    if (loaded != 0) {
        return HS_EXIT_FAILED;
    }
    int result = check_ends(s, &r, o, records);
    if (result == 0 && o->squint_deg != 0) {
        squint_records(&r, o->squint_deg);
    }
    result = result == 0 && keep_layer(&r, o->layer) == 0 ? render(s, &r, &edges, o) : -1;
    edges_free(&edges);
    trace_records_free(&r);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

static int check_outputs(const struct setup *s, const char *records, const struct outputs *o)
{
    if (!records == !s->model || (!o->png && !o->csv && !o->complex_file)) {
        hs_error("render", "see landmass-target render --help",
                 "needs one of --model and --records, and --out, --csv or --complex");
        return -1;
    }
    return 0;
}

int target_cmd_render(int argc, char **argv)
{
    struct setup s = setup_default();
    struct outputs o = {
        .zoom = 6, .weighting = FOCUS_TAYLOR, .cut_db = 20, .levels = 256, .site = {NAN, NAN, 0}};
    const char *records = NULL;
    long zoom = 6;
    enum { OWN = 55, COUNT = OWN + SETUP_OPTIONS + SETUP_ENDS_OPTIONS };
    struct hs_option options[COUNT] = {
        {"records", HS_INPUT, &records, 0, 0, "FILE.trace", "in place of a model", false},
        {"out", HS_OUTPUT, &o.png, 0, 0, "FILE.png", "the picture", false},
        {"csv", HS_OUTPUT, &o.csv, 0, 0, "FILE.csv", "the amplitudes", false},
        {"complex", HS_OUTPUT, &o.complex_file, 0, 0, "FILE.tif|FILE.ntf",
         "the fields, as GeoTIFF or NITF", false},
        {"coherent", HS_FLAG, &o.is_coherent, 0, 0, NULL, "add fields instead of power", false},
        {"edges", HS_FLAG, &o.has_edges, 0, 0, NULL,
         "add what the model's edges diffract, by Ufimtsev's physical theory", false},
        HS_NEEDS_ROW("edges", "coherent"),
        HS_NEEDS_ROW("edges", "model"),
        HS_CLASHES_ROW("edges", ENDS "|squint"),
        {"weighting", HS_CHOICE, &o.weighting, 0, 0, FOCUS_WEIGHTING_WORDS,
         "of the radar's band, with --coherent", false},
        {"polarisation", HS_CHOICE, &s.channel, 0, 0, REFLECT_CHANNEL_WORDS,
         "received and sent: hv receives H of what was sent in V. The electric vector is followed\n"
         "through all reflections; --law is raysar, fresnel or spm then. law: each reflection is\n"
         "as the law's name says",
         false},
        HS_NEEDS_ROW("polarisation", "coherent"),
        HS_CLASHES_ROW("polarisation", ENDS),
        HS_CLASHES_ROW("polarisation", "law=fresnel-hh|law=fresnel-vv|law=spm-hh|law=spm-vv"),
        {"layer", HS_INTEGER, &o.layer, 0, TRACE_BOUNCES_MAX, "N",
         "echoes of the Nth reflection alone; 0: of all", false},
        {"zoom", HS_INTEGER, &zoom, 1, 64, "N", "dots of the PNG a pixel, either way", false},
        {"raw", HS_FLAG, &o.is_raw, 0, 0, NULL,
         "the cells before the radar's response, pixels and speckle (Niu and others, Figure 26)",
         false},
        {"tone", HS_CHOICE, &o.tone, 0, 0, CHIP_TONE_WORDS,
         "grey by dB, or by the amplitude: white at the peak, or cut off below it", false},
        {"cut-db", HS_REAL, &o.cut_db, 0, 100, "DB", "how far below the peak that is", false},
        {"levels", HS_INTEGER, &o.levels, 2, 256, "N", "of grey in the PNG", false},
        {"squint", HS_REAL, &o.squint_deg, -60, 60, "DEG",
         "of a radar that flies level, the target on its left; positive: the target is ahead",
         false},
        {"latitude", HS_REAL, &o.site.latitude_deg, -89, 89, "DEG",
         "of the target, of WGS84: puts --complex FILE.tif in its place on earth, and makes\n"
         "FILE.ntf a SICD",
         false},
        {"longitude", HS_REAL, &o.site.longitude_deg, -180, 180, "DEG", "likewise", false},
        {"heading", HS_REAL, &o.site.heading_deg, -360, 360, "DEG",
         "of the target's nose, clockwise from north", false},
        HS_NEEDS_ROW("latitude", "complex"),
        HS_NEEDS_ROW("latitude", "longitude"),
        HS_NEEDS_ROW("longitude", "latitude"),
        HS_NEEDS_ROW("heading", "latitude"),
        HS_CLASHES_ROW("squint", ENDS "|latitude"),
        HS_CLASHES_ROW("latitude", ENDS),
        HS_CLASHES_ROW("raw", "coherent|looks|resolution|pixel"),
        HS_NEEDS_ROW("tone", "out"),
        HS_NEEDS_ROW("cut-db", "tone=cut"),
        HS_NEEDS_ROW("levels", "out"),
        {"azimuth", HS_REAL, &s.azimuth_deg, -360, 360, "DEG",
         "of the radar, from the model's nose towards its right", false},
        HS_NEEDS_ROW("complex", "coherent"),
        HS_NEEDS_ROW("weighting", "coherent"),
        HS_CLASHES_ROW("coherent", "looks"),
        HS_NEEDS_ROW("zoom", "out"),
        HS_NEEDS_ROW("range-db", "out"),
        HS_NEEDS_ROW("azimuth", "model"),
        HS_NEEDS_ROW("up", "model"),
        HS_NEEDS_ROW("scale", "model"),
        HS_NEEDS_ROW("turn", "model"),
        HS_NEEDS_ROW("as-is", "model"),
        HS_NEEDS_ROW("depression", "model"),
        HS_NEEDS_ROW("distance", "model"),
        HS_NEEDS_ROW("receiver-azimuth", "model"),
        HS_NEEDS_ROW("receiver-depression", "model"),
        HS_NEEDS_ROW("receiver-distance", "model"),
        HS_NEEDS_ROW("cell", "model"),
        HS_NEEDS_ROW("cells", "model"),
        HS_NEEDS_ROW("no-ground", "model"),
        HS_NEEDS_ROW("rays", "model"),
        HS_NEEDS_ROW("bounces", "model"),
    };
    int exit_code;
    setup_options(&s, options + OWN);
    setup_ends_options(&s, options + OWN + SETUP_OPTIONS);
    options[OWN].is_required = false; /* the model: there may be records instead */
    options[OWN + SETUP_MODEL_OPTIONS + SETUP_TRACE_OPTIONS].value_name =
        REFLECT_KIND_WORDS "|fresnel|spm";
    if (!hs_options_read(&usage, options, COUNT, argc, argv, &exit_code)) {
        return exit_code;
    }
    if (check_outputs(&s, records, &o) != 0) {
        return HS_EXIT_USAGE;
    }
    o.zoom = (int)zoom;
    return run(&s, records, &o);
}
