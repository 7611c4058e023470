#include "build_job.h"
#include "build_workers.h"
#include "commands.h"
#include "cost.h"

#include "build/geoid.h"
#include "build/heights.h"
#include "build/manifest.h"
#include "build/part.h"
#include "build/work_sources.h"
#include "bus/table_text.h"
#include "gis/gdal_start.h"
#include "gis/sensor_tag.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/options.h"
#include "hs/report.h"
#include "hs/team.h"
#include "image/codes.h"
#include "image/reader.h"
#include "lm/images.h"
#include "lm/radar_record.h"
#include "lm/sensor.h"
#include "radar/text.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const struct hs_usage usage = {
    "build", "make the database image from classes, reflectivity and terrain",
    "The class raster (of `landmass-db segment` or `correct`) and its reflectivity (of "
    "`landmass-db reflect`)\n"
    "cover the detailed area; the terrain may reach further, and what lies outside the class "
    "raster gets its\n"
    "class from elevation. With --terrain alone the whole image is made so.\n"
    "\n"
    "Terrain is whatever GDAL reads (DTED, SRTM .hgt or .hgt.zip, GeoTIFF ...) in any coordinate "
    "reference\n"
    "system; elevations are above mean sea level. Where files overlap the first one given counts. "
    "Voids most of\n"
    "whose rim is at sea level become sea, others are filled from their rim, and large ones on a "
    "coast are left without data.\n"
    "\n"
    "The same inputs and options always give the same bytes."};

static const struct hs_usage plan_usage = {
    "plan", "cut an image into shards that are made apart",
    "Takes the options of `build` and writes a plan, a text: which files the image is made from, "
    "with their digests,\n"
    "and shards that need a bounded memory each. `landmass-db build --plan P --shard N` makes one, "
    "on any machine that\n"
    "sees the files under the same names, and `landmass-db join` makes the image of them: the same "
    "bytes as `build` makes\n"
    "in one go. Each shard has a key. As long as that is the same, so are its tiles, and it need "
    "not be made again.\n"
    "\n"
    "Reads every input, some of them twice."};

#define OPTION(name, kind, field, low, high, value, help)                                          \
    {                                                                                              \
        name, kind, &s->field, low, high, value, help, false                                       \
    }

/* Keep the options of a command line that a plan shall repeat. */
static int keep_options(struct build_work *work, const struct hs_option *options, size_t count,
                        int argc, char **argv)
{
    static const char *const own[] = {"out", "json", "shards", "memory", "jobs"};
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i] + 2;
        const size_t length = strcspn(name, "=");
        bool is_flag = false, is_own = false;
        for (size_t k = 0; k < count; k++) {
            is_flag = is_flag || (options[k].kind == HS_FLAG && strlen(options[k].name) == length &&
                                  strncmp(options[k].name, name, length) == 0);
        }
        for (size_t k = 0; k < sizeof own / sizeof own[0]; k++) {
            is_own = is_own || (strlen(own[k]) == length && strncmp(own[k], name, length) == 0);
        }
        const bool is_whole = is_flag || name[length] == '=';
        const char *value = is_whole ? "" : argv[++i];
        if (is_own) {
            continue;
        }
        if (work->option_count == BUILD_WORK_OPTIONS_MAX ||
            asprintf(&work->options[work->option_count], "--%s%s%s", name, is_whole ? "" : "=",
                     value) < 0 ||
            strchr(work->options[work->option_count++], '\n')) {
            return hs_error(argv[i], "give fewer options, without line breaks",
                            "cannot be kept in a plan");
        }
    }
    return 0;
}

