/* Detail from its text file to the records that the firmware checks. Places are computed once more
 * in double precision from docs/FORMATS.md. */
#include "build/detail.h"
#include "image_damage.h"

#include "check.h"
#include "fx/crc32c.h"
#include "hs/error.h"
#include "image/codes.h"
#include "lm/db.h"
#include "lm/detail_reader.h"
#include "memory_flash.h"
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHIFT0 = 9 };

static struct db_class_table table;
static struct db_reflect_law laws[DB_CLASS_MAX];
static struct build_facing facing;
static const struct build_detail_settings settings = {
    .shift0 = SHIFT0, .seed = 1, .table = &table, .laws = laws, .facing = &facing};

static int open_table(void **state)
{
    (void)state;
    scene_folder();
    scene_classes();
    if (db_class_table_read(&table, scene_path(SCENE_CLASSES)) != 0) {
        return -1;
    }
    for (int i = 0; i < table.count; i++) {
        db_reflect_law_init(&laws[i], &table.items[i], 10);
    }
    return 0;
}

static int read_text(struct build_detail *d, const char *text)
{
    scene_text("some.detail", text);
    return build_detail_read(d, scene_path("some.detail"), &settings);
}

/* Latitude and longitude of an item, degrees. */
static void place_of(const struct build_detail_item *at, double *latitude, double *longitude)
{
    const double side = ldexp(360, SHIFT0 + 6 - 32);
    *latitude = (at->row + at->item.north / 65536.0) * side - 90;
    *longitude = (at->column + at->item.east / 65536.0) * side;
}

TEST(a_building_keeps_place_size_turn_and_height)
{
    struct build_detail d;
    assert_int_equal(
        read_text(&d, "building 46.0123456 11.0654321 23.4 12.3 251.5 8.7 gabled # x\n"), 0);
    assert_int_equal(d.count, 1);
    double latitude, longitude;
    place_of(&d.items[0], &latitude, &longitude);
    const struct lm_detail_item *item = &d.items[0].item;
    assert_true(fabs(latitude - 46.0123456) < 1e-7);
    assert_true(fabs(longitude - 11.0654321) < 1e-7);
    assert_int_equal(item->kind, LM_DETAIL_GABLE);
    assert_int_equal(item->length_dm, 234);
    assert_int_equal(item->width_dm, 123);
    assert_int_equal(item->height_dm, 87);
    assert_true(fabs(item->turn * 360.0 / 65536 - 251.5) < 0.006);
    assert_int_equal(table.items[item->class_number].kind, DB_KIND_STRUCTURE);
    build_detail_free(&d);
}

/* Pieces follow each other without a gap, and have the line's direction. */
TEST(a_long_line_is_cut_into_pieces)
{
    struct build_detail d;
    assert_int_equal(read_text(&d, "line 46 11 46.005 11.01 wire\n"), 0);
    const double degree_m = 40007862.917 / 360, cosine = cos(46.0025 * 0.017453292519943295);
    const double north = 0.005 * degree_m, east = 0.01 * degree_m * cosine;
    double sum_dm = 0;
    for (uint32_t i = 0; i < d.count; i++) {
        const struct lm_detail_item *item = &d.items[i].item;
        assert_int_equal(item->kind, LM_DETAIL_LINE);
        assert_true(item->length_dm <= 600 && item->glint_code > item->gamma_code);
        assert_true(fabs(item->turn * 360.0 / 65536 - atan2(east, north) * 57.29577951308232) <
                    0.01);
        sum_dm += item->length_dm;
    }
    assert_true(fabs(sum_dm / 10 - hypot(north, east)) < 0.05 * d.count + 0.2);
    build_detail_free(&d);
}

/* A strip keeps its direction and width, covers all but its own class, and its verge what is paved:
 * classes 1 and 2 of the scene's table are the only ground that people made. The items of a record
 * begin with them. */
