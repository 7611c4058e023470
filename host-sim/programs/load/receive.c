/* Databases from a PC over USB into the slot that is not flown: the panel's end. */
#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/real_time.h"
#include "hs/report.h"
#include "wire/panel.h"
#include "wire/socket.h"
#include "wire/usb.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { ANSWER_MS = 20 * 1000 }; /* a PC that says nothing for so long is given up */

struct receive {
    const char *folder, *socket;
    bool is_once;
    struct load load;
    struct wire_function function;
    struct wire_socket local;
    struct wire_panel panel;
    char said[WIRE_TEXT_BYTES]; /* the last error */
};

static void remember(void *ctx, const char *place, const char *cause, const char *remedy)
{
    struct receive *r = ctx;
    (void)snprintf(r->said, sizeof r->said, "%s: %s%s%s", place, cause, remedy ? "; " : "",
                   remedy ? remedy : "");
}

static int guess(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    const struct slot *s = ctx;
    return s->medium.read(s->medium.ctx, offset, to, length);
}

static void opened(void *ctx, struct slot *target)
{
    struct receive *r = ctx;
    r->panel.guess = guess;
    r->panel.guess_ctx = target;
}

static void checking(void *ctx, uint64_t done, uint64_t total)
{
    struct receive *r = ctx;
    wire_panel_status(&r->panel, done, total);
}

static const char *why(void *ctx)
{
    const struct receive *r = ctx;
    const struct wire_panel *p = &r->panel;
    if (p->cause == 0) {
        return NULL;
    }
    return p->cause == ECANCELED    ? p->text
           : p->cause == ECONNRESET ? "the PC has begun anew"
                                    : wire_cause(p->cause);
}

static void welcome(struct receive *r)
{
    char text[WIRE_TEXT_BYTES] = "";
    const int next = slot_choose(r->load.slots);
    for (int i = 0; i < LM_SLOTS; i++) {
        const struct slot *s = &r->load.slots[i];
        const size_t length = strlen(text);
        (void)snprintf(text + length, sizeof text - length, "%sslot %c: %s", i == 0 ? "" : "; ",
                       load_letter(i), slot_word(s->verdict));
        if (s->verdict == SLOT_WHOLE) {
            const size_t more = strlen(text);
            (void)snprintf(text + more, sizeof text - more, ", load %" PRIu64 "%s",
                           s->record.sequence, i == next ? ", flown next" : "");
        }
    }
    wire_panel_welcome(&r->panel, text);
}

/* Before anything is written: is it an image, and signed by somebody who may? */
static int look(struct receive *r)
{
    struct slot_fault fault;
    struct load *l = &r->load;
    if (load_accept(&l->places.places, l->name, l->source, LOAD_SIGNATURE) != 0) {
        return -1;
    }
    return slot_check(l->source, SLOT_TABLES, NULL, NULL, &fault) == 0
               ? 0
               : hs_error(l->name, "nothing was written", "offset 0x%" PRIx64 ": %s", fault.offset,
                          fault.cause);
}

static void tell_end(struct receive *r, int result)
{
    const struct load *l = &r->load;
    char text[WIRE_TEXT_BYTES];
    if (result != 0) {
        wire_panel_refuse(&r->panel, r->said);
        return;
    }
    const struct slot *s = &l->slots[l->slot];
    const struct wire_figures figures = {.load = s->record.sequence,
                                         .image_bytes = s->record.image_bytes,
                                         .written_bytes = l->load.written_bytes,
                                         .kept_bytes = l->load.kept_bytes,
                                         .bad_blocks = l->load.bad_blocks,
                                         .is_there_already = l->is_there};
    (void)snprintf(text, sizeof text,
                   l->is_there ? "slot %c holds this database already"
                               : "slot %c: load %" PRIu64
                                 "; every record was read back and is "
                                 "right; flown from the panel's next start on",
                   load_letter(l->slot), s->record.sequence);
    wire_panel_done(&r->panel, &figures, text);
}

