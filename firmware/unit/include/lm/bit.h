/* BIT page: the built-in test's versions, counters and faults, as rows of text. */
#ifndef LM_BIT_H
#define LM_BIT_H

#include "lm/text.h"
#include "lm/unit.h"

enum { LM_BIT_ROWS = 23 };

/* Senders of the bus that are not what they should be; each only grows. docs/bus.md, "Senders that
 * are noticed". */
struct lm_sender_counts {
    uint32_t stuck;  /* struct lm_canas, of all tables */
    uint32_t rivals; /* struct lm_nav, as disagreements */
    uint32_t disagreements;
    uint32_t sum;       /* of these three */
    uint32_t refused;   /* frames of nodes that are not on the board's list */
    uint8_t stuck_node; /* of a stuck sender; 0: there was none */
};

struct lm_sender_counts lm_sender_counts(const struct lm_unit *u);

/* What is wrong with a sender, in words, for LM_FLAG_SENDER: "STUCK NODE 7", "RIVAL NODE 9",
 * "SENDERS DIFFER"; empty if nothing ever was. */
struct lm_text lm_sender_fault(const struct lm_unit *u);

/* The text of a row, 0..LM_BIT_ROWS - 1; it may be empty:
 *
 *     0..2    version, title and size of the image; behind the version the slot that is flown, or
 *             how far a load into the other one is; behind the title how many further images
 *             answer
 *     3..15   counters, two in a row, each a name and its number; the last is where the radar table
 *             in use comes from, and its name
 *     16      flags that are raised now
 *     17..20  the faults that rose last, the latest first
 *     21      cause of the board's last restart, and slots that are damaged or cut off
 *     22      what the exercise has broken: no fault
 */
struct lm_text lm_bit_row(const struct lm_unit *u, uint32_t row);

#endif
