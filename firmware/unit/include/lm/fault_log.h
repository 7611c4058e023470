/* Faults: which of the unit's flags count as one, and when the last few rose. */
#ifndef LM_FAULT_LOG_H
#define LM_FAULT_LOG_H

#include <stdint.h>

#include "lm/overlay.h"

/* Flags that are a fault, each for its reason. What the operator switches or asks for is none:
 * LM_FLAG_FROZEN, LM_FLAG_SILENT, LM_FLAG_UNABLE. A board that lights a lamp derives its set from
 * this one. */
enum {
    LM_FLAGS_FAULT = LM_FLAG_NAV_STALE  /* the aircraft's data are late */
                     | LM_FLAG_NAV_DEAD /* or missing */
                     | LM_FLAG_DB       /* there is no usable image in the flash */
                     | LM_FLAG_TILE     /* records of it cannot be read or do not check */
                     | LM_FLAG_BUS      /* nothing at all comes from the bus */
                     | LM_FLAG_OFF_MAP  /* the image does not cover what is looked at */
                     | LM_FLAG_WEATHER  /* the sender of the weather has gone quiet */
};

enum { LM_FAULTS_KEPT = 4 };

struct lm_fault {
    uint32_t flag;    /* its number: lm_flag_word */
    uint64_t time_us; /* when it rose */
};

struct lm_fault_log {
    struct lm_fault kept[LM_FAULTS_KEPT]; /* fault n of `count` is at n % LM_FAULTS_KEPT */
    uint32_t count;                       /* only grows */
};

/* Keep those flags of `risen` that are faults, the lowest first. */
void lm_fault_log_add(struct lm_fault_log *log, uint32_t risen, uint64_t now_us);

/* The fault that rose last (age 0), or before that. NULL when there is none or it was not kept. */
const struct lm_fault *lm_fault_log_at(const struct lm_fault_log *log, uint32_t age);

#endif
