/* A USB bus for tests, in the place of libusb. It is as strict as the library's documentation: what
 * may not be called from a callback, or with transfers in flight, ends the test. No udevd runs, so
 * that a context knows the devices that were there when it was made, and never another one. */
#ifndef FAKE_USB_H
#define FAKE_USB_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FAKE_USB_DEVICES = 4, FAKE_USB_TRANSFERS = 16 };

struct fake_device {
    atomic_bool is_plugged;
    atomic_int address;
    int listed_address; /* as the context knows it; -1: not at all */
    uint16_t vendor, product;
    const char *serial;
    const uint8_t *descriptor; /* of its reports */
    int descriptor_bytes;      /* as the device really sends */
    int told_bytes;            /* as its HID descriptor says */
    bool has_bad_extra;        /* the descriptors beside the HID one are nonsense */
    bool is_boot_device, is_busy;
    atomic_bool is_unbound; /* its driver was taken away: transfers complete without data */
    atomic_int reports;     /* so many are to be sent */
    uint8_t report[8];
    int report_bytes;

    atomic_int opens;  /* now */
    atomic_int opened; /* ever */
};

extern struct fake_device fake_usb[FAKE_USB_DEVICES];
extern atomic_int fake_usb_init_failures; /* so many attempts fail first */
extern atomic_int fake_usb_transfers;     /* allocated and not freed */

/* An empty bus. */
void fake_usb_reset(void);

/* Plugged in anew, a device has another address. */
void fake_usb_plug(struct fake_device *d);

#endif
