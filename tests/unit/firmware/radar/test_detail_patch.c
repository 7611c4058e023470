/* Detail in a patch. The oracle places every item and every cell once more in double precision,
 * from docs/FORMATS.md and docs/EQUATIONS.md, "Detail", and asks which cells lie inside. */
#include "lm/detail_patch.h"

#include "check.h"
#include "fx/crc32c.h"
#include "hs/rng.h"
#include "lm/radar.h"
#include "reference_support.h"
#include "tiny_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 256, SHIFT0 = 9 };

static const double pi = 3.14159265358979323846, degree = 3.14159265358979323846 / 180;

static struct lm_detail_patch patch;
static struct lm_detail_reader reader;
static struct tiny_map map; /* its grid and classes are used, and its terrain in one test */
static struct lm_scan_line ground;
static struct hs_rng rng;

/* A slope to the north. */
static double slope_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300 + 0.1 * p->north_m;
}

static struct tiny_cell soil(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

static int open_map(void **state)
{
    (void)state;
    struct tiny_spec spec = tiny_spec_at(46, 11.2);
    spec.rows = spec.columns = 4;
    spec.cell = soil;
    spec.elevation_m = slope_m;
    tiny_map_open(&map, &spec, 40);
    return 0;
}

static int close_map(void **state)
{
    (void)state;
    tiny_map_close(&map);
    return 0;
}

/* A patch of `cell_m`, seen along `look_deg` from `range_m`. */
struct scene {
    struct ref_place centre;
    double look_deg, range_m, cell_m;
    uint32_t lines;
    struct lm_patch_geometry g;
};

static fx_bam_t bam(double deg)
{
    return (fx_bam_t)(int64_t)llround(deg / 360 * 4294967296.0);
}

static struct scene scene_at(double latitude, double look_deg, double range_m, double cell_m)
{
    struct scene s = {
        .centre = {latitude, 11.2}, .look_deg = look_deg, .range_m = range_m, .cell_m = cell_m};
    const double near_m = range_m - CELLS * cell_m / 2;
    s.lines = 2 * (uint32_t)ceil(CELLS * range_m / near_m / 2);
    s.g = (struct lm_patch_geometry){.centre = {bam(latitude), bam(11.2)},
                                     .look = bam(look_deg),
                                     .centre_m_q8 = (uint32_t)lround(range_m * 256),
                                     .cell_m_q8 = (uint32_t)lround(cell_m * 256),
                                     .lines = s.lines,
                                     .cells = CELLS,
                                     .traced = CELLS};
    lm_detail_patch_clear(&patch, &map.db);
    return s;
}

/* A tile near the centre, as the reader hands it over. */
static void open_record(const struct scene *s, int rows_off, int columns_off, uint16_t under)
{
    const uint32_t side = SHIFT0 + 6, zone = lm_db_zone(s->g.centre.latitude);
    memset(&reader, 0, sizeof reader);
    reader.row = (uint32_t)((int)((s->g.centre.latitude + FX_BAM_90) >> side) + rows_off);
    reader.column = (uint32_t)((int)(s->g.centre.longitude >> (side + zone)) + columns_off);
    reader.under = under;
}

static struct ref_place item_place(const struct scene *s, const struct lm_detail_item *item)
{
    const uint32_t zone = lm_db_zone(s->g.centre.latitude);
    const double side = ldexp(360, SHIFT0 + 6 - 32), wide = ldexp(side, (int)zone);
    return (struct ref_place){(reader.row + item->north / 65536.0) * side - 90,
                              (reader.column + item->east / 65536.0) * wide};
}

/* Where a place lies in the patch: metres to the right of the centre, and beyond it. */
static void to_patch(const struct scene *s, struct ref_place place, double *right, double *beyond)
{
    double azimuth, distance;
    ref_geo_inverse(s->centre, place, &azimuth, &distance);
    *right = distance * sin((azimuth - s->look_deg) * degree);
    *beyond = distance * cos((azimuth - s->look_deg) * degree);
}

/* An item on the patch: its middle in metres, its turn from the look, and its half sides, which
 * are half a cell at least. */
struct outline {
    double right_m, beyond_m, sine, cosine, half_length_m, half_width_m;
};

static struct outline outline_of(const struct scene *s, const struct lm_detail_item *item)
{
    const double turn = item->turn * (2 * pi / 65536) - s->look_deg * degree;
    struct outline o = {.sine = sin(turn),
                        .cosine = cos(turn),
                        .half_length_m = fmax(item->length_dm / 20.0, s->cell_m / 2),
                        .half_width_m = fmax(item->width_dm / 20.0, s->cell_m / 2)};
    to_patch(s, item_place(s, item), &o.right_m, &o.beyond_m);
    return o;
}

/* u and v of the middle of a cell, in half sides of an item. */
static void in_item(const struct scene *s, const struct outline *o, uint32_t line, uint32_t cell,
                    double *u, double *v)
{
    const double y = ((int)cell + 0.5 - CELLS / 2.0) * s->cell_m;
    const double x = (line + 0.5 - s->lines / 2.0) * s->cell_m * (s->range_m + y) / s->range_m;
    const double right_m = x - o->right_m, beyond_m = y - o->beyond_m;
    *u = (right_m * o->sine + beyond_m * o->cosine) / o->half_length_m;
    *v = (right_m * o->cosine - beyond_m * o->sine) / o->half_width_m;
}

/* Puts the item into the middle of the patch, or up to `off` of a tile's side aside. */
static void put_in_patch(const struct scene *s, struct lm_detail_item *item, double off)
{
    const uint32_t side = SHIFT0 + 6, zone = lm_db_zone(s->g.centre.latitude);
    const double north = ldexp((s->g.centre.latitude + FX_BAM_90) << (32 - side), -32),
                 east = ldexp(s->g.centre.longitude << (32 - side - zone), -32);
    const double aside[2] = {off * (2 * hs_rng_uniform(&rng) - 1),
                             off * (2 * hs_rng_uniform(&rng) - 1)};
    item->north = (uint16_t)fmax(0, fmin(65535, 65536 * (north + aside[0])));
    item->east = (uint16_t)fmax(0, fmin(65535, 65536 * (east + aside[1])));
}

static struct lm_detail_item random_block(void)
{
    return (struct lm_detail_item){.kind = LM_DETAIL_BLOCK,
                                   .class_number = TINY_STRUCTURE,
                                   .gamma_code = 140,
                                   .north = (uint16_t)hs_rng_u64(&rng),
                                   .east = (uint16_t)hs_rng_u64(&rng),
                                   .length_dm = (uint16_t)(1 + hs_rng_below(&rng, 500)),
                                   .width_dm = (uint16_t)(1 + hs_rng_below(&rng, 300)),
                                   .turn = (uint16_t)hs_rng_u64(&rng),
                                   .height_dm = 120};
}

static void draw(const struct scene *s, uint32_t line)
{
    for (uint32_t i = 0; i < CELLS; i++) {
        ground.cell[i] = 100 << 8 | TINY_SOIL << 4;
    }
    lm_detail_patch_draw(&patch, line, &ground, s->g.cells);
}

/* Any block at any place and turn, in patches near and far, wide and narrow: a cell is drawn if its
 * middle lies inside. Middles within 3 % of a half side, or 8 cm, of an edge are not judged. */
TEST(cells_whose_middle_is_inside_are_drawn_and_no_others)
{
    static const struct {
        double latitude, look, range, cell;
    } cases[] = {{46, 30, 20000, 1},
                 {46, 200, 3000, 2},
                 {-33, 314, 9000, 0.5},
                 {67, 95, 40000, 3},
                 {5, 180, 1500, 2}};
    uint32_t inside = 0, judged = 0;
    hs_rng_seed(&rng, 14);
    for (int n = 0; n < 120; n++) {
        const size_t which = (size_t)n % (sizeof cases / sizeof *cases);
        const struct scene s = scene_at(cases[which].latitude, cases[which].look,
                                        cases[which].range, cases[which].cell);
        open_record(&s, 0, 0, 0);
        reader.record.items[0] = random_block();
        put_in_patch(&s, &reader.record.items[0], 0.3);
        reader.record.count = 1;
        lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
        lm_detail_patch_close(&patch);
        const struct lm_detail_item *item = &reader.record.items[0];
        const double least = fmin(fmax(item->length_dm / 20.0, s.cell_m / 2),
                                  fmax(item->width_dm / 20.0, s.cell_m / 2));
        const double unsure = 0.03 + 0.08 / least;
        const struct outline outline = outline_of(&s, item);
        for (uint32_t line = 0; line < s.lines; line++) {
            draw(&s, line);
            for (uint32_t i = 0; i < CELLS; i++) {
                double u, v;
                in_item(&s, &outline, line, i, &u, &v);
                const double off = fmax(fabs(u), fabs(v)) - 1;
                const bool is_drawn = (ground.cell[i] >> 4 & 15) == TINY_STRUCTURE;
                if (fabs(off) > unsure) {
                    assert_int_equal(is_drawn, off < 0);
                    inside += off < 0;
                    judged++;
                }
            }
        }
    }
    print_message("# %u cells inside of %u\n", inside, judged);
    assert_true(inside > 40000);
}

/* A fence thinner than a cell is met by every line across it. */
TEST(no_line_of_the_patch_misses_a_thin_wall)
{
    const struct scene s = scene_at(46, 0, 20000, 2);
    open_record(&s, 0, 0, 0);
    for (int turn = 0; turn < 180; turn += 5) {
        lm_detail_patch_clear(&patch, &map.db);
        struct lm_detail_item wall = random_block();
        double x0, y0;
        wall.length_dm = 800;
        wall.width_dm = 3;
        wall.turn = (uint16_t)(turn * 65536 / 360);
        put_in_patch(&s, &wall, 0.2);
        reader.record.items[0] = wall;
        reader.record.count = 1;
        lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
        lm_detail_patch_close(&patch);
        to_patch(&s, item_place(&s, &wall), &x0, &y0);
        const double reach = 40 * fabs(sin(turn * degree)) - 3;
        for (uint32_t line = 0; line < s.lines; line++) {
            const double x = (line + 0.5 - s.lines / 2.0) * s.cell_m * (s.range_m + y0) / s.range_m;
            int drawn = 0;
            draw(&s, line);
            for (uint32_t i = 0; i < CELLS; i++) {
                drawn += (ground.cell[i] >> 4 & 15) == TINY_STRUCTURE;
            }
            if (fabs(x - x0) < reach && fabs(y0) < 200) {
                assert_true(drawn >= 1);
            }
        }
    }
}

/* Height above the terrain falls from the ridge to the eaves, three fifths as high. */
TEST(a_gable_is_highest_along_its_ridge)
{
    const struct scene s = scene_at(46, 0, 20000, 0.5);
    open_record(&s, 0, 0, 0);
    struct lm_detail_item house = random_block();
    house.kind = LM_DETAIL_GABLE;
    house.length_dm = 300;
    house.width_dm = 160;
    house.height_dm = 150;
    house.turn = 20 * 65536 / 360;
    put_in_patch(&s, &house, 0);
    reader.record.items[0] = house;
    reader.record.count = 1;
    lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
    lm_detail_patch_close(&patch);
    const uint16_t *height_dm = map.db.classes.height_dm;
    const struct outline outline = outline_of(&s, &house);
    int judged = 0;
    for (uint32_t line = 0; line < s.lines; line++) {
        draw(&s, line);
        for (uint32_t i = 0; i < CELLS; i++) {
            double u, v;
            in_item(&s, &outline, line, i, &u, &v);
            if (fmax(fabs(u), fabs(v)) < 0.97) {
                const double wanted = 15 * (1 - 0.4 * fabs(v)),
                             is = height_dm[ground.cell[i] & 15] / 10.0;
                /* Half an eighth of the fall, and the distance to the nearest of the heights. */
                double nearest = 1e9;
                for (int n = 0; n < 16; n++) {
                    nearest = fmin(nearest, fabs(height_dm[n] / 10.0 - wanted));
                }
                assert_true(fabs(is - wanted) <= nearest + 0.75);
                judged++;
            }
        }
    }
    assert_true(judged > 1000);
}

/* Reflectivity of a fence seen `off` its broadside, dB above that of one seen along. */
static double glint_db(double off_deg)
{
    const struct scene s = scene_at(46, 90, 20000, 1);
    open_record(&s, 0, 0, 0);
    struct lm_detail_item fence = {.kind = LM_DETAIL_LINE,
                                   .gamma_code = 120,
                                   .glint_code = 180,
                                   .length_dm = 300,
                                   .width_dm = 1,
                                   .turn = (uint16_t)lround(off_deg * 65536 / 360)};
    put_in_patch(&s, &fence, 0);
    reader.record.items[0] = fence;
    reader.record.count = 1;
    lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
    return (patch.shape[0].gamma_code - 120) / 2.0;
}

TEST(a_line_glints_broadside)
{
    assert_true(fabs(glint_db(0) - 30) < 0.6);
    assert_true(fabs(glint_db(180) - 30) < 0.6);
    for (int side = -1; side <= 1; side += 2) {
        assert_true(fabs(glint_db(side * 3) - (30 - 3)) < 0.8); /* half power at half the lobe */
        assert_true(fabs(glint_db(side * 6) - (30 - 12)) < 0.8);
        assert_true(glint_db(side * 15) == 0);
        assert_true(glint_db(90 + side * 10) == 0);
    }
}

/* A line keeps class and height of the ground, and never darkens it. */
TEST(a_line_lights_the_ground_that_it_crosses)
{
    const struct scene s = scene_at(46, 90, 20000, 1);
    (void)glint_db(0);
    lm_detail_patch_close(&patch);
    int lit = 0;
    for (uint32_t line = 0; line < s.lines; line++) {
        draw(&s, line);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_int_equal(ground.cell[i] & 0xFF, TINY_SOIL << 4);
            assert_true(ground.cell[i] >> 8 == 100 || ground.cell[i] >> 8 >= 178);
            lit += ground.cell[i] >> 8 != 100;
        }
    }
    assert_true(lit >= 25 && lit <= 70); /* 30 m of a fence that lies across the lines */
}

