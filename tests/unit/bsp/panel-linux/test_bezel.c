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
static struct fake_line *const alive = &fake_chips[1].line[9];

/* Keys on OSB1 (button 1), OSB2 (button 20) and a line without a name (designate), all at rest. */
static void set_up(struct bezel *b, struct config *c)
{
    config_defaults(c);
    snprintf(c->key[0], CONFIG_NAME, "OSB1");
    snprintf(c->key[19], CONFIG_NAME, "OSB2");
    snprintf(c->key[CONFIG_KEY_DESIGNATE], CONFIG_NAME, "9030000.pl061:0");
    snprintf(c->led[CONFIG_LED_ALIVE], CONFIG_NAME, "ALIVE");
    fake_gpio_reset();
    osb1->level = osb2->level = fake_chips[0].line[0].level = true;
    bezel_open(b, c, 0);
    assert_int_equal(b->gpio.input_count, 3);
}

static void wait_us(struct bezel *b, uint64_t *now_us, uint64_t us)
{
    for (const uint64_t end = *now_us + us; *now_us < end; *now_us += STEP_US) {
        bezel_service(b, *now_us);
    }
}

static void expect(struct bezel *b, struct lm_control expected)
{
    struct lm_control c = {0};
    assert_true(drv_control_ring_take(&b->ring, &c));
    assert_same_control(&c, expected);
}

static void expect_nothing(struct bezel *b)
{
    struct lm_control c;
    assert_false(drv_control_ring_take(&b->ring, &c));
}

TEST(each_key_is_the_button_that_the_configuration_says)
{
    static struct bezel b;
    static struct config c;
    uint64_t now = 0;
    set_up(&b, &c);
    fake_gpio_drive(osb2, false);
    wait_us(&b, &now, 50000);
    expect(&b, lm_control_button(true, 20));
    fake_gpio_drive(osb1, false);
    fake_gpio_drive(osb2, true);
    wait_us(&b, &now, 50000);
    expect(&b, lm_control_button(true, 1));
    expect(&b, lm_control_button(false, 20));
    fake_gpio_drive(&fake_chips[0].line[0], false);
    wait_us(&b, &now, 50000);
    fake_gpio_drive(&fake_chips[0].line[0], true);
    wait_us(&b, &now, 50000);
    expect(&b, lm_control_designate());
    expect_nothing(&b);
    bezel_close(&b);
}

/* The kernel's event is lost: the level is noticed all the same. */
TEST(a_press_whose_event_was_lost_is_noticed_within_a_tenth_of_a_second)
{
    static struct bezel b;
    static struct config c;
    uint64_t now = 0;
    set_up(&b, &c);
    osb1->level = false;
    wait_us(&b, &now, 100000 + 1000 * c.debounce_ms + 2 * STEP_US);
    expect(&b, lm_control_button(true, 1));
    bezel_close(&b);
}

TEST(a_key_that_is_down_at_the_start_is_stuck_and_means_nothing)
{
    static struct bezel b;
    static struct config c;
    uint64_t now = 0;
    set_up(&b, &c);
    bezel_close(&b);
    fake_chips[1].line[3].level = false;
    bezel_open(&b, &c, 0);
    assert_true(bezel_is_stuck(&b));
    wait_us(&b, &now, 500000);
    expect_nothing(&b);
    fake_gpio_drive(osb1, true);
    wait_us(&b, &now, 500000);
    assert_false(bezel_is_stuck(&b));
    expect_nothing(&b);
    fake_gpio_drive(osb1, false);
    wait_us(&b, &now, 500000);
    expect(&b, lm_control_button(true, 1));
    bezel_close(&b);
}

TEST(a_key_that_is_held_for_fifteen_seconds_is_stuck_until_it_is_let_go)
{
    static struct bezel b;
    static struct config c;
    uint64_t now = 0;
    set_up(&b, &c);
    fake_gpio_drive(osb1, false);
    wait_us(&b, &now, 14900000);
    assert_false(bezel_is_stuck(&b));
    wait_us(&b, &now, 300000);
    assert_true(bezel_is_stuck(&b));
    fake_gpio_drive(osb1, true);
    wait_us(&b, &now, 200000);
    assert_false(bezel_is_stuck(&b));
    bezel_close(&b);
}

TEST(a_line_that_is_missing_does_not_stop_the_others)
{
    static struct bezel b;
    static struct config c;
    uint64_t now = 0;
    set_up(&b, &c);
    bezel_close(&b);
    snprintf(c.key[4], CONFIG_NAME, "NOBODY");
    bezel_open(&b, &c, 0);
    assert_int_equal(b.gpio.input_count, 3);
    fake_gpio_drive(osb2, false);
    wait_us(&b, &now, 50000);
    expect(&b, lm_control_button(true, 20));
    bezel_close(&b);
}

TEST(lamps_and_backlight_follow_and_go_out_at_the_end)
{
    static struct bezel b;
    static struct config c;
    make_backlight(200);
    set_up(&b, &c);
    bezel_close(&b);
    snprintf(c.backlight, CONFIG_NAME, "glass");
    c.backlight_night = 15;
    bezel_open(&b, &c, 0);
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

TEST(a_backlight_that_is_not_there_is_done_without)
{
    static struct bezel b;
    static struct config c;
    set_up(&b, &c);
    bezel_close(&b);
    snprintf(c.backlight, CONFIG_NAME, "nobody");
    bezel_open(&b, &c, 0);
    assert_int_equal(b.backlight_fd, -1);
    const struct bezel_lamps night = {.is_night = true};
    bezel_show(&b, &night);
    bezel_close(&b);
}