bool build_job_read(struct build_settings *s, enum build_command command, struct build_work *work,
                    int argc, char **argv, int *exit_code)
{
    const struct hs_option options[] = {
        {"classes", HS_INPUT, &s->classes, 0, 0, "FILE", "class table (docs/classifier.md)",
         command != BUILD_WHOLE},
        {"terrain", HS_INPUTS, &s->terrain, 0, 0, "DEM", "elevation model; may be given again",
         false},
        OPTION("flat", HS_FLAG, is_flat, 0, 0, NULL,
               "instead of terrain: all ground of the class raster lies at --sea-level; the image "
               "says so"),
        OPTION("terrain-unit", HS_TEXT, terrain_unit, 0, 0, "UNIT",
               "of all terrain: m, cm, ft (international), us-ft ...; left out: as the files say, "
               "or m"),
        OPTION("terrain-datum", HS_WORD, terrain_datum, 0, 0, "msl|egm96|egm2008|ellipsoid",
               "what heights of all terrain are above; left out: as the files say, or msl"),
        OPTION("class-raster", HS_INPUT, class_raster, 0, 0, "FILE",
               "class of each pixel, 255: no data"),
        OPTION("class-numbers", HS_FLAG, ignores_names, 0, 0, NULL,
               "take the class raster's numbers for places in the class table, though it names "
               "its classes"),
        OPTION("map", HS_INPUT, map, 0, 0, "FILE",
               "the class raster is somebody's land cover: its codes, each with a class "
               "(docs/import.md)"),
        OPTION("unknown-codes", HS_TEXT, unknown_codes, 0, 0, "NAME",
               "class of codes that the map leaves out, or none; left out: they are an error"),
        OPTION("reflectivity", HS_INPUT, reflectivity, 0, 0, "FILE",
               "reflectivity (gamma, dB) on the class raster's grid; left out: drawn from "
               "the class's distribution"),
        OPTION("radar", HS_INPUT, radar, 0, 0, "FILE",
               "table of the radar that shall look at the image, a text (landmass-radar);\n"
               "left out: the display uses its own"),
        OPTION("bus-table", HS_INPUT, bus_table, 0, 0, "FILE",
               "table of the bus that the display shall hear, a text (docs/bus.md);\nleft out: the "
               "display uses its own"),
        OPTION("compress", HS_CHOICE, compression, 0, 0, IMAGE_COMPRESSION_WORDS,
               "how tiles are stored; none: larger, and the display unpacks nothing"),
        OPTION("sensor", HS_CHOICE, sensor, 0, 0, HS_SENSOR_WORDS,
               "what the image is for: a radar of that band, or the infrared;\nleft out: what the "
               "reflectivity was made for, or the band of --radar, or x"),
        OPTION(
            "heights", HS_INPUT, heights, 0, 0, "FILE",
            "metres of structures and trees above the terrain; left out: the class table's height"),
        OPTION("cut-heights", HS_FLAG, may_cut_heights, 0, 0, NULL,
               "cut structures and trees above 1,000 m to that; otherwise they are an error"),
        OPTION("beside", HS_INPUT, beside, 0, 0, "FILE.lmdb",
               "an image that shall be flown together with this one (landmass-sim --db2);\n"
               "the 16 heights of structures and trees are taken from it"),
        OPTION("targets", HS_INPUT, targets, 0, 0, "FILE",
               "specific targets and their signatures (docs/targets.md); left out: none"),
        OPTION("detail", HS_INPUT, detail, 0, 0, "FILE",
               "footprints of buildings, walls, lines and masts (docs/database.md); left out: "
               "none"),
        OPTION("cell", HS_REAL, cell_m, 0, 10000, "METRES",
               "about this cell size: the nearest of 0.149 m x 2^n;\n"
               "0: the pixel size of the class raster, or else two thirds of the terrain's, or the "
               "next smaller cell"),
        OPTION(
            "shift0", HS_INTEGER, shift0, 0, LM_DB_SHIFT_MAX, "N",
            "cell size as a power of two (docs/FORMATS.md, 1.2): 2^N x 9.3 mm; 0: as --cell says"),
        OPTION("centre", HS_TEXT, centre, 0, 0, "LAT,LON",
               "place worth looking at, degrees; left out: the middle of the class raster or the "
               "terrain"),
        OPTION("trust-inputs", HS_FLAG, trusts_inputs, 0, 0, NULL,
               "go on where an input looks like a mistake; the reasons are warnings then"),
        OPTION("title", HS_TEXT, title, 0, 0, "TEXT", "up to 32 bytes"),
        OPTION("land-class", HS_TEXT, land_class, 0, 0, "NAME",
               "class of ground above sea level outside the class raster (vegetation)"),
        OPTION("water-class", HS_TEXT, water_class, 0, 0, "NAME",
               "class at or below sea level outside the class raster (water)"),
        OPTION("sea-level", HS_REAL, sea_level_m, -1000, 1000, "METRES",
               "below 0 where dry land lies below the sea"),
        OPTION("voids-are-sea", HS_FLAG, voids_are_sea, 0, 0, NULL,
               "every void of the terrain is sea: for models that have no data at sea"),
        OPTION("steep-class", HS_TEXT, steep_class, 0, 0, "NAME",
               "class of steep ground outside the class raster; left out: none"),
        OPTION("steep-degrees", HS_REAL, steep_degrees, 1, 89, "DEGREES", "what counts as steep"),
        OPTION("geoid", HS_REAL, geoid_m, -200, 200, "METRES",
               "height of mean sea level above the WGS-84 ellipsoid, everywhere in the image"),
        OPTION("geoid-grid", HS_INPUT, geoid_grid, 0, 0, "egm96|FILE",
               "its height at each place instead: egm96, which PROJ has, or a raster of metres"),
        OPTION("seed", HS_INTEGER, seed, 0, 4294967295.0, "N", "of the reflectivity's random part"),
        HS_CLASHES_ROW("flat", "terrain"),
        HS_NEEDS_ROW("flat", "class-raster"),
        HS_NEEDS_ROW("terrain-unit", "terrain"),
        HS_NEEDS_ROW("terrain-datum", "terrain"),
        HS_NEEDS_ROW("class-numbers", "class-raster"),
        HS_CLASHES_ROW("class-numbers", "map"),
        HS_NEEDS_ROW("map", "class-raster"),
        HS_NEEDS_ROW("unknown-codes", "map"),
        HS_NEEDS_ROW("reflectivity", "class-raster"),
        HS_NEEDS_ROW("heights", "class-raster"),
        HS_CLASHES_ROW("shift0", "cell"),
        HS_NEEDS_ROW("land-class", "terrain"),
        HS_NEEDS_ROW("water-class", "terrain"),
        HS_NEEDS_ROW("voids-are-sea", "terrain"),
        HS_NEEDS_ROW("steep-class", "terrain"),
        HS_NEEDS_ROW("steep-degrees", "steep-class"),
        HS_CLASHES_ROW("geoid", "geoid-grid"),
        /* The rest is not for every command. */
        {"out", HS_OUTPUT, &s->out, 0, 0, command == BUILD_PLAN ? "FILE.plan" : "FILE.lmdb",
         command == BUILD_PLAN ? "the plan to write" : "the image to write, or the part", true},
        {command == BUILD_PLAN ? "shards" : "shard", HS_INTEGER,
         command == BUILD_PLAN ? &s->shards : &s->shard, command == BUILD_PLAN ? 1 : 0,
         BUILD_SHARDS_MAX, "N",
         command == BUILD_PLAN ? "at least so many" : "make this shard of --plan, from 0 on",
         false},
        {command == BUILD_PLAN ? "memory" : "plan", command == BUILD_PLAN ? HS_INTEGER : HS_INPUT,
         command == BUILD_PLAN ? (void *)&s->memory_mib : (void *)&s->plan,
         command == BUILD_PLAN ? 256 : 0, command == BUILD_PLAN ? 65536 : 0,
         command == BUILD_PLAN ? "MIB" : "FILE.plan",
         command == BUILD_PLAN
             ? "that a shard may need"
             : "plan of `landmass-db plan`: it has all other options, and --shard "
               "says what to make",
         false},
        HS_CLASHES_ROW("plan", "classes|terrain|flat|class-raster"),
        HS_NEEDS_ROW("plan", "shard"),
        HS_NEEDS_ROW("shard", "plan"),
        OPTION("jobs", HS_INTEGER, jobs, 0, HS_TEAM_MAX, "N",
               "processes that make tiles, as far as there are enough; 0: one for each processor"),
        HS_CLASHES_ROW("jobs", "plan"),
    };
    const size_t all = sizeof options / sizeof options[0];
    const size_t count = command == BUILD_WHOLE ? all : command == BUILD_PLAN ? all - 5 : all - 8;
    const struct hs_usage *const help = command == BUILD_PLAN ? &plan_usage : &usage;
    return hs_options_read(help, options, count, argc, argv, exit_code) &&
           (!work || keep_options(work, options, count, argc, argv) == 0);
}

static int usage_error(const char *option, const char *cause)
{
    return hs_error(option, "see landmass-db build --help", "%s", cause);
}

static int parse_centre(const char *text, uint32_t centre[2])
{
    double degrees[2];
    if (hs_numbers(text, ',', degrees, 2) != 2 || !(fabs(degrees[0]) <= 90) ||
        !(fabs(degrees[1]) <= 360)) {
        return usage_error("--centre", "must be LATITUDE,LONGITUDE in degrees");
    }
    centre[0] = (uint32_t)image_bam(degrees[0]);
    centre[1] = (uint32_t)image_bam(degrees[1]);
    return 0;
}

int build_job_check(struct build_settings *s)
{
    if (s->shift0 > 0 && s->shift0 < LM_DB_SHIFT_MIN) {
        return usage_error("--shift0", "must be 4 to 20");
    }
    if (s->title && strlen(s->title) > LM_IMAGE_TITLE_BYTES) {
        return usage_error("--title", "is longer than 32 bytes");
    }
    if (!s->is_flat && s->terrain.count == 0) {
        return usage_error("--terrain", "is missing; --flat puts all ground at sea level");
    }
    return s->centre ? parse_centre(s->centre, s->centre_bam) : 0;
}

