/* landmass-dis: the entities of a DIS exercise as live targets of the display. */
#include "dis/capture.h"
#include "dis/cigi.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/progress.h"
#include "hs/real_time.h"
#include "hs/report.h"
#include "hs/udp.h"
#include "image/reader.h"
#include "output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { STEP_US = 5000, BATCH = 64 };

struct run {
    struct command command;
    struct dis_kinds kinds;
    struct image image;
    struct output output;
    struct dis_gateway *gateway;
    struct dis_cigi *cigi;    /* NULL: the datagrams are of DIS */
    int64_t first_us, now_us; /* on the clock of the record, or UTC */
    int64_t paced_from_us;    /* CLOCK_MONOTONIC at first_us */
    bool has_begun, has_image;
    struct dis_capture capture; /* its counts */
    uint64_t other_port;
    uint32_t lost;
    uint8_t bytes[DIS_DATAGRAM_MAX];
};

/* ---- time ---- */

static bool is_over(const struct run *r, int64_t now_us)
{
    return hs_is_interrupted() || (r->command.seconds > 0 && r->has_begun &&
                                   (double)(now_us - r->first_us) * 1e-6 >= r->command.seconds);
}

static void begin(struct run *r, int64_t now_us)
{
    if (!r->has_begun) {
        r->has_begun = true;
        r->first_us = r->now_us = now_us;
        r->paced_from_us = hs_clock_us(CLOCK_MONOTONIC);
    }
}

static void take(struct run *r, const uint8_t *bytes, size_t length, int64_t now_us)
{
    if (r->cigi != NULL) {
        dis_cigi_take(r->cigi, bytes, length, now_us);
    } else {
        dis_gateway_take(r->gateway, bytes, length, now_us);
    }
}

static void step(struct run *r, int64_t now_us)
{
    r->now_us = now_us;
    dis_gateway_step(r->gateway, now_us);
    output_flush(&r->output);
}

/* An interface gets a record at the speed at which it was made. */
static void wait_until(const struct run *r, int64_t now_us)
{
    const int64_t until_us = r->paced_from_us + (now_us - r->first_us);
    const struct timespec t = {until_us / 1000000, until_us % 1000000 * 1000};
    while (r->command.can != NULL && !hs_is_interrupted() &&
           clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) == EINTR) {
    }
}

/* The steps up to `until_us` of a record. Recorders' clocks are set back now and then: what is
 * older than what came before it is taken as just as old. */
static void step_until(struct run *r, int64_t until_us)
{
    begin(r, until_us);
    /* A longer silence has no step that would say anything new: all have timed out. */
    const int64_t silent_us = (int64_t)(r->command.settings.timeout_s * 2e6) + 20000000;
    if (until_us - r->now_us > silent_us) {
        const int64_t resumes_us = until_us - STEP_US;
        for (int64_t t = r->now_us + STEP_US; t < r->now_us + silent_us && t < resumes_us;) {
            t += STEP_US;
            step(r, t);
        }
        step(r, resumes_us);
    }
    while (until_us - r->now_us > STEP_US && !is_over(r, r->now_us + STEP_US)) {
        wait_until(r, r->now_us + STEP_US);
        step(r, r->now_us + STEP_US);
    }
}

static void take_recorded(struct run *r, const uint8_t *bytes, size_t length, int64_t time_us)
{
    step_until(r, time_us);
    const int64_t now_us = time_us > r->now_us ? time_us : r->now_us;
    if (!is_over(r, now_us)) {
        wait_until(r, now_us);
        take(r, bytes, length, now_us);
        step(r, now_us);
    }
}

/* ---- sources ---- */

static int run_capture(struct run *r)
{
    struct dis_packet packet;
    struct hs_progress progress;
    if (dis_capture_open(&r->capture, r->command.capture_path) != 0) {
        return -1;
    }
    hs_progress_begin_beside(&progress, r->output.log, "reading", dis_capture_size(&r->capture));
    int status;
    while ((status = dis_capture_next(&r->capture, &packet)) == 1 && !is_over(r, r->now_us)) {
        if (r->command.port != 0 && packet.port != r->command.port) {
            r->other_port++;
            continue;
        }
        take_recorded(r, packet.bytes, packet.length, packet.time_us);
        hs_progress_update(&progress, dis_capture_at(&r->capture));
    }
    hs_progress_end(&progress);
    dis_capture_close(&r->capture);
    return status < 0 ? -1 : 0;
}