/* Add one item, of the tile of the patch's middle or of another. */
static void add_alone(const struct scene *s, const struct lm_detail_item *item)
{
    reader.record.items[0] = *item;
    reader.record.count = 1;
    lm_detail_patch_add(&patch, &reader, &map.tiles, &s->g, FX_BAM_DEG(6));
}

/* A surface paints the cells of the classes that it covers, whose middles lie inside; ground keeps
 * its elevation, and cells of other classes all they have. */
TEST(a_surface_covers_the_classes_that_it_names)
{
    const struct scene s = scene_at(46, 60, 20000, 1);
    uint32_t painted = 0;
    hs_rng_seed(&rng, 21);
    for (int n = 0; n < 20; n++) {
        lm_detail_patch_clear(&patch, &map.db);
        open_record(&s, 0, 0, 0);
        struct lm_detail_item strip = random_block();
        strip.kind = LM_DETAIL_SURFACE;
        strip.class_number = TINY_WATER;
        strip.gamma_code = 33;
        strip.glint_code = (uint8_t)(n % 2);
        strip.height_dm = 1 << TINY_SOIL;
        put_in_patch(&s, &strip, 0.1);
        add_alone(&s, &strip);
        lm_detail_patch_close(&patch);
        const struct outline outline = outline_of(&s, &strip);
        for (uint32_t line = 0; line < s.lines; line++) {
            for (uint32_t i = 0; i < CELLS; i++) {
                ground.cell[i] =
                    (i % 3 == 0 ? 100 << 8 | TINY_TREES << 4 | 7 : 100 << 8 | TINY_SOIL << 4 | 7);
                ground.elevation_m_q14[i] = (int32_t)i;
            }
            lm_detail_patch_draw(&patch, line, &ground, s.g.cells);
            for (uint32_t i = 0; i < CELLS; i++) {
                double u, v;
                in_item(&s, &outline, line, i, &u, &v);
                const double off = fmax(fabs(u), fabs(v)) - 1;
                assert_int_equal(ground.elevation_m_q14[i], i);
                if (i % 3 == 0) {
                    assert_int_equal(ground.cell[i], 100 << 8 | TINY_TREES << 4 | 7);
                } else if (fabs(off) > 0.2) {
                    assert_int_equal(ground.cell[i], off < 0 ? 33 << 8 | TINY_WATER << 4
                                                             : 100 << 8 | TINY_SOIL << 4 | 7);
                    painted += off < 0;
                }
            }
        }
    }
    print_message("# %u cells painted\n", painted);
    assert_true(painted > 500);
}

