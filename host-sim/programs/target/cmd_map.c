#include "commands.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/png.h"
#include "hs/report.h"
#include "tracer/echo_map.h"
#include "tracer/setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "map", "tell which part of a model made each point of its picture",
    "Parts are bodies that hang together, in the order of the model. The picture has a colour for\n"
    "the part from which the strongest ray of a cell came back last, the ground grey. The height\n"
    "is the one that tomography finds: of the place itself after one reflection, of the seam "
    "after\n"
    "two in a corner. Cells are those before the response of the radar and before pixels."};

struct outputs {
    const char *parts, *heights, *csv;
    long zoom;
    double range_db;
};

/* What a part did, and where it is. */
struct share {
    double power_m2, height_m2; /* the second weighted by the first */
    uint32_t cells, reflections[TRACE_BOUNCES_MAX], triangles;
    uint32_t material;
    struct vec low, high;
};

/* Twelve hues that differ; they come again. */
static const uint32_t inks[] = {0xe6194b, 0x3cb44b, 0xffe119, 0x4363d8, 0xf58231, 0x911eb4,
                                0x46f0f0, 0xf032e6, 0xbcf60c, 0xfabebe, 0x008080, 0xe6beff};
enum { INKS = sizeof inks / sizeof inks[0] };

static uint32_t ink_of(int32_t part)
{
    return part < 0 ? 0xc0c0c0 : inks[part % INKS];
}

/* The part that the strongest ray came from last, of those that are not the ground. */
static int32_t part_of(const struct echo_cell *c)
{
    int32_t part = ECHO_MAP_GROUND;
    for (uint32_t b = 0; b < c->reflections; b++) {
        part = c->parts[b] >= 0 ? c->parts[b] : part;
    }
    return part;
}

/* ---- pictures ---- */

static uint32_t darkened(uint32_t ink, double level)
{
    uint32_t dark = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        dark |= (uint32_t)lround((ink >> shift & 255) * level) << shift;
    }
    return dark;
}

/* How bright, 0 to 1. */
static double level_of(const struct echo_cell *c, double white, double range_db)
{
    const double level = c->power_m2 > 0 ? 1 + 10 * log10(c->power_m2 / white) / range_db : 0;
    return fmin(fmax(level, 0), 1);
}

/* From blue, low, over green to red. */
static uint32_t height_ink(double share)
{
    const double red = fmin(fmax(2 * share - 1, 0), 1), blue = fmin(fmax(1 - 2 * share, 0), 1);
    return (uint32_t)lround(255 * red) << 16 | (uint32_t)lround(255 * (1 - red - blue)) << 8 |
           (uint32_t)lround(255 * blue);
}

struct ramp {
    double low, high;
};

static uint32_t cell_ink(const struct echo_cell *c, const struct ramp *heights)
{
    if (!heights) {
        return ink_of(part_of(c));
    }
    const double span = heights->high - heights->low;
    const double share = span > 0 ? (c->height_m - heights->low) / span : 0;
    return height_ink(fmin(fmax(share, 0), 1));
}

static int draw(const struct echo_map *map, const struct trace_grid *grid, const struct outputs *o,
                const struct ramp *heights, const char *path)
{
    const int zoom = (int)o->zoom, width = (int)grid->cells_across, height = (int)grid->cells_range;
    uint32_t *pixels = calloc((size_t)(width * zoom) * (size_t)(height * zoom), sizeof *pixels);
    double white = 0;
    if (!pixels) {
        return hs_error(path, "give a smaller --zoom", "out of memory");
    }
    for (int i = 0; i < width * height; i++) {
        white = fmax(white, map->cells[i].power_m2);
    }
    for (int y = 0; y < height * zoom; y++) {
        for (int x = 0; x < width * zoom; x++) {
            const struct echo_cell *c = &map->cells[(height - 1 - y / zoom) * width + x / zoom];
            const double level = level_of(c, white, o->range_db);
            pixels[y * width * zoom + x] =
                c->reflections > 0 ? darkened(cell_ink(c, heights), level) : 0;
        }
    }
    const int result =
        hs_png_write_xrgb(path, pixels, width * zoom, height * zoom, (size_t)(width * zoom));
    free(pixels);
    return result;
}

