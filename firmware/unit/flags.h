/* Flags of the unit (enum lm_flag), updated in each step. */
#ifndef LM_UNIT_FLAGS_H
#define LM_UNIT_FLAGS_H

#include "lm/unit.h"

enum {
    /* The picture stands, and the aircraft moves over it. */
    LM_FLAGS_STANDING = LM_FLAG_FROZEN | LM_FLAG_SILENT,
    /* The picture is removed. */
    LM_FLAGS_REMOVING = LM_FLAG_DB | LM_FLAG_NAV_DEAD | LM_FLAG_POLE,
    /* No line is drawn. */
    LM_FLAGS_NO_LINES = LM_FLAGS_REMOVING | LM_FLAG_NAV_STALE | LM_FLAGS_STANDING
};

/* Update u->flags as of `now_us` and log new faults. Returns the flags that rose since the call
 * before. */
uint32_t lm_update_flags(struct lm_unit *u, uint64_t now_us);

#endif
