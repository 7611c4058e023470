#include "drv/stick.h"

#include <string.h>

enum { HAT_STEPS = 8, JOYSTICK = 4, GAME_PAD = 5, MULTI_AXIS = 8 };

void drv_stick_init(struct drv_stick *s, const struct drv_stick_config *config)
{
    memset(s, 0, sizeof *s);
    s->config = *config;
}

static bool is_field_of(const struct drv_hid_field *f, const struct drv_stick_axis *axis)
{
    return f->page == (axis->usage >> 8 & 0xf) && f->usage == (axis->usage & 0xff) &&
           !f->is_relative;
}

static bool is_hat(const struct drv_stick_axis *axis)
{
    return axis->usage == DRV_STICK_HAT_X || axis->usage == DRV_STICK_HAT_Y;
}

/* What calls itself a hand controller (HID Usage Tables 1.12, 4.1). */
static bool is_controller(const struct drv_hid_map *m)
{
    return m->application_page == DRV_HID_PAGE_DESKTOP &&
           (m->application == JOYSTICK || m->application == GAME_PAD ||
            m->application == MULTI_AXIS);
}

const char *drv_stick_attach(struct drv_stick *s, const uint8_t *descriptor, size_t size,
                             bool is_named)
{
    const char *cause = drv_hid_parse(descriptor, size, &s->map);
    if (cause == NULL && !is_named && !is_controller(&s->map)) {
        cause = "not a joystick, game pad or multi-axis controller";
    }
    if (cause != NULL) {
        return cause;
    }
    bool has_axis = false;
    for (uint32_t i = 0; i < s->map.count; i++) {
        const struct drv_hid_field *f = &s->map.field[i];
        has_axis = has_axis || is_field_of(f, &s->config.right) || is_field_of(f, &s->config.up);
    }
    if (!has_axis) {
        return "it has none of the axes that are to move the cursor";
    }
    s->now = (struct drv_stick_state){0};
    s->is_attached = true;
    return NULL;
}

/* -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION from the field's range: low and high are full, and the
 * middle is 0 whatever is odd about them. The range is at most 2^32, and full deflection 1000, so
 * that everything fits 64 bits. */
static int32_t deflection(const struct drv_hid_field *f, int32_t value)
{
    const int64_t span = (int64_t)f->high - f->low;
    const int64_t twice = 2 * ((int64_t)value - f->low) - span; /* -span..span */
    return span == 0 ? 0 : (int32_t)(twice * LM_FULL_DEFLECTION / span);
}

/* Nothing within the dead zone; beyond it full deflection stays full. */
static int32_t without_dead_zone(int32_t value, uint32_t dead_percent)
{
    const int32_t dead = (int32_t)dead_percent * LM_FULL_DEFLECTION / 100;
    const int32_t beyond = value > dead ? value - dead : value < -dead ? value + dead : 0;
    return beyond * LM_FULL_DEFLECTION / (LM_FULL_DEFLECTION - dead);
}

/* A hat's positions run clockwise from straight up (HID Usage Tables 1.12, 4.2). */
static int32_t hat_deflection(const struct drv_hid_field *f, int32_t value, bool is_x)
{
    static const int8_t right[HAT_STEPS] = {0, 1, 1, 1, 0, -1, -1, -1};
    const int64_t steps = (int64_t)f->high - f->low + 1;
    if (steps != HAT_STEPS && steps != HAT_STEPS / 2) {
        return 0;
    }
    const uint32_t eighth = (uint32_t)(value - f->low) * (uint32_t)(HAT_STEPS / steps);
    /* Down is what the device calls positive, as its Y axis does: up is a turned Y. */
    return LM_FULL_DEFLECTION * (is_x ? right[eighth] : -right[(eighth + 2) % HAT_STEPS]);
}

