/* Soak: two displays on one bus of 1 Mbit/s that is never idle, for an hour of the exercise's time.
 *
 *     soak [SECONDS]                                     3,600 unless said; make soak
 *
 * The wire is modelled bit by bit: a frame takes as long as its bits with those stuffed, and the
 * next one follows it at once. On it are navigation, an exercise clock, 256 live targets of eight
 * frames once a second, what both displays tell, exchanges of pages, and for the rest frames of
 * others. Each display steps every 4 ms, and once a second 16 ms late. Nothing may be lost: each
 * frame is heard by whom it is for, each set of live targets takes effect, each report goes out,
 * each exchange comes about, and the clock never steps. Exit code 1 if something was lost. */
#include "bus_frames.h"
#include "lm/canas.h"
#include "lm/swap.h"
#include "unit_rig.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    S = 1000000,
    SEATS = 2,
    QUEUE = 4096,
    OUTBOX = 64,
    SOAK_STEP_US = 4000,
    LATE_US = 16000,
    SWAP_EVERY_S = 10,
    LIVE_FRAMES = 8,
    ACTS = 2 /* frames of an exercise's second: time, rate */
};

struct seat {
    struct rig *r;
    struct soak *soak;
    struct lm_can_frame heard[QUEUE], said[OUTBOX];
    uint32_t heard_head, heard_tail, said_head, said_tail;
    uint32_t waited_most, overflowed;
    uint64_t next_us;
};

struct soak {
    struct seat seat[SEATS];
    uint64_t bus_ns; /* the wire is taken until then */
    uint64_t frames, busy_ns, of_others;
    uint64_t nav_us;     /* of the next navigation frames */
    uint32_t nav_at;     /* the next one of them */
    uint64_t live_at;    /* live frames sent so far */
    uint64_t exercise_s; /* the next second that is told */
    uint32_t exercise_at;
    uint8_t code;
};

/* ---- the wire ---- */

/* Bits of a standard data frame on the wire: the part that is stuffed, its stuff bits, and 13 more
 * to the end of the pause between frames (ISO 11898-1). */
static uint32_t frame_bits(const struct lm_can_frame *f)
{
    uint8_t bit[128];
    uint32_t n = 0, crc = 0, stuffed = 0, run = 0;
    const uint64_t head =
        (uint64_t)f->id << 7 | f->length; /* start, 11 bits, three zeros, length */
    for (int32_t i = 18; i >= 0; i--) {
        bit[n++] = (uint8_t)(head >> i & 1);
    }
    for (uint32_t i = 0; i < f->length * 8u; i++) {
        bit[n++] = f->data[i / 8] >> (7 - i % 8) & 1;
    }
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t next = bit[i] ^ (crc >> 14 & 1);
        crc = (crc << 1 ^ (next ? 0x4599u : 0u)) & 0x7fff;
    }
    for (int32_t i = 14; i >= 0; i--) {
        bit[n++] = (uint8_t)(crc >> i & 1);
    }
    for (uint32_t i = 0, last = 2; i < n; i++) {
        run = bit[i] == last ? run + 1 : 1;
        last = bit[i];
        if (run == 5) { /* the stuff bit is the other one, and begins a run */
            stuffed++;
            last ^= 1;
            run = 1;
        }
    }
    return n + stuffed + 13;
}

static int hear(void *ctx, struct lm_can_frame *frame)
{
    struct seat *s = ctx;
    if (s->heard_tail == s->heard_head || s->heard[s->heard_tail % QUEUE].time_us > s->r->now_us) {
        return 0;
    }
    *frame = s->heard[s->heard_tail++ % QUEUE];
    return 1;
}

static int say(void *ctx, const struct lm_can_frame *frame)
{
    struct seat *s = ctx;
    if (s->said_head - s->said_tail == OUTBOX) {
        return LM_BUSY;
    }
    s->said[s->said_head++ % OUTBOX] = *frame;
    return LM_OK;
}

static void put(struct soak *w, const struct seat *from, struct lm_can_frame f)
{
    const uint64_t took_ns = frame_bits(&f) * 1000ull;
    w->bus_ns += took_ns;
    w->busy_ns += took_ns;
    w->frames++;
    f.time_us = w->bus_ns / 1000;
    for (uint32_t i = 0; i < SEATS; i++) {
        struct seat *s = &w->seat[i];
        if (s == from) {
            continue;
        }
        if (s->heard_head - s->heard_tail == QUEUE) {
            s->overflowed++;
            continue;
        }
        s->heard[s->heard_head++ % QUEUE] = f;
        const uint32_t waiting = s->heard_head - s->heard_tail;
        s->waited_most = waiting > s->waited_most ? waiting : s->waited_most;
    }
}

