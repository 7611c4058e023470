/* Images that come and go in flight: what is drawn behind it is what a start with the same images
 * draws, and nothing of one that has gone is read any more. The flash is late, wrong, or hangs. */
#include "check.h"
#include "lm/bit.h"
#include "lm/image.h"
#include "lm/radar_record.h"
#include "unit_rig.h"

#include <stdlib.h>
#include <string.h>

enum { IMAGES = 4, ROUNDS = 60, ROW_DATABASE = 1 };

/* Behind the rig's country in its flash: a finer image, another of the same cells, one of other
 * classes. The first and the second overlap. */
struct world {
    struct rig *rig;
    uint8_t *bytes;
    struct lm_flash_part parts[IMAGES];
    struct lm_position centre; /* of the country, and of patches */
};

static struct tiny_cell trees(void *ctx, const struct tiny_place *p)
{
    const double *gamma_db = ctx;
    const bool is_open = p->east_m + 0.3 * p->north_m > 300;
    return is_open ? (struct tiny_cell){0, TINY_NONE, 0}
                   : (struct tiny_cell){*gamma_db, TINY_TREES, 3};
}

static struct tiny_image build(double gamma_db, bool is_foreign)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    struct lm_classes other = *tiny_classes();
    struct tiny_image image;
    other.height_dm[15]++;
    spec.shift0 = 10;
    spec.rows = spec.columns = 4;
    spec.cell = trees;
    spec.ctx = &gamma_db;
    spec.classes = is_foreign ? &other : NULL;
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    return image;
}

static struct world *make_world_of(struct rig *rig)
{
    struct world *w = calloc(1, sizeof *w);
    w->rig = rig;
    struct tiny_image images[IMAGES] = {w->rig->image, build(-8, false), build(-25, false),
                                        build(-8, true)};
    size_t size;
    w->bytes = tiny_images_join(images, IMAGES, w->parts, &size);
    assert_non_null(w->bytes);
    for (int i = 1; i < IMAGES; i++) {
        tiny_image_free(&images[i]);
    }
    memory_flash_open(&w->rig->board.flash, w->bytes, size);
    struct lm_db db;
    assert_int_equal(lm_db_open_part(&db, &w->rig->board.flash.port, &w->parts[0], 1000), LM_OK);
    w->centre = (struct lm_position){db.centre_latitude, db.centre_longitude};
    return w;
}

static struct world *make_world(void)
{
    return make_world_of(make_rig());
}

/* Start again with what the board has at its places. */
static void start_unit(struct world *w)
{
    assert_int_equal(lm_unit_init(&w->rig->unit, &w->rig->board.lent), LM_OK);
    command(w->rig, range_10);
    run(w->rig, 0.5);
}

/* `places`: bit n: the image n is there at the start. */
static struct world *start(uint32_t places)
{
    struct world *w = make_world();
    for (uint32_t i = 0; i < IMAGES; i++) {
        w->rig->board.lent.images[i] =
            (struct lm_flash_part){w->parts[i].offset, places >> i & 1 ? w->parts[i].bytes : 0};
    }
    start_unit(w);
    return w;
}

static void end(struct world *w)
{
    free_rig(w->rig);
    free(w->bytes);
    free(w);
}

static void tell(struct world *w, int32_t place, uint64_t bytes)
{
    command(w->rig, (struct lm_control){.kind = LM_CONTROL_IMAGE,
                                        .image = {.place = place, .bytes = bytes}});
}

static void comes(struct world *w, uint32_t i)
{
    tell(w, (int32_t)i + 1, w->parts[i].bytes);
}

static void goes(struct world *w, uint32_t i)
{
    tell(w, (int32_t)i + 1, 0);
}

static const struct lm_control patch = {
    .kind = LM_CONTROL_SAR,
    .sar = {
        .cell_mm = 3000, .look_azimuth = 0x20000000, .range_m = 9000, .height_m_q6 = 2000 * 64}};

