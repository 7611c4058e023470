/* Links over USB: a maintenance PC has libusb, a panel that is a USB device has FunctionFS of
 * Linux. Both know each other by class, subclass and protocol of the interface; vendor and product
 * are the panel maker's. */
#ifndef WIRE_USB_H
#define WIRE_USB_H

#include "wire/link.h"

#include <pthread.h>
#include <stdbool.h>

enum {
    WIRE_USB_CLASS = 0xff,    /* of the vendor's own */
    WIRE_USB_SUBCLASS = 0x4c, /* 'L' */
    WIRE_USB_PROTOCOL = 0x44, /* 'D' */
    /* pid.codes keeps this pair for prototypes; whoever makes panels has his own. */
    WIRE_USB_VENDOR = 0x1209,
    WIRE_USB_PRODUCT = 0x0001
};

/* The PC's end. */
struct wire_host {
    struct libusb_context *context;
    struct libusb_device_handle *handle;
    int interface;
    uint8_t in, out; /* addresses of the endpoints */
    struct wire_link link;
};

/* Open the only panel of this vendor and product. *h must not move, and must be closed in any case.
 * Returns 0, or an errno:
 * - ENXIO: no device of these numbers has a panel's interface,
 * - EMFILE: several have,
 * - EACCES: it is there and may not be opened,
 * - EBUSY: another program uses it,
 * - EIO: libusb failed. */
int wire_host_open(struct wire_host *h, uint16_t vendor, uint16_t product);
void wire_host_close(struct wire_host *h);

/* The panel's end: the endpoints in a folder where FunctionFS is mounted. */
struct wire_function {
    int control, in, out; /* descriptors of ep0, ep1 to the PC, ep2 from it; -1: not open */
    pthread_t thread;     /* refuses what comes to ep0 */
    bool has_thread;
    struct wire_link link;
};

/* Say which interface it is. From here on the gadget can be connected to its controller. Needs
 * SIGALRM. *f must not move, and must be closed in any case. Returns 0 or an errno. */
int wire_function_open(struct wire_function *f, const char *folder);
void wire_function_close(struct wire_function *f);

#endif
