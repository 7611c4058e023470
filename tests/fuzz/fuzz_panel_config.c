/* The panel's configuration file: whatever it is, every option ends up with a value that it may
 * have. */
#include "config.h"
#include "fuzz.h"

const uint32_t fuzz_mutations = 60000;

static void count(void *ctx, uint32_t line, const char *cause)
{
    FUZZ_ASSERT(line > 0 && cause != NULL);
    (*(uint32_t *)ctx)++;
}

static bool is_text(const char *text, size_t room)
{
    return memchr(text, '\0', room) != NULL;
}

static void check_axis(const struct drv_stick_axis *a)
{
    FUZZ_ASSERT(a->usage == DRV_STICK_NONE || a->usage == DRV_STICK_HAT_Y ||
                a->usage == DRV_STICK_RUDDER || a->usage == DRV_STICK_THROTTLE ||
                (a->usage >= DRV_STICK_X && a->usage <= DRV_STICK_HAT_X));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct config c;
    uint32_t told = 0;
    config_defaults(&c);
    FUZZ_ASSERT(config_read(&c, (const char *)data, size, count, &told) == told);
    FUZZ_ASSERT(is_text(c.database, sizeof c.database) && c.database[0] == '/');
    FUZZ_ASSERT(is_text(c.radar, sizeof c.radar) && (c.radar[0] == '/' || c.radar[0] == '\0'));
    FUZZ_ASSERT(is_text(c.can, 16) && is_text(c.glass_connector, 32));
    FUZZ_ASSERT(c.tiles >= 120 && c.tiles <= 512 && c.seed <= 2147483647);
    FUZZ_ASSERT(c.glass <= CONFIG_GLASS_NONE && c.glass_turn <= DRV_TURN_270);
    FUZZ_ASSERT(c.can_reports <= 1 && c.can_controls <= 1 && c.can_heading <= 1);
    FUZZ_ASSERT(c.glass_format <= DRV_RGB565 && c.glass_sector <= 1 && c.glass_heading <= 1);
    FUZZ_ASSERT(c.glass_strobe <= 1 && c.glass_borders <= 1 && c.key_active_low <= 1 &&
                c.led_active_low <= 1);
    FUZZ_ASSERT((c.glass_picture.width_px == 0 && c.glass_picture.height_px == 0) ||
                (c.glass_picture.width_px >= 256 && c.glass_picture.width_px <= 1024 &&
                 c.glass_picture.height_px >= 256 && c.glass_picture.height_px <= 1024));
    FUZZ_ASSERT(c.debounce_ms >= 1 && c.debounce_ms <= 50 && c.priority <= 90);
    FUZZ_ASSERT(c.watchdog_s >= 1 && c.watchdog_s <= 60 && c.stick_map.dead_percent <= 50);
    for (uint32_t i = 0; i < CONFIG_KEYS; i++) {
        FUZZ_ASSERT(is_text(c.key[i], CONFIG_NAME));
    }
    for (uint32_t i = 0; i < DRV_STICK_BUTTONS; i++) {
        const struct drv_stick_button *b = &c.stick_map.button[i];
        FUZZ_ASSERT(b->act != DRV_STICK_PRESS || (b->button >= 1 && b->button <= LM_BUTTONS));
    }
    check_axis(&c.stick_map.right);
    check_axis(&c.stick_map.up);
    check_axis(&c.stick_map.knob);
    FUZZ_ASSERT(is_text(c.stick.serial, sizeof c.stick.serial));
    return 0;
}
