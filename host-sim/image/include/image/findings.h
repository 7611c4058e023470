/* What is found wrong with an image: told at once, or kept until its turn comes. */
#ifndef IMAGE_FINDINGS_H
#define IMAGE_FINDINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct image_found {
    uint64_t offset; /* bytes into the image */
    char *text;      /* owned; NULL when there was no memory for it */
};

/* Findings that wait, the first `shown_max` of them. */
struct image_kept {
    struct image_found *items; /* owned */
    size_t count, room;
};

/* What was found wrong, as lines "offset 0x...: cause" on a stream. */
struct image_findings {
    FILE *out; /* borrowed; NULL: count only */
    uint64_t count, shown_max;
    bool is_reported; /* also as items of the array that is open in the report (hs/report.h) */
    struct image_kept *kept; /* borrowed; not NULL: nothing is told, findings are kept there */
};

/* Note one more finding, in printf's manner. `offset` is in bytes into the image. */
void image_find(struct image_findings *f, uint64_t offset, const char *cause, ...)
    __attribute__((format(printf, 3, 4)));

/* Tell in `f` what was kept in `part`, which is empty afterwards: as if it had been found there. It
 * shows the same lines if `part` keeps as many as `f` shows. A part of zeros, which was never
 * begun, has nothing to tell. */
void image_findings_tell(struct image_findings *f, struct image_findings *part);

/* Forget what was kept, if anything. */
void image_findings_drop(struct image_findings *part);

#endif
