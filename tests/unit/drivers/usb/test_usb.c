/* The USB driver on a bus where devices come, go, lie and fall silent. */
#include "check.h"
#include "drv/usb.h"
#include "fake_usb.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

static const uint8_t descriptor[] = {0x05, 0x01, 0x09, 0x04, 0xa1, 0x01, 0xc0};

/* A client that wants one vendor's device and counts what it is told. */
struct listener {
    uint16_t vendor;
    const char *refusal;
    atomic_int attached, detached, reports, told, first_byte, idles;
    char serial[DRV_USB_SERIAL];
};

static bool wants(void *ctx, const struct drv_usb_identity *identity)
{
    const struct listener *l = ctx;
    return identity->vendor == l->vendor && !identity->is_boot_device;
}

static const char *attach(void *ctx, const struct drv_usb_identity *identity, const uint8_t *bytes,
                          size_t size)
{
    struct listener *l = ctx;
    if (l->refusal != NULL || size != sizeof descriptor || memcmp(bytes, descriptor, size) != 0) {
        return l->refusal != NULL ? l->refusal : "another descriptor";
    }
    memcpy(l->serial, identity->serial, sizeof l->serial);
    atomic_fetch_add(&l->attached, 1);
    return NULL;
}

static void report(void *ctx, const uint8_t *bytes, size_t size)
{
    struct listener *l = ctx;
    atomic_store(&l->first_byte, size > 0 ? bytes[0] : -1);
    atomic_fetch_add(&l->reports, 1);
}

static void detach(void *ctx)
{
    struct listener *l = ctx;
    atomic_fetch_add(&l->detached, 1);
}

static void idle(void *ctx)
{
    struct listener *l = ctx;
    atomic_fetch_add(&l->idles, 1);
}

static void tell(void *ctx, const char *text)
{
    struct listener *l = ctx;
    (void)text;
    atomic_fetch_add(&l->told, 1);
}

static struct drv_usb_client client_of(struct listener *l)
{
    return (struct drv_usb_client){l, wants, attach, report, detach, idle, tell};
}

static struct drv_usb *start(struct listener *l)
{
    const struct drv_usb_client client = client_of(l);
    char error[160];
    struct drv_usb *u = drv_usb_start(&client, 1, error);
    assert_non_null(u);
    return u;
}

/* Until `value` is `expected`, or ten seconds have passed. */
static void await(atomic_int *value, int expected)
{
    const struct timespec rest = {.tv_nsec = 1000000};
    for (int i = 0; i < 10000 && atomic_load(value) != expected; i++) {
        nanosleep(&rest, NULL);
    }
    assert_int_equal(atomic_load(value), expected);
}

/* So long that the driver would have done whatever it is not to do. */
static void let_it_look(struct listener *l)
{
    const int looks = 40;
    const int until = atomic_load(&l->idles) + looks;
    const struct timespec rest = {.tv_nsec = 1000000};
    while (atomic_load(&l->idles) < until) {
        nanosleep(&rest, NULL);
    }
}

static struct fake_device *stick(void)
{
    struct fake_device *d = &fake_usb[0];
    fake_usb_reset();
    d->vendor = 0x046d;
    d->product = 0xc215;
    d->descriptor = descriptor;
    d->descriptor_bytes = d->told_bytes = sizeof descriptor;
    d->report[0] = 42;
    d->report_bytes = 3;
    return d;
}

TEST(a_device_that_is_there_is_attached_and_its_reports_arrive)
{
    struct fake_device *d = stick();
    struct listener l = {.vendor = 0x046d};
    d->serial = "A1";
    fake_usb_plug(d);
    struct drv_usb *u = start(&l);
    await(&l.attached, 1);
    assert_string_equal(l.serial, "A1");
    atomic_store(&d->reports, 100);
    await(&l.reports, 100);
    assert_int_equal(atomic_load(&l.first_byte), 42);
    drv_usb_stop(u);
    assert_int_equal(atomic_load(&l.detached), 1);
    assert_int_equal(atomic_load(&d->opens), 0);
    assert_int_equal(atomic_load(&fake_usb_transfers), 0);
}

TEST(a_device_may_be_unplugged_and_plugged_in_again_and_again)
{
    struct fake_device *d = stick();
    struct listener l = {.vendor = 0x046d};
    struct drv_usb *u = start(&l);
    for (int n = 1; n <= 5; n++) {
        fake_usb_plug(d);
        await(&l.attached, n);
        assert_int_equal(atomic_load(&fake_usb_transfers), DRV_USB_TRANSFERS); /* once for all */
        atomic_store(&d->is_plugged, false);
        await(&l.detached, n);
        assert_int_equal(atomic_load(&d->opens), 0);
    }
    drv_usb_stop(u);
    assert_int_equal(atomic_load(&l.detached), 5);
}

