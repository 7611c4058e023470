#include "commands.h"
#include "histogram_picture.h"
#include "table_picture.h"

#include "hs/error.h"
#include "hs/report.h"
#include "tracer/setup.h"

#include <stdio.h>

static const struct hs_usage usage = {
    "trace", "trace a model and keep every reflection",
    "Rays leave a plane square to the line of sight, or with --distance a point; each reflection "
    "is kept with its angles,\n"
    "material and the place where its echo is focused (docs/FORMATS.md, Traced records), for\n"
    "`landmass-target render` with any law of reflection, or to train a network on."};

struct outputs {
    const char *records, *picture, *histograms;
    long bounce; /* of the picture, from 1 */
};

static void report_histograms(const struct histogram h[HISTOGRAM_CHANNELS])
{
    hs_report_array("histograms");
    for (int i = 0; i < HISTOGRAM_CHANNELS; i++) {
        hs_report_object(NULL);
        hs_report_text("name", h[i].name);
        hs_report_real("low", h[i].low);
        hs_report_real("high", h[i].high);
        hs_report_count("beyond", h[i].beyond);
        hs_report_array("counts");
        for (int k = 0; k < HISTOGRAM_BINS; k++) {
            hs_report_count(NULL, h[i].counts[k]);
        }
        hs_report_close();
        hs_report_close();
    }
    hs_report_close();
}

static int write_histograms(const struct trace_records *r, const char *path)
{
    struct histogram h[HISTOGRAM_CHANNELS];
    histograms_of(r, h);
    report_histograms(h);
    return histogram_picture(h, path);
}

static int write_outputs(const struct trace_records *r, const struct outputs *o)
{
    if (trace_records_write(r, o->records) != 0) {
        return -1;
    }
    if (o->histograms && write_histograms(r, o->histograms) != 0) {
        return -1;
    }
    if (!o->picture) {
        return 0;
    }
    return o->bounce <= r->bounce_count
               ? table_picture(r, (uint32_t)o->bounce - 1, o->picture)
               : hs_error("--picture-of", "give at most the number of --bounces",
                          "reflection %ld was not traced", o->bounce);
}

static void report(const struct trace_records *r, uint64_t rays_cast)
{
    hs_report_put("columns", r->sensor.columns);
    hs_report_put("rows", r->sensor.rows);
    hs_report_put("primary_rays", (uint64_t)r->sensor.columns * r->sensor.rows);
    hs_report_put("rays", rays_cast);
    hs_report_array("reflections");
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        hs_report_put(NULL, r->bounces[b].count);
    }
    hs_report_close();
}

static int run(const struct setup *s, const struct outputs *outputs)
{
    struct scene scene;
    struct trace_records r;
    if (setup_scene(s, &scene) != 0) {
        return HS_EXIT_FAILED;
    }
    const struct trace_order order = setup_order(s, s->azimuth_deg);
    uint64_t rays_cast = 0;
    int result = trace_run(&scene, &order, s->model, &r, &rays_cast);
    scene_close(&scene);
    if (result == 0) {
        result = write_outputs(&r, outputs);
        printf("%u x %u primary rays, %llu rays in all; reflections by bounce:", r.sensor.columns,
               r.sensor.rows, (unsigned long long)rays_cast);
        for (uint32_t b = 0; b < r.bounce_count; b++) {
            printf(" %u", r.bounces[b].count);
        }
        putchar('\n');
        report(&r, rays_cast);
        trace_records_free(&r);
    }
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int target_cmd_trace(int argc, char **argv)
{
    struct setup s = setup_default();
    struct outputs outputs = {.bounce = 2};
    enum { OWN = 6, COUNT = OWN + SETUP_MODEL_OPTIONS + SETUP_TRACE_OPTIONS + SETUP_ENDS_OPTIONS };
    struct hs_option options[COUNT] = {
        {"out", HS_OUTPUT, &outputs.records, 0, 0, "FILE.trace", "the records", true},
        {"picture", HS_OUTPUT, &outputs.picture, 0, 0, "FILE.png",
         "what was recorded at one reflection, channel by channel, at the places where the\nrays "
         "were sent (Niu and others, Table I)",
         false},
        {"picture-of", HS_INTEGER, &outputs.bounce, 1, TRACE_BOUNCES_MAX, "N",
         "which reflection that is", false},
        HS_NEEDS_ROW("picture-of", "picture"),
        {"histograms", HS_OUTPUT, &outputs.histograms, 0, 0, "FILE.png",
         "how often each angle, phase and place was recorded (Niu and others, Figure 13)", false},
        {"azimuth", HS_REAL, &s.azimuth_deg, -360, 360, "DEG",
         "of the radar, from the model's nose towards its right", false},
    };
    int exit_code;
    setup_model_options(&s, options + OWN);
    setup_trace_options(&s, options + OWN + SETUP_MODEL_OPTIONS);
    setup_ends_options(&s, options + OWN + SETUP_MODEL_OPTIONS + SETUP_TRACE_OPTIONS);
    if (!hs_options_read(&usage, options, COUNT, argc, argv, &exit_code)) {
        return exit_code;
    }
    return run(&s, &outputs);
}
