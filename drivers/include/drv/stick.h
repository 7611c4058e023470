/* A hand controller as the operator's hands: which axis slews the cursor, which turns the range
 * knob, what each button means. Bytes in, controls out; knows nothing of USB. */
#ifndef DRV_STICK_H
#define DRV_STICK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/control_ring.h"
#include "drv/hid.h"
#include "lm/controls.h"

enum { DRV_STICK_BUTTONS = 32, DRV_STICK_NONE = 0 };

/* An axis by HID's page and usage, page << 8 | usage. The usages X to wheel follow each other; a
 * hat switch is two axes, and the second direction's number is above all pages. */
enum {
    DRV_STICK_X = DRV_HID_PAGE_DESKTOP << 8 | DRV_HID_X,
    DRV_STICK_HAT_X = DRV_HID_PAGE_DESKTOP << 8 | DRV_HID_HAT,
    DRV_STICK_HAT_Y = 1 << 12 | DRV_STICK_HAT_X,
    DRV_STICK_RUDDER = DRV_HID_PAGE_SIMULATION << 8 | DRV_HID_RUDDER,
    DRV_STICK_THROTTLE = DRV_HID_PAGE_SIMULATION << 8 | DRV_HID_THROTTLE
};
struct drv_stick_axis {
    uint16_t usage; /* DRV_STICK_NONE: not used */
    bool is_inverted;
};

/* What a button does. */
struct drv_stick_button {
    enum { DRV_STICK_NOTHING, DRV_STICK_PRESS, DRV_STICK_DESIGNATE, DRV_STICK_DROP } act;
    uint8_t button; /* of the bezel, for DRV_STICK_PRESS */
};

struct drv_stick_config {
    struct drv_stick_axis right, up, knob;
    uint32_t dead_percent; /* around the middle, of full deflection: 0..50 */
    struct drv_stick_button button[DRV_STICK_BUTTONS];
};

/* How the controls stand. */
struct drv_stick_state {
    int16_t right, up, knob; /* -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION */
    uint32_t buttons;        /* bit n - 1: the device's button n is held */
};

struct drv_stick {
    struct drv_stick_config config;
    struct drv_hid_map map; /* of the device that is attached */
    bool is_attached;
    struct drv_stick_state now, told; /* as the device says, as the firmware has been told */

    struct {
        uint32_t reports;
        uint32_t odd; /* reports that are too short for what they should hold */
    } count;
};

void drv_stick_init(struct drv_stick *s, const struct drv_stick_config *config);

/* A device came: read what its descriptor says about its reports. `is_named`: it was asked for by
 * name, so that anything with the right axes will do; otherwise it must call itself a hand
 * controller. NULL, or the cause why it is none that the config can use. */
const char *drv_stick_attach(struct drv_stick *s, const uint8_t *descriptor, size_t size,
                             bool is_named);

/* A report came. */
void drv_stick_report(struct drv_stick *s, const uint8_t *report, size_t size);

/* The device has gone: everything is let go. */
void drv_stick_detach(struct drv_stick *s);

/* Put what has changed into the ring; what finds no room is told next time. */
void drv_stick_tell(struct drv_stick *s, struct drv_control_ring *ring);

#endif
