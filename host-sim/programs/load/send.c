/* A database to a panel over USB: the maintenance PC's end. */
#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/real_time.h"
#include "hs/report.h"
#include "lm/db.h"
#include "wire/pc.h"
#include "wire/socket.h"
#include "wire/usb.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

enum { WAIT_MS = 300 * 1000, POLLS = 1000000 };

struct send {
    struct load_file file;
    const char *usb, *socket;
    uint16_t vendor, product;
    struct load_bar bar;
    struct wire_host host;
    struct wire_socket local;
    struct wire_pc pc;
};

static void checking_file(void *ctx, uint64_t done, uint64_t total)
{
    load_bar_move(ctx, "checking the file", done, total);
}

static void show_progress(void *ctx, enum wire_stage stage, uint64_t done, uint64_t total)
{
    static const char *const labels[] = {
        [WIRE_SENDING] = "sending", [WIRE_CHECKING] = "the panel checks"};
    load_bar_move(ctx, labels[stage], done, total);
}

static int read_image(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    return lm_db_read(ctx, offset, to, length, POLLS) == LM_OK ? 0 : EIO;
}

/* "1209:0001", as lsusb prints it. */
static bool take_numbers(struct send *s)
{
    unsigned vendor, product;
    int end = 0;
    const bool is_good =
        sscanf(s->usb, "%4x:%4x%n", &vendor, &product, &end) == 2 && s->usb[end] == '\0';
    s->vendor = is_good ? (uint16_t)vendor : 0;
    s->product = is_good ? (uint16_t)product : 0;
    return is_good;
}

static int refuse_usb(const struct send *s, int cause)
{
    switch (cause) {
    case ENXIO:
        return hs_error(s->usb,
                        "plug it in; on the panel `systemctl status landmass-load-usb` tells "
                        "whether it listens",
                        "no panel of these USB numbers is connected");
    case EMFILE:
        return hs_error(s->usb, "unplug all but one", "several panels are connected");
    case EACCES:
        return hs_error(s->usb, "run it as root, or let a udev rule give you the device",
                        "the panel may not be opened");
    case EBUSY:
        return hs_error(s->usb, "wait for it", "another program sends to the panel");
    default:
        return hs_error(s->usb, "unplug it and plug it in again", "USB failed");
    }
}

static int connect_panel(struct send *s)
{
    if (s->socket) {
        const int cause = wire_socket_connect(&s->local, s->socket);
        s->pc.link = &s->local.link;
        return cause == 0 ? 0
                          : hs_error(s->socket, "start `landmass-load receive --socket` first",
                                     "nobody listens: %s", wire_cause(cause));
    }
    const int cause = wire_host_open(&s->host, s->vendor, s->product);
    s->pc.link = &s->host.link;
    return cause == 0 ? 0 : refuse_usb(s, cause);
}

static void disconnect_panel(struct send *s)
{
    if (s->socket) {
        wire_socket_close(&s->local);
    } else {
        wire_host_close(&s->host);
    }
}

static int explain(const struct send *s, int cause)
{
    const char *place = s->socket ? s->socket : s->usb;
    switch (cause) {
    case 0:
        return 0;
    case ECANCELED:
        return hs_error("the panel", NULL, "%s", s->pc.text);
    case EIO:
        return hs_error(s->file.name, "the panel flies on as before",
                        "cannot be read any more, or USB failed");
    case EPROTONOSUPPORT:
        return hs_error(place, "use the landmass-load of the panel's version",
                        "the panel has version %" PRIu32 " of the protocol, this program %d",
                        s->pc.version, (int)WIRE_VERSION);
    default:
        return hs_error(place, "the panel flies on as before; run it again to go on", "%s",
                        wire_cause(cause));
    }
}

static void report(const struct send *s)
{
    const struct wire_figures *f = &s->pc.figures;
    printf("%s\n", s->pc.text);
    printf("%" PRIu64 " bytes sent; the panel had %" PRIu64 " already\n", s->pc.sent_bytes,
           s->pc.same_bytes);
    hs_report_text("panel", s->pc.text);
    hs_report_count("load", f->load);
    hs_report_count("image_bytes", f->image_bytes);
    hs_report_count("sent_bytes", s->pc.sent_bytes);
    hs_report_count("same_bytes", s->pc.same_bytes);
    hs_report_flag("is_there_already", f->is_there_already != 0);
}

static void print_slots(void *ctx, const char *slots)
{
    load_bar_end(ctx);
    printf("panel: %s\n", slots);
    fflush(stdout); /* the rest takes its time */
}

static int run(struct send *s)
{
    s->pc.image =
        (struct wire_image){&s->file.flash.port, s->file.flash.port.size_bytes, read_image};
    s->pc.session = (uint64_t)hs_clock_us(CLOCK_REALTIME) ^ (uint64_t)getpid() << 48;
    s->pc.wait_ms = WAIT_MS;
    s->pc.progress = show_progress;
    s->pc.welcome = print_slots;
    s->pc.ctx = &s->bar;
    const int cause = wire_pc_run(&s->pc);
    load_bar_end(&s->bar);
    if (explain(s, cause) != 0) {
        return -1;
    }
    report(s);
    return 0;
}

int load_cmd_send(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "send", "send a database to a panel over USB",
        "Checks the file, and sends it to the panel that is plugged in. The panel checks its "
        "signature, writes it into the slot that is not flown, reads every record back, and "
        "switches to it in one step, as put does there. Its configuration decides whose images it "
        "takes, and whether older ones.\n"
        "The cable may be pulled at any moment. Run again, it goes on: of what the panel has "
        "already, digests are sent."};
    static struct send s = {.usb = "1209:0001"};
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &s.file.name, 0, 0, NULL,
         "the database image, or a folder with one of the name landmass.lmdb", true},
        {"usb", HS_TEXT, &s.usb, 0, 0, "VENDOR:PRODUCT",
         "USB numbers of the panel, as lsusb prints them; left out: 1209:0001, which pid.codes "
         "keeps for prototypes",
         false},
        {"socket", HS_TEXT, &s.socket, 0, 0, "PATH",
         "a local socket instead of USB, where receive --socket listens: to try it without a panel",
         false},
        HS_CLASHES_ROW("socket", "usb"),
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    if (!take_numbers(&s)) {
        return hs_options_wrong(&usage, "--usb", "needs two hexadecimal numbers, 1209:0001");
    }
    if (load_file_open(&s.file) != 0) {
        return HS_EXIT_FAILED;
    }
    int result = load_file_check(&s.file, checking_file, &s.bar);
    load_bar_end(&s.bar);
    if (result == 0) {
        result = connect_panel(&s) == 0 ? run(&s) : -1;
        disconnect_panel(&s);
    }
    drv_flash_file_close(&s.file.flash);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
