/* A flight that is counted: the unit on the board's flash and display, with one core, no interrupts
 * and no waiting, and the bus handed to it from memory. The sums go out on the console:
 *
 *   stage MODE NAME CALLS INSTRUCTIONS MOST OWN  of chosen functions (images.mk)
 *   stage MODE line|step|frame-step ...          a line, a step without and with a picture
 *   stage MODE steady-frame|whole-frame ...      a picture of at most three steps, or of more
 *   first-picture-us N                           since the reset */
#include "board.h"
#include "console.h"
#include "handed.h"
#include "instrument.h"
#include "psci.h"

int main(void);
void instrument_nothing(void);

void instrument_nothing(void)
{
}

_Static_assert(LM_SECTOR_CHOICES *LM_FOVS + 2 < INSTRUMENT_MODES,
               "a sum for each mode, both patches and a track");

/* What changes in the steady sweep is composed in one step, or in two or three with many lines. */
enum { STEADY_STEPS = 3 };

struct bench {
    struct zcu102 z;
    struct handed handed;
    struct lm_can can;
    struct lm_controls controls;
    struct instrument_sum steps[INSTRUMENT_MODES], frame_steps[INSTRUMENT_MODES];
    struct instrument_sum steady[INSTRUMENT_MODES]; /* frames of few steps, and of more */
    struct instrument_sum whole[INSTRUMENT_MODES];
    uint64_t start_us, first_picture_us; /* since reset */
};

static void add(struct instrument_sum *sum, uint64_t spent)
{
    sum->instructions += spent;
    sum->calls++;
    sum->most = spent > sum->most ? (uint32_t)spent : sum->most;
}

/* A number for what is being drawn: mode and field of the sector, behind them the patch, the patch
 * of cells finer than the map, and a track that is held, which draws nothing. */
static uint32_t mode_of(const struct lm_unit *unit)
{
    const uint32_t patch = LM_SECTOR_CHOICES * LM_FOVS;
    if (unit->track.state >= LM_TRACK_HELD) {
        return patch + 2;
    }
    return unit->page.picture == LM_PICTURE_PATCH
               ? patch + unit->picture.sar.blend.is_on
               : (uint32_t)unit->page.mode * LM_FOVS + unit->page.fov;
}

static void fly(struct bench *b)
{
    struct zcu102 *z = &b->z;
    uint64_t frame = 0; /* instructions that the frame under way has taken */
    for (z->step_us = 0; z->step_us <= b->handed.header->end_us; z->step_us += ZCU102_STEP_US) {
        const uint32_t mode = mode_of(&z->unit), frames = z->unit.count.frames;
        instrument_set_mode(mode);
        const uint64_t before = instrument_of("lm_show_frame", mode);
        const uint64_t start = instrument_now();
        lm_unit_step(&z->unit, z->step_us);
        add(z->unit.count.frames == frames ? &b->steps[mode] : &b->frame_steps[mode],
            instrument_now() - start);
        frame += instrument_of("lm_show_frame", mode) - before;
        if (z->unit.count.frames != frames) {
            add(z->unit.frame_steps <= STEADY_STEPS ? &b->steady[mode] : &b->whole[mode], frame);
            frame = 0;
        }
        if (frames == 0 && z->unit.count.frames != 0) {
            /* In QEMU an instruction is a nanosecond. What the instrument takes does not count. */
            b->first_picture_us = b->start_us + instrument_now() / 1000;
        }
    }
}

static void print(struct drv_uart *u, uint32_t mode, const char *name,
                  const struct instrument_sum *sum)
{
    if (sum->calls == 0) {
        return;
    }
    zcu102_print(u, "stage ");
    zcu102_print_number(u, mode);
    zcu102_print(u, " ");
    zcu102_print(u, name);
    zcu102_print(u, " ");
    zcu102_print_number(u, sum->calls);
    zcu102_print(u, " ");
    zcu102_print_number(u, sum->instructions);
    zcu102_print(u, " ");
    zcu102_print_number(u, sum->most);
    zcu102_print(u, " ");
    zcu102_print_number(u, sum->own);
    zcu102_print(u, "\n");
}

static void report(struct bench *b)
{
    struct drv_uart *u = &b->z.console;
    const struct instrument *result = instrument_result();
    for (uint32_t mode = 0; mode < INSTRUMENT_MODES; mode++) {
        for (uint32_t i = 1; i < instrument_stages; i++) {
            print(u, mode, instrument_names[i], &result->sums[mode][i]);
        }
        print(u, mode, "line", &result->lines[mode]);
        print(u, mode, "step", &b->steps[mode]);
        print(u, mode, "frame-step", &b->frame_steps[mode]);
        print(u, mode, "steady-frame", &b->steady[mode]);
        print(u, mode, "whole-frame", &b->whole[mode]);
    }
    zcu102_print_value(u, "first-picture-us", b->first_picture_us);
    zcu102_print_value(u, "stack-used", zcu102_stack_used());
}

int main(void)
{
    static struct bench b;
    zcu102_open(&b.z);
    if (!handed_open(&b.handed, &b.z.step_us)) {
        zcu102_print(&b.z.console, "there is no scenario in memory\n");
        zcu102_power_off();
    }
    b.can = (struct lm_can){.ctx = &b.handed, .receive = handed_receive};
    b.controls = (struct lm_controls){.ctx = &b.handed, .next = handed_next_control};
    b.z.lent.can = &b.can;
    b.z.lent.controls = &b.controls;
    zcu102_mask_interrupts();
    if (lm_unit_init(&b.z.unit, &b.z.lent) == LM_OK) {
        const struct drv_timer since_reset = {.hz = b.z.timer.hz};
        b.start_us = drv_timer_us(&since_reset);
        instrument_start();
        fly(&b);
        report(&b);
    }
    zcu102_power_off();
}