/* Heights of the cells that are not ground alone. */
static struct ramp height_range(const struct echo_map *map, const struct trace_grid *grid)
{
    struct ramp ramp = {INFINITY, -INFINITY};
    for (uint32_t i = 0; i < grid->cells_across * grid->cells_range; i++) {
        const struct echo_cell *c = &map->cells[i];
        if (c->reflections > 0 && part_of(c) >= 0) {
            ramp.low = fmin(ramp.low, c->height_m);
            ramp.high = fmax(ramp.high, c->height_m);
        }
    }
    return ramp.low <= ramp.high ? ramp : (struct ramp){0, 0};
}

/* ---- tables ---- */

static void put_parts(FILE *out, const struct echo_cell *c)
{
    for (uint32_t b = 0; b < c->reflections; b++) {
        fputs(b > 0 ? ">" : "", out);
        if (c->parts[b] == ECHO_MAP_GROUND) {
            fputs("ground", out);
        } else if (c->parts[b] < 0) {
            putc('?', out);
        } else {
            fprintf(out, "%d:%d", c->parts[b] + 1, c->facets[b] + 1);
        }
    }
}

static int write_csv(const struct echo_map *map, const struct trace_grid *grid, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs(
        "across_m,range_m,power_m2,share_of_strongest_ray,reflections,height_m,height_spread_m,"
        "parts\n",
        file.stream);
    for (uint32_t i = 0; i < grid->cells_across * grid->cells_range; i++) {
        const struct echo_cell *c = &map->cells[i];
        if (c->reflections == 0) {
            continue;
        }
        const double column = i % grid->cells_across, row = i / grid->cells_across;
        fprintf(file.stream, "%.6g,%.6g,%.6g,%.3g,%u,%.4g,%.3g,",
                (column + 0.5 - grid->cells_across / 2) * grid->cell_m,
                (row + 0.5 - grid->cells_range / 2) * grid->cell_m, c->power_m2,
                c->strongest / c->power_m2, c->reflections, c->height_m, c->height_spread_m);
        put_parts(file.stream, c);
        putc('\n', file.stream);
    }
    return hs_atomic_commit(&file);
}

static void measure_parts(const struct echo_map *map, const struct mesh *m, struct share *shares)
{
    for (uint32_t i = 0; i < map->part_count; i++) {
        shares[i].low = (struct vec){INFINITY, INFINITY, INFINITY};
        shares[i].high = vec_scale(shares[i].low, -1);
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        struct share *s = &shares[map->part_of[i]];
        s->triangles++;
        s->material = m->triangles[i].material;
        for (int k = 0; k < 3; k++) {
            const struct vec v = m->vertices[m->triangles[i].corner[k]];
            s->low = (struct vec){fmin(s->low.x, v.x), fmin(s->low.y, v.y), fmin(s->low.z, v.z)};
            s->high =
                (struct vec){fmax(s->high.x, v.x), fmax(s->high.y, v.y), fmax(s->high.z, v.z)};
        }
    }
}

/* All the power of a cell counts for that part. */
static double add_up(const struct echo_map *map, const struct trace_grid *grid,
                     struct share *shares, struct share *ground)
{
    double total = 0;
    for (uint32_t i = 0; i < grid->cells_across * grid->cells_range; i++) {
        const struct echo_cell *c = &map->cells[i];
        if (c->reflections == 0) {
            continue;
        }
        const int32_t part = part_of(c);
        struct share *s = part >= 0 ? &shares[part] : ground;
        s->power_m2 += c->power_m2;
        s->height_m2 += c->power_m2 * c->height_m;
        s->cells++;
        s->reflections[c->reflections - 1]++;
        total += c->power_m2;
    }
    return total;
}

static void report_part(int32_t part, const struct share *s, const char *material, double total)
{
    const double share = total > 0 ? s->power_m2 / total : 0;
    const double height_m = s->power_m2 > 0 ? s->height_m2 / s->power_m2 : NAN;
    hs_report_object(NULL);
    hs_report_integer("part", part + 1);
    hs_report_text("material", material);
    hs_report_count("triangles", s->triangles);
    hs_report_real("power_share", share);
    hs_report_count("cells", s->cells);
    hs_report_real("echo_height_m", height_m);
    hs_report_close();
    if (part < 0) {
        printf("ground %51s", "");
    } else {
        printf("%4d   #%06x %-10s %7.2f to %-7.2f %6.2f to %-6.2f", part + 1,
               (unsigned)ink_of(part), material, s->low.x, s->high.x, s->low.y, s->high.y);
    }
    printf(" %6.2f %% %6u %8.2f\n", 100 * share, s->cells, height_m);
}