TEST(surfaces_and_verges_keep_what_the_text_says)
{
    struct build_detail d;
    table.items[1].is_natural = table.items[2].is_natural = false;
    assert_int_equal(read_text(&d,
                               "building 46.0011 11.0003 20 10 0 5 flat\n"
                               "surface 46.001 11.0002 46.0012 11.0004 45.5 asphalt\n"
                               "verge 46.001 11.0002 46.0012 11.0004 7.5 trees\n"),
                     0);
    const double turn = atan2(0.0002 * cos(46.0011 * 0.017453292519943295), 0.0002);
    uint32_t found[2] = {0, 0};
    for (uint32_t i = 0; i < d.count; i++) {
        const struct lm_detail_item *item = &d.items[i].item;
        if (item->kind == LM_DETAIL_SURFACE) {
            const int is_upper = item->glint_code;
            assert_in_range(is_upper, 0, 1);
            assert_true(fabs(item->turn * 360.0 / 65536 - turn * 57.29577951308232) < 0.01);
            assert_int_equal(item->width_dm, is_upper ? 455 : 75);
            assert_string_equal(table.items[item->class_number].name,
                                is_upper ? "asphalt" : "trees");
            assert_int_equal(item->height_dm, is_upper ? 0x7FFF - 2 : 6);
            found[is_upper]++;
        } else {
            assert_int_equal(i, d.count - 1);
        }
    }
    assert_int_equal(found[0], 1);
    assert_int_equal(found[1], 1);
    build_detail_free(&d);
}

/* Every item is in the record of its tile, records pass the firmware's check, and a later item of a
 * record is not lower than an earlier one. */
TEST(records_hold_all_items_by_tile)
{
    struct build_detail d;
    char text[4000] = "";
    size_t n = 0;
    for (int i = 0; i < 40; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n,
                              "building %.5f %.5f 12 9 30 %d flat\nmast %.5f %.5f 30\n",
                              46 + 0.0009 * i, 10.999 + 0.0004 * (i % 7), 5 + i % 9,
                              46 + 0.0011 * i, 11 - 0.001 * (i % 5));
    }
    assert_int_equal(read_text(&d, text), 0);
    assert_int_equal(d.count, 80);
    uint32_t items = 0;
    for (uint32_t i = 0; i < d.record_count; i++) {
        const struct build_detail_record found =
            build_detail_of_tile(&d, d.records[i].row, d.records[i].column);
        assert_int_equal(found.place, d.records[i].place);
        const struct lm_detail *r =
            (const void *)(d.section + (size_t)found.place * LM_DETAIL_UNIT_BYTES);
        assert_int_equal(
            lm_detail_check(r, found.units * LM_DETAIL_UNIT_BYTES, 0, found.row, found.column),
            LM_OK);
        for (uint32_t k = 1; k < r->count; k++) {
            assert_true(r->items[k].height_dm >= r->items[k - 1].height_dm);
        }
        items += r->count;
    }
    assert_int_equal(items, 80);
    assert_int_equal(build_detail_of_tile(&d, 5, 5).units, 0);
    build_detail_free(&d);
}

TEST(a_record_that_is_not_sound_is_refused)
{
    struct build_detail d;
    assert_int_equal(read_text(&d,
                               "surface 46 11 46.00001 11 5 concrete\n"
                               "surface 46 11 46.00001 11 5 asphalt\n"),
                     0);
    const struct build_detail_record at = d.records[0];
    const uint32_t bytes = at.units * LM_DETAIL_UNIT_BYTES;
    static struct lm_detail r;
    /* Each change of the record, sealed again, and the check's answer. */
    static const struct {
        size_t offset;
        uint8_t value;
    } changes[] = {
        {offsetof(struct lm_detail, lod), 1},
        {offsetof(struct lm_detail, row), 0xEE},
        {offsetof(struct lm_detail, count), 99},
        {offsetof(struct lm_detail, items) + 0, 0},
        {offsetof(struct lm_detail, items) + 0, LM_DETAIL_KINDS},
        {offsetof(struct lm_detail, items) + 1, LM_DB_CLASS_NONE},
        {offsetof(struct lm_detail, items) + LM_DETAIL_ITEM_BYTES + 3, 2}, /* no such layer */
        {offsetof(struct lm_detail, items) + LM_DETAIL_ITEM_BYTES - 1, 0x80},
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        memcpy(&r, d.section, bytes);
        ((uint8_t *)&r)[changes[i].offset] = changes[i].value;
        r.crc = fx_crc32c(0, (const uint8_t *)&r + 4, bytes - 4);
        assert_int_equal(lm_detail_check(&r, bytes, 0, at.row, at.column), LM_ERR_CORRUPT);
    }
    memcpy(&r, d.section, bytes);
    assert_int_equal(lm_detail_check(&r, bytes, 0, at.row, at.column), LM_OK);
    assert_int_equal(lm_detail_check(&r, bytes - 1, 0, at.row, at.column), LM_ERR_CORRUPT);
    assert_int_equal(lm_detail_check(&r, 0, 0, at.row, at.column), LM_ERR_CORRUPT);
    assert_int_equal(lm_detail_check(&r, bytes, 0, at.row, at.column + 1), LM_ERR_CORRUPT);
    ((uint8_t *)&r)[bytes - 1] ^= 1;
    assert_int_equal(lm_detail_check(&r, bytes, 0, at.row, at.column), LM_ERR_CORRUPT);
    build_detail_free(&d);
}

