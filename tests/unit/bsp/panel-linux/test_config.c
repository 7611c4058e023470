/* The configuration file: what it takes, and what it does with lines that are wrong. */
#include "check.h"
#include "config.h"

#include <stdio.h>
#include <string.h>

struct told {
    uint32_t count, line;
    char cause[128];
};

static void tell(void *ctx, uint32_t line, const char *cause)
{
    struct told *t = ctx;
    t->count++;
    t->line = line;
    snprintf(t->cause, sizeof t->cause, "%s", cause);
}

static struct told read_text(struct config *c, const char *text)
{
    struct told t = {0};
    config_defaults(c);
    const uint32_t wrong = config_read(c, text, strlen(text), tell, &t);
    assert_int_equal(wrong, t.count);
    return t;
}

TEST(every_default_is_a_value_of_its_option)
{
    struct config defaults, c;
    char text[CONFIG_FILE_BYTES] = "";
    for (uint32_t i = 0; i < config_option_count(); i++) {
        const struct config_option o = config_option_at(i);
        const size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s = %s\n", o.name, o.initial);
        assert_true(strlen(o.values) > 0 && strlen(o.help) > 10);
    }
    config_defaults(&defaults);
    const struct told t = read_text(&c, text);
    assert_int_equal(t.count, 0);
    assert_memory_equal(&c, &defaults, sizeof c);
    assert_string_equal(c.can, "can0");
    assert_int_equal(c.priority, 40);
    assert_int_equal(c.locks_memory, 1);
    assert_int_equal(c.key_active_low, 1);
    assert_string_equal(c.key[3], "");
    assert_int_equal(c.stick.choice, CONFIG_STICK_AUTO);
    assert_int_equal(c.stick_map.up.usage, DRV_STICK_X + 1);
    assert_true(c.stick_map.up.is_inverted);
    assert_int_equal(c.stick_map.button[0].act, DRV_STICK_DESIGNATE);
}

/* Every option, given a value that none of them takes, is refused, named by its line, and as it
 * was. Texts and paths take nearly anything, so theirs is too long. */
TEST(every_option_refuses_what_is_no_value_of_it)
{
    char nonsense[200];
    memset(nonsense, '~', sizeof nonsense - 1);
    nonsense[sizeof nonsense - 1] = '\0';
    for (uint32_t i = 0; i < config_option_count(); i++) {
        struct config defaults, c;
        char text[400];
        config_defaults(&defaults);
        snprintf(text, sizeof text, "# first\n\n%s = %s\n", config_option_at(i).name, nonsense);
        const struct told t = read_text(&c, text);
        assert_int_equal(t.count, 1);
        assert_int_equal(t.line, 3);
        assert_memory_equal(&c, &defaults, sizeof c);
    }
}

TEST(every_profile_of_the_bus_is_a_choice)
{
    for (const struct lm_bus_named_profile *p = lm_bus_profiles; p->name != NULL; p++) {
        struct config c;
        char text[100];
        snprintf(text, sizeof text, "can.profile = %s\n", p->name);
        assert_int_equal(read_text(&c, text).count, 0);
        assert_ptr_equal(c.can_profile, p->profile);
    }
    struct config c;
    assert_int_equal(read_text(&c, "can.profile = auto\n").count, 0);
    assert_null(c.can_profile);
}

TEST(a_list_of_nodes_is_numbers_between_commas)
{
    struct config c;
    assert_int_equal(read_text(&c, "can.nodes = 1,17,255\n").count, 0);
    assert_true(c.can_nodes.is_list);
    for (int node = 0; node < 256; node++) {
        const bool is_heard = lm_bus_is_heard(c.can_nodes.bits, (uint8_t)node);
        assert_int_equal(is_heard, node == 1 || node == 17 || node == 255);
    }
    assert_int_equal(read_text(&c, "can.nodes = all\n").count, 0);
    assert_false(c.can_nodes.is_list);
    static const char *const wrong[] = {"0", "256", "1,", ",1", "1,,2", "1 2", "a", "-1"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[60];
        snprintf(text, sizeof text, "can.nodes = %s\n", wrong[i]);
        assert_int_equal(read_text(&c, text).count, 1);
        assert_false(c.can_nodes.is_list);
    }
}

