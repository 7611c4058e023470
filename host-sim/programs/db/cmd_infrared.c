/* landmass-db infrared: a class raster in, pictures of what a thermal camera sees at given hours.
 */
#include "cast_shadow.h"
#include "commands.h"
#include "ground_slope.h"
#include "infrared_curves.h"
#include "pixel_places.h"
#include "source_options.h"

#include "gis/class_raster.h"
#include "gis/preview.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/output_path.h"
#include "hs/png.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "infrared/planck.h"
#include "reflectivity/reflect.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { NODATA = -9999, HOURS_MAX = 48, PATH_SIZE = 1024 };

static const double window_low_um = 8, window_high_um = 12;
static const double zero_celsius = 273.15, degree = 3.14159265358979323846 / 180;

static const struct hs_usage usage = {
    .command = "infrared",
    .summary = "make thermal pictures of a class raster at hours of a day",
    .description =
        "Computes how warm the ground of each class is over a day, from the weather and the "
        "class's emissivity,\n"
        "albedo, conductivity, heat capacity, wetness and roughness, and writes into the folder "
        "--out:\n\n"
        "  infrared-HHMM.tif  for each hour: surface temperature in kelvin, and radiance at 8..12 "
        "um in W/(m2 sr),\n"
        "                     with the sky that the ground reflects (Float32 GeoTIFF, -9999 for no "
        "data)\n"
        "  infrared-HHMM.png  the radiance, white is hot, stretched from its 2nd to its 98th "
        "percentile\n"
        "  infrared.csv       temperature of each class in degrees Celsius every half hour\n"
        "  infrared.png       the same as curves\n\n"
        "Each day is like the one before: what a front or a shower did is not in it. Hours are "
        "local solar time.\n"
        "Within a class places differ in albedo, conductivity and emissivity by its spreads, and "
        "with --terrain\n"
        "in slope, with --shadows in sunshine. Not computed: melting, heat of people, and the air "
        "between the ground "
        "and the camera.\n\n"
        "Example:\n"
        "  landmass-db infrared --class-raster scene-classes.tif --classes heaton6.classes \\\n"
        "      --date 06-21 --hours 4,14 --air 18 --air-range 12 --wind 2 --out scene-infrared",
};

struct options {
    const char *class_raster, *classes, *out, *terrain, *heights;
    struct hs_list hours;
    int month, day;
    double latitude_deg, air_c, air_range, humidity_percent, wind_m_s, cloud, water_c;
    long seed;
    bool ignores_names, has_shadows, trusts_inputs;
};

struct work {
    const struct options *options;
    struct ir_weather weather;
    struct db_class_table table;
    struct db_reflect_law laws[DB_CLASS_MAX]; /* of the emissivity */
    struct ir_class_days *days;               /* owned: of each class */
    struct db_raster classes;
    struct db_class_numbers numbers;
    struct pixel_places places;
    struct ground_slope slope;
    struct cast_shadow shadow;
    double hours[HOURS_MAX];
    int hour_count;
    float *values, *radiance; /* owned: of a block of rows */
    uint8_t *valid, *class_of;
    int block_rows;
};

/* One picture. */
struct shot {
    struct ir_class_hour classes[DB_CLASS_MAX];
    struct ir_air air;
    struct db_raster_out out;
    struct db_preview preview;
    double sum[DB_CLASS_MAX], count[DB_CLASS_MAX];
};

/* Of a year of 365 days: 29 February is its 1 March. */
static const int month_days[12] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

static const char *take_date(void *context, const char *text)
{
    struct options *o = context;
    char end;
    if (sscanf(text, "%2d-%2d%c", &o->month, &o->day, &end) != 2 || o->month < 1 || o->month > 12) {
        return "needs a month and a day, MM-DD";
    }
    const int days = month_days[o->month - 1] + (o->month == 2);
    return o->day >= 1 && o->day <= days ? NULL : "names a day that its month has not";
}

static int day_of_year(const struct options *o)
{
    int day = o->day;
    for (int m = 1; m < o->month; m++) {
        day += month_days[m - 1];
    }
    return day;
}

