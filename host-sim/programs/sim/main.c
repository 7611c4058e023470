/* landmass-sim: the display unit's firmware on a PC. */
#include "bench.h"
#include "images.h"
#include "options.h"

#include "bus/table_text.h"
#include "drv/can_log.h"
#include "drv/can_socket.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/png.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "lm/bit.h"
#include "lm/bus_filters.h"
#include "radar/text.h"
#include "sim/bezel.h"
#include "sim/drill.h"
#include "sim/hands.h"
#include "sim/script.h"
#include "sim/track_log.h"
#include "sim/window.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

/* The unit is stepped as often as a line is due at the fastest scale. */
enum { STEP_US = 2000, MALFORMED_SHOWN = 5 };

struct sim {
    struct options options;
    struct lm_radar radar;           /* of --radar */
    struct bus_table table, table_2; /* of --table, --table2 */
    struct script script;
    struct bench bench;
    struct images images;
    uint32_t images_came; /* in this step, a bit for each place */
    FILE *log_file;
    struct drv_can_log log;
    FILE *log_file_2; /* of --bus2 */
    struct drv_can_log log_2;
    struct lm_can can_2;
    struct drv_can_socket socket;
    struct lm_can can;
    struct hs_atomic_file sent; /* of --bus-out */
    struct lm_can heard;        /* the bus behind it */
    struct drill drill;
    struct lm_can drilled;           /* the bus behind the script's exercise */
    struct hs_atomic_file recording; /* of --record */
    struct recorder recorder;
    struct replay replay;
    struct window_player player;
    struct track_log tracks;
    uint64_t now_us; /* of the step */
    struct timespec slept;
    struct hands hands;
    struct bezel bezel;
    uint32_t *bezel_pixels; /* owned; NULL when no bezel is asked for */
    struct window *window;
    uint32_t pictures_written;
    uint32_t malformed_shown;
};

static int no_bus(void *ctx, struct lm_can_frame *frame)
{
    (void)ctx;
    (void)frame;
    return 0;
}

static int hear(void *ctx, struct lm_can_frame *frame)
{
    const struct sim *s = ctx;
    return s->heard.receive(s->heard.ctx, frame);
}

/* Send to the bus, if it is one that can be sent to, and into the log. */
static int send_and_log(void *ctx, const struct lm_can_frame *frame)
{
    struct sim *s = ctx;
    const int status = s->heard.send ? s->heard.send(s->heard.ctx, frame) : LM_OK;
    if (status == LM_OK) {
        (void)drv_can_log_write(s->sent.stream, "can0", s->now_us, frame); /* commit tells */
    }
    return status;
}

static bool has_exercise(const struct sim *s)
{
    return s->script.exercise.has_clock || s->script.exercise.malfunction_count > 0;
}

/* The exercise of the script beside the bus. */
static int open_drill(struct sim *s)
{
    if (!has_exercise(s)) {
        return 0;
    }
    const uint8_t *const nodes = s->options.nodes;
    const unsigned node = NAV_EXERCISE_NODE;
    if (s->bench.unit->bus.profile != &lm_bus_canas17) {
        return hs_error(s->options.script, "fly with --profile canas17",
                        "`clock` and `break` are frames of canas17, which this bus is not");
    }
    if (s->options.has_nodes && (nodes[node / 8] >> node % 8 & 1) == 0) {
        return hs_error(s->options.script, "name it, too",
                        "`clock` and `break` are of node %u, which --nodes leaves out", node);
    }
    s->drilled = s->can;
    s->can = drill_open(&s->drill, &s->script.exercise, &s->drilled);
    return 0;
}

static int open_sent_log(struct sim *s)
{
    if (!s->options.bus_out) {
        return 0;
    }
    s->heard = s->can;
    s->can = (struct lm_can){.ctx = s, .receive = hear, .send = send_and_log};
    return hs_atomic_open(&s->sent, s->options.bus_out);
}

static void report_malformed(void *ctx, uint32_t line, const char *cause)
{
    struct sim *s = ctx;
    char place[512];
    if (s->malformed_shown++ < MALFORMED_SHOWN) {
        snprintf(place, sizeof place, "%s line %u", s->options.bus_log, line);
        hs_warn(place, "the line is skipped", "%s", cause);
    }
}

