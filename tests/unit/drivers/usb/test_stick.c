/* What a hand on the stick means to the firmware. */
#include "drv/stick.h"

#include <string.h>

#include "check.h"
#include "control_asserts.h"

/* X, Y -127..127, slider 0..255, a hat of eight positions, 4 buttons: five bytes. */
static const uint8_t descriptor[] = {
    0x05, 0x01, 0x09, 0x04, 0xa1, 0x01, 0x15, 0x81, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x02,
    0x09, 0x30, 0x09, 0x31, 0x81, 0x02, 0x15, 0x00, 0x26, 0xff, 0x00, 0x95, 0x01, 0x09,
    0x36, 0x81, 0x02, 0x25, 0x07, 0x75, 0x04, 0x09, 0x39, 0x81, 0x42, 0x81, 0x01, 0x05,
    0x09, 0x19, 0x01, 0x29, 0x08, 0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x81, 0x02, 0xc0};
enum { REPORT = 5, CENTRED_HAT = 8 };

static struct drv_stick_config standard(void)
{
    struct drv_stick_config c = {
        .right = {.usage = DRV_STICK_X},
        .up = {.usage = DRV_STICK_X + 1, .is_inverted = true},
        .knob = {.usage = DRV_STICK_X + 6},
        .dead_percent = 10,
    };
    c.button[0].act = DRV_STICK_DESIGNATE;
    c.button[1].act = DRV_STICK_DROP;
    c.button[2] = (struct drv_stick_button){DRV_STICK_PRESS, 7};
    return c;
}

static struct drv_stick attached(const struct drv_stick_config *c)
{
    struct drv_stick s;
    drv_stick_init(&s, c);
    assert_null(drv_stick_attach(&s, descriptor, sizeof descriptor, false));
    return s;
}

static void feel(struct drv_stick *s, int x, int y, int slider, int hat, int buttons)
{
    const uint8_t report[REPORT] = {(uint8_t)x, (uint8_t)y, (uint8_t)slider, (uint8_t)hat,
                                    (uint8_t)buttons};
    drv_stick_report(s, report, sizeof report);
}

static void expect(struct drv_control_ring *ring, struct lm_control expected)
{
    struct lm_control c = {0};
    assert_true(drv_control_ring_take(ring, &c));
    assert_same_control(&c, expected);
}

static void expect_nothing(struct drv_control_ring *ring)
{
    struct lm_control c;
    assert_false(drv_control_ring_take(ring, &c));
}

TEST(full_deflection_is_full_and_away_from_the_operator_is_up)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s = attached(&c);
    struct drv_control_ring ring = {0};
    feel(&s, 127, -127, 0, CENTRED_HAT, 0);
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_slew(1000, 1000));
    expect(&ring, lm_control_knob(-1000));
    feel(&s, -127, 127, 255, CENTRED_HAT, 0);
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_slew(-1000, -1000));
    expect(&ring, lm_control_knob(1000));
    expect_nothing(&ring);
}

/* Over the whole range: nothing within the dead zone, never a step backwards, symmetric. */
TEST(deflection_grows_from_the_edge_of_the_dead_zone)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s = attached(&c);
    int before = -1000;
    for (int x = -127; x <= 127; x++) {
        feel(&s, x, 0, 128, CENTRED_HAT, 0);
        const int right = s.now.right;
        assert_true(right >= before);
        assert_int_equal(right == 0, x >= -12 && x <= 12); /* 10 % of 127 is 12.7 */
        before = right;
        feel(&s, -x, 0, 128, CENTRED_HAT, 0);
        assert_int_equal(s.now.right, -right);
    }
}

TEST(what_has_not_changed_is_not_told_again)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s = attached(&c);
    struct drv_control_ring ring = {0};
    feel(&s, 127, 0, 128, CENTRED_HAT, 0);
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_slew(1000, 0));
    feel(&s, 127, 0, 128, CENTRED_HAT, 0);
    drv_stick_tell(&s, &ring);
    expect_nothing(&ring);
}

