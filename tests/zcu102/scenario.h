/* A flight handed to the board in its memory: what others send on the bus, what the operator does,
 * and when a picture is to be kept. Written by scenario.c on the PC, read by images/flight.c;
 * little-endian, as both machines are. The three tables follow the header in this order, each
 * sorted by time. */
#ifndef SCENARIO_H
#define SCENARIO_H

#include "lm/controls.h"
#include "lm/port.h"

enum { SCENARIO_MAGIC = 0x4E43534C, SCENARIO_BYTES_MAX = 8 << 20, SCENARIO_PICTURES_MAX = 16 };

struct scenario_header {
    uint32_t magic, frames, controls, pictures;
    uint64_t end_us;
    uint64_t hang; /* enum scenario_hang, from hang_us on */
    uint64_t hang_us;
};

/* What the test makes go wrong, for the supervisor to find. */
enum scenario_hang {
    SCENARIO_FINE,
    SCENARIO_HANG_STEP,    /* a stage of the step never returns */
    SCENARIO_HANG_DISPLAY, /* the display is busy for ever */
    SCENARIO_HANG_BUS      /* the bus is no longer asked */
};

struct scenario_control {
    uint64_t time_us;
    struct lm_control control;
};

struct scenario_picture {
    uint64_t time_us;
    char name[64];
};

#endif
