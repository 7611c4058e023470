/* landmass-db correct: a class raster and hand-drawn corrections in, a corrected class raster out.
 */
#include "commands.h"
#include "source_options.h"

#include "gis/class_raster.h"
#include "gis/label_map.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "hs/report.h"

#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    .command = "correct",
    .summary = "apply manual corrections to a class raster",
    .description =
        "Sets the pixels inside polygons to the polygons' class, in the order of the file; where "
        "two overlap\n"
        "the later wins. Corrections stay in their own file, so that they can be applied again "
        "after the\n"
        "image has been segmented anew. Pixels without data are set too; the label `nodata` takes "
        "data away.\n"
        "Polygons are read, and reprojected, as for `train`.\n\n"
        "Example:\n"
        "  landmass-db correct --class-raster scene-classes.tif --classes heaton6.classes \\\n"
        "      --corrections beach-is-not-concrete.geojson --out scene-corrected.tif",
};

struct options {
    const char *class_raster, *classes, *corrections, *field, *map, *out;
    bool ignores_names;
};

static bool read_options(struct options *o, int argc, char **argv, int *exit_code)
{
    const struct hs_option table[] = {
        {"class-raster", HS_INPUT, &o->class_raster, 0, 0, "FILE",
         "The class raster, from `segment`.", true},
        DB_CLASSES_OPTION(o->classes),
        DB_CLASS_NUMBERS_OPTION(o->ignores_names),
        {"corrections", HS_INPUT, &o->corrections, 0, 0, "FILE", "Polygons of the right class.",
         true},
        {"out", HS_OUTPUT, &o->out, 0, 0, "FILE", "Where the corrected class raster goes.", true},
        {"field", HS_TEXT, &o->field, 0, 0, "NAME",
         "The polygons' field that holds the class; default `class`.", false},
        {"map", HS_INPUT, &o->map, 0, 0, "FILE",
         "Lines of `source-label = class`; without it labels must be names of classes.", false},
    };
    return hs_options_read(&usage, table, sizeof table / sizeof table[0], argc, argv, exit_code);
}

struct work {
    const struct options *options;
    struct db_class_table table;
    struct db_label_map map;
    struct db_raster in;
    struct db_class_numbers numbers;
    struct db_raster_out out;
    struct db_polygons polygons;
    uint8_t *class_of; /* owned: of each polygon */
    uint64_t *changed; /* owned: pixels of each polygon that had another class before it */
    uint64_t *covered; /* owned: pixels of each polygon */
    float *scratch;    /* owned */
    uint8_t *valid;    /* owned */
    uint8_t *classes;  /* owned */
    int y, block_rows; /* the block in memory */
    size_t polygon;    /* the one being applied */
};

/* Unlike exemplars, a correction of unknown class is an error: it was drawn to have an effect. */
static int find_classes(struct work *w)
{
    const size_t count = w->polygons.count;
    w->class_of = malloc(count);
    w->changed = calloc(count, sizeof *w->changed);
    w->covered = calloc(count, sizeof *w->covered);
    if (!w->class_of || !w->changed || !w->covered) {
        return hs_error(w->options->corrections, NULL, "out of memory");
    }
    for (size_t i = 0; i < count; i++) {
        const char *label = w->polygons.items[i].label;
        const int c = db_label_map_find(&w->map, label);
        if (c < 0 && strcmp(label, "nodata") != 0) {
            char names[DB_CLASS_MAX * DB_NAME_SIZE];
            db_class_names(&w->table, names, sizeof names);
            return hs_error(w->options->corrections, "correct the label, or give a --map",
                            "polygon %ld has the unknown class `%s`; there are %s, nodata",
                            w->polygons.items[i].id, label, names);
        }
        w->class_of[i] = c < 0 ? DB_CLASS_NODATA : (uint8_t)c;
    }
    return 0;
}

