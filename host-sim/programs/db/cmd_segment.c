/* landmass-db segment: an image and a trained network in, a class raster out. */
#include "commands.h"
#include "cost.h"
#include "source_options.h"

#include "classify/confusion.h"
#include "classify/error_regions.h"
#include "classify/judge.h"
#include "classify/learn.h"
#include "classify/mixtures.h"
#include "classify/mlp_apply.h"
#include "classify/specks.h"
#include "gis/class_raster.h"
#include "gis/gdal_start.h"
#include "gis/preview.h"
#include "gis/sieve.h"
#include "gis/strips.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/png.h"
#include "hs/progress.h"
#include "hs/report.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static const struct hs_usage usage = {
    .command = "segment",
    .summary = "give each pixel of an image its class",
    .description =
        "Runs the trained network over the image, a block of rows at a time, and writes the class "
        "of each\n"
        "pixel as a compressed GeoTIFF (Byte, 255 for no data) with the image's georeferencing and "
        "the class\n"
        "table's colours and names.\n\n"
        "Pixels across a border between two classes are a mixture of both, which may look like a "
        "third: they\n"
        "take the class that covers more of them (--mixtures).\n\n"
        "Specks, smaller than --sieve says, take the class around them: single wrong pixels stand "
        "as bright\n"
        "spots in a picture that is finer than the map. Look at the result (--picture) before "
        "going on:\n"
        "scattered errors become background clutter; systematic ones call for more exemplars or "
        "for `landmass-db correct`. With "
        "exemplars\n"
        "given, --report lists the polygons and the squares of the image that came out worst.\n\n"
        "A large image is made in strips (--shards, --shard), on whatever machine.\n\n"
        "Example:\n"
        "  landmass-db segment --image scene.tif --classes heaton6.classes --net scene.net \\\n"
        "      --out scene-classes.tif --picture scene-classes.png",
};

_Static_assert((int)DB_SPECKS_HALO <= (int)DB_MIXTURES_HALO, "a block has room for either");

struct options {
    struct db_image_options image;
    struct db_exemplar_options known; /* for the report */
    const char *classes, *net, *out, *picture, *report, *reject;
    double sure, mixtures, sieve;
    struct hs_list picture_bands, spare;
    long square;
    struct db_strip_options strips;
};