/* One image of one PC. Returns 0, or -1 with the error reported. */
static int take_one(struct receive *r)
{
    struct load *l = &r->load;
    r->said[0] = '\0';
    load_judge(l->slots, &l->places, SLOT_TABLES);
    welcome(r);
    hs_report_object(NULL);
    const int result = look(r) == 0 ? load_run(l) : -1;
    if (result == 0) {
        load_report(l);
        hs_report_count("sent_bytes", r->panel.sent_bytes);
        hs_report_count("same_bytes", r->panel.same_bytes);
    }
    hs_report_flag("is_done", result == 0);
    hs_report_close();
    fflush(stdout);
    slot_close(&l->slots[0]);
    slot_close(&l->slots[1]);
    tell_end(r, result);
    return result;
}

/* Until a signal comes; 0, or -1 with the error reported. */
static int serve(struct receive *r)
{
    for (;;) {
        const int cause = wire_panel_wait(&r->panel);
        if (cause == 0) {
            const int result = take_one(r);
            if (r->is_once) {
                return result;
            }
        } else if (cause == EINTR) {
            return 0;
        } else if (cause != ENODEV) { /* pulled: the next one is waited for */
            return hs_error(r->load.name, "restart landmass-load-usb", "%s", wire_cause(cause));
        }
    }
}

static int listen_to_pc(struct receive *r)
{
    if (r->socket) {
        const int cause = wire_socket_listen(&r->local, r->socket);
        return cause == 0 ? 0
                          : hs_error(r->socket, "choose another path",
                                     "the socket cannot be made: %s", strerror(cause));
    }
    const int cause = wire_function_open(&r->function, r->folder);
    return cause == 0
               ? 0
               : hs_error(r->folder,
                          "`systemctl start landmass-load-usb` mounts it, where the kernel has "
                          "FunctionFS",
                          "is no FunctionFS that can be used: %s", strerror(cause));
}

static void close_link(struct receive *r)
{
    if (r->socket) {
        wire_socket_close(&r->local);
    } else {
        wire_function_close(&r->function);
    }
}

static int run(struct receive *r)
{
    int result = listen_to_pc(r);
    if (result == 0) {
        struct load *l = &r->load;
        wire_panel_open(&r->panel, r->socket ? &r->local.link : &r->function.link, ANSWER_MS);
        l->name = r->socket ? r->socket : "USB";
        l->source = &r->panel.port;
        l->opened = opened;
        l->checking = checking;
        l->why = why;
        l->ctx = r;
        hs_error_listen(remember, r);
        hs_catch_interrupts();
        hs_report_array("loads");
        result = serve(r);
        hs_report_close();
        hs_report_count("damaged_messages", r->panel.bad);
        hs_error_listen(NULL, NULL);
    }
    close_link(r);
    return result;
}

int load_cmd_receive(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "receive", "a panel: take databases from a PC over USB",
        "The service landmass-load-usb runs it on a panel whose board is a USB device. Each "
        "database that landmass-load send offers goes into the slot that is not flown, as with "
        "put. Its signature is checked before anything is written; whose is accepted, and whether "
        "an older one is, the configuration says, never the PC.\n"
        "It ends with a signal."};
    static struct receive r = {.folder = "/run/landmass-usb",
                               .load = {.places = {.config = SLOT_CONFIG}}};
    int exit_code;
    const struct hs_option options[] = {
        {"functionfs", HS_TEXT, &r.folder, 0, 0, "FOLDER",
         "where FunctionFS is mounted; left out: /run/landmass-usb", false},
        {"socket", HS_TEXT, &r.socket, 0, 0, "PATH",
         "a local socket instead of USB, for send --socket: to try it without a cable", false},
        {"once", HS_FLAG, &r.is_once, 0, 0, NULL,
         "end after one database; the exit code is 1 if it was not taken", false},
        LOAD_PANEL_OPTIONS(r.load.places),
        HS_CLASHES_ROW("socket", "functionfs"),
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    if (load_places_find(&r.load.places) != 0) {
        return HS_EXIT_FAILED;
    }
    return run(&r) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
