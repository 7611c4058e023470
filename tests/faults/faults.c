#include "faults.h"

#include "bus_frames.h"

#include <stdlib.h>
#include <string.h>

enum {
    NEVER = 1 << 30,
    JUNK_A_STEP = 16, /* 8,000 frames a second: all of 1 Mbit/s */
    STOP_MS = 8000,
    LEAP_MS = 1000000, /* 17 minutes */
    ELSEWHERE_BYTES = 4096,
    SECOND_US = 1000000,
    NODE = 20 /* the display's own */
};

/* ---- devices that fail ---- */

static int start_read(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct faults *f = ctx;
    struct memory_flash *flash = &f->r->board.flash;
    const uint32_t some = 2 + f->draw % 6;
    if (faults_stand(f, READS_REFUSED)) {
        return LM_ERR_IO;
    }
    if (faults_stand(f, READS_ELSEWHERE) && offset >= ELSEWHERE_BYTES * (1 + f->draw % 8)) {
        offset -= ELSEWHERE_BYTES * (1 + f->draw % 8);
    }
    const bool fails = faults_stand(f, READS_FAIL) ||
                       (faults_stand(f, READS_FAIL_SOME) && hs_rng_below(&f->rng, some) == 0);
    flash->fail_every = fails ? 1 : 0;
    flash->busy_polls = faults_stand(f, READS_NEVER) ? NEVER
                        : faults_stand(f, READS_LATE)
                            ? 1 + hs_rng_below(&f->rng, 20 + f->draw % 200)
                            : 0;
    return f->flash.read_start(f->flash.ctx, offset, destination, length);
}

static int poll_read(void *ctx)
{
    struct faults *f = ctx;
    struct memory_flash *flash = &f->r->board.flash;
    if (!faults_stand(f, READS_NEVER) && flash->now.polls_left > NEVER / 2) {
        flash->now.polls_left = 0; /* the fault went */
    }
    const int status = f->flash.read_poll(f->flash.ctx);
    uint8_t *bytes = flash->now.to;
    const uint32_t length = flash->now.length;
    if (status == LM_OK && faults_stand(f, READS_TORN)) {
        const uint32_t from = hs_rng_below(&f->rng, length);
        memset(bytes + from, (int)(f->draw & 0xff), length - from);
    }
    for (uint32_t n = 0; status == LM_OK && faults_stand(f, READS_FLIP) && n <= f->draw % 16; n++) {
        bytes[hs_rng_below(&f->rng, length)] ^= (uint8_t)(1 << hs_rng_below(&f->rng, 8));
    }
    return status;
}

static bool is_of(const struct lm_can_frame *frame, const uint32_t *ids)
{
    while (*ids != 0 && *ids != frame->id) {
        ids++;
    }
    return *ids != 0;
}

static bool is_lost(const struct faults *f, const struct lm_can_frame *frame)
{
    static const uint32_t position[] = {1036, 1037, 0}, height[] = {1038, 320, 0},
                          heading[] = {1133, 321, 0}, speed[] = {1039, 1040, 0},
                          attitude[] = {311, 312, 0};
    return (faults_stand(f, NO_POSITION) && is_of(frame, position)) ||
           (faults_stand(f, NO_HEIGHT) && is_of(frame, height)) ||
           (faults_stand(f, NO_HEADING) && is_of(frame, heading)) ||
           (faults_stand(f, NO_SPEED) && is_of(frame, speed)) ||
           (faults_stand(f, NO_ATTITUDE) && is_of(frame, attitude));
}

/* Not a number, infinite, or far outside of what the quantity can be. */
static void spoil(struct faults *f, struct lm_can_frame *frame)
{
    static const uint32_t words[] = {0x7fc00000, 0x7f800000, 0xff800000, 0x7f7fffff, 0x4d000000};
    const uint32_t word = words[f->draw % 5];
    for (int i = 0; i < 4; i++) {
        frame->data[4 + i] = (uint8_t)(word >> (24 - 8 * i));
    }
}

