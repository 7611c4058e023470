/* HID report descriptor of a USB human interface device: the position of each axis and button in
 * its reports. Source: Device Class Definition for HID 1.11, section 6.2.2. Pure, and safe on any
 * input: a descriptor that contradicts itself is refused as a whole. */
#ifndef DRV_HID_H
#define DRV_HID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    DRV_HID_DESCRIPTOR_BYTES = 4096, /* longer ones are refused */
    DRV_HID_REPORT_BYTES = 64,       /* longest input report, including its number */
    DRV_HID_FIELDS = 96,             /* fields kept of a device; further ones are dropped */
    DRV_HID_DEPTH = 8,               /* depth of collections within collections */
    DRV_HID_STACK = 4                /* Push items without their Pop */
};

/* Pages and usages that the code names (HID Usage Tables 1.12). */
enum { DRV_HID_PAGE_DESKTOP = 1, DRV_HID_PAGE_SIMULATION = 2, DRV_HID_PAGE_BUTTON = 9 };
enum { DRV_HID_X = 0x30, DRV_HID_WHEEL = 0x38, DRV_HID_HAT = 0x39 };
enum { DRV_HID_RUDDER = 0xba, DRV_HID_THROTTLE = 0xbb };

/* Field: a number in an input report. */
struct drv_hid_field {
    uint16_t page, usage;
    uint16_t bit;   /* position of its lowest bit, from behind the report's number, if any */
    uint8_t bits;   /* 1..32 */
    uint8_t report; /* number of its report; 0: reports have none */
    bool is_relative;
    int32_t low, high; /* range of its values; a value outside means "nothing" */
};

struct drv_hid_map {
    uint16_t application_page, application; /* usage of the first outermost collection */
    bool has_numbers;                       /* reports begin with their number */
    uint32_t count;
    struct drv_hid_field
        field[DRV_HID_FIELDS]; /* axes, hats and buttons, in the descriptor's order */
};

/* Parse a descriptor. Returns NULL; or the cause of its refusal, in static memory, with *map
 * unspecified. */
const char *drv_hid_parse(const uint8_t *descriptor, size_t size, struct drv_hid_map *map);

/* Read a field's value from a report. False iff
 * - the report has another number than the field's,
 * - the report is too short, or
 * - the value is outside the field's range. */
bool drv_hid_read(const struct drv_hid_map *map, const struct drv_hid_field *field,
                  const uint8_t *report, size_t size, int32_t *value);

#endif
