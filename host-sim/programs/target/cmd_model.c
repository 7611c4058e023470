#include "commands.h"
#include "view.h"

#include "hs/error.h"
#include "hs/png.h"
#include "hs/report.h"
#include "tracer/mesh_audit.h"
#include "tracer/model_file.h"
#include "tracer/models.h"
#include "tracer/setup.h"

#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "model", "check a model, describe it, draw it, write it as OBJ",
    "Built-in models:\n"
    "  slicy      Sandia's test target of boxes, cylinders, dihedral and trihedral\n"
    "  tank       a tank of a T-72's dimensions, of boxes, cylinders and plates\n"
    "  plate, dihedral, trihedral, tophat   single reflectors, about a metre in size\n"
    "Metres; x points ahead (the nose), y to the left, z up; the ground is z = 0."};

static void report_corner(const char *key, struct vec corner)
{
    hs_report_object(key);
    hs_report_put("ahead_m", corner.x);
    hs_report_put("left_m", corner.y);
    hs_report_put("up_m", corner.z);
    hs_report_close();
}

static void report(const struct mesh *m, const struct mesh_audit *audit, struct vec low,
                   struct vec high)
{
    hs_report_put("triangles", m->triangle_count);
    hs_report_put("parts", audit->part_count);
    hs_report_put("materials", m->material_count);
    report_corner("least", low);
    report_corner("greatest", high);
    hs_report_put("open_edges", audit->open_edges);
    hs_report_put("turned_edges", audit->turned_edges);
    hs_report_put("inside_out_parts", audit->inside_out);
    hs_report_put("triangles_without_area", audit->degenerate);
}

static int describe(const struct setup *s, const struct mesh *m)
{
    struct vec low, high;
    struct mesh_audit audit;
    if (mesh_audit(m, s->model, &audit) != 0) {
        return -1;
    }
    mesh_bounds(m, &low, &high);
    printf("%u triangles in %u parts, %u materials\n", m->triangle_count, audit.part_count,
           m->material_count);
    printf("ahead %.3f to %.3f m, left %.3f to %.3f m, up %.3f to %.3f m\n", low.x, high.x, low.y,
           high.y, low.z, high.z);
    printf(
        "%u open edges, %u edges whose sides disagree, %u parts inside out, %u triangles "
        "without area\n",
        audit.open_edges, audit.turned_edges, audit.inside_out, audit.degenerate);
    report(m, &audit, low, high);
    return 0;
}

static int draw(const struct setup *s, const struct mesh *m, double azimuth_deg, int size_px,
                const char *path)
{
    struct scene scene;
    struct vec low, high;
    mesh_bounds(m, &low, &high);
    const double span_m = 2.1 * fmax(vec_length(low), vec_length(high));
    uint32_t *pixels = malloc((size_t)size_px * (size_t)size_px * sizeof *pixels);
    if (!pixels || scene_open(&scene, m, span_m, s->model) != 0) {
        free(pixels);
        return pixels ? -1 : hs_error(path, "give a smaller --size", "out of memory");
    }
    const struct view view = {azimuth_deg, s->depression_deg, span_m};
    view_draw(&scene, &view, pixels, size_px, size_px);
    const int result = hs_png_write_xrgb(path, pixels, size_px, size_px, (size_t)size_px);
    free(pixels);
    scene_close(&scene);
    return result;
}

int target_cmd_model(int argc, char **argv)
{
    struct setup s = setup_default();
    const char *view = NULL, *obj = NULL;
    long size_px = 480;
    s.depression_deg = 30;
    s.azimuth_deg = 30;
    struct hs_option options[SETUP_MODEL_OPTIONS + 8] = {
        {"obj", HS_OUTPUT, &obj, 0, 0, "FILE.obj", "write the model, with z up", false},
        {"view", HS_OUTPUT, &view, 0, 0, "FILE.png", "draw the model", false},
        {"azimuth", HS_REAL, &s.azimuth_deg, -360, 360, "DEG",
         "of the eye, from the model's nose towards its right", false},
        {"depression", HS_REAL, &s.depression_deg, 1, 90, "DEG", "of the eye's sight", false},
        {"size", HS_INTEGER, &size_px, 16, 4096, "PIXELS", "of the picture", false},
        HS_NEEDS_ROW("azimuth", "view"),
        HS_NEEDS_ROW("depression", "view"),
        HS_NEEDS_ROW("size", "view"),
    };
    int exit_code;
    setup_model_options(&s, options + 8);
    if (!hs_options_read(&usage, options, SETUP_MODEL_OPTIONS + 8, argc, argv, &exit_code)) {
        return exit_code;
    }
    struct mesh m;
    if (setup_load(&s, &m) != 0) {
        return HS_EXIT_FAILED;
    }
    int result = describe(&s, &m);
    if (result == 0 && obj) {
        result = model_file_write(&m, obj);
    }
    if (result == 0 && view) {
        result = draw(&s, &m, s.azimuth_deg, (int)size_px, view);
    }
    mesh_free(&m);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
