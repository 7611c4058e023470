/* landmass-db reflect: a class raster in, a reflectivity raster out. */
#include "commands.h"
#include "cost.h"
#include "pixel_places.h"
#include "radar_image.h"
#include "source_options.h"

#include "gis/class_raster.h"
#include "gis/preview.h"
#include "gis/sensor_tag.h"
#include "gis/strips.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/png.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "reflectivity/reflect.h"

#include <math.h>
#include <stdlib.h>

enum { NODATA_DB = -9999 };

static const struct hs_usage usage = {
    .command = "reflect",
    .summary = "give each pixel its radar reflectivity",
    .description =
        "Writes the constant-gamma reflectivity of each pixel in dB (Float32 GeoTIFF, -9999 for "
        "no\n"
        "data) from its class, by one of Heaton's two methods, what lies between them, or from "
        "radar imagery,\n"
        "for a radar at X band or another --sensor of the class table:\n\n"
        "  assign  random values with the class's mean, spread, limits and texture. Predictable, "
        "and borders\n"
        "          between classes soften where their limits overlap. The value depends on the "
        "seed and the\n"
        "          pixel's place on the ground alone: other rasters and levels have the same "
        "there.\n"
        "          Where grown classes of ground and trees meet, a pixel has the mean power of "
        "those "
        "around it.\n"
        "  fields  as assign, but what differs between fields, roofs and yards is the image's "
        "brightness, and not\n"
        "          an invented pattern of parcels: each field has a level of its own and ends "
        "where "
        "it ends.\n"
        "          Needs --image. Water, and pixels without data in the image, are as by assign.\n"
        "  adjust  the image's brightness is kept as detail: the mean and spread of each class's "
        "brightness\n"
        "          are moved to its gamma_db and spread_db. Water becomes uniform. More detailed, "
        "but what is\n"
        "          bright to the eye need not be bright to the radar. Needs --image. Pixels of a "
        "class where\n"
        "          the image has no data get the class's mean. An image put together from several "
        "pictures has\n"
        "          edges where they meet: --patches makes each class alike in all of them.\n"
        "  radar   radar imagery (--radar), as Sentinel-1's gamma0, which is the constant-gamma "
        "reflectivity.\n"
        "          Speckle is lessened by mean powers over --multilook pixels. Its band has other "
        "levels than\n"
        "          the sensor's: it is assumed that they differ by one number of dB in each class "
        "(--calibrate).\n"
        "          Water is uniform as above. Pixels without radar data are drawn as by assign, "
        "and counted.\n\n"
        "Speckle is not added: the display unit does that. For the infrared the value is the "
        "share of 8..12 um\n"
        "radiation that is reflected, in dB; `landmass-db infrared` makes pictures of what is "
        "emitted.\n\n"
        "A large raster is made in strips (--shards, --shard), on whatever machine. The other "
        "methods "
        "look at\n"
        "all pixels of a class before they give one its value, and do without.\n\n"
        "Example:\n"
        "  landmass-db reflect --class-raster scene-classes.tif --classes heaton6.classes \\\n"
        "      --method adjust --image scene.tif --out scene-gamma.tif",
};

struct options {
    struct db_image_options image;
    struct hs_list bands;
    const char *class_raster, *classes, *out, *picture, *patches;
    int sensor, method, calibrate; /* enum hs_sensor, method, calibration */
    struct radar_options radar;
    long seed;
    bool ignores_names;
    struct db_strip_options strips;
};

