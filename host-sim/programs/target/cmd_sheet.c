#include "chip_picture.h"
#include "commands.h"
#include "view.h"

#include "hs/chart.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "tracer/setup.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    "sheet", "draw a model and its radar picture side by side, over azimuth",
    "Each pair shows the model as an eye at the radar's azimuth sees it, 40 degrees down, and\n"
    "the radar picture at the depression given, both to the same scale. All radar pictures\n"
    "have the same white."};

enum { GAP = 6, CAPTION = 24 };

struct layout {
    int count, columns, side_px;
};

/* The radar pictures of all azimuths, one behind the other. */
struct strip {
    float *power;
    int width, height;
};

static int add_chip(const struct setup *s, const struct scene *scene, double azimuth_deg, int i,
                    int count, struct strip *strip)
{
    struct trace_records r;
    const struct trace_order order = setup_order(s, azimuth_deg);
    if (trace_run(scene, &order, s->model, &r, NULL) != 0) {
        return -1;
    }
    float *power = setup_chip(s, &r, &strip->width, &strip->height);
    trace_records_free(&r);
    if (!power) {
        return -1;
    }
    const size_t size = (size_t)strip->width * (size_t)strip->height;
    if (!strip->power) {
        strip->power = malloc(size * (size_t)count * sizeof *power);
    }
    if (strip->power) {
        memcpy(strip->power + size * (size_t)i, power, size * sizeof *power);
    }
    free(power);
    return strip->power ? 0 : hs_error("sheet", "draw fewer azimuths", "out of memory");
}

static double azimuth_of(const struct setup *s, const struct layout *l, int i)
{
    return s->azimuth_deg + 360.0 * i / l->count;
}

static void draw_pair(const struct setup *s, const struct scene *scene, const struct strip *strip,
                      const struct layout *l, int i, float white, struct sheet *sheet)
{
    const int zoom = l->side_px / strip->width, side = zoom * strip->width;
    const int x = GAP + i % l->columns * (2 * side + 3 * GAP);
    const int y = GAP + i / l->columns * (side + CAPTION + GAP);
    uint32_t *corner = sheet->pixels + y * sheet->width + x;
    const struct view view = {azimuth_of(s, l, i), 40, (double)s->cells * s->cell_m};
    const struct chip_tone tone = {CHIP_DB, white, s->range_db, 256};
    view_draw(scene, &view, corner, side, sheet->width);
    chip_draw(strip->power + (size_t)i * (size_t)(strip->width * strip->height), strip->width,
              strip->height, &tone, zoom, corner + side + GAP, sheet->width);
    char text[64];
    snprintf(text, sizeof text, "azimuth %g", fmod(azimuth_of(s, l, i), 360));
    sheet_text(sheet, x, y + side + 4, text, INK_BLACK);
}

static int draw_sheet(const struct setup *s, const struct scene *scene, const struct strip *strip,
                      const struct layout *l, const char *path)
{
    const int side = l->side_px / strip->width * strip->width;
    const int rows = (l->count + l->columns - 1) / l->columns;
    struct sheet sheet;
    if (sheet_open(&sheet, l->columns * (2 * side + 3 * GAP) + GAP,
                   rows * (side + CAPTION + GAP) + GAP) != 0) {
        return -1;
    }
    const float white = chip_peak(strip->power, strip->width * strip->height * l->count);
    for (int i = 0; i < l->count; i++) {
        draw_pair(s, scene, strip, l, i, white, &sheet);
    }
    return sheet_close(&sheet, path);
}

static int run(const struct setup *s, const struct layout *l, const char *path)
{
    struct scene scene;
    struct strip strip = {NULL, 0, 0};
    struct hs_progress progress;
    if (setup_scene(s, &scene) != 0) {
        return HS_EXIT_FAILED;
    }
    int result = 0;
    hs_progress_begin(&progress, "azimuths", (uint64_t)l->count);
    for (int i = 0; result == 0 && i < l->count; i++) {
        result = add_chip(s, &scene, azimuth_of(s, l, i), i, l->count, &strip);
        hs_progress_update(&progress, (uint64_t)i + 1);
    }
    hs_progress_end(&progress);
    if (result == 0 && (strip.width < 1 || strip.width > l->side_px)) {
        result = hs_error("--size", "give more", "%d dots are too few for %d pixels", l->side_px,
                          strip.width);
    }
    if (result == 0) {
        result = draw_sheet(s, &scene, &strip, l, path);
    }
    free(strip.power);
    scene_close(&scene);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int target_cmd_sheet(int argc, char **argv)
{
    struct setup s = setup_default();
    const char *out = NULL;
    long count = 12, columns = 3, size_px = 216;
    enum { OWN = 5, COUNT = OWN + SETUP_OPTIONS };
    struct hs_option options[COUNT] = {
        {"out", HS_OUTPUT, &out, 0, 0, "FILE.png", "the sheet", true},
        {"count", HS_INTEGER, &count, 1, 360, "N", "azimuths, evenly around", false},
        {"azimuth", HS_REAL, &s.azimuth_deg, -360, 360, "DEG", "of the first of them", false},
        {"columns", HS_INTEGER, &columns, 1, 20, "N", "pairs side by side", false},
        {"size", HS_INTEGER, &size_px, 16, 2048, "DOTS", "side of each picture, at most", false},
    };
    int exit_code;
    setup_options(&s, options + OWN);
    if (!hs_options_read(&usage, options, COUNT, argc, argv, &exit_code)) {
        return exit_code;
    }
    const struct layout layout = {(int)count, (int)columns, (int)size_px};
    return run(&s, &layout, out);
}
