#include "drv/usb.h"

#include <errno.h>
#include <libusb.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    STACK_BYTES = 256 << 10,
    PUMP_MS = 100,
    LOOK_EVERY_S = 1,
    CONTROL_TIMEOUT_MS = 500,
    EMPTY_MAX = 64,   /* transfers without data in a row: the device is no longer there */
    CLOSE_PUMPS = 20, /* cancelled transfers come back within this many pumps, or never */
    REFUSED_MAX = 32,
    TRIES = 3, /* a device just plugged in may not be ready, or belong to another program yet */
    ERROR_BYTES = 160,
    HID_REPORT_DESCRIPTOR = 0x22, /* HID 1.11, 7.1 */
    HID_DESCRIPTOR = 0x21,
    HID_BOOT = 1, /* HID 1.11, 4.2 */
    HID_DESCRIPTOR_BYTES = 9
};

/* A client and the device that it has. */
struct slot {
    struct drv_usb *usb;
    struct drv_usb_client client;
    libusb_device_handle *handle; /* NULL: none */
    int interface;
    bool is_gone;       /* to be closed, outside of any callback */
    uint32_t in_flight; /* transfers that the library has */
    uint32_t empty;     /* in a row */
    struct libusb_transfer *transfer[DRV_USB_TRANSFERS];
    uint8_t bytes[DRV_USB_TRANSFERS][DRV_HID_REPORT_BYTES];
};

/* A device that was tried in vain, by its place and its turn there. */
struct place {
    uint8_t bus, address;
    uint8_t tries;
};

struct drv_usb {
    libusb_context *context; /* NULL: not available yet */
    pthread_t thread;
    atomic_bool is_over;
    struct slot slot[DRV_USB_CLIENTS];
    uint32_t slot_count;
    struct place refused[REFUSED_MAX]; /* devices that were looked at and are not wanted */
    uint32_t refused_count;
    struct {
        atomic_uint attached, detached, refused, reports, empty, errors;
    } count;
};

/* Where a device's reports come from. */
struct endpoint {
    int interface;
    uint8_t address;
    uint16_t packet_bytes;
    uint16_t descriptor_bytes; /* of the report descriptor */
};

static void count_one(atomic_uint *counter)
{
    atomic_fetch_add_explicit(counter, 1, memory_order_relaxed);
}

static void tell(const struct slot *s, const struct drv_usb_identity *i, const char *what)
{
    char text[ERROR_BYTES];
    snprintf(text, sizeof text, "%04x:%04x: %s", i->vendor, i->product, what);
    s->client.tell(s->client.ctx, text);
}

/* A transfer came back. Nothing may be closed from here (libusb, libusb_close), only marked. */
static void LIBUSB_CALL take(struct libusb_transfer *t)
{
    struct slot *s = t->user_data;
    const bool is_complete = t->status == LIBUSB_TRANSFER_COMPLETED;
    s->in_flight--;
    if (is_complete && t->actual_length > 0) {
        s->empty = 0;
        count_one(&s->usb->count.reports);
        s->client.report(s->client.ctx, t->buffer, (size_t)t->actual_length);
    } else if (is_complete) {
        /* A device whose driver was taken away answers so for ever. */
        count_one(&s->usb->count.empty);
        s->is_gone = s->is_gone || ++s->empty > EMPTY_MAX;
    } else {
        if (t->status != LIBUSB_TRANSFER_CANCELLED) {
            count_one(&s->usb->count.errors);
        }
        s->is_gone = true;
    }
    if (!s->is_gone && libusb_submit_transfer(t) == 0) {
        s->in_flight++;
    } else {
        s->is_gone = true;
    }
}

/* Cancel, wait for the library to give everything back, and only then close. */
static void close_slot(struct slot *s)
{
    if (s->handle == NULL) {
        return;
    }
    s->is_gone = true;
    for (uint32_t i = 0; i < DRV_USB_TRANSFERS; i++) {
        (void)libusb_cancel_transfer(s->transfer[i]);
    }
    for (int i = 0; i < CLOSE_PUMPS && s->in_flight > 0; i++) {
        struct timeval step = {.tv_usec = PUMP_MS * 1000};
        (void)libusb_handle_events_timeout_completed(s->usb->context, &step, NULL);
    }
    (void)libusb_release_interface(s->handle, s->interface);
    libusb_close(s->handle);
    s->handle = NULL;
    count_one(&s->usb->count.detached);
    s->client.detach(s->client.ctx);
}