/* Where the axis stands in this report; `before` when the report does not say. */
static int16_t read_axis(const struct drv_stick *s, const struct drv_stick_axis *axis,
                         const uint8_t *report, size_t size, int16_t before)
{
    for (uint32_t i = 0; i < s->map.count; i++) {
        const struct drv_hid_field *f = &s->map.field[i];
        int32_t value;
        if (!is_field_of(f, axis)) {
            continue;
        }
        if (!drv_hid_read(&s->map, f, report, size, &value)) {
            const bool is_told = !s->map.has_numbers || report[0] == f->report;
            return is_told && is_hat(axis) ? 0 : before; /* a hat that is let go says "nothing" */
        }
        value = is_hat(axis) ? hat_deflection(f, value, axis->usage == DRV_STICK_HAT_X)
                             : without_dead_zone(deflection(f, value), s->config.dead_percent);
        return (int16_t)(axis->is_inverted ? -value : value);
    }
    return before;
}

static uint32_t read_buttons(const struct drv_stick *s, const uint8_t *report, size_t size,
                             uint32_t before)
{
    uint32_t buttons = before;
    for (uint32_t i = 0; i < s->map.count; i++) {
        const struct drv_hid_field *f = &s->map.field[i];
        int32_t value;
        if (f->page == DRV_HID_PAGE_BUTTON && f->usage >= 1 && f->usage <= DRV_STICK_BUTTONS &&
            drv_hid_read(&s->map, f, report, size, &value)) {
            const uint32_t bit = 1u << (f->usage - 1);
            buttons = value != 0 ? buttons | bit : buttons & ~bit;
        }
    }
    return buttons;
}

/* The bytes that this report must have to hold all of its fields. */
static size_t report_bytes(const struct drv_hid_map *map, const uint8_t *report)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < map->count; i++) {
        const struct drv_hid_field *f = &map->field[i];
        const size_t end = ((size_t)f->bit + f->bits + 7) / 8 + map->has_numbers;
        if ((!map->has_numbers || f->report == report[0]) && end > bytes) {
            bytes = end;
        }
    }
    return bytes;
}

void drv_stick_report(struct drv_stick *s, const uint8_t *report, size_t size)
{
    if (!s->is_attached) {
        return;
    }
    s->count.reports++;
    if (size == 0 || size < report_bytes(&s->map, report)) {
        s->count.odd++;
        return;
    }
    const struct drv_stick_config *c = &s->config;
    s->now.right = read_axis(s, &c->right, report, size, s->now.right);
    s->now.up = read_axis(s, &c->up, report, size, s->now.up);
    s->now.knob = read_axis(s, &c->knob, report, size, s->now.knob);
    s->now.buttons = read_buttons(s, report, size, s->now.buttons);
}

void drv_stick_detach(struct drv_stick *s)
{
    s->is_attached = false;
    s->now =
        (struct drv_stick_state){.knob = s->now.knob}; /* a knob stays where it was turned to */
}

/* False when there is no room; a button that means nothing needs none. */
static bool tell_button(const struct drv_stick_button *b, bool is_down,
                        struct drv_control_ring *ring)
{
    switch (b->act) {
    case DRV_STICK_PRESS:
        return drv_control_ring_put(ring, lm_control_button(is_down, b->button));
    case DRV_STICK_DESIGNATE:
        return !is_down || drv_control_ring_put(ring, lm_control_designate());
    case DRV_STICK_DROP:
        return !is_down || drv_control_ring_put(ring, lm_control_drop());
    case DRV_STICK_NOTHING:
        break;
    }
    return true;
}

void drv_stick_tell(struct drv_stick *s, struct drv_control_ring *ring)
{
    struct drv_stick_state *told = &s->told;
    if ((s->now.right != told->right || s->now.up != told->up) &&
        drv_control_ring_put(ring, lm_control_slew(s->now.right, s->now.up))) {
        told->right = s->now.right;
        told->up = s->now.up;
    }
    if (s->now.knob != told->knob && drv_control_ring_put(ring, lm_control_knob(s->now.knob))) {
        told->knob = s->now.knob;
    }
    for (uint32_t n = 0; n < DRV_STICK_BUTTONS; n++) {
        const uint32_t bit = 1u << n;
        const bool is_down = (s->now.buttons & bit) != 0;
        if (((s->now.buttons ^ told->buttons) & bit) != 0 &&
            tell_button(&s->config.button[n], is_down, ring)) {
            told->buttons ^= bit;
        }
    }
}
