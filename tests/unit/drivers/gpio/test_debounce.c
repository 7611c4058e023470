/* Keys that bounce, glitch, stick, and lose their events. */
#include "check.h"
#include "drv/debounce.h"

enum { PERIOD_US = 10000, STEP_US = 500, KEY = 5 };

static struct drv_debounce idle(void)
{
    struct drv_debounce d;
    drv_debounce_init(&d, PERIOD_US, 0);
    return d;
}

/* Look every STEP_US until `until_us`; returns how often the belief about KEY changed. */
static int watch(struct drv_debounce *d, uint64_t level, uint64_t *now_us, uint64_t until_us)
{
    int changes = 0;
    for (; *now_us < until_us; *now_us += STEP_US) {
        changes += (drv_debounce_look(d, level << KEY, 0, *now_us) >> KEY & 1) != 0;
    }
    return changes;
}

TEST(a_press_is_believed_once_after_the_period)
{
    struct drv_debounce d = idle();
    uint64_t now = 0;
    assert_int_equal(watch(&d, 1, &now, PERIOD_US), 0);
    assert_true(drv_debounce_is_waiting(&d));
    assert_int_equal(watch(&d, 1, &now, 10 * PERIOD_US), 1);
    assert_true(d.down == 1u << KEY);
    assert_false(drv_debounce_is_waiting(&d));
    assert_int_equal(watch(&d, 0, &now, 20 * PERIOD_US), 1);
    assert_true(d.down == 0);
}

/* Nine bounces within 5 ms, as the virtual machine's gpio-sim was made to do them. */
TEST(bounces_make_one_press)
{
    struct drv_debounce d = idle();
    uint64_t now = 0;
    int changes = 0;
    for (int i = 0; i < 9; i++) {
        changes += watch(&d, (uint64_t)(i & 1), &now, now + STEP_US);
    }
    assert_int_equal(changes + watch(&d, 1, &now, now + 2 * PERIOD_US), 1);
    assert_true(d.down == 1u << KEY);
}

TEST(a_glitch_shorter_than_the_period_is_nothing)
{
    struct drv_debounce d = idle();
    uint64_t now = 0;
    assert_int_equal(watch(&d, 1, &now, PERIOD_US - STEP_US), 0);
    assert_int_equal(watch(&d, 0, &now, 10 * PERIOD_US), 0);
}

TEST(an_edge_between_two_looks_that_agree_is_movement)
{
    struct drv_debounce d = idle();
    const uint64_t key = 1u << KEY;
    drv_debounce_look(&d, key, key, 0);
    drv_debounce_look(&d, key, key, PERIOD_US - 1); /* it has moved, and is back */
    assert_true(drv_debounce_look(&d, key, 0, PERIOD_US) == 0);
    assert_true(drv_debounce_look(&d, key, 0, 2 * PERIOD_US - 1) == key);
}

TEST(a_key_that_is_down_at_the_start_counts_only_once_it_was_let_go)
{
    struct drv_debounce d;
    const uint64_t key = 1u << KEY;
    drv_debounce_init(&d, PERIOD_US, key);
    uint64_t now = 0;
    assert_int_equal(watch(&d, 1, &now, 10 * PERIOD_US), 0);
    assert_true(drv_debounce_stuck(&d, now, UINT64_MAX) == key);
    assert_int_equal(watch(&d, 0, &now, 20 * PERIOD_US), 0);
    assert_true(drv_debounce_stuck(&d, now, UINT64_MAX) == 0);
    assert_int_equal(watch(&d, 1, &now, 30 * PERIOD_US), 1);
    assert_true(d.down == key);
}

TEST(a_key_that_is_held_is_stuck_after_the_time_said)
{
    struct drv_debounce d = idle();
    uint64_t now = 0;
    watch(&d, 1, &now, 2 * PERIOD_US);
    assert_true(drv_debounce_stuck(&d, PERIOD_US + 15000000 - 1, 15000000) == 0);
    assert_true(drv_debounce_stuck(&d, PERIOD_US + 15000000, 15000000) == 1u << KEY);
}

/* All 64 lines at once, the last one too. */
TEST(every_line_has_its_own_time)
{
    struct drv_debounce d = idle();
    uint64_t levels = 0, changed = 0;
    for (uint64_t now = 0; now < 64 + PERIOD_US; now++) {
        levels |= now < 64 ? UINT64_C(1) << now : 0;
        const uint64_t c = drv_debounce_look(&d, levels, 0, now);
        if (now >= PERIOD_US) {
            assert_true(c == UINT64_C(1) << (now - PERIOD_US));
        } else {
            assert_true(c == 0);
        }
        changed |= c;
    }
    assert_true(changed == UINT64_MAX);
    assert_true(d.down == UINT64_MAX);
}
