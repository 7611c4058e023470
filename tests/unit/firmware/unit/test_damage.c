/* Frames by damage: whatever happened, the glass that is shown equals one composed whole, pixel by
 * pixel, for one, two and three buffers, in one step or over many. The seed is fixed; another one
 * may be given. */
#include "check.h"
#include "present.h"
#include "support.h"
#include "unit_rig.h"

#include "hs/rng.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 256, BUFFERS = 3, PIXELS_MOST = 333 * 270, EVENTS = 300, STEP_PX = 4096 };

/* A glass of some buffers, which compares each picture with one composed whole. */
struct glass {
    struct rig *rig;
    uint16_t width_px, height_px;
    uint32_t buffer[BUFFERS][PIXELS_MOST];
    uint32_t buffers, next; /* in use; the one lent next */
    uint32_t presented;
    uint32_t before[PIXELS_MOST]; /* the picture presented last */
    uint64_t lent_us, longest_us, presented_us;
    uint64_t changed_blocks; /* of all pictures */
    uint32_t differing;      /* pixels that differ from those composed whole */
    uint32_t unannounced;    /* pixels that differ from the picture before, and are not marked */
    struct lm_composer whole;
    uint32_t whole_pixels[PIXELS_MOST];
};

static int acquire(void *ctx, struct lm_surface *surface)
{
    struct glass *g = ctx;
    assert_true(g->presented == 0 || g->rig->now_us >= g->presented_us + LM_DISPLAY_REST_US);
    *surface = (struct lm_surface){
        .pixels = g->buffer[g->next],
        .stride_px = g->width_px,
        .width_px = g->width_px,
        .height_px = g->height_px,
        .age = (uint8_t)(g->presented >= g->buffers ? g->buffers : 0),
    };
    g->lent_us = g->rig->now_us;
    return LM_OK;
}

static bool is_marked(const struct lm_damage *d, int32_t x, int32_t y)
{
    const struct lm_rectangle r = {x, y, x + 1, y + 1};
    return lm_damage_meets(d, &r);
}

static void compose_whole(struct glass *g)
{
    const struct lm_surface surface = {.pixels = g->whole_pixels,
                                       .stride_px = g->width_px,
                                       .width_px = g->width_px,
                                       .height_px = g->height_px};
    lm_composer_init(&g->whole, g->width_px, g->height_px);
    lm_composer_begin(&g->whole, &surface);
    assert_true(lm_compose_glass(&g->rig->unit, &g->whole, UINT32_MAX));
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct glass *g = ctx;
    const uint32_t *shown = g->buffer[g->next];
    compose_whole(g);
    for (int32_t i = 0; i < g->width_px * g->height_px; i++) {
        g->differing += shown[i] != g->whole_pixels[i];
        g->unannounced += g->presented != 0 && shown[i] != g->before[i] &&
                          !is_marked(changed, i % g->width_px, i / g->width_px);
    }
    for (uint32_t band = 0; band < LM_BANDS; band++) {
        g->changed_blocks += (uint64_t)__builtin_popcountll(changed->band[band]);
    }
    memcpy(g->before, shown, sizeof g->before);
    g->longest_us =
        g->rig->now_us - g->lent_us > g->longest_us ? g->rig->now_us - g->lent_us : g->longest_us;
    g->next = (g->next + 1) % g->buffers;
    g->presented++;
    g->presented_us = g->rig->now_us;
    return LM_OK;
}

static struct glass *power_up(uint32_t buffers, uint32_t step_px, uint16_t width_px,
                              uint16_t height_px)
{
    struct glass *g = calloc(1, sizeof *g);
    assert_non_null(g);
    memset(g->buffer, 0x5a, sizeof g->buffer);
    g->buffers = buffers;
    g->width_px = width_px;
    g->height_px = height_px;
    g->rig = make_rig();
    struct memory_board *b = &g->rig->board;
    b->display = (struct lm_display){g, width_px, height_px, acquire, present};
    b->lent.glass_step_px = step_px;
    b->lent.options = (struct lm_glass_options){
        .has_borders = buffers == 2, .has_strobe = buffers != 1, .has_heading = true};
    assert_int_equal(lm_unit_init(&g->rig->unit, &b->lent), LM_OK);
    command(g->rig, range_10);
    return g;
}

static struct glass *begin(uint32_t buffers, uint32_t step_px, uint16_t width_px,
                           uint16_t height_px)
{
    struct glass *g = power_up(buffers, step_px, width_px, height_px);
    run(g->rig, 1);
    return g;
}

static void end(struct glass *g)
{
    free_rig(g->rig);
    free(g);
}