static int read_datagram(struct run *r, const char *path, size_t *length)
{
    FILE *in = hs_input_open(path, "rb");
    if (in == NULL) {
        return hs_error(path, NULL, "cannot be opened: %s", strerror(errno));
    }
    *length = fread(r->bytes, 1, sizeof r->bytes, in);
    const bool is_read = ferror(in) == 0;
    fclose(in);
    return is_read ? 0 : hs_error(path, NULL, "cannot be read: %s", strerror(errno));
}

static int run_files(struct run *r)
{
    for (int i = 0; i < r->command.pdu_paths.count; i++) {
        size_t length = 0;
        if (read_datagram(r, r->command.pdu_paths.items[i], &length) != 0) {
            return -1;
        }
        take_recorded(r, r->bytes, length, INT64_C(1000000) * i);
    }
    return 0;
}

/* UTC that is never set: it follows the monotonic clock from here on. */
static int run_port(struct run *r)
{
    struct hs_udp receiver;
    if (hs_udp_open(&receiver, r->command.listen_port, r->command.bind, r->command.group) != 0) {
        return -1;
    }
    const int64_t ahead_us = hs_clock_us(CLOCK_REALTIME) - hs_clock_us(CLOCK_MONOTONIC);
    begin(r, hs_clock_us(CLOCK_MONOTONIC) + ahead_us);
    int status = 0;
    while (status >= 0 && !is_over(r, hs_clock_us(CLOCK_MONOTONIC) + ahead_us)) {
        size_t length;
        for (int i = 0; i < BATCH; i++) {
            status = hs_udp_next(&receiver, i == 0 ? STEP_US / 1000 : 0, r->bytes, sizeof r->bytes,
                                 &length, NULL);
            if (status != 1) {
                break;
            }
            take(r, r->bytes, length, hs_clock_us(CLOCK_MONOTONIC) + ahead_us);
        }
        step(r, hs_clock_us(CLOCK_MONOTONIC) + ahead_us);
    }
    r->lost = receiver.lost;
    hs_udp_close(&receiver);
    return status < 0 ? -1 : 0;
}

/* ---- what was met ---- */

static void report_kinds(const struct run *r)
{
    struct dis_type types[DIS_STRANGE_MAX];
    const int count = dis_gateway_strange(r->gateway, types);
    hs_report_array("types_without_rule");
    for (int i = 0; i < count; i++) {
        const struct dis_type *t = &types[i];
        char text[40];
        snprintf(text, sizeof text, "%u.%u.%u.%u.%u.%u.%u", t->kind, t->domain, t->country,
                 t->category, t->subcategory, t->specific, t->extra);
        hs_report_text(NULL, text);
        if (!r->command.is_quiet) {
            fprintf(stderr, "no rule fits %s\n", text);
        }
    }
    hs_report_close();
}

static void report_entity(const struct dis_listed *e)
{
    char text[40];
    hs_report_object(NULL);
    snprintf(text, sizeof text, "%u:%u:%u", e->id.site, e->id.application, e->id.entity);
    hs_report_text("id", text);
    hs_report_text("marking", e->marking);
    hs_report_text("target_kind", e->has_kind ? dis_kind_name(e->kind.kind) : NULL);
    if (e->number >= 0) {
        hs_report_integer("target_number", e->number);
    }
    hs_report_real("latitude_deg", e->place.latitude_deg);
    hs_report_real("longitude_deg", e->place.longitude_deg);
    hs_report_real("ellipsoid_height_m", e->place.height_m);
    hs_report_close();
}

static void report_entities(const struct run *r)
{
    const int count = dis_gateway_entities(r->gateway);
    hs_report_array("entities_at_end");
    for (int i = 0; i < count && hs_report_is_wanted(); i++) {
        const struct dis_listed e = dis_gateway_entity(r->gateway, i, r->now_us);
        report_entity(&e);
    }
    hs_report_close();
}

