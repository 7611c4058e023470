/* Progress bar for long work: drawn only when standard error is a terminal, silent otherwise. */
#ifndef HS_PROGRESS_H
#define HS_PROGRESS_H

#include <stdint.h>
#include <stdio.h>

struct hs_progress {
    const char *label; /* borrowed until hs_progress_end */
    uint64_t total;    /* of `done` at the end, in any unit */
    int shown_permille;
    int is_terminal;
};

/* Start the bar at 0 of `total`. */
void hs_progress_begin(struct hs_progress *p, const char *label, uint64_t total);

/* The same beside work that writes lines to `out`: no bar when that is a terminal, where the lines
 * show how far it is, nor without a total. */
void hs_progress_begin_beside(struct hs_progress *p, FILE *out, const char *label, uint64_t total);

/* Redraws only when the tenth of a per cent changes; cheap enough to call once a block or row. */
void hs_progress_update(struct hs_progress *p, uint64_t done);

/* Removes the bar. */
void hs_progress_end(struct hs_progress *p);

#endif
