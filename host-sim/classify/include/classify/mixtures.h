/* Mixtures: pixels that lie across a border between two classes take the class that covers more of
 * them. A mixture of two classes often looks like a third: water and grass like asphalt, asphalt
 * and grass like a roof. A network that sees one pixel at a time cannot know; its neighbours can.
 *
 * The model is linear mixing (Settle and Drake 1993): the spectrum of a pixel is that of what it
 * holds, each by its share of the area. docs/classifier.md, "Mixtures", has the rule and figures.
 *
 * What becomes of a pixel depends on the pixels at most DB_MIXTURES_HALO away and on nothing else:
 * however an image is cut into blocks, the bytes are the same. */
#ifndef CLASSIFY_MIXTURES_H
#define CLASSIFY_MIXTURES_H

#include "classify/net_file.h"

enum { DB_MIXTURES_HALO = 3 }; /* the window of 5 x 5, and the neighbours of its pixels */

/* Farthest that a mixture lies from the line between its two classes, as a part of the distance
 * between them. Of 0.15, 0.2 and 0.3 the best on the scenes of docs/classifier.md, by little. */
#define DB_MIXTURES_TOLERANCE 0.2

struct db_mixtures {
    int band_count;
    double tolerance;
    double *weights; /* owned: of each band, one over the variance of the exemplars */
    double *sums;    /* owned: the bands of each class in the window, scratch */
};

/* Bands are weighed by their spread in `net`. Returns 0, or -1 out of memory, reported. */
int db_mixtures_init(struct db_mixtures *m, const struct db_net *net, double tolerance);

/* Harmless on a zeroed struct. */
void db_mixtures_free(struct db_mixtures *m);

/* Rows of an image of which some are to be judged. The others are their halo: DB_MIXTURES_HALO
 * rows above and below, fewer only where the image ends. */
struct db_mixtures_block {
    const float *planes;    /* band_count planes of rows * width */
    const uint8_t *classes; /* rows * width; DB_CLASS_MAX and above: none */
    uint8_t *sure;          /* rows * width, scratch */
    int width, rows;
    int first, count; /* the rows to judge */
};

/* Write the classes of the `count` rows into `out`; returns how many pixels changed.
 *
 * A pixel is sure when at least five of its eight neighbours are of its class, and keeps it. For
 * the others, the means of the sure pixels of each class in the window of 5 x 5 stand for what the
 * pixel may hold. Of all pairs of them the one whose mixture comes nearest to the pixel is taken,
 * and of that the class of the larger share, the lower number of equals. The class that the pixel
 * has is kept down to a share of 0.4, and where no mixture comes nearer than the tolerance. */
uint64_t db_mixtures_resolve(struct db_mixtures *m, const struct db_mixtures_block *b,
                             uint8_t *out);

#endif