static int named_class(const struct db_class_table *table, const char *option, const char *name)
{
    const int k = db_class_find(table, name);
    if (k < 0) {
        char names[512];
        db_class_names(table, names, sizeof names);
        return hs_error(option, "name one of the class table",
                        "there is no class \"%s\" (there are %s)", name, names);
    }
    return k;
}

static int make_rule(struct build_rule *rule, const struct build_settings *s,
                     const struct db_class_table *table)
{
    if (s->is_flat) { /* Nothing is classed from elevation. */
        *rule = (struct build_rule){.steep = -1, .sea_level_m = s->sea_level_m};
        return 0;
    }
    *rule = (struct build_rule){
        .land = named_class(table, "--land-class", s->land_class),
        .water = named_class(table, "--water-class", s->water_class),
        .steep = -1,
        .sea_level_m = s->sea_level_m,
        .steep_tangent = tan(s->steep_degrees * (3.14159265358979323846 / 180.0)),
    };
    if (s->steep_class) {
        rule->steep = named_class(table, "--steep-class", s->steep_class);
    }
    const bool is_missing = s->steep_class && rule->steep < 0;
    return rule->land < 0 || rule->water < 0 || is_missing ? -1 : 0;
}

static void fill_classes(struct lm_classes *to, const struct db_class_table *table)
{
    *to = (struct lm_classes){0};
    for (int i = 0; i < table->count; i++) {
        const struct db_class *c = &table->items[i];
        struct lm_class *e = &to->entry[i];
        memcpy(e->name, c->name, strnlen(c->name, sizeof e->name));
        memcpy(e->colour, c->colour, sizeof e->colour);
        e->kind = (uint8_t)c->kind;
        e->gamma_db_q8 = (int16_t)lround(c->gamma_db * 256.0);
        e->spread_db_q8 = (uint16_t)lround(c->spread_db * 256.0);
        e->height_dm = (uint16_t)lround(c->height_m * 10.0);
        e->looks = (uint16_t)fmax(1.0, round(c->looks));
        e->flags = c->is_natural ? LM_CLASS_NATURAL : 0;
    }
}

_Static_assert((int)HS_SENSOR_X == LM_SENSOR_X && (int)HS_SENSOR_KU == LM_SENSOR_KU &&
                   (int)HS_SENSOR_KA == LM_SENSOR_KA && (int)HS_SENSOR_MMW == LM_SENSOR_MMW &&
                   (int)HS_SENSOR_IR == LM_SENSOR_IR && (int)HS_SENSOR_COUNT == LM_SENSORS,
               "the header's numbers are those of the host");

/* The sensor of the reflectivity raster, the one that was asked for, the radar's, or X. */
static int choose_sensor(const struct build_settings *s, const struct lm_radar *radar,
                         enum hs_sensor *sensor)
{
    const enum hs_sensor asked = s->sensor >= 0 ? (enum hs_sensor)s->sensor
                                 : s->radar     ? (enum hs_sensor)radar->sensor
                                                : HS_SENSOR_X;
    *sensor = asked;
    const int is_untagged = s->reflectivity ? db_sensor_tag_read(s->reflectivity, sensor) : 0;
    if (is_untagged < 0) {
        return -1;
    }
    if (s->sensor >= 0 && asked != *sensor) {
        return hs_error(s->reflectivity, "make it anew with `landmass-db reflect --sensor`",
                        "is for %s, and --sensor asks for %s", hs_sensor_title(*sensor),
                        hs_sensor_title(asked));
    }
    if (s->radar && (int)*sensor != radar->sensor) {
        return hs_error(s->radar, "give a radar of that band, or other reflectivity",
                        "is a radar of %s, and the image is for %s",
                        hs_sensor_title((enum hs_sensor)radar->sensor), hs_sensor_title(*sensor));
    }
    const bool is_assumed = s->sensor < 0 && (is_untagged || (!s->reflectivity && !s->radar));
    printf("sensor: %s%s\n", hs_sensor_title(*sensor),
           is_assumed ? " (assumed; no tag " DB_SENSOR_ITEM " and no --sensor says another)" : "");
    return 0;
}

static int read_table(struct build_context *b, const struct build_settings *s)
{
    if (choose_sensor(s, &b->radar, &b->sensor) != 0 ||
        db_class_table_read(&b->table, s->classes) != 0 ||
        db_class_table_choose(&b->table, s->classes, b->sensor) != 0) {
        return -1;
    }
    if (b->table.count > LM_DB_CLASS_NONE) {
        return hs_error(s->classes, "join some of them", "has %d classes; an image holds up to %d",
                        b->table.count, LM_DB_CLASS_NONE);
    }
    fill_classes(&b->classes, &b->table);
    build_facing_classes(&b->facing, &b->classes, b->table.count);
    return make_rule(&b->rule, s, &b->table);
}

/* Pixel size that matters to the grid: latitude, or longitude as the zone widens it. */
static double pixel_bam(const struct image_area *area, double latitude_bam, double longitude_bam)
{
    int64_t latitude;
    uint32_t longitude;
    image_area_centre(area, &latitude, &longitude);
    return fmin(latitude_bam, longitude_bam / (1 << lm_db_zone((fx_bam_t)latitude)));
}

static double cover_pixel_bam(const struct resample_cover *c)
{
    return pixel_bam(&c->area, c->pixel_latitude_bam, c->pixel_longitude_bam);
}

/* Distance of posts that keeps a model's crests: two thirds of its pixel. Posts as far apart as the
 * pixels lie beside them. */
static double terrain_posts_bam(const struct terrain_layer *layer)
{
    return pixel_bam(&layer->area, layer->pixel_latitude_bam, layer->pixel_longitude_bam) * 2 / 3;
}

/* The longest cell that can hold an edge which people have drawn. Beyond it a border follows the
 * pixels of a raster, and a town would be made of them. */
#define STRAIGHT_CELL_MAX_M 40.0

static void let_all_borders_bend(struct lm_classes *classes)
{
    for (int i = 0; i < LM_DB_CLASSES; i++) {
        struct lm_class *c = &classes->entry[i];
        c->flags |= c->name[0] != 0 ? LM_CLASS_NATURAL : 0;
    }
}

static int choose_shift0(const struct build_context *b, const struct build_settings *s)
{
    if (s->shift0 > 0) {
        return (int)s->shift0;
    }
    if (s->cell_m > 0) {
        return (int)lround(log2(s->cell_m / IMAGE_METRES_PER_BAM));
    }
    double pixel = b->cover.classes.dataset ? cover_pixel_bam(&b->cover) : HUGE_VAL;
    for (int i = 0; !b->cover.classes.dataset && i < b->terrain.layer_count; i++) {
        pixel = fmin(pixel, terrain_posts_bam(&b->terrain.layers[i]));
    }
    const int shift = build_plan_level(0, pixel);
    return shift < LM_DB_SHIFT_MIN   ? LM_DB_SHIFT_MIN
           : shift > LM_DB_SHIFT_MAX ? LM_DB_SHIFT_MAX
                                     : shift;
}