static bool read_options(struct options *o, int argc, char **argv, int *exit_code)
{
    struct hs_option table[] = {
        HS_NEEDS_ROW("patches", "method=fields|method=adjust"),
        HS_NEEDS_ROW("bands", "method=fields|method=adjust"),
        HS_NEEDS_ROW("image", "method=fields|method=adjust"),
        HS_NEEDS_ROW("nodata", "image"),
        HS_NEEDS_ROW("black-is-nodata", "image"),
        HS_NEEDS_ROW("radar", "method=radar"),
        HS_NEEDS_ROW("radar-unit", "radar"),
        HS_NEEDS_ROW("radar-band", "radar"),
        HS_NEEDS_ROW("incidence", "radar"),
        HS_NEEDS_ROW("multilook", "radar"),
        HS_NEEDS_ROW("calibrate", "radar"),
        HS_NEEDS_ROW("trust-inputs", "radar"),
        {"class-raster", HS_INPUT, &o->class_raster, 0, 0, "FILE",
         "The class raster, from `segment` or `correct`.", true},
        DB_CLASSES_OPTION(o->classes),
        DB_CLASS_NUMBERS_OPTION(o->ignores_names),
        {"out", HS_OUTPUT, &o->out, 0, 0, "FILE", "Where the reflectivity raster goes.", false},
        {"sensor", HS_CHOICE, &o->sensor, 0, 0, HS_SENSOR_WORDS,
         "What the values are for: a radar at X, Ku, Ka band or millimetre waves, or thermal "
         "infrared.",
         false},
        {"method", HS_CHOICE, &o->method, 0, 0, "assign|fields|adjust|radar",
         "How values come about; see above.", false},
        {"patches", HS_INPUT, &o->patches, 0, 0, "FILE",
         "With fields and adjust: numbers of the pictures that the image is made of, from\n"
         "`import --out-mask`.",
         false},
        {"radar", HS_INPUT, &o->radar.path, 0, 0, "FILE",
         "With radar: the imagery, in any CRS and pixel size.", false},
        {"radar-unit", HS_CHOICE, &o->radar.unit, 0, 0, "db|linear",
         "What it holds: dB or linear power.", false},
        {"radar-band", HS_INTEGER, &o->radar.band, 1, 64, "N",
         "Its band, from 1; vertical polarisation is that of most radars.", false},
        {"incidence", HS_REAL, &o->radar.incidence_deg, 1, 80, "DEGREES",
         "It holds sigma0, seen at this angle from the vertical; default: it holds gamma0.", false},
        {"multilook", HS_INTEGER, &o->radar.multilook, 1, 99, "N",
         "Side, an odd number of its pixels, of the squares whose mean power is taken.", false},
        {"calibrate", HS_CHOICE, &o->calibrate, 0, 0, "class|scene|none",
         "class: each class gets the mean of the class table; scene: one number of dB for all;\n"
         "none: as it is.",
         false},
        {"trust-inputs", HS_FLAG, &o->radar.is_trusted, 0, 0, NULL,
         "Go on where the radar imagery looks like a mistake; the reasons are warnings then.",
         false},
        {"bands", HS_LIST, &o->bands, 0, 0, "N,N",
         "Bands of the image whose mean is the brightness, from 1; default all.", false},
        {"seed", HS_INTEGER, &o->seed, 0, 2147483647, "N", "Seed of the random values.", false},
        {"picture", HS_OUTPUT, &o->picture, 0, 0, "FILE",
         "Also write a PNG, black at the lowest and white at the highest mean of the classes.",
         false},
        DB_STRIP_OPTIONS(&o->strips),
        HS_NEEDS_ROW("shards", "method=assign"),
        HS_CLASHES_ROW("shards", "picture"),
        DB_IMAGE_OPTIONS(&o->image),
    };
    enum { COUNT = sizeof table / sizeof table[0] };
    table[COUNT - 3].is_required = false; /* The image: two methods look at it. */
    return hs_options_read(&usage, table, COUNT, argc, argv, exit_code);
}

/* In the order of the words of --method and --calibrate. */
enum method { ASSIGN, FIELDS, ADJUST, RADAR };
enum calibration { BY_CLASS, BY_SCENE, NOT_AT_ALL };

enum {
    PATCHES = 65536,
    PATCH_PIXELS_MIN = 50 /* of a class, for a mean and spread of their own */
};

