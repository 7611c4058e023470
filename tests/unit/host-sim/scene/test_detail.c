/* The detail of the scene: boxes as large and as turned as what was painted. Expected values are
 * plane geometry. */
#include "check.h"
#include "scene/canvas.h"
#include "scene/detail.h"
#include "scene/land.h"

#include <math.h>

static void assert_near(double is, double wanted, double tolerance)
{
    assert_true(fabs(is - wanted) <= tolerance);
}

TEST(a_rectangle_is_its_own_box)
{
    struct detail d = {0};
    const struct frame f = frame_at((struct point){100, -50}, 30);
    const struct shape s = frame_rectangle(&f, -10, -4, 10, 4);
    detail_add_footprint(&d, s.p, s.count, &(struct detail_block){.height_m = 7});
    assert_int_equal(d.block_count, 1);
    const struct detail_block *b = &d.blocks[0];
    assert_near(b->length_m, 20, 1e-9);
    assert_near(b->width_m, 8, 1e-9);
    assert_near(b->height_m, 7, 0);
    assert_near(b->middle.origin.u, 100, 1e-9);
    assert_near(b->middle.origin.v, -50, 1e-9);
    /* Along the length, either way. */
    assert_near(fabs(b->middle.cos * f.cos + b->middle.sin * f.sin), 1, 1e-12);
    detail_free(&d);
}

TEST(any_other_polygon_keeps_its_area)
{
    struct detail d = {0};
    const struct point ship[] = {{-50, -8}, {35, -8}, {50, 0}, {35, 8}, {-50, 8}};
    detail_add_footprint(&d, ship, 5, &(struct detail_block){.height_m = 11});
    assert_int_equal(d.block_count, 1);
    assert_near(d.blocks[0].length_m * d.blocks[0].width_m, 85 * 16 + 15 * 16 / 2, 1e-6);
    assert_near(fabs(d.blocks[0].middle.cos), 1, 1e-12);
    detail_free(&d);
}

TEST(a_disc_is_two_boxes_across_each_other)
{
    struct detail d = {0};
    struct point p[20];
    for (int i = 0; i < 20; i++) {
        p[i] = (struct point){20 * cos(i * 0.314159265), 20 * sin(i * 0.314159265)};
    }
    detail_add_footprint(&d, p, 20, &(struct detail_block){.height_m = 15});
    assert_int_equal(d.block_count, 2);
    const struct frame *a = &d.blocks[0].middle, *b = &d.blocks[1].middle;
    assert_near(a->cos * b->cos + a->sin * b->sin, sqrt(0.5), 1e-9);
    /* Two squares of side q share a regular octagon; together they cover (4 - 2 sqrt 2) q^2. */
    const double side = d.blocks[0].length_m, star = side * side * (4 - 2 * sqrt(2));
    assert_near(star / (3.14159265 * 400), 1, 0.1);
    detail_free(&d);
}

TEST(masts_stand_at_both_ends_of_a_power_line_and_wires_between)
{
    struct detail d = {0};
    detail_add_power_line(&d, (struct point){0, 0}, (struct point){900, 1200}, 290, 40);
    assert_int_equal(d.mast_count, 6); /* 1500 m in five spans */
    assert_int_equal(d.line_count, 5);
    assert_near(d.masts[5].at.u, 900, 1e-9);
    assert_near(point_distance(d.lines[2].from, d.lines[2].to), 300, 1e-9);
    detail_free(&d);
}

/* A court is painted over the back of a house: half of the house is left. */
TEST(a_block_is_cut_to_what_is_still_seen_of_it)
{
    struct canvas c;
    assert_int_equal(canvas_init(&c, 64, 1), 0);
    const struct frame f = frame_at((struct point){0, 0}, 20);
    const struct shape house = frame_rectangle(&f, -12, -10, 12, 10),
                       court = frame_rectangle(&f, -20, 0, 20, 20),
                       shed = frame_rectangle(&f, -4, 12, 4, 18);
    canvas_shape(&c, &shed, &(struct brush){ROOF_TILE, 4, 3, 0});
    canvas_shape(&c, &house, &(struct brush){ROOF_TILE, 3, 8, 0});
    canvas_shape(&c, &court, &(struct brush){GARDEN, 3, 0, 0});
    assert_int_equal(c.detail.block_count, 2);
    canvas_trim_detail(&c);
    assert_int_equal(c.detail.block_count, 1);
    const struct detail_block *b = &c.detail.blocks[0];
    assert_near(b->length_m, 24, 1e-6);
    assert_near(b->width_m, 10, 1.7); /* a twelfth of its width */
    assert_near(b->middle.origin.u * -f.sin + b->middle.origin.v * f.cos, -5, 0.9);
    canvas_free(&c);
}

