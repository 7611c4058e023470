/* Flights of random events: recorded by one build of the firmware, shown again by another.
 *
 *   flights image FILE                       the country that is flown over
 *   flights record IMAGE FOLDER FIRST COUNT [SECONDS]
 *                                            fly seeds FIRST.., into FOLDER/SEED.log and SEED.sums
 *   flights replay IMAGE FOLDER FIRST COUNT  fly the logs again; every picture's checksum must be
 *                                            that of SEED.sums
 *   flights lose   IMAGE FOLDER FIRST COUNT  the same with one step of each flight, in which
 *                                            something happened, left out: it must be seen
 *
 * The bus has gaps, jumps, storms and an outage; reads of the flash are late or fail, also at the
 * start; steps come when they come; the display is busy, fails, and has buffers of any age; keys,
 * knobs and commands come at any time. A partner asks for a swap of the pages and answers one, and
 * frames of it are lost; some flights begin with the settings that another left, or with noise. */
#include "bus_frames.h"
#include "fx/crc32c.h"
#include "hs/rng.h"
#include "lm/canas.h"
#include "lm/swap.h"
#include "memory_flash.h"
#include "record.h"
#include "replay.h"
#include "tiny_country.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOST_STEP = 1500 };
enum { NODE = 20, PARTNER = 21, SAYINGS = 64 };
enum { FLIGHT_S = 6, SIDE_PX = 288, TILES = 130, POLLS = 60, BUFFERS = LM_AGES + 1 };

struct flight {
    struct hs_rng rng;
    struct memory_flash flash;
    struct lm_flash port;
    struct lm_can can, can_2;
    struct lm_controls controls;
    struct lm_display display;
    struct lm_board board;
    struct lm_unit unit;
    uint64_t pool[TILES * sizeof(struct lm_tile) / 8];
    uint8_t plane[SIDE_PX * SIDE_PX];
    uint32_t buffer[BUFFERS][SIDE_PX * SIDE_PX];
    uint64_t now_us, end_us;
    struct {
        uint64_t sent_us, silent_until_us, down_until_us;
        int next;
        uint8_t code;
        double jump_deg, heading_deg;
    } bus;
    struct { /* the partner: it knows the settings that the unit told last */
        struct lm_can_frame saying[SAYINGS];
        uint32_t head, tail;
        uint8_t known[LM_SETTINGS_BYTES];
        uint16_t missing;
        uint8_t code;
    } partner;
    uint32_t pictures, ages, held_button;
    bool is_display_busy, is_voice_busy;
    FILE *log, *sums;
};

static int write_image(const char *path)
{
    const struct tiny_spec spec = tiny_country(10);
    struct tiny_image image;
    if (tiny_image_build(&image, &spec) != 0) {
        return -1;
    }
    const int status = tiny_image_write(&image, path);
    tiny_image_free(&image);
    return status;
}

/* ---- a bad day ---- */

static bool happens(struct flight *f, uint32_t once_in)
{
    return hs_rng_below(&f->rng, once_in) == 0;
}

static int start_read(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct flight *f = ctx;
    f->flash.busy_polls = happens(f, 3) ? hs_rng_below(&f->rng, happens(f, 20) ? 90 : 6) : 0;
    f->flash.fail_every = happens(f, 25) ? 1 : 0;
    if (happens(f, 200)) {
        return LM_ERR_IO;
    }
    return f->flash.port.read_start(f->flash.port.ctx, offset, destination, length);
}

static int poll_read(void *ctx)
{
    const struct flight *f = ctx;
    return f->flash.port.read_poll(f->flash.port.ctx);
}

static struct lm_can_frame nav_frame(struct flight *f, int number)
{
    const double t = (double)f->now_us / 1e6;
    const struct {
        uint32_t id;
        double value;
    } items[] = {{1036, 45.96 + 150 * t / 111132 + f->bus.jump_deg},
                 {1037, 11.0},
                 {1038, 2000},
                 {1133, f->bus.heading_deg},
                 {321, f->bus.heading_deg},
                 {1039, 150},
                 {1040, f->bus.heading_deg},
                 {311, 2},
                 {312, 0},
                 {305, 3},
                 {1000, 46.02},
                 {1001, 11.02}};
    return bus_frame(items[number].id, LM_CANAS_FLOAT, f->bus.code,
                     bus_float_bits(items[number].value), f->now_us - hs_rng_below(&f->rng, 400));
}