/* Whatever the order of their records: a verge lies under a surface, and both under a house. */
TEST(surfaces_lie_in_their_layers)
{
    const struct scene s = scene_at(46, 60, 20000, 1);
    struct lm_detail_item item[3] = {random_block(), random_block(), random_block()};
    const uint8_t classes[3] = {TINY_STRUCTURE, TINY_WATER, TINY_TREES};
    for (int first = 0; first < 3; first++) {
        int seen[16] = {0};
        lm_detail_patch_clear(&patch, &map.db);
        open_record(&s, 0, 0, 0);
        for (int k = 0; k < 3; k++) {
            struct lm_detail_item *at = &item[(first + k) % 3];
            const int rank = (first + k) % 3;
            at->kind = rank == 0 ? LM_DETAIL_BLOCK : LM_DETAIL_SURFACE;
            at->class_number = classes[rank];
            at->glint_code = rank == 1;
            at->height_dm = rank == 0 ? 120 : 0x7FFF;
            at->length_dm = at->width_dm = (uint16_t)(200 + 400 * rank);
            at->turn = 0;
            put_in_patch(&s, at, 0);
            add_alone(&s, at);
        }
        lm_detail_patch_close(&patch);
        for (uint32_t line = 0; line < s.lines; line++) {
            draw(&s, line);
            for (uint32_t i = 0; i < CELLS; i++) {
                seen[ground.cell[i] >> 4 & 15]++;
            }
        }
        /* Squares of 20, 60 and 100 m in each other. */
        assert_true(abs(seen[TINY_STRUCTURE] - 400) < 60);
        assert_true(abs(seen[TINY_WATER] - (3600 - 400)) < 300);
        assert_true(abs(seen[TINY_TREES] - (10000 - 3600)) < 500);
    }
}

