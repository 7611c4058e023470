/* Kernels of the radar: bins from cells, azimuths and beam, receiver, tone. What holds for every
 * kernel (arrays, groups of 16 cells, ownership, costs) is in lm/kernels_map.h. */
#ifndef LM_KERNELS_RADAR_H
#define LM_KERNELS_RADAR_H

#include <stdint.h>

#include "fx/const.h"
#include "fx/tables.h"

/* Each bin takes the level of one cell: bin_db_q8[i] = level_db_q8[cell_of[i]]. `cell_of` may hold
 * any index of `level_db_q8`. Reads and writes no bin behind the last one. Cost: 2 a cell. */
void lm_k_gather(const int16_t *level_db_q8, const int32_t *cell_of, int16_t *bin_db_q8,
                 uint32_t cells);

/* Power of each level, 10^(level / 10) in Q24. 1 is the least power, -72.25 dB; powers of 24.08 dB
 * and more are those of the octave below 2^32. Writes no entry behind the last cell. Cost: 3 a
 * cell. */
void lm_k_powers_of_levels(const int16_t *level_db_q8, uint32_t *power_q24, uint32_t cells);

enum { LM_K_STRIDE = 4 };

/* Sum of the powers of level_db_q8[0], [LM_K_STRIDE], ..., `count` of them, over that of
 * `most_db_q8`, which counts for what is higher, in Q24. No level between the first and the last
 * group of LM_K_STRIDE is outside the array, and there are at most 255. Cost: 3 a level that
 * counts.
 */
uint32_t lm_k_sum_powers(const int16_t *level_db_q8, int16_t most_db_q8, uint32_t count);

/* Sum of powers, as levels held within 16 bits: add `level_db_q8` to `sum_db_q8`. Worst error 0.018
 * dB. Writes no entry behind the last cell. Cost: 2 a cell. */
void lm_k_levels_add(int16_t *sum_db_q8, const int16_t *level_db_q8, uint32_t cells);

/* Mean of powers, as levels: the sum of `sum_db_q8` and `level_db_q8` as above, less `less_db_q8`.
 * The result stands in `level_db_q8`. Writes no entry behind the last cell. Cost: 2 a cell. */
void lm_k_levels_mean(const int16_t *sum_db_q8, int16_t less_db_q8, int16_t *level_db_q8,
                      uint32_t cells);

enum { LM_K_HIGHEST_CELLS = 16 };

/* The highest of each LM_K_HIGHEST_CELLS levels. Behind the last cell there may be anything: it
 * counts too. Cost: 1 a cell. */
void lm_k_highest(const int16_t *level_db_q8, int16_t *highest_db_q8, uint32_t cells);

enum { LM_K_BESIDE = 4 };

/* Those of LM_K_HIGHEST_CELLS cells that are at least `least_db_q8` high, as high as each of the
 * LM_K_BESIDE cells before and behind them, and `above_db_q8` or more above the last of these: bit
 * k is cell k. As many cells before the first and behind the last are read, too. The difference is
 * held within 16 bits. Cost: 4 a cell. */
uint32_t lm_k_stand_out(const int16_t *level_db_q8, int16_t least_db_q8, int16_t above_db_q8);

enum { LM_K_LOBES_REACH = 8, LM_K_LOBES_BELOW_DB_Q8 = 25 * 256 };

/* Add a point's side lobes to the LM_K_LOBES_REACH levels before and behind its own, cell `cell` of
 * its line, and to that cell of the lines on either side. `around` has 2 LM_K_LOBES_REACH + 1
 * lines, its own in the middle. Both responses are in decibels over the point's level, from where
 * the point's own entry is. `along_db_q8` is NULL where the line has not all cells: nothing is
 * added along it. What is LM_K_LOBES_BELOW_DB_Q8 below a level, or more, is not added. Sums and
 * differences are held within 16 bits. Cost: 9 a cell of the reach. */
void lm_k_side_lobes(const int16_t *along_db_q8, const int16_t *across_db_q8, int16_t point_db_q8,
                     int16_t *const *around, uint32_t cell);

enum { LM_K_TAPS = 8 };

/* Weighted sum of LM_K_TAPS lines of powers, rounded down. The weights add up to 65536, so that the
 * sum fits. Writes no entry behind the last cell. Cost: 7 a cell. */