static void print_parts(const struct echo_map *map, const struct mesh *m,
                        const struct share *shares, const struct share *ground, double total)
{
    puts(
        "part   colour  material       ahead, m           left, m         power  cells  echo at, "
        "m");
    hs_report_array("parts");
    for (uint32_t i = 0; i < map->part_count; i++) {
        if (shares[i].cells > 0) {
            report_part((int32_t)i, &shares[i], m->materials[shares[i].material], total);
        }
    }
    report_part(ECHO_MAP_GROUND, ground, "ground", total);
    hs_report_close();
}

static int tell_parts(const struct echo_map *map, const struct mesh *m,
                      const struct trace_grid *grid)
{
    struct share *shares = calloc(map->part_count + 1, sizeof *shares), ground = {0};
    if (!shares) {
        return hs_error("map", NULL, "out of memory");
    }
    measure_parts(map, m, shares);
    const double total = add_up(map, grid, shares, &ground);
    print_parts(map, m, shares, &ground, total);
    free(shares);
    return 0;
}

/* ---- the command ---- */

static int write_all(const struct echo_map *map, const struct mesh *m,
                     const struct trace_grid *grid, const struct outputs *o)
{
    const struct ramp heights = height_range(map, grid);
    int result = tell_parts(map, m, grid);
    printf("heights of echoes: %.2f to %.2f m\n", heights.low, heights.high);
    hs_report_real("least_height_m", heights.low);
    hs_report_real("greatest_height_m", heights.high);
    if (result == 0 && o->parts) {
        result = draw(map, grid, o, NULL, o->parts);
    }
    if (result == 0 && o->heights) {
        result = draw(map, grid, o, &heights, o->heights);
    }
    return result == 0 && o->csv ? write_csv(map, grid, o->csv) : result;
}

static int map_of(const struct setup *s, const struct mesh *m, const struct scene *scene,
                  const struct outputs *o)
{
    struct trace_records r;
    struct reflect_law law;
    struct echo_map map;
    const struct trace_order order = setup_order(s, s->azimuth_deg);
    if (trace_run(scene, &order, s->model, &r, NULL) != 0) {
        return -1;
    }
    int result = setup_law(s, &r, &law) == 0 ? echo_map_make(&map, &r, &law, scene, m) : -1;
    if (result == 0) {
        result = write_all(&map, m, &r.grid, o);
        echo_map_free(&map);
    }
    trace_records_free(&r);
    return result;
}

static int run(const struct setup *s, const struct outputs *o)
{
    struct mesh m;
    struct scene scene;
    if (setup_load(s, &m) != 0) {
        return HS_EXIT_FAILED;
    }
    int result = setup_scene_of(s, &m, &scene);
    if (result == 0) {
        result = map_of(s, &m, &scene, o);
        scene_close(&scene);
    }
    mesh_free(&m);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int target_cmd_map(int argc, char **argv)
{
    struct setup s = setup_default();
    struct outputs o = {.zoom = 4, .range_db = 50};
    enum { OWN = 6, LAW = OWN + SETUP_MODEL_OPTIONS + SETUP_TRACE_OPTIONS };
    struct hs_option options[LAW + SETUP_LAW_OPTIONS] = {
        {"out", HS_OUTPUT, &o.parts, 0, 0, "FILE.png", "a picture of the parts", false},
        {"heights", HS_OUTPUT, &o.heights, 0, 0, "FILE.png",
         "a picture of the heights of the echoes: blue, low, over green to red", false},
        {"csv", HS_OUTPUT, &o.csv, 0, 0, "FILE.csv",
         "each cell: place, power, height, and the parts with their triangles, in the order of the "
         "reflections",
         false},
        {"zoom", HS_INTEGER, &o.zoom, 1, 16, "N", "dots of a picture a cell, either way", false},
        {"range-db", HS_REAL, &o.range_db, 1, 200, "DB", "from the brightest cell to black", false},
        {"azimuth", HS_REAL, &s.azimuth_deg, -360, 360, "DEG",
         "of the radar, from the model's nose towards its right", false},
    };
    int exit_code;
    setup_model_options(&s, options + OWN);
    setup_trace_options(&s, options + OWN + SETUP_MODEL_OPTIONS);
    setup_law_options(&s, options + LAW);
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return run(&s, &o);
}
