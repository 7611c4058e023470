/* Every pixel of every rotation, against the plain statement of what a rotation is. */
#include "check.h"
#include "drv/blit.h"
#include "hs/rng.h"

#include <string.h>

enum { STRIDE = 20, BORDER = 0x5a5a5a5a, SIDE = 24 };

static uint32_t colour(int x, int y)
{
    return (uint32_t)(x * 0x010307 + y * 0x0b1d00) & 0xffffffu;
}

/* Where the pixel of a width x height picture comes to lie when it is turned clockwise. */
static void turn_point(enum drv_turn turn, int width, int height, int x, int y, int *to_x,
                       int *to_y)
{
    *to_x = x;
    *to_y = y;
    for (int i = 0; i < (int)turn; i++) { /* a quarter: left becomes top */
        const int old_x = *to_x;
        *to_x = height - 1 - *to_y;
        *to_y = old_x;
        const int old_width = width;
        width = height;
        height = old_width;
    }
}

static struct lm_surface picture(uint32_t *pixels, uint16_t width, uint16_t height)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            pixels[y * STRIDE + x] = colour(x, y);
        }
    }
    return (struct lm_surface){
        .pixels = pixels, .stride_px = STRIDE, .width_px = width, .height_px = height};
}

/* Blit and compare each pixel of the target, borders included. */
static void check(uint16_t width, uint16_t height, uint16_t to_width, uint16_t to_height,
                  enum drv_turn turn)
{
    static uint32_t pixels[STRIDE * STRIDE], target[SIDE * SIDE], expected[SIDE * SIDE];
    const struct lm_surface from = picture(pixels, width, height);
    const struct drv_target to = {target, SIDE * 4, to_width, to_height, DRV_XRGB8888};
    const int is_upright = turn == DRV_TURN_0 || turn == DRV_TURN_180;
    const int shift_x = (to_width - (is_upright ? width : height)) / 2;
    const int shift_y = (to_height - (is_upright ? height : width)) / 2;
    for (int i = 0; i < SIDE * SIDE; i++) {
        target[i] = expected[i] = BORDER;
    }
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            int at_x, at_y;
            turn_point(turn, width, height, x, y, &at_x, &at_y);
            at_x += shift_x;
            at_y += shift_y;
            if (at_x >= 0 && at_x < to_width && at_y >= 0 && at_y < to_height) {
                expected[at_y * SIDE + at_x] = colour(x, y);
            }
        }
    }
    drv_blit(&to, &from, turn, NULL);
    assert_memory_equal(target, expected, sizeof target);
}

TEST(every_turn_puts_every_pixel_where_it_belongs)
{
    for (int turn = DRV_TURN_0; turn <= DRV_TURN_270; turn++) {
        check(16, 12, 16, 12, (enum drv_turn)turn);
        check(12, 16, 16, 12, (enum drv_turn)turn);
    }
}

/* Every difference of sizes from -6 to 6, odd ones too. */
TEST(the_picture_is_centred_and_what_is_too_large_is_cut)
{
    for (int turn = DRV_TURN_0; turn <= DRV_TURN_270; turn++) {
        for (uint16_t width = 8; width <= 20; width++) {
            for (uint16_t height = 8; height <= 20; height += 3) {
                check(width, height, 14, 15, (enum drv_turn)turn);
            }
        }
    }
}

TEST(rgb565_keeps_the_upper_bits_of_each_colour)
{
    uint32_t pixels[256];
    uint16_t target[256];
    for (uint32_t i = 0; i < 256; i++) {
        pixels[i] = i << 16 | (255 - i) << 8 | (i ^ 0x55);
    }
    const struct lm_surface from = {
        .pixels = pixels, .stride_px = 256, .width_px = 256, .height_px = 1};
    const struct drv_target to = {target, sizeof target, 256, 1, DRV_RGB565};
    drv_blit(&to, &from, DRV_TURN_0, NULL);
    for (uint32_t i = 0; i < 256; i++) {
        assert_int_equal(target[i] >> 11, i / 8);
        assert_int_equal(target[i] >> 5 & 63, (255 - i) / 4);
        assert_int_equal(target[i] & 31, (i ^ 0x55) / 8);
    }
    drv_blit(&to, &from, DRV_TURN_180, NULL);
    assert_int_equal(target[255] >> 11, 0);
    assert_int_equal(target[0] >> 11, 31);
}

TEST(clearing_leaves_what_lies_beyond_the_rows)
{
    uint16_t target[8 * 4];
    memset(target, 0xff, sizeof target);
    const struct drv_target to = {target, 16, 5, 4, DRV_RGB565};
    drv_blit_clear(&to);
    for (int i = 0; i < 8 * 4; i++) {
        assert_int_equal(target[i], i % 8 < 5 ? 0 : 0xffff);
    }
}

/* Two pictures that differ in some blocks, on panels that cut them or leave a border: copying the
 * blocks is as good as copying all. */
TEST(the_blocks_that_changed_are_enough_in_every_turn)
{
    enum { LARGE = 60, ROOM = 80 };
    static uint32_t pixels[LARGE * LARGE], part[ROOM * ROOM], whole[ROOM * ROOM];
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    for (int n = 0; n < 400; n++) {
        const enum drv_turn turn = (enum drv_turn)(n % 4);
        const uint16_t width = (uint16_t)(30 + hs_rng_below(&rng, 30)),
                       height = (uint16_t)(30 + hs_rng_below(&rng, 30));
        const struct lm_surface from = {
            .pixels = pixels, .stride_px = LARGE, .width_px = width, .height_px = height};
        struct drv_target to = {part, ROOM * 4, (uint16_t)(30 + hs_rng_below(&rng, 50)),
                                (uint16_t)(30 + hs_rng_below(&rng, 50)), DRV_XRGB8888};
        struct lm_damage changed = {{0}};
        drv_blit(&to, &from, turn, NULL);
        for (int k = 0; k < 5; k++) {
            const int32_t x = (int32_t)hs_rng_below(&rng, width),
                          y = (int32_t)hs_rng_below(&rng, height);
            pixels[y * LARGE + x] = (uint32_t)n << 8 | (uint32_t)k;
            lm_damage_mark(&changed, &(struct lm_rectangle){x, y, x + 1, y + 1});
        }
        drv_blit(&to, &from, turn, &changed);
        memcpy(whole, part, sizeof whole);
        to.bytes = whole;
        drv_blit(&to, &from, turn, NULL);
        assert_memory_equal(part, whole, sizeof whole);
    }
}

TEST(what_did_not_change_is_not_touched)
{
    static uint32_t pixels[64 * 64], target[64 * 64];
    const struct lm_surface from = {
        .pixels = pixels, .stride_px = 64, .width_px = 64, .height_px = 64};
    const struct drv_target to = {target, 64 * 4, 64, 64, DRV_XRGB8888};
    struct lm_damage changed = {{0}};
    memset(target, 0x5a, sizeof target);
    lm_damage_mark(&changed, &(struct lm_rectangle){20, 20, 21, 21});
    drv_blit(&to, &from, DRV_TURN_90, &changed);
    int touched = 0;
    for (int i = 0; i < 64 * 64; i++) {
        touched += target[i] != BORDER;
    }
    assert_int_equal(touched, LM_BLOCK_WIDTH_PX * LM_BLOCK_HEIGHT_PX);
}