/* What came out, for each class. */
struct outcome {
    double sum[DB_CLASS_MAX], square[DB_CLASS_MAX], low[DB_CLASS_MAX], high[DB_CLASS_MAX];
    double count[DB_CLASS_MAX];
};

struct block {
    float *pixels; /* planes of the image, or one plane of scratch */
    uint8_t *valid, *class_valid, *classes;
    uint8_t *around; /* owned: the rows of `classes`, with one before and one behind */
    float *values;   /* brightness, or dB of the radar; then dB of the result */
    float *patches;
    int y, rows;
};

struct work {
    const struct options *options;
    enum method method;
    struct radar_image radar;
    struct db_raster patches;
    struct db_brightness *by_patch; /* owned: of each patch; NULL: there are none */
    double scene_offset_db;         /* of radar imagery */
    uint64_t filled, alone;         /* pixels without radar data; in patches too small */
    struct db_class_table table;
    struct db_reflect_law laws[DB_CLASS_MAX];
    struct db_raster classes, image;
    struct db_class_numbers numbers;
    bool uses_band[HS_LIST_MAX * 8];
    int bands_used;
    struct db_raster_out out;
    struct db_row_writer writer;
    struct db_rows own; /* rows that are written */
    struct db_preview preview;
    struct pixel_places places;
    struct db_brightness brightness;
    struct outcome outcome;
    struct block block;
    int block_rows;
};

static bool has_patterns(const struct work *w)
{
    return w->method == ASSIGN || w->method == FIELDS;
}

static bool has_image(const struct work *w)
{
    return w->method == FIELDS || w->method == ADJUST;
}

static int choose_bands(struct work *w)
{
    const struct hs_list *list = &w->options->bands;
    const int most = (int)sizeof w->uses_band;
    if (w->image.band_count > most) {
        return hs_error(w->image.name, "name some with --bands", "has more than %d bands", most);
    }
    for (int b = 0; b < w->image.band_count && list->count == 0; b++) {
        w->uses_band[b] = true;
    }
    for (int i = 0; i < list->count; i++) {
        const int b = atoi(list->items[i]) - 1;
        if (b < 0 || b >= w->image.band_count) {
            return hs_error("--bands", NULL, "`%s` is not a band of 1..%d", list->items[i],
                            w->image.band_count);
        }
        w->uses_band[b] = true;
    }
    for (int b = 0; b < w->image.band_count; b++) {
        w->bands_used += w->uses_band[b];
    }
    return 0;
}

static int open_image(struct work *w)
{
    if (w->method == RADAR) {
        return radar_image_open(&w->radar, &w->options->radar, &w->classes.grid);
    }
    if (!has_image(w)) {
        return 0;
    }
    if (db_image_open(&w->image, &w->options->image) != 0) {
        return -1;
    }
    if (!db_grid_is_same(&w->image.grid, &w->classes.grid)) {
        return hs_error(w->image.name, "give the image the classes were made from",
                        "lies on another grid than %s", w->options->class_raster);
    }
    return choose_bands(w);
}

static int open_patches(struct work *w)
{
    const char *path = w->options->patches;
    if (!path) {
        return 0;
    }
    if (db_raster_open_one(&w->patches, path) != 0) {
        return -1;
    }
    if (w->patches.band_count != 1 || !db_grid_is_same(&w->patches.grid, &w->classes.grid)) {
        return hs_error(path, "give the --out-mask of the import that made the image",
                        "has %d bands, or lies on another grid than %s", w->patches.band_count,
                        w->options->class_raster);
    }
    w->by_patch = calloc(PATCHES, sizeof *w->by_patch);
    return w->by_patch ? 0 : hs_error(path, NULL, "out of memory");
}

