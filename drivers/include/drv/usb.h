/* USB: devices with interrupt reports, through libusb, on a thread of its own. libusb allocates
 * memory whenever a transfer is submitted, which a real-time loop must not do.
 *
 * A client wants one device; the hand controller is one. When a device is plugged in, and once a
 * second, the thread looks for the devices of its clients. It claims a client's device, hands the
 * reports to the client, and tells it when the device has gone. Transfers and buffers are allocated
 * once, when the thread starts. */
#ifndef DRV_USB_H
#define DRV_USB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/hid.h"

enum {
    DRV_USB_CLIENTS = 4,
    DRV_USB_TRANSFERS = 2, /* in flight for each device, so that no report is missed */
    DRV_USB_SERIAL = 64
};

struct drv_usb_identity {
    uint16_t vendor, product;
    bool is_boot_device;         /* a keyboard or mouse that a BIOS understands */
    char serial[DRV_USB_SERIAL]; /* empty if the device has none */
};

/* Client. Its functions are called on the USB thread, and must not call this driver. Their pointers
 * are borrowed for the call. */
struct drv_usb_client {
    void *ctx; /* borrowed until drv_usb_stop */

    /* True if this device is to be opened. Its serial number is not known yet. */
    bool (*wants)(void *ctx, const struct drv_usb_identity *identity);

    /* The device is open; its report descriptor has `size` bytes, as the device sent it. Returns
     * NULL if the client takes it, else the cause, in static memory. After three refusals the
     * device is ignored until it is plugged in again. */
    const char *(*attach)(void *ctx, const struct drv_usb_identity *identity,
                          const uint8_t *descriptor, size_t size);

    /* One report, at most DRV_HID_REPORT_BYTES. */
    void (*report)(void *ctx, const uint8_t *bytes, size_t size);

    /* The device has gone. Called once for each attach that returned NULL. */
    void (*detach)(void *ctx);

    /* Called about ten times a second, with or without a device. */
    void (*idle)(void *ctx);

    /* An event in words, for the log. */
    void (*tell)(void *ctx, const char *text);
};

struct drv_usb_counts {
    uint32_t attached, detached, refused;
    uint32_t reports, empty; /* empty: transfers without data, which are no reports */
    uint32_t errors; /* transfers that failed: the device is released and looked for again */
};

struct drv_usb;

/* Start the thread for `count` clients, which are copied. Returns the driver, to be ended by
 * drv_usb_stop; or NULL, with the cause in `error` (160 bytes). A machine without USB is no error:
 * a controller may be plugged in later. */
struct drv_usb *drv_usb_start(const struct drv_usb_client *clients, uint32_t count, char *error);

/* Release every device, end the thread, and free *u. NULL is allowed. */
void drv_usb_stop(struct drv_usb *u);

/* The counters as of now. Safe on any thread. */
struct drv_usb_counts drv_usb_counts(const struct drv_usb *u);

#endif
