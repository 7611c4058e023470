/* Hand controller: reports of a HID device in, controls out. The configuration says which axis
 * slews the cursor, which turns the knob, and what each button does. It does not use USB itself. */
#ifndef DRV_STICK_H
#define DRV_STICK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/control_ring.h"
#include "drv/hid.h"
#include "lm/controls.h"

enum { DRV_STICK_BUTTONS = 32, DRV_STICK_NONE = 0 };

/* Axes, by HID's page and usage: page << 8 | usage. The usages from X to wheel are consecutive. A
 * hat switch counts as two axes; the number of the second is above all pages. */
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

/* Action of a button. */
struct drv_stick_button {
    enum { DRV_STICK_NOTHING, DRV_STICK_PRESS, DRV_STICK_DESIGNATE, DRV_STICK_DROP } act;
    uint8_t button; /* of the bezel, for DRV_STICK_PRESS */
};

struct drv_stick_config {
    struct drv_stick_axis right, up, knob;
    uint32_t dead_percent; /* around the middle, of full deflection: 0..50 */
    struct drv_stick_button button[DRV_STICK_BUTTONS];
};

/* Positions of the controls. */
struct drv_stick_state {
    int16_t right, up, knob; /* -LM_FULL_DEFLECTION..LM_FULL_DEFLECTION */
    uint32_t buttons;        /* bit n - 1: the device's button n is held */
};

struct drv_stick {
    struct drv_stick_config config;
    struct drv_hid_map map; /* of the attached device */
    bool is_attached;
    struct drv_stick_state now, told; /* as the device reported, and as put into the ring */

    struct {
        uint32_t reports;
        uint32_t odd; /* reports that are too short for their fields */
    } count;
};

/* Begin without a device. The config is copied. */
void drv_stick_init(struct drv_stick *s, const struct drv_stick_config *config);

/* Attach a device with this report descriptor. A device that the configuration names (`is_named`)
 * needs only the right axes; any other must declare itself a hand controller. Returns NULL; or the
 * cause, in static memory, why the configuration cannot use it. */
const char *drv_stick_attach(struct drv_stick *s, const uint8_t *descriptor, size_t size,
                             bool is_named);

/* Take a report. */
void drv_stick_report(struct drv_stick *s, const uint8_t *report, size_t size);

/* Detach the device: all axes return to the middle and all buttons are released. */
void drv_stick_detach(struct drv_stick *s);

/* Put what changed into the ring. A change that finds the ring full is put in by a later call. */
void drv_stick_tell(struct drv_stick *s, struct drv_control_ring *ring);

#endif
