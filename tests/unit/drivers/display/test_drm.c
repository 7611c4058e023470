/* The DRM driver against a card that is busy, silent, unplugged and taken away. */
#include "check.h"
#include "drv/drm.h"
#include "fake_drm.h"
#include "hs/rng.h"

#include <errno.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 300, TICK_US = 2000, CONSOLE = 99 };

struct rig {
    struct drv_drm drm;
    uint32_t pixels[WIDTH * HEIGHT];
    struct lm_surface picture;
    uint64_t now_us;
};

static const struct drv_drm_config standard = {.device = "/dev/dri/fake"};

static void set_up(struct rig *r, const struct drv_drm_config *config)
{
    fake_drm_reset();
    r->picture = (struct lm_surface){
        .pixels = r->pixels, .stride_px = WIDTH, .width_px = WIDTH, .height_px = HEIGHT};
    r->now_us = 5000000;
    assert_int_equal(drv_drm_open(&r->drm, config, r->now_us), LM_OK);
}

/* Present a picture of one colour. */
static int show(struct rig *r, uint32_t colour)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        r->pixels[i] = colour;
    }
    struct lm_damage all = {{0}};
    lm_damage_mark(&all, &(struct lm_rectangle){0, 0, WIDTH, HEIGHT});
    return drv_drm_present(&r->drm, &r->picture, &all, r->now_us);
}

static void wait_us(struct rig *r, uint64_t us)
{
    for (const uint64_t end = r->now_us + us; r->now_us < end; r->now_us += TICK_US) {
        drv_drm_service(&r->drm, r->now_us);
    }
}

/* The pixel in the middle of what the screen shows; two of them where they have 16 bits. */
static uint32_t middle(void)
{
    const struct fake_drm_buffer *b = &fake_drm.buffer[fake_drm.handle_of_shown - 1];
    const size_t row_words = b->size / b->height / sizeof *b->pixels;
    return b->pixels[b->height / 2 * row_words + b->width / 2 * b->bpp / 32];
}

TEST(each_picture_comes_on_the_screen_with_one_flip)
{
    static struct rig r;
    set_up(&r, &standard);
    assert_int_equal(r.drm.state, DRV_DRM_IDLE);
    assert_int_equal(r.drm.width_px, 640);
    assert_string_equal(r.drm.connector, "HDMI-A-1");
    assert_int_equal(middle(), 0); /* black, not what was in the memory */
    for (uint32_t n = 1; n <= 100; n++) {
        assert_int_equal(show(&r, n), LM_OK);
        assert_int_not_equal(middle(), n); /* nothing is seen before the blank */
        fake_drm_blank();
        assert_int_equal(middle(), n);
        wait_us(&r, TICK_US);
    }
    assert_int_equal(r.drm.count.flips, 100);
    assert_int_equal(fake_drm.modes_set, 1);
    drv_drm_close(&r.drm);
}

/* Whether the screen shows the picture of the rig, in its middle. */
static bool shows_picture(const struct rig *r)
{
    const struct fake_drm_buffer *b = &fake_drm.buffer[fake_drm.handle_of_shown - 1];
    const size_t row_words = b->size / b->height / sizeof *b->pixels;
    const size_t left = (b->width - WIDTH) / 2u, top = (b->height - HEIGHT) / 2u;
    for (size_t y = 0; y < HEIGHT; y++) {
        if (memcmp(b->pixels + (top + y) * row_words + left, r->pixels + y * WIDTH,
                   WIDTH * sizeof *r->pixels) != 0) {
            return false;
        }
    }
    return true;
}

/* Whether cards that copy the clips show all of the shown buffer. */
static bool show_copies(void)
{
    const uint32_t shown = fake_drm.handle_of_shown - 1;
    const struct fake_drm_buffer *b = &fake_drm.buffer[shown];
    const size_t row_words = b->size / b->height / sizeof *b->pixels;
    for (size_t y = 0; y < b->height; y++) {
        const uint32_t *row = b->pixels + y * row_words;
        if (memcmp(row, fake_drm.screen + y * row_words, b->width * sizeof *row) != 0 ||
            memcmp(row, fake_drm.copy[shown] + y * row_words, b->width * sizeof *row) != 0) {
            return false;
        }
    }
    return true;
}