/* The length of the report descriptor, from the HID descriptor among the extra ones (6.2.1). 0:
 * there is none that makes sense. */
static uint16_t report_descriptor_bytes(const struct libusb_interface_descriptor *d)
{
    int left = d->extra_length;
    for (const uint8_t *at = d->extra; left >= 2 && at[0] >= 2 && at[0] <= left;) {
        if (at[1] == HID_DESCRIPTOR && at[0] >= HID_DESCRIPTOR_BYTES &&
            at[6] == HID_REPORT_DESCRIPTOR) {
            return (uint16_t)(at[7] | at[8] << 8);
        }
        left -= at[0];
        at += at[0];
    }
    return 0;
}

static bool find_interrupt_in(const struct libusb_interface_descriptor *d, struct endpoint *e)
{
    for (uint8_t i = 0; i < d->bNumEndpoints; i++) {
        const struct libusb_endpoint_descriptor *p = &d->endpoint[i];
        const uint16_t bytes = p->wMaxPacketSize & 0x7ff;
        if ((p->bmAttributes & 3) == LIBUSB_TRANSFER_TYPE_INTERRUPT &&
            (p->bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0 && bytes > 0) {
            *e = (struct endpoint){.interface = d->bInterfaceNumber,
                                   .address = p->bEndpointAddress,
                                   .packet_bytes = bytes,
                                   .descriptor_bytes = report_descriptor_bytes(d)};
            return true;
        }
    }
    return false;
}

/* The first HID interface that sends reports. */
static bool find_endpoint(libusb_device *device, struct endpoint *e,
                          struct drv_usb_identity *identity)
{
    struct libusb_config_descriptor *config;
    bool is_found = false;
    if (libusb_get_active_config_descriptor(device, &config) != 0) {
        return false;
    }
    for (uint8_t i = 0; i < config->bNumInterfaces && !is_found; i++) {
        const struct libusb_interface_descriptor *d = config->interface[i].altsetting;
        is_found = config->interface[i].num_altsetting > 0 &&
                   d->bInterfaceClass == LIBUSB_CLASS_HID && find_interrupt_in(d, e);
        identity->is_boot_device = is_found && d->bInterfaceSubClass == HID_BOOT;
    }
    libusb_free_config_descriptor(config);
    return is_found;
}

/* Ask the device for its report descriptor and the client for its opinion. */
static const char *introduce(struct slot *s, const struct endpoint *e,
                             const struct drv_usb_identity *identity)
{
    uint8_t descriptor[DRV_HID_DESCRIPTOR_BYTES];
    if (e->packet_bytes > DRV_HID_REPORT_BYTES) {
        return "its reports are longer than 64 bytes";
    }
    if (e->descriptor_bytes == 0 || e->descriptor_bytes > sizeof descriptor) {
        return "its report descriptor has no sensible length";
    }
    const int got = libusb_control_transfer(
        s->handle, (uint8_t)LIBUSB_ENDPOINT_IN | (uint8_t)LIBUSB_RECIPIENT_INTERFACE,
        LIBUSB_REQUEST_GET_DESCRIPTOR, HID_REPORT_DESCRIPTOR << 8, (uint16_t)e->interface,
        descriptor, e->descriptor_bytes, CONTROL_TIMEOUT_MS);
    if (got != e->descriptor_bytes) {
        return "it does not send its report descriptor";
    }
    return s->client.attach(s->client.ctx, identity, descriptor, (size_t)got);
}

/* Every transfer on its way. At least one is; a device that takes none is gone already. */
static void submit(struct slot *s, const struct endpoint *e)
{
    for (uint32_t i = 0; i < DRV_USB_TRANSFERS; i++) {
        libusb_fill_interrupt_transfer(s->transfer[i], s->handle, e->address, s->bytes[i],
                                       e->packet_bytes, take, s, 0);
        if (libusb_submit_transfer(s->transfer[i]) == 0) {
            s->in_flight++;
        }
    }
    s->is_gone = s->in_flight == 0;
}

static void read_serial(libusb_device_handle *handle, uint8_t index, char serial[DRV_USB_SERIAL])
{
    if (index == 0 || libusb_get_string_descriptor_ascii(handle, index, (unsigned char *)serial,
                                                         DRV_USB_SERIAL) < 0) {
        serial[0] = '\0';
    }
    serial[DRV_USB_SERIAL - 1] = '\0';
}

/* NULL: the client has it. Otherwise the cause why not, with nothing left open. */
static const char *open_device(struct slot *s, libusb_device *device, const struct endpoint *e,
                               uint8_t serial_index, struct drv_usb_identity *identity)
{
    int status = libusb_open(device, &s->handle);
    if (status != 0) {
        s->handle = NULL;
        return libusb_strerror(status);
    }
    (void)libusb_set_auto_detach_kernel_driver(s->handle, 1);
    status = libusb_claim_interface(s->handle, e->interface);
    const char *cause = status == 0 ? NULL : libusb_strerror(status);
    if (cause == NULL) {
        read_serial(s->handle, serial_index, identity->serial);
        cause = introduce(s, e, identity);
    }
    if (cause != NULL) {
        (void)libusb_release_interface(s->handle, e->interface);
        libusb_close(s->handle);
        s->handle = NULL;
        return cause;
    }
    s->interface = e->interface;
    s->is_gone = false;
    s->in_flight = s->empty = 0;
    submit(s, e);
    return NULL;
}

/* The device's entry; a new one, as long as there is room; NULL when there is none. */
static struct place *place_of(struct drv_usb *u, libusb_device *device)
{
    const struct place at = {libusb_get_bus_number(device), libusb_get_device_address(device), 0};
    for (uint32_t i = 0; i < u->refused_count; i++) {
        if (u->refused[i].bus == at.bus && u->refused[i].address == at.address) {
            return &u->refused[i];
        }
    }
    if (u->refused_count == REFUSED_MAX) {
        return NULL;
    }
    u->refused[u->refused_count] = at;
    return &u->refused[u->refused_count++];
}

/* Devices that have left make room; an address is not used again soon. */
static void forget_absent(struct drv_usb *u, libusb_device **list)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < u->refused_count; i++) {
        bool is_there = false;
        for (libusb_device **d = list; *d != NULL && !is_there; d++) {
            is_there = libusb_get_bus_number(*d) == u->refused[i].bus &&
                       libusb_get_device_address(*d) == u->refused[i].address;
        }
        if (is_there) {
            u->refused[kept++] = u->refused[i];
        }
    }
    u->refused_count = kept;
}

