/* `landmass-db build --map`: somebody's land cover becomes classes of ours, code by code, and what
 * the map does not know is refused by name. */
#include "image/codes.h"
#include "image/grid.h"
#include "image/reader.h"

#include "check.h"
#include "gis/code_map.h"
#include "scene.h"
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TABLES "host-sim/programs/db/classes/"

static const double west_deg = 8, north_deg = 47.06, step_deg = 0.001;
enum { SIDE = 60 };

static long pixel(double degrees, double from, double step)
{
    return lround((degrees - from) / step - 0.5);
}

/* Codes of four digits, and 255: what a byte would cut and a class raster calls no data. */
static double code_of(long column, long row)
{
    static const double codes[4] = {255, 1000, 41, 7};
    return codes[(column / 3 + 2 * (row / 3)) % 4];
}

static double code_value(double x, double y)
{
    return code_of(pixel(x, west_deg, step_deg), pixel(y, north_deg, -step_deg));
}

static double level_value(double x, double y)
{
    (void)x, (void)y;
    return 100;
}

static void write_terrain(void)
{
    const struct scene_raster terrain =
        scene_in_degrees(40, 7.99, 47.07, 0.002, GDT_Float32, level_value);
    scene_write("terrain.tif", &terrain);
}

static void write_codes(GDALDataType type, double (*value)(double x, double y))
{
    const struct scene_raster codes =
        scene_in_degrees(SIDE, west_deg, north_deg, step_deg, type, value);
    scene_classes();
    scene_write("codes.tif", &codes);
    write_terrain();
}

static int run_build(const char *map, const char *options)
{
    scene_text("codes.map", map);
    return scene_run(
        "build --classes %s --class-raster %s --map %s --terrain %s --land-class soil "
        "--out %s %s",
        scene_path(SCENE_CLASSES), scene_path("codes.tif"), scene_path("codes.map"),
        scene_path("terrain.tif"), scene_path("codes.lmdb"), options);
}

static void remove_image(void)
{
    remove(scene_path("codes.lmdb"));
}

static const char whole_map[] =
    "255 = water # the lake\n"
    "1000 = trees # the wood\n"
    "40-42 = asphalt\n"
    "7 = none\n";

/* Class of the cell under the centre of a pixel on the finest level: those of facings are the
 * structure's. */
static int class_at(const struct image *image, double latitude, double longitude)
{
    const uint8_t shift = image->header.shift0;
    const int64_t up = image_bam(latitude) + IMAGE_BAM_QUARTER;
    const uint32_t east = (uint32_t)image_bam(longitude), row = (uint32_t)(up >> (shift + 6));
    const int east_shift = shift + image_row_zone(shift, row);
    const struct lm_tile *t = image_find_tile(image, 0, row, east >> (east_shift + 6));
    assert_non_null(t);
    return image_cell_class(image_tile_cell(t, up >> shift & 63, (int)(east >> east_shift & 63)));
}

TEST(each_code_becomes_the_class_that_the_map_gives_it)
{
    struct image image;
    int seen[4] = {0};
    write_codes(GDT_UInt16, code_value);
    assert_int_equal(run_build(whole_map, ""), 0);
    assert_int_equal(image_open(&image, scene_path("codes.lmdb")), 0);
    for (int row = 0; row < SIDE; row++) {
        for (int column = 0; column < SIDE; column++) {
            const int code = (int)code_of(column, row);
            /* No data is soil, by the rule for ground outside the class raster. */
            const int expected = code == 255 ? 5 : code == 1000 ? 4 : code == 41 ? 1 : 0;
            const double latitude = north_deg - (row + 0.5) * step_deg,
                         longitude = west_deg + (column + 0.5) * step_deg;
            assert_int_equal(class_at(&image, latitude, longitude), expected);
            seen[code % 4]++;
        }
    }
    image_close(&image);
    assert_true(seen[3] > 0 && seen[0] > 0 && seen[1] > 0);
}

TEST(what_occurs_is_printed_with_pixels_share_class_and_legend)
{
    write_codes(GDT_UInt16, code_value);
    assert_int_equal(run_build(whole_map, ""), 0);
    assert_true(scene_log_holds("code 255 "));
    assert_true(scene_log_holds("900 pixels   25.0 %  water        the lake"));
    assert_true(scene_log_holds("900 pixels   25.0 %  trees        the wood"));
}