/* Change a few rectangles and present that. Pictures come while the last is on its way, and while
 * the screen is away; whenever one is taken and shown, it is whole. Returns how many were. */
static uint32_t change_and_show(struct rig *r, uint32_t pictures)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 21);
    uint32_t shown = 0;
    for (uint32_t n = 0; n < pictures; n++) {
        struct lm_damage changed = {{0}};
        for (uint32_t k = hs_rng_below(&rng, 4); k > 0; k--) {
            const int32_t left = (int32_t)hs_rng_below(&rng, WIDTH),
                          top = (int32_t)hs_rng_below(&rng, HEIGHT);
            const struct lm_rectangle part = {left, top, left + 1 + (int32_t)hs_rng_below(&rng, 9),
                                              top + 1 + (int32_t)hs_rng_below(&rng, 9)};
            for (int32_t y = top; y < part.bottom && y < HEIGHT; y++) {
                for (int32_t x = left; x < part.right && x < WIDTH; x++) {
                    r->pixels[y * WIDTH + x] = n * 7919;
                }
            }
            lm_damage_mark(&changed, &part);
        }
        const bool is_away = n % 100 >= 40 && n % 100 < 60;
        fake_drm.has_screen = !is_away;
        const int status = drv_drm_present(&r->drm, &r->picture, &changed, r->now_us);
        const bool is_taken = status == LM_OK && r->drm.state != DRV_DRM_DARK;
        if (hs_rng_below(&rng, 3) != 0) {
            fake_drm_blank();
            wait_us(r, TICK_US);
            if (is_taken && r->drm.state == DRV_DRM_IDLE && !is_away) {
                assert_true(r->drm.config.turn != DRV_TURN_0 || shows_picture(r));
                assert_true(show_copies());
                shown++;
            }
        }
        if (n % 20 == 0) {
            wait_us(r, 1100000); /* a screen that comes or goes is noticed */
        }
    }
    return shown;
}

TEST(what_changed_is_copied_into_both_buffers_and_nothing_is_forgotten)
{
    static struct rig r;
    set_up(&r, &standard);
    const uint32_t shown = change_and_show(&r, 600);
    print_message("# %u pictures shown\n", shown);
    assert_true(shown > 100 && r.drm.count.lit > 2 && r.drm.count.clipped == 0);
    drv_drm_close(&r.drm);
}

/* Cards that copy what the clips say, and nothing else, show all of each picture. */
TEST(clips_hold_all_that_changed_however_the_picture_is_turned)
{
    for (enum drv_turn turn = DRV_TURN_0; turn <= DRV_TURN_270; turn++) {
        static struct rig r;
        struct drv_drm_config config = standard;
        config.turn = turn;
        set_up(&r, &config);
        fake_drm.takes_clips = true;
        drv_drm_close(&r.drm);
        assert_int_equal(drv_drm_open(&r.drm, &config, r.now_us), LM_OK);
        assert_true(change_and_show(&r, 300) > 50);
        assert_true(r.drm.count.clipped > 50);
        assert_int_equal(fake_drm.live_blobs, 0);
        const uint64_t a_flip_px = fake_drm.copied_px / r.drm.count.clipped;
        print_message("# turn %d: %u flips with clips, %u pixels each\n", (int)turn,
                      (unsigned)r.drm.count.clipped, (unsigned)a_flip_px);
        assert_true(a_flip_px < WIDTH * HEIGHT / 4);
        drv_drm_close(&r.drm);
    }
}

/* Present the picture after a change of every `apart`th row's first pixels. */
static int change_rows(struct rig *r, int32_t apart, uint32_t colour)
{
    struct lm_damage changed = {{0}};
    for (int32_t y = 0; y < HEIGHT; y += apart) {
        const int32_t left = 16 * (y / 8 % 2); /* bands that are not joined */
        r->pixels[y * WIDTH + left] = colour;
        lm_damage_mark(&changed, &(struct lm_rectangle){left, y, left + 1, y + 1});
    }
    return drv_drm_present(&r->drm, &r->picture, &changed, r->now_us);
}