static bool read_options(struct options *o, int argc, char **argv, int *exit_code)
{
    const struct hs_option table[] = {
        DB_IMAGE_OPTIONS(&o->image),
        {"classes", HS_INPUT, &o->classes, 0, 0, "FILE",
         "The class table the network was trained with.", true},
        {"net", HS_INPUT, &o->net, 0, 0, "FILE", "The network, from `landmass-db train`.", true},
        {"out", HS_OUTPUT, &o->out, 0, 0, "FILE", "Where the class raster goes.", false},
        {"picture", HS_OUTPUT, &o->picture, 0, 0, "FILE",
         "Also write a PNG: the image on the left, its classes on the right; at most 1024 "
         "pixels each\n"
         "way, larger images show every n-th pixel.",
         false},
        {"picture-bands", HS_LIST, &o->picture_bands, 0, 0, "R,G,B",
         "Bands to show as red, green and blue, from 1; default 1,2,3 of three bands, "
         "3,2,1 of more.",
         false},
        {"reject", HS_TEXT, &o->reject, 0, 0, "CLASS",
         "Give this class of the table, or `nodata`, to pixels outside the range that the network "
         "was\n"
         "trained on, instead of what it says of them.",
         false},
        {"sure", HS_REAL, &o->sure, 0.5, 0.999, "P",
         "With --reject: also to pixels whose class is less than so probable against the next.",
         false},
        {"mixtures", HS_REAL, &o->mixtures, 0, 1, "X",
         "Pixels without five neighbours of their own class, whose bands lie on the line between "
         "two classes\n"
         "around them, take that of the larger share. X is how far from the line they may lie, as "
         "a "
         "part of\n"
         "the distance between the two; 0 leaves all as the network says.",
         false},
        {"sieve", HS_REAL, &o->sieve, 0, 10000, "M2",
         "Regions of one class that cover less ground than so many square metres, corners counted "
         "as\n"
         "borders, take the class around them that looks most like them; 0 keeps them all. Pixels "
         "that are\n"
         "larger are none.",
         false},
        {"spare", HS_LIST, &o->spare, 0, 0, "CLASS,..",
         "Classes whose smallest regions stay: what people built, say, where a lone house counts.",
         false},
        {"report", HS_FOLDER, &o->report, 0, 0, "FOLDER",
         "Write where exemplars (below) came out wrong: regions.csv, squares.csv, worst.txt, "
         "confusion.csv.",
         false},
        DB_EXEMPLAR_OPTIONS(&o->known),
        {"square", HS_INTEGER, &o->square, 4, 4096, "N",
         "Side in pixels of the squares of the report.", false},
        DB_STRIP_OPTIONS(&o->strips),
        HS_CLASHES_ROW("shards", "picture|report"),
        HS_NEEDS_ROW("picture-bands", "picture"),
        HS_NEEDS_ROW("sure", "reject"),
        HS_NEEDS_ROW("report", "exemplars|labels"),
        HS_NEEDS_ROW("exemplars", "report"),
        HS_CLASHES_ROW("exemplars", "labels"),
        HS_NEEDS_ROW("field", "exemplars"),
        HS_NEEDS_ROW("labels", "report"),
        HS_NEEDS_ROW("ignore", "report"),
        HS_NEEDS_ROW("map", "report"),
        HS_NEEDS_ROW("square", "report"),
    };
    return hs_options_read(&usage, table, sizeof table / sizeof table[0], argc, argv, exit_code);
}

/* Classes on their way: some rows of the raster, in a file of their own. */
struct step {
    struct db_raster_out file;
    struct db_rows rows;
};

struct work {
    const struct options *options;
    struct db_class_table table;
    struct db_net net;
    uint8_t class_of_output[DB_CLASS_MAX];
    struct db_applied applied;
    struct db_judge judge;
    uint8_t rejected_class; /* what rejected pixels become */
    struct db_raster image;
    /* As the network says, with mixtures resolved, and as the sieve leaves it. Without the rule
     * `settled` is not used. */
    struct step raw, settled;
    struct db_raster_out out;
    struct db_row_writer writer;
    const struct step *before_sieve; /* one of them */
    struct db_rows own, sieved;      /* rows that are written; those that the sieve sees */
    uint8_t *band, *before;          /* owned: rows in the sieve, and those of them before it */
    struct db_mixtures mixtures;
    int speck_pixels; /* regions of fewer are specks */
    bool is_spared[DB_CLASS_MAX];
    struct db_exemplars exemplars;
    uint8_t *given; /* owned: class of each exemplar */
    size_t given_count;
    struct db_preview original, classes;
    int shown[3]; /* bands of the picture, from 0 */
    int shown_count;
    uint64_t counts[256];  /* pixels of each class by the network, without those rejected */
    uint64_t written[256]; /* pixels of each class in the raster */
    uint64_t rejected, resolved, sieved_pixels;
    double seconds; /* of the network alone */
};

static int choose_bands(struct work *w)
{
    const struct hs_list *list = &w->options->picture_bands;
    const int bands = w->image.band_count;
    w->shown_count = bands >= 3 ? 3 : 1;
    for (int i = 0; i < 3; i++) {
        w->shown[i] = bands == 3 ? i : bands > 3 ? 2 - i : 0;
    }
    if (list->count == 0) {
        return 0;
    }
    w->shown_count = list->count == 3 ? 3 : 1;
    for (int i = 0; i < list->count && i < 3; i++) {
        w->shown[i] = atoi(list->items[i]) - 1;
        if (w->shown[i] < 0 || w->shown[i] >= bands || (list->count != 1 && list->count != 3)) {
            return hs_error("--picture-bands", "give one band or three",
                            "`%s` is not a band of 1..%d", list->items[i], bands);
        }
    }
    return 0;
}