static uint64_t refused(const struct dis_counts *n)
{
    uint64_t sum = 0;
    for (int i = 1; i < DIS_FAULT_COUNT; i++) {
        sum += n->fault[i];
    }
    return sum;
}

static void report_input(const struct run *r, const struct dis_counts *n)
{
    hs_report_count("datagrams", n->datagrams);
    hs_report_count("pdus", n->pdus);
    hs_report_count("entity_states", n->states);
    hs_report_count("entity_state_updates", n->updates);
    hs_report_count("commands", n->commands);
    hs_report_count("other_pdus", n->other_pdus);
    hs_report_object("refused");
    for (int i = 1; i < DIS_FAULT_COUNT; i++) {
        hs_report_count(dis_fault_key((enum dis_fault)i), n->fault[i]);
    }
    hs_report_close();
    hs_report_object("left_out");
    hs_report_count("other_versions", n->other_versions);
    hs_report_count("other_exercise", n->other_exercise);
    hs_report_count("other_site", n->other_site);
    hs_report_count("ownship", n->ownship);
    hs_report_count("update_of_unknown", n->update_of_unknown);
    hs_report_count("attached", n->attached);
    hs_report_count("without_room", n->without_room);
    hs_report_count("too_fast", n->too_fast);
    hs_report_count("too_high", n->too_high);
    hs_report_count("lost_by_the_kernel", r->lost);
    hs_report_count("other_traffic", r->capture.other_traffic + r->other_port);
    hs_report_count("fragments", r->capture.fragments);
    hs_report_count("cut_short", r->capture.cut_short);
    hs_report_close();
}

static double span_s(const struct run *r)
{
    return (double)(r->now_us - r->first_us) * 1e-6;
}

static void report_output(const struct run *r, const struct dis_counts *n)
{
    hs_report_count("entities", n->entities);
    hs_report_count("entities_skipped", n->skipped);
    hs_report_count("entities_without_rule", n->without_rule);
    hs_report_count("entities_deactivated", n->deactivated);
    hs_report_count("entities_timed_out", n->timed_out);
    hs_report_count("targets_most", n->targets_most);
    hs_report_count("targets_left_out_most", n->left_out_most);
    hs_report_count("sets", n->sets);
    hs_report_count("new_sets", n->new_sets);
    hs_report_count("changed_sets", n->changed_sets);
    hs_report_count("heartbeats", n->heartbeats);
    hs_report_count("late_sets", n->late);
    hs_report_count("removals", n->removals);
    hs_report_count("frames", n->frames);
    hs_report_count("frames_lost", n->refused_frames);
    hs_report_real("span_s", span_s(r));
    hs_report_flag("is_frozen_at_end", dis_gateway_is_frozen(r->gateway));
}

typedef unsigned long long count;

static void print_input(const struct run *r, const struct dis_counts *n)
{
    fprintf(stderr,
            "datagrams: %llu with %llu PDUs: %llu entity states, %llu updates, %llu commands, %llu "
            "others\n",
            (count)n->datagrams, (count)n->pdus, (count)n->states, (count)n->updates,
            (count)n->commands, (count)n->other_pdus);
    fprintf(stderr, "refused: %llu", (count)refused(n));
    for (int i = 1; i < DIS_FAULT_COUNT; i++) {
        if (n->fault[i] > 0) {
            fprintf(stderr, "; %llu %s", (count)n->fault[i], dis_fault_text((enum dis_fault)i));
        }
    }
    fprintf(stderr,
            "\nleft out: %llu of versions 1 to 5, %llu of another exercise, %llu of another site "
            "or application, %llu of the ownship, %llu updates of the unknown, %llu attached to "
            "others, %llu too fast, %llu too high\n",
            (count)n->other_versions, (count)n->other_exercise, (count)n->other_site,
            (count)n->ownship, (count)n->update_of_unknown, (count)n->attached, (count)n->too_fast,
            (count)n->too_high);
    const uint64_t around = r->capture.other_traffic + r->other_port;
    if (r->lost + around + r->capture.fragments + r->capture.cut_short > 0) {
        fprintf(stderr,
                "network: %llu packets of other traffic, %llu fragments, %llu cut short by the "
                "recorder, %llu lost by the kernel\n",
                (count)around, (count)r->capture.fragments, (count)r->capture.cut_short,
                (count)r->lost);
    }
}