TEST(numbers_are_held_to_their_range)
{
    static const struct {
        const char *text;
        bool is_good;
    } cases[] = {
        {"realtime.priority = 0", true},
        {"realtime.priority = 90", true},
        {"realtime.priority = 91", false},
        {"realtime.priority = -1", false},
        {"realtime.priority = 4 0", false},
        {"realtime.priority = 0x10", false},
        {"realtime.priority =", false},
        {"keys.debounce = 0", false},
        {"keys.debounce = 1", true},
        {"keys.debounce = 50", true},
        {"keys.debounce = 51", false},
        {"seed = 2147483647", true},
        {"seed = 2147483648", false},
        {"seed = 99999999999999999999", false},
        {"tiles = 119", false},
        {"tiles = 512", true},
        {"glass.picture = 256x1024", true},
        {"glass.picture = 255x1024", false},
        {"glass.picture = 256x1025", false},
        {"glass.picture = 256", false},
        {"glass.picture = 256x", false},
        {"glass.picture = x256", false},
        {"glass.picture = 256x256x256", false},
        {"glass.turn = 90", true},
        {"glass.turn = 45", false},
        {"glass.turn = 9", false},
        {"can = 123456789012345", true},
        {"can = 1234567890123456", false},
        {"database = relative/path", false},
        {"watchdog = none", true},
        {"stick = 046d:c215", true},
        {"stick = 046D:C215:0042", true},
        {"stick = 046d", false},
        {"stick = 046d:", false},
        {"stick = 046d:c215:", false},
        {"stick = 0046d:c215", false},
        {"stick = g46d:c215", false},
        {"stick.up = -hatx", true},
        {"stick.up = throttle", true},
        {"stick.up = -none", false},
        {"stick.up = w", false},
        {"stick.button.32 = con-", true},
        {"stick.button.1 = 20", true},
        {"stick.button.1 = 21", false},
        {"stick.button.33 = 1", false},
        {"key.21 = A", false},
        {"key.gain+ = A LINE", true},
        {"unknown = 1", false},
        {"can can0", false},
        {"= 1", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct config c;
        const struct told t = read_text(&c, cases[i].text);
        if ((t.count == 0) != cases[i].is_good) {
            fail_msg("%s: %s", cases[i].text, t.count ? t.cause : "accepted");
        }
    }
}

TEST(values_arrive_where_they_belong)
{
    struct config c;
    const struct told t = read_text(&c,
                                    "\t can=vcan1\r\n"
                                    "glass.mode = 800x480 # a remark\n"
                                    "key.20=BEZEL#20\n"
                                    "  # stick = none\n"
                                    "stick = 1209:0c0d:AB:1\n"
                                    "stick.button.9 = brt-\n"
                                    "backlight = panel-0\n"
                                    "glass.turn = 270");
    assert_int_equal(t.count, 0);
    assert_string_equal(c.can, "vcan1");
    assert_int_equal(c.glass_mode.width_px, 800);
    assert_int_equal(c.glass_mode.height_px, 480);
    assert_string_equal(c.key[19], "BEZEL#20");
    assert_int_equal(c.stick.choice, CONFIG_STICK_NAMED);
    assert_int_equal(c.stick.vendor, 0x1209);
    assert_int_equal(c.stick.product, 0x0c0d);
    assert_string_equal(c.stick.serial, "AB:1");
    assert_int_equal(c.stick_map.button[8].act, DRV_STICK_PRESS);
    assert_int_equal(c.stick_map.button[8].button, lm_rocker_button(LM_ROCKER_BRT, false));
    assert_string_equal(c.backlight, "panel-0");
    assert_int_equal(c.glass_turn, DRV_TURN_270);
}

TEST(an_option_that_is_given_twice_keeps_its_first_value)
{
    struct config c;
    const struct told t = read_text(&c, "can = a\nseed = 1\ncan = b\n");
    assert_int_equal(t.count, 1);
    assert_int_equal(t.line, 3);
    assert_string_equal(c.can, "a");
}

TEST(a_wrong_line_does_not_hide_the_right_one_behind_it)
{
    struct config c;
    const struct told t = read_text(&c, "seed = x\nseed = 7\n");
    assert_int_equal(t.count, 1);
    assert_int_equal(t.line, 1);
    assert_int_equal(c.seed, 7);
}

TEST(what_is_no_text_and_what_is_too_long_loses_only_its_line)
{
    struct config c;
    struct told t = {0};
    char text[1024] = "can = x\001\n";
    memset(text + strlen(text), 'a', 300);
    strcat(text, "\nseed = 3\n");
    const size_t size = strlen(text) + 5; /* zeros behind it: a last line that is no text */
    config_defaults(&c);
    assert_int_equal(config_read(&c, text, size, tell, &t), 3);
    assert_int_equal(t.line, 4);
    assert_string_equal(c.can, "can0");
    assert_int_equal(c.seed, 3);
}