void lm_k_beam_sum(const uint32_t *const power_q24[LM_K_TAPS], const uint32_t *weight_q16,
                   uint32_t *sum_q24, uint32_t cells);

/* Add to the power of each cell a floor that begins at `from_q24` and rises by `step` a cell, which
 * has LM_K_SLOPE_PLACES binary places more. A step of 2^32 - n falls by n. The floor is 0..2^27 - 1
 * in each cell. What does not fit is the largest power. Writes no entry behind the last cell.
 * Cost: 2 a cell. */
enum { LM_K_SLOPE_PLACES = 5 };
void lm_k_add_slope(uint32_t *power_q24, uint32_t cells, uint32_t from_q24, uint32_t step);

/* Multiply the power of each cell by its speckle, 1 in Q24, in place. What does not fit is the
 * largest power. Cost: 1 a cell. */
void lm_k_fade(const uint32_t *speckle_q24, uint32_t *power_q24, uint32_t cells);

/* 10 log10 2^24, in 1/256 dB. */
enum { LM_K_UNIT_Q24_DB_Q8 = 24 * FX_DB_PER_OCTAVE_Q14 / 64 };

/* A receiver's noise, and its bins. */
struct lm_k_receiver {
    const int32_t *noise_db_q8; /* mean of each bin, dB of gamma */
    const int32_t *fall_db_q8;  /* STC roll-off of each bin */
    int32_t rise_db_q8;         /* of the noise, in all bins */
    const int16_t *row_db_q8;   /* draws of the noise, as in lm/kernels_clutter.h */
    const uint32_t *entry;
};

/* Rain in each bin. */
struct lm_k_rain {
    const int32_t *loss_db_q8; /* on the way there and back; 0 or more */
    const int32_t *rain_db_q8; /* what the drops return, dB of gamma */
};

/* What lm_k_detect adds to levels, that 16 bits hold them: 48 dB. */
enum { LM_K_DETECT_BIAS_DB_Q8 = 48 * 256 };

/* Level of each bin: signal and noise added as powers, then less fall_db_q8. The noise is its mean
 * and a draw; 1.0 in Q24 of power is 0 dB; no power counts as -176 dB. Signals, noises and
 * their sums are held between -176 and 80 dB, levels and falls within 16 bits. What is given is
 * within 2^30 of 0. Groups have LM_LANES cells. Cost: 7 a cell. */
void lm_k_detect(const struct lm_k_receiver *r, const uint32_t *power_q24, int16_t *level_db_q8,
                 uint32_t cells);

/* Level of each bin in rain. The signal is weaker by the loss. Noise and rain add before the draw,
 * because drops move and fluctuate as the noise does. Nothing but the result is held, and no power
 * counts as -240 dB. All else as lm_k_detect. Cost: 12 a cell. */
void lm_k_detect_in_rain(const struct lm_k_receiver *r, const struct lm_k_rain *rain,
                         const uint32_t *power_q24, int16_t *level_db_q8, uint32_t cells);

enum { LM_K_TONE_PIECES = 64, LM_K_TONE_PIECE_STEPS_LOG2 = 5 };

/* A tone curve from black to white. */
struct lm_k_tone_curve {
    int32_t black_db_q8, white_db_q8; /* 16 bits each, black below white */
    int32_t step_log2;                /* 0..5: a step is 2^step_log2 of 1/256 dB */
    const int32_t *grey_of_step;      /* 0..255 of each step from black, step 0, to white */

    /* NULL, or the same curve in LM_K_TONE_PIECES straight lines, for machines that look up 64
     * bytes at once. Step 32 n + k has (base[n] + k slope[n]) / 256, rounded down. Rows: lower byte
     * and upper byte of base[n] - 32 (n mod 8) slope[n], modulo 2^16; slope[n]. */
    const uint8_t (*pieces)[LM_K_TONE_PIECES];
};

/* Grey of each level. Writes no entry behind the last cell. Cost: 2 a cell,
 * without lines 6. */
void lm_k_tone(const struct lm_k_tone_curve *tone, const int16_t *level_db_q8, uint8_t *grey,
               uint32_t cells);

#endif
