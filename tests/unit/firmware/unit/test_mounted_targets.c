/* Targets and signatures of several images: all are shown, each with its own signature, and go with
 * their image in flight. */
#include "../targets/signature_image.h"

#include "check.h"
#include "unit_rig.h"

enum { IMAGES = 2, EACH = TARGETS };

/* Two images that differ in the place of three targets and in the chips of their one signature. The
 * third target of the first names a signature that its image has not: the other's, if numbers
 * were not kept apart. */
struct world {
    struct rig *rig;
    uint8_t *bytes;
    struct lm_flash_part parts[IMAGES];
};

static const struct lm_position places[IMAGES] = {{0x20b60b61, 0x07d27d28},
                                                  {0x20b7d27d, 0x07d3c114}};

static double degrees(fx_bam_t angle)
{
    return angle * 360.0 / 4294967296.0;
}

static struct with_signatures build(const struct tiny_image *country, uint32_t n)
{
    struct with_targets t;
    struct with_signatures s;
    struct lm_target of =
        target_with_signature(degrees(places[n].latitude), degrees(places[n].longitude), 30);
    of.flags |= LM_TARGET_ABOVE_GROUND;
    add_targets(&t, country, of);
    if (n == 0) {
        struct lm_target *const third =
            (struct lm_target *)(void *)(t.bytes + t.head_at + 64 + 2 * LM_TARGET_BYTES);
        third->signature = 1;
        seal_target(third);
    }
    const struct tiny_image with = {.bytes = t.bytes, .size = t.size};
    add_signatures(&s, &with);
    for (uint32_t k = 0; n == 1 && k < CHIPS; k++) {
        struct lm_chip *const chip =
            (struct lm_chip *)(void *)(s.bytes + s.chips_at + k * LM_CHIP_BYTES);
        chip->level[4][LM_CHIP_SIDE / 2 + 8] = code_of(30);
        seal_chip(chip);
    }
    free(t.bytes);
    return s;
}

static struct world *start(void)
{
    struct world *w = calloc(1, sizeof *w);
    struct tiny_image images[IMAGES];
    size_t size;
    w->rig = make_rig();
    for (uint32_t i = 0; i < IMAGES; i++) {
        const struct with_signatures with = build(&w->rig->image, i);
        images[i] = (struct tiny_image){.bytes = with.bytes, .size = with.size};
    }
    w->bytes = tiny_images_join(images, IMAGES, w->parts, &size);
    assert_non_null(w->bytes);
    for (uint32_t i = 0; i < IMAGES; i++) {
        free(images[i].bytes);
        w->rig->board.lent.images[i] = w->parts[i];
    }
    memory_flash_open(&w->rig->board.flash, w->bytes, size);
    assert_int_equal(lm_unit_init(&w->rig->unit, &w->rig->board.lent), LM_OK);
    command(w->rig, range_10);
    run(w->rig, 0.5);
    return w;
}

static void end(struct world *w)
{
    free_rig(w->rig);
    free(w->bytes);
    free(w);
}

static void tell(struct world *w, uint32_t place, uint64_t bytes)
{
    command(w->rig, (struct lm_control){.kind = LM_CONTROL_IMAGE,
                                        .image = {.place = (int32_t)place + 1, .bytes = bytes}});
    run(w->rig, 0.1);
}

/* The plane of a patch around the targets of an image. */
static uint32_t patch_of(struct world *w, uint32_t n)
{
    command(w->rig, (struct lm_control){.kind = LM_CONTROL_SAR,
                                        .sar = {.centre = places[n],
                                                .cell_mm = 1000,
                                                .look_azimuth = 0x20000000,
                                                .range_m = 9000,
                                                .height_m_q6 = 2000 * 64}});
    run(w->rig, 6);
    assert_int_equal(w->rig->unit.picture.sar.line, w->rig->unit.picture.sar.lines);
    return plane_sum(w->rig);
}

static const struct lm_unit_map *map_of(const struct world *w)
{
    return &w->rig->unit.map;
}