enum { NAV_FRAMES = 12 };

/* Anything: weather, controls, requests, noise. */
static struct lm_can_frame other_frame(struct flight *f)
{
    static const uint32_t ids[] = {1800, 1801, 1802, 1803, 1804, 1805, 1806, 1807, 1808, 1809,
                                   128,  1530, 1531, 1532, 1533, 1537, 1539, 1540, 1541, 1};
    struct lm_can_frame frame =
        bus_frame(ids[hs_rng_below(&f->rng, sizeof ids / sizeof *ids)], LM_CANAS_FLOAT, f->bus.code,
                  bus_float_bits(hs_rng_below(&f->rng, 60)), f->now_us);
    if (frame.id >= 1530 && frame.id < 1550) {
        frame.data[1] = LM_CANAS_UCHAR;
        frame.data[2] = (uint8_t)hs_rng_below(&f->rng, 2);
        frame.data[4] = (uint8_t)hs_rng_below(&f->rng, 30);
        frame.length = 5;
    }
    frame.data[0] = happens(f, 3) ? 2 : frame.data[0];
    frame.is_error = happens(f, 30);
    frame.is_remote = !frame.is_error && happens(f, 30);
    frame.is_extended = !frame.is_error && happens(f, 30);
    return frame;
}

/* ---- the partner ---- */

static void say(struct flight *f, uint32_t service, uint8_t code, const uint8_t data[4])
{
    if (f->partner.head - f->partner.tail < SAYINGS && !happens(f, 100)) {
        f->partner.saying[f->partner.head++ % SAYINGS] =
            (struct lm_can_frame){.id = LM_SWAP_ID,
                                  .length = 8,
                                  .data = {PARTNER, LM_CANAS_UCHAR4, (uint8_t)service, code,
                                           data[0], data[1], data[2], data[3]}};
    }
}

static void say_act(struct flight *f, uint32_t act, uint8_t code)
{
    say(f, act, code, (const uint8_t[4]){NODE});
}

static void say_settings(struct flight *f, uint32_t first_part, uint8_t code)
{
    for (uint32_t part = 0; part < LM_SWAP_PARTS; part++) {
        say(f, first_part + part, code, f->partner.known + 4 * part);
    }
}

/* What the unit says to it. */
static void partner_hears(struct flight *f, const struct lm_can_frame *frame)
{
    const uint8_t service = frame->data[2], code = frame->data[3];
    if (frame->id != LM_SWAP_ID || f->board.bus_partner == 0) {
        return;
    }
    if (service < LM_SWAP_ASK) {
        memcpy(f->partner.known + (size_t)4 * (service % LM_SWAP_PARTS), frame->data + 4, 4);
        f->partner.missing &= (uint16_t) ~(1u << service % LM_SWAP_PARTS);
    } else if (service == LM_SWAP_ASK) {
        say_settings(f, LM_SWAP_OF_ANSWER, code);
        say_act(f, LM_SWAP_ANSWER, code);
    } else if (service == LM_SWAP_ANSWER) {
        say_act(f, LM_SWAP_TAKE, code);
    } else if (service == LM_SWAP_TAKE) {
        say_act(f, LM_SWAP_TAKEN, code);
    }
}