static void open_with_clips(struct rig *r)
{
    set_up(r, &standard);
    fake_drm.takes_clips = true;
    drv_drm_close(&r->drm);
    assert_int_equal(drv_drm_open(&r->drm, &standard, r->now_us), LM_OK);
    for (uint32_t n = 1; n <= DRV_DRM_BUFFERS + 1; n++) {
        assert_int_equal(show(r, n), LM_OK);
        fake_drm_blank();
        wait_us(r, TICK_US);
    }
    assert_int_equal(r->drm.count.clipped, 1);
}

TEST(the_last_clip_holds_all_that_others_do_not)
{
    static struct rig r;
    open_with_clips(&r);
    for (uint32_t n = 4; n < 8; n++) {
        assert_int_equal(change_rows(&r, 1, n), LM_OK);
        /* Before that, a buffer lacks all of the picture. */
        assert_int_equal(r.drm.clips, n < 5 ? 1 : DRV_DRM_CLIPS);
        fake_drm_blank();
        wait_us(&r, TICK_US);
        assert_true(show_copies());
    }
    drv_drm_close(&r.drm);
}

/* What was drawn and never shown is in no copy. */
TEST(after_a_flip_that_failed_the_next_ones_have_no_clips)
{
    static struct rig r;
    open_with_clips(&r);
    fake_drm.atomic_errno = fake_drm.flip_errno = EACCES;
    assert_int_equal(change_rows(&r, 1, 4), LM_ERR_IO);
    fake_drm.atomic_errno = fake_drm.flip_errno = 0;
    wait_us(&r, 2 * DRV_DRM_LOOK_US);
    for (uint32_t n = 5; n < 9; n++) {
        assert_int_equal(change_rows(&r, 100, n), LM_OK);
        fake_drm_blank();
        wait_us(&r, TICK_US);
        assert_true(show_copies());
    }
    assert_int_equal(r.drm.count.clipped, 3);
    drv_drm_close(&r.drm);
}

TEST(a_card_that_refuses_clips_is_asked_without)
{
    static struct rig r;
    fake_drm_reset();
    set_up(&r, &standard);
    fake_drm.takes_clips = true;
    drv_drm_close(&r.drm);
    assert_int_equal(drv_drm_open(&r.drm, &standard, r.now_us), LM_OK);
    fake_drm.atomic_errno = EINVAL;
    for (uint32_t n = 1; n <= 5; n++) {
        assert_int_equal(show(&r, n), LM_OK);
        fake_drm_blank();
        assert_int_equal(middle(), n);
        wait_us(&r, TICK_US);
    }
    assert_int_equal(r.drm.count.clipped, 0);
    assert_int_equal(r.drm.count.errors, 0);
    assert_int_equal(fake_drm.live_blobs, 0);
    drv_drm_close(&r.drm);
}

TEST(no_second_picture_is_taken_while_one_is_on_its_way)
{
    static struct rig r;
    set_up(&r, &standard);
    assert_int_equal(show(&r, 1), LM_OK);
    wait_us(&r, 10 * TICK_US);
    assert_int_equal(show(&r, 2), LM_BUSY);
    assert_int_equal(fake_drm.flips, 1);
    fake_drm_blank();
    wait_us(&r, TICK_US);
    assert_int_equal(show(&r, 3), LM_OK);
    assert_int_equal(fake_drm.flips, 2);
    drv_drm_close(&r.drm);
}

TEST(a_busy_kernel_is_asked_again_and_the_picture_is_kept)
{
    static struct rig r;
    set_up(&r, &standard);
    fake_drm.flip_errno = EBUSY;
    assert_int_equal(show(&r, 7), LM_OK);
    wait_us(&r, 20 * TICK_US);
    assert_int_equal(r.drm.state, DRV_DRM_DUE);
    assert_int_equal(show(&r, 8), LM_BUSY);
    fake_drm.flip_errno = 0;
    wait_us(&r, TICK_US);
    fake_drm_blank();
    assert_int_equal(middle(), 7);
    assert_true(r.drm.count.busy >= 20);
    assert_int_equal(fake_drm.modes_set, 1);
    drv_drm_close(&r.drm);
}

