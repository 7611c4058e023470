/* The panel's end of a wire: FunctionFS, where the endpoints of a USB function are files. */
#include "wire/usb.h"

#include "hs/real_time.h"

#include <endian.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/usb/ch9.h>
#include <linux/usb/functionfs.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

/* One interface with a bulk endpoint each way, at one speed. */
struct speed {
    struct usb_interface_descriptor interface;
    struct usb_endpoint_descriptor_no_audio in, out;
} __attribute__((packed));

struct super_speed {
    struct usb_interface_descriptor interface;
    struct usb_endpoint_descriptor_no_audio in;
    struct usb_ss_ep_comp_descriptor in_more;
    struct usb_endpoint_descriptor_no_audio out;
    struct usb_ss_ep_comp_descriptor out_more;
} __attribute__((packed));

struct descriptors {
    struct usb_functionfs_descs_head_v2 head;
    uint32_t full_count, high_count, super_count;
    struct speed full, high;
    struct super_speed super;
} __attribute__((packed));

struct strings {
    struct usb_functionfs_strings_head head;
    uint16_t language;
    char interface[sizeof "landmass database"];
} __attribute__((packed));

static const struct usb_interface_descriptor interface = {.bLength = USB_DT_INTERFACE_SIZE,
                                                          .bDescriptorType = USB_DT_INTERFACE,
                                                          .bNumEndpoints = 2,
                                                          .bInterfaceClass = WIRE_USB_CLASS,
                                                          .bInterfaceSubClass = WIRE_USB_SUBCLASS,
                                                          .bInterfaceProtocol = WIRE_USB_PROTOCOL,
                                                          .iInterface = 1};

static struct usb_endpoint_descriptor_no_audio endpoint(uint8_t address, uint16_t packet_bytes)
{
    return (struct usb_endpoint_descriptor_no_audio){.bLength = USB_DT_ENDPOINT_SIZE,
                                                     .bDescriptorType = USB_DT_ENDPOINT,
                                                     .bEndpointAddress = address,
                                                     .bmAttributes = USB_ENDPOINT_XFER_BULK,
                                                     .wMaxPacketSize = htole16(packet_bytes)};
}

static struct speed at_speed(uint16_t packet_bytes)
{
    return (struct speed){.interface = interface,
                          .in = endpoint(1 | USB_DIR_IN, packet_bytes),
                          .out = endpoint(2 | USB_DIR_OUT, packet_bytes)};
}

static int write_all(int fd, const void *bytes, size_t size)
{
    const ssize_t count = write(fd, bytes, size);
    return count == (ssize_t)size ? 0 : count < 0 ? errno : EIO;
}

static int describe(int control)
{
    static const struct usb_ss_ep_comp_descriptor more = {
        .bLength = USB_DT_SS_EP_COMP_SIZE, .bDescriptorType = USB_DT_SS_ENDPOINT_COMP};
    const struct speed at_super_speed = at_speed(1024);
    const struct descriptors d = {
        .head = {.magic = htole32(FUNCTIONFS_DESCRIPTORS_MAGIC_V2),
                 .length = htole32(sizeof d),
                 .flags = htole32(FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC |
                                  FUNCTIONFS_HAS_SS_DESC)},
        .full_count = htole32(3),
        .high_count = htole32(3),
        .super_count = htole32(5),
        .full = at_speed(64),
        .high = at_speed(512),
        .super = {interface, at_super_speed.in, more, at_super_speed.out, more}};
    const struct strings s = {.head = {.magic = htole32(FUNCTIONFS_STRINGS_MAGIC),
                                       .length = htole32(sizeof s),
                                       .str_count = htole32(1),
                                       .lang_count = htole32(1)},
                              .language = htole16(0x0409),
                              .interface = "landmass database"};
    const int cause = write_all(control, &d, sizeof d);
    return cause == 0 ? write_all(control, &s, sizeof s) : cause;
}