TEST(a_line_that_makes_no_sense_is_refused)
{
    static const char *const bad[] = {
        "house 46 11 1 1 1 1 flat\n",
        "building 46 11 12 9 30 5\n",
        "building 46 11 12 9 30 5 round\n",
        "building 46 11 12 9 30 1001 flat\n",
        "building 46 11 0 9 30 5 flat\n",
        "building nan 11 12 9 30 5 flat\n",
        "building 46 11 12 9 30 5 flat flat\n",
        "wall 46 11 46 11.001\n",
        "wall 46 11 46 11.001 -2\n",
        "line 46 11 46 11.001\n",
        "line 46 11 46 11.001 rope\n",
        "line 91 11 46 11.001 rail\n",
        "surface 46 11 46 11.001 5\n",
        "surface 46 11 46 11.001 0 asphalt\n",
        "surface 46 11 46 11.001 5 lava\n",
        "verge 46 11 46 11.001 5 structure\n",
        "mast 46 11\n",
        "mast 46 11 x\n",
        "mast 46 11 20 1 2 3 4 5 6 7 8\n",
    };
    struct build_detail d;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(read_text(&d, bad[i]), -1);
        assert_null(d.items);
    }
    assert_int_equal(build_detail_read(&d, scene_path("none.detail"), &settings), -1);
}

TEST(too_many_items_in_a_tile_are_refused)
{
    struct build_detail d;
    char *text = malloc(64 * (LM_DETAIL_ITEMS_MAX + 1));
    size_t n = 0;
    for (int i = 0; i <= LM_DETAIL_ITEMS_MAX; i++) {
        n += (size_t)sprintf(text + n, "mast 46.0001 11.0001 20\n");
    }
    assert_int_equal(read_text(&d, text), -1);
    text[n - strlen("mast 46.0001 11.0001 20\n")] = '\0';
    assert_int_equal(read_text(&d, text), 0);
    build_detail_free(&d);
    free(text);
}

/* ---- in an image ---- */

static double plain_m(double x, double y)
{
    return 400 + 30 * sin(x * 300) * cos(y * 200);
}

enum { POOL_TILES = 400, BUILDINGS = 300 };

static struct image image;
static struct memory_flash flash;
static struct lm_db db;
static struct lm_tile_cache tiles;
static struct lm_detail_reader reader;
static uint8_t *bytes;

static void build_of(const char *land, const char *more)
{
    const struct scene_raster terrain = {.width = 60,
                                         .height = 60,
                                         .geotransform = {10.98, 0.001, 0, 46.03, 0, -0.001},
                                         .epsg = 4326,
                                         .type = GDT_Float32,
                                         .value = plain_m};
    scene_write("plain.tif", &terrain);
    assert_int_equal(scene_run("build --classes %s --terrain %s --land-class %s --water-class "
                               "water --shift0 9 --out %s %s",
                               scene_path(SCENE_CLASSES), scene_path("plain.tif"), land,
                               scene_path("detail.lmdb"), more),
                     0);
}

static void build(const char *more)
{
    build_of("soil", more);
}

/* An image with buildings all over, and one that lies outside; opened by the firmware, with all
 * tiles of the finest level resident. */