/* A runway in the grass, crossed by a river and half covered by a concrete one: two pieces are
 * left, each with a verge of grass on either side and one across its open end. */
TEST(paving_is_strips_where_it_still_shows)
{
    struct canvas c;
    assert_int_equal(canvas_init(&c, 100, 5), 0);
    const struct frame f = frame_at((struct point){0, 0}, 25);
    const struct shape field = frame_rectangle(&f, -300, -300, 300, 300),
                       runway = frame_rectangle(&f, -150, -20, 150, 20),
                       river = frame_rectangle(&f, -45, -300, -15, 300);
    canvas_shape(&c, &field, &(struct brush){GRASS, 0, 0, 0});
    canvas_shape(&c, &runway, &(struct brush){ASPHALT_NEW, 0, 0, 0});
    canvas_shape(&c, &river, &(struct brush){RIVER_WATER, 0, 0, 0});
    assert_int_equal(c.detail.strip_count, 1);
    canvas_trim_paving(&c);
    double paved_m = 0, verge_m = 0;
    for (int i = 0; i < c.detail.strip_count; i++) {
        const struct detail_strip *s = &c.detail.strips[i];
        const double length = point_distance(s->from, s->to);
        const double along = ((s->to.u - s->from.u) * f.cos + (s->to.v - s->from.v) * f.sin);
        if (s->is_verge) {
            assert_int_equal(s->ground, CLASS_VEGETATION);
            assert_near(s->width_m, 7.5, 1e-9);
            verge_m += length;
        } else {
            assert_int_equal(s->ground, CLASS_ASPHALT);
            assert_near(s->width_m, 40, 1e-9);
            assert_near(fabs(along), length, 1e-9);
            paved_m += length;
        }
    }
    /* Of ten pieces of 30 m those that the river meets are gone: two or three. */
    assert_in_range((int)round(paved_m), 209, 241);
    /* Along both sides, and 55 m across both ends. Those at the river lie in water, which has none
     * that grows but the river's own class: 55 m each where 0.8 of a verge fits. */
    assert_in_range((int)round(verge_m), 2 * 180 + 2 * 55, 2 * 240 + 4 * 55);
    canvas_free(&c);
}

/* Painted all over, a strip is gone; a triangle, paint and what stands are none. */
TEST(what_is_no_paving_is_no_strip)
{
    struct canvas c;
    assert_int_equal(canvas_init(&c, 64, 5), 0);
    const struct shape s = {{{-90, -10}, {90, -10}, {90, 10}, {-90, 10}}, 4};
    const struct point triangle[] = {{-90, -10}, {90, -10}, {0, 40}};
    canvas_shape(&c, &s, &(struct brush){ROOF_DARK, 0, 9, 0});
    canvas_shape(&c, &s, &(struct brush){PAINT, 0, 0, 0});
    canvas_shape(&c, &s, &(struct brush){CONCRETE, 0, 6, 0});
    canvas_polygon(&c, triangle, 3, &(struct brush){CONCRETE, 0, 0, 0});
    assert_int_equal(c.detail.strip_count, 0);
    canvas_shape(&c, &s, &(struct brush){CONCRETE, 0, 0, 0});
    assert_int_equal(c.detail.strip_count, 1);
    canvas_shape(&c, &s, &(struct brush){GRASS, 0, 0, 0});
    canvas_trim_paving(&c);
    assert_int_equal(c.detail.strip_count, 0);
    canvas_free(&c);
}

/* What the canvas takes: what is built, has a height, and is painted at its middle. */
TEST(the_canvas_adds_what_is_built)
{
    struct canvas c;
    assert_int_equal(canvas_init(&c, 64, 5), 0);
    const struct shape s = {{{-20, -10}, {20, -10}, {20, 10}, {-20, 10}}, 4};
    const struct brush house = {ROOF_TILE, 0, 8, 0}, wood = {BROADLEAF, 0, 12, 0},
                       flat = {ROOF_TILE, 0, 0, 0},
                       elsewhere = {ROOF_TILE, 0, 8, MATERIAL_BIT(CONCRETE)};
    canvas_shape(&c, &s, &wood);
    canvas_shape(&c, &s, &flat);
    canvas_shape(&c, &s, &elsewhere);
    assert_int_equal(c.detail.block_count, 0);
    canvas_shape(&c, &s, &house);
    assert_int_equal(c.detail.block_count, 1);
    canvas_free(&c);
}