static void print_output(const struct run *r, const struct dis_counts *n)
{
    const double seconds = span_s(r) > 0 ? span_s(r) : 1;
    fprintf(stderr,
            "entities: %llu; %llu skipped by the table, %llu without a rule, %llu without room, "
            "%llu deactivated, %llu timed out\n",
            (count)n->entities, (count)n->skipped, (count)n->without_rule, (count)n->without_room,
            (count)n->deactivated, (count)n->timed_out);
    fprintf(stderr, "targets: at most %u at once, and %u more left out for want of a number\n",
            n->targets_most, n->left_out_most);
    fprintf(stderr,
            "sent: %llu sets (%llu new, %llu changed, %llu heartbeats, %llu late) and %llu "
            "removals, %llu frames in %.1f s, %.0f frames/s, %llu lost\n",
            (count)n->sets, (count)n->new_sets, (count)n->changed_sets, (count)n->heartbeats,
            (count)n->late, (count)n->removals, (count)n->frames, span_s(r),
            (double)n->frames / seconds, (count)n->refused_frames);
}

static void report(const struct run *r)
{
    const struct dis_counts *n = dis_gateway_counts(r->gateway);
    report_input(r, n);
    report_output(r, n);
    report_kinds(r);
    if (!r->command.is_quiet) {
        print_input(r, n);
        print_output(r, n);
    }
}

/* ---- the run ---- */

static int read_files(struct run *r)
{
    const struct command *c = &r->command;
    const int status = c->kinds_path != NULL ? dis_kinds_read(&r->kinds, c->kinds_path)
                                             : dis_kinds_read_builtin(&r->kinds);
    if (status != 0 || c->image_path == NULL) {
        return status;
    }
    if (image_open(&r->image, c->image_path) != 0) {
        return -1;
    }
    r->has_image = true;
    struct dis_sea_level *sea = &r->command.settings.sea;
    sea->height_m = r->image.db.geoid_m_q6 / 64.0;
    sea->grid = r->image.db.geoid.rows > 0 ? &r->image.db.geoid : NULL;
    return 0;
}

static int run_source(struct run *r)
{
    return r->command.capture_path != NULL  ? run_capture(r)
           : r->command.pdu_paths.count > 0 ? run_files(r)
                                            : run_port(r);
}

static int run(struct run *r)
{
    if (read_files(r) != 0 || output_open(&r->output, &r->command) != 0) {
        return -1;
    }
    const struct dis_sink sink = {output_send, &r->output};
    r->gateway = dis_gateway_new(&r->command.settings, &r->kinds, &sink);
    if (r->gateway != NULL && r->command.is_cigi) {
        r->cigi = dis_cigi_new(r->gateway, &r->command.settings.sea);
    }
    const bool is_ready = r->gateway != NULL && (r->cigi != NULL || !r->command.is_cigi);
    int status = is_ready ? run_source(r) : -1;
    if (r->gateway != NULL) {
        report_entities(r);
        dis_gateway_end(r->gateway, r->now_us);
        output_flush(&r->output);
        report(r);
    }
    if (output_close(&r->output, status == 0) != 0) {
        status = -1;
    }
    return status;
}

static int print_kinds(void)
{
    if (fputs(dis_kinds_builtin(), stdout) < 0 || fflush(stdout) != 0) {
        (void)hs_error("standard output", "free some space", "cannot be written: %s",
                       strerror(errno));
        return HS_EXIT_FAILED;
    }
    return HS_EXIT_OK;
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-dis");
    static struct run r;
    int exit_code;
    hs_catch_interrupts();
    if (dis_options_read(&r.command, argc, argv, &exit_code)) {
        exit_code = r.command.prints_kinds ? print_kinds()
                    : run(&r) == 0         ? HS_EXIT_OK
                                           : HS_EXIT_FAILED;
    }
    if (r.has_image) {
        image_close(&r.image);
    }
    dis_cigi_free(r.cigi);
    dis_gateway_free(r.gateway);
    dis_options_free(&r.command);
    return hs_report_end(exit_code);
}