static bool read_options(struct options *o, int argc, char **argv, int *exit_code)
{
    struct hs_taker date = {take_date, o};
    const struct hs_option table[] = {
        {"class-raster", HS_INPUT, &o->class_raster, 0, 0, "FILE",
         "The class raster, from `segment` or `correct`.", true},
        DB_CLASSES_OPTION(o->classes),
        DB_CLASS_NUMBERS_OPTION(o->ignores_names),
        {"out", HS_FOLDER, &o->out, 0, 0, "FOLDER", "Where the files go; made if need be.", true},
        {"hours", HS_LIST, &o->hours, 0, 0, "H,H",
         "Local solar hours, 0 to less than 24, also 13.5; default 4,14.", false},
        {"date", HS_TAKER, &date, 0, 0, "MM-DD", "The day; default 06-21.", false},
        {"latitude", HS_REAL, &o->latitude_deg, -90, 90, "DEGREES",
         "Default: that of the raster's middle.", false},
        {"air", HS_REAL, &o->air_c, -60, 50, "CELSIUS", "Mean temperature of the air.", false},
        {"air-range", HS_REAL, &o->air_range, 0, 40, "KELVIN",
         "Between its coldest hour and its warmest, which is 15 h.", false},
        {"humidity", HS_REAL, &o->humidity_percent, 1, 100, "PERCENT",
         "Relative humidity at the mean temperature.", false},
        {"wind", HS_REAL, &o->wind_m_s, 0, 40, "M/S", "10 m above the ground.", false},
        {"cloud", HS_REAL, &o->cloud, 0, 1, "SHARE", "Of the sky: 0 is clear, 1 overcast.", false},
        {"water", HS_REAL, &o->water_c, -2, 40, "CELSIUS",
         "Mean temperature of classes of water, which is that of the season; default: that of the "
         "air.",
         false},
        {"terrain", HS_INPUT, &o->terrain, 0, 0, "DEM",
         "Elevation model in any CRS: slopes are as warm as they face the sun.", false},
        {"heights", HS_INPUT, &o->heights, 0, 0, "FILE",
         "With --shadows: metres of buildings and trees above the terrain, on the class raster's "
         "grid.",
         false},
        {"shadows", HS_FLAG, &o->has_shadows, 0, 0, NULL,
         "What --terrain and --heights hide from the sun is colder, and stays so for hours.",
         false},
        {"trust-inputs", HS_FLAG, &o->trusts_inputs, 0, 0, NULL,
         "Go on where terrain or heights look like a mistake; the reasons are warnings then.",
         false},
        {"seed", HS_INTEGER, &o->seed, 0, 2147483647, "N",
         "Seed of the differences within a class, as that of `reflect`.", false},
        HS_NEEDS_ROW("shadows", "terrain|heights"),
        HS_NEEDS_ROW("heights", "shadows"),
        HS_NEEDS_ROW("trust-inputs", "terrain|heights"),
    };
    return hs_options_read(&usage, table, sizeof table / sizeof table[0], argc, argv, exit_code);
}

/* Returns 0, or -1 with the error reported. */
static int take_hours(struct work *w)
{
    static const double usual[] = {4, 14};
    const struct hs_list *list = &w->options->hours;
    w->hour_count = list->count > 0 ? list->count : 2;
    if (w->hour_count > HOURS_MAX) {
        return hs_error("--hours", NULL, "names more than %d hours", HOURS_MAX);
    }
    for (int i = 0; i < w->hour_count; i++) {
        w->hours[i] = usual[i % 2];
        if (list->count > 0 &&
            (!hs_number_within(list->items[i], 0, 24, &w->hours[i]) || w->hours[i] == 24)) {
            return hs_error("--hours", "give hours from 0 to below 24, such as 4,13.5",
                            "`%s` is no hour", list->items[i]);
        }
    }
    return 0;
}

/* Geodetic latitude of a place on the ellipsoid, degrees. */
static double latitude_deg(struct reflect_place p)
{
    static const double eccentricity2 = 0.00669437999014;
    return atan2(p.z, (1 - eccentricity2) * hypot(p.x, p.y)) / degree;
}