TEST(a_kernel_that_stays_busy_is_told_the_mode_anew)
{
    static struct rig r;
    set_up(&r, &standard);
    fake_drm.flip_errno = EBUSY;
    assert_int_equal(show(&r, 9), LM_OK);
    wait_us(&r, DRV_DRM_FLIP_US + 10 * TICK_US);
    assert_int_equal(fake_drm.modes_set, 2);
    assert_int_equal(middle(), 9);
    assert_int_equal(r.drm.state, DRV_DRM_IDLE);
    drv_drm_close(&r.drm);
}

TEST(a_flip_that_is_never_reported_is_given_up_in_time)
{
    static struct rig r;
    set_up(&r, &standard);
    fake_drm.is_silent = true;
    for (uint32_t n = 1; n <= 5; n++) {
        assert_int_equal(show(&r, n), LM_OK);
        fake_drm_blank();
        assert_int_equal(middle(), n);
        wait_us(&r, DRV_DRM_FLIP_US - TICK_US);
        assert_int_equal(r.drm.state, DRV_DRM_FLIPPING);
        wait_us(&r, 3 * TICK_US);
        assert_int_equal(r.drm.state, DRV_DRM_IDLE);
        assert_int_equal(r.drm.count.lost, n);
    }
    assert_int_equal(r.drm.count.flips, 0);
    drv_drm_close(&r.drm);
}

/* The report of a flip that was given up must not end the next one. */
TEST(a_report_that_comes_too_late_is_only_counted)
{
    static struct rig r;
    set_up(&r, &standard);
    assert_int_equal(show(&r, 1), LM_OK);
    wait_us(&r, DRV_DRM_FLIP_US + 2 * TICK_US);
    assert_int_equal(r.drm.count.lost, 1);
    fake_drm_blank(); /* the first is reported now, and not read yet */
    assert_int_equal(show(&r, 2), LM_OK);
    wait_us(&r, TICK_US);
    assert_int_equal(r.drm.count.late, 1);
    assert_int_equal(r.drm.state, DRV_DRM_FLIPPING);
    fake_drm_blank();
    wait_us(&r, TICK_US);
    assert_int_equal(r.drm.count.flips, 1);
    assert_int_equal(middle(), 2);
    drv_drm_close(&r.drm);
}

TEST(a_screen_that_is_unplugged_comes_back_with_another_mode)
{
    static struct rig r;
    set_up(&r, &standard);
    fake_drm.has_screen = false;
    wait_us(&r, 2 * DRV_DRM_LOOK_US);
    assert_int_equal(r.drm.state, DRV_DRM_DARK);
    assert_non_null(strstr(r.drm.error, "HDMI-A-1"));
    assert_int_equal(show(&r, 5), LM_OK); /* seen by nobody */
    fake_drm.has_screen = true;
    fake_drm.width = 1024;
    fake_drm.height = 768;
    wait_us(&r, 2 * DRV_DRM_LOOK_US);
    assert_int_equal(r.drm.state, DRV_DRM_IDLE);
    assert_int_equal(r.drm.width_px, 1024);
    assert_int_equal(fake_drm.live_buffers, 2);
    assert_int_equal(show(&r, 6), LM_OK);
    fake_drm_blank();
    assert_int_equal(middle(), 6);
    drv_drm_close(&r.drm);
}

/* Looking must not make the kernel read the screen's description: that takes long. */
TEST(looking_after_a_screen_that_is_there_probes_nothing)
{
    static struct rig r;
    set_up(&r, &standard);
    const uint32_t probes = fake_drm.probes;
    wait_us(&r, 5 * DRV_DRM_LOOK_US);
    assert_int_equal(fake_drm.probes, probes);
    drv_drm_close(&r.drm);
}

TEST(a_screen_that_comes_later_than_the_program_is_lit)
{
    static struct rig r;
    fake_drm_reset();
    fake_drm.has_screen = false;
    r.picture = (struct lm_surface){
        .pixels = r.pixels, .stride_px = WIDTH, .width_px = WIDTH, .height_px = HEIGHT};
    r.now_us = 0;
    assert_int_equal(drv_drm_open(&r.drm, &standard, 0), LM_OK);
    assert_int_equal(r.drm.state, DRV_DRM_DARK);
    fake_drm.has_screen = true;
    wait_us(&r, 2 * DRV_DRM_LOOK_US);
    assert_int_equal(r.drm.state, DRV_DRM_IDLE);
    drv_drm_close(&r.drm);
}