static int prepare(struct work *w)
{
    const struct options *o = w->options;
    if (db_class_table_read(&w->table, o->classes) != 0 ||
        db_label_map_read(&w->map, o->map, &w->table) != 0 ||
        db_class_raster_open(&w->in, &w->numbers, o->class_raster, &w->table, o->ignores_names) !=
            0 ||
        db_polygons_read(&w->polygons, o->corrections, o->field, &w->in.grid) != 0 ||
        find_classes(w) != 0) {
        return -1;
    }
    w->block_rows = db_raster_block_rows(&w->in.grid, sizeof *w->scratch + 2);
    const size_t count = (size_t)w->block_rows * (size_t)w->in.grid.width;
    w->scratch = malloc(count * sizeof *w->scratch);
    w->valid = malloc(count);
    w->classes = malloc(count);
    if (!w->scratch || !w->valid || !w->classes) {
        return hs_error(o->class_raster, NULL, "out of memory");
    }
    return db_class_raster_create(&w->out, o->out, &w->in.grid, &w->table);
}

static int apply_span(void *context, int y, int x_begin, int x_end)
{
    struct work *w = context;
    uint8_t *row = w->classes + (size_t)(y - w->y) * (size_t)w->in.grid.width;
    const uint8_t c = w->class_of[w->polygon];
    w->covered[w->polygon] += (uint64_t)(x_end - x_begin);
    for (int x = x_begin; x < x_end; x++) {
        w->changed[w->polygon] += row[x] != c;
        row[x] = c;
    }
    return 0;
}

static int correct_block(struct work *w, int rows)
{
    if (db_class_raster_read(&w->in, &w->numbers, w->y, rows, w->scratch, w->valid, w->classes) !=
        0) {
        return -1;
    }
    for (w->polygon = 0; w->polygon < w->polygons.count; w->polygon++) {
        if (db_polygon_walk(&w->polygons.items[w->polygon], w->y, w->y + rows, w->in.grid.width,
                            apply_span, w) != 0) {
            return hs_error(w->options->corrections, NULL, "out of memory");
        }
    }
    return db_raster_write(&w->out, w->y, rows, w->classes);
}

static int correct(struct work *w)
{
    const int height = w->in.grid.height;
    struct hs_progress progress;
    hs_progress_begin(&progress, "correct", (uint64_t)height);
    int result = 0;
    for (w->y = 0; result == 0 && w->y < height; w->y += w->block_rows) {
        const int rows = w->y + w->block_rows < height ? w->block_rows : height - w->y;
        result = correct_block(w, rows);
        hs_progress_update(&progress, (uint64_t)(w->y + rows));
    }
    hs_progress_end(&progress);
    return result;
}

static void report_change(const struct db_polygon *p, uint64_t changed, uint64_t covered)
{
    hs_report_object(NULL);
    hs_report_put("id", p->id);
    hs_report_put("label", p->label);
    hs_report_put("changed_pixels", changed);
    hs_report_put("covered_pixels", covered);
    hs_report_close();
}

static void print_changes(const struct work *w)
{
    hs_report_array("corrections");
    for (size_t i = 0; i < w->polygons.count; i++) {
        const struct db_polygon *p = &w->polygons.items[i];
        report_change(p, w->changed[i], w->covered[i]);
        char place[96];
        snprintf(place, sizeof place, "correction %ld (%s)", p->id, p->label);
        printf("%s: %llu of %llu pixels changed\n", place, (unsigned long long)w->changed[i],
               (unsigned long long)w->covered[i]);
        if (w->covered[i] == 0) {
            hs_warn(place, "check its CRS", "covers no pixel of the class raster");
        }
    }
    hs_report_close();
}

static int run(struct work *w)
{
    if (prepare(w) != 0 || correct(w) != 0 || db_raster_commit(&w->out) != 0) {
        db_raster_abort(&w->out);
        return HS_EXIT_FAILED;
    }
    print_changes(w);
    return HS_EXIT_OK;
}

int db_cmd_correct(int argc, char **argv)
{
    struct options options = {.field = "class"};
    int exit_code;
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        hs_error("correct", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    w->options = &options;
    if (read_options(&options, argc, argv, &exit_code)) {
        exit_code = run(w);
    }
    db_polygons_free(&w->polygons);
    db_raster_close(&w->in);
    free(w->class_of);
    free(w->changed);
    free(w->covered);
    free(w->scratch);
    free(w->valid);
    free(w->classes);
    free(w);
    return exit_code;
}
