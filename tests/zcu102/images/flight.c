/* A flight on the board, as the host handed it over (scenario.h): the second core replays the bus,
 * the script works the controls, and the pictures it asks for are kept and shown at the end, so
 * that the flight runs without a stop. What the bus brought, and when, stays in `received` for the
 * host.
 *
 * After a restart the unit flies again without bus and shows its BIT page. */
#include "board.h"
#include "console.h"
#include "fx/mem.h"
#include "handed.h"
#include "look.h"
#include "peer.h"
#include "psci.h"
#include "sections.h"

int main(void);

enum {
    PIXELS = ZCU102_WIDTH_PX * ZCU102_HEIGHT_PX,
    RECEIVED_MAX = 65536,
    BIT_BUTTON = 12,
    AFTER_RESTART_US = 1500000
};

/* Read by the host (machine.py finds it by name). */
extern struct lm_can_frame received[RECEIVED_MAX];
ZCU102_BULK struct lm_can_frame received[RECEIVED_MAX];

static ZCU102_BULK uint32_t album[SCENARIO_PICTURES_MAX][PIXELS];

struct flight {
    struct zcu102 z;
    struct peer peer;
    struct handed handed;
    uint32_t next_picture, received_count;
    uint32_t kept_at[SCENARIO_PICTURES_MAX]; /* pictures presented until then */
    uint32_t early;            /* frames that a step was given although they came after its time */
    uint64_t first_picture_us; /* since the board's reset */
    struct lm_can can;
    struct lm_controls control_port;
    struct lm_display display;
};

static bool is_hung(const struct flight *f, enum scenario_hang what)
{
    return f->handed.header->hang == (uint64_t)what && f->z.step_us >= f->handed.header->hang_us &&
           f->z.last_restart.cause == ZCU102_POWER_ON;
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct flight *f = ctx;
    if (is_hung(f, SCENARIO_HANG_BUS)) {
        return 0;
    }
    const int status = f->z.can.port.receive(f->z.can.port.ctx, frame);
    if (status == 1 && f->received_count < RECEIVED_MAX) {
        received[f->received_count++] = *frame;
        f->early += frame->time_us > f->z.step_us;
    }
    return status;
}

static int send(void *ctx, const struct lm_can_frame *frame)
{
    struct flight *f = ctx;
    return f->z.can.port.send(f->z.can.port.ctx, frame);
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct flight *f = ctx;
    while (is_hung(f, SCENARIO_HANG_STEP)) {
    }
    return handed_next_control(&f->handed, control);
}

static int acquire(void *ctx, struct lm_surface *surface)
{
    struct flight *f = ctx;
    return is_hung(f, SCENARIO_HANG_DISPLAY)
               ? LM_BUSY
               : f->z.display.port.acquire(f->z.display.port.ctx, surface);
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct flight *f = ctx;
    if (f->first_picture_us == 0) {
        const struct drv_timer since_reset = {.hz = f->z.timer.hz};
        f->first_picture_us = drv_timer_us(&since_reset);
    }
    return f->z.display.port.present(f->z.display.port.ctx, changed);
}

static void put_between(struct flight *f)
{
    f->can = (struct lm_can){.ctx = f, .receive = receive, .send = send};
    f->control_port = (struct lm_controls){.ctx = f, .next = next_control};
    f->display = f->z.display.port;
    f->display.ctx = f;
    f->display.acquire = acquire;
    f->display.present = present;
    f->z.lent.can = &f->can;
    f->z.lent.controls = &f->control_port;
    f->z.lent.display = &f->display;
}

/* The glass as it is just before the step, where the bench takes its pictures too. */
static void keep_pictures(struct flight *f)
{
    while (f->next_picture < f->handed.header->pictures &&
           f->handed.pictures[f->next_picture].time_us <= f->z.step_us) {
        look_keep(&f->z.display, album[f->next_picture]);
        f->kept_at[f->next_picture] = f->z.unit.count.frames;
        f->next_picture++;
    }
}

static void show_pictures(struct flight *f)
{
    for (uint32_t i = 0; i < f->next_picture; i++) {
        look_show(&f->z.display, album[i]);
        look(&f->z.console, &f->z.display, f->handed.pictures[i].name);
    }
}

static void report(struct flight *f)
{
    struct drv_uart *u = &f->z.console;
    const struct lm_unit *unit = &f->z.unit;
    zcu102_print_value(u, "first-picture-us", f->first_picture_us);
    zcu102_print_value(u, "sent", f->peer.sent);
    zcu102_print_value(u, "refused", f->peer.refused);
    zcu102_print_value(u, "received", f->received_count);
    zcu102_print_value(u, "early", f->early);
    zcu102_print_value(u, "ring-overflowed", f->z.can.count.overflowed);
    zcu102_print_value(u, "fifo-overflowed", f->z.can.count.fifo_overflowed);
    zcu102_print_value(u, "frames", unit->count.frames);
    zcu102_print_value(u, "lines", unit->count.lines);
    zcu102_print_value(u, "lines-dropped", unit->count.lines_dropped);
    zcu102_print_value(u, "steps-left-out", f->z.steps_left_out);
    zcu102_print_value(u, "tiles-read", unit->map.tiles.count.tiles_read);
    zcu102_print_value(u, "read-errors", unit->map.tiles.count.io_errors);
    zcu102_print_value(u, "tiles-corrupt", unit->map.tiles.count.corrupt);
    zcu102_print_value(u, "flags", unit->flags);
    zcu102_print_value(u, "recorded-lines-lost", f->z.recording.lines_lost);
    for (uint32_t i = 0; i < f->next_picture; i++) {
        zcu102_print_value(u, f->handed.pictures[i].name, f->kept_at[i]);
    }
    zcu102_print_value(u, "interrupts", f->z.irq.count.taken);
    zcu102_print_value(u, "stack-used", zcu102_stack_used());
}

static void fly(struct flight *f)
{
    while (f->z.step_us <= f->handed.header->end_us) {
        keep_pictures(f);
        zcu102_step(&f->z);
    }
    f->z.is_supervised = false; /* looking takes as long as the host likes */
    report(f);
    show_pictures(f);
}

/* The BIT page says why. */
static void show_restart(struct flight *f)
{
    static const struct scenario_header nothing_but_presses = {.controls = 2};
    static const struct scenario_control presses[] = {
        {500000, {.kind = LM_CONTROL_DOWN, .button = BIT_BUTTON}},
        {600000, {.kind = LM_CONTROL_UP, .button = BIT_BUTTON}}};
    f->handed.header = &nothing_but_presses;
    f->handed.controls = presses;
    while (f->z.step_us <= AFTER_RESTART_US) {
        zcu102_step(&f->z);
    }
    f->z.is_supervised = false;
    look(&f->z.console, &f->z.display, "bit");
}

int main(void)
{
    static struct flight f;
    zcu102_open(&f.z);
    if (!handed_open(&f.handed, &f.z.step_us)) {
        zcu102_print(&f.z.console, "there is no scenario in memory\n");
        zcu102_power_off();
    }
    f.peer.board = &f.z;
    f.peer.frames = f.handed.frames;
    f.peer.count = f.handed.header->frames;
    put_between(&f);
    if (zcu102_start(&f.z) != LM_OK) {
        zcu102_print(&f.z.console, "the unit does not start\n");
        zcu102_power_off();
    }
    if (f.z.last_restart.cause != ZCU102_POWER_ON) {
        show_restart(&f);
    } else if (f.peer.count > 0 && !peer_start(&f.peer)) {
        zcu102_print(&f.z.console, "the second core does not start\n");
    } else {
        fly(&f);
    }
    zcu102_power_off();
}