/* What does not fit is left out and counted; a line draws so many cells and no more. */
TEST(room_and_cost_are_bounded)
{
    const struct scene s = scene_at(46, 0, 20000, 3);
    hs_rng_seed(&rng, 3);
    open_record(&s, 0, 0, 0);
    for (int i = 0; i < LM_DETAIL_ITEMS_MAX; i++) {
        reader.record.items[i] = random_block();
    }
    reader.record.count = LM_DETAIL_ITEMS_MAX;
    for (int k = 0; k < 5; k++) {
        lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
    }
    lm_detail_patch_close(&patch);
    assert_int_equal(patch.shape_count, LM_DETAIL_SHAPES_MAX);
    assert_true(patch.left_out >= 5 * LM_DETAIL_ITEMS_MAX - LM_DETAIL_SHAPES_MAX);
    for (uint32_t line = 0; line < s.lines; line++) {
        draw(&s, line);
    }
    reader.record.count = 0;
    while (patch.tile_count < LM_DETAIL_TILES_MAX) {
        lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
    }
    const uint32_t before = patch.left_out;
    reader.record.count = 7;
    lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
    assert_int_equal(patch.tile_count, LM_DETAIL_TILES_MAX);
    assert_int_equal(patch.left_out, before + 7);
}

/* A shape is sorted into the blocks of lines that it may touch and into no other: the last block of
 * the largest patch is the last there is. */