/* The log of the second interface, from the same time on as the first. */
static int open_second_log(struct sim *s)
{
    const struct options *o = &s->options;
    if (!o->bus_log_2) {
        return 0;
    }
    s->log_file_2 = hs_input_open(o->bus_log_2, "r");
    if (!s->log_file_2) {
        return hs_error(o->bus_log_2, "landmass-nav makes one from a track", "cannot be opened: %s",
                        strerror(errno));
    }
    drv_can_log_init(&s->log_2, s->log_file_2, NULL, NULL);
    s->can_2 = drv_can_log_port(&s->log_2);
    return drv_can_log_skip(&s->log_2, (uint64_t)llround(o->start_s * 1e6)) == LM_OK
               ? 0
               : hs_error(o->bus_log_2, "begin earlier", "ends before %g s", o->start_s);
}

static int open_bus(struct sim *s)
{
    const struct options *o = &s->options;
    s->socket.fd = -1;
    if (o->bus_log) {
        s->log_file = hs_input_open(o->bus_log, "r");
        if (!s->log_file) {
            return hs_error(o->bus_log, "landmass-nav makes one from a track",
                            "cannot be opened: %s", strerror(errno));
        }
        drv_can_log_init(&s->log, s->log_file, report_malformed, s);
        s->can = drv_can_log_port(&s->log);
        const uint64_t start_us = (uint64_t)llround(o->start_s * 1e6);
        if (drv_can_log_skip(&s->log, start_us) != LM_OK || drv_can_log_is_over(&s->log)) {
            return hs_error("--start", "begin earlier", "%s ends before %g s", o->bus_log,
                            o->start_s);
        }
    } else if (o->can_interface) {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        const uint64_t zero_us = (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
        struct lm_can_filter filters[2 * LM_BUS_FILTERS_MAX];
        uint32_t count = lm_bus_filters(s->bench.unit->bus.profile, filters);
        if (s->bench.board.tables[0].profile) {
            count += lm_bus_filters(s->bench.board.tables[0].profile, filters + count);
        }
        if (drv_can_socket_open(&s->socket, o->can_interface, filters, count, zero_us) != LM_OK) {
            return hs_error(o->can_interface, NULL, "%s", s->socket.error);
        }
        s->can = drv_can_socket_port(&s->socket);
    } else {
        s->can = (struct lm_can){.ctx = NULL, .receive = no_bus};
    }
    return 0;
}

/* Buttons are lit whoever holds them down: a hand in the window or the script. */
static void draw_bezel(struct sim *s)
{
    bezel_draw(&s->bezel, s->bezel_pixels, s->bench.glass, s->bench.unit->keys.down);
}

static int write_picture(struct sim *s, const char *name)
{
    char path[4096];
    const struct lm_display *d = &s->bench.display;
    if (!s->options.png_folder) {
        return hs_error(name, "add --png DIR", "there is no folder for pictures");
    }
    const int length = snprintf(path, sizeof path, "%s/%s.png", s->options.png_folder, name);
    if (length < 0 || (size_t)length >= sizeof path) {
        return hs_error(s->options.png_folder, "use a shorter name", "the path is too long");
    }
    s->pictures_written++;
    if (s->options.has_bezel) {
        draw_bezel(s);
        return hs_png_write_xrgb(path, s->bezel_pixels, s->bezel.width_px, s->bezel.height_px,
                                 s->bezel.width_px);
    }
    return hs_png_write_xrgb(path, s->bench.glass, d->width_px, d->height_px, d->width_px);
}

/* A new picture is on the glass: show it and write it where that was asked for. Returns 0, 1 when
 * the user wants to end, or -1. */
static int serve_picture(struct sim *s)
{
    const struct options *o = &s->options;
    if (s->window) {
        draw_bezel(s);
        window_show(s->window, s->bezel_pixels);
        if (!window_poll(s->window)) {
            return 1;
        }
    }
    const uint32_t number = s->bench.pictures - 1;
    if (o->png_folder && o->every && number % o->every == 0) {
        char name[32];
        snprintf(name, sizeof name, "frame-%05u", number);
        return write_picture(s, name);
    }
    return 0;
}

static void wait_until(const struct timespec *start, uint64_t flight_us)
{
    struct timespec due = *start;
    due.tv_sec += (time_t)(flight_us / 1000000u);
    due.tv_nsec += (long)(flight_us % 1000000u) * 1000;
    if (due.tv_nsec >= 1000000000) {
        due.tv_nsec -= 1000000000;
        due.tv_sec++;
    }
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL) == EINTR) {
    }
}

