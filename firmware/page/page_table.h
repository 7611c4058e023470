/* Page table: the keys of a page as rows. A new key is a row in its page's file. A new page is a
 * file with such a table, a row in page.c, and a row in the table of drawing functions in
 * unit/present.c. The latter is there because a page's drawing needs the unit, which this room does
 * not see. */
#ifndef LM_PAGE_TABLE_H
#define LM_PAGE_TABLE_H

#include "lm/page.h"

/* Keys that several pages name by number. */
enum { LM_OSB_CNTL = 5, LM_OSB_DECLUTTER = 11 };

/* A key of a page. Members that are NULL or 0 have no effect; a row with nothing but its number is
 * a free key. */
struct lm_page_key {
    uint8_t osb;        /* 1..LM_OSBS */
    bool repeats;       /* acts again and again while it is held */
    bool starts_hidden; /* after power-up, declutter hides its label */
    bool stays_when_on; /* declutter does not hide its label while is_on: an unusual setting is
                           shown */
    int8_t step;        /* argument of `press`: up 1, down -1 */

    /* The label: `words`, or what `text` writes into both lines of *label. It is hidden while
     * is_shown returns false, and inverse while is_on returns true. */
    const char *words;
    void (*text)(const struct lm_page *p, struct lm_label *label);
    bool (*is_shown)(const struct lm_page *p);
    bool (*is_on)(const struct lm_page *p);

    /* The value between this key and its partner, which both change. */
    void (*value)(const struct lm_page *p, struct lm_label *value);
    bool (*has_value)(const struct lm_page *p); /* NULL: always, if `value` is set */

    /* Carry out a press, or a long press. Each returns its effects (enum lm_effect). */
    uint32_t (*press)(struct lm_page *p, int32_t step);
    uint32_t (*hold)(struct lm_page *p);
};

struct lm_page_table {
    const struct lm_page_key *keys;
    uint32_t count;
    bool is_decluttered;                     /* declutter hides labels on this page */
    const struct lm_page_table *chooses_for; /* keys choose which labels of that page declutter
                                              * hides, and do nothing else; NULL: keys act */
};

extern const struct lm_page_table lm_page_radar, lm_page_cntl, lm_page_dclt;

/* Set the two lines of a label; either may be empty, and is cut off after five characters. */
void lm_label_set(struct lm_label *label, const char *first, const char *second);

/* Set a label to a number below a name, or to a number alone if the name is empty. */
void lm_label_number(struct lm_label *label, const char *name, int32_t value, bool is_signed);

/* Set a label to a number of tenths, at least 0, below a name and behind a sign. */
void lm_label_tenths(struct lm_label *label, const char *name, const char *sign, uint32_t tenths);

/* Reduce the scale to the largest that mode and field of view have. Returns the effects that start
 * the sector. */
uint32_t lm_page_fit_range(struct lm_page *p);

/* Change a value by a step, within +-limit. Returns `effect` if it changed, else 0. */
uint32_t lm_page_step(int8_t *value, int32_t step, int32_t limit, uint32_t effect);

#endif