static int alloc_block(struct work *w)
{
    const size_t planes = has_image(w) ? (size_t)w->image.band_count : 1;
    const size_t pixel = (planes + 2) * sizeof(float) + 3;
    w->block_rows = db_raster_block_rows(&w->classes.grid, pixel);
    const size_t count = (size_t)w->block_rows * (size_t)w->classes.grid.width;
    struct block *b = &w->block;
    b->pixels = malloc(planes * count * sizeof *b->pixels);
    b->values = malloc(count * sizeof *b->values);
    b->patches = malloc(count * sizeof *b->patches);
    b->valid = malloc(count);
    b->class_valid = malloc(count);
    b->around = malloc(count + 2 * (size_t)w->classes.grid.width);
    if (!b->pixels || !b->values || !b->patches || !b->valid || !b->class_valid || !b->around) {
        return hs_error(w->options->out, NULL, "out of memory");
    }
    b->classes = b->around + w->classes.grid.width;
    return 0;
}

static int create_output(struct work *w)
{
    const struct options *o = w->options;
    const struct db_grid grid = db_strips_grid(&w->classes.grid, w->own);
    if (db_raster_create(&w->out, o->out, &grid, GDT_Float32, NODATA_DB) != 0) {
        return -1;
    }
    db_sensor_tag_write(&w->out, (enum hs_sensor)o->sensor);
    db_strips_tag(&w->out, &o->strips);
    return db_row_writer_init(&w->writer, &w->out);
}

static int prepare(struct work *w)
{
    const struct options *o = w->options;
    const enum hs_sensor sensor = (enum hs_sensor)o->sensor;
    if (db_class_table_read(&w->table, o->classes) != 0 ||
        db_class_table_choose(&w->table, o->classes, sensor) != 0 ||
        db_class_raster_open(&w->classes, &w->numbers, o->class_raster, &w->table,
                             o->ignores_names) != 0 ||
        open_image(w) != 0 || open_patches(w) != 0 || alloc_block(w) != 0 ||
        pixel_places_open(&w->places, &w->classes.grid, o->class_raster) != 0) {
        return -1;
    }
    const double pixel_m = sensor == HS_SENSOR_IR ? 0 : w->places.pixel_m; /* Spots are corners. */
    for (int i = 0; i < w->table.count; i++) {
        db_reflect_law_init(&w->laws[i], &w->table.items[i], pixel_m);
        w->outcome.low[i] = INFINITY;
        w->outcome.high[i] = -INFINITY;
    }
    if (o->picture && db_preview_init(&w->preview, &w->classes.grid, 1) != 0) {
        return -1;
    }
    if (db_strips_rows(&o->strips, &w->classes.grid, &w->own) != 0) {
        return -1;
    }
    return o->strips.plan ? 0 : create_output(w);
}

/* A pixel is drawn by its class and those of the pixels around it. */
static int write_plan(const struct work *w)
{
    const struct db_raster *rasters[] = {&w->classes};
    const char *plain[] = {w->options->classes};
    const struct db_strip_sources sources = {rasters, 1, plain, 1, 1};
    return db_strips_write_plan(&w->options->strips, &w->classes.grid, &sources);
}

static int read_patches(struct work *w)
{
    struct block *b = &w->block;
    if (!w->by_patch) {
        return 0;
    }
    if (db_raster_read(&w->patches, b->y, b->rows, b->patches, b->valid) != 0) {
        return -1;
    }
    for (size_t i = 0; i < (size_t)b->rows * (size_t)w->classes.grid.width; i++) {
        const float n = b->valid[i] ? b->patches[i] : 0;
        if (!(n >= 0 && n < (float)PATCHES && n == floorf(n))) {
            return hs_error(w->options->patches, "give the --out-mask of an import",
                            "holds %g, and numbers of patches are whole, 0 to %d", (double)n,
                            PATCHES - 1);
        }
        b->patches[i] = n;
    }
    return 0;
}