static int set_weather(struct work *w)
{
    const struct options *o = w->options;
    double latitude = o->latitude_deg;
    if (isnan(latitude)) {
        if (!w->places.to_wgs84) {
            return hs_error(o->class_raster, "give --latitude",
                            "names no coordinate reference system, and so no latitude");
        }
        pixel_places_row(&w->places, w->classes.grid.height / 2);
        latitude = latitude_deg(w->places.row[w->classes.grid.width / 2]);
    }
    w->weather = (struct ir_weather){.latitude = latitude * degree,
                                     .day_of_year = day_of_year(o),
                                     .air_kelvin = o->air_c + zero_celsius,
                                     .air_range_kelvin = o->air_range,
                                     .humidity = o->humidity_percent / 100,
                                     .wind_m_s = o->wind_m_s,
                                     .cloud = o->cloud};
    printf(
        "day %d of the year at %.2f degrees: air %.1f to %.1f C, humidity %.0f %%, wind %g m/s, "
        "cloud %g\n",
        w->weather.day_of_year, latitude, o->air_c - o->air_range / 2, o->air_c + o->air_range / 2,
        o->humidity_percent, o->wind_m_s, o->cloud);
    hs_report_put("day_of_year", w->weather.day_of_year);
    hs_report_put("latitude_deg", latitude);
    return 0;
}

static int alloc_block(struct work *w)
{
    w->block_rows = db_raster_block_rows(&w->classes.grid, 3 * sizeof(float) + 2);
    const size_t count = (size_t)w->block_rows * (size_t)w->classes.grid.width;
    w->values = malloc(count * sizeof *w->values);
    w->radiance = malloc(count * sizeof *w->radiance);
    w->valid = malloc(count);
    w->class_of = malloc(count);
    w->days = malloc((size_t)w->table.count * sizeof *w->days);
    return w->values && w->radiance && w->valid && w->class_of && w->days
               ? 0
               : hs_error(w->options->out, NULL, "out of memory");
}

static int open_shadows(struct work *w)
{
    const struct options *o = w->options;
    const struct reflect_place *row = w->places.row;
    const int middle = w->classes.grid.width / 2;
    pixel_places_row(&w->places, w->classes.grid.height / 2);
    const struct reflect_place a = row[middle], b = row[middle > 0 ? middle - 1 : 0];
    const double pixel_m[2] = {hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z), w->places.pixel_m};
    const struct cast_shadow_of of = {&w->classes, o->terrain ? &w->slope : NULL, o->heights,
                                      o->trusts_inputs};
    return cast_shadow_open(&w->shadow, &of, pixel_m);
}

static int prepare(struct work *w)
{
    const struct options *o = w->options;
    if (db_class_table_read(&w->table, o->classes) != 0 ||
        db_class_table_choose(&w->table, o->classes, HS_SENSOR_IR) != 0 ||
        db_class_raster_open(&w->classes, &w->numbers, o->class_raster, &w->table,
                             o->ignores_names) != 0 ||
        pixel_places_open(&w->places, &w->classes.grid, o->class_raster) != 0 ||
        alloc_block(w) != 0) {
        return -1;
    }
    if (o->terrain && ground_slope_open(&w->slope, o->terrain, &w->classes.grid, w->block_rows,
                                        o->trusts_inputs) != 0) {
        return -1;
    }
    return set_weather(w) != 0 || (o->has_shadows && open_shadows(w) != 0) ? -1 : 0;
}

static void make_days(struct work *w)
{
    const struct options *o = w->options;
    struct hs_progress progress;
    hs_progress_begin(&progress, "days", (uint64_t)w->table.count);
    for (int i = 0; i < w->table.count; i++) {
        ir_class_days_make(&w->days[i], &w->table.items[i].thermal, &w->weather,
                           o->terrain != NULL);
        if (w->table.items[i].kind == DB_KIND_WATER) {
            ir_class_days_set_mean(&w->days[i],
                                   zero_celsius + (isnan(o->water_c) ? o->air_c : o->water_c));
        }
        db_reflect_law_init(&w->laws[i], &w->table.items[i], 0);
        hs_progress_update(&progress, (uint64_t)i + 1);
    }
    hs_progress_end(&progress);
}