/* An image of the script comes or goes. */
static bool open_image(void *ctx, int32_t place, const char *path, struct lm_control *control)
{
    struct sim *s = ctx;
    if (bench_mount(&s->bench, place, path, control) != 0) {
        char line[sizeof s->script.path + 32];
        snprintf(line, sizeof line, "%s line %d", s->script.path, s->script.line_taken);
        hs_warn(line, "the flight goes on without it", "%s", s->bench.error);
        return false;
    }
    s->images.path[place - 1] = path;
    s->images_came |= path ? 1u << (place - 1) : 0;
    return true;
}

static void settle_images(struct sim *s)
{
    bench_settle(&s->bench);
    for (uint32_t i = 0; s->images_came != 0; i++, s->images_came >>= 1) {
        if (s->images_came & 1) {
            images_warn(&s->images, &s->bench.unit->map, i);
        }
    }
}

static int step(struct sim *s, uint64_t now_us)
{
    const char *picture;
    while ((picture = script_advance(&s->script, now_us)) != NULL) {
        if (write_picture(s, picture) != 0) {
            return -1;
        }
    }
    if (s->log_file) {
        drv_can_log_set_now(&s->log, now_us);
    }
    if (s->log_file_2) {
        drv_can_log_set_now(&s->log_2, now_us);
    }
    if (has_exercise(s)) {
        drill_advance(&s->drill, now_us, STEP_US);
    }
    const uint32_t before = s->bench.pictures;
    s->now_us = now_us;
    if (s->options.record) {
        record_step(&s->recorder, now_us);
    }
    lm_unit_step(s->bench.unit, now_us);
    settle_images(s);
    track_log_step(&s->tracks, &s->bench.unit->track, now_us);
    return s->bench.pictures != before ? serve_picture(s) : 0;
}

static void put_line(void *ctx, const char *line, size_t bytes)
{
    const struct sim *s = ctx;
    (void)fwrite(line, 1, bytes, s->recording.stream); /* commit tells */
}

/* A log and a script that both tell what node 30 tells would be heard as one sender that
 * contradicts itself: the clock would jump to and fro. */
static int judge_drill(const struct sim *s)
{
    const uint32_t id = s->drill.clash_id;
    return id == 0 ? 0
                   : hs_error(s->options.script,
                              "leave them to one of the two: take `clock` or `break` out of the "
                              "script, or record the log without them",
                              "tells what the bus tells, too: frame %u of node %u came at %.2f s",
                              id, (unsigned)NAV_EXERCISE_NODE, (double)s->drill.clash_us * 1e-6);
}

static int fly(struct sim *s)
{
    const struct options *o = &s->options;
    const uint64_t end_us = o->seconds > 0 ? (uint64_t)llround(o->seconds * 1e6) : UINT64_MAX;
    const bool is_paced = s->window || o->can_interface;
    struct timespec start;
    struct hs_progress progress;
    clock_gettime(CLOCK_MONOTONIC, &start);
    hs_progress_begin(&progress, "flying", end_us);
    int status = 0;
    for (uint64_t now_us = 0; now_us <= end_us && status == 0; now_us += STEP_US) {
        status = step(s, now_us);
        status = status == 0 ? judge_drill(s) : status;
        if (o->seconds <= 0 && s->log_file && drv_can_log_is_over(&s->log)) {
            break;
        }
        if (is_paced) {
            wait_until(&start, now_us);
        }
        hs_progress_update(&progress, now_us);
    }
    hs_progress_end(&progress);
    return status < 0 ? -1 : 0;
}

/* One step of the recording. 2 at its end; otherwise as serve_picture. */
static int step_again(struct sim *s, uint64_t from_us)
{
    struct replay *p = &s->replay;
    const uint32_t before = p->pictures;
    if (!replay_step(p, &s->now_us)) {
        return 2;
    }
    lm_unit_step(s->bench.unit, s->now_us);
    track_log_step(&s->tracks, &s->bench.unit->track, s->now_us);
    s->bench.pictures = p->pictures;
    s->bench.glass = p->shown[p->pictures % REPLAY_BUFFERS];
    return p->pictures != before && s->now_us >= from_us ? serve_picture(s) : 0;
}

static int open_recording(struct sim *s)
{
    return replay_open(&s->replay, s->options.replay) == 0
               ? 0
               : hs_error(s->options.replay, "landmass-sim --record and the panel write recordings",
                          "%s", s->replay.error);
}