/* Classes of a row beside the block; none beyond the raster. */
static int read_beside(struct work *w, int y, uint8_t *classes)
{
    struct block *b = &w->block;
    if (y < 0 || y >= w->classes.grid.height) {
        memset(classes, DB_CLASS_NODATA, (size_t)w->classes.grid.width);
        return 0;
    }
    return db_class_raster_read(&w->classes, &w->numbers, y, 1, b->values, b->class_valid, classes);
}

/* The row before the block and the one behind it. */
static int read_around(struct work *w)
{
    struct block *b = &w->block;
    uint8_t *const behind = b->classes + (size_t)b->rows * (size_t)w->classes.grid.width;
    return read_beside(w, b->y - 1, b->around) == 0 ? read_beside(w, b->y + b->rows, behind) : -1;
}

/* Classes of the block, and in `values` brightness or radar (NAN where there is none). */
static int read_block(struct work *w)
{
    struct block *b = &w->block;
    const size_t count = (size_t)b->rows * (size_t)w->classes.grid.width;
    if ((has_patterns(w) && read_around(w) != 0) ||
        db_class_raster_read(&w->classes, &w->numbers, b->y, b->rows, b->values, b->class_valid,
                             b->classes) != 0) {
        return -1;
    }
    if (w->method == RADAR) {
        return radar_image_rows(&w->radar, b->y, b->rows, b->values);
    }
    if (!has_image(w)) {
        return 0;
    }
    if (read_patches(w) != 0 ||
        db_raster_read(&w->image, b->y, b->rows, b->pixels, b->valid) != 0) {
        return -1;
    }
    for (size_t i = 0; i < count; i++) {
        double sum = 0;
        for (int band = 0; band < w->image.band_count; band++) {
            sum += w->uses_band[band] ? (double)b->pixels[(size_t)band * count + i] : 0;
        }
        b->values[i] = b->valid[i] ? (float)(sum / w->bands_used) : (float)NAN;
    }
    return 0;
}

static int measure_block(struct work *w)
{
    const struct block *b = &w->block;
    for (size_t i = 0; i < (size_t)b->rows * (size_t)w->classes.grid.width; i++) {
        if (b->classes[i] != DB_CLASS_NODATA && !isnan(b->values[i])) {
            db_brightness_add(&w->brightness, b->classes[i], (double)b->values[i]);
            if (w->by_patch) {
                db_brightness_add(&w->by_patch[(int)b->patches[i]], b->classes[i],
                                  (double)b->values[i]);
            }
        }
    }
    return 0;
}

/* The brightness of the class in the pixel's own patch, or in all where there is too little. */
static const struct db_brightness *brightness_about(struct work *w, size_t i)
{
    const struct block *b = &w->block;
    if (!w->by_patch) {
        return &w->brightness;
    }
    const struct db_brightness *patch = &w->by_patch[(int)b->patches[i]];
    const bool is_enough =
        b->patches[i] > 0 && patch->count[b->classes[i]] >= (double)PATCH_PIXELS_MIN;
    w->alone += !is_enough;
    return is_enough ? patch : &w->brightness;
}

static double adjusted(struct work *w, size_t i)
{
    const int c = w->block.classes[i];
    return db_reflect_adjust(&w->table.items[c], brightness_about(w, i), c,
                             (double)w->block.values[i]);
}

/* What stands for the pattern of objects: the image, if it is to. */
static double object_of(struct work *w, size_t i)
{
    const int c = w->block.classes[i];
    return w->method == ASSIGN || w->table.items[c].kind == DB_KIND_WATER
               ? (double)NAN
               : db_brightness_deviations(brightness_about(w, i), c, (double)w->block.values[i]);
}

static double class_mean(const struct work *w, int c)
{
    return w->brightness.sum[c] / w->brightness.count[c];
}

static double offset_of(const struct work *w, int c)
{
    const enum calibration how = (enum calibration)w->options->calibrate;
    return how == NOT_AT_ALL ? 0
           : how == BY_SCENE ? w->scene_offset_db
                             : w->table.items[c].gamma_db - class_mean(w, c);
}

