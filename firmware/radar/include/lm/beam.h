/* The beam across the line: a ring of azimuths sampled side by side, and the lines of the display
 * as their mean under the antenna's two-way pattern. docs/EQUATIONS.md, "Real beam". */
#ifndef LM_BEAM_H
#define LM_BEAM_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/config.h"
#include "lm/radar.h"
#include "lm/scan_line.h"

enum {
    LM_BEAM_TAPS = 8,
    LM_BEAM_FINEST = 8 /* largest k of D = D0 / 2^k */
};

/* Sample n lies at azimuth (n + 1/2) D from the sector's middle; its power is in slot n mod 8. */
struct lm_beam {
    uint8_t fineness;    /* k */
    int32_t first, held; /* samples first .. first + held - 1 are held */
    uint32_t power_q24[LM_BEAM_TAPS][LM_CELLS_ROOM];
};

/* What one line of the display is made of: samples first .. first + 7, each with its weight. */
struct lm_beam_taps {
    int32_t first;
    uint32_t weight_q16[LM_BEAM_TAPS]; /* of sample first + j; they add up to 65536 */
};

/* Nothing is held any more: the scene has changed. */
void lm_beam_clear(struct lm_beam *b);

/* Look at `azimuth` (signed BAM from the sector's middle, within +-90 degrees) with the radar's
 * beam sharpened `ratio_q8` / 256 times, a power of two (1..256). The table's `sample` is to be 2/7
 * of the beam or less, and 1/4 or more: eight samples then hold it. Samples of another fineness are
 * dropped. Cost: about 450 instructions. */
void lm_beam_set_taps(struct lm_beam *b, const struct lm_radar *radar, int32_t azimuth,
                      uint32_t ratio_q8, struct lm_beam_taps *taps);

/* Azimuth of a sample, signed BAM, and the distance between two. */
fx_bam_t lm_beam_spacing(const struct lm_beam *b, const struct lm_radar *radar);
int32_t lm_beam_azimuth(const struct lm_beam *b, const struct lm_radar *radar, int32_t sample);

/* Whether a sample is held. */
bool lm_beam_has(const struct lm_beam *b, int32_t sample);

/* Whether the look lacks a sample, and which is to be taken next: one beside those that are held,
 * where these are of any use, and else the look's first. */
bool lm_beam_next_missing(const struct lm_beam *b, const struct lm_beam_taps *taps,
                          int32_t *sample);

/* The room of a sample, which counts as held from now on; the others only if it is beside them. */
uint32_t *lm_beam_slot(struct lm_beam *b, int32_t sample);

/* The line: all of the look's samples are held. Cost: see docs/benchmarks.md. */
void lm_beam_sum(const struct lm_beam *b, const struct lm_beam_taps *taps, uint32_t *power_q24,
                 uint32_t cells);

#endif
