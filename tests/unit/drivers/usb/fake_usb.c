#include "fake_usb.h"

#include <libusb.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

struct fake_device fake_usb[FAKE_USB_DEVICES];
atomic_int fake_usb_init_failures, fake_usb_transfers;

static atomic_int next_address = 1;
static bool is_in_callback; /* the driver's thread is the only one that calls */
static struct flight {
    struct libusb_transfer *transfer;
    bool is_cancelled;
} flights[FAKE_USB_TRANSFERS];

int __wrap_clock_gettime(clockid_t clock, struct timespec *t);

/* Every look at the clock costs a quarter of a second. */
int __wrap_clock_gettime(clockid_t clock, struct timespec *t)
{
    static atomic_llong quarters;
    (void)clock;
    const long long now = atomic_fetch_add(&quarters, 1);
    *t = (struct timespec){.tv_sec = now / 4, .tv_nsec = now % 4 * 250000000};
    return 0;
}

static void must(bool holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "libusb was misused: %s\n", what);
        abort();
    }
}

static struct fake_device *fake(const void *device)
{
    return &fake_usb[(const struct fake_device *)device - fake_usb];
}

void fake_usb_reset(void)
{
    memset(fake_usb, 0, sizeof fake_usb);
    atomic_store(&fake_usb_init_failures, 0);
}

void fake_usb_plug(struct fake_device *d)
{
    atomic_store(&d->address, atomic_fetch_add(&next_address, 1));
    atomic_store(&d->is_unbound, false);
    atomic_store(&d->is_plugged, true);
}

int libusb_init(libusb_context **ctx)
{
    if (atomic_load(&fake_usb_init_failures) > 0) {
        atomic_fetch_sub(&fake_usb_init_failures, 1);
        return LIBUSB_ERROR_OTHER;
    }
    for (int i = 0; i < FAKE_USB_DEVICES; i++) {
        fake_usb[i].listed_address =
            atomic_load(&fake_usb[i].is_plugged) ? atomic_load(&fake_usb[i].address) : -1;
    }
    *ctx = (libusb_context *)(void *)fake_usb;
    return 0;
}

void libusb_exit(libusb_context *ctx)
{
    must(ctx != NULL, "exit without context");
}

ssize_t libusb_get_device_list(libusb_context *ctx, libusb_device ***list)
{
    must(ctx != NULL && !is_in_callback, "list");
    static libusb_device *devices[FAKE_USB_DEVICES + 1];
    ssize_t count = 0;
    for (int i = 0; i < FAKE_USB_DEVICES; i++) {
        if (atomic_load(&fake_usb[i].is_plugged) &&
            atomic_load(&fake_usb[i].address) == fake_usb[i].listed_address) {
            devices[count++] = (libusb_device *)(void *)&fake_usb[i];
        }
    }
    devices[count] = NULL;
    *list = devices;
    return count;
}

void libusb_free_device_list(libusb_device **list, int unref_devices)
{
    (void)list;
    (void)unref_devices;
}

uint8_t libusb_get_bus_number(libusb_device *device)
{
    (void)device;
    return 1;
}

uint8_t libusb_get_device_address(libusb_device *device)
{
    return (uint8_t)atomic_load(&fake(device)->address);
}

int libusb_get_device_descriptor(libusb_device *device, struct libusb_device_descriptor *d)
{
    *d = (struct libusb_device_descriptor){.idVendor = fake(device)->vendor,
                                           .idProduct = fake(device)->product,
                                           .iSerialNumber = fake(device)->serial != NULL};
    return 0;
}

/* One block, so that it can be freed as one. */
struct configuration {
    struct libusb_config_descriptor config;
    struct libusb_interface interface;
    struct libusb_interface_descriptor setting;
    struct libusb_endpoint_descriptor endpoint;
    uint8_t extra[16];
};

int libusb_get_active_config_descriptor(libusb_device *device,
                                        struct libusb_config_descriptor **config)
{
    const struct fake_device *f = fake(device);
    struct configuration *c = calloc(1, sizeof *c);
    const uint8_t hid[9] = {
        9, 0x21, 0x11, 1, 0, 1, 0x22, (uint8_t)f->told_bytes, (uint8_t)(f->told_bytes >> 8)};
    const uint8_t nonsense[9] = {0, 0x21, 0xff, 9, 9, 9, 9, 9, 9};
    memcpy(c->extra, f->has_bad_extra ? nonsense : hid, 9);
    c->endpoint =
        (struct libusb_endpoint_descriptor){.bmAttributes = LIBUSB_TRANSFER_TYPE_INTERRUPT,
                                            .bEndpointAddress = 0x81,
                                            .wMaxPacketSize = 8};
    c->setting = (struct libusb_interface_descriptor){.bInterfaceClass = LIBUSB_CLASS_HID,
                                                      .bInterfaceSubClass = f->is_boot_device,
                                                      .bNumEndpoints = 1,
                                                      .endpoint = &c->endpoint,
                                                      .extra = c->extra,
                                                      .extra_length = 9};
    c->interface = (struct libusb_interface){.altsetting = &c->setting, .num_altsetting = 1};
    c->config = (struct libusb_config_descriptor){.bNumInterfaces = 1, .interface = &c->interface};
    *config = &c->config;
    return 0;
}

void libusb_free_config_descriptor(struct libusb_config_descriptor *config)
{
    free(config);
}