/* A unit for the recording that is open. */
static int open_again(struct sim *s, const struct bench_bus *bus)
{
    const struct options *o = &s->options;
    const struct bench_glass glass = {(uint16_t)s->replay.head.width_px,
                                      (uint16_t)s->replay.head.height_px, o->glass};
    const struct bench_scene scene = {.database = o->database,
                                      .further = {o->further[0], o->further[1], o->further[2]},
                                      .radar = o->radar ? &s->radar : NULL,
                                      .replay = &s->replay,
                                      .is_any_replayed = o->is_any_replayed};
    if (bench_open(&s->bench, &scene, &glass, 0, bus, &s->hands.port) != 0) {
        return hs_error(o->replay,
                        "name the images, the tables of the bus and --radar of the recording; "
                        "--replay-anyway shows it with these",
                        "%s", s->bench.error);
    }
    return 0;
}

/* Begin again, for a jump back. */
static int rewind_flight(struct sim *s, const struct bench_bus *bus)
{
    replay_close(&s->replay);
    bench_close(&s->bench);
    s->tracks = (struct track_log){0};
    return open_recording(s) == 0 ? open_again(s, bus) : -1;
}

/* Stand still as long as the user wants, and hold his pace otherwise. Returns 1 when he ends it. */
static int keep_pace(struct sim *s, struct timespec *due, uint64_t step_us)
{
    struct window_player *p = &s->player;
    clock_gettime(CLOCK_MONOTONIC, &s->slept);
    if (due->tv_sec < s->slept.tv_sec - 1) {
        *due = s->slept; /* after a jump or a pause */
    }
    const uint64_t us = (uint64_t)((double)step_us / p->speed) + (uint64_t)due->tv_nsec / 1000;
    due->tv_sec += (time_t)(us / 1000000);
    due->tv_nsec = (long)(us % 1000000) * 1000;
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, due, NULL) == EINTR) {
    }
    while (p->is_paused && p->jump_s == 0) {
        const struct timespec rest = {.tv_nsec = 20000000};
        nanosleep(&rest, NULL);
        if (!window_poll(s->window)) {
            return 1;
        }
    }
    return 0;
}

/* Where to show from, after the user has jumped. */
static int jump(struct sim *s, const struct bench_bus *bus, uint64_t *from_us)
{
    const int64_t to_us = (int64_t)s->now_us + (int64_t)s->player.jump_s * 1000000;
    s->player.jump_s = 0;
    *from_us = to_us > 0 ? (uint64_t)to_us : 0;
    return *from_us < s->now_us ? rewind_flight(s, bus) : 0;
}

static int fly_again(struct sim *s, const struct bench_bus *bus)
{
    const struct options *o = &s->options;
    uint64_t from_us = (uint64_t)llround(o->from_s * 1e6);
    const uint64_t end_us =
        o->seconds > 0 ? from_us + (uint64_t)llround(o->seconds * 1e6) : UINT64_MAX;
    struct timespec due = {0};
    struct hs_progress progress;
    hs_progress_begin(&progress, "replaying", end_us);
    int status = 0;
    while (status == 0) {
        const uint64_t before_us = s->now_us;
        status = step_again(s, from_us);
        if (status == 0 && s->now_us > end_us) {
            break;
        }
        if (status == 0 && s->window && s->now_us >= from_us) {
            status = keep_pace(s, &due, s->now_us - before_us);
        }
        if (status == 0 && s->player.jump_s != 0) {
            status = jump(s, bus, &from_us);
        }
        hs_progress_update(&progress, s->now_us);
    }
    hs_progress_end(&progress);
    return status < 0 ? -1 : 0;
}

/* What the recording proved. A difference is an error: the picture is not the one that was seen. */
static int judge_again(const struct sim *s)
{
    const struct replay *p = &s->replay;
    hs_report_object("replay");
    hs_report_integer("steps", (int64_t)p->steps);
    hs_report_put("departures", p->count.departures);
    hs_report_put("checks", p->count.checks);
    hs_report_put("checks_failed", p->count.checks_failed);
    hs_report_put("reads_differ", p->count.reads_differ);
    hs_report_flag("has_ended", p->has_ended);
    hs_report_flag("is_other_build", replay_is_other_build(p));
    hs_report_put("ceased", p->ceased);
    hs_report_close();
    if (!s->options.is_quiet) {
        printf("replay: %llu steps, %.1f s; checks of the glass %u, failed %u; departures %u%s\n",
               (unsigned long long)p->steps, (double)p->now_us * 1e-6, p->count.checks,
               p->count.checks_failed, p->count.departures,
               p->has_ended ? "" : "; the recording has no end");
    }
    if (p->ceased != 0) {
        hs_warn(s->options.replay, "the flight went on, and is not in it",
                "the recorder gave up here: %s", record_reason_words(p->ceased));
    }
    if (p->error[0] != '\0') {
        return hs_error(s->options.replay, "what stands before it was shown", "%s", p->error);
    }
    if (p->count.checks_failed + p->count.reads_differ + p->count.departures != 0 &&
        !s->options.is_any_replayed) {
        return hs_error(s->options.replay, "was the image changed, or the recording edited?",
                        "the flight was not the one recorded: from %.6f s on",
                        (double)p->departed_us * 1e-6);
    }
    return 0;
}

