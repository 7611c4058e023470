/* Beam: the antenna in azimuth. A ring holds the last samples (azimuths traced side by side), and
 * each line of the display is their mean under the antenna's two-way pattern.
 *
 *     azimuth from the sector's middle
 *     sample     n-4   n-3   n-2   n-1    n    n+1   n+2   n+3
 *                 |     |     |     |     |     |     |     |     D apart, sample k at (k + 1/2) D
 *     weight      .     .     o     O  ^  O     o     .     .     2^(-8 x^2)
 *                                      azimuth of the display line: 8 taps around it
 *
 *     slot       sample mod 8: a new sample beside the held ones takes the slot of the one at the
 *                other end, so the ring always holds neighbours
 *
 * Order of the calls for a line: lm_beam_set_taps; while lm_beam_next_missing, fill
 * lm_beam_slot(sample); then lm_beam_sum. No call fails.
 * Source: docs/EQUATIONS.md, "Real beam". */
#ifndef LM_BEAM_H
#define LM_BEAM_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/config.h"
#include "lm/radar.h"
#include "lm/scan_line.h"

enum {
    LM_BEAM_TAPS = 8,
    LM_BEAM_FINEST = 8 /* largest k of the spacing D = D0 / 2^k */
};

/* Ring of samples. Sample n lies at azimuth (n + 1/2) D from the sector's middle, with its power in
 * slot n mod 8. The caller owns it. */
struct lm_beam {
    uint8_t fineness;    /* k of the spacing D = D0 / 2^k; D0 is the table's `sample` */
    int32_t first, held; /* samples first .. first + held - 1 are held; held is 0..8 */
    uint32_t power_q24[LM_BEAM_TAPS][LM_CELLS_ROOM];
    bool has_steady[LM_BEAM_TAPS]; /* true if a slot has scatterers, which are kept apart */
    uint32_t steady_q24[LM_BEAM_TAPS][LM_CELLS_ROOM];
};

/* Taps of one display line: samples first .. first + 7, each with its weight. */
struct lm_beam_taps {
    int32_t first;
    uint32_t weight_q16[LM_BEAM_TAPS]; /* of sample first + j; they add up to 65536 or less */
};

/* Drop all samples, because what they were traced from has changed. */
void lm_beam_clear(struct lm_beam *b);

/* Compute the taps of a display line at `azimuth` (signed BAM from the sector's middle, within +-90
 * degrees).
 *
 * - ratio_q8 / 256 is the sharpening ratio N, 1..256. The fineness is the nearest to log2 N.
 * - The table's `sample` must be 1/4 to 2/7 of the beam: eight samples then hold the beam, which is
 *   1.7 to 3.5 of them wide.
 * - Samples of another fineness are dropped.
 *
 * The weights add up to 65536. Cost: about 450 instructions. */
void lm_beam_set_taps(struct lm_beam *b, const struct lm_radar *radar, int32_t azimuth,
                      uint32_t ratio_q8, struct lm_beam_taps *taps);

/* Weaken a line: multiply its power by share_q16 / 65536, which is at most 1. */
void lm_beam_weaken(struct lm_beam_taps *taps, uint32_t share_q16);

/* Distance D between two samples. */
fx_bam_t lm_beam_spacing(const struct lm_beam *b, const struct lm_radar *radar);

/* Azimuth of a sample, signed BAM from the sector's middle. */
int32_t lm_beam_azimuth(const struct lm_beam *b, const struct lm_radar *radar, int32_t sample);

/* True if a sample is held. */
bool lm_beam_has(const struct lm_beam *b, int32_t sample);

/* Find the sample to take next for these taps. True if one is missing, with *sample set to
 * - the first of the taps, if none of the held samples is among them;
 * - the neighbour of the held samples on the side where one is missing, otherwise.
 * False, with *sample of no meaning, if all are held. */
bool lm_beam_next_missing(const struct lm_beam *b, const struct lm_beam_taps *taps,
                          int32_t *sample);

/* Slot of a sample, which counts as held from now on: the caller fills it with the powers of its
 * cells. The other samples stay held only if this one is their neighbour. The slot is part of *b.
 */
uint32_t *lm_beam_slot(struct lm_beam *b, int32_t sample);

/* The same slot's powers of scatterers, which the caller fills, too. Call it after lm_beam_slot; a
 * slot without this call has no scatterers. */
uint32_t *lm_beam_steady_slot(struct lm_beam *b, int32_t sample);

/* Compute the powers of the scatterers of the display line. False, with *power_q24 unchanged, if no
 * sample of the taps has any. Cost: that of lm_beam_sum, or 30 instructions. */
bool lm_beam_steady_sum(const struct lm_beam *b, const struct lm_beam_taps *taps,
                        uint32_t *power_q24, uint32_t cells);

/* Compute the powers of the display line. All samples of the taps must be held. Cost:
 * docs/benchmarks.md. */
void lm_beam_sum(const struct lm_beam *b, const struct lm_beam_taps *taps, uint32_t *power_q24,
                 uint32_t cells);

#endif