/* The driver's clock of the frames is wrong by up to 16 s. */
static uint64_t arrival_us(const struct faults *f)
{
    const uint64_t now_us = f->r->now_us, wrong_us = 1000 * (uint64_t)(1 + f->draw % 16000);
    if (faults_stand(f, FRAMES_OLD)) {
        return now_us > wrong_us ? now_us - wrong_us : 0;
    }
    return faults_stand(f, FRAMES_AHEAD) ? now_us + wrong_us : now_us;
}

static void alter(struct faults *f, struct lm_can_frame *frame)
{
    frame->time_us = arrival_us(f);
    if (frame->id != f->bus_id) {
        return;
    }
    if (faults_stand(f, BAD_VALUES)) {
        spoil(f, frame);
    }
    if (faults_stand(f, STUCK_CODE)) {
        frame->data[3] = (uint8_t)f->draw;
    }
    if (faults_stand(f, RIVAL)) {
        f->has_rival = true;
        f->rival = *frame;
        f->rival.data[0] = 77;
        f->rival.data[6] ^= (uint8_t)(1 << f->draw % 8);
    }
}

/* A node asks this one who it is, without a pause (CANaerospace: identification service). */
static struct lm_can_frame question(const struct faults *f)
{
    return (struct lm_can_frame){
        .id = 128, .length = 4, .data = {NODE, LM_CANAS_NODATA, 0, 0}, .time_us = f->r->now_us};
}

/* Of an identifier that nobody here has. */
static struct lm_can_frame junk(struct faults *f)
{
    if (faults_stand(f, QUESTIONS)) {
        return question(f);
    }
    struct lm_can_frame frame = {
        .id = hs_rng_below(&f->rng, 128), .length = 8, .time_us = f->r->now_us};
    frame.is_error = faults_stand(f, BUS_ERRORS);
    for (int i = 0; i < 8; i++) {
        frame.data[i] = (uint8_t)hs_rng_below(&f->rng, 256);
    }
    return frame;
}

/* ---- the exercise ---- */

static void tell_frame(struct faults *f, uint32_t id, uint8_t type, uint32_t word)
{
    f->told[f->told_count++] = bus_frame(id, type, (uint8_t)f->told_s, word, 0);
}

/* Once a second: the clock, a circle of rain, a ship. */
static void tell_exercise(struct faults *f)
{
    const uint64_t bus_us = f->r->bus.now_us;
    if (bus_us < f->told_s * SECOND_US) {
        return;
    }
    f->told_s = bus_us / SECOND_US + 1;
    f->told_count = f->told_next = 0;
    if (!faults_stand(f, NO_EXERCISE)) {
        const uint32_t leap_ms =
            faults_stand(f, EXERCISE_LEAPS) ? hs_rng_below(&f->rng, LEAP_MS) : 0;
        tell_frame(f, 1820, LM_CANAS_LONG, (uint32_t)(bus_us / 1000) + leap_ms);
    }
    if (!faults_stand(f, NO_WEATHER)) {
        const double rain[] = {46.1, 11.05, 3000, 10};
        for (uint32_t i = 0; i < 4; i++) {
            tell_frame(f, 1800 + i, LM_CANAS_FLOAT, bus_float_bits(rain[i]));
        }
    }
    if (!faults_stand(f, NO_TARGETS)) {
        tell_frame(f, 1810, LM_CANAS_LONG, 460200000);
        tell_frame(f, 1811, LM_CANAS_LONG, 110100000);
        tell_frame(f, 1815, LM_CANAS_UCHAR4, 12u << 24);
    }
}

static int receive_told(struct faults *f, struct lm_can_frame *frame)
{
    if (f->told_next == f->told_count || faults_stand(f, BUS_SILENT)) {
        f->told_next = f->told_count;
        return 0;
    }
    *frame = f->told[f->told_next++];
    return 1;
}