/* It asks with settings that are sound: those that it knows. */
static void partner_asks(struct flight *f)
{
    if (f->board.bus_partner != 0 && f->partner.missing == 0 &&
        f->partner.head == f->partner.tail) {
        say_settings(f, 0, ++f->partner.code);
        say_act(f, LM_SWAP_ASK, f->partner.code);
    }
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct flight *f = ctx;
    if (f->now_us < f->bus.down_until_us) {
        return LM_ERR_IO;
    }
    if (f->partner.tail != f->partner.head) {
        *frame = f->partner.saying[f->partner.tail++ % SAYINGS];
        frame->time_us = f->now_us;
        return 1;
    }
    if (happens(f, 40)) {
        *frame = other_frame(f);
        return 1;
    }
    if (f->bus.next == 0) {
        if (f->now_us < f->bus.sent_us || f->now_us < f->bus.silent_until_us) {
            return 0;
        }
        f->bus.sent_us = f->now_us + 50000;
        f->bus.code++;
    }
    *frame = nav_frame(f, f->bus.next);
    f->bus.next = (f->bus.next + 1) % NAV_FRAMES;
    return 1;
}

/* The second interface: the same frames at other times, which are late by another sender's clock.
 */
static int receive_2(void *ctx, struct lm_can_frame *frame)
{
    struct flight *f = ctx;
    if (happens(f, 300)) {
        return LM_ERR_IO;
    }
    if (!happens(f, 8)) {
        return 0;
    }
    *frame = happens(f, 4) ? other_frame(f) : nav_frame(f, (int)hs_rng_below(&f->rng, NAV_FRAMES));
    frame->data[0] = 2;
    return 1;
}

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct flight *f = ctx;
    if (happens(f, 10)) {
        f->is_voice_busy = !f->is_voice_busy && happens(f, 3);
    }
    const int status = f->is_voice_busy ? LM_BUSY : happens(f, 50) ? LM_ERR_IO : LM_OK;
    if (status == LM_OK) {
        partner_hears(f, frame);
    }
    return status;
}

static struct lm_position place(struct flight *f)
{
    return (struct lm_position){FX_BAM_DEG(46) + hs_rng_below(&f->rng, 1 << 19),
                                FX_BAM_DEG(11) + hs_rng_below(&f->rng, 1 << 19)};
}

static struct lm_control environment(struct flight *f)
{
    struct lm_control c = {.kind = LM_CONTROL_ENVIRONMENT};
    c.environment.rain_count = (uint8_t)hs_rng_below(&f->rng, 3);
    for (uint32_t i = 0; i < LM_RAINS_MAX; i++) {
        c.environment.rain[i] = (struct lm_rain){place(f), 3000, 40};
    }
    c.environment.jammer_count = (uint8_t)hs_rng_below(&f->rng, 2);
    c.environment.jammer[0] = (struct lm_jammer){place(f), 20 * 256};
    c.environment.sea_state = (uint8_t)hs_rng_below(&f->rng, 10);
    return c;
}

static struct lm_control any_control(struct flight *f)
{
    const int32_t value = (int32_t)hs_rng_below(&f->rng, 2001) - 1000;
    switch (hs_rng_below(&f->rng, 16)) {
    case 0:
        return (struct lm_control){.kind = LM_CONTROL_SECTOR,
                                   .sector = {value & 3, value >> 2 & 3}};
    case 1:
        return (struct lm_control){
            .kind = LM_CONTROL_SAR,
            .sar = {.centre = place(f), .cell_mm = 5000, .is_from_ownship = true}};
    case 2:
        return (struct lm_control){.kind = LM_CONTROL_SAR,
                                   .sar = {.centre = place(f),
                                           .cell_mm = 3000,
                                           .look_azimuth = (fx_bam_t)value << 20,
                                           .range_m = 20000,
                                           .height_m_q6 = 64 * 4000}};
    case 3:
        return environment(f);
    case 4:
        return (struct lm_control){.kind = LM_CONTROL_STEERPOINT,
                                   .steerpoint = {value & 1, place(f)}};
    case 5:
        return (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = place(f)};
    case 6:
        return (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 10 << (value & 3)};
    case 7:
        return (struct lm_control){.kind = LM_CONTROL_AZIMUTH, .azimuth_index = value & 3};
    case 8:
        return (struct lm_control){.kind = LM_CONTROL_GAIN, .gain_db = value / 30};
    case 9:
        return (struct lm_control){.kind = LM_CONTROL_FREEZE, .is_frozen = happens(f, 3)};
    case 10:
        return lm_control_knob(value);
    case 11:
        return lm_control_slew(value, -value);
    case 12:
        return lm_control_designate();
    case 13:
        return (struct lm_control){.kind = LM_CONTROL_TRACK};
    case 14:
        return (struct lm_control){.kind = LM_CONTROL_RANGING};
    default:
        return happens(f, 2) ? lm_control_drop()
                             : (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 10};
    }
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct flight *f = ctx;
    if (!happens(f, 60)) {
        return 0;
    }
    if (f->held_button != 0) {
        *control = lm_control_button(false, (int32_t)f->held_button);
        f->held_button = 0;
    } else if (happens(f, 2)) {
        f->held_button = 1 + hs_rng_below(&f->rng, LM_BUTTONS);
        *control = lm_control_button(true, (int32_t)f->held_button);
    } else {
        *control = any_control(f);
    }
    return 1;
}