static void open_image(void)
{
    char text[80 * BUILDINGS] = "", more[400];
    size_t n = 0;
    for (int i = 0; i < BUILDINGS; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "building %.6f %.6f 20 10 %d 9 flat\n",
                              46 + 0.00006 * i, 11 + 0.00008 * ((7 * i) % BUILDINGS), i % 180);
    }
    snprintf(text + n, sizeof text - n, "mast 47.5 11 20\n");
    scene_text("all.detail", text);
    snprintf(more, sizeof more, "--detail %s", scene_path("all.detail"));
    build(more);
    assert_int_equal(image_open(&image, scene_path("detail.lmdb")), 0);
    bytes = damage_copy(&image);
    memory_flash_open(&flash, bytes, image.size_bytes);
    assert_int_equal(lm_db_open(&db, &flash.port, 4), LM_OK);
    void *pool = malloc(POOL_TILES * sizeof(struct lm_tile));
    assert_int_equal(
        lm_tile_cache_init(&tiles, &db, pool, POOL_TILES * sizeof(struct lm_tile), 100), LM_OK);
}

static void close_image(void)
{
    free(tiles.pool);
    free(bytes);
    image_close(&image);
}

/* 45.999 to 46.02 degrees north, 10.999 to 11.026 degrees east. */
static const struct lm_detail_box box = {548789446, 549039986, 131223181, 131545303};

static void read_tiles(void)
{
    const uint32_t side = SHIFT0 + 6;
    for (uint32_t row = (box.south + FX_BAM_90) >> side; row <= (box.north + FX_BAM_90) >> side;
         row++) {
        for (uint32_t column = box.west >> side; column <= box.east >> side; column++) {
            lm_tile_cache_want(&tiles, 0, row, column);
            while (!lm_tile_cache_is_idle(&tiles)) {
                lm_tile_cache_service(&tiles, 0, 10);
            }
        }
    }
}

/* Items that arrive, at most one record a step. */
static uint32_t read_detail(uint32_t *records)
{
    uint32_t items = 0;
    enum lm_detail_step step;
    *records = 0;
    lm_detail_reader_start(&reader, &db, &box);
    do {
        step = lm_detail_reader_step(&reader, &tiles);
        if (step == LM_DETAIL_ARRIVED) {
            assert_true(reader.under != 0);
            items += reader.record.count;
            (*records)++;
        }
        lm_tile_cache_service(&tiles, 0, 4);
    } while (step != LM_DETAIL_ENDED);
    return items;
}

TEST(what_is_in_the_file_arrives_at_the_firmware)
{
    uint32_t records;
    open_image();
    assert_true(scene_log_holds("detail 301 items"));
    assert_true(scene_log_holds("1 items lie outside"));
    read_tiles();
    flash.busy_polls = 3;
    assert_int_equal(read_detail(&records), BUILDINGS);
    assert_true(records > 20);
    assert_int_equal(tiles.count.corrupt, 0);
    close_image();
}

/* A record that is damaged, and one that cannot be read, are counted, and the others arrive. */
TEST(a_bad_record_is_passed_over_and_counted)
{
    uint32_t all, records;
    open_image();
    read_tiles();
    read_detail(&all);
    const struct lm_image_section *detail = image.sections[LM_IMAGE_DETAIL];
    bytes[detail->offset + 40] ^= 4;
    (void)read_detail(&records);
    assert_int_equal(records, all - 1);
    assert_int_equal(tiles.count.corrupt, 1);
    flash.fail_read = flash.reads + 5;
    (void)read_detail(&records);
    assert_int_equal(records, all - 2);
    assert_int_equal(tiles.count.io_errors, 1);
    close_image();
}

TEST(verify_finds_damage_of_the_detail)
{
    open_image();
    const struct lm_image_section *detail = image.sections[LM_IMAGE_DETAIL];
    assert_int_equal(damage_faults(bytes, image.size_bytes), 0);
    assert_int_equal(scene_run("inspect %s", scene_path("detail.lmdb")), 0);
    assert_true(scene_log_holds("DETAIL"));
    for (size_t i = 0; i < 64; i += 3) {
        bytes[detail->offset + i] ^= 1;
        assert_true(damage_faults(bytes, image.size_bytes) > 0);
        bytes[detail->offset + i] ^= 1;
    }
    close_image();
}

/* An image without detail is what it was: no section, and nothing in the directory. */
TEST(an_image_without_detail_has_no_section)
{
    build("");
    assert_int_equal(image_open(&image, scene_path("detail.lmdb")), 0);
    assert_null(image.sections[LM_IMAGE_DETAIL]);
    image_close(&image);
}

/* ---- footprints in the cells ---- */

enum { HOUSES = 24 };
static const double house_length_m = 31, house_width_m = 17;

