#include "unit_rig.h"
#include "bus_frames.h"
#include "check.h"
#include "glass_text.h"

#include "fx/crc32c.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct rig *r = ctx;
    struct fake_bus *b = &r->bus;
    if (b->is_down) {
        return LM_ERR_IO;
    }
    if (b->queue_next == 0) {
        if (b->now_us < b->sent_us || b->now_us >= b->stop_us) {
            return 0;
        }
        b->sent_us += 50000;
        b->code++;
    }
    const double north = b->speed_m_s * (double)b->now_us / 1e6;
    const struct {
        uint32_t id;
        double value;
    } items[] = {{1036, b->latitude_deg - 0.05 + north / 111132.0 + b->jump_degrees},
                 {1037, b->longitude_deg},
                 {1038, b->height_m},
                 {320, b->height_m + 300},
                 {1133, b->nose_deg},
                 {321, b->nose_deg},
                 {b->has_no_velocity ? 303 : 1039, b->has_no_velocity ? 0 : b->speed_m_s},
                 {b->has_no_velocity ? 303 : 1040, 0},
                 {311, b->pitch_deg},
                 {312, 0},
                 {303, 0},
                 {305, b->turn_deg_s},
                 {1000, b->steerpoint_deg[0]},
                 {1001, b->steerpoint_deg[1]}};
    const int count = (int)(sizeof items / sizeof *items) - (b->has_steerpoint ? 0 : 2);
    *frame = bus_frame(items[b->queue_next].id, LM_CANAS_FLOAT, b->code,
                       bus_float_bits(items[b->queue_next].value), b->now_us);
    b->queue_next = (b->queue_next + 1) % count;
    return 1;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct rig *r = ctx;
    if (r->control_next == r->control_count) {
        return 0;
    }
    *control = r->controls_waiting[r->control_next++];
    return 1;
}

static struct tiny_cell scene(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    if (hypot(p->east_m, p->north_m) < 700) {
        return (struct tiny_cell){-40, TINY_WATER, 0};
    }
    const int is_house =
        fabs(remainder(p->east_m, 300)) < 40 && fabs(remainder(p->north_m, 300)) < 40;
    return is_house ? (struct tiny_cell){0, TINY_STRUCTURE, 5}
                    : (struct tiny_cell){-18, TINY_SOIL, 0};
}

static double hills(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 100 + 50 * sin(p->east_m / 900);
}

/* An image of the caller's own. That of the last place is kept, since tests make many rigs at one
 * place and an image takes as long as seconds of flight. */
static struct tiny_image image_at(double latitude_deg, double longitude_deg)
{
    static struct tiny_image last;
    static struct tiny_spec spec;
    if (!last.bytes || spec.latitude_deg != latitude_deg || spec.longitude_deg != longitude_deg) {
        tiny_image_free(&last);
        spec = tiny_spec_at(latitude_deg, longitude_deg);
        spec.cell = scene;
        spec.elevation_m = hills;
        spec.shift0 = 11;
        spec.rows = spec.columns = 10;
        assert_int_equal(tiny_image_build(&last, &spec), 0);
    }
    struct tiny_image copy = last;
    copy.bytes = malloc(last.size);
    assert_non_null(copy.bytes);
    memcpy(copy.bytes, last.bytes, last.size);
    return copy;
}

struct rig *make_rig_at(double latitude_deg, double longitude_deg)
{
    struct rig *r = calloc(1, sizeof *r);
    r->image = image_at(latitude_deg, longitude_deg);
    const struct memory_board_parts parts = {.ctx = r,
                                             .receive = receive,
                                             .next_control = next_control,
                                             .width_px = WIDTH,
                                             .height_px = HEIGHT,
                                             .glass = r->glass,
                                             .plane = r->plane,
                                             .tile_pool = r->pool,
                                             .tile_pool_bytes = sizeof r->pool};
    memory_board_open(&r->board, r->image.bytes, r->image.size, &parts);
    r->bus.latitude_deg = latitude_deg;
    r->bus.longitude_deg = longitude_deg;
    r->bus.stop_us = UINT64_MAX;
    r->bus.speed_m_s = 150;
    r->bus.height_m = 2000;
    r->bus.pitch_deg = 2;
    return r;
}

struct rig *make_rig(void)
{
    return make_rig_at(46, 11);
}

struct rig *start_rig(void)
{
    struct rig *r = make_rig();
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    return r;
}

struct rig *fly_rig(void)
{
    struct rig *r = start_rig();
    command(r, range_10);
    run(r, 1.5);
    return r;
}

void run(struct rig *r, double seconds)
{
    const uint64_t until = r->now_us + (uint64_t)(seconds * 1e6);
    for (; r->now_us < until; r->now_us += STEP_US) {
        r->bus.now_us = r->now_us;
        lm_unit_step(&r->unit, r->now_us);
    }
}

void command(struct rig *r, struct lm_control control)
{
    if (r->control_next == r->control_count) {
        r->control_next = r->control_count = 0;
    }
    assert_true(r->control_count < CONTROLS_MAX);
    r->controls_waiting[r->control_count++] = control;
}

void hold(struct rig *r, int button, double seconds)
{
    command(r, lm_control_button(true, button));
    run(r, seconds);
    command(r, lm_control_button(false, button));
    run(r, 0.1);
}

void press(struct rig *r, int button)
{
    hold(r, button, 0.1);
}

void free_rig(struct rig *r)
{
    tiny_image_free(&r->image);
    free(r);
}

struct lm_surface glass_of(const struct rig *r)
{
    return (struct lm_surface){
        .pixels = (uint32_t *)r->glass, .stride_px = WIDTH, .width_px = WIDTH, .height_px = HEIGHT};
}

bool says(const struct rig *r, const char *words)
{
    const struct lm_surface s = glass_of(r);
    return glass_find(&s, words, r->unit.palette.symbol, r->unit.palette.ink, NULL);
}

uint32_t plane_sum(const struct rig *r)
{
    return fx_crc32c(0, r->plane, sizeof r->plane);
}

uint32_t lit_pixels(const struct rig *r)
{
    uint32_t lit = 0;
    for (size_t i = 0; i < sizeof r->plane; i++) {
        lit += r->plane[i] > 20;
    }
    return lit;
}

const struct lm_control range_10 = {.kind = LM_CONTROL_RANGE, .range_nm = 10};
const struct lm_control patch_here = {.kind = LM_CONTROL_SAR,
                                      .sar = {.centre = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20},
                                              .cell_mm = 5000,
                                              .is_from_ownship = true}};
