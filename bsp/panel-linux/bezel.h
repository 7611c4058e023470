/* Bezel of the panel: keys and lamps on GPIO lines, and the display's backlight. */
#ifndef PANEL_BEZEL_H
#define PANEL_BEZEL_H

#include "config.h"
#include "drv/control_ring.h"
#include "drv/debounce.h"
#include "drv/gpio.h"

/* States of the lamps. */
struct bezel_lamps {
    bool is_lit[CONFIG_LEDS];
    bool is_night; /* of the backlight: night instead of day */
};

struct bezel {
    const struct config *config; /* borrowed */
    struct drv_gpio gpio;
    uint8_t key_of_input[DRV_GPIO_LINES];  /* 0..CONFIG_KEYS - 1 */
    uint8_t led_of_output[DRV_GPIO_LINES]; /* 0..CONFIG_LEDS - 1 */
    struct drv_debounce debounce;
    uint64_t resync_us; /* time when the levels are read again without an event */
    uint64_t stuck;     /* bit n: input n was reported as stuck */
    struct bezel_lamps shown;
    int backlight_fd; /* -1: none */
    uint32_t backlight_max;
    struct drv_control_ring ring; /* controls for the firmware */
    uint32_t missed;              /* controls that found the ring full */
};

/* Request every line that the config names. A line that is missing is reported, and the others
 * work. The config stays borrowed until bezel_close. */
void bezel_open(struct bezel *b, const struct config *config, uint64_t now_us);

/* Release all lines. */
void bezel_close(struct bezel *b);

/* Read the keys. Call before each step of the firmware. Never waits. */
void bezel_service(struct bezel *b, uint64_t now_us);

/* Set the lamps and the backlight that changed. */
void bezel_show(struct bezel *b, const struct bezel_lamps *lamps);

/* True if a key is stuck. */
bool bezel_is_stuck(const struct bezel *b);

/* File descriptor for poll(): readable when a key moved; -1: no keys. */
int bezel_fd(const struct bezel *b);

#endif