static void report_live(const struct lm_unit *u)
{
    const struct lm_live_bus *l = &u->live;
    hs_report_object("live");
    hs_report_put("sets", l->count.sets);
    hs_report_put("torn", l->count.torn);
    hs_report_put("refused", l->count.refused);
    hs_report_put("frames_of_a_second_sender", l->count.rivals);
    hs_report_put("removed", l->count.removed);
    hs_report_put("aged_out", l->count.aged);
    hs_report_put("there", l->live.count);
    hs_report_put("left_out", u->picture.targets_left_out);
    hs_report_close();
}

static void report_bus(const struct sim *s)
{
    static const struct {
        enum lm_bus_outcome outcome;
        const char *key;
    } outcomes[] = {{LM_BUS_VALUE, "values"},
                    {LM_BUS_UNUSED, "not_used"},
                    {LM_BUS_BAD_LENGTH, "refused_length"},
                    {LM_BUS_BAD_NODE, "refused_node"},
                    {LM_BUS_BAD_TYPE, "refused_type"},
                    {LM_BUS_NOT_A_NUMBER, "refused_not_a_number"},
                    {LM_BUS_OUT_OF_RANGE, "refused_range"}};
    const struct lm_unit *u = s->bench.unit;
    hs_report_object("bus");
    hs_report_put("profile", u->bus.profile->name);
    hs_report_put("frames", u->count.bus_frames);
    hs_report_put("malformed", s->log_file ? s->log.count.malformed : s->socket.count.malformed);
    hs_report_put("errors", u->count.bus_errors);
    for (size_t i = 0; i < sizeof outcomes / sizeof outcomes[0]; i++) {
        hs_report_put(outcomes[i].key, u->bus.count.outcome[outcomes[i].outcome]);
    }
    hs_report_close();
    const struct lm_canas_control *c = &u->control_bus;
    hs_report_object("controls");
    hs_report_put("told", c->count.told);
    hs_report_put("lost", c->count.lost);
    hs_report_put("obeyed", c->count.heard);
    hs_report_put("refused_frames", c->count.refused);
    hs_report_put("torn", c->count.torn);
    hs_report_put("bad", c->count.bad);
    const struct lm_sender_counts senders = lm_sender_counts(u);
    hs_report_put("senders_stuck", senders.stuck);
    hs_report_put("senders_rival", senders.rivals);
    hs_report_put("senders_disagree", senders.disagreements);
    hs_report_put("node_not_on_the_list", senders.refused);
    hs_report_close();
    const struct lm_weather_bus *w = &u->weather.bus;
    hs_report_object("weather");
    hs_report_put("sets", w->count.sets);
    hs_report_put("torn", w->count.torn);
    hs_report_put("out_of_range", w->count.refused);
    hs_report_put("frames_numbered_above_3", w->count.numbers);
    hs_report_put("frames_of_a_second_sender", w->count.rivals);
    hs_report_close();
    report_live(u);
    track_log_report(&s->tracks);
}

static uint32_t signatures_held(const struct lm_unit *u)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < u->map.target_set.signature_count; i++) {
        count += u->map.signatures[i].aspects != 0;
    }
    return count;
}

static void report_map(const struct lm_unit *u)
{
    const struct lm_tile_cache *t = &u->map.tiles;
    hs_report_object("tiles");
    hs_report_put("read", t->count.tiles_read);
    hs_report_put("bytes_read", t->count.bytes_read);
    hs_report_put("evicted", t->count.evicted);
    hs_report_put("hits", lm_tile_cache_hits(t));
    hs_report_put("misses", t->count.misses);
    hs_report_put("substituted", t->count.substituted);
    hs_report_put("off_map", t->count.off_map);
    hs_report_close();
    hs_report_object("faults");
    hs_report_put("flash_reads_failed", t->count.io_errors);
    hs_report_put("records_corrupt", lm_unit_map_corrupt_records(&u->map));
    hs_report_put("requests_dropped", t->count.requests_dropped);
    hs_report_put("display_errors", u->count.display_errors);
    hs_report_close();
    hs_report_object("targets");
    hs_report_put("held", u->map.target_set.count);
    hs_report_put("lost", u->map.count.targets_lost);
    hs_report_put("signatures_held", signatures_held(u));
    hs_report_put("signatures_lost", u->map.count.signatures_lost);
    hs_report_put("chips_read", u->map.chips.count.read);
    hs_report_put("chips_corrupt", u->map.chips.count.corrupt);
    hs_report_put("chips_left_out", u->map.chips.count.left_out);
    hs_report_put("chip_cells_left_out", u->map.chips.count.cells_left_out);
    hs_report_put("detail_left_out", u->picture.sar.detail.left_out);
    hs_report_close();
}