static int acquire(void *ctx, struct lm_surface *surface)
{
    struct flight *f = ctx;
    if (happens(f, 20)) {
        f->is_display_busy = !f->is_display_busy && happens(f, 3);
    }
    if (f->is_display_busy) {
        return LM_BUSY;
    }
    if (happens(f, 60)) {
        return LM_ERR_IO;
    }
    if (happens(f, 30)) {
        f->ages = hs_rng_below(&f->rng, LM_AGES + 1);
    }
    const uint32_t age = f->ages <= f->pictures ? f->ages : 0;
    uint32_t *pixels = f->buffer[0];
    if (age > 0) {
        memcpy(pixels, f->buffer[1 + (f->pictures - (age - 1)) % LM_AGES], sizeof f->buffer[0]);
    }
    *surface = (struct lm_surface){.pixels = pixels,
                                   .stride_px = SIDE_PX,
                                   .width_px = SIDE_PX,
                                   .height_px = SIDE_PX,
                                   .age = (uint8_t)age};
    return LM_OK;
}

static uint32_t sum_of(const uint32_t *pixels)
{
    return fx_crc32c(0, pixels, sizeof(uint32_t) * SIDE_PX * SIDE_PX);
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct flight *f = ctx;
    (void)changed;
    f->pictures++;
    memcpy(f->buffer[1 + f->pictures % LM_AGES], f->buffer[0], sizeof f->buffer[0]);
    fprintf(f->sums, "%08" PRIx32 "\n", sum_of(f->buffer[0]));
    return happens(f, 80) ? LM_ERR_IO : LM_OK;
}

static void upset_bus(struct flight *f)
{
    if (happens(f, 1500)) {
        f->bus.silent_until_us = f->now_us + hs_rng_below(&f->rng, 3000000);
    }
    if (happens(f, 3000)) {
        f->bus.down_until_us = f->now_us + hs_rng_below(&f->rng, 1500000);
    }
    if (happens(f, 2500)) {
        f->bus.jump_deg += 0.05;
    }
    f->bus.heading_deg += happens(f, 100) ? 3 : 0;
    if (happens(f, 600)) {
        partner_asks(f);
    }
}

static uint64_t pause_us(struct flight *f)
{
    return happens(f, 400) ? 1000 * (uint64_t)hs_rng_below(&f->rng, 120)
           : happens(f, 2) ? 2000
                           : 500 + hs_rng_below(&f->rng, 3500);
}

/* ---- boards ---- */

