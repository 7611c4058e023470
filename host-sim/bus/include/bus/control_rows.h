/* Rows of control frames (lm/canas_control.h), as those of reports: names and units for people, who
 * read them in the decoder, the table and the .dbc file. */
#ifndef BUS_CONTROL_ROWS_H
#define BUS_CONTROL_ROWS_H

#include "lm/canas_report.h"

/* The row of an item, 0..LM_CONTROL_ITEMS - 1. Its set means nothing. */
struct lm_report_row bus_control_row(int item);

/* The row of what two displays tell each other when SWAP is pressed. */
struct lm_report_row bus_swap_row(void);

#endif
