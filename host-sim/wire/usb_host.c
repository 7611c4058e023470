/* The PC's end of a wire: libusb. */
#include "wire/usb.h"

#include <errno.h>
#include <libusb.h>

static int cause_of(int status)
{
    switch (status) {
    case LIBUSB_SUCCESS:
        return 0;
    case LIBUSB_ERROR_TIMEOUT:
        return ETIMEDOUT;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_PIPE: /* the interface has gone from under it */
        return ENODEV;
    case LIBUSB_ERROR_ACCESS:
        return EACCES;
    case LIBUSB_ERROR_BUSY:
        return EBUSY;
    case LIBUSB_ERROR_INTERRUPTED:
        return EINTR;
    default:
        return EIO;
    }
}

static int move(struct wire_host *h, uint8_t endpoint, uint8_t *at, uint32_t length,
                uint32_t timeout_ms)
{
    int moved = 0;
    const int cause =
        cause_of(libusb_bulk_transfer(h->handle, endpoint, at, (int)length, &moved, timeout_ms));
    if (cause == 0 && moved != (int)length) {
        return EPROTO;
    }
    return cause;
}

static int host_send(void *ctx, const void *from, uint32_t length, uint32_t timeout_ms)
{
    struct wire_host *h = ctx;
    return move(h, h->out, (uint8_t *)(uintptr_t)from, length, timeout_ms);
}

static int host_receive(void *ctx, void *to, uint32_t length, uint32_t timeout_ms)
{
    struct wire_host *h = ctx;
    return move(h, h->in, to, length, timeout_ms);
}

/* Has it one bulk endpoint each way? */
static bool take_endpoints(struct wire_host *h, const struct libusb_interface_descriptor *d)
{
    h->in = h->out = 0;
    for (int i = 0; i < d->bNumEndpoints; i++) {
        const struct libusb_endpoint_descriptor *e = &d->endpoint[i];
        if ((e->bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) == LIBUSB_TRANSFER_TYPE_BULK) {
            *(e->bEndpointAddress & LIBUSB_ENDPOINT_IN ? &h->in : &h->out) = e->bEndpointAddress;
        }
    }
    return h->in != 0 && h->out != 0;
}

static bool find_interface(struct wire_host *h, libusb_device *device)
{
    struct libusb_config_descriptor *config;
    bool is_found = false;
    if (libusb_get_active_config_descriptor(device, &config) != 0) {
        return false;
    }
    for (int i = 0; i < config->bNumInterfaces && !is_found; i++) {
        const struct libusb_interface *interface = &config->interface[i];
        const struct libusb_interface_descriptor *d = interface->altsetting;
        is_found = interface->num_altsetting > 0 && d->bInterfaceClass == WIRE_USB_CLASS &&
                   d->bInterfaceSubClass == WIRE_USB_SUBCLASS &&
                   d->bInterfaceProtocol == WIRE_USB_PROTOCOL && take_endpoints(h, d);
        h->interface = is_found ? d->bInterfaceNumber : -1;
    }
    libusb_free_config_descriptor(config);
    return is_found;
}

static int open_device(struct wire_host *h, libusb_device *device)
{
    (void)find_interface(h, device);
    int cause = cause_of(libusb_open(device, &h->handle));
    if (cause == 0) {
        cause = cause_of(libusb_claim_interface(h->handle, h->interface));
    }
    /* Chosen anew, so that the panel gives up what an earlier program has begun. */
    return cause == 0 ? cause_of(libusb_set_interface_alt_setting(h->handle, h->interface, 0))
                      : cause;
}

int wire_host_open(struct wire_host *h, uint16_t vendor, uint16_t product)
{
    libusb_device **list, *chosen = NULL;
    int found = 0;
    *h = (struct wire_host){.interface = -1, .link = {h, host_send, host_receive}};
    if (libusb_init(&h->context) != 0) {
        h->context = NULL;
        return EIO;
    }
    const ssize_t count = libusb_get_device_list(h->context, &list);
    if (count < 0) {
        return EIO;
    }
    for (ssize_t i = 0; i < count; i++) {
        struct libusb_device_descriptor d;
        if (libusb_get_device_descriptor(list[i], &d) == 0 && d.idVendor == vendor &&
            d.idProduct == product && find_interface(h, list[i])) {
            chosen = list[i];
            found++;
        }
    }
    const int cause = found == 1 ? open_device(h, chosen) : found == 0 ? ENXIO : EMFILE;
    libusb_free_device_list(list, 1);
    return cause;
}

void wire_host_close(struct wire_host *h)
{
    if (h->handle) {
        (void)libusb_release_interface(h->handle, h->interface);
        libusb_close(h->handle);
    }
    if (h->context) {
        libusb_exit(h->context);
    }
    h->handle = NULL;
    h->context = NULL;
}