/* Requests to the interface are refused: there are none. Refusing is a transfer the wrong way. */
static void *refuse_requests(void *ctx)
{
    const struct wire_function *f = ctx;
    struct usb_functionfs_event event;
    while (read(f->control, &event, sizeof event) == (ssize_t)sizeof event) {
        if (event.type == FUNCTIONFS_SETUP) {
            const bool is_in = (event.u.setup.bRequestType & USB_DIR_IN) != 0;
            (void)!(is_in ? read(f->control, NULL, 0) : write(f->control, NULL, 0));
        }
    }
    return NULL;
}

static void wake(int number)
{
    (void)number;
}

/* Signals are for the thread that waits at an endpoint. */
static int start_thread(struct wire_function *f)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int cause = pthread_create(&f->thread, NULL, refuse_requests, f);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    f->has_thread = cause == 0;
    return cause;
}

/* The alarm rings on, because the first one may come before the wait begins. */
static void set_alarm(uint32_t timeout_ms)
{
    const struct timeval first = {(time_t)(timeout_ms / 1000u),
                                  (suseconds_t)(timeout_ms % 1000u) * 1000};
    const struct itimerval timer = {.it_interval = {.tv_sec = timeout_ms != 0}, .it_value = first};
    (void)setitimer(ITIMER_REAL, &timer, NULL);
}

/* One transfer; the alarm ends it, and what it has moved until then is lost. */
static int move(int fd, uint8_t *at, uint32_t length, uint32_t timeout_ms, bool is_sending)
{
    if (hs_is_interrupted()) {
        return EINTR;
    }
    set_alarm(timeout_ms);
    const ssize_t count = is_sending ? write(fd, at, length) : read(fd, at, length);
    const int cause = count < 0 ? errno : 0;
    set_alarm(0);
    switch (cause) {
    case 0:
        return count == (ssize_t)length ? 0 : EPROTO;
    case ESHUTDOWN: /* unplugged, or a program at the PC begins anew */
    case ECONNRESET:
        return ENODEV;
    case EINTR:
        return hs_is_interrupted() ? EINTR : ETIMEDOUT;
    default:
        return cause == ENODEV ? EIO : cause;
    }
}

static int function_send(void *ctx, const void *from, uint32_t length, uint32_t timeout_ms)
{
    const struct wire_function *f = ctx;
    return move(f->in, (uint8_t *)(uintptr_t)from, length, timeout_ms, true);
}

static int function_receive(void *ctx, void *to, uint32_t length, uint32_t timeout_ms)
{
    const struct wire_function *f = ctx;
    return move(f->out, to, length, timeout_ms, false);
}

static int open_in(const char *folder, const char *name, int *fd)
{
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path) {
        return ENAMETOOLONG;
    }
    *fd = open(path, O_RDWR | O_CLOEXEC);
    return *fd < 0 ? errno : 0;
}

int wire_function_open(struct wire_function *f, const char *folder)
{
    const struct sigaction alarm = {.sa_handler = wake};
    *f = (struct wire_function){
        .control = -1, .in = -1, .out = -1, .link = {f, function_send, function_receive}};
    int cause = sigaction(SIGALRM, &alarm, NULL) == 0 ? 0 : errno;
    cause = cause == 0 ? open_in(folder, "ep0", &f->control) : cause;
    cause = cause == 0 ? describe(f->control) : cause;
    cause = cause == 0 ? open_in(folder, "ep1", &f->in) : cause;
    cause = cause == 0 ? open_in(folder, "ep2", &f->out) : cause;
    return cause == 0 ? start_thread(f) : cause;
}

void wire_function_close(struct wire_function *f)
{
    if (f->has_thread) {
        (void)pthread_cancel(f->thread);
        (void)pthread_join(f->thread, NULL);
        f->has_thread = false;
    }
    const int all[] = {f->in, f->out, f->control};
    for (int i = 0; i < 3; i++) {
        if (all[i] >= 0) {
            close(all[i]);
        }
    }
    f->in = f->out = f->control = -1;
}
