/* Report: gathers from the unit what lm/canas_report.h tells the other avionics. */
#ifndef LM_UNIT_REPORT_H
#define LM_UNIT_REPORT_H

#include "lm/unit.h"

/* Tell the sets that are due. Call in every step. No effect unless the board asked for reports.
 * Cost: up to 2000 instructions when sets are due. */
void lm_send_reports(struct lm_unit *u, uint64_t now_us);

#endif
