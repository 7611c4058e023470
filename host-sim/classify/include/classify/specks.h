/* Specks: which class of those around it a pixel takes that a sieve took out of its own. GDAL's
 * sieve gives a whole speck the class of its largest neighbour, which beside a road is always the
 * field: what was one wrong pixel of a line becomes a notch. Here each pixel takes, of the classes
 * beside it, the one whose pixels around it look most like it.
 *
 * What becomes of a pixel depends on the pixels at most DB_SPECKS_HALO away and on nothing else:
 * however an image is cut into blocks, the bytes are the same. */
#ifndef CLASSIFY_SPECKS_H
#define CLASSIFY_SPECKS_H

#include "classify/net_file.h"

enum { DB_SPECKS_HALO = 2 };

/* Rows of an image of which some are to be judged. The others are their halo: DB_SPECKS_HALO rows
 * above and below, fewer only where the image ends. */
struct db_specks_block {
    const float *planes;           /* band_count planes of rows * width */
    const uint8_t *before, *after; /* the sieve: rows * width; DB_CLASS_MAX and above: none */
    int width, rows;
    int first, count; /* the rows to judge */
};

/* True if the pixel is of a speck: its class differs, and is not spared. */
bool db_specks_has(const struct db_specks_block *b, const bool is_spared[DB_CLASS_MAX], size_t at);

/* Write the classes of the `count` rows into `out`; returns how many are not those before the
 * sieve.
 *
 * What is no speck has its class from before the sieve. A pixel of a speck takes one of the classes
 * that its eight neighbours outside of specks have: that whose mean over the 5 x 5 pixels around,
 * specks left out, is nearest to its bands, weighed by their spread in `net`; the lower number of
 * equals. Without such a neighbour it has the class that the sieve gave it. */
uint64_t db_specks_settle(const struct db_net *net, const bool is_spared[DB_CLASS_MAX],
                          const struct db_specks_block *b, uint8_t *out);

#endif