static int find_exemplars(struct work *w)
{
    const struct options *o = w->options;
    struct db_label_map map;
    if (!o->report) {
        return 0;
    }
    if (db_exemplar_map_read(&map, &o->known, &w->table) != 0) {
        return -1;
    }
    const struct db_exemplar_source source = {
        .polygons_path = o->known.polygons,
        .field = o->known.field,
        .labels_path = o->known.labels,
        .map = &map,
        .table = &w->table,
        .per_class = 1000000,
        .seed = 1,
    };
    if (db_exemplars_find(&w->exemplars, &source, &w->image.grid) != 0) {
        return -1;
    }
    for (size_t i = 0; i < w->exemplars.count; i++) {
        w->exemplars.items[i].part = DB_PART_UNKNOWN;
    }
    w->given = malloc(w->exemplars.count + 1);
    return w->given ? 0 : hs_error(o->report, NULL, "out of memory");
}

static int find_reject_class(struct work *w)
{
    const char *name = w->options->reject;
    w->judge.net = &w->net;
    w->judge.sure = w->options->sure;
    w->rejected_class = DB_CLASS_NODATA;
    if (!name || strcmp(name, "nodata") == 0) {
        return 0;
    }
    const int c = db_class_find(&w->table, name);
    if (c < 0) {
        char names[DB_CLASS_MAX * DB_NAME_SIZE];
        db_class_names(&w->table, names, sizeof names);
        return hs_error("--reject", "name one of them",
                        "there is no class `%s`; there are %s, nodata", name, names);
    }
    w->rejected_class = (uint8_t)c;
    return 0;
}

static int find_spared(struct work *w)
{
    const struct hs_list *names = &w->options->spare;
    for (int i = 0; i < names->count; i++) {
        const int c = db_class_find(&w->table, names->items[i]);
        if (c < 0) {
            char known[DB_CLASS_MAX * DB_NAME_SIZE];
            db_class_names(&w->table, known, sizeof known);
            return hs_error("--spare", "name one of them", "there is no class `%s`; there are %s",
                            names->items[i], known);
        }
        w->is_spared[c] = true;
    }
    return 0;
}

/* A raster of its own name, for classes on their way: two under the name of the result would be
 * written into one file. */
static int create_step(const struct work *w, struct step *step, struct db_rows rows,
                       const char *name)
{
    const size_t size = strlen(w->options->out) + strlen(name) + 2;
    const struct db_grid grid = db_strips_grid(&w->image.grid, rows);
    char *path = malloc(size);
    if (!path) {
        return hs_error(w->options->out, NULL, "out of memory");
    }
    snprintf(path, size, "%s.%s", w->options->out, name);
    step->rows = rows;
    const int result = db_class_raster_create(&step->file, path, &grid, &w->table);
    free(path);
    return result;
}

static int create_outputs(struct work *w)
{
    const struct options *o = w->options;
    const struct db_grid *whole = &w->image.grid;
    const struct db_grid own = db_strips_grid(whole, w->own);
    const int halo = o->mixtures > 0 ? DB_MIXTURES_HALO : 0;
    w->before_sieve = halo ? &w->settled : &w->raw;
    if (halo && (db_mixtures_init(&w->mixtures, &w->net, o->mixtures) != 0 ||
                 create_step(w, &w->settled, w->sieved, "mixtures") != 0)) {
        return -1;
    }
    if (create_step(w, &w->raw, db_rows_around(w->sieved, halo, whole), "network") != 0 ||
        db_class_raster_create(&w->out, o->out, &own, &w->table) != 0) {
        return -1;
    }
    db_strips_tag(&w->out, &o->strips);
    return db_row_writer_init(&w->writer, &w->out);
}