/* Cut cells that are larger than the class raster's pixels, so that none of these is passed over.
 */
static int choose_parts(const struct build_context *b, uint8_t shift0)
{
    enum { PARTS_MAX = 32 };
    const double pixel = b->cover.classes.dataset ? cover_pixel_bam(&b->cover) : HUGE_VAL;
    int parts = 1;
    while (parts < PARTS_MAX && ldexp(1.0, shift0) / parts > 1.0001 * pixel) {
        parts *= 2;
    }
    return parts;
}

static int make_plan(struct build_context *b, const struct build_settings *s)
{
    const int shift0 = choose_shift0(b, s);
    if (shift0 < LM_DB_SHIFT_MIN || shift0 > LM_DB_SHIFT_MAX) {
        return hs_error("--cell", "choose 0.15 to 9768", "there are no cells of %g m", s->cell_m);
    }
    struct build_extent extents[HS_LIST_MAX + 1];
    const int layers = b->terrain.layer_count;
    const bool has_cover = b->cover.classes.dataset != NULL;
    int finest = LM_DB_SHIFT_MAX;
    for (int i = 0; i < layers; i++) {
        const struct terrain_layer *layer = &b->terrain.layers[i];
        const int level = build_plan_level((uint8_t)shift0, terrain_posts_bam(layer));
        extents[i] = (struct build_extent){layer->area, level < 0 ? 0 : level};
        finest = extents[i].level < finest ? extents[i].level : finest;
    }
    for (int i = 0; i < layers && !has_cover; i++) {
        /* Cells finer than the terrain were asked for: then it fills them. */
        extents[i].level -= finest;
    }
    extents[layers] = (struct build_extent){b->cover.area, 0};
    if (build_plan_make(&b->plan, (uint8_t)shift0, extents, layers + 1) != 0) {
        return -1;
    }
    for (int i = 0; i < layers; i++) {
        b->terrain_level[i] = extents[i].level;
    }
    if (ldexp(IMAGE_METRES_PER_BAM, shift0) > STRAIGHT_CELL_MAX_M) {
        let_all_borders_bend(&b->classes);
    }
    b->parts = choose_parts(b, (uint8_t)shift0);
    terrain_set_cell(&b->terrain, (uint8_t)shift0);
    resample_cover_set_cell(&b->cover, (uint8_t)shift0);
    return 0;
}

enum { POSTS_LEAST = 3 }; /* of terrain along the longer side of the class raster; UNSOURCED */

static int check_overlap(const struct build_context *b, const struct build_settings *s)
{
    if (!b->cover.classes.dataset || s->is_flat) {
        return 0;
    }
    const struct terrain_layer *finest = NULL;
    for (int i = 0; i < b->terrain.layer_count; i++) {
        const struct terrain_layer *layer = &b->terrain.layers[i];
        if (image_areas_meet(&layer->area, &b->cover.area) &&
            (!finest || layer->pixel_latitude_bam < finest->pixel_latitude_bam)) {
            finest = layer;
        }
    }
    const struct image_area *a = &b->cover.area;
    if (finest) {
        const double posts = fmax((double)(a->north - a->south) / finest->pixel_latitude_bam,
                                  (double)a->width / finest->pixel_longitude_bam);
        return posts >= POSTS_LEAST
                   ? 0
                   : hs_doubt(s->trusts_inputs, finest->mosaic.members[0].path,
                              "give a finer --terrain",
                              "has %.1f posts along the whole of %s: the ground would be a plane",
                              posts, s->class_raster);
    }
    return hs_error(s->class_raster, "give a --terrain that covers this area",
                    "lies outside all terrain (it covers %.4f to %.4f north, %.4f to %.4f east)",
                    image_degrees(a->south), image_degrees(a->north),
                    image_longitude_degrees(a->west),
                    image_longitude_degrees(a->west + (uint32_t)a->width));
}

/* The display takes images together that have one table of heights. */
static int take_heights(struct build_context *b, const char *beside)
{
    struct image other;
    if (image_open(&other, beside) != 0) {
        return -1;
    }
    enum { TOP = 15 }; /* the highest */
    const int own = b->classes.height_dm[TOP], theirs = other.db.classes.height_dm[TOP];
    memcpy(b->classes.height_dm, other.db.classes.height_dm, sizeof b->classes.height_dm);
    image_close(&other);
    if (own > theirs + theirs / 50) {
        hs_warn(beside,
                "make the image with the highest structures first, and the others --beside it",
                "has heights of up to %g m: what is up to %g m high here is cut to that",
                theirs / 10.0, own / 10.0);
    }
    return 0;
}

/* Will the display take the image together with the one that it is made beside? */
static int check_beside(const struct build_context *b, const char *beside)
{
    struct image other;
    if (image_open(&other, beside) != 0) {
        return -1;
    }
    const struct lm_db own = {.sensor = (uint8_t)b->sensor, .classes = b->classes};
    const int status = lm_images_judge(&other.db, &own);
    image_close(&other);
    if (status == LM_OK) {
        return 0;
    }
    return hs_error(beside,
                    status == LM_ERR_SENSOR ? "give the --sensor of that image"
                                            : "give the class table that it was built with",
                    "%s", status == LM_ERR_SENSOR ? "is for another band" : "has other classes");
}

static int choose_heights(struct build_context *b)
{
    struct build_heights *h = malloc(sizeof *h);
    if (!h) {
        return hs_error("--heights", NULL, "out of memory");
    }
    const int result = build_heights_survey(h, b);
    if (result == 0) {
        build_heights_choose(h, b->classes.height_dm);
    }
    free(h);
    return result;
}

/* `is_known`: a plan has looked at which numbers or codes occur. */
static int read_codes(struct build_context *b, const struct build_settings *s, bool is_known)
{
    if (!s->map) {
        return s->class_raster ? resample_cover_set_numbers(&b->cover, s->ignores_names, is_known)
                               : 0;
    }
    if (db_code_map_read(&b->codes, s->map, &b->table) != 0) {
        return -1;
    }
    if (s->unknown_codes) {
        const bool is_none = strcmp(s->unknown_codes, "none") == 0;
        b->codes.unknown_class =
            is_none ? DB_CLASS_NODATA : named_class(&b->table, "--unknown-codes", s->unknown_codes);
        if (b->codes.unknown_class < 0) {
            return -1;
        }
    }
    if (is_known) {
        b->cover.codes = &b->codes;
        return 0;
    }
    return resample_cover_set_codes(&b->cover, &b->codes);
}

/* Without a class raster there are no structures that could have spots, which are corners to a
 * radar. */
static void set_laws(struct build_context *b)
{
    const double pixel_m =
        b->sensor == HS_SENSOR_IR ? 0 : b->cover.pixel_latitude_bam * IMAGE_METRES_PER_BAM;
    for (int i = 0; i < b->table.count; i++) {
        db_reflect_law_init(&b->laws[i], &b->table.items[i], pixel_m);
    }
}

