#include "commands.h"

#include "gis/class_raster.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/options.h"
#include "hs/report.h"
#include "vectors/output.h"
#include "vectors/source.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct settings {
    struct hs_list vectors;
    const char *rules, *classes, *area, *ground, *map, *unknown_codes;
    const char *out, *heights, *detail, *package;
    double cell_m;
};

static const struct hs_usage usage = {
    "vectors", "make classes, heights and detail of OpenStreetMap or other vectors",
    "Buildings, roads, rails, power lines, water, coast and woods become a class raster, a raster "
    "of heights\n"
    "and a file of detail, which landmass-db build takes. A file of rules says what each feature "
    "becomes;\n"
    "classes/osm.rules is for OpenStreetMap (.osm.pbf, .osm). Other files are read by GDAL "
    "(GeoPackage, Shapefile,\n"
    "GeoJSON): their fields are the tags, and `layer` is one more.\n"
    "\n"
    "Each element is accounted for: the table printed says how many were made, and why others were "
    "not."};

#define OPTION(name, kind, field, low, high, value, help)                                          \
    {                                                                                              \
        name, kind, &s->field, low, high, value, help, false                                       \
    }

static bool read_settings(struct settings *s, int argc, char **argv, int *exit_code)
{
    const struct hs_option options[] = {
        {"vectors", HS_INPUTS, &s->vectors, 0, 0, "FILE", "vector file; may be given again", true},
        {"rules", HS_INPUT, &s->rules, 0, 0, "FILE",
         "what each feature becomes (docs/FORMATS.md); classes/osm.rules for OpenStreetMap", true},
        {"classes", HS_INPUT, &s->classes, 0, 0, "FILE", "class table (docs/classifier.md)", true},
        {"out", HS_OUTPUT, &s->out, 0, 0, "FILE.tif", "the class raster to write", true},
        OPTION("heights", HS_OUTPUT, heights, 0, 0, "FILE.tif", "heights to write"),
        OPTION("detail", HS_OUTPUT, detail, 0, 0, "FILE", "detail to write (docs/database.md)"),
        OPTION("package", HS_OUTPUT, package, 0, 0, "FILE.gpkg",
               "a GeoPackage to write, of all that was made: to look at in QGIS"),
        OPTION("area", HS_TEXT, area, 0, 0, "S,W,N,E",
               "degrees; left out: what the files say of themselves, or all of them"),
        OPTION("cell", HS_REAL, cell_m, 0.2, 1000, "METRES", "side of a pixel"),
        OPTION("ground", HS_INPUT, ground, 0, 0, "FILE",
               "class raster or land cover under the vectors; left out: none, so that build "
               "decides by elevation"),
        OPTION("map", HS_INPUT, map, 0, 0, "FILE",
               "the ground is somebody's land cover: its codes, each with a class"),
        OPTION("unknown-codes", HS_TEXT, unknown_codes, 0, 0, "NAME",
               "class of codes that the map leaves out, or none; left out: they are an error"),
        HS_NEEDS_ROW("map", "ground"),
        HS_NEEDS_ROW("unknown-codes", "map"),
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

/* Everything of one run; freed whole. */
struct job {
    struct db_class_table table;
    struct vector_rules rules;
    struct db_code_map codes;
    struct vector_source sources[HS_LIST_MAX];
    int source_count;
    struct vector_map map;
};

/* ---- area ---- */

static int parse_area(const char *text, struct vector_area *a)
{
    double d[4];
    if (hs_numbers(text, ',', d, 4) != 4) {
        return hs_error("--area", "write SOUTH,WEST,NORTH,EAST in degrees", "`%s` is no area",
                        text);
    }
    *a = (struct vector_area){.south = d[0], .west = d[1], .north = d[2], .east = d[3]};
    return 0;
}

static int choose_area(const struct job *j, const struct settings *s, struct vector_area *a)
{
    bool is_known = false;
    if (s->area) {
        return parse_area(s->area, a);
    }
    for (int i = 0; i < j->source_count; i++) {
        const struct vector_source *source = &j->sources[i];
        if (source->has_area && is_known) {
            a->south = fmin(a->south, source->area.south);
            a->west = fmin(a->west, source->area.west);
            a->north = fmax(a->north, source->area.north);
            a->east = fmax(a->east, source->area.east);
        } else if (source->has_area) {
            *a = source->area;
            is_known = true;
        }
    }
    return is_known ? 0 : hs_error("--area", "give one", "the files have no places");
}

/* ---- input ---- */

static int read_codes(struct job *j, const struct settings *s)
{
    if (!s->map) {
        return 0;
    }
    if (db_code_map_read(&j->codes, s->map, &j->table) != 0) {
        return -1;
    }
    if (s->unknown_codes) {
        const bool is_none = strcmp(s->unknown_codes, "none") == 0;
        j->codes.unknown_class =
            is_none ? DB_CLASS_NODATA : db_class_find(&j->table, s->unknown_codes);
        if (j->codes.unknown_class < 0) {
            return hs_error("--unknown-codes", "name one of the class table, or none",
                            "there is no class \"%s\"", s->unknown_codes);
        }
    }
    return 0;
}

static int open_sources(struct job *j, const struct settings *s)
{
    for (int i = 0; i < s->vectors.count; i++) {
        if (vector_source_open(&j->sources[i], s->vectors.items[i]) != 0) {
            return -1;
        }
        j->source_count++;
    }
    return 0;
}

static int add_sources(struct job *j)
{
    hs_report_array("sources");
    for (int i = 0; i < j->source_count; i++) {
        struct vector_source *source = &j->sources[i];
        if (vector_source_add(source, &j->map) != 0) {
            return -1;
        }
        vector_census_print(&source->census, source->path);
        vector_census_report(&source->census, source->path);
        if (vector_census_check(&source->census, source->path) != 0) {
            return -1;
        }
        vector_census_warn(&source->census, source->path);
    }
    hs_report_close();
    return j->map.item_count > 0
               ? 0
               : hs_error("--vectors", "check --area, and the rules' tags with ogrinfo",
                          "no feature of the area fits a rule that makes something");
}

/* ---- output ---- */

static int write_rows(struct db_raster_out *out, const struct vector_map *map, const void *pixels,
                      size_t pixel_bytes)
{
    int result = 0;
    for (int y = 0; y < map->grid.height && result == 0; y++) {
        result = db_raster_write(
            out, y, 1, (const char *)pixels + (size_t)y * (size_t)map->grid.width * pixel_bytes);
    }
    return result;
}

static int write_rasters(const struct job *j, const struct settings *s)
{
    struct db_raster_out classes = {.dataset = NULL}, heights = {.dataset = NULL};
    const struct vector_map *map = &j->map;
    if (db_class_raster_create(&classes, s->out, &map->grid, &j->table) != 0) {
        return -1;
    }
    int result =
        s->heights ? db_raster_create(&heights, s->heights, &map->grid, GDT_Float32, -1) : 0;
    if (result == 0) {
        result = write_rows(&classes, map, map->classes, 1);
    }
    if (result == 0 && s->heights) {
        result = write_rows(&heights, map, map->heights_m, sizeof(float));
    }
    if (result == 0 && s->heights) {
        result = db_raster_commit(&heights);
    }
    if (result == 0) {
        return db_raster_commit(&classes);
    }
    db_raster_abort(&classes);
    db_raster_abort(&heights);
    return -1;
}

static void report_detail(const struct vector_detail_counts *n)
{
    hs_report_object("detail");
    hs_report_put("buildings", n->buildings);
    hs_report_put("boxes", n->boxes);
    hs_report_put("boxes_m2", n->boxes_m2);
    hs_report_put("footprint_m2", n->footprint_m2);
    hs_report_put("walls", n->walls);
    hs_report_put("lines", n->lines);
    hs_report_put("masts", n->masts);
    hs_report_put("strips", n->strips);
    hs_report_put("outside", n->outside);
    hs_report_close();
}

static int write_detail(const struct job *j, const struct settings *s)
{
    char remark[160];
    bool is_osm = false;
    struct vector_detail_counts n;
    for (int i = 0; i < j->source_count; i++) {
        is_osm = is_osm || j->sources[i].store;
    }
    snprintf(remark, sizeof remark, "Made by landmass-db vectors%s",
             is_osm ? ". Data (c) OpenStreetMap contributors, ODbL 1.0" : "");
    if (vector_detail_write(&j->map, &j->table, s->detail, remark, &n) != 0) {
        return -1;
    }
    printf("detail: %" PRIu64 " buildings in %" PRIu64 " boxes (%.0f m2 of %.0f m2), %" PRIu64
           " walls, %" PRIu64 " lines, %" PRIu64 " masts, %" PRIu64 " strips",
           n.buildings, n.boxes, n.boxes_m2, n.footprint_m2, n.walls, n.lines, n.masts, n.strips);
    printf("; %" PRIu64 " pieces outside the area left out\n", n.outside);
    report_detail(&n);
    return 0;
}

static void print_classes(const struct job *j)
{
    uint64_t counts[256] = {0};
    const size_t cells = (size_t)j->map.grid.width * (size_t)j->map.grid.height;
    for (size_t i = 0; i < cells; i++) {
        counts[j->map.classes[i]]++;
    }
    db_class_counts_print(&j->table, counts);
}

static int write_all(const struct job *j, const struct settings *s)
{
    if ((s->detail && write_detail(j, s) != 0) ||
        (s->package && vector_package_write(&j->map, &j->table, s->package) != 0)) {
        return -1;
    }
    return write_rasters(j, s);
}

static void report_area(const struct vector_area *area, const struct job *j,
                        const struct settings *s)
{
    hs_report_object("area");
    hs_report_put("south_deg", area->south);
    hs_report_put("west_deg", area->west);
    hs_report_put("north_deg", area->north);
    hs_report_put("east_deg", area->east);
    hs_report_close();
    hs_report_put("width_px", j->map.grid.width);
    hs_report_put("height_px", j->map.grid.height);
    hs_report_put("cell_m", s->cell_m);
}

static int work(struct job *j, const struct settings *s)
{
    struct vector_area area;
    if (db_class_table_read(&j->table, s->classes) != 0 ||
        vector_rules_read(&j->rules, s->rules, &j->table) != 0 || read_codes(j, s) != 0 ||
        open_sources(j, s) != 0 || choose_area(j, s, &area) != 0 ||
        vector_map_init(&j->map, &j->rules, &area, s->cell_m) != 0) {
        return -1;
    }
    printf("area %.4f,%.4f,%.4f,%.4f: %d x %d cells of %g m\n", area.south, area.west, area.north,
           area.east, j->map.grid.width, j->map.grid.height, s->cell_m);
    report_area(&area, j, s);
    if ((s->ground &&
         vector_ground(&j->map, s->ground, s->map ? &j->codes : NULL, &j->table) != 0) ||
        add_sources(j) != 0 || vector_map_burn(&j->map) != 0) {
        return -1;
    }
    vector_map_print(&j->map);
    print_classes(j);
    return write_all(j, s);
}

int db_cmd_vectors(int argc, char **argv)
{
    hs_outputs_together();
    struct settings s = {.cell_m = 2};
    int exit_code;
    const bool goes_on = read_settings(&s, argc, argv, &exit_code);
    struct job *j = goes_on ? calloc(1, sizeof *j) : NULL;
    if (goes_on) {
        exit_code = j && work(j, &s) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    for (int i = 0; j && i < j->source_count; i++) {
        vector_source_close(&j->sources[i]);
    }
    if (j) {
        vector_map_free(&j->map);
    }
    free(j);
    hs_list_free(&s.vectors);
    return exit_code;
}
