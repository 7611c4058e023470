/* USB devices with interrupt reports, through libusb, on a thread of their own: libusb allocates
 * whenever a transfer is submitted, which a real-time loop must not.
 *
 * A client is whoever wants one device: today the hand controller, later a maintenance loader. The
 * thread looks for its device when one is plugged in and once a second, claims it, hands it the
 * reports, and tells it when the device has gone. Transfers and buffers are allocated once, when
 * the thread starts. */
#ifndef DRV_USB_H
#define DRV_USB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/hid.h"

enum {
    DRV_USB_CLIENTS = 4,
    DRV_USB_TRANSFERS = 2, /* in flight for each device, so that none is missed between two */
    DRV_USB_SERIAL = 64
};

struct drv_usb_identity {
    uint16_t vendor, product;
    bool is_boot_device;         /* a keyboard or mouse that a BIOS understands */
    char serial[DRV_USB_SERIAL]; /* empty when the device does not tell */
};

/* All are called on the USB thread, and must not call back into this driver. */
struct drv_usb_client {
    void *ctx;

    /* Whether this device is worth opening; the serial number is not known yet. */
    bool (*wants)(void *ctx, const struct drv_usb_identity *identity);

    /* It is open; its report descriptor is `size` bytes, as the device sent it. NULL: taken, or the
     * cause why not; after three tries it is left alone until it is plugged in again. */
    const char *(*attach)(void *ctx, const struct drv_usb_identity *identity,
                          const uint8_t *descriptor, size_t size);

    /* One report, at most DRV_HID_REPORT_BYTES. */
    void (*report)(void *ctx, const uint8_t *bytes, size_t size);

    /* It has gone. Called once for each attach that took it. */
    void (*detach)(void *ctx);

    /* About ten times a second, with or without a device. */
    void (*idle)(void *ctx);

    /* Told of what happened, in words; for the log. */
    void (*tell)(void *ctx, const char *text);
};

struct drv_usb_counts {
    uint32_t attached, detached, refused;
    uint32_t reports, empty; /* transfers without data are not reports */
    uint32_t errors;         /* transfers that failed: the device is let go and looked for again */
};

struct drv_usb;

/* Start the thread for `count` clients, which are copied; their ctx stays borrowed until
 * drv_usb_stop. NULL with `error` (160 bytes) filled. A machine without USB is no error: it may get
 * one. */
struct drv_usb *drv_usb_start(const struct drv_usb_client *clients, uint32_t count, char *error);

/* Let go of every device and end the thread. NULL is allowed. */
void drv_usb_stop(struct drv_usb *u);

struct drv_usb_counts drv_usb_counts(const struct drv_usb *u);

#endif