/* One offset whose error over all pixels is least in square. */
static void find_scene_offset(struct work *w)
{
    double sum = 0, count = 0;
    for (int c = 0; c < w->table.count; c++) {
        if (w->brightness.count[c] > 0 && w->table.items[c].kind != DB_KIND_WATER) {
            sum += w->brightness.count[c] * (w->table.items[c].gamma_db - class_mean(w, c));
            count += w->brightness.count[c];
        }
    }
    w->scene_offset_db = count > 0 ? sum / count : 0;
}

/* The pixel's class and those around it decide. */
static double assigned(struct work *w, size_t i)
{
    const size_t width = (size_t)w->classes.grid.width, x = i % width;
    uint8_t around[9];
    for (size_t n = 0; n < 9; n++) {
        const bool is_beyond = (n % 3 == 0 && x == 0) || (n % 3 == 2 && x + 1 == width);
        around[n] = is_beyond ? DB_CLASS_NODATA : w->block.around[i + n / 3 * width + n % 3 - 1];
    }
    return db_reflect_assign_among(w->laws, around, object_of(w, i), (uint64_t)w->options->seed,
                                   w->places.row[x]);
}

static double value_of(struct work *w, size_t i)
{
    const struct block *b = &w->block;
    const int c = b->classes[i];
    if (has_patterns(w)) {
        return assigned(w, i);
    }
    const bool is_missing = isnan(b->values[i]);
    w->filled += is_missing;
    if (w->method == RADAR && is_missing) {
        return db_reflect_assign(&w->laws[c], (uint64_t)w->options->seed,
                                 w->places.row[i % (size_t)w->classes.grid.width]);
    }
    if (is_missing || w->table.items[c].kind == DB_KIND_WATER) {
        return w->table.items[c].gamma_db;
    }
    return w->method == RADAR ? (double)b->values[i] + offset_of(w, c) : adjusted(w, i);
}

static void count_value(struct outcome *o, int c, double value)
{
    o->sum[c] += value;
    o->square[c] += value * value;
    o->low[c] = fmin(o->low[c], value);
    o->high[c] = fmax(o->high[c], value);
    o->count[c]++;
}

static int reflect_block(struct work *w)
{
    struct block *b = &w->block;
    const int width = w->classes.grid.width;
    for (size_t i = 0; i < (size_t)b->rows * (size_t)width; i++) {
        if (w->method != ADJUST && i % (size_t)width == 0) {
            pixel_places_row(&w->places, b->y + (int)(i / (size_t)width));
        }
        if (b->classes[i] == DB_CLASS_NODATA) {
            b->values[i] = NODATA_DB;
            continue;
        }
        const double value = value_of(w, i);
        count_value(&w->outcome, b->classes[i], value);
        b->values[i] = (float)value;
    }
    if (w->options->picture) {
        db_preview_add(&w->preview, 0, b->y, b->rows, width, b->values, b->class_valid);
    }
    return db_row_writer_add(&w->writer, b->rows, b->values);
}

static int for_all_blocks(struct work *w, const char *label, int (*work_on)(struct work *))
{
    const int end = w->own.end;
    struct block *b = &w->block;
    struct hs_progress progress;
    hs_progress_begin(&progress, label, (uint64_t)end);
    int result = 0;
    for (b->y = w->own.first; result == 0 && b->y < end; b->y += w->block_rows) {
        b->rows = b->y + w->block_rows < end ? w->block_rows : end - b->y;
        result = read_block(w);
        if (result == 0) {
            result = work_on(w);
        }
        hs_progress_update(&progress, (uint64_t)(b->y + b->rows));
    }
    hs_progress_end(&progress);
    return result;
}

static double class_mean_db(const struct outcome *o, int c)
{
    return o->sum[c] / o->count[c];
}

static double class_spread_db(const struct outcome *o, int c)
{
    const double mean = class_mean_db(o, c);
    return sqrt(fmax(0, o->square[c] / o->count[c] - mean * mean));
}