static void report_flight(const struct sim *s)
{
    const struct lm_unit *u = s->bench.unit;
    hs_report_put("frames", u->count.frames);
    hs_report_put("lines", u->count.lines);
    hs_report_put("lines_dropped", u->count.lines_dropped);
    hs_report_put("pictures_written", s->pictures_written);
    hs_report_put("position_jumps", u->nav.position_jumps);
    hs_report_put("commands_refused", u->count.commands_refused);
    report_bus(s);
    images_report(&s->images, &u->map, s->bench.board.images);
    hs_report_flag("map_is_usable", u->map.is_usable);
    if (u->map.is_usable) {
        report_map(u);
    }
}

static void print_live(const struct lm_unit *u)
{
    const struct lm_live_bus *l = &u->live;
    if (l->count.sets + l->count.torn + l->count.refused + l->count.rivals != 0) {
        printf(
            "     live targets: %u sets taken, %u torn, %u out of range, %u frames of a second "
            "sender; %u removed, %u aged out, %u there at the end\n",
            l->count.sets, l->count.torn, l->count.refused, l->count.rivals, l->count.removed,
            l->count.aged, l->live.count);
    }
    if (u->picture.targets_left_out != 0) {
        printf("     targets: %u times one was left out of a beam or patch that had 32\n",
               u->picture.targets_left_out);
    }
}

static void print_targets(const struct lm_unit *u)
{
    printf("targets: %u held, %u of the images not; signatures: %u held, %u not\n",
           u->map.target_set.count, u->map.count.targets_lost, signatures_held(u),
           u->map.count.signatures_lost);
    printf("chips: %u read, %u damaged, %u without room, %u cells of lines left out\n",
           u->map.chips.count.read, u->map.chips.count.corrupt, u->map.chips.count.left_out,
           u->map.chips.count.cells_left_out);
    printf("detail: %u items without room\n", u->picture.sar.detail.left_out);
}

static void print_summary(const struct sim *s)
{
    const struct lm_unit *u = s->bench.unit;
    printf("frames %u, lines %u (%u dropped), pictures written %u\n", u->count.frames,
           u->count.lines, u->count.lines_dropped, s->pictures_written);
    printf("bus: %s: %u frames, %u malformed, %u errors; position jumps %u; commands refused %u\n",
           u->bus.profile->name, u->count.bus_frames,
           s->log_file ? s->log.count.malformed : s->socket.count.malformed, u->count.bus_errors,
           u->nav.position_jumps, u->count.commands_refused);
    const struct lm_bus *bus = &u->bus;
    printf(
        "     %u values, %u frames of other use; refused: %u length, %u node, %u type, %u no "
        "number, %u range\n",
        bus->count.outcome[LM_BUS_VALUE], bus->count.outcome[LM_BUS_UNUSED],
        bus->count.outcome[LM_BUS_BAD_LENGTH], bus->count.outcome[LM_BUS_BAD_NODE],
        bus->count.outcome[LM_BUS_BAD_TYPE], bus->count.outcome[LM_BUS_NOT_A_NUMBER],
        bus->count.outcome[LM_BUS_OUT_OF_RANGE]);
    const struct lm_sender_counts senders = lm_sender_counts(u);
    if (senders.sum + senders.refused != 0) {
        printf("     senders: %u frames stuck, %u of rivals, %u disagree, %u not on the list\n",
               senders.stuck, senders.rivals, senders.disagreements, senders.refused);
    }
    const struct lm_canas_report *r = &u->report;
    if (r->node != 0) {
        printf("     told: %u frames; %u sets cut short, %u frames lost\n", r->count.sent,
               r->count.cut, r->count.lost);
    }
    const struct lm_canas_control *c = &u->control_bus;
    if (c->count.told + c->count.lost + c->count.heard + c->count.refused + c->count.bad != 0) {
        printf("     controls: %u told, %u lost, %u obeyed; %u frames refused, %u torn, %u bad\n",
               c->count.told, c->count.lost, c->count.heard, c->count.refused, c->count.torn,
               c->count.bad);
    }
    const struct lm_weather_bus *w = &u->weather.bus;
    if (w->count.sets + w->count.torn + w->count.refused + w->count.numbers != 0) {
        printf(
            "     weather: %u sets taken, %u torn, %u out of range, %u frames of numbers above 3, "
            "%u of a second sender\n",
            w->count.sets, w->count.torn, w->count.refused, w->count.numbers, w->count.rivals);
    }
    print_live(u);
    track_log_print(&s->tracks);
    if (!u->map.is_usable) {
        printf("database: not usable, nothing was drawn\n");
        return;
    }
    if (u->map.target_set.count + u->map.count.targets_lost != 0) {
        print_targets(u);
    }
    const struct lm_tile_cache *t = &u->map.tiles;
    const double looked = (double)lm_tile_cache_hits(t) + t->count.misses;
    printf(
        "tiles: %u read (%.1f MB), %u evicted; %.2f %% of look-ups hit, %u answered by a coarser "
        "tile, %u off the map\n",
        t->count.tiles_read, (double)t->count.bytes_read / 1e6, t->count.evicted,
        looked > 0 ? 100 * lm_tile_cache_hits(t) / looked : 0, t->count.substituted,
        t->count.off_map);
    printf(
        "faults: %u flash reads failed, %u records corrupt, %u requests dropped, %u display "
        "errors\n",
        t->count.io_errors, lm_unit_map_corrupt_records(&u->map), t->count.requests_dropped,
        u->count.display_errors);
}

