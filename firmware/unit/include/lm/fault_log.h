/* Fault log: which of the unit's flags are faults, and when the last few rose. */
#ifndef LM_FAULT_LOG_H
#define LM_FAULT_LOG_H

#include <stdint.h>

#include "lm/overlay.h"

/* The flags that are faults. Those that follow from what the operator switches or asks for are not:
 * LM_FLAG_FROZEN, LM_FLAG_SILENT, LM_FLAG_UNABLE. Nor is what an exercise breaks:
 * LM_FLAG_MALFUNCTION; nor a restart, whose cause the BIT page has; nor what the owner allows:
 * LM_FLAG_UNSIGNED. A board that lights a lamp derives its set from this one. */
enum {
    LM_FLAGS_FAULT = LM_FLAG_NAV_STALE  /* the ownship's data are stale */
                     | LM_FLAG_NAV_DEAD /* the ownship's data are dead */
                     | LM_FLAG_DB       /* there is no usable image in the flash */
                     | LM_FLAG_TILE    /* records of the image cannot be read or have a wrong CRC */
                     | LM_FLAG_BUS     /* the bus is down or silent */
                     | LM_FLAG_OFF_MAP /* the image does not cover most of the picture */
                     | LM_FLAG_WEATHER /* the sender of the weather is silent */
                     | LM_FLAG_BELOW   /* height or terrain is wrong */
                     | LM_FLAG_MAGNETIC /* the sender of the variation is silent */
                     | LM_FLAG_SENDER   /* a sender is stuck, has a rival, or disagrees */
                     | LM_FLAG_EXERCISE /* the sender of the exercise is silent */
};

enum { LM_FAULTS_KEPT = 4 };

struct lm_fault {
    uint32_t flag;    /* number of the flag's bit, as for lm_flag_word */
    uint64_t time_us; /* when it rose */
};

struct lm_fault_log {
    struct lm_fault kept[LM_FAULTS_KEPT]; /* a ring: fault n, from 0, is at n % LM_FAULTS_KEPT */
    uint32_t count;                       /* faults that ever rose; only grows */
};

/* Add those of the flags `risen` that are faults, the lowest bit first. The oldest are
 * overwritten. */
void lm_fault_log_add(struct lm_fault_log *log, uint32_t risen, uint64_t now_us);

/* The fault that rose last (age 0), or the one `age` before it. NULL iff there was none or it is no
 * longer kept. Valid until the next lm_fault_log_add. */
const struct lm_fault *lm_fault_log_at(const struct lm_fault_log *log, uint32_t age);

#endif
