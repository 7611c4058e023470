/* Why the board restarted: a record that survives a reset, in memory that no loader touches. */
#ifndef ZCU102_RESTART_H
#define ZCU102_RESTART_H

#include <stdbool.h>
#include <stdint.h>

enum zcu102_cause {
    ZCU102_POWER_ON,  /* no record: power was off */
    ZCU102_EXCEPTION, /* the program did what the machine does not allow */
    ZCU102_NO_STEP,   /* the supervisor saw the unit's step hang, */
    ZCU102_NO_FRAME,  /* no picture come, */
    ZCU102_NO_BUS,    /* or the bus not being asked */
    ZCU102_CAUSES
};

struct zcu102_restart {
    uint32_t cause;             /* enum zcu102_cause */
    uint32_t count;             /* restarts since power came */
    uint64_t pc;                /* where the program was */
    uint64_t syndrome, address; /* ESR_EL1, FAR_EL1 of an exception */
};

/* Write the record and reset the board through PSCI. */
_Noreturn void zcu102_restart(enum zcu102_cause cause, uint64_t pc, uint64_t syndrome,
                              uint64_t address);

/* The record of the last restart; ZCU102_POWER_ON when there is none, or one that does not check.
 * `count` then grows from it at the next restart. */
struct zcu102_restart zcu102_last_restart(void);

/* A few words for a cause, in capitals as the glass has them. */
const char *zcu102_cause_words(uint32_t cause);

#endif