static int open_bezel(struct sim *s)
{
    const struct options *o = &s->options;
    s->bezel = bezel_around(o->width_px, o->height_px);
    if (!o->has_window && !o->has_bezel) {
        return 0;
    }
    s->bezel_pixels = malloc(sizeof *s->bezel_pixels * s->bezel.width_px * s->bezel.height_px);
    if (!s->bezel_pixels) {
        return hs_error("bezel", NULL, "out of memory");
    }
    if (o->has_window) {
        s->window = window_open(&s->bezel, &s->hands);
    }
    return 0;
}

/* Hear `profile` on that interface besides. Two tables of one interface must not claim one
 * identifier. */
static int hear_beside(struct bench_bus *bus, const struct lm_bus_profile *first,
                       const struct lm_bus_profile *profile, uint8_t interface)
{
    uint32_t id;
    if (first && lm_bus_profiles_clash(first, profile, &id)) {
        return hs_error(profile->name, "hear them on two interfaces", "and %s both take frame %X",
                        first->name, id);
    }
    struct lm_board_table *table = bus->tables;
    while (table->profile) {
        table++; /* at most three are ever added */
    }
    *table = (struct lm_board_table){profile, interface};
    return 0;
}

/* The tables of both interfaces. */
static int choose_tables(struct sim *s, struct bench_bus *bus)
{
    const struct options *o = &s->options;
    bus->profile = o->profile || !o->table ? o->profile : &s->table.profile;
    if (o->profile && o->table && hear_beside(bus, o->profile, &s->table.profile, 0) != 0) {
        return -1;
    }
    const bool is_recorded = (s->replay.head.switches & RECORD_HAS_SECOND) != 0;
    if (!o->bus_log_2 && !is_recorded) {
        return 0;
    }
    const struct lm_bus_profile *second =
        o->profile_2 || o->table_2 ? o->profile_2 : &lm_bus_canas17;
    bus->can_2 = &s->can_2;
    if (second && hear_beside(bus, NULL, second, 1) != 0) {
        return -1;
    }
    return o->table_2 ? hear_beside(bus, second, &s->table_2.profile, 1) : 0;
}

static void warn_of_images(struct sim *s)
{
    const struct options *o = &s->options;
    s->images = (struct images){{o->database, o->further[0], o->further[1], o->further[2]}};
    for (uint32_t i = 0; i < LM_IMAGES_MAX; i++) {
        images_warn(&s->images, &s->bench.unit->map, i);
    }
}

/* Another build may show the same: the checks tell. */
static void warn_of_build(const struct sim *s)
{
    if (replay_is_other_build(&s->replay)) {
        hs_warn(s->options.replay, "the checks tell whether the pictures are the same",
                "was made by build %s of the firmware, and this is %s", s->replay.head.build,
                record_build);
    }
}