/* All that the image covers, eastwards from the first part. */
static struct image_area whole_area(const struct build_context *b)
{
    struct image_area all = b->cover.area;
    for (int i = 0; i < b->terrain.layer_count; i++) {
        const struct image_area *a = &b->terrain.layers[i].area;
        if (all.width == 0) {
            all = *a;
            continue;
        }
        const int64_t west = (int32_t)(a->west - all.west);
        const int64_t first = west < 0 ? west : 0;
        const int64_t end = west + a->width > all.width ? west + a->width : all.width;
        all.south = a->south < all.south ? a->south : all.south;
        all.north = a->north > all.north ? a->north : all.north;
        all.west += (uint32_t)first;
        all.width = end - first > IMAGE_BAM_ROUND ? IMAGE_BAM_ROUND : end - first;
    }
    return all;
}

/* The grid of the geoid into b->geoid, and its height in the middle for the header. */
static int make_geoid(struct build_context *b, const struct build_settings *s)
{
    const struct image_area area = whole_area(b);
    if (!s->geoid_grid) {
        printf("geoid: %g m above WGS-84 everywhere (%s)\n", s->geoid_m,
               s->geoid_m != 0 ? "as told" : "assumed; --geoid-grid egm96 knows better");
        return 0;
    }
    return build_geoid_make(&b->geoid, &area, s->geoid_grid) == 0
               ? build_geoid_pages_make(&b->geoid_pages, &b->geoid, &area, s->geoid_grid)
               : -1;
}

static int open_rasters(struct build_context *b, const struct build_settings *s,
                        const struct build_work *work)
{
    const struct terrain_options options = {.sea_level_m = s->sea_level_m,
                                            .voids_are_sea = s->voids_are_sea,
                                            .vertical = {s->terrain_unit, s->terrain_datum},
                                            .are_trusted = s->trusts_inputs,
                                            .are_judged = work != NULL,
                                            .have_no_voids = work && !work->has_voids};
    if (resample_cover_open(&b->cover, &b->table, s->class_raster, s->reflectivity, s->heights) !=
            0 ||
        (!work && resample_cover_judge(&b->cover, s->trusts_inputs) != 0)) {
        return -1;
    }
    return read_codes(b, s, work != NULL) == 0 ? terrain_open(&b->terrain, &s->terrain, &options)
                                               : -1;
}

/* The levels must be those of the plan: keys and shards are made for them. */
static int check_grid(const struct build_context *b, const struct build_settings *s,
                      const struct build_work *work)
{
    char digest[IMAGE_SHA256_TEXT];
    build_work_grid(&b->plan, digest);
    return strcmp(digest, work->grid_sha256) == 0
               ? 0
               : hs_error(s->plan, "make the plan again", "the inputs are not those of the plan");
}

/* Facings are wanted where cells of the finest level are made. */
static int make_tables(struct build_context *b, const struct build_settings *s,
                       const struct build_work *work, const struct build_shard *shard)
{
    if (work && check_grid(b, s, work) != 0) {
        return -1;
    }
    if (shard) {
        const struct image_area within = build_work_reach(b, shard);
        if (build_facing_survey(&b->facing, &b->classes, &b->cover, &b->plan, &within) != 0) {
            return -1;
        }
    }
    int result = 0;
    if (work) {
        memcpy(b->classes.height_dm, work->heights_dm, sizeof b->classes.height_dm);
    } else {
        result = choose_heights(b);
        result = result == 0 && s->beside ? take_heights(b, s->beside) : result;
    }
    return result == 0 && s->beside && !shard ? check_beside(b, s->beside) : result;
}

int build_job_open(struct build_context *b, const struct build_settings *s,
                   const struct build_work *work, const struct build_shard *shard)
{
    b->seed = (uint32_t)s->seed;
    if ((s->radar && radar_text_read(&b->radar, s->radar) != 0) || read_table(b, s) != 0 ||
        open_rasters(b, s, work) != 0) {
        return -1;
    }
    if ((!work && check_overlap(b, s) != 0) || (!shard && make_geoid(b, s) != 0) ||
        make_plan(b, s) != 0) {
        return -1;
    }
    set_laws(b);
    const struct build_detail_settings detail = {b->plan.shift0, b->seed, &b->table, b->laws,
                                                 &b->facing};
    if (s->detail && build_detail_read(&b->detail, s->detail, &detail) != 0) {
        return -1;
    }
    return make_tables(b, s, work, shard);
}

void build_job_close(struct build_context *b)
{
    build_facing_free(&b->facing);
    resample_cover_close(&b->cover);
    terrain_close(&b->terrain);
    build_detail_free(&b->detail);
    free((void *)b->geoid_pages.data);
}

/* The bus table as a record. Its name goes with it, and there is less room than in the text. */
static int read_bus_table(struct build_extras *e, const char *path)
{
    struct bus_table table;
    if (bus_table_load(&table, path) != 0) {
        return -1;
    }
    if (strlen(table.name) >= LM_BUS_PROFILE_NAME_SIZE) {
        return hs_error(path, "shorten it", "the profile's name has more than %d bytes",
                        LM_BUS_PROFILE_NAME_SIZE - 1);
    }
    e->bus_bytes = lm_bus_pack(&table.profile, e->bus);
    return 0;
}

int build_job_extras(struct build_extras *e, const struct build_settings *s)
{
    const char *const path = s->targets;
    *e = (struct build_extras){.targets_bytes = NULL};
    if (s->bus_table && read_bus_table(e, s->bus_table) != 0) {
        return -1;
    }
    if (!path) {
        return 0;
    }
    if (build_targets_read(&e->targets, path) != 0) {
        return -1;
    }
    const bool has_signatures = e->targets.signatures.count > 0;
    e->targets_bytes = build_targets_section(&e->targets, &e->targets_size);
    if (has_signatures) {
        e->signatures_bytes = build_signatures_section(&e->targets.signatures, &e->signatures_size);
    }
    return e->targets_bytes && (!has_signatures || e->signatures_bytes)
               ? 0
               : hs_error(path, NULL, "out of memory");
}

void build_job_free_extras(struct build_extras *e)
{
    build_targets_free(&e->targets);
    free(e->targets_bytes);
    free(e->signatures_bytes);
}

static int write_targets_inputs(FILE *out, const char *path,
                                const struct build_signatures *signatures)
{
    int result = build_manifest_file(out, "targets", path);
    for (uint32_t i = 0; i < signatures->count && result == 0; i++) {
        result = build_manifest_file(out, "signature", signatures->paths[i]);
    }
    return result;
}