TEST(a_shape_is_looked_at_in_its_own_blocks_of_lines)
{
    static const struct {
        uint16_t first_line, end_line, first_block, end_block;
    } cases[] = {
        {0, 1, 0, 1},
        {7, 8, 0, 1},
        {7, 9, 0, 2},
        {8, 24, 1, 3},
        {LM_PATCH_LINES_MAX - 8, LM_PATCH_LINES_MAX, LM_DETAIL_BLOCKS - 1, LM_DETAIL_BLOCKS}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lm_detail_patch_clear(&patch, &map.db);
        patch.shape[0] = (struct lm_detail_shape){.first_line = cases[i].first_line,
                                                  .end_line = cases[i].end_line};
        patch.shape_count = 1;
        lm_detail_patch_close(&patch);
        for (uint32_t b = 0; b < LM_DETAIL_BLOCKS; b++) {
            const bool is_in = b >= cases[i].first_block && b < cases[i].end_block;
            assert_int_equal(patch.first[b + 1] - patch.first[b], is_in);
        }
    }
}

/* Anything that passes the record's check may be drawn: no item reaches beyond the line. */
TEST(hostile_items_stay_in_the_line)
{
    hs_rng_seed(&rng, 8);
    for (int n = 0; n < 60; n++) {
        const struct scene s = scene_at(n % 2 ? 84.3 : 61.8, n * 37.0, 1500 + 900 * n, 0.5 + n % 9);
        open_record(&s, (int)hs_rng_below(&rng, 5) - 2, (int)hs_rng_below(&rng, 5) - 2, 0);
        for (int i = 0; i < 300; i++) {
            struct lm_detail_item *item = &reader.record.items[i];
            *item = random_block();
            item->kind = (uint8_t)(1 + hs_rng_below(&rng, LM_DETAIL_KINDS - 1));
            item->class_number = (uint8_t)hs_rng_below(&rng, LM_DB_CLASS_NONE);
            item->length_dm = (uint16_t)(1 + hs_rng_below(&rng, 65535));
            item->width_dm = (uint16_t)(1 + hs_rng_below(&rng, 65535));
            item->height_dm = (uint16_t)hs_rng_u64(&rng);
            item->glint_code = 255;
            item->gamma_code = (uint8_t)hs_rng_u64(&rng);
        }
        reader.record.count = 300;
        lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
        lm_detail_patch_close(&patch);
        for (uint32_t line = 0; line < s.lines; line += 7) {
            for (uint32_t i = s.g.cells; i < LM_CELLS_ROOM; i++) {
                ground.cell[i] = 0xABCDEF;
            }
            draw(&s, line);
            for (uint32_t i = s.g.cells; i < LM_CELLS_ROOM; i++) {
                assert_int_equal(ground.cell[i], 0xABCDEF);
            }
        }
    }
}