/* ---- who sends ---- */

/* Twenty times a second, 150 m/s to the north and back, an hour of it over 10 km. */
static bool send_nav(struct soak *w, uint64_t now_us)
{
    static const uint32_t ids[] = {1036, 1037, 1038, 320, 1133, 321,
                                   1039, 1040, 311,  312, 303,  305};
    if (now_us < w->nav_us) {
        return false;
    }
    const double turn_s = 120, t = fmod((double)w->nav_us / S, turn_s);
    const bool is_back = fmod((double)w->nav_us / S, 2 * turn_s) >= turn_s;
    const double north_m = is_back ? 150 * (turn_s - t) : 150 * t;
    const double heading = is_back ? 180 : 0;
    const double values[] = {
        45.95 + north_m / 111132, 11, 2000, 2300, heading, heading, 150, heading, 2, 0, 0, 0};
    put(w, NULL,
        bus_frame(ids[w->nav_at], LM_CANAS_FLOAT, (uint8_t)(w->nav_us / 50000),
                  bus_float_bits(values[w->nav_at]), 0));
    w->nav_at = (w->nav_at + 1) % (sizeof ids / sizeof *ids);
    w->nav_us += w->nav_at == 0 ? 50000 : 0;
    return true;
}

static bool send_exercise(struct soak *w, uint64_t now_us)
{
    if (now_us < w->exercise_s * S) {
        return false;
    }
    const bool is_rate = w->exercise_at == 0;
    put(w, NULL,
        bus_frame(is_rate ? 1821 : 1820, is_rate ? LM_CANAS_FLOAT : LM_CANAS_LONG, w->code,
                  is_rate ? bus_float_bits(1) : (uint32_t)(now_us / 1000), 0));
    w->exercise_at = (w->exercise_at + 1) % ACTS;
    if (w->exercise_at == 0) {
        w->exercise_s++;
        w->code++;
    }
    return true;
}

/* Each of 256 targets once a second, all of its eight frames one behind another. */
static bool send_live(struct soak *w, uint64_t now_us)
{
    static const uint32_t ids[LIVE_FRAMES] = {1810, 1811, 1815, 1812, 1813, 1814, 1816, 1819};
    static const uint8_t types[LIVE_FRAMES] = {LM_CANAS_LONG,  LM_CANAS_LONG,   LM_CANAS_UCHAR4,
                                               LM_CANAS_FLOAT, LM_CANAS_SHORT2, LM_CANAS_SHORT2,
                                               LM_CANAS_FLOAT, LM_CANAS_SHORT2};
    if (w->live_at * S / (LM_LIVE_MAX * LIVE_FRAMES) > now_us) {
        return false;
    }
    const uint32_t part = (uint32_t)(w->live_at % LIVE_FRAMES);
    const uint32_t number = (uint32_t)(w->live_at / LIVE_FRAMES % LM_LIVE_MAX);
    const uint32_t words[LIVE_FRAMES] = {460000000 + number % 16 * 10000,
                                         110000000 + number / 16 * 10000,
                                         2u << 24 | 2u << 16 | 31,
                                         bus_float_bits(200),
                                         100u << 16 | 60,
                                         0,
                                         bus_float_bits(20),
                                         0};
    struct lm_can_frame f =
        bus_frame(ids[part], types[part], (uint8_t)(w->live_at / (LM_LIVE_MAX * LIVE_FRAMES)),
                  words[part], 0);
    f.data[0] = 7;
    f.data[2] = (uint8_t)number;
    put(w, NULL, f);
    w->live_at++;
    return true;
}

/* What a display said, in turn. */
static bool send_said(struct soak *w)
{
    for (uint32_t i = 0; i < SEATS; i++) {
        struct seat *s = &w->seat[(w->frames + i) % SEATS];
        if (s->said_head != s->said_tail) {
            put(w, s, s->said[s->said_tail++ % OUTBOX]);
            return true;
        }
    }
    return false;
}

static void send_other(struct soak *w)
{
    struct lm_can_frame f = bus_frame(400 + (uint32_t)(w->frames % 97), LM_CANAS_LONG,
                                      (uint8_t)w->frames, (uint32_t)(w->frames * 2654435761u), 0);
    f.data[0] = 40;
    w->of_others++;
    put(w, NULL, f);
}

/* Fill the wire up to a time. */
static void fill(struct soak *w, uint64_t until_us)
{
    while (w->bus_ns < until_us * 1000) {
        const uint64_t now_us = w->bus_ns / 1000;
        if (!send_nav(w, now_us) && !send_exercise(w, now_us) && !send_said(w) &&
            !send_live(w, now_us)) {
            send_other(w);
        }
    }
}