/* Show a recording: its bus, its controls and its settings take the place of those named. */
static int run_again(struct sim *s, const struct bench_bus *bus)
{
    s->socket.fd = -1;
    s->can = (struct lm_can){.receive = no_bus};
    s->player = (struct window_player){.speed = s->options.speed};
    if (open_again(s, bus) != 0) {
        return -1;
    }
    warn_of_images(s);
    warn_of_build(s);
    s->options.width_px = (uint16_t)s->replay.head.width_px;
    s->options.height_px = (uint16_t)s->replay.head.height_px;
    int status = open_bezel(s);
    if (s->window) {
        window_watch(s->window, &s->player);
    }
    status = status == 0 ? fly_again(s, bus) : status;
    return status == 0 ? judge_again(s) : status;
}

/* Fly: bus, script and window as they were named. */
static int run_flight(struct sim *s, const struct bench_bus *bus)
{
    const struct options *o = &s->options;
    const struct record_sink sink = {s, put_line};
    const struct bench_glass glass = {o->width_px, o->height_px, o->glass};
    const struct bench_scene scene = {.database = o->database,
                                      .further = {o->further[0], o->further[1], o->further[2]},
                                      .radar = o->radar ? &s->radar : NULL,
                                      .recorder = o->record ? &s->recorder : NULL,
                                      .sink = &sink};
    if (o->record && hs_atomic_open(&s->recording, o->record) != 0) {
        return -1;
    }
    if (bench_open(&s->bench, &scene, &glass, o->seed, bus, &s->hands.port) != 0) {
        return hs_error(o->database, "landmass-db build makes a database", "%s", s->bench.error);
    }
    warn_of_images(s);
    /* What an interface lets through is what the unit hears, which the database may say. */
    if (open_bus(s) != 0 || open_second_log(s) != 0 || open_sent_log(s) != 0 ||
        script_read(&s->script, o->script, s->bench.unit->map.radar) != 0 || open_drill(s) != 0 ||
        open_bezel(s) != 0) {
        return -1;
    }
    s->script.images = (struct script_images){s, open_image};
    int status = fly(s);
    if (status == 0 && o->bus_out) {
        status = hs_atomic_commit(&s->sent);
    }
    if (status == 0 && o->record) {
        record_end(&s->recorder);
        status = hs_atomic_commit(&s->recording);
    }
    return status;
}

static int run(struct sim *s)
{
    const struct options *o = &s->options;
    if (o->png_folder && mkdir(o->png_folder, 0777) != 0 && errno != EEXIST) {
        return hs_error(o->png_folder, "check the folder above it", "cannot be made: %s",
                        strerror(errno));
    }
    if ((o->radar && radar_text_read(&s->radar, o->radar) != 0) ||
        (o->table && bus_table_load(&s->table, o->table) != 0) ||
        (o->table_2 && bus_table_load(&s->table_2, o->table_2) != 0)) {
        return -1;
    }
    hands_init(&s->hands, &s->script.port);
    struct bench_bus bus = {.can = &s->can,
                            .nodes = o->has_nodes ? o->nodes : NULL,
                            .node = o->node,
                            .partner = o->partner,
                            .is_heading_magnetic = o->heading == 1,
                            .tells_reports = o->tells_reports,
                            .obeys_controls = o->obeys_controls};
    if ((o->replay && open_recording(s) != 0) || choose_tables(s, &bus) != 0) {
        return -1;
    }
    const int status = o->replay ? run_again(s, &bus) : run_flight(s, &bus);
    if (status == 0) {
        report_flight(s);
    }
    if (status == 0 && !o->is_quiet) {
        print_summary(s);
    }
    window_close(s->window);
    if (s->bench.unit) {
        bench_close(&s->bench);
    }
    replay_close(&s->replay);
    return status;
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-sim");
    struct sim *s = calloc(1, sizeof *s);
    if (!s) {
        hs_error("start", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    int exit_code;
    if (options_read(&s->options, argc, argv, &exit_code)) {
        exit_code = run(s) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    script_free(&s->script);
    free(s->bezel_pixels);
    drv_can_socket_close(&s->socket);
    hs_atomic_abort(&s->sent);
    hs_atomic_abort(&s->recording);
    if (s->log_file) {
        fclose(s->log_file);
    }
    if (s->log_file_2) {
        fclose(s->log_file_2);
    }
    free(s);
    return hs_report_end(exit_code);
}