/* On a slope, a building's cells all have the elevation of the terrain under its middle; the ground
 * beside it keeps its own. */
TEST(a_building_stands_level_on_the_terrain_under_its_middle)
{
    const struct scene s = scene_at(46, 0, 20000, 1);
    open_record(&s, 0, 0, 0);
    lm_tile_cache_want(&map.tiles, 0, reader.row, reader.column);
    tiny_map_read_tiles(&map);
    struct lm_detail_item hall = random_block();
    hall.length_dm = hall.width_dm = 600;
    put_in_patch(&s, &hall, 0);
    reader.record.items[0] = hall;
    reader.record.count = 1;
    lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
    lm_detail_patch_close(&patch);
    int32_t level = 0;
    int inside = 0;
    for (uint32_t line = 0; line < s.lines; line++) {
        for (uint32_t i = 0; i < CELLS; i++) {
            ground.elevation_m_q14[i] = -1;
        }
        draw(&s, line);
        for (uint32_t i = 0; i < CELLS; i++) {
            if ((ground.cell[i] >> 4 & 15) != TINY_STRUCTURE) {
                assert_int_equal(ground.elevation_m_q14[i], -1);
                continue;
            }
            level = inside++ == 0 ? ground.elevation_m_q14[i] : level;
            assert_int_equal(ground.elevation_m_q14[i], level);
        }
    }
    double azimuth, distance;
    ref_geo_inverse(s.centre, item_place(&s, &hall), &azimuth, &distance);
    const double wanted = 300 + 0.1 * distance * cos(azimuth * degree);
    assert_true(inside > 3000);
    assert_true(fabs(level / 16384.0 - wanted) < 0.1);
}

/* Whether a tile so many rows and columns off takes an item. */
static bool is_tile_taken(const struct scene *s, int rows_off, int columns_off)
{
    const struct lm_detail_item item = random_block();
    lm_detail_patch_clear(&patch, &map.db);
    open_record(s, rows_off, columns_off, 0);
    add_alone(s, &item);
    assert_int_equal(patch.shape_count, 0);
    return patch.tile_count != 0;
}