/* ---- the displays ---- */

static void sit(struct soak *w, uint32_t i)
{
    struct seat *s = &w->seat[i];
    s->r = make_rig();
    s->soak = w;
    s->r->board.can = (struct lm_can){.ctx = s, .receive = hear, .send = say};
    s->r->board.lent.bus_node = (uint8_t)(20 + i);
    s->r->board.lent.bus_partner = (uint8_t)(21 - i);
    s->r->board.lent.tells_reports = true;
    if (lm_unit_init(&s->r->unit, &s->r->board.lent) != LM_OK) {
        fprintf(stderr, "soak: the display does not start\n");
        exit(1);
    }
    command(s->r, range_10);
}

/* Every 4 ms; once a second, each at its own time, 16 ms late. */
static void step_seat(struct seat *s, uint64_t now_us)
{
    if (now_us < s->next_us) {
        return;
    }
    s->r->now_us = now_us;
    lm_unit_step(&s->r->unit, now_us);
    const bool is_late = now_us % S / SOAK_STEP_US == (s == s->soak->seat ? 20 : 170);
    s->next_us = now_us + SOAK_STEP_US + (is_late ? LATE_US : 0);
}

static void press_swap(struct rig *r)
{
    command(r, lm_control_button(true, 15));
    command(r, lm_control_button(false, 15));
}

/* ---- verdict ---- */

static uint64_t judge(const char *what, uint64_t lost)
{
    printf("%-52s %10" PRIu64 "\n", what, lost);
    return lost;
}

static uint64_t judge_seat(const struct soak *w, uint32_t i, uint32_t swaps)
{
    const struct seat *s = &w->seat[i];
    const struct lm_unit *u = &s->r->unit;
    const uint64_t heard = u->count.bus_frames + (uint64_t)(s->heard_head - s->heard_tail);
    printf("display %u: %u frames heard, at most %u waited; %u lines, %u pictures\n", 20 + i,
           u->count.bus_frames, s->waited_most, u->count.lines, u->count.frames);
    const uint64_t sets = w->live_at / LIVE_FRAMES; /* the last one or two may still wait */
    uint64_t lost = judge("  frames that found no room", s->overflowed);
    lost += judge("  frames not heard though they came", s->heard_head != (uint32_t)heard);
    lost += judge("  sets of live targets torn, refused or aged out",
                  u->live.count.torn + u->live.count.refused + u->live.count.aged);
    lost += judge("  sets of live targets that did not take effect",
                  sets > u->live.count.sets + 4 ? sets - u->live.count.sets : 0);
    lost += judge("  steps of the exercise clock", u->exercise.count.steps);
    lost += judge("  reports cut or lost", u->report.count.cut + u->report.count.lost);
    lost += judge("  controls told and lost", u->control_bus.count.lost);
    lost += judge("  exchanges of pages that failed", swaps - u->count.swaps);
    lost += judge("  lines of the picture left out", u->count.lines_dropped);
    return lost;
}

int main(int argc, char **argv)
{
    const uint64_t seconds = argc > 1 ? strtoull(argv[1], NULL, 10) : 3600;
    struct soak *w = calloc(1, sizeof *w);
    uint32_t swaps = 0;
    if (!w || seconds < 2 || seconds > 86400) {
        fprintf(stderr, "soak: give seconds of the exercise, 2 to 86400\n");
        return 1;
    }
    sit(w, 0);
    sit(w, 1);
    for (uint64_t now_us = 0; now_us < seconds * S; now_us += SOAK_STEP_US) {
        if (now_us % (SWAP_EVERY_S * S) == 5 * S) {
            press_swap(w->seat[swaps++ % SEATS].r);
        }
        fill(w, now_us);
        step_seat(&w->seat[0], now_us);
        step_seat(&w->seat[1], now_us);
    }
    printf("%" PRIu64 " s of a bus of 1 Mbit/s: %" PRIu64
           " frames, busy for %.2f %% of it, %.0f %% of "
           "the frames of others\n",
           seconds, w->frames, (double)w->busy_ns / (double)seconds / 1e7,
           (double)w->of_others * 100 / (double)w->frames);
    const uint64_t lost = judge_seat(w, 0, swaps) + judge_seat(w, 1, swaps);
    printf("%u exchanges of pages; lost in all: %" PRIu64 "\n", swaps, lost);
    free_rig(w->seat[0].r);
    free_rig(w->seat[1].r);
    free(w);
    return lost == 0 ? 0 : 1;
}