static void open_board(struct flight *f, const uint8_t *image, size_t size)
{
    memory_flash_open(&f->flash, image, size);
    f->port = (struct lm_flash){
        .ctx = f, .size_bytes = size, .read_start = start_read, .read_poll = poll_read};
    f->can = (struct lm_can){.ctx = f, .receive = receive, .send = send_frame};
    f->can_2 = (struct lm_can){.ctx = f, .receive = receive_2};
    f->controls = (struct lm_controls){.ctx = f, .next = next_control};
    f->display = (struct lm_display){f, SIDE_PX, SIDE_PX, acquire, present};
    f->board = (struct lm_board){.radar = &lm_radar_default,
                                 .flash = &f->port,
                                 .can = &f->can,
                                 .bus_node = NODE,
                                 .tells_reports = true,
                                 .obeys_controls = true,
                                 .controls = &f->controls,
                                 .display = &f->display,
                                 .tile_pool = f->pool,
                                 .tile_pool_bytes = sizeof f->pool,
                                 .plane = f->plane,
                                 .glass_step_px = LM_GLASS_STEP_PX,
                                 .flash_poll_limit = POLLS};
}

/* Every third flight has a second interface, and every fourth hears some nodes only. Replays must
 * know it from the table of the one and the recording of the other. */
static void choose_buses(struct flight *f, uint64_t seed)
{
    if (seed % 3 == 0) {
        f->board.can_2 = &f->can_2;
        f->board.tables[0] = (struct lm_board_table){&lm_bus_xcsoar, 1};
    }
    if (seed % 4 == 0) {
        static const uint8_t nodes[LM_BUS_NODE_BYTES] = {0, 1 << 1, 1 << PARTNER % 8}; /* and 9 */
        f->board.bus_nodes = nodes;
    }
}

/* Flights with a partner, and those that begin as another ended, or with noise in its place.
 * Replays know it from the recording alone. */
static void choose_starts(struct flight *f, uint64_t seed, struct lm_settings *kept)
{
    f->partner.missing = 0xffff;
    if (seed % 5 < 3) {
        f->board.bus_partner = PARTNER;
    }
    if (seed % 7 == 3) {
        for (size_t i = 0; i < sizeof *kept; i++) {
            ((uint8_t *)kept)[i] = (uint8_t)hs_rng_below(&f->rng, 256);
        }
    }
    if (seed % 2 == 0 || seed % 7 == 3) {
        f->board.settings = kept;
        f->board.restart = "HUNG STEP";
    }
}

static void put_line(void *ctx, const char *line, size_t bytes)
{
    const struct flight *f = ctx;
    (void)fwrite(line, 1, bytes, f->log);
}

static FILE *open_file(const char *folder, uint64_t seed, const char *kind, const char *mode)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%" PRIu64 ".%s", folder, seed, kind);
    return fopen(path, mode);
}

static uint32_t swaps; /* of all flights recorded */

/* The head names the flash before it begins to fail. */
static bool record_flight(struct flight *f, const char *folder, uint64_t seed)
{
    static struct recorder recorder;
    static struct lm_settings kept; /* of the flight before */
    const struct record_sink sink = {f, put_line};
    hs_rng_seed(&f->rng, seed);
    f->board.noise_seed = (uint32_t)seed;
    choose_buses(f, seed);
    choose_starts(f, seed, &kept);
    f->log = open_file(folder, seed, "log", "w");
    f->sums = open_file(folder, seed, "sums", "w");
    if (!f->log || !f->sums) {
        fprintf(stderr, "flights: %s: cannot be written\n", folder);
        return false;
    }
    f->board.flash = &f->flash.port;
    record_begin(&recorder, &sink, &f->board, 1700000000000000, 7);
    recorder.flash = &f->port;
    bool is_whole = lm_unit_init(&f->unit, &f->board) == LM_OK;
    for (; is_whole && f->now_us < f->end_us; f->now_us += pause_us(f)) {
        upset_bus(f);
        record_step(&recorder, f->now_us);
        lm_unit_step(&f->unit, f->now_us);
    }
    record_end(&recorder);
    lm_settings_give(&f->unit, &kept);
    swaps += f->unit.count.swaps;
    is_whole = fclose(f->log) == 0 && fclose(f->sums) == 0 && is_whole;
    return is_whole;
}

/* A step in which something happened: its line of steps was ended by an event, not by being full.
 */
static bool is_eventful(const struct replay *p)
{
    return p->ticks.at == p->ticks.count && p->ticks.count < 5;
}