static int write_inputs(FILE *out, const struct build_context *b, const struct build_settings *s,
                        const struct build_signatures *signatures)
{
    const struct resample_plane *planes[3] = {&b->cover.classes, &b->cover.reflectivity,
                                              &b->cover.heights};
    const char *const roles[3] = {"class-raster", "reflectivity", "heights"};
    int result = build_manifest_file(out, "classes", s->classes);
    if (result == 0 && s->map) {
        result = build_manifest_file(out, "map", s->map);
    }
    for (int i = 0; i < 3 && result == 0; i++) {
        if (planes[i]->dataset) {
            result = build_manifest_dataset(out, roles[i], planes[i]->dataset);
        }
    }
    if (s->is_flat) {
        fprintf(out, "terrain: none, all ground lies at %g m\n", s->sea_level_m);
    }
    for (int i = 0; i < b->terrain.layer_count; i++) {
        const struct terrain_mosaic *m = &b->terrain.layers[i].mosaic;
        for (int k = 0; k < m->member_count && result == 0; k++) {
            result = build_manifest_dataset(out, "terrain", m->members[k].dataset);
            fprintf(out, "terrain-heights: %s\n", m->members[k].vertical.said);
        }
    }
    if (result == 0 && s->detail) {
        result = build_manifest_file(out, "detail", s->detail);
    }
    if (result == 0 && s->radar) {
        result = build_manifest_file(out, "radar", s->radar);
    }
    if (result == 0 && s->bus_table) {
        result = build_manifest_file(out, "bus-table", s->bus_table);
    }
    if (result == 0 && s->geoid_grid) {
        result = strcmp(s->geoid_grid, "egm96") == 0
                     ? fprintf(out, "geoid-grid: egm96\n") < 0
                     : build_manifest_file(out, "geoid-grid", s->geoid_grid);
    }
    return result == 0 && s->targets ? write_targets_inputs(out, s->targets, signatures) : result;
}

