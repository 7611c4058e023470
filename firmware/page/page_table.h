/* Page table: the keys of a page as rows. A new key is a row in its page's file; a new page is a
 * file with such a table, a row in page.c, and one in the table of drawing functions
 * (unit/present.c), for what a page draws needs the unit, which this room does not see. */
#ifndef LM_PAGE_TABLE_H
#define LM_PAGE_TABLE_H

#include "lm/page.h"

/* Keys that pages know of each other by number. */
enum { LM_OSB_CNTL = 5, LM_OSB_DECLUTTER = 11 };

/* A key of a page. Members that are NULL or 0 ask for nothing: a row with a number alone is a key
 * that is free. */
struct lm_page_key {
    uint8_t osb;        /* 1..LM_OSBS */
    bool repeats;       /* while it is held */
    bool starts_hidden; /* after power-up, declutter takes its label away */
    bool stays_when_on; /* but not while is_on holds: what is out of the ordinary is shown */
    int8_t step;        /* given to `press`: up 1, down -1 */

    /* The label: `words`, or what `text` writes into both lines of *label; none while is_shown
     * says so; inverse while is_on says so. */
    const char *words;
    void (*text)(const struct lm_page *p, struct lm_label *label);
    bool (*is_shown)(const struct lm_page *p);
    bool (*is_on)(const struct lm_page *p);

    /* What stands between this key and its partner, the value that both change. */
    void (*value)(const struct lm_page *p, struct lm_label *value);
    bool (*has_value)(const struct lm_page *p); /* NULL: always, where there is `value` */

    /* A press, and one that was held long; each returns its effects (enum lm_effect). */
    uint32_t (*press)(struct lm_page *p, int32_t step);
    uint32_t (*hold)(struct lm_page *p);
};

struct lm_page_table {
    const struct lm_page_key *keys;
    uint32_t count;
    bool is_decluttered;                     /* declutter takes labels away here */
    const struct lm_page_table *chooses_for; /* keys choose which labels declutter takes away on
                                              * that page, and do nothing else; NULL: they act */
};

extern const struct lm_page_table lm_page_radar, lm_page_cntl, lm_page_dclt;

/* Write one or two lines of a label; what is longer than five characters is cut off. */
void lm_label_say(struct lm_label *label, const char *first, const char *second);

/* A number under a name, or alone where the name is empty. */
void lm_label_number(struct lm_label *label, const char *name, int32_t value, bool is_signed);

/* A number of tenths, at least 0, under a name, behind a sign. */
void lm_label_tenths(struct lm_label *label, const char *name, const char *sign, uint32_t tenths);

/* Begin the sector with the largest scale, up to the one at hand, that mode and field have. */
uint32_t lm_page_fit_range(struct lm_page *p);

/* Move a value by a step within +-limit. Returns `effect` when it moved, else 0. */
uint32_t lm_page_step(int8_t *value, int32_t step, int32_t limit, uint32_t effect);

#endif