static double house_latitude(int i)
{
    return 46 + 0.0008 * (i / 6) + 0.00003 * i;
}

static double house_longitude(int i)
{
    return 11 + 0.0013 * (i % 6) + 0.00002 * i;
}

/* Metres from a place to the nearest house, 0 inside. */
static double to_house_m(double latitude, double longitude)
{
    const double degree_m = 40007862.917 / 360;
    double nearest = 1e9;
    for (int i = 0; i < HOUSES; i++) {
        const double y = degree_m * (latitude - house_latitude(i));
        const double x = degree_m * (longitude - house_longitude(i)) * cos(latitude * M_PI / 180);
        const double turn = 13.0 * i * M_PI / 180;
        const double beyond = fabs(x * sin(turn) + y * cos(turn)) - house_length_m / 2;
        const double aside = fabs(x * cos(turn) - y * sin(turn)) - house_width_m / 2;
        nearest = fmin(nearest, hypot(fmax(beyond, 0), fmax(aside, 0)));
    }
    return nearest;
}

struct seen {
    uint32_t roofs, beside, woods;
};

/* Check a cell by where its middle lies. Within 0.1 m of a border either side will do. */
static void check_cell(struct seen *seen, uint16_t cell, double to_m)
{
    const double cell_m = ldexp(40007862.917, SHIFT0 - 32);
    const int kind = image.db.classes.entry[image_cell_class(cell)].kind;
    const uint16_t height_dm = image.db.classes.height_dm[image_cell_height(cell)];
    if (to_m == 0) {
        seen->roofs += kind == LM_KIND_STRUCTURE && height_dm == 80;
    } else if (to_m > 0.1 && to_m < 0.75 * cell_m - 0.1) {
        assert_true(kind == LM_KIND_TREES && height_dm == 0);
        seen->beside++;
    } else if (to_m > 0.75 * cell_m + 0.1) {
        assert_int_equal(kind, LM_KIND_TREES);
        seen->woods += height_dm > 40;
    }
}

/* In a wood 12 m high, the cells of houses are roofs, those around them bare, and no others. The
 * mast and the wall are too narrow for cells. */
TEST(footprints_are_structures_and_no_tree_leans_on_them)
{
    char text[80 * (HOUSES + 2)] = "", more[400];
    size_t n = 0;
    for (int i = 0; i < HOUSES; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "building %.7f %.7f %g %g %d 8 flat\n",
                              house_latitude(i), house_longitude(i), house_length_m, house_width_m,
                              13 * i);
    }
    snprintf(text + n, sizeof text - n, "mast 46.005 11 20\nwall 46.006 11 46.006 11.001 5\n");
    scene_text("houses.detail", text);
    snprintf(more, sizeof more, "--detail %s", scene_path("houses.detail"));
    build_of("trees", more);
    assert_int_equal(image_open(&image, scene_path("detail.lmdb")), 0);
    struct seen seen = {0};
    const double side = ldexp(360, SHIFT0 + 6 - 32);
    uint32_t inside = 0;
    for (uint32_t row = (box.south + FX_BAM_90) >> (SHIFT0 + 6);
         row <= (box.north + FX_BAM_90) >> (SHIFT0 + 6); row++) {
        for (uint32_t column = box.west >> (SHIFT0 + 6); column <= box.east >> (SHIFT0 + 6);
             column++) {
            static uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS];
            image_cells_decode(image_find_tile(&image, 0, row, column), cells);
            for (int i = 0; i < LM_TILE_CELLS * LM_TILE_CELLS; i++) {
                const int r = i / LM_TILE_CELLS, c = i % LM_TILE_CELLS;
                const double to_m = to_house_m((row + (r + 0.5) / LM_TILE_CELLS) * side - 90,
                                               (column + (c + 0.5) / LM_TILE_CELLS) * side);
                inside += to_m == 0;
                check_cell(&seen, cells[r][c], to_m);
            }
        }
    }
    print_message("# %u roofs of %u, %u beside, %u woods\n", seen.roofs, inside, seen.beside,
                  seen.woods);
    /* A border that runs through a middle by rounding is a cell or two of some 560. */
    assert_true(inside > 500 && seen.roofs + 2 >= inside && seen.beside > 300);
    assert_true(seen.woods > 100000);
    image_close(&image);
}

TEST_GROUP(open_table, NULL);