/* What the bus, the flash, the display and the operator may do. */
static void do_something(struct glass *g, struct hs_rng *rng)
{
    struct rig *r = g->rig;
    switch (hs_rng_below(rng, 14)) {
    case 0:
        command(r, lm_control_slew((int32_t)hs_rng_below(rng, 2001) - 1000,
                                   (int32_t)hs_rng_below(rng, 2001) - 1000));
        break;
    case 1:
        command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR,
                                       .sector = {(int32_t)hs_rng_below(rng, LM_SECTOR_CHOICES),
                                                  (int32_t)hs_rng_below(rng, LM_FOVS)}});
        break;
    case 2:
        command(r, patch_here);
        break;
    case 3:
        command(r, (struct lm_control){.kind = LM_CONTROL_RANGE,
                                       .range_nm = 10 << hs_rng_below(rng, 3)});
        break;
    case 4:
        command(r, (struct lm_control){.kind = LM_CONTROL_FREEZE,
                                       .is_frozen = hs_rng_below(rng, 2) != 0});
        break;
    case 5:
        r->bus.is_down = hs_rng_below(rng, 3) == 0;
        break;
    case 6:
        r->bus.jump_degrees = 0.01 * hs_rng_below(rng, 3);
        break;
    case 7:
        r->bus.nose_deg = hs_rng_below(rng, 360);
        r->bus.has_steerpoint = hs_rng_below(rng, 2) != 0;
        r->bus.steerpoint_deg[0] = 46.05, r->bus.steerpoint_deg[1] = 11.02;
        break;
    case 8:
        r->board.flash.fail_every = hs_rng_below(rng, 3) == 0 ? 2 : 0;
        break;
    case 9:
        r->bus.stop_us = hs_rng_below(rng, 3) == 0 ? r->now_us : UINT64_MAX;
        break;
    case 10:
        hold(r, 11, 1); /* opens the page of declutter */
        break;
    default:
        press(r, 1 + (int)hs_rng_below(rng, LM_BUTTONS));
        break;
    }
}

static uint32_t formats_seen; /* by all random flights */

static struct glass *fly_at_random(uint32_t buffers, uint32_t step_px)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, support_number("SEED", 1) * 64 + buffers);
    struct glass *g = begin(buffers, step_px, 333, 270); /* no multiples of a block */
    for (uint32_t i = 0; i < EVENTS; i++) {
        do_something(g, &rng);
        run(g->rig, 0.002 * (1 + hs_rng_below(&rng, 150)));
        formats_seen |= 1u << g->rig->unit.page.format;
    }
    return g;
}

static void check_buffers(uint32_t buffers)
{
    for (uint32_t step_px = 0; step_px <= STEP_PX; step_px += STEP_PX) {
        struct glass *g = fly_at_random(buffers, step_px);
        assert_true(g->presented > 1000);
        assert_int_equal(g->differing, 0);
        assert_int_equal(g->unannounced, 0);
        end(g);
    }
}

TEST(a_glass_of_one_buffer_equals_one_composed_whole)
{
    check_buffers(1);
}

TEST(a_glass_of_two_buffers_equals_one_composed_whole)
{
    check_buffers(2);
}

TEST(a_glass_of_three_buffers_equals_one_composed_whole)
{
    check_buffers(3);
}

TEST(the_flights_above_saw_every_page)
{
    assert_int_equal(formats_seen, (1u << LM_FORMATS) - 1);
}

/* Marking the whole glass each time would pass the tests above. */
TEST(a_steady_sweep_changes_a_small_part_of_the_glass)
{
    struct glass *g = begin(1, 0, SIDE, SIDE);
    run(g->rig, 2);
    const uint32_t pictures = g->presented;
    g->changed_blocks = 0;
    run(g->rig, 2);
    const uint64_t blocks = g->changed_blocks / (g->presented - pictures);
    assert_in_range(blocks, 4, SIDE * SIDE / (LM_BLOCK_WIDTH_PX * LM_BLOCK_HEIGHT_PX) / 8);
    assert_int_equal(g->differing, 0);
    end(g);
}

TEST(a_whole_picture_is_spread_over_steps_and_shown_when_it_is_complete)
{
    struct glass *g = begin(2, STEP_PX, SIDE, SIDE);
    run(g->rig, 1);
    g->longest_us = 0;
    press(g->rig, lm_rocker_button(LM_ROCKER_BRT, true)); /* another palette: every pixel */
    run(g->rig, 0.2);
    const uint32_t steps = SIDE * SIDE / STEP_PX;
    assert_in_range(g->longest_us, (steps - 2) * STEP_US, (steps + 5) * STEP_US);
    assert_int_equal(g->differing, 0);
    assert_int_equal(g->rig->unit.count.frames_hurried, 0);
    end(g);
}

/* What it warns of is the first thing to be seen. */
TEST(the_first_picture_comes_in_few_steps_and_before_the_first_line)
{
    enum { STEPS = (SIDE * SIDE + 8 * STEP_PX - 1) / (8 * STEP_PX) };
    struct glass *g = power_up(2, STEP_PX, SIDE, SIDE);
    uint32_t steps = 0;
    for (; g->presented == 0 && steps < 100; steps++) {
        run(g->rig, STEP_US / 1e6);
    }
    assert_in_range(steps, STEPS, STEPS + 2); /* whole bands; and the list, noted in the last */
    assert_int_equal(g->rig->unit.count.lines, 0);
    run(g->rig, 0.5);
    assert_true(g->rig->unit.count.lines > 0);
    assert_int_equal(g->differing, 0);
    end(g);
}

/* A page that changes in every step cannot keep the glass from being shown. */
TEST(a_picture_comes_after_so_many_steps_at_most)
{
    struct glass *g = begin(2, STEP_PX, SIDE, SIDE);
    for (uint32_t i = 0; i < 1000; i++) {
        g->rig->unit.palette.picture[255] ^= 1;
        run(g->rig, STEP_US / 1e6);
    }
    assert_true(g->presented > 10);
    assert_in_range(g->longest_us, (LM_FRAME_STEPS - 2) * STEP_US, LM_FRAME_STEPS * STEP_US);
    assert_true(g->rig->unit.count.frames_hurried > 5);
    assert_int_equal(g->differing, 0);
    end(g);
}
