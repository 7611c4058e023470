/* The panel's bezel: keys and lamps on GPIO lines, and the glass's backlight. */
#ifndef PANEL_BEZEL_H
#define PANEL_BEZEL_H

#include "config.h"
#include "drv/control_ring.h"
#include "drv/debounce.h"
#include "drv/gpio.h"

/* What the lamps show. */
struct bezel_lamps {
    bool is_lit[CONFIG_LEDS];
    bool is_night; /* backlight */
};

struct bezel {
    const struct config *config; /* borrowed */
    struct drv_gpio gpio;
    uint8_t key_of_input[DRV_GPIO_LINES];  /* 0..CONFIG_KEYS - 1 */
    uint8_t led_of_output[DRV_GPIO_LINES]; /* 0..CONFIG_LEDS - 1 */
    struct drv_debounce debounce;
    uint64_t resync_us; /* when the levels are read again without an event */
    uint64_t stuck;     /* keys that were reported as stuck; bit n: input n */
    struct bezel_lamps shown;
    int backlight_fd; /* -1: none */
    uint32_t backlight_max;
    struct drv_control_ring ring; /* what was done, for the firmware */
    uint32_t missed;              /* controls that found the ring full */
};

/* Request every line that the config names. One that is missing is reported, and the others work.
 */
void bezel_open(struct bezel *b, const struct config *config, uint64_t now_us);
void bezel_close(struct bezel *b);

/* At every step, before the firmware's: look at the keys. */
void bezel_service(struct bezel *b, uint64_t now_us);

/* Show the lamps, when they are not as they were. */
void bezel_show(struct bezel *b, const struct bezel_lamps *lamps);

bool bezel_is_stuck(const struct bezel *b);

/* For poll(): readable when a key moved; -1: no keys. */
int bezel_fd(const struct bezel *b);

#endif