int libusb_open(libusb_device *device, libusb_device_handle **handle)
{
    must(!is_in_callback, "open in a callback");
    atomic_fetch_add(&fake(device)->opens, 1);
    atomic_fetch_add(&fake(device)->opened, 1);
    *handle = (libusb_device_handle *)(void *)device;
    return 0;
}

void libusb_close(libusb_device_handle *handle)
{
    must(!is_in_callback, "close in a callback");
    for (int i = 0; i < FAKE_USB_TRANSFERS; i++) {
        must(flights[i].transfer == NULL || flights[i].transfer->dev_handle != handle,
             "close with a transfer in flight");
    }
    atomic_fetch_sub(&fake(handle)->opens, 1);
}

int libusb_set_auto_detach_kernel_driver(libusb_device_handle *handle, int enable)
{
    (void)handle;
    return enable ? 0 : LIBUSB_ERROR_NOT_SUPPORTED;
}

int libusb_claim_interface(libusb_device_handle *handle, int interface)
{
    (void)interface;
    return fake(handle)->is_busy ? LIBUSB_ERROR_BUSY : 0;
}

int libusb_release_interface(libusb_device_handle *handle, int interface)
{
    (void)handle;
    (void)interface;
    return 0;
}

int libusb_control_transfer(libusb_device_handle *handle, uint8_t type, uint8_t request,
                            uint16_t value, uint16_t index, unsigned char *data, uint16_t length,
                            unsigned int timeout)
{
    must(!is_in_callback && timeout > 0, "a control transfer that may wait for ever");
    must(type == 0x81 && request == 6 && value == 0x2200 && index == 0, "another request");
    const struct fake_device *f = fake(handle);
    const int size = f->descriptor_bytes < length ? f->descriptor_bytes : length;
    memcpy(data, f->descriptor, (size_t)size);
    return size;
}

int libusb_get_string_descriptor_ascii(libusb_device_handle *handle, uint8_t index,
                                       unsigned char *data, int length)
{
    (void)index;
    return snprintf((char *)data, (size_t)length, "%s", fake(handle)->serial);
}

const char *libusb_strerror(int code)
{
    return code == LIBUSB_ERROR_BUSY ? "Resource busy" : "Other error";
}

struct libusb_transfer *libusb_alloc_transfer(int packets)
{
    (void)packets;
    atomic_fetch_add(&fake_usb_transfers, 1);
    return calloc(1, sizeof(struct libusb_transfer));
}

void libusb_free_transfer(struct libusb_transfer *transfer)
{
    for (int i = 0; i < FAKE_USB_TRANSFERS; i++) {
        must(flights[i].transfer != transfer, "a transfer freed in flight");
    }
    atomic_fetch_sub(&fake_usb_transfers, transfer != NULL);
    free(transfer);
}

int libusb_submit_transfer(struct libusb_transfer *transfer)
{
    if (!atomic_load(&fake(transfer->dev_handle)->is_plugged)) {
        return LIBUSB_ERROR_NO_DEVICE;
    }
    for (int i = 0; i < FAKE_USB_TRANSFERS; i++) {
        must(flights[i].transfer != transfer, "a transfer submitted twice");
    }
    for (int i = 0; i < FAKE_USB_TRANSFERS; i++) {
        if (flights[i].transfer == NULL) {
            flights[i] = (struct flight){transfer, false};
            return 0;
        }
    }
    return LIBUSB_ERROR_NO_MEM;
}

int libusb_cancel_transfer(struct libusb_transfer *transfer)
{
    for (int i = 0; i < FAKE_USB_TRANSFERS; i++) {
        if (flights[i].transfer == transfer) {
            flights[i].is_cancelled = true;
            return 0;
        }
    }
    return LIBUSB_ERROR_NOT_FOUND;
}

/* Whether the transfer comes back now, and how. */
static bool is_finished(const struct flight *f)
{
    struct libusb_transfer *t = f->transfer;
    struct fake_device *d = fake(t->dev_handle);
    t->actual_length = 0;
    if (f->is_cancelled) {
        t->status = LIBUSB_TRANSFER_CANCELLED;
        return true;
    }
    if (!atomic_load(&d->is_plugged)) {
        t->status = LIBUSB_TRANSFER_NO_DEVICE;
        return true;
    }
    t->status = LIBUSB_TRANSFER_COMPLETED;
    if (atomic_load(&d->is_unbound)) {
        return true;
    }
    if (atomic_load(&d->reports) == 0) {
        return false;
    }
    atomic_fetch_sub(&d->reports, 1);
    t->actual_length = d->report_bytes;
    memcpy(t->buffer, d->report, (size_t)d->report_bytes);
    return true;
}

int libusb_handle_events_timeout_completed(libusb_context *ctx, struct timeval *tv, int *completed)
{
    (void)tv;
    (void)completed;
    must(ctx != NULL && !is_in_callback, "events in a callback");
    const struct timespec rest = {.tv_nsec = 200000};
    nanosleep(&rest, NULL);
    for (int i = 0; i < FAKE_USB_TRANSFERS; i++) {
        struct libusb_transfer *t = flights[i].transfer;
        if (t != NULL && is_finished(&flights[i])) {
            flights[i].transfer = NULL;
            is_in_callback = true;
            t->callback(t);
            is_in_callback = false;
        }
    }
    return 0;
}