/* Temperature and radiance of pixel i of the block, in row y. */
static void take_pixel(struct work *w, struct shot *s, size_t i, int y)
{
    const int c = w->class_of[i], column = (int)(i % (size_t)w->classes.grid.width);
    const uint64_t seed = (uint64_t)w->options->seed;
    const struct reflect_place p = w->places.row[column];
    /* The reflectivity has the rank of `seed` itself. */
    struct ir_place place = {
        .albedo_rank = db_reflect_rank(&w->laws[c], seed + 1, p),
        .conductivity_rank = db_reflect_rank(&w->laws[c], seed + 2, p),
    };
    if (w->options->terrain) {
        ground_slope_at(&w->slope, &w->places, column, y, &place.rise_east, &place.rise_north);
    }
    if (w->options->has_shadows) {
        place.hidden = cast_shadow_at(&w->shadow, column, y);
    }
    const double kelvin = ir_class_hour_at(&s->classes[c], &place);
    const double reflected = pow(10, db_reflect_assign(&w->laws[c], seed, p) / 10);
    const double sky =
        s->air.sky_window * ir_band_radiance(window_low_um, window_high_um, s->air.kelvin);
    w->values[i] = (float)kelvin;
    w->radiance[i] =
        (float)((1 - reflected) * ir_band_radiance(window_low_um, window_high_um, kelvin) +
                reflected * sky);
    s->sum[c] += kelvin;
    s->count[c]++;
}

static int take_block(struct work *w, struct shot *s, int y, int rows)
{
    const int width = w->classes.grid.width;
    if (db_class_raster_read(&w->classes, &w->numbers, y, rows, w->values, w->valid, w->class_of) !=
            0 ||
        (w->options->terrain && ground_slope_rows(&w->slope, y, rows) != 0)) {
        return -1;
    }
    for (size_t i = 0; i < (size_t)rows * (size_t)width; i++) {
        const int row = y + (int)(i / (size_t)width);
        if (i % (size_t)width == 0) {
            pixel_places_row(&w->places, row);
        }
        w->values[i] = w->radiance[i] = NODATA;
        w->valid[i] = w->class_of[i] != DB_CLASS_NODATA;
        if (w->valid[i]) {
            take_pixel(w, s, i, row);
        }
    }
    db_preview_add(&s->preview, 0, y, rows, width, w->radiance, w->valid);
    return db_raster_write_band(&s->out, 1, y, rows, w->values) != 0 ||
                   db_raster_write_band(&s->out, 2, y, rows, w->radiance) != 0
               ? -1
               : 0;
}

static int path_of(const struct work *w, char *path, double hour, const char *ending)
{
    const int minutes = (int)lround(hour * 60);
    char name[40];
    snprintf(name, sizeof name, "infrared-%02d%02d.%s", minutes / 60, minutes % 60, ending);
    return hs_output_path(path, PATH_SIZE, w->options->out, name);
}

static int write_picture(const struct work *w, const struct shot *s, double hour)
{
    const struct db_preview *p = &s->preview;
    char path[PATH_SIZE];
    uint8_t *rgb = malloc(3 * (size_t)p->width * (size_t)p->height);
    if (!rgb) {
        return hs_error(w->options->out, NULL, "out of memory");
    }
    int result = path_of(w, path, hour, "png") != 0 || db_preview_paint_stretched(p, rgb, 0, 1) != 0
                     ? -1
                     : 0;
    if (result == 0) {
        for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
            rgb[i] = rgb[3 * i];
        }
        result = hs_png_write_grey(path, rgb, p->width, p->height, (size_t)p->width);
    }
    free(rgb);
    return result;
}

static void print_shot(const struct work *w, const struct shot *s, double hour)
{
    hs_report_object(NULL);
    hs_report_put("hour", hour);
    hs_report_put("air_c", s->air.kelvin - zero_celsius);
    hs_report_array("classes");
    printf("%05.2f h, air %.1f C:", hour, s->air.kelvin - zero_celsius);
    for (int c = 0; c < w->table.count; c++) {
        if (s->count[c] > 0) {
            const double mean_c = s->sum[c] / s->count[c] - zero_celsius;
            printf("  %s %.1f", w->table.items[c].name, mean_c);
            hs_report_object(NULL);
            hs_report_put("name", w->table.items[c].name);
            hs_report_put("mean_c", mean_c);
            hs_report_close();
        }
    }
    printf("\n");
    hs_report_close();
    hs_report_close();
}

