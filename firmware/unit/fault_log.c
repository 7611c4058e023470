#include "lm/fault_log.h"

#include <stddef.h>

void lm_fault_log_add(struct lm_fault_log *log, uint32_t risen, uint64_t now_us)
{
    for (uint32_t i = 0; i < LM_FLAGS; i++) {
        if (risen & LM_FLAGS_FAULT & 1u << i) {
            log->kept[log->count++ % LM_FAULTS_KEPT] = (struct lm_fault){i, now_us};
        }
    }
}

const struct lm_fault *lm_fault_log_at(const struct lm_fault_log *log, uint32_t age)
{
    return age < log->count && age < LM_FAULTS_KEPT
               ? &log->kept[(log->count - 1 - age) % LM_FAULTS_KEPT]
               : NULL;
}