/* Rows on either side that a pixel's class depends on. */
static int reach_of(const struct work *w)
{
    return db_sieve_margin(w->speck_pixels) + (w->options->mixtures > 0 ? DB_MIXTURES_HALO : 0) +
           w->net.context / 2;
}

static int write_plan(const struct work *w)
{
    const struct db_raster *rasters[] = {&w->image};
    const char *plain[] = {w->options->classes, w->options->net};
    const struct db_strip_sources sources = {rasters, 1, plain, 2, reach_of(w)};
    return db_strips_write_plan(&w->options->strips, &w->image.grid, &sources);
}

static int prepare(struct work *w)
{
    const struct options *o = w->options;
    if (db_class_table_read(&w->table, o->classes) != 0 || db_net_read(&w->net, o->net) != 0 ||
        db_net_classes(&w->net, &w->table, o->net, w->class_of_output) != 0 ||
        find_reject_class(w) != 0 || find_spared(w) != 0 ||
        db_apply_init(&w->applied, &w->net) != 0 || db_image_open(&w->image, &o->image) != 0) {
        return -1;
    }
    if (w->image.band_count != w->net.band_count) {
        return hs_error(w->image.name, "give the same bands in the same order",
                        "has %d bands, but %s was trained with %d", w->image.band_count, o->net,
                        w->net.band_count);
    }
    if (find_exemplars(w) != 0 || choose_bands(w) != 0) {
        return -1;
    }
    if (o->picture && (db_preview_init(&w->original, &w->image.grid, w->shown_count) != 0 ||
                       db_preview_init(&w->classes, &w->image.grid, 1) != 0)) {
        return -1;
    }
    w->speck_pixels = db_sieve_pixels(&w->image.grid, o->sieve);
    if (db_strips_rows(&o->strips, &w->image.grid, &w->own) != 0) {
        return -1;
    }
    w->sieved = db_rows_around(w->own, db_sieve_margin(w->speck_pixels), &w->image.grid);
    return o->strips.plan ? 0 : create_outputs(w);
}

struct block {
    float *planes;
    uint8_t *valid, *classes, *reject;
    float *margins; /* NULL unless pixels can be unsure */
    int y, rows;
};

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void classify(struct work *w, const struct block *b)
{
    const size_t count = (size_t)b->rows * (size_t)w->image.grid.width;
    const double begin = now_s();
    db_apply(&w->applied, b->planes, count, count, b->classes, b->margins);
    w->seconds += now_s() - begin;
    db_judge_add(&w->judge, b->planes, b->margins, b->valid, count, b->reject);
    for (size_t i = 0; i < count; i++) {
        if (!b->valid[i]) {
            b->classes[i] = DB_CLASS_NODATA;
        } else if (w->options->reject && b->reject[i]) {
            w->rejected++;
            b->classes[i] = w->rejected_class;
            continue;
        } else {
            b->classes[i] = w->class_of_output[b->classes[i]];
        }
        w->counts[b->classes[i]]++;
    }
}

static void keep_for_report(struct work *w, const struct block *b)
{
    while (w->given_count < w->exemplars.count &&
           w->exemplars.items[w->given_count].y < b->y + b->rows) {
        const struct db_exemplar *e = &w->exemplars.items[w->given_count];
        const size_t row = (size_t)(e->y - b->y);
        w->given[w->given_count++] = b->classes[row * (size_t)w->image.grid.width + (size_t)e->x];
    }
}

static void keep_original(struct work *w, const struct block *b)
{
    const int width = w->image.grid.width;
    const size_t count = (size_t)b->rows * (size_t)width;
    for (int i = 0; w->options->picture && i < w->shown_count; i++) {
        db_preview_add(&w->original, i, b->y, b->rows, width,
                       b->planes + (size_t)w->shown[i] * count, b->valid);
    }
}

static int segment_block(struct work *w, const struct block *b)
{
    if (db_features_read(&w->image, w->net.context, b->y, b->rows, b->planes, b->valid) != 0) {
        return -1;
    }
    classify(w, b);
    keep_original(w, b);
    return db_raster_write(&w->raw.file, b->y - w->raw.rows.first, b->rows, b->classes);
}