static int open_shot(struct work *w, struct shot *s, double hour)
{
    static const char *const names[] = {"surface temperature, K", "radiance 8..12 um, W/(m2 sr)"};
    const struct db_raster_kind kind = {GDT_Float32, NODATA, 2};
    char path[PATH_SIZE];
    for (int i = 0; i < w->table.count; i++) {
        ir_class_hour_of(&s->classes[i], &w->days[i], hour);
    }
    s->air = ir_weather_at(&w->weather, hour);
    w->shadow.sun_count = ir_past_suns(&w->weather, hour, w->shadow.suns);
    if (path_of(w, path, hour, "tif") != 0 ||
        db_preview_init(&s->preview, &w->classes.grid, 1) != 0 ||
        db_raster_create_bands(&s->out, path, &w->classes.grid, &kind) != 0) {
        return -1;
    }
    for (int b = 0; b < 2; b++) {
        GDALSetDescription(GDALGetRasterBand(s->out.dataset, b + 1), names[b]);
    }
    return 0;
}

static int take_shot(struct work *w, double hour)
{
    const int height = w->classes.grid.height;
    struct shot *s = calloc(1, sizeof *s);
    if (!s) {
        return hs_error(w->options->out, NULL, "out of memory");
    }
    struct hs_progress progress;
    hs_progress_begin(&progress, "infrared", (uint64_t)height);
    int result = open_shot(w, s, hour);
    for (int y = 0; result == 0 && y < height; y += w->block_rows) {
        const int rows = y + w->block_rows < height ? w->block_rows : height - y;
        result = take_block(w, s, y, rows);
        hs_progress_update(&progress, (uint64_t)(y + rows));
    }
    hs_progress_end(&progress);
    if (result == 0 && db_raster_commit(&s->out) == 0) {
        print_shot(w, s, hour);
        result = write_picture(w, s, hour);
    } else {
        db_raster_abort(&s->out);
        result = -1;
    }
    db_preview_free(&s->preview);
    free(s);
    return result;
}

/* Say how much of the ground has no elevation, once it is known. */
static void report_missing_terrain(const struct work *w)
{
    const struct ground_slope *s = &w->slope;
    if (s->missing > 0) {
        hs_warn(w->options->terrain, "give terrain of the whole raster",
                "%.1f %% of the pixels have no elevation, and are level ground",
                100 * (double)s->missing / (double)s->pixels);
    }
}

static int run(struct work *w)
{
    if (prepare(w) != 0) {
        return HS_EXIT_FAILED;
    }
    make_days(w);
    if (infrared_curves_write(w->options->out, &w->table, w->days) != 0) {
        return HS_EXIT_FAILED;
    }
    int result = 0;
    hs_report_array("pictures");
    for (int i = 0; i < w->hour_count && result == 0; i++) {
        result = take_shot(w, w->hours[i]);
    }
    hs_report_close();
    report_missing_terrain(w);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int db_cmd_infrared(int argc, char **argv)
{
    hs_outputs_together();
    struct options options = {.month = 6,
                              .day = 21,
                              .latitude_deg = NAN,
                              .water_c = NAN,
                              .air_c = 20,
                              .air_range = 12,
                              .humidity_percent = 50,
                              .wind_m_s = 3,
                              .seed = 1};
    int exit_code;
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        hs_error("infrared", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    w->options = &options;
    if (read_options(&options, argc, argv, &exit_code)) {
        exit_code = take_hours(w) == 0 ? run(w) : HS_EXIT_USAGE;
    }
    free(w->values);
    free(w->radiance);
    free(w->valid);
    free(w->class_of);
    free(w->days);
    ground_slope_close(&w->slope);
    cast_shadow_close(&w->shadow);
    pixel_places_close(&w->places);
    db_raster_close(&w->classes);
    hs_list_free(&options.hours);
    free(w);
    return exit_code;
}
