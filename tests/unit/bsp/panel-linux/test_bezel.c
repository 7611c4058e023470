/* The bezel: which key is which button, what is stuck, what the lamps and the backlight show. The
 * lines are those of tests/unit/drivers/gpio/fake_gpio.h; the backlight's files lie in a folder of
 * the test. */
#include "bezel.h"
#include "fake_gpio.h"
#include "support.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>

#include "check.h"
#include "control_asserts.h"

enum { STEP_US = 2000 };

int __wrap_open(const char *path, int flags, ...);
int __real_open(const char *path, int flags, ...);

/* /sys is the test's. */
int __wrap_open(const char *path, int flags, ...)
{
    char ours[256];
    if (strncmp(path, "/sys/", 5) == 0) {
        snprintf(ours, sizeof ours, "%s/tmp/bezel%s", support_build_dir(), path);
        return __real_open(ours, flags);
    }
    return __real_open(path, flags);
}

static void make_backlight(unsigned max)
{
    const char *o = support_build_dir();
    assert_int_equal(support_run("d=%s/tmp/bezel/sys/class/backlight/glass && mkdir -p $d && "
                                 "echo %u >$d/max_brightness && : >$d/brightness",
                                 o, max),
                     0);
}

static int brightness(void)
{
    char path[256];
    int value = -1;
    snprintf(path, sizeof path, "%s/tmp/bezel/sys/class/backlight/glass/brightness",
             support_build_dir());
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    if (fscanf(f, "%3d", &value) != 1) {
        value = -1;
    }
    fclose(f);
    return value;
}

static struct fake_line *const osb1 = &fake_chips[1].line[3];
static struct fake_line *const osb2 = &fake_chips[1].line[4];
static struct fake_line *const designate = &fake_chips[0].line[0];
static struct fake_line *const alive = &fake_chips[1].line[9];

static struct bezel b;
static struct config c;
static uint64_t now_us;

/* Keys on OSB1 (button 1), OSB2 (button 20) and a line without a name (designate), all at rest. */
static int set_up(void **state)
{
    (void)state;
    now_us = 0;
    config_defaults(&c);
    snprintf(c.key[0], CONFIG_NAME, "OSB1");
    snprintf(c.key[19], CONFIG_NAME, "OSB2");
    snprintf(c.key[CONFIG_KEY_DESIGNATE], CONFIG_NAME, "9030000.pl061:0");
    snprintf(c.led[CONFIG_LED_ALIVE], CONFIG_NAME, "ALIVE");
    fake_gpio_reset();
    osb1->level = osb2->level = designate->level = true;
    bezel_open(&b, &c, 0);
    return b.gpio.input_count == 3 ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    bezel_close(&b);
    return 0;
}

/* With what a test has changed of the configuration or of the lines at the start. */
static void open_again(void)
{
    bezel_close(&b);
    bezel_open(&b, &c, 0);
}

static void wait_us(uint64_t us)
{
    for (const uint64_t end_us = now_us + us; now_us < end_us; now_us += STEP_US) {
        bezel_service(&b, now_us);
    }
}

/* A key pulls its line down; then wait until it is debounced. */
static void press(struct fake_line *line)
{
    fake_gpio_drive(line, false);
    wait_us(50000);
}

static void let_go(struct fake_line *line)
{
    fake_gpio_drive(line, true);
    wait_us(50000);
}

static void expect(struct lm_control expected)
{
    struct lm_control control = {0};
    assert_true(drv_control_ring_take(&b.ring, &control));
    assert_same_control(&control, expected);
}

static void expect_nothing(void)
{
    struct lm_control control;
    assert_false(drv_control_ring_take(&b.ring, &control));
}

TEST_WITH(each_key_is_the_button_that_the_configuration_says, set_up, tear_down)
{
    press(osb2);
    expect(lm_control_button(true, 20));
    fake_gpio_drive(osb1, false);
    let_go(osb2);
    expect(lm_control_button(true, 1));
    expect(lm_control_button(false, 20));
    press(designate);
    let_go(designate);
    expect(lm_control_designate());
    expect_nothing();
}

/* The kernel's event is lost: the level is noticed all the same. */
TEST_WITH(a_press_whose_event_was_lost_is_noticed_within_a_tenth_of_a_second, set_up, tear_down)
{
    osb1->level = false;
    wait_us(100000 + 1000 * c.debounce_ms + 2 * STEP_US);
    expect(lm_control_button(true, 1));
}

TEST_WITH(a_key_that_is_down_at_the_start_is_stuck_and_means_nothing, set_up, tear_down)
{
    osb1->level = false;
    open_again();
    assert_true(bezel_is_stuck(&b));
    wait_us(500000);
    expect_nothing();
    fake_gpio_drive(osb1, true);
    wait_us(500000);
    assert_false(bezel_is_stuck(&b));
    expect_nothing();
    fake_gpio_drive(osb1, false);
    wait_us(500000);
    expect(lm_control_button(true, 1));
}

TEST_WITH(a_key_that_is_held_for_fifteen_seconds_is_stuck_until_it_is_let_go, set_up, tear_down)
{
    fake_gpio_drive(osb1, false);
    wait_us(14900000);
    assert_false(bezel_is_stuck(&b));
    wait_us(300000);
    assert_true(bezel_is_stuck(&b));
    fake_gpio_drive(osb1, true);
    wait_us(200000);
    assert_false(bezel_is_stuck(&b));
}

TEST_WITH(a_line_that_is_missing_does_not_stop_the_others, set_up, tear_down)
{
    snprintf(c.key[4], CONFIG_NAME, "NOBODY");
    open_again();
    assert_int_equal(b.gpio.input_count, 3);
    press(osb2);
    expect(lm_control_button(true, 20));
}

TEST_WITH(lamps_and_backlight_follow_and_go_out_at_the_end, set_up, tear_down)
{
    make_backlight(200);
    snprintf(c.backlight, CONFIG_NAME, "glass");
    c.backlight_night = 15;
    open_again();
    assert_int_equal(brightness(), 200);
    struct bezel_lamps lamps = {.is_lit = {[CONFIG_LED_ALIVE] = true}, .is_night = true};
    bezel_show(&b, &lamps);
    assert_true(alive->level);
    assert_int_equal(brightness() / 10, 30); /* a file keeps the third digit of "200" */
    lamps.is_night = false;
    bezel_show(&b, &lamps);
    assert_int_equal(brightness(), 200);
    bezel_close(&b);
    assert_false(alive->level);
}

TEST_WITH(a_backlight_that_is_not_there_is_done_without, set_up, tear_down)
{
    snprintf(c.backlight, CONFIG_NAME, "nobody");
    open_again();
    assert_int_equal(b.backlight_fd, -1);
    const struct bezel_lamps night = {.is_night = true};
    bezel_show(&b, &night);
}
