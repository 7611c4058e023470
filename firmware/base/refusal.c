#include "lm/refusal.h"

const char *lm_refusal_word(enum lm_refusal reason)
{
    static const char words[LM_REFUSALS][9] = {
        [LM_REFUSED_NOT] = "",          [LM_REFUSED_VALUE] = "VALUE",
        [LM_REFUSED_PAGE] = "PAGE",     [LM_REFUSED_CURSOR] = "CURSOR",
        [LM_REFUSED_SILENT] = "SILENT", [LM_REFUSED_MAP] = "NO MAP",
        [LM_REFUSED_NAV] = "NO NAV",    [LM_REFUSED_CELL] = "CELL",
        [LM_REFUSED_NEAR] = "TOO NEAR", [LM_REFUSED_FAR] = "TOO FAR",
        [LM_REFUSED_HEIGHT] = "HEIGHT", [LM_REFUSED_SQUINT] = "SQUINT",
        [LM_REFUSED_GIMBAL] = "GIMBAL", [LM_REFUSED_DWELL] = "DWELL",
        [LM_REFUSED_SWAP] = "NO SWAP",  [LM_REFUSED_POLE] = "POLE",
    };
    return words[(unsigned)reason < LM_REFUSALS ? reason : LM_REFUSED_NOT];
}