TEST(a_program_that_takes_the_screen_is_outlived)
{
    static struct rig r;
    set_up(&r, &standard);
    fake_drm.is_foreign = true;
    fake_drm.flip_errno = EACCES;
    assert_int_equal(show(&r, 1), LM_ERR_IO);
    assert_int_equal(r.drm.state, DRV_DRM_DARK);
    wait_us(&r, 3 * DRV_DRM_LOOK_US);
    assert_non_null(strstr(r.drm.error, "another program"));
    fake_drm.is_foreign = false;
    fake_drm.flip_errno = 0;
    wait_us(&r, 2 * DRV_DRM_LOOK_US);
    assert_int_equal(r.drm.state, DRV_DRM_IDLE);
    assert_true(fake_drm.masters >= 2);
    drv_drm_close(&r.drm);
}

TEST(the_end_gives_the_screen_and_the_memory_back)
{
    static struct rig r;
    set_up(&r, &standard);
    assert_int_equal(show(&r, 1), LM_OK);
    drv_drm_close(&r.drm);
    assert_int_equal(fake_drm.shown, CONSOLE);
    assert_int_equal(fake_drm.live_buffers, 0);
    assert_int_equal(fake_drm.live_framebuffers, 0);
    drv_drm_close(&r.drm); /* once more does no harm */
}

TEST(signals_interrupt_no_call)
{
    static struct rig r;
    set_up(&r, &standard);
    for (uint32_t n = 1; n < 20; n++) {
        fake_drm.interrupts = 3;
        assert_int_equal(show(&r, n), LM_OK);
        assert_int_equal(r.drm.state, DRV_DRM_FLIPPING);
        fake_drm_blank();
        wait_us(&r, TICK_US);
    }
    assert_int_equal(r.drm.count.errors, 0);
    drv_drm_close(&r.drm);
}

TEST(the_mode_and_the_connector_of_the_configuration_are_kept_to)
{
    static struct rig r;
    struct drv_drm_config config = standard;
    fake_drm_reset();
    fake_drm.extra_modes = 3;
    config.width_px = 320;
    config.height_px = 200;
    assert_int_equal(drv_drm_open(&r.drm, &config, 0), LM_OK);
    assert_int_equal(r.drm.height_px, 200);
    drv_drm_close(&r.drm);
    config.height_px = 201;
    assert_int_equal(drv_drm_open(&r.drm, &config, 0), LM_OK);
    assert_int_equal(r.drm.state, DRV_DRM_DARK);
    assert_non_null(strstr(r.drm.error, "mode asked for"));
    drv_drm_close(&r.drm);
    config = standard;
    config.connector = "DP-1";
    assert_int_equal(drv_drm_open(&r.drm, &config, 0), LM_OK);
    assert_non_null(strstr(r.drm.error, "connector asked for"));
    drv_drm_close(&r.drm);
}

TEST(sixteen_bits_are_asked_for_when_they_are_wanted)
{
    static struct rig r;
    struct drv_drm_config config = standard;
    config.format = DRV_RGB565;
    set_up(&r, &config);
    assert_int_equal(show(&r, 0xffffff), LM_OK);
    fake_drm_blank();
    assert_int_equal(fake_drm.buffer[fake_drm.handle_of_shown - 1].bpp, 16);
    assert_int_equal(middle(), 0xffffffff); /* two pixels */
    drv_drm_close(&r.drm);
}

TEST(a_card_without_plain_memory_and_no_card_at_all_are_errors)
{
    struct drv_drm drm;
    fake_drm_reset();
    fake_drm.has_dumb = false;
    assert_int_equal(drv_drm_open(&drm, &standard, 0), LM_ERR_IO);
    assert_int_equal(drm.fd, -1);
    const struct drv_drm_config nowhere = {.device = "/dev/dri/none"};
    assert_int_equal(drv_drm_open(&drm, &nowhere, 0), LM_ERR_IO);
    assert_non_null(strstr(drm.error, "/dev/dri/none"));
    drv_drm_close(&drm);
}