static void report_class(const struct work *w, int c)
{
    const struct outcome *o = &w->outcome;
    hs_report_object(NULL);
    hs_report_put("name", w->table.items[c].name);
    hs_report_put("pixels", o->count[c]);
    hs_report_put("mean_db", class_mean_db(o, c));
    hs_report_put("spread_db", class_spread_db(o, c));
    hs_report_put("least_db", o->low[c]);
    hs_report_put("greatest_db", o->high[c]);
    hs_report_put("table_mean_db", w->table.items[c].gamma_db);
    hs_report_put("table_spread_db", w->table.items[c].spread_db);
    hs_report_close();
}

static void print_outcome(const struct work *w)
{
    const struct outcome *o = &w->outcome;
    hs_report_array("classes");
    for (int i = 0; i < w->table.count; i++) {
        if (o->count[i] > 0) {
            const double mean = class_mean_db(o, i);
            printf(
                "%-16s %12.0f pixels  mean %7.2f dB (table %g)  spread %5.2f dB (%g)  %7.2f .. "
                "%.2f "
                "dB\n",
                w->table.items[i].name, o->count[i], mean, w->table.items[i].gamma_db,
                class_spread_db(o, i), w->table.items[i].spread_db, o->low[i], o->high[i]);
            report_class(w, i);
        }
    }
    hs_report_close();
}

static void print_radar(const struct work *w)
{
    printf("radar: %.2f of its pixels along a pixel of the class raster, mean power of %ld x %ld\n",
           w->radar.pixels_per_cell, w->options->radar.multilook, w->options->radar.multilook);
    hs_report_put("radar_pixels_per_pixel", w->radar.pixels_per_cell);
    hs_report_put("pixels_without_radar", w->filled);
    hs_report_array("radar_classes");
    for (int c = 0; c < w->table.count; c++) {
        if (w->brightness.count[c] > 0) {
            printf("%-16s %12.0f pixels of radar  mean %7.2f dB  offset %+.2f dB%s\n",
                   w->table.items[c].name, w->brightness.count[c], class_mean(w, c),
                   offset_of(w, c), w->table.items[c].kind == DB_KIND_WATER ? ", uniform" : "");
            hs_report_object(NULL);
            hs_report_put("name", w->table.items[c].name);
            hs_report_put("pixels", w->brightness.count[c]);
            hs_report_put("mean_db", class_mean(w, c));
            hs_report_put("offset_db", offset_of(w, c));
            hs_report_close();
        }
    }
    hs_report_close();
    if (w->options->calibrate != NOT_AT_ALL) {
        printf("assumed: %s differs from this imagery by one number of dB in %s\n",
               hs_sensor_title((enum hs_sensor)w->options->sensor),
               w->options->calibrate == BY_CLASS ? "each class" : "all classes");
    }
    if (w->filled > 0) {
        hs_warn(w->options->radar.path, NULL,
                "%llu pixels have no radar data and are drawn from their class",
                (unsigned long long)w->filled);
    }
}

static void print_patches(const struct work *w)
{
    int count = 0;
    for (int i = 1; i < PATCHES; i++) {
        double pixels = 0;
        for (int c = 0; c < w->table.count; c++) {
            pixels += w->by_patch[i].count[c];
        }
        count += pixels > 0;
    }
    hs_report_put("patches", count);
    hs_report_put("pixels_by_whole_image", w->alone);
    printf(
        "patches: %d; %llu pixels have less than %d of their class in theirs and go by the whole "
        "image\n",
        count, (unsigned long long)w->alone, PATCH_PIXELS_MIN);
}