/* Pictures that are not those of the recording; -1 if the log cannot be flown. */
static long fly_again(struct flight *f, struct replay *p, FILE *sums, bool is_losing)
{
    long wrong = 0;
    uint64_t now_us;
    char line[32];
    if (lm_unit_init(&f->unit, &f->board) != LM_OK) {
        return -1;
    }
    while (replay_step(p, &now_us)) {
        const uint32_t before = p->pictures;
        if (is_losing && p->steps > LOST_STEP && is_eventful(p)) {
            is_losing = false;
            continue;
        }
        lm_unit_step(&f->unit, now_us);
        if (p->pictures != before) {
            const bool has_sum = fgets(line, sizeof line, sums) != NULL;
            wrong += !has_sum || strtoul(line, NULL, 16) != sum_of(replay_glass(p));
        }
    }
    return wrong + (fgets(line, sizeof line, sums) != NULL);
}

static bool replay_flight(struct flight *f, const char *folder, uint64_t seed, bool is_losing)
{
    static struct replay p;
    char path[1024];
    snprintf(path, sizeof path, "%s/%" PRIu64 ".log", folder, seed);
    FILE *sums = open_file(folder, seed, "sums", "r");
    if (!sums || replay_open(&p, path) != 0) {
        fprintf(stderr, "flights: %s: %s\n", path, sums ? p.error : "has no sums");
        return false;
    }
    f->board.flash = &f->flash.port;
    choose_buses(f, seed);
    f->board.bus_nodes = NULL;
    struct record_head mine;
    record_describe(&mine, &f->board, 0);
    const char *difference = replay_difference(&p, &mine);
    const long wrong =
        difference || replay_wrap(&p, &f->board) != 0 ? -1 : fly_again(f, &p, sums, is_losing);
    const uint32_t seen = p.count.departures + p.count.checks_failed + p.count.reads_differ;
    const bool is_same =
        wrong == 0 && seen == 0 && p.error[0] == '\0' && p.has_ended && p.count.checks > 0;
    if (is_same == is_losing) {
        fprintf(stderr, "flights: %s: %ld pictures differ, departures %u, checks failed %u: %s\n",
                path, wrong, p.count.departures, p.count.checks_failed,
                difference ? difference : p.error);
    }
    replay_close(&p);
    fclose(sums);
    return is_same != is_losing;
}

static uint8_t *read_image(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) {
        fprintf(stderr, "flights: %s: cannot be read\n", path);
        exit(1);
    }
    *size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*size);
    if (!bytes || fread(bytes, 1, *size, file) != *size) {
        fprintf(stderr, "flights: %s: cannot be read\n", path);
        exit(1);
    }
    fclose(file);
    return bytes;
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "image") == 0) {
        return write_image(argv[2]) == 0 ? 0 : 1;
    }
    if (argc != 6 && argc != 7) {
        fprintf(stderr,
                "usage: flights image FILE\n"
                "       flights record|replay|lose IMAGE FOLDER FIRST COUNT [SECONDS]\n");
        return 2;
    }
    size_t size;
    uint8_t *image = read_image(argv[2], &size);
    const uint64_t first = strtoull(argv[4], NULL, 10), count = strtoull(argv[5], NULL, 10);
    uint64_t good = 0;
    for (uint64_t seed = first; seed < first + count; seed++) {
        struct flight *f = calloc(1, sizeof *f);
        if (!f) {
            return 1;
        }
        open_board(f, image, size);
        f->end_us = 1000000 * (argc == 7 ? strtoull(argv[6], NULL, 10) : FLIGHT_S);
        good += strcmp(argv[1], "record") == 0
                    ? record_flight(f, argv[3], seed)
                    : replay_flight(f, argv[3], seed, strcmp(argv[1], "lose") == 0);
        free(f);
    }
    free(image);
    if (swaps > 0) {
        printf("# %" PRIu32 " pages swapped\n", swaps);
    }
    printf("%s: %" PRIu64 " of %" PRIu64 " flights\n", argv[1], good, count);
    return good == count ? 0 : 1;
}