/* Take rows from a raster that is being written. */
static int read_back(const struct work *w, const struct step *from, int y, int rows,
                     uint8_t *classes)
{
    const int width = w->image.grid.width;
    CPLErrorReset();
    if (GDALRasterIO(GDALGetRasterBand(from->file.dataset, 1), GF_Read, 0, y - from->rows.first,
                     width, rows, classes, width, rows, GDT_Byte, 0, 0) != CE_None) {
        return hs_error(from->file.path, "free some space and run again",
                        "cannot be read again: %s", db_gdal_complaint());
    }
    return 0;
}

/* ---- mixtures ---- */

/* The rows of the block are judged with those around them; `rows` counts all that there is room
 * for but the halo. `margins` is not used. */
static int resolve_block(struct work *w, const struct block *b)
{
    const int top = b->y > DB_MIXTURES_HALO ? b->y - DB_MIXTURES_HALO : 0;
    const int wanted = b->y + b->rows + DB_MIXTURES_HALO;
    const int bottom = wanted < w->image.grid.height ? wanted : w->image.grid.height;
    const struct db_mixtures_block m = {.planes = b->planes,
                                        .classes = b->classes,
                                        .sure = b->valid,
                                        .width = w->image.grid.width,
                                        .rows = bottom - top,
                                        .first = b->y - top,
                                        .count = b->rows};
    if (db_raster_read(&w->image, top, bottom - top, b->planes, b->valid) != 0 ||
        read_back(w, &w->raw, top, bottom - top, b->classes) != 0) {
        return -1;
    }
    w->resolved += db_mixtures_resolve(&w->mixtures, &m, b->reject);
    return db_raster_write(&w->settled.file, b->y - w->settled.rows.first, b->rows, b->reject);
}

/* ---- the sieve ---- */

/* The rows of the block as they are, and those around them, as far as the band that was sieved,
 * `seen`, has them. Without a sieve it has none, and there are no specks. */
static struct db_specks_block around(const struct work *w, const struct block *b,
                                     struct db_rows seen)
{
    const int top = b->y - DB_SPECKS_HALO > seen.first ? b->y - DB_SPECKS_HALO : seen.first;
    const int wanted = b->y + b->rows + DB_SPECKS_HALO;
    const int bottom = wanted < seen.end ? wanted : seen.end;
    const size_t from = (size_t)(top - seen.first) * (size_t)w->image.grid.width;
    return (struct db_specks_block){.planes = b->planes,
                                    .before = w->before + from,
                                    .after = w->band + from,
                                    .width = w->image.grid.width,
                                    .rows = bottom - top,
                                    .first = b->y - top,
                                    .count = b->rows};
}

static bool has_specks(const struct work *w, const struct db_specks_block *s)
{
    const size_t end = (size_t)s->rows * (size_t)s->width;
    for (size_t at = 0; at < end; at++) {
        if (db_specks_has(s, w->is_spared, at)) {
            return true;
        }
    }
    return false;
}

/* `classes` becomes what is written. */
static int settle_specks(struct work *w, const struct block *b, struct db_rows seen)
{
    const struct db_specks_block s = around(w, b, seen);
    const size_t count = (size_t)b->rows * (size_t)s.width;
    if (has_specks(w, &s) &&
        db_raster_read(&w->image, b->y - s.first, s.rows, b->planes, b->valid) != 0) {
        return -1;
    }
    w->sieved_pixels += db_specks_settle(&w->net, w->is_spared, &s, b->classes);
    for (size_t i = 0; i < count; i++) {
        w->written[b->classes[i]]++;
    }
    return 0;
}