static int write_picture(const struct work *w)
{
    const struct db_preview *p = &w->preview;
    double low = INFINITY, high = -INFINITY;
    if (!w->options->picture) {
        return 0;
    }
    for (int i = 0; i < w->table.count; i++) {
        if (w->outcome.count[i] > 0) {
            low = fmin(low, w->table.items[i].gamma_db - w->table.items[i].spread_db);
            high = fmax(high, w->table.items[i].gamma_db + w->table.items[i].spread_db);
        }
    }
    uint8_t *rgb = malloc(3 * (size_t)p->width * (size_t)p->height);
    if (!rgb) {
        return hs_error(w->options->picture, NULL, "out of memory");
    }
    db_preview_paint_grey(p, low, high, rgb, 0, 1);
    const int result =
        hs_png_write_rgb(w->options->picture, rgb, p->width, p->height, 3 * (size_t)p->width);
    free(rgb);
    return result;
}

static int run(struct work *w)
{
    const double start = db_cost_seconds();
    const bool is_ready = prepare(w) == 0;
    if (is_ready && w->options->strips.plan) {
        return write_plan(w) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    if (!is_ready || (w->method != ASSIGN && for_all_blocks(w, "brightness", measure_block) != 0)) {
        db_raster_abort(&w->out);
        return HS_EXIT_FAILED;
    }
    find_scene_offset(w);
    if (for_all_blocks(w, "reflect", reflect_block) != 0 || db_row_writer_end(&w->writer) != 0 ||
        db_raster_commit(&w->out) != 0) {
        db_raster_abort(&w->out);
        return HS_EXIT_FAILED;
    }
    print_outcome(w);
    if (w->method == RADAR) {
        print_radar(w);
    }
    if (w->by_patch) {
        print_patches(w);
    }
    hs_report_put("width_px", w->classes.grid.width);
    hs_report_put("height_px", w->own.end - w->own.first);
    db_cost_report(db_cost_seconds() - start);
    return write_picture(w) != 0 ? HS_EXIT_FAILED : HS_EXIT_OK;
}

static const char *fault_of(const struct options *o, const char **option)
{
    *option = o->method == FIELDS ? "--method fields" : "--method adjust";
    if ((o->method == FIELDS || o->method == ADJUST) && o->image.paths.count == 0) {
        return "needs the image for its brightness: name it with --image";
    }
    *option = "--method radar";
    if (o->method == RADAR && !o->radar.path) {
        return "needs the radar imagery: name it with --radar";
    }
    *option = "--radar-unit";
    if (o->method == RADAR && o->radar.unit < 0) {
        return "must say whether the imagery holds db or linear power";
    }
    *option = "--method radar";
    if (o->method == RADAR && o->sensor == HS_SENSOR_IR) {
        return "takes radar imagery, which says nothing of the infrared; use another method";
    }
    *option = "--multilook";
    return o->radar.multilook % 2 == 0 ? "must be odd"
                                       : db_strips_fault(&o->strips, o->out, option);
}

int db_cmd_reflect(int argc, char **argv)
{
    hs_outputs_together();
    struct options options = {
        .seed = 1,
        .strips = DB_STRIP_DEFAULTS,
        .radar = {.unit = -1, .band = 1, .multilook = 3, .incidence_deg = NAN}};
    int exit_code;
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        hs_error("reflect", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    w->options = &options;
    if (read_options(&options, argc, argv, &exit_code)) {
        const char *option, *fault = fault_of(&options, &option);
        w->method = (enum method)options.method;
        exit_code = fault ? hs_options_wrong(&usage, option, fault) : run(w);
    }
    db_row_writer_free(&w->writer);
    free(w->block.pixels);
    free(w->block.values);
    free(w->block.patches);
    free(w->by_patch);
    radar_image_close(&w->radar);
    db_raster_close(&w->patches);
    free(w->block.valid);
    free(w->block.class_valid);
    free(w->block.around);
    db_preview_free(&w->preview);
    pixel_places_close(&w->places);
    db_raster_close(&w->classes);
    db_raster_close(&w->image);
    hs_list_free(&options.image.paths);
    hs_list_free(&options.bands);
    free(w);
    return exit_code;
}