/* Tiles are 305 m high, and the northern and the eastern corners of those that are left out first
 * are the ones that lie beyond. */
TEST(a_tile_of_which_a_corner_is_beyond_300_km_is_left_out)
{
    const struct scene s = scene_at(46, 0, 20000, 1);
    const double side_m = ldexp(40007862.9, SHIFT0 + 6 - 32), least_m = 297000, most_m = 302000;
    const int rows = (int)(least_m / side_m),
              columns = (int)(least_m / (side_m * cos(46 * degree)));
    int taken[2] = {0};
    assert_true(is_tile_taken(&s, rows, 0) && is_tile_taken(&s, 0, columns));
    while (is_tile_taken(&s, rows + taken[0], 0)) {
        taken[0]++;
    }
    while (is_tile_taken(&s, 0, columns + taken[1])) {
        taken[1]++;
    }
    assert_true((rows + taken[0]) * side_m < most_m);
    assert_true((columns + taken[1]) * side_m * cos(46 * degree) < most_m);
    assert_false(is_tile_taken(&s, rows + taken[0] + 2, 0)); /* all of it is */
}

TEST(what_lies_behind_the_antenna_is_left_out)
{
    for (int is_behind = 0; is_behind < 2; is_behind++) {
        const struct scene s = scene_at(46, 0, is_behind ? 1500 : 4000, 9);
        struct lm_detail_item hall = random_block();
        lm_detail_patch_clear(&patch, &map.db);
        open_record(&s, -6, 0, 0); /* 1.6 km before the middle */
        hall.north = 49152;
        hall.length_dm = hall.width_dm = 50000;
        add_alone(&s, &hall);
        assert_int_equal(patch.tile_count, 1);
        assert_int_equal(patch.shape_count, !is_behind);
    }
}

TEST(a_line_does_not_darken_what_is_brighter)
{
    const struct scene s = scene_at(46, 90, 20000, 1);
    (void)glint_db(0); /* its code is 180 */
    lm_detail_patch_close(&patch);
    for (uint32_t line = 0; line < s.lines; line++) {
        for (uint32_t i = 0; i < CELLS; i++) {
            ground.cell[i] = 200 << 8 | TINY_SOIL << 4;
        }
        lm_detail_patch_draw(&patch, line, &ground, s.g.cells);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_int_equal(ground.cell[i], 200 << 8 | TINY_SOIL << 4);
        }
    }
}

/* A line of the map's structures through two tiles, the second of which has detail. */
static void draw_structures(uint32_t row, uint32_t column)
{
    enum { BORDER = 100, STRUCTURE = 100 << 8 | TINY_STRUCTURE << 4 | 5 };
    for (uint32_t i = 0; i < CELLS; i++) {
        ground.cell[i] = i % 2 ? STRUCTURE : 100 << 8 | TINY_TREES << 4;
    }
    ground.run_count = 2;
    ground.run[0] = (struct lm_scan_run){row, column + 1, BORDER};
    ground.run[1] = (struct lm_scan_run){row, column, CELLS};
    lm_detail_patch_draw(&patch, 0, &ground, CELLS);
    ground.run_count = 0;
    for (uint32_t i = 0; i < CELLS; i++) {
        const uint32_t under = 70 << 8 | TINY_CONCRETE << 4;
        const bool is_uncovered = patch.tile_count != 0 && i >= BORDER;
        assert_int_equal(ground.cell[i], i % 2 == 0     ? 100 << 8 | TINY_TREES << 4
                                         : is_uncovered ? under
                                                        : (uint32_t)STRUCTURE);
    }
}

TEST(structures_of_the_map_go_where_their_tile_has_detail)
{
    const struct scene s = scene_at(46, 0, 20000, 1);
    open_record(&s, 0, 0, 70 << 8 | TINY_CONCRETE << 4);
    draw_structures(reader.row, reader.column);
    lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6)); /* of no item */
    open_record(&s, 3, 0, 0);
    lm_detail_patch_add(&patch, &reader, &map.tiles, &s.g, FX_BAM_DEG(6));
    lm_detail_patch_close(&patch);
    assert_int_equal(patch.tile_count, 2);
    draw_structures(reader.row - 3, reader.column);
}

TEST_GROUP(open_map, close_map);
