#include "bezel.h"

#include "report.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Levels are read again this often even without an event, which may have been lost. */
enum { RESYNC_US = 100000, STUCK_US = 15000000 };

static const char *key_name(const struct bezel *b, uint32_t input)
{
    return b->config->key[b->key_of_input[input]];
}

static void request_keys(struct bezel *b)
{
    for (uint32_t key = 0; key < CONFIG_KEYS; key++) {
        const char *name = b->config->key[key];
        if (name[0] == '\0') {
            continue;
        }
        const int input = drv_gpio_add_input(&b->gpio, name, b->config->key_active_low != 0);
        if (input < 0) {
            report(REPORT_ERROR, "key: %s", b->gpio.error);
        } else {
            b->key_of_input[input] = (uint8_t)key;
        }
    }
}

static void request_leds(struct bezel *b)
{
    for (uint32_t led = 0; led < CONFIG_LEDS; led++) {
        const char *name = b->config->led[led];
        if (name[0] == '\0') {
            continue;
        }
        const int output = drv_gpio_add_output(&b->gpio, name, b->config->led_active_low != 0);
        if (output < 0) {
            report(REPORT_ERROR, "lamp: %s", b->gpio.error);
        } else {
            b->led_of_output[output] = (uint8_t)led;
        }
    }
}

/* The kernel's backlight class: brightness 0..max_brightness (sysfs-class-backlight). */
static void open_backlight(struct bezel *b)
{
    char path[160], digits[16] = "";
    snprintf(path, sizeof path, "/sys/class/backlight/%s/max_brightness", b->config->backlight);
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    const ssize_t size = fd >= 0 ? read(fd, digits, sizeof digits - 1) : -1;
    if (fd >= 0) {
        close(fd);
    }
    snprintf(path, sizeof path, "/sys/class/backlight/%s/brightness", b->config->backlight);
    b->backlight_max = size > 0 ? (uint32_t)strtoul(digits, NULL, 10) : 0;
    b->backlight_fd = b->backlight_max > 0 ? open(path, O_WRONLY | O_CLOEXEC) : -1;
    if (b->backlight_fd < 0) {
        report(REPORT_ERROR, "backlight: %s: %s", path, strerror(errno));
    }
}

static void set_backlight(struct bezel *b, bool is_night)
{
    char digits[16];
    const uint64_t percent = is_night ? b->config->backlight_night : b->config->backlight_day;
    const int size =
        snprintf(digits, sizeof digits, "%u", (uint32_t)((percent * b->backlight_max + 50) / 100));
    if (b->backlight_fd >= 0 && pwrite(b->backlight_fd, digits, (size_t)size, 0) < 0) {
        report(REPORT_WARNING, "backlight: %s", strerror(errno));
    }
}

static void report_stuck(const struct bezel *b, uint64_t keys, const char *what)
{
    for (uint32_t i = 0; i < b->gpio.input_count; i++) {
        if ((keys >> i & 1) != 0) {
            report(REPORT_WARNING, "key: %s %s", key_name(b, i), what);
        }
    }
}

void bezel_open(struct bezel *b, const struct config *config, uint64_t now_us)
{
    memset(b, 0, sizeof *b);
    b->config = config;
    b->backlight_fd = -1;
    if (drv_gpio_open(&b->gpio) != LM_OK) {
        report(REPORT_ERROR, "bezel: %s", b->gpio.error);
        return;
    }
    request_keys(b);
    request_leds(b);
    if (config->backlight[0] != '\0') {
        open_backlight(b);
        set_backlight(b, false);
    }
    drv_debounce_init(&b->debounce, config->debounce_ms * 1000, drv_gpio_levels(&b->gpio));
    b->stuck = b->debounce.at_start;
    report_stuck(b, b->stuck, "is down at the start; it counts once it has been let go");
    b->resync_us = now_us + RESYNC_US;
}

void bezel_close(struct bezel *b)
{
    const struct bezel_lamps off = {0};
    bezel_show(b, &off);
    drv_gpio_close(&b->gpio);
    if (b->backlight_fd >= 0) {
        close(b->backlight_fd);
        b->backlight_fd = -1;
    }
}

static void put(struct bezel *b, uint32_t key, bool is_down)
{
    bool is_put = true;
    if (key < LM_BUTTONS) {
        is_put = drv_control_ring_put(&b->ring, lm_control_button(is_down, (int32_t)key + 1));
    } else if (is_down) {
        is_put = drv_control_ring_put(&b->ring, key == CONFIG_KEY_DESIGNATE ? lm_control_designate()
                                                                            : lm_control_drop());
    }
    b->missed += !is_put;
}

static void update_stuck(struct bezel *b, uint64_t now_us)
{
    const uint64_t stuck = drv_debounce_stuck(&b->debounce, now_us, STUCK_US);
    if (stuck != b->stuck) {
        report_stuck(b, stuck & ~b->stuck, "has been down for 15 s: stuck");
        report_stuck(b, b->stuck & ~stuck, "is let go again");
        b->stuck = stuck;
    }
}

void bezel_service(struct bezel *b, uint64_t now_us)
{
    if (b->gpio.input_count == 0) {
        return;
    }
    const uint64_t edges = drv_gpio_take_edges(&b->gpio);
    if (edges == 0 && !drv_debounce_is_waiting(&b->debounce) && now_us < b->resync_us) {
        return;
    }
    b->resync_us = now_us + RESYNC_US;
    const uint64_t levels = drv_gpio_levels(&b->gpio);
    const uint64_t changed = drv_debounce_look(&b->debounce, levels, edges, now_us);
    for (uint32_t i = 0; i < b->gpio.input_count && changed != 0; i++) {
        if ((changed >> i & 1) != 0) {
            put(b, b->key_of_input[i], (b->debounce.down >> i & 1) != 0);
        }
    }
    update_stuck(b, now_us);
}

void bezel_show(struct bezel *b, const struct bezel_lamps *lamps)
{
    for (uint32_t i = 0; i < b->gpio.output_count; i++) {
        const uint8_t led = b->led_of_output[i];
        if (lamps->is_lit[led] != b->shown.is_lit[led]) {
            drv_gpio_set(&b->gpio, i, lamps->is_lit[led]);
        }
    }
    if (lamps->is_night != b->shown.is_night) {
        set_backlight(b, lamps->is_night);
    }
    b->shown = *lamps;
}

bool bezel_is_stuck(const struct bezel *b)
{
    return b->stuck != 0;
}

int bezel_fd(const struct bezel *b)
{
    return b->gpio.input_count > 0 ? b->gpio.fd : -1;
}
