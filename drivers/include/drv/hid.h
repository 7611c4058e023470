/* The report descriptor of a USB human interface device: where in its reports each axis and button
 * lies. (Device Class Definition for HID 1.11, section 6.2.2.) Pure, and hostile-proof: a
 * descriptor that contradicts itself is refused whole. */
#ifndef DRV_HID_H
#define DRV_HID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    DRV_HID_DESCRIPTOR_BYTES = 4096, /* longer ones are refused */
    DRV_HID_REPORT_BYTES = 64,       /* longest input report, its number included */
    DRV_HID_FIELDS = 96,             /* fields kept; those of a device that has more are dropped */
    DRV_HID_DEPTH = 8,               /* collections within collections */
    DRV_HID_STACK = 4                /* Push without Pop */
};

/* Pages and usages that are looked for (HID Usage Tables 1.12). */
enum { DRV_HID_PAGE_DESKTOP = 1, DRV_HID_PAGE_SIMULATION = 2, DRV_HID_PAGE_BUTTON = 9 };
enum { DRV_HID_X = 0x30, DRV_HID_WHEEL = 0x38, DRV_HID_HAT = 0x39 };
enum { DRV_HID_RUDDER = 0xba, DRV_HID_THROTTLE = 0xbb };

/* A number in an input report. */
struct drv_hid_field {
    uint16_t page, usage;
    uint16_t bit;   /* of its lowest bit in the report, after the report's number if it has one */
    uint8_t bits;   /* 1..32 */
    uint8_t report; /* its number; 0: reports have none */
    bool is_relative;
    int32_t low, high; /* what it ranges over; another value is "nothing" */
};

struct drv_hid_map {
    uint16_t application_page, application; /* usage of the first outermost collection */
    bool has_numbers;                       /* reports begin with theirs */
    uint32_t count;
    struct drv_hid_field field[DRV_HID_FIELDS]; /* axes, hats and buttons, as they are described */
};

/* NULL, or the cause why the descriptor is refused; the map is then unspecified. */
const char *drv_hid_parse(const uint8_t *descriptor, size_t size, struct drv_hid_map *map);

/* The field's value in this report. False when the report is another one, too short, or the value
 * is outside the field's range. */
bool drv_hid_read(const struct drv_hid_map *map, const struct drv_hid_field *field,
                  const uint8_t *report, size_t size, int32_t *value);

#endif
