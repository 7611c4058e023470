/* Restart record: the cause of the board's last restart, in memory that survives a reset and that
 * no loader changes. */
#ifndef ZCU102_RESTART_H
#define ZCU102_RESTART_H

#include <stdbool.h>
#include <stdint.h>

enum zcu102_cause {
    ZCU102_POWER_ON,  /* there is no record: power was off */
    ZCU102_EXCEPTION, /* the program caused an exception */
    ZCU102_NO_STEP,   /* the supervisor found that no step ended */
    ZCU102_NO_FRAME,  /* the supervisor found that no frame was drawn */
    ZCU102_NO_BUS,    /* the supervisor found that the bus was not polled */
    ZCU102_CAUSES
};

struct zcu102_restart {
    uint32_t cause;             /* enum zcu102_cause */
    uint32_t count;             /* restarts since power was switched on */
    uint64_t pc;                /* program counter at the cause */
    uint64_t syndrome, address; /* ESR_EL1, FAR_EL1 of an exception */
};

/* Write the record and reset the board through PSCI. */
_Noreturn void zcu102_restart(enum zcu102_cause cause, uint64_t pc, uint64_t syndrome,
                              uint64_t address);

/* The record of the last restart. Its cause is ZCU102_POWER_ON if there is none, or its check sum
 * is wrong. The next restart continues its count. */
struct zcu102_restart zcu102_last_restart(void);

/* A cause in a few words, in capitals for the glass; in static memory. */
const char *zcu102_cause_words(uint32_t cause);

#endif