static void try_device(struct slot *s, libusb_device *device)
{
    struct libusb_device_descriptor d;
    struct place *place = place_of(s->usb, device);
    if (place == NULL || place->tries == TRIES || libusb_get_device_descriptor(device, &d) != 0 ||
        d.bDeviceClass == LIBUSB_CLASS_HUB) {
        return;
    }
    struct endpoint e;
    struct drv_usb_identity identity = {.vendor = d.idVendor, .product = d.idProduct};
    if (!find_endpoint(device, &e, &identity) || !s->client.wants(s->client.ctx, &identity)) {
        return;
    }
    const char *cause = open_device(s, device, &e, d.iSerialNumber, &identity);
    if (cause == NULL) {
        count_one(&s->usb->count.attached);
        tell(s, &identity, "attached");
        place->tries = 0;
    } else if (place->tries++ == 0) {
        count_one(&s->usb->count.refused);
        tell(s, &identity, cause);
    }
}

static bool has_device(const struct drv_usb *u)
{
    bool is_any = false;
    for (uint32_t i = 0; i < u->slot_count; i++) {
        is_any = is_any || u->slot[i].handle != NULL;
    }
    return is_any;
}

/* The library learns of devices that come from udev alone; where no udevd runs, what it knows is
 * what was there when its context was made. While nobody has a device a new one costs nothing. */
static void renew_context(struct drv_usb *u)
{
    if (u->context != NULL && !has_device(u)) {
        libusb_exit(u->context);
        u->context = NULL;
    }
    if (u->context == NULL && libusb_init(&u->context) != 0) {
        u->context = NULL;
    }
}