static const struct lm_signature *signature_of(const struct world *w, uint32_t i)
{
    const struct lm_target_set *set = &map_of(w)->target_set;
    const struct lm_target *t = &set->items[i];
    const struct lm_target_body body = {.signature = t->signature, .flags = t->flags};
    return lm_target_signature(set, &body);
}

TEST(targets_of_all_images_are_shown_each_by_a_signature_of_its_own_image)
{
    struct world *w = start();
    const struct lm_unit_map *m = map_of(w);
    assert_int_equal(m->image_count, IMAGES);
    assert_int_equal(m->target_set.count, IMAGES * EACH);
    assert_int_equal(m->target_set.signature_count, IMAGES);
    assert_int_equal(m->count.targets_lost + m->count.signatures_lost, 0);
    for (uint32_t i = 0; i < IMAGES * EACH; i++) {
        assert_int_equal(m->target_set.items[i].latitude, places[i / EACH].latitude);
        const struct lm_signature *own = i == 2 ? NULL : &m->signatures[i / EACH];
        assert_ptr_equal(signature_of(w, i), own);
    }
    const uint64_t into_second = m->chip_source[1].chips_offset - w->parts[1].offset;
    assert_true(into_second < w->parts[1].bytes);
    for (uint32_t n = 0; n < IMAGES; n++) {
        const uint32_t before = m->chips.count.read;
        patch_of(w, n);
        assert_true(m->chips.count.read > before);
    }
    assert_int_equal(m->chips.count.corrupt + m->chips.count.io_errors, 0);
    end(w);
}

TEST(targets_go_and_come_back_with_their_image)
{
    struct world *w = start();
    const struct lm_unit_map *m = map_of(w);
    const uint32_t first = patch_of(w, 0), second = patch_of(w, 1);
    for (uint32_t gone = 0; gone < IMAGES; gone++) {
        const uint32_t here = 1 - gone, with_it = gone == 0 ? first : second;
        tell(w, gone, 0);
        assert_int_equal(m->target_set.count, EACH);
        assert_int_equal(m->target_set.signature_count, 1);
        assert_int_equal(m->target_set.items[0].latitude, places[here].latitude);
        assert_ptr_equal(signature_of(w, 0), &m->signatures[0]);
        assert_int_equal(patch_of(w, here), here == 0 ? first : second);
        const uint32_t without = patch_of(w, gone);
        tell(w, gone, w->parts[gone].bytes);
        assert_int_equal(patch_of(w, gone), with_it);
        assert_true(without != with_it);
    }
    assert_int_equal(m->chips.count.corrupt + m->chips.count.io_errors, 0);
    end(w);
}

/* The exercise's clock stands from now on. */
static void stand(struct world *w)
{
    struct lm_exercise *x = &w->rig->unit.exercise;
    x->is_told = true;
    x->rate_q8 = 0;
    x->told_us = 50000000;
    x->anchor_us = x->heard_us = w->rig->now_us;
    x->stale_us = UINT32_MAX;
}

/* Targets that the sweep shows, all of them of images that are there. */
static uint32_t shown(const struct world *w)
{
    const struct lm_target_candidates *c = &w->rig->unit.picture.sector.candidates;
    for (uint32_t i = 0; i < c->count; i++) {
        assert_true(c->candidate[i].index < map_of(w)->target_set.count);
    }
    return c->count;
}

/* Of an exercise that stands one sweep is drawn over and over, of the same time and place: its
 * targets would be those of before for ever. */
TEST(a_sweep_that_stands_shows_the_targets_of_the_images_that_are_there)
{
    struct world *w = start();
    stand(w);
    run(w->rig, 2);
    const uint32_t both = plane_sum(w->rig);
    assert_int_equal(shown(w), IMAGES * EACH);
    tell(w, 1, 0);
    run(w->rig, 2);
    assert_int_equal(shown(w), EACH);
    assert_true(plane_sum(w->rig) != both);
    tell(w, 1, w->parts[1].bytes);
    run(w->rig, 2);
    assert_int_equal(shown(w), IMAGES * EACH);
    end(w);
}