static void keep_classes(struct work *w, const struct block *b)
{
    const size_t count = (size_t)b->rows * (size_t)w->image.grid.width;
    keep_for_report(w, b);
    if (w->options->picture) {
        for (size_t i = 0; i < count; i++) {
            b->planes[i] = (float)b->classes[i];
            b->valid[i] = b->classes[i] != DB_CLASS_NODATA;
        }
        db_preview_add(&w->classes, 0, b->y, b->rows, w->image.grid.width, b->planes, b->valid);
    }
}

/* A block of the band that was sieved, `seen`. */
static int finish_block(struct work *w, const struct block *b, struct db_rows seen)
{
    if (settle_specks(w, b, seen) != 0) {
        return -1;
    }
    keep_classes(w, b);
    return db_row_writer_add(&w->writer, b->rows, b->classes);
}

/* Rows that are sieved together; the blocks of the band have at most `b->rows` rows. */
static int finish_band(struct work *w, struct block *b, struct db_rows band)
{
    const int most = b->rows;
    const struct db_rows seen =
        db_rows_around(band, db_sieve_margin(w->speck_pixels), &w->image.grid);
    const int rows = seen.end - seen.first, width = w->image.grid.width;
    if (read_back(w, w->before_sieve, seen.first, rows, w->band) != 0) {
        return -1;
    }
    memcpy(w->before, w->band, (size_t)rows * (size_t)width);
    int result = db_sieve(w->band, width, rows, w->speck_pixels, w->options->out);
    for (b->y = band.first; result == 0 && b->y < band.end; b->y += most) {
        b->rows = b->y + most < band.end ? most : band.end - b->y;
        result = finish_block(w, b, seen);
    }
    b->rows = most;
    return result;
}

static int finish(struct work *w, struct block *b, int rows)
{
    const size_t width = (size_t)w->image.grid.width;
    const size_t margin = (size_t)db_sieve_margin(w->speck_pixels);
    w->band = malloc((DB_SIEVE_ROWS + 2 * margin) * width);
    w->before = malloc((DB_SIEVE_ROWS + 2 * margin) * width);
    if (!w->band || !w->before) {
        return hs_error(w->options->out, NULL, "out of memory");
    }
    struct hs_progress progress;
    hs_progress_begin(&progress, "sieve", (uint64_t)(w->own.end - w->own.first));
    int result = 0;
    b->rows = rows;
    for (int y = w->own.first; result == 0 && y < w->own.end; y += DB_SIEVE_ROWS) {
        const int end = y + DB_SIEVE_ROWS < w->own.end ? y + DB_SIEVE_ROWS : w->own.end;
        result = finish_band(w, b, (struct db_rows){y, end});
        hs_progress_update(&progress, (uint64_t)(end - w->own.first));
    }
    hs_progress_end(&progress);
    return result == 0 ? db_row_writer_end(&w->writer) : result;
}

static void free_block(struct block *b)
{
    free(b->planes);
    free(b->valid);
    free(b->classes);
    free(b->reject);
    free(b->margins);
}

static int alloc_block(const struct work *w, struct block *b, size_t count)
{
    const bool wants_margins = w->options->sure > 0.5;
    *b = (struct block){malloc((size_t)w->net.input_count * count * sizeof(float)),
                        malloc(count),
                        malloc(count),
                        malloc(count),
                        wants_margins ? malloc(count * sizeof(float)) : NULL,
                        0,
                        0};
    if (b->planes && b->valid && b->classes && b->reject && (b->margins || !wants_margins)) {
        return 0;
    }
    free_block(b);
    return hs_error(w->image.name, NULL, "out of memory");
}

/* What the report counts. */
struct counted {
    struct db_judge judge;
    uint64_t counts[256], rejected, resolved;
};

static struct counted counted_so_far(const struct work *w)
{
    struct counted c = {.judge = w->judge, .rejected = w->rejected, .resolved = w->resolved};
    memcpy(c.counts, w->counts, sizeof c.counts);
    return c;
}

static void count_as(struct work *w, const struct counted *c)
{
    w->judge = c->judge;
    w->rejected = c->rejected;
    w->resolved = c->resolved;
    memcpy(w->counts, c->counts, sizeof w->counts);
}