/* The plane of a patch over the middle of all images. */
static uint32_t patch_of(struct world *w)
{
    struct lm_control c = patch;
    c.sar.centre = w->centre;
    command(w->rig, c);
    run(w->rig, 6);
    assert_int_equal(w->rig->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(w->rig->unit.picture.sar.line, w->rig->unit.picture.sar.lines);
    return plane_sum(w->rig);
}

static uint32_t patch_of_start(uint32_t places)
{
    struct world *w = start(places);
    const uint32_t sum = patch_of(w);
    end(w);
    return sum;
}

/* Cells that the sweep reads. */
static uint32_t cell_of_sweep_mm(const struct world *w)
{
    return lm_db_cell_mm(&w->rig->unit.map.db, w->rig->unit.picture.sector.lod);
}

static uint8_t *forbidden_from, *forbidden_to;

static bool fetch_unless_forbidden(void *to, const uint8_t *from, uint32_t length)
{
    assert_false(from >= forbidden_from && from < forbidden_to);
    memcpy(to, from, length);
    return true;
}

/* An image has gone: its bytes are nobody's from here on. */
static void forbid(struct world *w, uint32_t i)
{
    forbidden_from = w->bytes + w->parts[i].offset;
    forbidden_to = forbidden_from + w->parts[i].bytes;
    w->rig->board.flash.fetch = fetch_unless_forbidden;
}

TEST(what_is_drawn_after_an_image_came_or_went_is_what_a_start_draws)
{
    const uint32_t one = patch_of_start(1), two = patch_of_start(3), three = patch_of_start(7);
    assert_true(one != two);
    for (uint32_t polls = 0; polls < 6; polls += 5) {
        struct world *w = start(1);
        w->rig->board.flash.busy_polls = polls;
        comes(w, 2);
        run(w->rig, 0.1);
        comes(w, 1); /* has cells of the same length, and stands before it all the same */
        run(w->rig, 0.3);
        assert_int_equal(w->rig->unit.map.image_count, 3);
        assert_int_equal(patch_of(w), three);
        goes(w, 2);
        run(w->rig, 0.004);
        forbid(w, 2);
        assert_int_equal(patch_of(w), two);
        command(w->rig, (struct lm_control){.kind = LM_CONTROL_DROP});
        run(w->rig, 0.7); /* in the middle of a sweep */
        const uint32_t cell_mm = cell_of_sweep_mm(w);
        goes(w, 1);
        run(w->rig, 0.02);
        assert_int_equal(cell_of_sweep_mm(w), cell_mm);
        forbid(w, 1);
        run(w->rig, 4);
        assert_true(lit_pixels(w->rig) > 1000);
        assert_int_equal(patch_of(w), one);
        assert_int_equal(w->rig->unit.map.tiles.count.io_errors, 0);
        assert_int_equal(w->rig->unit.count.commands_refused, 0);
        end(w);
    }
}

TEST(a_patch_half_drawn_begins_again_and_one_that_is_whole_stays)
{
    struct world *w = start(1);
    const uint32_t two = patch_of_start(3), one = patch_of(w);
    comes(w, 1);
    run(w->rig, 2);
    assert_int_equal(plane_sum(w->rig), one);
    goes(w, 1);
    struct lm_control c = patch;
    c.sar.centre = w->rig->unit.picture.sar.command.centre;
    command(w->rig, c);
    run(w->rig, 0.004);
    const struct lm_sar *sar = &w->rig->unit.picture.sar;
    for (int i = 0; i < 3000 && sar->line < 50; i++) {
        run(w->rig, 0.002);
    }
    assert_in_range(sar->line, 50, sar->lines - 1);
    comes(w, 1);
    run(w->rig, 6);
    assert_int_equal(plane_sum(w->rig), two);
    end(w);
}

TEST(an_image_that_is_refused_is_told_and_the_others_are_flown)
{
    struct world *w = start(3);
    const uint32_t two = patch_of(w);
    const struct lm_unit *u = &w->rig->unit;
    comes(w, 3);
    run(w->rig, 0.1);
    assert_int_equal(u->map.part_status[3], LM_ERR_TABLE);
    assert_true((u->flags & LM_FLAG_TILE) != 0);
    assert_int_equal(patch_of(w), two);
    goes(w, 3);
    run(w->rig, 0.1);
    assert_true((u->flags & LM_FLAG_TILE) == 0);
    tell(w, 3, w->parts[2].bytes / 2); /* cut short */
    run(w->rig, 0.1);
    assert_int_equal(u->map.part_status[2], LM_ERR_CORRUPT);
    goes(w, 2);
    for (uint32_t at = 0; at < LM_DB_HEADER_BYTES; at += 13) { /* each byte of the header counts */
        w->bytes[w->parts[2].offset + at] ^= 4;
        comes(w, 2);
        run(w->rig, 0.002);
        w->bytes[w->parts[2].offset + at] ^= 4;
        goes(w, 2);
        run(w->rig, 0.002);
        assert_int_equal(u->map.image_count, 2);
    }
    assert_int_equal(u->count.commands_refused, 0);
    static const int32_t none[] = {0, -1, IMAGES + 1, INT32_MIN, INT32_MAX};
    for (uint32_t i = 0; i < sizeof none / sizeof *none; i++) {
        tell(w, none[i], i % 2 * w->parts[1].bytes);
        run(w->rig, 0.002);
        assert_int_equal(u->count.commands_refused, i + 1);
    }
    assert_int_equal(patch_of(w), two);
    end(w);
}

static bool fetch_unless_gone(void *to, const uint8_t *from, uint32_t length)
{
    const bool is_gone = from >= forbidden_from && from < forbidden_to;
    memcpy(to, from, is_gone ? 0 : length);
    return !is_gone;
}

/* The second and the third, without the first: those of a start with them at the first places. */
static uint32_t patch_of_others(void)
{
    struct world *w = make_world();
    struct lm_flash_part *images = w->rig->board.lent.images;
    memset(images, 0, IMAGES * sizeof *images);
    images[0] = w->parts[1];
    images[1] = w->parts[2];
    start_unit(w);
    const uint32_t sum = patch_of(w);
    end(w);
    return sum;
}

TEST(the_first_image_goes_and_comes_back_and_the_last_one_stays)
{
    struct world *w = start(7);
    const struct lm_unit *u = &w->rig->unit;
    const uint32_t three = patch_of(w), others = patch_of_others();
    assert_true(others != three);
    goes(w, 0);
    run(w->rig, 0.004);
    forbid(w, 0);
    assert_int_equal(u->map.image_count, 2);
    assert_int_equal(u->map.db.base, w->parts[1].offset); /* it leads now */
    assert_int_equal(patch_of(w), others);
    assert_true((u->flags & LM_FLAG_TILE) == 0);
    goes(w, 2);
    run(w->rig, 0.1);
    assert_int_equal(u->count.commands_refused, 0);
    goes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(u->count.commands_refused, 1);
    assert_int_equal(u->map.image_count, 1);
    w->rig->board.flash.fetch = NULL;
    comes(w, 3); /* of other classes than the one that is left */
    run(w->rig, 0.1);
    assert_int_equal(u->map.part_status[3], LM_ERR_TABLE);
    goes(w, 3);
    comes(w, 0);
    comes(w, 2);
    run(w->rig, 1);
    assert_int_equal(u->map.db.base, w->parts[0].offset);
    assert_int_equal(patch_of(w), three);
    end(w);
}

/* At its last place the board has the finer image, and none but the country at its first. */
TEST(an_image_at_the_last_place_may_be_the_only_one)
{
    struct world *w = make_world();
    struct lm_flash_part *at = w->rig->board.lent.images;
    at[0] = w->parts[0];
    at[LM_IMAGES_MAX - 1] = (struct lm_flash_part){w->parts[1].offset, 0};
    start_unit(w);
    tell(w, LM_IMAGES_MAX, w->parts[1].bytes);
    goes(w, 0);
    run(w->rig, 0.1);
    const struct lm_unit_map *m = &w->rig->unit.map;
    assert_int_equal(m->image_count, 1);
    assert_int_equal(m->db.base, w->parts[1].offset);
    assert_int_equal(m->db.shift0, 10);
    end(w);
}

TEST(a_map_without_a_list_of_places_is_the_image_at_the_start_of_the_flash)
{
    static struct lm_unit_map map;
    struct rig *r = make_rig();
    const struct lm_unit_map_lent lent = {.flash = &r->board.flash.port,
                                          .tile_pool = r->pool,
                                          .tile_pool_bytes = sizeof r->pool,
                                          .flash_poll_limit = 1000};
    assert_int_equal(lm_unit_map_open(&map, &lent), LM_OK);
    assert_true(map.is_usable);
    assert_int_equal(map.image_count, 1);
    assert_int_equal(map.images[0].base, 0);
    free_rig(r);
}

TEST(the_radar_of_an_image_that_has_gone_is_flown_on_and_the_image_may_come_back)
{
    struct lm_radar radar = lm_radar_default;
    uint8_t record[LM_RADAR_RECORD_BYTES];
    struct rig *r = make_rig();
    strcpy(radar.name, "ITS OWN");
    lm_radar_pack(&radar, record);
    assert_int_equal(tiny_image_add_section(&r->image, LM_IMAGE_RADAR, record, sizeof record), 0);
    r->board.lent.radar = NULL;
    struct world *w = make_world_of(r);
    memcpy(r->board.lent.images, w->parts, 2 * sizeof *w->parts);
    start_unit(w);
    goes(w, 0);
    run(w->rig, 0.1);
    assert_int_equal(r->unit.map.image_count, 1);
    assert_string_equal(r->unit.map.radar->name, "ITS OWN");
    comes(w, 0);
    run(w->rig, 0.1);
    assert_int_equal(r->unit.map.part_status[0], LM_OK);
    assert_int_equal(r->unit.map.image_count, 2);
    end(w);
}

/* The first image stays mounted without its medium: the others answer. When it is back, what is
 * read anew is right. (A tile at the border of another image, whose gaps the first could not fill,
 * stays as it is until it leaves the cache.) */
TEST(when_the_medium_of_the_first_image_goes_the_others_answer_until_it_is_back)
{
    struct world *w = start(7);
    const struct lm_unit *u = &w->rig->unit;
    const uint32_t three = patch_of(w);
    forbid(w, 0);
    w->rig->board.flash.fetch = fetch_unless_gone;
    goes(w, 2); /* tiles of all images leave the cache */
    comes(w, 2);
    run(w->rig, 1);
    assert_true(u->map.tiles.count.io_errors > 0);
    assert_true((u->flags & LM_FLAG_TILE) != 0);
    assert_int_equal(u->map.image_count, 3);
    assert_true(patch_of(w) != three);
    assert_true(lit_pixels(w->rig) > 1000);
    w->rig->board.flash.fetch = NULL;
    goes(w, 2);
    comes(w, 2);
    run(w->rig, 2); /* failed tiles are tried again after a second */
    assert_int_equal(patch_of(w), three);
    run(w->rig, 4);
    assert_true((u->flags & LM_FLAG_TILE) == 0);
    end(w);
}

TEST(a_flash_that_hangs_while_an_image_comes_is_outlived)
{
    struct world *w = start(1);
    const uint32_t one = patch_of(w);
    command(w->rig, (struct lm_control){.kind = LM_CONTROL_DROP});
    w->rig->board.flash.busy_polls = 1000000;
    command(w->rig, patch);
    run(w->rig, 0.1);
    comes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(w->rig->unit.map.part_status[1], LM_ERR_IO);
    w->rig->board.flash.busy_polls = 0;
    w->rig->board.flash.now.polls_left = 0;
    goes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(patch_of(w), one);
    comes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(w->rig->unit.map.image_count, 2);
    end(w);
}

/* A read that never ends: what it may still write to is given to nobody, and no image comes. */
TEST(an_image_does_not_come_while_a_read_of_before_has_not_ended)
{
    struct world *w = start(1);
    const uint32_t one = patch_of(w);
    struct lm_unit *u = &w->rig->unit;
    w->rig->board.lent.flash_poll_limit = 1000;
    command(w->rig, (struct lm_control){.kind = LM_CONTROL_DROP});
    run(w->rig, 0.2);
    comes(w, 2);
    run(w->rig, 0.002);
    goes(w, 2); /* the cache is empty */
    w->rig->board.flash.busy_polls = UINT32_MAX;
    for (int i = 0; i < 200 && w->rig->board.flash.now.polls_left == 0; i++) {
        run(w->rig, 0.01);
    }
    assert_int_not_equal(w->rig->board.flash.now.polls_left, 0);
    const uint32_t reads = w->rig->board.flash.reads;
    comes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(u->map.part_status[1], LM_ERR_IO);
    assert_int_equal(u->map.image_count, 1);
    assert_int_equal(w->rig->board.flash.reads, reads); /* not even its header was asked for */
    assert_true((u->flags & LM_FLAG_TILE) != 0);
    w->rig->board.flash.busy_polls = w->rig->board.flash.now.polls_left = 0;
    run(w->rig, 0.1);
    goes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(patch_of(w), one);
    end(w);
}

/* The first image is damaged, so the second brought tables and targets: it stays while it is alone.
 */
TEST(the_only_image_neither_comes_anew_nor_goes)
{
    struct world *w = make_world();
    struct lm_unit *u = &w->rig->unit;
    for (uint32_t i = 0; i < 2; i++) {
        w->rig->board.lent.images[i] = w->parts[i];
    }
    w->rig->board.lent.images[2].offset = w->parts[2].offset;
    w->bytes[100] ^= 1;
    assert_int_equal(lm_unit_init(u, &w->rig->board.lent), LM_OK);
    run(w->rig, 0.5);
    assert_int_equal(u->map.image_count, 1);
    assert_int_equal(u->map.db.base, w->parts[1].offset);
    for (uint32_t i = 0; i < 2; i++) {
        tell(w, 2, i * w->parts[1].bytes);
        run(w->rig, 0.1);
        assert_int_equal(u->refusal, LM_REFUSED_MAP);
        assert_int_equal(u->count.commands_refused, i + 1);
        assert_int_equal(u->map.image_count, 1);
    }
    const struct lm_flash_part *other = &w->parts[2];
    assert_int_equal(lm_unit_map_mount(&u->map, LM_IMAGES_MAX, other, 1000), LM_ERR_RANGE);
    assert_int_equal(u->map.image_count, 1);
    comes(w, 2);
    run(w->rig, 0.1);
    assert_int_equal(u->map.image_count, 2);
    goes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(u->count.commands_refused, 2);
    assert_int_equal(u->map.image_count, 1);
    assert_int_equal(u->map.db.base, other->offset);
    end(w);
}

TEST(no_image_comes_to_a_display_without_a_map)
{
    struct world *w = make_world();
    w->rig->board.lent.images[0] = w->parts[0];
    w->rig->board.lent.images[1].offset = w->parts[1].offset;
    w->bytes[100] ^= 1;
    assert_int_equal(lm_unit_init(&w->rig->unit, &w->rig->board.lent), LM_OK);
    run(w->rig, 0.1);
    comes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(w->rig->unit.refusal, LM_REFUSED_MAP);
    assert_int_equal(w->rig->unit.map.image_count, 0);
    assert_int_equal(w->rig->unit.flags & LM_FLAG_DB, LM_FLAG_DB);
    end(w);
}

TEST(nobody_signed_one_of_the_images_as_long_as_that_is_there)
{
    struct world *w = start(1);
    const struct lm_unit *u = &w->rig->unit;
    assert_int_equal(u->flags & LM_FLAG_UNSIGNED, 0);
    command(w->rig, (struct lm_control){
                        .kind = LM_CONTROL_IMAGE,
                        .image = {.place = 2, .bytes = w->parts[1].bytes, .is_unsigned = true}});
    comes(w, 2);
    run(w->rig, 0.1);
    assert_int_equal(u->flags & LM_FLAG_UNSIGNED, LM_FLAG_UNSIGNED);
    assert_non_null(strstr(lm_bit_row(u, ROW_DATABASE).words, "  +2")); /* beside the first */
    goes(w, 2);
    run(w->rig, 0.1);
    assert_int_equal(u->flags & LM_FLAG_UNSIGNED, LM_FLAG_UNSIGNED);
    assert_non_null(strstr(lm_bit_row(u, ROW_DATABASE).words, "  +1"));
    goes(w, 1);
    run(w->rig, 0.1);
    assert_null(strchr(lm_bit_row(u, ROW_DATABASE).words, '+'));
    assert_int_equal(u->flags & LM_FLAG_UNSIGNED, 0);
    end(w);
}

/* It would begin anew over the new map, but the aircraft does not know where it is. */
TEST(a_patch_that_cannot_begin_again_gives_way_to_the_sector)
{
    struct world *w = start(1);
    const struct lm_unit *u = &w->rig->unit;
    run(w->rig, 1);
    struct lm_control c = patch_here;
    c.sar.cell_mm = 1000; /* drawn in more than a second */
    command(w->rig, c);
    w->rig->bus.stop_us = w->rig->now_us;
    run(w->rig, 0.6);
    assert_in_range(u->picture.sar.line, 0, u->picture.sar.lines - 1);
    assert_int_equal(u->flags & LM_FLAG_NAV_STALE, LM_FLAG_NAV_STALE);
    assert_int_equal(u->page.picture, LM_PICTURE_PATCH);
    comes(w, 1);
    run(w->rig, 0.1);
    assert_int_equal(u->page.picture, LM_PICTURE_SECTOR);
    assert_int_equal(u->count.commands_refused, 0); /* the image itself was welcome */
    end(w);
}

TEST(after_a_storm_of_changes_the_picture_is_that_of_a_quiet_start)
{
    struct world *w = start(1);
    srand(5);
    w->rig->board.flash.fail_every = 17;
    for (int i = 0; i < ROUNDS; i++) {
        const uint32_t which = 1 + (uint32_t)rand() % (IMAGES - 1);
        w->rig->board.flash.busy_polls = (uint32_t)rand() % 4;
        if (rand() % 2) {
            comes(w, which);
        } else {
            goes(w, which);
        }
        if (rand() % 6 == 0) {
            command(w->rig, rand() % 2 ? patch_here : (struct lm_control){.kind = LM_CONTROL_DROP});
        }
        run(w->rig, 0.002 * (1 + rand() % 40));
    }
    w->rig->board.flash.fail_every = 0;
    for (uint32_t i = 1; i < IMAGES; i++) {
        goes(w, i);
    }
    run(w->rig, 2);
    assert_int_equal(w->rig->unit.map.image_count, 1);
    const uint32_t one = patch_of(w);
    assert_int_equal(one, patch_of_start(1));
    end(w);
}
