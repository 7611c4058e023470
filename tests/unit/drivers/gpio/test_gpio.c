/* The GPIO driver over both versions of libgpiod: this file is linked once with each. */
#include "check.h"
#include "drv/gpio.h"
#include "fake_gpio.h"

#include "lm/status.h"

#include <poll.h>
#include <string.h>

static struct fake_line *const osb1 = &fake_chips[1].line[3];
static struct fake_line *const osb2 = &fake_chips[1].line[4];
static struct fake_line *const alive = &fake_chips[1].line[9];

static void set_up(struct drv_gpio *g)
{
    fake_gpio_reset();
    assert_int_equal(drv_gpio_open(g), LM_OK);
}

static bool wakes(const struct drv_gpio *g)
{
    struct pollfd p = {.fd = g->fd, .events = POLLIN};
    return poll(&p, 1, 0) == 1;
}

TEST(lines_are_found_by_name_and_read_as_active_or_not)
{
    struct drv_gpio g;
    set_up(&g);
    osb1->level = osb2->level = true; /* at rest, pulled up */
    assert_int_equal(drv_gpio_add_input(&g, "OSB2", true), 0);
    assert_int_equal(drv_gpio_add_input(&g, "OSB1", true), 1);
    assert_true(drv_gpio_levels(&g) == 0);
    fake_gpio_drive(osb1, false);
    assert_true(drv_gpio_levels(&g) == 2);
    fake_gpio_drive(osb2, false);
    assert_true(drv_gpio_levels(&g) == 3);
    drv_gpio_close(&g);
}

TEST(a_line_without_a_name_is_found_by_chip_and_number)
{
    struct drv_gpio g;
    set_up(&g);
    assert_int_equal(drv_gpio_add_input(&g, "9030000.pl061:5", false), 0);
    assert_int_equal(drv_gpio_add_input(&g, "gpiochip1:39", false), 1);
    fake_gpio_drive(&fake_chips[0].line[5], true);
    assert_true(drv_gpio_levels(&g) == 1);
    fake_gpio_drive(&fake_chips[1].line[39], true);
    assert_true(drv_gpio_levels(&g) == 3);
    drv_gpio_close(&g);
}

TEST(what_is_not_there_is_told_and_leaves_nothing_open)
{
    static const char *const missing[] = {"OSB99",    "bezel:40", "bezel:",        ":3",
                                          "nobody:3", "bezel:3x", "bezel:99999999"};
    struct drv_gpio g;
    set_up(&g);
    for (size_t i = 0; i < sizeof missing / sizeof missing[0]; i++) {
        assert_int_equal(drv_gpio_add_input(&g, missing[i], false), LM_ERR_IO);
        assert_non_null(strstr(g.error, missing[i]));
    }
    osb1->is_taken = true;
    assert_int_equal(drv_gpio_add_input(&g, "OSB1", false), LM_ERR_IO);
    assert_int_equal(g.input_count, 0);
    assert_int_equal(fake_chips[0].opens + fake_chips[1].opens, 0);
    drv_gpio_close(&g);
}

TEST(an_edge_wakes_the_loop_until_it_was_taken)
{
    struct drv_gpio g;
    set_up(&g);
    assert_int_equal(drv_gpio_add_input(&g, "OSB1", false), 0);
    assert_int_equal(drv_gpio_add_input(&g, "OSB2", false), 1);
    assert_false(wakes(&g));
    fake_gpio_drive(osb2, true);
    assert_true(wakes(&g));
    assert_true(drv_gpio_take_edges(&g) == 2);
    assert_false(wakes(&g));
    assert_true(drv_gpio_take_edges(&g) == 0); /* and does not wait */
    drv_gpio_close(&g);
}

/* 41 edges of which the kernel kept 16, and a level that none of them tells: the driver believes
 * the level. */
TEST(after_a_storm_of_edges_the_level_is_right)
{
    struct drv_gpio g;
    set_up(&g);
    assert_int_equal(drv_gpio_add_input(&g, "OSB1", false), 0);
    for (int i = 0; i < 41; i++) {
        fake_gpio_drive(osb1, (i & 1) == 0);
    }
    assert_true(drv_gpio_take_edges(&g) == 1);
    assert_true(drv_gpio_levels(&g) == 1);
    assert_false(wakes(&g));
    drv_gpio_close(&g);
}

TEST(a_line_that_cannot_interrupt_is_had_without)
{
    struct drv_gpio g;
    set_up(&g);
    osb1->no_interrupt = true;
    assert_int_equal(drv_gpio_add_input(&g, "OSB1", false), 0);
    assert_int_equal(g.input[0].fd, -1);
    fake_gpio_drive(osb1, true);
    assert_true(drv_gpio_levels(&g) == 1);
    drv_gpio_close(&g);
}

TEST(a_line_that_fails_counts_as_let_go)
{
    struct drv_gpio g;
    set_up(&g);
    assert_int_equal(drv_gpio_add_input(&g, "OSB1", false), 0);
    fake_gpio_drive(osb1, true);
    assert_true(drv_gpio_levels(&g) == 1);
    osb1->is_broken = true;
    assert_true(drv_gpio_levels(&g) == 0);
    assert_int_equal(g.count.errors, 1);
    drv_gpio_close(&g);
}

TEST(lamps_begin_dark_and_shine_at_either_level)
{
    for (int is_active_low = 0; is_active_low < 2; is_active_low++) {
        struct drv_gpio g;
        set_up(&g);
        alive->level = !is_active_low;
        assert_int_equal(drv_gpio_add_output(&g, "ALIVE", is_active_low), 0);
        assert_int_equal(alive->level, is_active_low);
        drv_gpio_set(&g, 0, true);
        assert_int_equal(alive->level, !is_active_low);
        drv_gpio_set(&g, 0, false);
        assert_int_equal(alive->level, is_active_low);
        assert_int_equal(g.count.errors, 0);
        drv_gpio_close(&g);
    }
}

TEST(closing_gives_every_line_and_chip_back)
{
    struct drv_gpio g;
    set_up(&g);
    for (int i = 0; i < FAKE_LINES; i++) {
        char name[16] = "bezel:";
        name[6] = (char)('0' + i / 10);
        name[7] = (char)('0' + i % 10);
        assert_int_equal(drv_gpio_add_input(&g, name, false), i);
    }
    assert_int_equal(fake_chips[1].opens, FAKE_LINES);
    drv_gpio_close(&g);
    assert_int_equal(fake_chips[1].opens, 0);
    assert_false(osb1->is_requested);
    assert_int_equal(g.fd, -1);
}
