/* When a button acts: lm/keys.h, sentence by sentence. */
#include "check.h"
#include "lm/keys.h"

enum { BUTTON = 7, STEP_US = 2000 };

/* Acts of a button that is held from 0 to `held_us`, counting short and long ones. */
static void hold_button(enum lm_key_style style, uint64_t held_us, int *shorts, int *longs)
{
    struct lm_keys keys = {0};
    struct lm_press press;
    *longs = 0;
    *shorts = lm_keys_down(&keys, BUTTON, style, 0);
    for (uint64_t now = STEP_US; now < held_us; now += STEP_US) {
        while (lm_keys_held(&keys, now, &press)) {
            assert_int_equal(press.button, BUTTON);
            *(press.is_long ? longs : shorts) += 1;
        }
    }
    *shorts += lm_keys_up(&keys, BUTTON, held_us);
    assert_int_equal(keys.down, 0);
}

TEST(a_plain_key_acts_once_when_it_goes_down_however_long_it_is_held)
{
    const uint64_t held[] = {STEP_US, 400000, 900000, 30000000};
    for (size_t i = 0; i < sizeof held / sizeof *held; i++) {
        int shorts, longs;
        hold_button(LM_KEY_ONCE, held[i], &shorts, &longs);
        assert_int_equal(shorts, 1);
        assert_int_equal(longs, 0);
    }
}

TEST(a_repeating_key_waits_half_a_second_then_acts_ten_times_a_second)
{
    const struct {
        uint64_t held_us;
        int acts;
    } cases[] = {{490000, 1}, {510000, 2}, {590000, 2}, {610000, 3}, {1510000, 12}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int shorts, longs;
        hold_button(LM_KEY_REPEATS, cases[i].held_us, &shorts, &longs);
        assert_int_equal(shorts, cases[i].acts);
        assert_int_equal(longs, 0);
    }
}

TEST(a_key_with_a_long_meaning_acts_when_let_go_or_once_when_held)
{
    int shorts, longs;
    hold_button(LM_KEY_HAS_LONG, 790000, &shorts, &longs);
    assert_int_equal(shorts, 1);
    assert_int_equal(longs, 0);
    hold_button(LM_KEY_HAS_LONG, 810000, &shorts, &longs);
    assert_int_equal(shorts, 0);
    assert_int_equal(longs, 1);
    hold_button(LM_KEY_HAS_LONG, 9000000, &shorts, &longs);
    assert_int_equal(shorts, 0);
    assert_int_equal(longs, 1);
}

/* A release whose press was lost, or that comes twice, is none of a key. */
TEST(a_key_that_is_let_go_and_was_not_down_does_not_act)
{
    struct lm_keys keys = {0};
    assert_false(lm_keys_up(&keys, BUTTON, 1000));
    lm_keys_down(&keys, BUTTON, LM_KEY_HAS_LONG, 2000);
    assert_false(lm_keys_up(&keys, BUTTON + 1, 3000));
    assert_true(lm_keys_up(&keys, BUTTON, 4000));
    assert_false(lm_keys_up(&keys, BUTTON, 5000));
}

TEST(a_stuck_key_is_counted_once_and_means_nothing_until_it_is_let_go)
{
    struct lm_keys keys = {0};
    struct lm_press press;
    lm_keys_down(&keys, BUTTON, LM_KEY_REPEATS, 0);
    int late = 0;
    for (uint64_t now = 0; now < 40000000; now += 50000) {
        while (lm_keys_held(&keys, now, &press)) {
            late += now >= LM_KEY_STUCK_US;
        }
    }
    assert_int_equal(late, 0);
    assert_int_equal(keys.count.stuck, 1);
    lm_keys_up(&keys, BUTTON, 40000000);
    assert_true(lm_keys_down(&keys, BUTTON, LM_KEY_REPEATS, 41000000));
    assert_true(lm_keys_held(&keys, 41600000, &press));
}

TEST(a_lost_release_and_a_release_out_of_nowhere_do_no_harm)
{
    struct lm_keys keys = {0};
    assert_false(lm_keys_up(&keys, BUTTON, 5));
    assert_true(lm_keys_down(&keys, BUTTON, LM_KEY_ONCE, 10));
    assert_true(lm_keys_down(&keys, BUTTON, LM_KEY_ONCE, 20));
    assert_false(lm_keys_up(&keys, BUTTON, 30));
    assert_false(lm_keys_up(&keys, BUTTON, 40));
}

TEST(two_keys_at_once_do_not_disturb_each_other)
{
    struct lm_keys keys = {0};
    struct lm_press press;
    int acts[LM_BUTTONS + 1] = {0};
    acts[LM_BUTTONS] += lm_keys_down(&keys, LM_BUTTONS, LM_KEY_REPEATS, 0);
    for (uint64_t now = 0; now < 1000000; now += STEP_US) {
        if (now == 100000) {
            acts[1] += lm_keys_down(&keys, 1, LM_KEY_REPEATS, now);
        }
        while (lm_keys_held(&keys, now, &press)) {
            acts[press.button]++;
        }
    }
    assert_int_equal(acts[LM_BUTTONS], 6); /* 0, 0.5, 0.6, 0.7, 0.8, 0.9 */
    assert_int_equal(acts[1], 5);
}

TEST(a_key_let_go_at_the_very_moment_of_its_long_meaning_has_no_short_one)
{
    struct lm_keys keys = {0};
    struct lm_press press;
    assert_false(lm_keys_down(&keys, BUTTON, LM_KEY_HAS_LONG, 0));
    assert_true(lm_keys_held(&keys, LM_KEY_LONG_US, &press) && press.is_long);
    assert_false(lm_keys_up(&keys, BUTTON, LM_KEY_LONG_US));
}
