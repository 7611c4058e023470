/* What the glass says about the unit (enum lm_flag), judged anew in each step. */
#ifndef LM_UNIT_FLAGS_H
#define LM_UNIT_FLAGS_H

#include "lm/unit.h"

enum {
    /* The picture stays on the glass, and the aircraft moves over it. */
    LM_FLAGS_STANDING = LM_FLAG_FROZEN | LM_FLAG_SILENT,
    /* The picture is removed. */
    LM_FLAGS_REMOVING = LM_FLAG_DB | LM_FLAG_NAV_DEAD,
    /* No line is drawn. */
    LM_FLAGS_NO_LINES = LM_FLAGS_REMOVING | LM_FLAG_NAV_STALE | LM_FLAGS_STANDING
};

/* Put u->flags right as of `now_us` and keep new faults. Returns the flags that have risen. */
uint32_t lm_judge_flags(struct lm_unit *u, uint64_t now_us);

#endif