/* The whole text; the caller frees it. NULL with the error reported. */
char *build_job_manifest(const struct build_context *b, const struct build_settings *s,
                         const struct build_signatures *signatures)
{
    char *text = NULL, options[704], heights[160];
    image_heights_text(b->classes.height_dm, heights, sizeof heights);
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    if (!out) {
        hs_error("manifest", NULL, "out of memory");
        return NULL;
    }
    snprintf(options, sizeof options,
             "sensor: %s\nshift0: %d\nfacings: %d\nland-class: %s\nwater-class: %s\nsea-level: %g "
             "m\nvoids-are-sea: "
             "%d\nsteep-class: %s\n"
             "steep-degrees: %g\nunknown-codes: %s\nheights:%s\n",
             hs_sensor_name(b->sensor), b->plan.shift0, b->facing.facings, s->land_class,
             s->water_class, s->sea_level_m, s->voids_are_sea,
             s->steep_class ? s->steep_class : "none", s->steep_degrees,
             s->unknown_codes ? s->unknown_codes : "refused", heights);
    const struct build_manifest head = {options, &b->table, b->seed};
    build_manifest_head(out, &head);
    const int result = write_inputs(out, b, s, signatures);
    if (fclose(out) != 0 || result != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static int32_t geoid_q6(const struct build_context *b, const struct build_settings *s,
                        const uint32_t centre[2])
{
    return b->geoid.rows > 0
               ? lm_geoid_height_m_q6(&b->geoid, (struct lm_position){centre[0], centre[1]})
               : (int32_t)lround(s->geoid_m * 64.0);
}

static void fill_header(struct lm_image_header *h, const struct build_context *b,
                        const struct build_settings *s, const uint32_t centre[2])
{
    const struct build_counts *n = &b->counts;
    const double land_m2 = build_sum_value(&n->land_area_m2);
    const double mean_m =
        land_m2 > 0 ? build_sum_value(&n->land_metres_m2) / land_m2 : s->sea_level_m;
    h->mean_elevation_m_q6 = (int32_t)lround(mean_m * 64.0);
    h->geoid_m_q6 = geoid_q6(b, s, centre);
    h->sensor = (uint8_t)b->sensor;
    h->centre_latitude = centre[0];
    h->centre_longitude = centre[1];
    if (s->title) {
        memcpy(h->title, s->title, strlen(s->title));
    }
}

static void choose_centre(const struct build_context *b, const struct build_settings *s,
                          uint32_t centre[2])
{
    if (s->centre) {
        memcpy(centre, s->centre_bam, sizeof s->centre_bam);
        return;
    }
    struct image_area area = b->cover.area;
    for (int i = 0; area.width == 0 && i < b->terrain.layer_count; i++) {
        area = b->terrain.layers[i].area;
    }
    int64_t latitude;
    image_area_centre(&area, &latitude, &centre[1]);
    centre[0] = (uint32_t)latitude;
}

static void set_town_gains(struct build_context *b)
{
    for (int i = 0; i < LM_DB_CLASSES; i++) {
        struct lm_class *c = &b->classes.entry[i];
        for (int level = 0; level < b->plan.level_count && c->kind == LM_KIND_STRUCTURE; level++) {
            c->lod_gain_db_q8[level] = (int16_t)lround(256 * build_towns_gain_db(&b->towns, level));
        }
    }
}

static int check_heights(const struct build_context *b, const struct build_settings *s)
{
    if (b->counts.heights_cut == 0 || s->may_cut_heights) {
        return 0;
    }
    return hs_error(s->heights ? s->heights : s->classes,
                    "correct them, or give --cut-heights to cut them to 1,000 m",
                    "%" PRIu64 " samples of structures or trees are higher than 1,000 m",
                    b->counts.heights_cut);
}

int build_job_write(struct build_context *b, const struct build_settings *s,
                    const struct build_made *made, const char *manifest,
                    const struct build_extras *extras, struct build_report *report)
{
    uint32_t centre[2];
    choose_centre(b, s, centre);
    struct image_writer w;
    const struct lm_image_header header = {.shift0 = b->plan.shift0,
                                           .lod_count = b->plan.level_count,
                                           .band_count = b->plan.band_count,
                                           .entry_count = b->plan.entry_count};
    if (image_writer_begin(&w, s->out, &header, &b->classes, b->plan.bands) != 0) {
        return -1;
    }
    if (build_pyramid_join(b, made, &w, &report->levels) != 0 || check_heights(b, s) != 0) {
        image_writer_abort(&w);
        return -1;
    }
    if (w.header.record_count == 0) {
        image_writer_abort(&w);
        return hs_error(s->out, "check the inputs with gdalinfo",
                        "no cell of the image would hold data");
    }
    fill_header(&w.header, b, s, centre);
    set_town_gains(b);
    w.classes = b->classes;
    w.compression = (enum image_compression)s->compression;
    w.targets = (struct image_bytes){extras->targets_bytes, extras->targets_size};
    w.signatures = (struct image_bytes){extras->signatures_bytes, extras->signatures_size};
    w.geoid = (struct image_bytes){b->geoid.rows > 0 ? &b->geoid : NULL, sizeof b->geoid};
    w.geoid_pages = b->geoid_pages;
    w.detail = (struct image_bytes){b->detail.section_bytes ? b->detail.section : NULL,
                                    b->detail.section_bytes};
    uint8_t radar[LM_RADAR_RECORD_BYTES];
    lm_radar_pack(&b->radar, radar);
    w.radar = (struct image_bytes){s->radar ? radar : NULL, sizeof radar};
    w.bus = (struct image_bytes){extras->bus_bytes ? extras->bus : NULL, extras->bus_bytes};
    char *whole = NULL;
    if (asprintf(&whole, "%sheights-cut: %" PRIu64 "\n", manifest, b->counts.heights_cut) < 0) {
        image_writer_abort(&w);
        return hs_error(s->out, NULL, "out of memory");
    }
    const int status = image_writer_end(&w, whole);
    free(whole);
    if (status != 0) {
        return -1;
    }
    report->image_bytes = w.header.image_bytes;
    report->entry_count = w.header.entry_count;
    report->record_count = w.header.record_count;
    report->mean_elevation_q6 = w.header.mean_elevation_m_q6;
    return 0;
}

static void report_level(int level, double cell_m, uint32_t tiles)
{
    hs_report_object(NULL);
    hs_report_put("level", level);
    hs_report_put("cell_m", cell_m);
    hs_report_put("tiles", tiles);
    hs_report_close();
}

static void print_levels(const struct build_context *b, const struct build_report *r)
{
    hs_report_array("levels");
    for (int level = 0; level < b->plan.level_count; level++) {
        const double cell_m = ldexp(IMAGE_METRES_PER_BAM, b->plan.shift0 + level);
        printf("level %-2d cell %8.2f m  %7" PRIu32 " tiles\n", level, cell_m,
               r->levels.tiles[level]);
        report_level(level, cell_m, r->levels.tiles[level]);
    }
    hs_report_close();
    hs_report_put("tiles", r->record_count);
    hs_report_put("entries", r->entry_count);
    hs_report_put("bytes", r->image_bytes);
    printf("image %" PRIu64 " tiles of %" PRIu64 " entries, %" PRIu64 " bytes\n", r->record_count,
           r->entry_count, r->image_bytes);
}

static void report_class(const char *name, uint64_t cells, double area_m2, uint64_t faced)
{
    hs_report_object(NULL);
    hs_report_put("name", name);
    hs_report_put("cells", cells);
    hs_report_put("area_km2", area_m2 * 1e-6);
    hs_report_put("cells_with_facing", faced);
    hs_report_close();
}

static void print_classes(const struct build_context *b)
{
    const struct build_counts *n = &b->counts;
    uint64_t cells = 0;
    hs_report_array("classes");
    for (int k = 0; k < b->table.count; k++) {
        uint64_t of_class = n->cells[k];
        double area_m2 = build_sum_value(&n->area_m2[k]);
        for (int i = 0; b->facing.first[k] > 0 && i < b->facing.facings; i++) {
            of_class += n->cells[b->facing.first[k] + i];
            area_m2 += build_sum_value(&n->area_m2[b->facing.first[k] + i]);
        }
        printf("class %-2d %-16s %12" PRIu64 " cells  %12.3f km2", k, b->table.items[k].name,
               of_class, area_m2 * 1e-6);
        if (b->table.items[k].kind == DB_KIND_STRUCTURE) {
            printf("  in %d facings, %.0f %% of them", b->facing.facings,
                   of_class ? 100.0 * (double)(of_class - n->cells[k]) / (double)of_class : 0);
        }
        printf("\n");
        report_class(b->table.items[k].name, of_class, area_m2, of_class - n->cells[k]);
        cells += of_class;
    }
    hs_report_close();
    hs_report_put("facings", b->facing.facings);
    hs_report_put("cells", cells);
    hs_report_put("cells_by_elevation", n->cells_by_rule);
    hs_report_put("cells_beyond_terrain", n->cells_beyond_terrain);
    printf("cells %" PRIu64 ", of them %" PRIu64 " classed from elevation, %" PRIu64
           " beyond the terrain\n",
           cells, n->cells_by_rule, n->cells_beyond_terrain);
}

static void print_voids(const struct terrain *t)
{
    uint64_t pixels[3] = {0, 0, 0};
    for (int i = 0; i < t->layer_count; i++) {
        const struct terrain_voids *v = &t->layers[i].voids;
        for (size_t k = 0; k < v->region_count; k++) {
            pixels[v->regions[k].filling] += v->regions[k].pixels;
        }
    }
    hs_report_object("voids");
    hs_report_put("interpolated_posts", pixels[TERRAIN_INTERPOLATED]);
    hs_report_put("sea_posts", pixels[TERRAIN_SEA]);
    hs_report_put("left_void_posts", pixels[TERRAIN_LEFT_VOID]);
    hs_report_close();
    printf("voids %" PRIu64 " posts interpolated, %" PRIu64 " taken as sea, %" PRIu64
           " left without data\n",
           pixels[TERRAIN_INTERPOLATED], pixels[TERRAIN_SEA], pixels[TERRAIN_LEFT_VOID]);
    if (pixels[TERRAIN_LEFT_VOID] > 0) {
        hs_warn("--terrain",
                "give another model of them after this one, or --voids-are-sea if they are",
                "%" PRIu64 " posts in large voids were left without data",
                pixels[TERRAIN_LEFT_VOID]);
    }
}

static void print_report(const struct build_context *b, const struct build_report *r,
                         double seconds)
{
    char heights[160];
    print_levels(b, r);
    print_classes(b);
    if (b->terrain.layer_count > 0) {
        print_voids(&b->terrain);
    } else {
        printf("no terrain: all ground lies at %g m\n", b->rule.sea_level_m);
    }
    image_heights_text(b->classes.height_dm, heights, sizeof heights);
    printf("heights m%s; %" PRIu64 " samples cut to 1,000 m\n", heights, b->counts.heights_cut);
    image_heights_report(b->classes.height_dm);
    hs_report_put("heights_cut", b->counts.heights_cut);
    hs_report_put("mean_land_elevation_m", r->mean_elevation_q6 / 64.0);
    printf("mean elevation of land %.1f m\n", r->mean_elevation_q6 / 64.0);
    printf("done in %.1f s\n", seconds);
}

static void print_detail(const struct build_context *b, const char *path)
{
    const uint64_t outside = b->detail.count - b->counts.detail_items;
    printf("detail %" PRIu32 " items in %" PRIu32 " tiles\n", b->detail.count,
           b->detail.record_count);
    hs_report_object("detail");
    hs_report_put("items", b->detail.count);
    hs_report_put("tiles", b->detail.record_count);
    hs_report_put("outside", outside);
    hs_report_close();
    if (outside > 0) {
        hs_warn(path, "give --class-raster or --terrain that reaches there",
                "%" PRIu64 " items lie outside the map's finest level and are not shown", outside);
    }
}

/* DTED keeps whole columns in a block: a row of tiles over fourteen degrees of level 2 stays in
 * memory. */
static const int64_t cache_bytes = (int64_t)384 << 20;

void build_job_print(const struct build_context *b, const struct build_settings *s,
                     const struct build_extras *extras, const struct build_report *report,
                     double seconds)
{
    if (s->targets) {
        printf("targets %" PRIu32 ", signatures %" PRIu32 "\n", extras->targets.count,
               extras->targets.signatures.count);
        hs_report_put("targets", extras->targets.count);
        hs_report_put("signatures", extras->targets.signatures.count);
    }
    if (s->detail) {
        print_detail(b, s->detail);
    }
    print_report(b, report, seconds);
}

/* The image, its tiles made by workers or, where there are few or `jobs` is 1, here. */
static int write_image(struct build_context *b, const struct build_settings *s,
                       struct build_work *work, const struct build_extras *extras,
                       struct build_report *report)
{
    const int jobs = s->jobs > 0 ? (int)s->jobs : (int)hs_team_threads();
    const int shards = build_workers_shards(b->plan.entry_count, jobs);
    if (shards > 1) {
        return build_workers_image(b, s, shards, jobs, work, extras, report);
    }
    if (build_facing_survey(&b->facing, &b->classes, &b->cover, &b->plan, NULL) != 0) {
        return -1;
    }
    char *manifest = build_job_manifest(b, s, &extras->targets.signatures);
    const int result = manifest ? build_job_write(b, s, NULL, manifest, extras, report) : -1;
    free(manifest);
    return result;
}

static int build(const struct build_settings *s, struct build_work *work)
{
    const double start = db_cost_seconds();
    GDALSetCacheMax64(cache_bytes);
    struct build_context *b = calloc(1, sizeof *b);
    if (!b) {
        return hs_error(s->out, NULL, "out of memory");
    }
    struct build_report report = {0};
    struct build_extras extras;
    int result = build_job_extras(&extras, s) == 0 ? build_job_open(b, s, NULL, NULL) : -1;
    if (result == 0) {
        result = write_image(b, s, work, &extras, &report);
    }
    if (result == 0) {
        build_job_print(b, s, &extras, &report, db_cost_seconds() - start);
    }
    build_job_free_extras(&extras);
    build_job_close(b);
    free(b);
    return result;
}

/* ---- a shard of a plan ---- */

int build_job_read_plan(struct build_work *work, struct build_settings *s, const char *path)
{
    char *words[BUILD_WORK_OPTIONS_MAX + 1] = {(char *)"build"};
    int exit_code;
    if (build_work_read(work, path) != 0) {
        return -1;
    }
    for (int i = 0; i < work->option_count; i++) {
        words[i + 1] = work->options[i];
        if (strcmp(words[i + 1], "--version") == 0 || strncmp(words[i + 1], "--help", 6) == 0) {
            return hs_error(path, "make it again with `landmass-db plan`",
                            "has an option that is none of `build`");
        }
    }
    return build_job_read(s, BUILD_FROM_PLAN, NULL, work->option_count + 1, words, &exit_code) &&
                   build_job_check(s) == 0
               ? 0
               : hs_error(path, "make it again with `landmass-db plan`", "has wrong options");
}

static int make_part(struct build_context *b, const struct build_settings *s,
                     const struct build_work *work, int number)
{
    const struct build_work_shard *shard = &work->shards[number];
    struct build_part_writer w;
    if (build_part_begin(&w, s->out, &shard->place, (uint32_t)number, (uint32_t)work->shard_count,
                         shard->key) != 0) {
        return -1;
    }
    const struct build_sink sink = {&w, build_part_put};
    if (build_pyramid_shard(b, &shard->place, &sink) != 0) {
        build_part_abort(&w);
        return -1;
    }
    const uint32_t tiles = w.head.tile_count;
    if (build_part_end(&w, b) != 0) {
        return -1;
    }
    printf("shard %d of %d: %" PRIu32 " tiles, %" PRIu64 " bytes\n", number, work->shard_count,
           tiles, w.head.part_bytes);
    hs_report_put("shard", number);
    hs_report_put("shards", work->shard_count);
    hs_report_put("tiles", tiles);
    hs_report_put("bytes", w.head.part_bytes);
    hs_report_put("key", shard->key);
    return 0;
}

static int build_shard(struct build_context *b, const struct build_settings *from,
                       const struct build_work *work)
{
    const int number = (int)from->shard;
    if (number >= work->shard_count) {
        return hs_error("--shard", "choose one of the plan", "there are %d shards in %s, from 0 on",
                        work->shard_count, from->plan);
    }
    const struct build_shard *place = &work->shards[number].place;
    bool *counts = calloc((size_t)work->source_count + 1, sizeof *counts);
    int result =
        counts ? build_job_open(b, from, work, place) : hs_error(from->plan, NULL, "out of memory");
    if (result == 0) {
        build_work_choose(work, b, place, counts);
        result = build_work_check_sources(work, counts);
    }
    free(counts);
    return result == 0 ? make_part(b, from, work, number) : -1;
}

int build_job_shard(const struct build_settings *given)
{
    const double start = db_cost_seconds();
    GDALSetCacheMax64((int64_t)BUILD_WORK_CACHE_MIB << 20);
    struct build_work work;
    struct build_settings s = build_job_defaults();
    struct build_context *b = calloc(1, sizeof *b);
    int result = b ? build_job_read_plan(&work, &s, given->plan)
                   : hs_error(given->out, NULL, "out of memory");
    if (result == 0) {
        s.plan = given->plan;
        s.shard = given->shard;
        s.out = given->out;
        result = build_shard(b, &s, &work);
        if (result != 0) {
            hs_error(given->plan, "see the line before", "shard %ld could not be made",
                     given->shard);
        }
        build_job_close(b);
        build_work_free(&work);
    }
    if (result == 0) {
        db_cost_report(db_cost_seconds() - start);
    }
    hs_list_free(&s.terrain);
    free(b);
    return result;
}

struct build_settings build_job_defaults(void)
{
    return (struct build_settings){.land_class = "vegetation",
                                   .water_class = "water",
                                   .steep_degrees = 25.0,
                                   .seed = 1,
                                   .compression = IMAGE_COMPRESSION_LZ4,
                                   .sensor = -1,
                                   .shard = -1,
                                   .shards = 1,
                                   .memory_mib = 1024};
}

int db_cmd_build(int argc, char **argv)
{
    struct build_settings s = build_job_defaults();
    static struct build_work work;
    int exit_code;
    if (build_job_read(&s, BUILD_WHOLE, &work, argc, argv, &exit_code)) {
        if (!s.plan && !s.classes) {
            exit_code = hs_options_wrong(&usage, "--classes", "is required");
        } else if (s.plan) {
            exit_code = build_job_shard(&s) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
        } else {
            exit_code = build_job_check(&s) != 0 ? HS_EXIT_USAGE
                        : build(&s, &work) != 0  ? HS_EXIT_FAILED
                                                 : HS_EXIT_OK;
        }
    }
    build_work_free(&work);
    hs_list_free(&s.terrain);
    return exit_code;
}