TEST(a_button_is_told_when_it_goes_down_and_up_as_its_meaning_needs)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s = attached(&c);
    struct drv_control_ring ring = {0};
    feel(&s, 0, 0, 128, CENTRED_HAT, 0x0f);
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_designate());
    expect(&ring, lm_control_drop());
    expect(&ring, lm_control_button(true, 7));
    expect_nothing(&ring); /* the fourth means nothing */
    feel(&s, 0, 0, 128, CENTRED_HAT, 0);
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_button(false, 7));
    expect_nothing(&ring);
}

TEST(a_device_that_goes_lets_go_of_everything)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s = attached(&c);
    struct drv_control_ring ring = {0};
    feel(&s, 127, 127, 128, CENTRED_HAT, 0x04);
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_slew(1000, -1000));
    expect(&ring, lm_control_button(true, 7));
    drv_stick_detach(&s);
    feel(&s, 127, 127, 128, CENTRED_HAT, 0x04); /* a report that was on its way */
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_slew(0, 0));
    expect(&ring, lm_control_button(false, 7));
    expect_nothing(&ring);
}

/* A ring that nobody empties: what does not fit is told later, in its last state. */
TEST(a_full_ring_loses_no_release)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s = attached(&c);
    struct drv_control_ring ring = {0};
    feel(&s, 0, 0, 128, CENTRED_HAT, 0x04);
    drv_stick_tell(&s, &ring);
    while (drv_control_ring_put(&ring, lm_control_knob(0))) {
    }
    feel(&s, 0, 0, 128, CENTRED_HAT, 0);
    drv_stick_tell(&s, &ring);
    struct lm_control control;
    while (drv_control_ring_take(&ring, &control)) {
        assert_int_not_equal(control.kind, LM_CONTROL_UP);
    }
    drv_stick_tell(&s, &ring);
    expect(&ring, lm_control_button(false, 7));
}

TEST(a_hat_slews_in_eight_directions_and_stops_when_it_is_let_go)
{
    struct drv_stick_config c = standard();
    c.right.usage = DRV_STICK_HAT_X;
    c.up.usage = DRV_STICK_HAT_Y;
    struct drv_stick s = attached(&c);
    static const int right[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    static const int up[] = {1, 1, 0, -1, -1, -1, 0, 1, 0};
    for (int hat = 0; hat <= CENTRED_HAT; hat++) {
        feel(&s, 0, 0, 128, hat, 0);
        assert_int_equal(s.now.right, 1000 * right[hat]);
        assert_int_equal(s.now.up, 1000 * up[hat]);
    }
}

TEST(a_short_report_changes_nothing_and_is_counted)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s = attached(&c);
    feel(&s, 127, 0, 128, CENTRED_HAT, 0x04);
    const struct drv_stick_state before = s.now;
    const uint8_t report[REPORT] = {0};
    for (size_t size = 0; size < REPORT; size++) {
        drv_stick_report(&s, report, size);
        assert_memory_equal(&s.now, &before, sizeof before);
    }
    assert_int_equal(s.count.odd, REPORT);
}

TEST(only_what_calls_itself_a_controller_is_taken_unless_it_is_named)
{
    const struct drv_stick_config c = standard();
    struct drv_stick s;
    uint8_t mouse[sizeof descriptor];
    memcpy(mouse, descriptor, sizeof mouse);
    mouse[3] = 0x02; /* usage: mouse */
    drv_stick_init(&s, &c);
    assert_non_null(drv_stick_attach(&s, mouse, sizeof mouse, false));
    assert_null(drv_stick_attach(&s, mouse, sizeof mouse, true));
}

TEST(a_device_without_the_axes_is_refused)
{
    struct drv_stick_config c = standard();
    c.right.usage = DRV_STICK_X + 3; /* Rx */
    c.up.usage = DRV_STICK_NONE;
    struct drv_stick s;
    drv_stick_init(&s, &c);
    assert_non_null(drv_stick_attach(&s, descriptor, sizeof descriptor, true));
    assert_false(s.is_attached);
}