/* Three of four columns are wood. */
static double stripes_value(double x, double y)
{
    (void)y;
    return pixel(x, west_deg, step_deg) % 4 == 0 ? 255 : 1000;
}

TEST(a_cell_of_many_pixels_takes_the_commonest_class)
{
    struct image image;
    write_codes(GDT_UInt16, stripes_value);
    assert_int_equal(run_build(whole_map, "--cell 600"), 0);
    assert_int_equal(image_open(&image, scene_path("codes.lmdb")), 0);
    assert_int_equal(class_at(&image, 47.03, 8.03), 4);
    image_close(&image);
}

/* A town of pixels of 100 m is no row of squares; one of 20 m may have straight sides. */
TEST(no_border_is_straight_where_cells_are_longer_than_40_m)
{
    static const struct {
        const char *cell;
        bool are_all_natural;
    } images[] = {{"--cell 19", false}, {"--cell 38", false}, {"--cell 76", true}};
    for (size_t n = 0; n < sizeof images / sizeof images[0]; n++) {
        struct image image;
        write_codes(GDT_UInt16, code_value);
        assert_int_equal(run_build(whole_map, images[n].cell), 0);
        assert_int_equal(image_open(&image, scene_path("codes.lmdb")), 0);
        bool are_all_natural = true;
        for (int i = 0; i < LM_DB_CLASSES; i++) {
            const struct lm_class *c = &image.db.classes.entry[i];
            const bool is_natural = (c->flags & LM_CLASS_NATURAL) != 0;
            are_all_natural = are_all_natural && (is_natural || c->name[0] == 0);
            assert_true(c->name[0] != 0 || !is_natural);
        }
        assert_int_equal(are_all_natural, images[n].are_all_natural);
        image_close(&image);
    }
}

TEST(unknown_codes_are_counted_and_named_and_refused)
{
    write_codes(GDT_UInt16, code_value);
    remove_image();
    assert_int_equal(run_build("1000 = trees\n41 = asphalt\n", ""), 1);
    assert_true(
        scene_log_holds("1800 pixels (50.00 %) have codes that the map does not name: 7 "
                        "(900), 255 (900)"));
    assert_true(scene_log_holds("--unknown-codes"));
    FILE *image = fopen(scene_path("codes.lmdb"), "rb");
    assert_null(image);
}

TEST(unknown_codes_get_the_class_that_is_told)
{
    struct image image;
    write_codes(GDT_UInt16, code_value);
    assert_int_equal(run_build("1000 = trees\n41 = asphalt\n", "--unknown-codes water"), 0);
    assert_true(scene_log_holds("taken for water: 7 (900), 255 (900)"));
    assert_int_equal(image_open(&image, scene_path("codes.lmdb")), 0);
    assert_int_equal(class_at(&image, north_deg - 0.5 * step_deg, west_deg + 0.5 * step_deg), 5);
    image_close(&image);
    remove_image();
    assert_int_equal(run_build("1000 = trees\n41 = asphalt\n", "--unknown-codes none"), 0);
    remove_image();
    assert_int_equal(run_build("1000 = trees\n41 = asphalt\n", "--unknown-codes sea"), 1);
    assert_true(scene_log_holds("there is no class \"sea\""));
}

static double negative_value(double x, double y)
{
    return pixel(x, west_deg, step_deg) == 0 && pixel(y, north_deg, -step_deg) == 0 ? -5 : 1000;
}

TEST(values_that_are_no_codes_are_refused)
{
    write_codes(GDT_Float32, code_value);
    assert_int_equal(run_build(whole_map, ""), 1);
    assert_true(scene_log_holds("holds Float32 values, and codes are whole numbers"));
    write_codes(GDT_Int16, negative_value);
    assert_int_equal(run_build(whole_map, "--unknown-codes water"), 1);
    assert_true(scene_log_holds("has 1 pixels below 0 or above 65535"));
}

/* GDAL reads the raster: whatever is wrong with it, the program ends by itself within its limits.
 */
