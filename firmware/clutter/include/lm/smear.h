/* Smear: blur of a moving target in a patch. During the dwell it moves through range cells, and its
 * Doppler shift moves it through azimuth. Law: docs/EQUATIONS.md, "Movers", under "Smear".
 *
 *      along
 *        ^              .-.
 *        |          .-.(   )   4 slices of the dwell, each a stretched point response
 *        |      .-.(   )`-'    (lm/response.h); their powers add
 *        |     (   )`-'
 *        |      `-'
 *        +------------------> across   */
#ifndef LM_SMEAR_H
#define LM_SMEAR_H

#include <stdint.h>

enum {
    LM_SMEAR_SLICES = 8,        /* of the longest smears */
    LM_SMEAR_ACROSS_MAX = 1024, /* cells, to either side */
    LM_SMEAR_ALONG_MAX = 256    /* cells, either way */
};

/* The dwell cut into slices, each with a point response of its own. */
struct lm_smear {
    uint32_t slices;                              /* 1, 2, 4 or LM_SMEAR_SLICES */
    int32_t across_cells_q8, along_cells_q8;      /* from one slice to the next */
    uint32_t across_stretch_q8, along_stretch_q8; /* size over that of the point response; 256 up */
};

/* Smear of a target that moves that far over the whole dwell. Movements beyond LM_SMEAR_ACROSS_MAX
 * and LM_SMEAR_ALONG_MAX count as these. A target that moves by a cell or less has one slice, not
 * stretched. */
struct lm_smear lm_smear_of(int64_t across_cells_q8, int64_t along_cells_q8);

/* Peak power of a slice, 0..slices - 1, relative to the peak of the target without smear, in
 * decibels: the slice's share of the dwell under the squared Taylor weights, divided by its stretch
 * both ways. */
int32_t lm_smear_share_db_q8(const struct lm_smear *s, uint32_t slice);

#endif