/* Seen on a real kernel: a device whose driver is unbound completes every transfer with nothing. */
TEST(a_device_that_sends_nothing_for_ever_is_let_go)
{
    struct fake_device *d = stick();
    struct listener l = {.vendor = 0x046d};
    fake_usb_plug(d);
    struct drv_usb *u = start(&l);
    await(&l.attached, 1);
    atomic_store(&d->is_unbound, true);
    const struct timespec rest = {.tv_nsec = 1000000};
    for (int i = 0; i < 10000 && atomic_load(&l.detached) == 0; i++) {
        nanosleep(&rest, NULL);
    }
    assert_true(atomic_load(&l.detached) >= 1);
    assert_int_equal(atomic_load(&l.reports), 0);
    assert_true(drv_usb_counts(u).empty > 0);
    drv_usb_stop(u);
}

TEST(a_device_that_lies_about_itself_is_refused_and_left_alone)
{
    static const struct {
        int told, sent;
        bool has_bad_extra;
    } lies[] = {{0, 7, false}, {65535, 7, false}, {8, 7, false}, {7, 6, false}, {7, 7, true}};
    for (size_t i = 0; i < sizeof lies / sizeof lies[0]; i++) {
        struct fake_device *d = stick();
        struct listener l = {.vendor = 0x046d};
        d->told_bytes = lies[i].told;
        d->descriptor_bytes = lies[i].sent;
        d->has_bad_extra = lies[i].has_bad_extra;
        fake_usb_plug(d);
        struct drv_usb *u = start(&l);
        await(&d->opened, 3); /* it is tried three times */
        let_it_look(&l);
        assert_int_equal(atomic_load(&d->opened), 3);
        assert_int_equal(atomic_load(&l.attached), 0);
        assert_int_equal(atomic_load(&l.told), 1); /* and said once */
        drv_usb_stop(u);
        assert_int_equal(atomic_load(&l.detached), 0);
        assert_int_equal(atomic_load(&d->opens), 0);
    }
}

TEST(a_device_that_was_refused_is_looked_at_again_when_it_is_plugged_in_anew)
{
    struct fake_device *d = stick();
    struct listener l = {.vendor = 0x046d};
    d->is_busy = true;
    fake_usb_plug(d);
    struct drv_usb *u = start(&l);
    await(&d->opened, 3);
    let_it_look(&l);
    atomic_store(&d->is_plugged, false);
    let_it_look(&l);
    d->is_busy = false;
    fake_usb_plug(d);
    await(&l.attached, 1);
    drv_usb_stop(u);
}

TEST(what_the_client_does_not_want_is_never_opened)
{
    struct fake_device *d = stick();
    struct listener l = {.vendor = 0x1209};
    fake_usb_plug(d);
    fake_usb[1] = (struct fake_device){.vendor = 0x1209, .is_boot_device = true};
    fake_usb_plug(&fake_usb[1]);
    struct drv_usb *u = start(&l);
    let_it_look(&l);
    assert_int_equal(atomic_load(&d->opened) + atomic_load(&fake_usb[1].opened), 0);
    drv_usb_stop(u);
}

TEST(a_second_client_has_a_device_of_its_own)
{
    struct fake_device *d = stick();
    struct listener hand = {.vendor = 0x046d}, loader = {.vendor = 0x1209};
    fake_usb[1] = (struct fake_device){.vendor = 0x1209,
                                       .descriptor = descriptor,
                                       .descriptor_bytes = sizeof descriptor,
                                       .told_bytes = sizeof descriptor,
                                       .report = {7},
                                       .report_bytes = 1};
    fake_usb_plug(d);
    fake_usb_plug(&fake_usb[1]);
    const struct drv_usb_client clients[] = {client_of(&hand), client_of(&loader)};
    char error[160];
    struct drv_usb *u = drv_usb_start(clients, 2, error);
    await(&hand.attached, 1);
    await(&loader.attached, 1);
    atomic_store(&fake_usb[1].reports, 3);
    await(&loader.reports, 3);
    assert_int_equal(atomic_load(&loader.first_byte), 7);
    assert_int_equal(atomic_load(&hand.reports), 0);
    atomic_store(&d->is_plugged, false);
    await(&hand.detached, 1);
    assert_int_equal(atomic_load(&loader.detached), 0);
    drv_usb_stop(u);
}

TEST(a_machine_that_gets_its_usb_later_is_waited_for)
{
    struct fake_device *d = stick();
    struct listener l = {.vendor = 0x046d};
    fake_usb_plug(d);
    atomic_store(&fake_usb_init_failures, 2);
    struct drv_usb *u = start(&l);
    await(&l.attached, 1);
    drv_usb_stop(u);
}

TEST(more_clients_than_there_is_room_for_are_an_error)
{
    const struct drv_usb_client clients[DRV_USB_CLIENTS + 1] = {{0}};
    char error[160] = "";
    assert_null(drv_usb_start(clients, DRV_USB_CLIENTS + 1, error));
    assert_true(strlen(error) > 0);
    drv_usb_stop(NULL);
}