TEST(a_damaged_land_cover_ends_in_an_error_or_an_image)
{
    static uint8_t bytes[1 << 16];
    write_codes(GDT_UInt16, code_value);
    scene_text("codes.map", whole_map);
    FILE *file = fopen(scene_path("codes.tif"), "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    for (unsigned seed = 1; seed <= 40; seed++) {
        unsigned random = seed * 2654435761u;
        file = fopen(scene_path("damaged.tif"), "wb");
        assert_int_equal(fwrite(bytes, 1, size, file), size);
        for (int k = 0; k < 6; k++) {
            random = random * 1664525u + 1013904223u;
            /* Head and directory stand at both ends. */
            const long at = (long)((random >> 8) % 300);
            fseek(file, k % 2 ? at : (long)size - 1 - at, SEEK_SET);
            fputc((int)(random >> 4 & 255), file);
        }
        fclose(file);
        const int status = support_run(
            "(ulimit -v 4000000; timeout -k 1 20 %s/bin/landmass-db build --classes %s "
            "--class-raster %s --map %s --terrain %s --land-class soil --unknown-codes none "
            "--out %s) >%s/log 2>&1",
            support_build_dir(), scene_path(SCENE_CLASSES), scene_path("damaged.tif"),
            scene_path("codes.map"), scene_path("terrain.tif"), scene_path("damaged.lmdb"),
            scene_folder());
        assert_true(status == 0 || status == 1);
    }
}

TEST(a_map_that_is_none_is_refused_with_its_line)
{
    static const struct {
        const char *map, *said;
    } wrong[] = {
        {"255 water\n", "codes.map:1: this line maps nothing"},
        {"\n# a remark\nlake = water\n", "codes.map:3: `lake` is no code"},
        {"7.5 = water\n", "`7.5` is no code"},
        {"65536 = water\n", "`65536` is no code"},
        {"9-7 = water\n", "`9-7` is no code"},
        {"7- = water\n", "`7-` is no code"},
        {"-7 = water\n", "`-7` is no code"},
        {"7 = wood\n", "there is no class `wood` in the class table; it has soil, asphalt"},
        {"7-9 = water\n8 = soil\n", "codes.map:2: code 8 is mapped twice"},
        {"# nothing\n", "maps no code"},
    };
    write_codes(GDT_UInt16, code_value);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(run_build(wrong[i].map, ""), 1);
        assert_true(scene_log_holds(wrong[i].said));
    }
}

TEST(a_map_without_a_class_raster_is_a_wrong_command_line)
{
    scene_classes();
    scene_text("codes.map", whole_map);
    assert_int_equal(scene_run("build --classes %s --map %s --terrain t.tif --out o.lmdb",
                               scene_path(SCENE_CLASSES), scene_path("codes.map")),
                     2);
    assert_int_equal(
        scene_run("build --classes %s --class-raster c.tif --unknown-codes none --terrain t.tif "
                  "--out o.lmdb",
                  scene_path(SCENE_CLASSES)),
        2);
}

/* Codes that each legend has, one with a class that is easily mistaken. */
TEST(every_shipped_map_goes_with_the_shipped_classes)
{
    static const struct {
        const char *map;
        int code, class_index;
    } shipped[] = {{"worldcover.map", 80, 5}, {"nlcd.map", 24, 3},    {"cdl.map", 176, 4},
                   {"corine.map", 44, 5},     {"corine.map", 523, 5}, {"glc2000.map", 21, 9},
                   {"cgls.map", 126, 6}};
    for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
        static struct db_class_table table;
        static struct db_code_map map;
        char path[256];
        assert_int_equal(db_class_table_read(&table, TABLES "landcover.classes"), 0);
        snprintf(path, sizeof path, TABLES "%s", shipped[i].map);
        assert_int_equal(db_code_map_read(&map, path, &table), 0);
        assert_int_equal(db_code_map_class(&map, shipped[i].code), shipped[i].class_index);
        assert_int_equal(db_code_map_class(&map, 65000), DB_CODE_UNKNOWN);
        for (int k = 0; k < map.count; k++) {
            assert_true(map.lines[k].legend[0]); /* a legend says what each code is */
        }
    }
}
