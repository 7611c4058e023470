/* Judgement of an image against what its network was trained on: pixels whose bands lie outside the
 * range of the exemplars, pixels between two classes, and a class that swallows the image.
 *
 * A network answers for any numbers: imagery of other units, another sensor or another season gets
 * classes all the same, often one alone. These figures say so. */
#ifndef CLASSIFY_JUDGE_H
#define CLASSIFY_JUDGE_H

#include "classify/net_file.h"
#include "classify/samples.h"

/* Shares of an image from which on it is warned of. Judgements: on their own scenes networks of the
 * real imagery leave at most 10 % outside and no class has more than 72 % (docs/classifier.md). */
#define DB_OUTSIDE_WARN 0.25
#define DB_LARGEST_WARN 0.98

struct db_judge {
    const struct db_net *net;       /* borrowed */
    double sure;                    /* of the winner against the next, 0.5..1; less is unsure */
    uint64_t pixels;                /* with data */
    uint64_t outside, unsure;       /* of them; a pixel may be both */
    uint64_t by_band[DB_INPUT_MAX]; /* pixels outside the range of each band */
};

/* Count `count` pixels. `planes` and `margins` as in db_apply; `margins` may be NULL when `sure` is
 * 0.5. `reject` becomes 1 for pixels outside or unsure, 0 for the others. Of the inputs only the
 * bands count; without a range in the network no pixel is outside. */
void db_judge_add(struct db_judge *j, const float *planes, const float *margins,
                  const uint8_t *valid, size_t count, uint8_t *reject);

/* Print the shares and warn where they are large. `counts` are pixels of each class, by index into
 * the table, without those rejected. */
void db_judge_report(const struct db_judge *j, const char *image,
                     const struct db_class_table *table, const uint64_t counts[256]);

#endif