struct pass {
    const char *label;
    int rows; /* of a block, at most */
    int (*work)(struct work *w, const struct block *b);
};

static int for_blocks(struct work *w, struct block *b, const struct pass *pass, struct db_rows part,
                      struct hs_progress *progress)
{
    int result = 0;
    for (b->y = part.first; result == 0 && b->y < part.end; b->y += pass->rows) {
        b->rows = b->y + pass->rows < part.end ? pass->rows : part.end - b->y;
        result = pass->work(w, b);
        hs_progress_update(progress, (uint64_t)(b->y + b->rows));
    }
    return result;
}

/* Call the pass with each block of the rows. Only own rows are counted. */
static int for_all_blocks(struct work *w, struct block *b, const struct pass *pass,
                          struct db_rows rows)
{
    struct hs_progress progress;
    hs_progress_begin(&progress, pass->label, (uint64_t)rows.end);
    const struct db_rows before = {rows.first, w->own.first}, behind = {w->own.end, rows.end};
    const struct counted nothing = counted_so_far(w);
    int result = for_blocks(w, b, pass, before, &progress);
    count_as(w, &nothing);
    result = result == 0 ? for_blocks(w, b, pass, w->own, &progress) : result;
    const struct counted own = counted_so_far(w);
    result = result == 0 ? for_blocks(w, b, pass, behind, &progress) : result;
    count_as(w, &own);
    hs_progress_end(&progress);
    return result;
}

static int segment(struct work *w)
{
    const struct db_grid *grid = &w->image.grid;
    const size_t bytes = db_feature_bytes(w->image.band_count, w->net.context) + 2 + sizeof(float);
    const int rows = db_raster_block_rows(grid, bytes);
    const size_t held = (size_t)rows + 2 * DB_MIXTURES_HALO;
    const struct pass network = {"segment", rows, segment_block};
    const struct pass mixtures = {"mixtures", rows, resolve_block};
    struct block b;
    if (alloc_block(w, &b, held * (size_t)grid->width) != 0) {
        return -1;
    }
    int result = for_all_blocks(w, &b, &network, w->raw.rows);
    if (result == 0 && w->options->mixtures > 0) {
        result = for_all_blocks(w, &b, &mixtures, w->settled.rows);
    }
    if (result == 0) {
        result = finish(w, &b, rows);
    }
    free_block(&b);
    return result;
}

static int write_picture(const struct work *w)
{
    const struct db_preview *p = &w->original;
    if (!w->options->picture) {
        return 0;
    }
    uint8_t *rgb = malloc(6 * (size_t)p->width * (size_t)p->height);
    if (!rgb) {
        return hs_error(w->options->picture, NULL, "out of memory");
    }
    int result = db_preview_paint_stretched(p, rgb, 0, 2);
    if (result == 0) {
        db_preview_paint_classes(&w->classes, &w->table, rgb, 1, 2);
        result = hs_png_write_rgb(w->options->picture, rgb, 2 * p->width, p->height,
                                  6 * (size_t)p->width);
    }
    free(rgb);
    return result;
}

static int write_report(const struct work *w)
{
    struct db_confusion confusion = {0};
    char path[1024];
    if (!w->options->report) {
        return 0;
    }
    for (size_t i = 0; i < w->exemplars.count; i++) {
        if (w->given[i] < DB_CLASS_MAX) {
            confusion.counts[w->exemplars.items[i].class_index][w->given[i]]++;
        }
    }
    printf("\nExemplars in the segmented image (trained on or not):\n");
    db_confusion_print(stdout, &confusion, &w->table);
    db_confusion_report("exemplars", &confusion, &w->table);
    if (db_report_path(path, sizeof path, w->options->report, "confusion.csv") != 0 ||
        db_confusion_write(path, &confusion, &w->table) != 0) {
        return -1;
    }
    return db_error_regions_write(
        w->options->report, w->exemplars.items, w->given, w->exemplars.count, w->exemplars.regions,
        w->exemplars.region_count, (int)w->options->square, &w->image.grid, &w->table);
}