/* What is said: to the bus. */
static int send(void *ctx, const struct lm_can_frame *frame)
{
    const struct faults *f = ctx;
    (void)frame;
    return faults_stand(f, SENDS_FAIL) ? LM_ERR_IO : faults_stand(f, SENDS_BUSY) ? LM_BUSY : LM_OK;
}

static int receive_any(struct faults *f, struct lm_can_frame *frame)
{
    return receive_told(f, frame) == 1 ? 1 : f->can.receive(f->can.ctx, frame);
}

static bool is_dropped(struct faults *f, const struct lm_can_frame *frame)
{
    return is_lost(f, frame) ||
           (faults_stand(f, FRAMES_LOST) && hs_rng_below(&f->rng, 8) < 1 + f->draw % 4);
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct faults *f = ctx;
    if (faults_stand(f, BUS_DOWN)) {
        return LM_ERR_IO;
    }
    if (f->junk > 0) {
        f->junk--;
        *frame = junk(f);
        return 1;
    }
    if (f->has_rival) {
        f->has_rival = false;
        *frame = f->rival;
        return 1;
    }
    int status = receive_any(f, frame);
    while (status == 1 && is_dropped(f, frame)) {
        status = receive_any(f, frame);
    }
    if (status == 1) {
        alter(f, frame);
    }
    return status;
}

/* What a key, a knob or a mistaken sender may say. */
static struct lm_control any_control(struct faults *f)
{
    const int32_t value = (int32_t)hs_rng_below(&f->rng, 2001) - 1000;
    const int32_t button = 1 + (int32_t)hs_rng_below(&f->rng, LM_BUTTONS);
    return hs_rng_below(&f->rng, 4) == 0 ? lm_control_knob(value)
                                         : lm_control_button(hs_rng_below(&f->rng, 2) == 0, button);
}

static struct lm_control bad_control(struct faults *f)
{
    static const enum lm_control_kind kind[] = {
        LM_CONTROL_SECTOR,         LM_CONTROL_SAR,   LM_CONTROL_ENVIRONMENT,
        LM_CONTROL_CURSOR,         LM_CONTROL_RANGE, LM_CONTROL_GAIN,
        LM_CONTROL_AZIMUTH,        LM_CONTROL_DOWN,  LM_CONTROL_UP,
        LM_CONTROL_KNOB,           LM_CONTROL_SLEW,  (enum lm_control_kind)LM_CONTROL_KINDS,
        (enum lm_control_kind) - 1};
    struct lm_control c;
    memset(&c, 0x80, sizeof c);
    c.kind = kind[hs_rng_below(&f->rng, sizeof kind / sizeof *kind)];
    if (c.kind == LM_CONTROL_SAR) {
        c.sar.is_from_ownship = true; /* a bool of another value is no C */
    }
    return c;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct faults *f = ctx;
    if (faults_stand(f, KEY_CHATTERS) && hs_rng_below(&f->rng, 3) == 0) {
        f->is_down = !f->is_down;
        *control = lm_control_button(f->is_down, f->button);
        return 1;
    }
    if ((faults_stand(f, KEY_STORM) || faults_stand(f, BAD_CONTROLS)) &&
        hs_rng_below(&f->rng, 4) == 0) {
        *control = faults_stand(f, BAD_CONTROLS) ? bad_control(f) : any_control(f);
        return 1;
    }
    return f->controls.next(f->controls.ctx, control);
}

/* ---- what a campaign calls ---- */

static void take_over(struct faults *f)
{
    struct rig *r = f->r;
    r->board.can.ctx = r->board.controls.ctx = r->board.flash.port.ctx = f;
    r->board.can.receive = receive;
    r->board.can.send = send;
    r->board.controls.next = next_control;
    r->board.flash.port.read_start = start_read;
    r->board.flash.port.read_poll = poll_read;
}

void faults_open(struct faults *f, struct rig *r)
{
    *f = (struct faults){
        .r = r, .can = r->board.can, .flash = r->board.flash.port, .controls = r->board.controls};
    take_over(f);
}

void faults_go_on(struct faults *f, const struct faults *from, const struct hs_rng *rng)
{
    *f = *from;
    f->rng = *rng;
    take_over(f);
}

