/* A report descriptor of a hostile device, and then its reports: nothing is read beyond them, and
 * what reaches the firmware is within what controls.h allows. The input is the descriptor, its
 * length in the first two bytes, and reports of eight bytes. */
#include "drv/stick.h"
#include "fuzz.h"

const uint32_t fuzz_mutations = 60000;

static void check_map(const struct drv_hid_map *map)
{
    FUZZ_ASSERT(map->count <= DRV_HID_FIELDS);
    for (uint32_t i = 0; i < map->count; i++) {
        const struct drv_hid_field *f = &map->field[i];
        FUZZ_ASSERT(f->bits >= 1 && f->bits <= 32 && f->low <= f->high);
        FUZZ_ASSERT(f->bit + f->bits <= 8 * DRV_HID_REPORT_BYTES);
        FUZZ_ASSERT((f->report != 0) == map->has_numbers);
    }
}

static void check_control(const struct lm_control *c)
{
    switch (c->kind) {
    case LM_CONTROL_DOWN:
    case LM_CONTROL_UP:
        FUZZ_ASSERT(c->button >= 1 && c->button <= LM_BUTTONS);
        break;
    case LM_CONTROL_KNOB:
        FUZZ_ASSERT(abs(c->knob) <= LM_FULL_DEFLECTION);
        break;
    case LM_CONTROL_SLEW:
        FUZZ_ASSERT(abs(c->slew.x) <= LM_FULL_DEFLECTION && abs(c->slew.y) <= LM_FULL_DEFLECTION);
        break;
    default:
        FUZZ_ASSERT(c->kind == LM_CONTROL_DESIGNATE || c->kind == LM_CONTROL_DROP);
    }
}

static void drain(struct drv_stick *s, struct drv_control_ring *ring)
{
    struct lm_control control;
    drv_stick_tell(s, ring);
    while (drv_control_ring_take(ring, &control)) {
        check_control(&control);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const size_t wanted = fuzz_u16(&supply);
    const size_t length = wanted < supply.left ? wanted : supply.left;
    struct drv_stick_config config = {.right = {.usage = DRV_STICK_X},
                                      .up = {.usage = DRV_STICK_HAT_Y, .is_inverted = true},
                                      .knob = {.usage = DRV_STICK_THROTTLE},
                                      .dead_percent = 50};
    for (uint32_t i = 0; i < DRV_STICK_BUTTONS; i++) {
        config.button[i] =
            (struct drv_stick_button){DRV_STICK_PRESS, (uint8_t)(i % LM_BUTTONS + 1)};
    }
    struct drv_stick stick;
    static struct drv_control_ring ring;
    uint8_t *descriptor = malloc(length + 1); /* by itself, so that reading beyond it is seen */
    memcpy(descriptor, supply.at, length);
    drv_stick_init(&stick, &config);
    if (drv_stick_attach(&stick, descriptor, length, true) == NULL) {
        check_map(&stick.map);
        supply.at += length;
        supply.left -= length;
        while (supply.left > 0) {
            const size_t part = supply.left < 8 ? supply.left : 8;
            drv_stick_report(&stick, supply.at, part);
            drain(&stick, &ring);
            supply.at += part;
            supply.left -= part;
        }
        drv_stick_detach(&stick);
        drain(&stick, &ring);
        FUZZ_ASSERT(stick.told.right == 0 && stick.told.up == 0 && stick.told.buttons == 0);
    }
    free(descriptor);
    return 0;
}
