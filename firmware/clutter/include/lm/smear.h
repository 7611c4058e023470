/* What is left of a mover's focus in a patch: while the radar dwells, it walks through range cells,
 * and its Doppler shift through azimuth. docs/EQUATIONS.md, "Movers". */
#ifndef LM_SMEAR_H
#define LM_SMEAR_H

#include <stdint.h>

enum { LM_SMEAR_SLICES = 8, LM_SMEAR_ACROSS_MAX = 1024, LM_SMEAR_ALONG_MAX = 256 /* cells */ };

/* The dwell cut into slices, each a point response: `across` and `along` (cells * 256) from the one
 * before, stretched to across_stretch_q8 and along_stretch_q8 / 256 times its size. */
struct lm_smear {
    uint32_t slices; /* 1, 2, 4 or LM_SMEAR_SLICES */
    int32_t across_cells_q8, along_cells_q8;
    uint32_t across_stretch_q8, along_stretch_q8; /* from 256 up */
};

/* The smear of what goes so far over the whole dwell, cells * 256; what is farther than
 * LM_SMEAR_..._MOST is taken for that. Up to a cell either way there is none. */
struct lm_smear lm_smear_of(int64_t across_cells_q8, int64_t along_cells_q8);

/* Power of a slice in its middle, of that of the whole unsmeared, dB * 256: its share of the dwell
 * under Taylor's weights, over its stretch both ways. */
int32_t lm_smear_share_db_q8(const struct lm_smear *s, uint32_t slice);

#endif