bool faults_stand(const struct faults *f, enum kind kind)
{
    return (f->standing & 1ull << kind) != 0;
}

/* The memory of the pictures is another one, in which anything stands. */
static void lose_surface(struct rig *r)
{
    r->board.presented = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        r->glass[i] = FAULTS_GARBAGE;
    }
}

void faults_step(struct faults *f)
{
    struct rig *r = f->r;
    r->bus.now_us = r->now_us - f->leapt_us;
    r->bus.stop_us = faults_stand(f, BUS_SILENT) ? 0 : UINT64_MAX;
    f->junk =
        faults_stand(f, BUS_FLOOD) || faults_stand(f, BUS_ERRORS) || faults_stand(f, QUESTIONS)
            ? JUNK_A_STEP
            : 0;
    tell_exercise(f);
    if (faults_stand(f, SURFACE_LOST)) {
        lose_surface(r);
    }
    r->board.acquire_status = faults_stand(f, NO_SURFACE)     ? LM_BUSY
                              : faults_stand(f, SCREEN_FAILS) ? LM_ERR_IO
                                                              : LM_OK;
    r->board.present_status = faults_stand(f, SHOWING_FAILS) ? LM_ERR_IO : LM_OK;
    lm_unit_step(&r->unit, r->now_us);
    r->now_us += STEP_US;
    if (faults_stand(f, STARVED)) {
        r->now_us += hs_rng_below(&f->rng, 1000 * (20 + f->draw % 400));
    }
}

/* A second database comes, of which so many bytes are there. */
static struct lm_control image_of(uint64_t bytes)
{
    return (struct lm_control){.kind = LM_CONTROL_IMAGE, .image = {.place = 2, .bytes = bytes}};
}

void faults_begin(struct faults *f, enum kind kind)
{
    static const uint32_t ids[] = {1036, 1037, 1133, 1038, 1039};
    struct rig *r = f->r;
    f->draw = hs_rng_below(&f->rng, 1 << 20);
    f->bus_id = ids[hs_rng_below(&f->rng, 5)];
    f->standing |= 1ull << kind;
    if (kind == JUMP_NEAR) {
        r->bus.jump_degrees = 0.01 + f->draw % 100 * 0.0002;
    } else if (kind == JUMP_FAR) {
        r->bus.jump_degrees = 1 + f->draw % 40;
    } else if (kind == KEY_STUCK || kind == KEY_CHATTERS) {
        f->button = 1 + (int32_t)(f->draw % LM_BUTTONS);
        f->is_down = kind == KEY_STUCK;
        command(r, lm_control_button(true, f->button));
    } else if (kind == STICK_HELD) {
        const int32_t x = (int32_t)(f->draw % 2001) - 1000,
                      y = (int32_t)(f->draw / 2001 % 2001) - 1000;
        command(r, lm_control_slew(x, y));
    } else if (kind == BAD_IMAGE) {
        command(r, image_of(1 + f->draw % 100000));
    } else if (kind == STOPPED) {
        r->now_us += 1000 * (uint64_t)(100 + f->draw % STOP_MS);
    } else if (kind == LEAP) {
        f->leapt_us = 1000 * (uint64_t)(1 + f->draw % LEAP_MS);
        r->now_us += f->leapt_us;
    } else if (kind == RESTART) {
        if (lm_unit_init(&r->unit, &r->board.lent) != LM_OK) {
            abort();
        }
        command(r, range_10);
    }
}

void faults_end(struct faults *f)
{
    f->r->bus.jump_degrees = 0;
    if (faults_stand(f, STICK_HELD)) {
        command(f->r, lm_control_slew(0, 0));
    }
    if (faults_stand(f, BAD_IMAGE)) {
        command(f->r, image_of(0));
    }
    if (faults_stand(f, KEY_STUCK) || faults_stand(f, KEY_CHATTERS)) {
        command(f->r, lm_control_button(false, f->button));
    }
    f->standing = 0;
}
