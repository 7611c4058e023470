/* Counts the instructions of chosen functions, calls included, with the core's performance counter
 * (INST_RETIRED, DDI 0487 D7.11): under QEMU's -icount the same to the digit in each run. Which
 * functions, images.mk says; the instrument's own instructions are taken off. */
#ifndef INSTRUMENT_H
#define INSTRUMENT_H

#include <stdint.h>

enum { INSTRUMENT_STAGES_MAX = 80, INSTRUMENT_MODES = 20 };

struct instrument_sum {
    uint64_t instructions;
    uint64_t
        own; /* in stages *_sample_ahead and *_draw_line, without what other stages took in it */
    uint32_t calls, most; /* most: of one call */
};

struct instrument {
    struct instrument_sum sums[INSTRUMENT_MODES][INSTRUMENT_STAGES_MAX];
    struct instrument_sum
        lines[INSTRUMENT_MODES]; /* a stage *_draw_line and the lm_scan_conv_* behind it */
};

extern const uint32_t instrument_stages;
extern const char *const instrument_names[];

/* How often each mode was set. Whoever watches the memory from outside sees the mode by the word
 * that is written (tests/zcu102/cycles). */
extern uint32_t instrument_modes_set[INSTRUMENT_MODES];

/* Start counting; interrupts should be masked while something is measured. */
void instrument_start(void);

/* What the mode is that is counted for from now on, 0..INSTRUMENT_MODES - 1. */
void instrument_set_mode(uint32_t mode);

/* Instructions so far, without the instrument's. */
uint64_t instrument_now(void);

/* Those of a stage so far, in a mode. */
uint64_t instrument_of(const char *name, uint32_t mode);

const struct instrument *instrument_result(void);

#endif