/* The classes as they stand in the raster, then how far to believe them. */
static void print_counts(struct work *w)
{
    db_class_counts_print(&w->table, w->written);
    printf("mixtures: %llu pixels took the class of the larger share\n",
           (unsigned long long)w->resolved);
    hs_report_put("mixtures", w->resolved);
    printf("sieve: %llu pixels took the class around them, in regions of fewer than %d pixels\n",
           (unsigned long long)w->sieved_pixels, w->speck_pixels);
    hs_report_object("sieve");
    hs_report_put("pixels", w->sieved_pixels);
    hs_report_put("speck_pixels", w->speck_pixels);
    hs_report_close();
    db_judge_report(&w->judge, w->image.name, &w->table, w->counts);
    if (w->options->reject) {
        printf("rejected: %llu pixels of %llu became %s; %llu outside the range, %llu unsure\n",
               (unsigned long long)w->rejected, (unsigned long long)w->judge.pixels,
               w->options->reject, (unsigned long long)w->judge.outside,
               (unsigned long long)w->judge.unsure);
        hs_report_object("rejected");
        hs_report_put("pixels", w->rejected);
        hs_report_put("outside", w->judge.outside);
        hs_report_put("unsure", w->judge.unsure);
        hs_report_put("became", w->options->reject);
        hs_report_close();
    }
}

static int run(struct work *w)
{
    const double start = db_cost_seconds();
    const bool is_ready = prepare(w) == 0;
    if (is_ready && w->options->strips.plan) {
        return write_plan(w) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    const bool is_written = is_ready && segment(w) == 0 && db_raster_commit(&w->out) == 0;
    db_raster_abort(&w->raw.file);
    db_raster_abort(&w->settled.file);
    if (!is_written) {
        db_raster_abort(&w->out);
        return HS_EXIT_FAILED;
    }
    print_counts(w);
    hs_report_put("width_px", w->image.grid.width);
    hs_report_put("height_px", w->own.end - w->own.first);
    hs_report_put("network_s", w->seconds);
    const double megapixels =
        1e-6 * (double)w->image.grid.width * (double)(w->raw.rows.end - w->raw.rows.first);
    printf("network: %.2f Mpixel in %.3f s on one core, %.1f Mpixel/s\n", megapixels, w->seconds,
           megapixels / w->seconds);
    db_cost_report(db_cost_seconds() - start);
    return write_picture(w) != 0 || write_report(w) != 0 ? HS_EXIT_FAILED : HS_EXIT_OK;
}

int db_cmd_segment(int argc, char **argv)
{
    hs_outputs_together();
    struct options options = {.known = {.field = "class"},
                              .square = 64,
                              .sure = 0.5,
                              .mixtures = DB_MIXTURES_TOLERANCE,
                              .sieve = 60,
                              .strips = DB_STRIP_DEFAULTS};
    int exit_code;
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        hs_error("segment", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    w->options = &options;
    if (read_options(&options, argc, argv, &exit_code)) {
        const char *option, *fault = db_strips_fault(&options.strips, options.out, &option);
        exit_code = fault ? hs_options_wrong(&usage, option, fault) : run(w);
    }
    db_row_writer_free(&w->writer);
    free(w->band);
    free(w->before);
    db_preview_free(&w->original);
    db_preview_free(&w->classes);
    db_exemplars_free(&w->exemplars);
    free(w->given);
    db_raster_close(&w->image);
    db_mixtures_free(&w->mixtures);
    db_apply_free(&w->applied);
    db_net_free(&w->net);
    hs_list_free(&options.image.paths);
    hs_list_free(&options.picture_bands);
    hs_list_free(&options.spare);
    hs_list_free(&options.known.ignore);
    free(w);
    return exit_code;
}