TEST(a_track_goes_on_with_its_target_under_another_number_and_ends_with_its_image)
{
    struct world *w = start();
    struct lm_track *t = &w->rig->unit.track;
    *t = (struct lm_track){.kind = LM_TRACK_FIXED,
                           .state = LM_TRACK_COASTING,
                           .has_target = true,
                           .index = EACH,
                           .next_us = UINT64_MAX,
                           .seen = {.position = places[1]}};
    tell(w, 0, 0);
    assert_int_equal(t->state, LM_TRACK_COASTING);
    assert_int_equal(t->index, 0);
    assert_int_equal(map_of(w)->targets[t->index].latitude, places[1].latitude);
    tell(w, 0, w->parts[0].bytes);
    assert_int_equal(t->index, EACH);
    tell(w, 1, 0);
    assert_int_equal(t->state, LM_TRACK_OFF);
    assert_int_equal(t->loss, LM_TRACK_NOTHING);
    end(w);
}

/* Of the ground, of a live target with the number of one of the image that goes, and of a number
 * that no target has. */
TEST(a_track_of_no_target_of_an_image_outlasts_all_images)
{
    static const struct lm_track tracks[] = {{.has_target = false, .index = 0},
                                             {.has_target = true, .is_live = true, .index = 0},
                                             {.has_target = true, .index = IMAGES * EACH}};
    for (size_t i = 0; i < sizeof tracks / sizeof *tracks; i++) {
        struct world *w = start();
        struct lm_track *t = &w->rig->unit.track;
        *t = tracks[i];
        t->kind = LM_TRACK_FIXED;
        t->state = LM_TRACK_COASTING;
        t->next_us = UINT64_MAX;
        t->seen.position = places[1];
        tell(w, 0, 0);
        assert_int_equal(map_of(w)->target_set.count, EACH);
        assert_int_equal(t->state, LM_TRACK_COASTING);
        assert_int_equal(t->index, tracks[i].index);
        end(w);
    }
}

/* Signature of a live target that names the first one, in the list; -1: it has none. */
static int signature_of_live(const struct world *w)
{
    struct lm_live live = {.count = 1, .target[0] = {.is_there = true, .signature = 1}};
    struct lm_target_set set = map_of(w)->target_set;
    const struct lm_target_query here = {.position = places[0]};
    struct lm_target_candidate candidate;
    set.live = &live;
    assert_true(lm_target_candidate_of(&candidate, &set, true, 0, &here));
    return candidate.body.flags & LM_TARGET_HAS_SIGNATURE ? candidate.body.signature : -1;
}

TEST(live_targets_name_signatures_of_the_first_place_or_none)
{
    struct world *w = start();
    assert_int_equal(signature_of_live(w), 0);
    tell(w, 0, 0);
    assert_int_equal(signature_of_live(w), -1);
    tell(w, 0, w->parts[0].bytes);
    assert_int_equal(signature_of_live(w), 0);
    tell(w, 1, 0);
    assert_int_equal(signature_of_live(w), 0);
    end(w);
}

TEST(a_flash_that_hangs_shows_no_target_of_an_image_that_may_have_gone)
{
    struct world *w = start();
    const struct lm_unit_map *m = map_of(w);
    const uint32_t first = patch_of(w, 0);
    command(w->rig, (struct lm_control){.kind = LM_CONTROL_DROP});
    w->rig->board.flash.busy_polls = 1000000;
    struct lm_control there = patch_here;
    there.sar.centre = places[1];
    there.sar.cell_mm = 1000;
    command(w->rig, there); /* wants a chip of the image that goes */
    run(w->rig, 0.1);
    tell(w, 1, 0);
    assert_int_equal(m->target_set.count, 0);
    assert_int_equal(m->count.targets_lost, EACH);
    assert_int_equal(m->count.signatures_lost, 1);
    assert_int_equal(signature_of_live(w), -1);
    w->rig->board.flash.busy_polls = 0;
    w->rig->board.flash.now.polls_left = 0;
    run(w->rig, 0.1);
    tell(w, 1, w->parts[1].bytes);
    assert_int_equal(m->target_set.count, IMAGES * EACH);
    assert_int_equal(m->count.targets_lost, 0);
    assert_int_equal(patch_of(w, 0), first);
    end(w);
}