/* Offer every device to every client that has none. */
static void look(struct drv_usb *u)
{
    libusb_device **list;
    if (libusb_get_device_list(u->context, &list) < 0) {
        return;
    }
    forget_absent(u, list);
    for (uint32_t i = 0; i < u->slot_count; i++) {
        for (libusb_device **d = list; *d != NULL && u->slot[i].handle == NULL; d++) {
            try_device(&u->slot[i], *d);
        }
    }
    libusb_free_device_list(list, 1);
}

static void pump(struct drv_usb *u)
{
    struct timeval step = {.tv_usec = PUMP_MS * 1000};
    if (u->context == NULL ||
        libusb_handle_events_timeout_completed(u->context, &step, NULL) != 0) {
        const struct timespec rest = {.tv_nsec = PUMP_MS * 1000000};
        nanosleep(&rest, NULL);
    }
    for (uint32_t i = 0; i < u->slot_count; i++) {
        struct slot *s = &u->slot[i];
        if (s->handle != NULL && s->is_gone) {
            close_slot(s);
            s->client.tell(s->client.ctx, "the device has gone");
        }
        s->client.idle(s->client.ctx);
    }
}

static void *run(void *argument)
{
    struct drv_usb *u = argument;
    for (time_t look_s = 0; !atomic_load(&u->is_over);) {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        if (now.tv_sec >= look_s) {
            look_s = now.tv_sec + LOOK_EVERY_S;
            renew_context(u);
            if (u->context != NULL) {
                look(u);
            }
        }
        pump(u);
    }
    for (uint32_t i = 0; i < u->slot_count; i++) {
        close_slot(&u->slot[i]);
    }
    return NULL;
}

static void release(struct drv_usb *u)
{
    for (uint32_t i = 0; i < u->slot_count; i++) {
        for (uint32_t k = 0; k < DRV_USB_TRANSFERS; k++) {
            libusb_free_transfer(u->slot[i].transfer[k]);
        }
    }
    if (u->context != NULL) {
        libusb_exit(u->context);
    }
    free(u);
}

static bool allocate_transfers(struct drv_usb *u)
{
    bool is_complete = true;
    for (uint32_t i = 0; i < u->slot_count; i++) {
        for (uint32_t k = 0; k < DRV_USB_TRANSFERS; k++) {
            u->slot[i].transfer[k] = libusb_alloc_transfer(0);
            is_complete = is_complete && u->slot[i].transfer[k] != NULL;
        }
    }
    return is_complete;
}

static int start_thread(struct drv_usb *u)
{
    pthread_attr_t attributes;
    int cause = pthread_attr_init(&attributes);
    if (cause == 0) {
        pthread_attr_setstacksize(&attributes, STACK_BYTES);
        cause = pthread_create(&u->thread, &attributes, run, u);
        pthread_attr_destroy(&attributes);
    }
    return cause;
}

struct drv_usb *drv_usb_start(const struct drv_usb_client *clients, uint32_t count, char *error)
{
    struct drv_usb *u = count <= DRV_USB_CLIENTS ? calloc(1, sizeof *u) : NULL;
    if (u == NULL) {
        snprintf(error, ERROR_BYTES, "USB: no memory, or too many clients");
        return NULL;
    }
    u->slot_count = count;
    for (uint32_t i = 0; i < count; i++) {
        u->slot[i].usb = u;
        u->slot[i].client = clients[i];
    }
    const int cause = allocate_transfers(u) ? start_thread(u) : ENOMEM;
    if (cause != 0) {
        snprintf(error, ERROR_BYTES, "USB: %s", strerror(cause));
        release(u);
        return NULL;
    }
    return u;
}

void drv_usb_stop(struct drv_usb *u)
{
    if (u != NULL) {
        atomic_store(&u->is_over, true);
        pthread_join(u->thread, NULL);
        release(u);
    }
}

struct drv_usb_counts drv_usb_counts(const struct drv_usb *u)
{
    return (struct drv_usb_counts){
        .attached = atomic_load(&u->count.attached),
        .detached = atomic_load(&u->count.detached),
        .refused = atomic_load(&u->count.refused),
        .reports = atomic_load(&u->count.reports),
        .empty = atomic_load(&u->count.empty),
        .errors = atomic_load(&u->count.errors),
    };
}
