#include "instrument.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

enum { INST_RETIRED = 8, PMCR_ENABLE_RESET_LONG = 0x47, DEPTH_MAX = 16, CALIBRATIONS = 16 };

void instrument_enter(uint64_t stage);
void instrument_leave(uint64_t stage);
void instrument_nothing(void);

/* Test code: one program, one instrument. */
static struct {
    struct instrument result;
    uint64_t now;      /* instructions outside of the instrument */
    uint32_t resumed;  /* the counter when the program went on */
    uint32_t crossing; /* instructions that entering or leaving adds outside of it */
    uint32_t depth, mode;
    uint64_t started[DEPTH_MAX];
    uint64_t inner[DEPTH_MAX]; /* what the stages that are called in a stage under way have taken */
    bool samples[INSTRUMENT_STAGES_MAX], draws[INSTRUMENT_STAGES_MAX],
        paints[INSTRUMENT_STAGES_MAX];
    uint64_t line;    /* of the line drawn last */
    uint32_t in_line; /* how many of the stages under way sample or draw a line */
} state;

uint32_t instrument_modes_set[INSTRUMENT_MODES];

static uint32_t counter(void)
{
    uint64_t value;
    __asm__ volatile("isb\n\tmrs %0, pmevcntr0_el0" : "=r"(value) : : "memory");
    return (uint32_t)value;
}

static void stop_counting(void)
{
    state.now += counter() - state.resumed;
    state.now -= state.crossing;
}

static void go_on_counting(void)
{
    state.resumed = counter();
}

void instrument_enter(uint64_t stage)
{
    stop_counting();
    state.in_line += state.samples[stage] || state.draws[stage];
    state.inner[state.depth % DEPTH_MAX] = 0;
    state.started[state.depth++ % DEPTH_MAX] = state.now;
    go_on_counting();
}

static void add(struct instrument_sum *sum, uint64_t spent, uint64_t own)
{
    sum->instructions += spent;
    sum->own += own;
    sum->calls++;
    sum->most = spent > sum->most ? (uint32_t)spent : sum->most;
}

void instrument_leave(uint64_t stage)
{
    stop_counting();
    const uint64_t spent = state.now - state.started[--state.depth % DEPTH_MAX];
    add(&state.result.sums[state.mode][stage], spent,
        state.in_line ? spent - state.inner[state.depth % DEPTH_MAX] : 0);
    state.in_line -= state.samples[stage] || state.draws[stage];
    state.inner[(state.depth - 1) % DEPTH_MAX] += spent;
    if (state.draws[stage]) {
        state.line = spent;
    } else if (state.paints[stage]) {
        add(&state.result.lines[state.mode], state.line + spent, 0);
    }
    go_on_counting();
}

static size_t length_of(const char *name)
{
    size_t length = 0;
    while (name[length]) {
        length++;
    }
    return length;
}

static bool ends_in(const char *name, const char *end)
{
    const size_t length = length_of(name), end_length = length_of(end);
    return length >= end_length && memcmp(name + length - end_length, end, end_length) == 0;
}

static bool begins_with(const char *name, const char *begin)
{
    const size_t length = length_of(begin);
    return length_of(name) >= length && memcmp(name, begin, length) == 0;
}

static void find_lines(void)
{
    for (uint32_t i = 0; i < instrument_stages; i++) {
        state.samples[i] = ends_in(instrument_names[i], "_sample_ahead");
        state.draws[i] = ends_in(instrument_names[i], "_draw_line");
        state.paints[i] = begins_with(instrument_names[i], "lm_scan_conv_");
    }
}

/* What a pair of entering and leaving costs outside of the two functions, halved. */
static uint32_t measure_crossing(void)
{
    go_on_counting();
    state.now = 0;
    for (uint32_t i = 0; i < CALIBRATIONS; i++) {
        instrument_nothing(); /* stage 0: does nothing */
    }
    stop_counting();
    return (uint32_t)(state.now / (2 * CALIBRATIONS));
}

void instrument_start(void)
{
    __asm__ volatile("msr pmevtyper0_el0, %0\n\tmsr pmcntenset_el0, %1\n\tmsr pmcr_el0, %2\n\tisb"
                     :
                     : "r"((uint64_t)INST_RETIRED), "r"((uint64_t)1),
                       "r"((uint64_t)PMCR_ENABLE_RESET_LONG));
    find_lines();
    state.crossing = measure_crossing();
    state.result = (struct instrument){0};
    state.now = 0;
    go_on_counting();
}

void instrument_set_mode(uint32_t mode)
{
    state.mode = mode < INSTRUMENT_MODES ? mode : INSTRUMENT_MODES - 1;
    instrument_modes_set[state.mode]++;
}

uint64_t instrument_now(void)
{
    stop_counting();
    state.now += state.crossing; /* nothing was crossed */
    go_on_counting();
    return state.now;
}

uint64_t instrument_of(const char *name, uint32_t mode)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < instrument_stages; i++) {
        const bool is_it =
            begins_with(instrument_names[i], name) && ends_in(instrument_names[i], name);
        sum += is_it ? state.result.sums[mode][i].instructions : 0;
    }
    return sum;
}

const struct instrument *instrument_result(void)
{
    return &state.result;
}
